//! Fresnel reflectance of a smooth interface, exact, dielectric and conducting.
//!
//! The textbook amplitudes (c − g)/(c + g) subtract two nearly equal numbers as soon as the media are nearly
//! equal. Multiplying by the conjugate turns each difference into a product that is known exactly:
//! `c² − g² = 1 − eta²` and `eta⁴c² − g² = (eta² − 1)(eta²c² − sin²θ)`. The same step with the complex index
//! serves conductors. Nothing here loses digits for eta → 1, and absorptances are not formed as 1 − R.
//!
//! Sign of the cosine, dielectrics: `cos_i > 0` arrives from above, `cos_i < 0` from below; `eta = n_below/n_above`
//! always. A caller who has only the ratio seen from the ray's side passes `|cos_i|` and that ratio.

use glam::DVec3;

/// One number for each linear polarisation, as a fraction of the incident power of that polarisation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Polarised {
    /// Electric field perpendicular to the plane of incidence.
    pub s: f64,
    /// Electric field in the plane of incidence.
    pub p: f64,
}

impl Polarised {
    const ZERO: Self = Self { s: 0.0, p: 0.0 };
    const ONE: Self = Self { s: 1.0, p: 1.0 };

    /// The mean of both: the value for unpolarised light.
    #[must_use]
    pub fn unpolarised(self) -> f64 {
        0.5 * (self.s + self.p)
    }
}

/// Cosines of Snell's law, each multiplied by its index: `p1 = n1 cos θ1`, `p2 = n2 cos θ2`.
struct Refraction {
    n1: f64,
    n2: f64,
    cos_i: f64,
    p1: f64,
    p2: f64,
    /// n2² − n1².
    contrast: f64,
}

/// `None` under total internal reflection, and at its edge.
fn refraction(cos_i: f64, eta: f64) -> Option<Refraction> {
    // (eta − 1) is exact for eta in [1/2, 2] (Sterbenz), so the contrast keeps full relative accuracy.
    let below_minus_above = (eta - 1.0) * (eta + 1.0);
    let (n1, n2, contrast) =
        if cos_i < 0.0 { (eta, 1.0, -below_minus_above) } else { (1.0, eta, below_minus_above) };
    let cos_i = cos_i.abs().min(1.0);
    let p1 = n1 * cos_i;
    if contrast == 0.0 {
        return Some(Refraction { n1, n2, cos_i, p1, p2: p1, contrast });
    }
    // n2² − n1² sin²θ either way; each form is the one without cancellation on its side of 45 degrees.
    let square = if 2.0 * cos_i * cos_i > 1.0 {
        n2 * n2 - n1 * n1 * (1.0 - cos_i) * (1.0 + cos_i)
    } else {
        contrast + p1 * p1
    };
    (square > 0.0).then(|| Refraction { n1, n2, cos_i, p1, p2: square.sqrt(), contrast })
}

/// Reflectance of a dielectric interface, both polarisations.
///
/// `R_s = (d/(c + g)²)²`, `R_p = (d (eta²c² − sin²θ)/(eta²c + g)²)²`, `d = (eta − 1)(eta + 1)`,
/// `g = eta cos θ_t = √(d + c²)`, c = `cos_i`; from below the same with the media exchanged, without forming 1/eta.
/// Source: [Born and Wolf 1999](crate::cite::BORN_WOLF_1999) §1.5.2; [Walter2007](crate::cite::WALTER_2007) Eq. 22 is
/// the unpolarised mean. The product forms follow by multiplying with the conjugate.
/// Domain: `cos_i` in [−1, 1] (see the module for its sign), eta in [1e-4, 1e4]. Range: [0, 1].
/// Laws: 1 under total internal reflection; `R_p = 0` at Brewster's angle; `R(c, eta) = R(−c_t, eta)`.
/// Guard: eta = 1 is 0 at every angle, also at grazing, where the general form is 0/0.
/// Accuracy: relative 1e-14 for `R_s`; for `R_p` the same away from its zero, absolute 1e-16 at it
/// (`tests/terms.rs`).
#[must_use]
pub fn dielectric(cos_i: f64, eta: f64) -> Polarised {
    let Some(r) = refraction(cos_i, eta) else { return Polarised::ONE };
    if r.contrast == 0.0 {
        return Polarised::ZERO;
    }
    let sum_s = r.p1 + r.p2;
    let sum_p = r.n2 * r.n2 * r.cos_i + r.n1 * r.p2;
    let amplitude_s = r.contrast / (sum_s * sum_s);
    let brewster = r.n2 * r.n2 * r.cos_i * r.cos_i - r.n1 * r.n1 * (1.0 - r.cos_i) * (1.0 + r.cos_i);
    let amplitude_p = r.contrast / sum_p * (brewster / sum_p);
    // At grazing both are 1 up to rounding, and rounding may go up.
    Polarised { s: (amplitude_s * amplitude_s).min(1.0), p: (amplitude_p * amplitude_p).min(1.0) }
}

/// Transmittance 1 − R of a dielectric interface, both polarisations, without the subtraction.
///
/// `T_s = 4 c g/(c + g)²`, `T_p = 4 eta²c g/(eta²c + g)²`; the power that crosses, so no factor eta².
/// Source, domain, sign of the cosine: as [`dielectric`]. Range: [0, 1]; 0 under total internal reflection.
/// Accuracy: relative 1e-14, except near the critical angle, where g is the root of a difference
/// (`tests/terms.rs`).
#[must_use]
pub fn dielectric_transmittance(cos_i: f64, eta: f64) -> Polarised {
    let Some(r) = refraction(cos_i, eta) else { return Polarised::ZERO };
    if r.contrast == 0.0 {
        return Polarised::ONE;
    }
    let sum_s = r.p1 + r.p2;
    let (a, b) = (r.n2 * r.n2 * r.cos_i, r.n1 * r.p2);
    let sum_p = a + b;
    Polarised {
        s: (4.0 * (r.p1 / sum_s) * (r.p2 / sum_s)).min(1.0),
        p: (4.0 * (a / sum_p) * (b / sum_p)).min(1.0),
    }
}

/// Transmittance from the cosines to both sides of the facet, for a chart that has them both without a difference.
///
/// `T_s = 4 c b/(c + b)²`, b = eta `cos_t`; `T_p = 4 a cos_t/(a + cos_t)²`, a = eta c. The law of refraction is not looked at.
/// Source: as [`dielectric_transmittance`]. Domain: both cosines in [0, 1], eta in [1e-4, 1e4]. Range: [0, 1]; 0 where one cosine is 0.
/// Accuracy: relative 1e-15 of the cosines given.
#[must_use]
pub fn transmittance_between(cos_i: f64, cos_t: f64, eta: f64) -> Polarised {
    let of = |a: f64, b: f64| {
        let sum = a + b;
        if sum > 0.0 { (4.0 * (a / sum) * (b / sum)).min(1.0) } else { 0.0 }
    };
    Polarised { s: of(cos_i, eta * cos_t), p: of(eta * cos_i, cos_t) }
}

/// Cosine of the refracted direction, ≥ 0; `None` under total internal reflection.
///
/// `cos θ_t = √(eta² − 1 + c²)/eta` from above; A.4's `g` is eta times it.
/// Source: Snell's law, [Born and Wolf 1999](crate::cite::BORN_WOLF_1999) §1.5.1. Domain and sign: as [`dielectric`].
/// Range: [0, 1]. For eta = 1 it is |`cos_i`| bit for bit.
#[must_use]
pub fn cos_refracted(cos_i: f64, eta: f64) -> Option<f64> {
    refraction(cos_i, eta).map(|r| (r.p2 / r.n2).min(1.0))
}

/// The refracted direction of `wo` at a facet with normal `wm`; `None` under total internal reflection.
///
/// `wt = −r wo + (r c ∓ cos θ_t) wm`, c = `wo·wm`, r = 1/eta and minus for c > 0, r = eta and plus for c < 0.
/// Both directions point away from the facet. Unit in, unit out within 4 ulp. For eta = 1 it is −`wo` bit for bit.
/// Source: [Walter2007](crate::cite::WALTER_2007) Eq. 40. Domain: unit vectors, eta as in [`dielectric`].
#[must_use]
pub fn refract(wo: DVec3, wm: DVec3, eta: f64) -> Option<DVec3> {
    let c = wo.dot(wm);
    let cos_t = cos_refracted(c, eta)?;
    let ratio = if c < 0.0 { eta } else { 1.0 / eta };
    Some((ratio * c - cos_t.copysign(c)) * wm - ratio * wo)
}

/// Cosine of the critical angle seen from the denser side, `√(1 − m²)` with m the smaller of eta and 1/eta.
///
/// Smaller cosines are totally reflected. 0 for eta = 1.
/// Source: [Born and Wolf 1999](crate::cite::BORN_WOLF_1999) §1.5.4. Domain: eta > 0. Range: [0, 1).
/// The reflectance has an infinite slope there: split quadratures and tables at this cosine.
#[must_use]
pub fn cos_critical(eta: f64) -> f64 {
    let contrast = ((eta - 1.0) * (eta + 1.0)).abs();
    (contrast / (eta * eta).max(1.0)).sqrt()
}

/// Cosine of Brewster's angle for arrival from above, `1/√(1 + eta²)`: where `R_p` = 0.
///
/// Source: [Born and Wolf 1999](crate::cite::BORN_WOLF_1999) §1.5.3. Domain: eta > 0. Range: (0, 1).
#[must_use]
pub fn cos_brewster(eta: f64) -> f64 {
    1.0 / libm::hypot(1.0, eta)
}

/// `N² − 1 + c² = q²`, q = a + ib the complex `N cos θ_t`, and what both polarisations share.
struct Metal {
    c: f64,
    a: f64,
    /// Re N² and Im N².
    n_squared: (f64, f64),
    /// |N² − 1|².
    contrast_squared: f64,
    /// |c + q|².
    sum_s: f64,
    /// |N²c + q|².
    sum_p: f64,
    /// |q²| + sin²θ.
    excess: f64,
}

impl Metal {
    fn new(cos_i: f64, n: f64, k: f64) -> Self {
        let c = cos_i.abs().min(1.0);
        let sin_squared = (1.0 - c) * (1.0 + c);
        let n_squared = ((n - k) * (n + k), 2.0 * n * k);
        // Re q² as in `refraction`: each form without cancellation on its side of 45 degrees.
        let real = if c * c > sin_squared {
            n_squared.0 - sin_squared
        } else {
            (n - 1.0) * (n + 1.0) - k * k + c * c
        };
        let modulus = libm::hypot(real, n_squared.1);
        // The root of the larger part first; the smaller one follows from a b = n k without a difference.
        let (a, b) = if modulus == 0.0 {
            (0.0, 0.0)
        } else if real >= 0.0 {
            let a = (0.5 * (modulus + real)).sqrt();
            (a, n * k / a)
        } else {
            let b = (0.5 * (modulus - real)).sqrt();
            (n * k / b, b)
        };
        let square = |x: f64| x * x;
        Self {
            c,
            a,
            n_squared,
            contrast_squared: (square(n - 1.0) + k * k) * (square(n + 1.0) + k * k),
            sum_s: square(c + a) + b * b,
            sum_p: square(n_squared.0 * c + a) + square(n_squared.1 * c + b),
            excess: modulus + sin_squared,
        }
    }
}

/// Reflectance of a conductor with complex index N = n + ik against vacuum or a dielectric, both polarisations.
///
/// `R_s = |N² − 1|²/|c + q|⁴`, `R_p = |N² − 1|² |N²c² − sin²θ|²/|N²c + q|⁴`, `q² = N² − 1 + c²`, Im q ≥ 0,
/// with n and k relative to the medium above.
/// Source: [Born and Wolf 1999](crate::cite::BORN_WOLF_1999) §14.2, whose index is n(1 + iκ): k = nκ here.
/// Domain: |`cos_i`| in [0, 1] (the sign is ignored), n ≥ 0, k ≥ 0, at most 1e4. Range: [0, 1].
/// Laws: k = 0 is [`dielectric`]; 1 at grazing; ((n−1)² + k²)/((n+1)² + k²) at normal incidence.
/// Guard: n = 1, k = 0 at grazing and n = k = 0 at normal incidence are 0/0; they give 0 (no interface) and 1.
/// Accuracy: relative 1e-14 (`tests/terms.rs`), also for k ≫ n, where the usual form cancels.
#[must_use]
pub fn conductor(cos_i: f64, n: f64, k: f64) -> Polarised {
    let m = Metal::new(cos_i, n, k);
    if m.contrast_squared == 0.0 {
        return Polarised::ZERO;
    }
    let c2 = m.c * m.c;
    let (re, im) = (m.n_squared.0 * c2 - (1.0 - m.c) * (1.0 + m.c), m.n_squared.1 * c2);
    let s = m.contrast_squared / m.sum_s / m.sum_s;
    let p = m.contrast_squared / m.sum_p * ((re * re + im * im) / m.sum_p);
    let guard = |r: f64| if r.is_nan() { 1.0 } else { r.min(1.0) };
    Polarised { s: guard(s), p: guard(p) }
}

/// Absorptance 1 − R of a conductor, both polarisations, without the subtraction.
///
/// `A_s = 4 a c/|c + q|²`, `A_p = 4 a c (|q|² + sin²θ)/|N²c + q|²`, a = Re q. Good metals reflect nearly
/// everything; their colour and their losses after many bounces are in this number.
/// Source: as [`conductor`]; the second form follows from `Re(N̄² q) = a (|q|² + sin²θ)`.
/// Domain, guard: as [`conductor`]. Range: [0, 1]. Accuracy: relative 1e-14 (`tests/terms.rs`), where 1 − R has
/// no digit left at n = 0.01, k = 1000.
#[must_use]
pub fn conductor_absorptance(cos_i: f64, n: f64, k: f64) -> Polarised {
    let m = Metal::new(cos_i, n, k);
    if m.contrast_squared == 0.0 {
        return Polarised::ONE;
    }
    let s = 4.0 * m.a * (m.c / m.sum_s);
    let p = 4.0 * m.a * (m.c / m.sum_p) * m.excess;
    let guard = |x: f64| if x.is_nan() { 0.0 } else { x.min(1.0) };
    Polarised { s: guard(s), p: guard(p) }
}

/// Hemispherical average `F_avg = 2 ∫₀¹ F(c) c dc` of the unpolarised dielectric reflectance.
///
/// `eta` is the index on the far side over the index on the near side, where the light comes from.
/// Source: [Duntley1942](crate::cite::DUNTLEY_1942), after Walsh, for the closed form in logarithms, used for a
/// ratio of 2 and above. It cancels as 1/(eta − 1)², so below 2 this is used instead: with c = √(eta² − 1) sinh u,
/// w = exp(−2u), ρ = (eta² − 1)/(eta² + 1) and q = (eta − 1)/(eta + 1) the amplitudes become `r_s = −w` and
/// `r_p = (ρ − w)/(1 − ρw)`, so that
///
/// ```text
/// F_s,avg = q (q + 2)/3
/// F_p,avg = (eta² − 1)/4 ∫_q^1 (1 − w²) [ρ/w − (1 − ρ²)/(1 − ρw)]² dw
/// ```
/// and the integral is a logarithm plus a power series in ρ ≤ 3/5 with terms of one sign.
/// From the denser side, eta < 1: `F_avg(eta) = (1 − eta²) + eta² F_avg(1/eta)` (flux reversibility).
/// Domain: eta in [1e-4, 1e4]. Range: [0, 1]; `F_avg` → |eta − 1|/3 from above 1. Guard: eta = 1 gives 0.
/// Accuracy: relative 2e-15 (`tests/terms.rs`).
#[must_use]
pub fn dielectric_average(eta: f64) -> f64 {
    if eta < 1.0 {
        // The ratios in terms of eta itself: 1/eta − 1 would lose the digits that eta − 1 has.
        let contrast = (1.0 - eta) * (1.0 + eta);
        let e2 = eta * eta;
        return contrast
            + e2 * average_from_outside(1.0 / eta, (1.0 - eta) / (1.0 + eta), contrast / (1.0 + e2));
    }
    average_from_outside(eta, (eta - 1.0) / (eta + 1.0), (eta - 1.0) * (eta + 1.0) / (eta * eta + 1.0))
}

/// `F_avg` for a ratio n ≥ 1, with q = (n − 1)/(n + 1) and rho = (n² − 1)/(n² + 1).
fn average_from_outside(n: f64, q: f64, rho: f64) -> f64 {
    if q == 0.0 {
        return 0.0;
    }
    let n2 = n * n;
    let n4 = n2 * n2;
    if n >= 2.0 {
        let (n2p, n4m) = (n2 + 1.0, n4 - 1.0);
        return 0.5
            + (n - 1.0) * (3.0 * n + 1.0) / (6.0 * (n + 1.0) * (n + 1.0))
            + n2 * (n2 - 1.0) * (n2 - 1.0) / (n2p * n2p * n2p) * libm::log(q)
            - 2.0 * n2 * n * (n2 + 2.0 * n - 1.0) / (n2p * n4m)
            + 8.0 * n4 * (n4 + 1.0) / (n2p * n4m * n4m) * libm::log(n);
    }
    let average_s = q * (q + 2.0) / 3.0;
    // Σ ρᵏ M_k and Σ (k+1) ρᵏ M_k with M_k = ∫_q^1 (1 − w²) wᵏ dw.
    let (mut plain, mut weighted) = (0.0, 0.0);
    let (mut power, mut q_power, mut order) = (1.0, q, 1.0);
    while order * power > 1e-18 {
        let moment = power * ((1.0 - q_power) / order - (1.0 - q_power * q * q) / (order + 2.0));
        plain += moment;
        weighted += order * moment;
        power *= rho;
        q_power *= q;
        order += 1.0;
    }
    // 1 − ρ² = (2n/(n² + 1))², and n² − 1 = 4 q/(1 − q)².
    let rest = (2.0 * n / (n2 + 1.0)) * (2.0 * n / (n2 + 1.0));
    let squared = rho * rho * (1.0 - q) * (1.0 - q) / q;
    let mixed = 2.0 * rho * rest * (-libm::log(q) - 0.5 * (1.0 - q) * (1.0 + q) + rho * plain);
    let average_p = q / ((1.0 - q) * (1.0 - q)) * (squared - mixed + rest * rest * weighted);
    0.5 * (average_s + average_p)
}
