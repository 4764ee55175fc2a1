//! A thin dielectric film on a dielectric or conductor: oil on water, soap, anodised metal, coatings.
//!
//! Spectral truth is Airy's sum of all orders, here by the characteristic matrix of the film, which stays regular
//! where Airy's form is 0/0 (grazing inside the film). Its colour is the integral over the sensitivities of the eye;
//! Belcour and Barla do that in closed form, order by order. Outside is vacuum (air).

use super::fresnel::Polarised;
use crate::math::complex::Complex;
use std::f64::consts::PI;

/// A film of real index `n2` and thickness `d_nm` on a substrate of index `n3 + i k3`, seen from vacuum.
///
/// Units: nm. Domain: `n2` in [0.1, 10], `n3` ≥ 0, `k3` ≥ 0 (not both 0), `d_nm` in [0, 1e5].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Film {
    /// Index of the film.
    pub n2: f64,
    /// Real part of the index of the substrate.
    pub n3: f64,
    /// Extinction coefficient of the substrate; k = nκ in the convention n(1 + iκ).
    pub k3: f64,
    /// Thickness, nm.
    pub d_nm: f64,
}

/// Squared indices N², and q = N cos θ, of the three media.
struct Stack {
    square: [Complex; 3],
    q: [Complex; 3],
    /// sin²θ outside.
    sin2: f64,
}

impl Stack {
    fn new(film: &Film, cos_i: f64) -> Self {
        let c = cos_i.abs().min(1.0);
        let sin2 = (1.0 - c) * (1.0 + c);
        let (n2, n3, k3) = (film.n2, film.n3, film.k3);
        let square =
            [Complex::real(1.0), Complex::real(n2 * n2), Complex::new((n3 - k3) * (n3 + k3), 2.0 * n3 * k3)];
        // N² − sin²θ, or (N² − 1) + cos²θ below 45 degrees from the horizon: each without cancellation on its side.
        let steep = 2.0 * c * c > 1.0;
        let root = |above: f64, contrast: f64, im: f64| {
            Complex::new(if steep { above - sin2 } else { contrast + c * c }, im).sqrt_upper()
        };
        let q2 = root(n2 * n2, (n2 - 1.0) * (n2 + 1.0), 0.0);
        let q3 = root(square[2].re, (n3 - 1.0) * (n3 + 1.0) - k3 * k3, square[2].im);
        Self { square, q: [Complex::real(c), q2, q3], sin2 }
    }

    /// `q_a − q_b` as `(N_a² − N_b²)/(q_a + q_b)`.
    fn difference_s(&self, a: usize, b: usize) -> Complex {
        regular(self.square[a] - self.square[b], self.q[a] + self.q[b])
    }

    /// `N_a² q_b − N_b² q_a` as `(N_a² − N_b²)(N_a² N_b² − sin²θ (N_a² + N_b²))/(N_b² q_a + N_a² q_b)`.
    fn difference_p(&self, a: usize, b: usize) -> Complex {
        let (sa, sb) = (self.square[a], self.square[b]);
        let above = (sa - sb) * (sa * sb - (sa + sb).scale(self.sin2));
        regular(above, sb * self.q[a] + sa * self.q[b])
    }

    /// Amplitudes (s, p) of the interface from `a` to `b`, in Verdet's sign: both equal at normal incidence up to sign.
    fn interface(&self, a: usize, b: usize) -> [Complex; 2] {
        let s = regular(self.difference_s(a, b), self.q[a] + self.q[b]);
        let (sa, sb) = (self.square[a], self.square[b]);
        let p = regular(-self.difference_p(a, b), sb * self.q[a] + sa * self.q[b]);
        [s, p]
    }
}

/// a/b, and 0 for 0/0: no contrast, no reflection.
fn regular(a: Complex, b: Complex) -> Complex {
    if a.norm2() == 0.0 { a } else { a.over(b) }
}

/// Spectral reflectance of the coated surface, both polarisations (Airy's formula).
///
/// `R = |r12 + r23 e^(iδ)|²/|1 + r12 r23 e^(iδ)|²`, δ = 4π n2 d cos θ2/λ. Evaluated as
/// `|u cos φ − i v sin φ/q2|²/|u' cos φ − i v' sin φ/q2|²`, φ = δ/2, with for s: u = q1 − q3, v = q1 q3 − q2²,
/// u' = q1 + q3, v' = q1 q3 + q2², and for p: u = N1² q3 − N3² q1, v = N1² N3² q2²/N2² − N2² q1 q3, u', v' their sums;
/// q = N cos θ. The differences are formed as products, as in [`fresnel`](super::fresnel).
/// Source: [Born and Wolf 1999](crate::cite::BORN_WOLF_1999) §1.6.4 and §7.6.1; [Belcour and Barla 2017](crate::cite::BELCOUR_BARLA_2017)
/// §3. Units: `lambda_nm` in nm, > 0. Domain: |`cos_i`| in [0, 1]. Range: [0, 1].
/// Laws: d = 0 is the bare substrate. Film index below 1: evanescent waves are included.
/// Accuracy: relative 1e-12 (`tests/terms.rs`), absolute 1e-15 at the minima of antireflection coatings.
#[must_use]
pub fn airy(film: &Film, cos_i: f64, lambda_nm: f64) -> Polarised {
    let stack = Stack::new(film, cos_i);
    let [n1, n2, n3] = stack.square;
    let [q1, q2, q3] = stack.q;
    let path = 2.0 * PI * film.d_nm / lambda_nm;
    // cos φ and sin φ/q2, both times e^(iφ), which has no effect on a quotient of moduli and keeps them bounded.
    let grown = q2.scale(2.0 * path).expm1_i();
    let cosine = grown.scale(0.5) + Complex::real(1.0);
    let sine = if q2.norm2() == 0.0 {
        Complex::real(path)
    } else {
        // (e^(2iφ) − 1)/(2i)
        Complex::new(0.5 * grown.im, -0.5 * grown.re).over(q2)
    };
    let times_minus_i = |z: Complex| Complex::new(z.im, -z.re);
    let quotient = |u: Complex, v: Complex, u_sum: Complex, v_sum: Complex| {
        let above = u * cosine + times_minus_i(v * sine);
        let below = u_sum * cosine + times_minus_i(v_sum * sine);
        // 0/0 only where nothing separates the media at grazing: no reflection.
        if above.norm2() == 0.0 { 0.0 } else { (above.norm2() / below.norm2()).min(1.0) }
    };
    let s = quotient(
        stack.difference_s(0, 2),
        stack.difference_s(0, 1) * q3 + q2 * stack.difference_s(2, 1),
        q1 + q3,
        q1 * q3 + q2 * q2,
    );
    let inside = 1.0 / n2.re;
    let mixed = n1 * q2 * stack.difference_p(2, 1) + n2 * q3 * stack.difference_p(0, 1);
    let p = quotient(
        stack.difference_p(0, 2),
        mixed.scale(inside),
        n1 * q3 + n3 * q1,
        (n1 * n3 * q2 * q2).scale(inside) + n2 * q1 * q3,
    );
    Polarised { s, p }
}

/// A channel of the CIE 1931 standard observer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Channel {
    /// x-bar.
    X,
    /// y-bar.
    Y,
    /// z-bar.
    Z,
}

/// Fourier transform of a sensitivity of the eye at an optical path difference, with a phase `shift` in rad.
///
/// `S = Σ v √(2π w) cos(m p + shift) exp(−w p²)/1.0685e-7`, p = 2π OPD; Y and Z are one Gaussian, X two.
/// Source: [Belcour and Barla 2017](crate::cite::BELCOUR_BARLA_2017), constants as in their published shader and in
/// MaterialX. Units: `opd_nm` in nm. Range: [−1.01, 1.01]; 1 at 0 within 1.2e-3. Accuracy: as a fit, relative 1e-13 of the
/// larger Gaussian (`tests/terms.rs`).
#[must_use]
pub fn sensitivity(channel: Channel, opd_nm: f64, shift: f64) -> f64 {
    let p = 2.0 * PI * opd_nm * 1e-9;
    let lobe = |value: f64, position: f64, width: f64| {
        value * (2.0 * PI * width).sqrt() * libm::cos(position * p + shift) * libm::exp(-width * p * p)
    };
    let sum = match channel {
        Channel::X => lobe(5.4856e-13, 1.6810e6, 4.3278e9) + lobe(9.7470e-14, 2.2399e6, 4.5282e9),
        Channel::Y => lobe(4.4201e-13, 1.7953e6, 9.3046e9),
        Channel::Z => lobe(5.2481e-13, 2.2084e6, 6.6121e9),
    };
    sum / 1.0685e-7
}

/// Reflectance as a sum over orders, with `wave(m · OPD, m · phase)` in place of each cosine.
///
/// `R = C0 + 2 Σ C_m wave(m OPD, m φ)`, `R* = T² R23/(1 − R12 R23)`, `C0 = R12 + R*`,
/// `C_m = (R* − T)(R12 R23)^(m/2)`, φ = arg r21 + arg r23, OPD = 2 n2 d cos θ2. With the wave cos(2π OPD/λ + φ) and many
/// orders it is [`airy`]. Source: [Belcour and Barla 2017](crate::cite::BELCOUR_BARLA_2017) Eq. 10, by [Cycles](crate::cite::CYCLES) `iridescence_airy_summation_channel`, which has the same `C0` and `C_m`.
/// Domain: as [`airy`], `n2` ≥ 1; a film that reflects totally gives 1.
#[must_use]
pub fn series(film: &Film, cos_i: f64, orders: u32, wave: &dyn Fn(f64, f64) -> f64) -> Polarised {
    let stack = Stack::new(film, cos_i);
    if stack.q[1].im > 0.0 {
        return Polarised { s: 1.0, p: 1.0 };
    }
    let opd = 2.0 * stack.q[1].re * film.d_nm;
    let (first, second) = (stack.interface(0, 1), stack.interface(1, 2));
    let sum = |i: usize| {
        let (r12, r23) = (first[i].norm2().min(1.0), second[i].norm2().min(1.0));
        let phase = (-first[i]).argument() + second[i].argument();
        let through = 1.0 - r12;
        let loss = 1.0 - r12 * r23;
        let star = if loss > 0.0 { through * through * r23 / loss } else { 0.0 };
        let mut total = r12 + star;
        let mut weight = star - through;
        for m in 1..=orders {
            weight *= (r12 * r23).sqrt();
            let m = f64::from(m);
            total += 2.0 * weight * wave(m * opd, m * phase);
        }
        total
    };
    Polarised { s: sum(0), p: sum(1) }
}

/// XYZ to linear RGB for equal-energy white, the matrix that goes with [`sensitivity`].
const TO_RGB: [[f64; 3]; 3] = [
    [2.3706743, -0.9000405, -0.4706338],
    [-0.5138850, 1.4253036, 0.0885814],
    [0.0052982, -0.0146949, 1.0093968],
];

/// Reflectance of unpolarised white light as linear RGB, by [`series`] over the [`sensitivity`] of the eye.
///
/// Source: [Belcour and Barla 2017](crate::cite::BELCOUR_BARLA_2017) Eq. 10, matrix as in [MaterialX](crate::cite::MATERIALX).
/// `orders`: 2 or 3 are usual. Range: about [−0.1, 1.1]: cut series and matrix overshoot; renderers clamp to [0, 1].
/// One index for all channels; a coloured metal is three films, of which each gives its channel.
#[must_use]
pub fn rgb(film: &Film, cos_i: f64, orders: u32) -> [f64; 3] {
    let xyz = [Channel::X, Channel::Y, Channel::Z].map(|channel| {
        series(film, cos_i, orders, &|opd, phase| sensitivity(channel, opd, phase)).unpolarised()
    });
    TO_RGB.map(|row| row[0] * xyz[0] + row[1] * xyz[1] + row[2] * xyz[2])
}
