//! SBRDF maps as McAllister built them: at each texel a diffuse albedo and one to three generalised cosine lobes of Lafortune.
//!
//! A lobe is `albedo (C i . o)^n / N`, C = diag(Cx, Cy, Cz) with max |C| = 1, which fixes what C and the albedo could pass
//! to each other. `i` is the direction of the light, `o` that of the viewer, both in the frame of tangent, bitangent and normal; (−1, −1, 1)
//! is Phong's lobe, Cx = Cy > 0 sends light back. N is the integral of the lobe ([`integral`]): see [`Normalise`].
//! [`fit`] finds shapes and albedos, [`curve`] does so once for all roughnesses of a map, [`ladder`] tells levels of a prefiltered environment.
//!
//! Source: [Lafortune 1997](crate::cite::LAFORTUNE_1997); [McAllister 2002](crate::cite::MCALLISTER_2002).

pub mod curve;
pub mod fit;
pub mod integral;
pub mod ladder;
pub mod nodes;
pub mod refit;
pub mod tabulated;

use glam::DVec3;

/// Most lobes of a texel.
pub const MOST_LOBES: usize = 3;

/// Texels of the table of the integrals: along v, u = v |v|, and along the code of the exponent.
pub const NORMALISATION: [usize; 2] = [129, 65];

/// Range of exponents: what a fit may take, and what the codes 0 and 1 stand for, spread over the logarithm.
pub const EXPONENTS: [f64; 2] = [1.0, 1e5];

/// What a lobe is divided by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Normalise {
    /// Its own integral at the direction of the light: the reflectance of each lobe is its albedo exactly, and reciprocity is broken.
    Incident,
    /// The largest integral over all directions, one number a lobe: reciprocal, and the reflectance is at most the albedo.
    Largest,
}

impl Normalise {
    /// Id: kebab-case.
    #[must_use]
    pub const fn id(self) -> &'static str {
        match self {
            Normalise::Incident => "incident",
            Normalise::Largest => "largest",
        }
    }
}

/// A generalised cosine lobe without albedo.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CosineLobe {
    /// Diagonal of C, max |C| = 1.
    pub c: [f64; 3],
    /// Exponent.
    pub n: f64,
}

impl CosineLobe {
    /// `C i`.
    fn turned(&self, i: DVec3) -> DVec3 {
        let [x, y, z] = self.c;
        DVec3::new(x * i.x, y * i.y, z * i.z)
    }

    /// `max(0, C i . o)^n`, in [0, 1].
    #[must_use]
    pub fn power(&self, i: DVec3, o: DVec3) -> f64 {
        let d = self.turned(i).dot(o);
        if d > 0.0 { libm::pow(d, self.n) } else { 0.0 }
    }

    /// N(i), the integral of the lobe times the cosine over the hemisphere of o: |C i|^n I(n, u), u the cosine between C i and the normal.
    #[must_use]
    pub fn norm(&self, i: DVec3) -> f64 {
        let a = self.turned(i);
        let length = a.length();
        if length > 0.0 {
            libm::pow(length, self.n) * integral::integral(self.n, a.z / length, true)
        } else {
            0.0
        }
    }

    /// The largest N over all directions of light.
    #[must_use]
    pub fn largest(&self) -> f64 {
        let round = self.c[0].abs().total_cmp(&self.c[1].abs()).is_eq();
        let azimuths: &[f64] = if round { &[0.0] } else { &[0.0, std::f64::consts::FRAC_PI_2] };
        let along = |phi: f64| {
            let value = |mu: f64| {
                let sin = (1.0 - mu * mu).max(0.0).sqrt();
                let (s, c) = libm::sincos(phi);
                self.norm(DVec3::new(sin * c, sin * s, mu))
            };
            let steps = 32;
            let at = |k: usize| k as f64 / steps as f64;
            let best = (0..=steps).fold(0, |b, k| if value(at(k)) > value(at(b)) { k } else { b });
            golden(at(best.saturating_sub(1)), at((best + 1).min(steps)), value)
        };
        // between the axes of C the integral lies between those along them
        azimuths.iter().map(|phi| along(*phi)).fold(0.0, f64::max)
    }
}

/// The largest value between two points, by golden sections.
fn golden(mut a: f64, mut b: f64, value: impl Fn(f64) -> f64) -> f64 {
    let ratio = 0.5 * (5f64.sqrt() - 1.0);
    let mut best = value(a).max(value(b));
    for _ in 0..40 {
        let (c, d) = (b - ratio * (b - a), a + ratio * (b - a));
        let (left, right) = (value(c), value(d));
        best = best.max(left).max(right);
        if left > right { b = d } else { a = c }
    }
    best
}

/// A lobe that is divided by its integral, for the directions of light of a fit.
#[derive(Debug, Clone)]
pub struct Divided {
    lobe: CosineLobe,
    /// One over the largest integral; for [`Normalise::Incident`] each direction has its own.
    constant: Option<f64>,
}

impl Divided {
    /// A lobe with its normalisation.
    #[must_use]
    pub fn new(lobe: CosineLobe, normalise: Normalise) -> Divided {
        let constant = (normalise == Normalise::Largest).then(|| 1.0 / lobe.largest());
        Divided { lobe, constant }
    }

    /// A lobe that is divided by nothing.
    fn plain(lobe: CosineLobe) -> Divided {
        Divided { lobe, constant: Some(1.0) }
    }

    /// The lobe for light of one direction, as a function of o: unit sr⁻¹, without the cosine.
    pub fn from(&self, i: DVec3) -> impl Fn(DVec3) -> f64 + use<> {
        let a = self.lobe.turned(i);
        let length = a.length();
        let (axis, n) = (if length > 0.0 { a / length } else { DVec3::Z }, self.lobe.n);
        let scale = match self.constant {
            // |C i|^n cancels
            None => 1.0 / integral::integral(n, axis.z, true).max(f64::MIN_POSITIVE),
            Some(constant) => constant * libm::pow(length, n),
        };
        move |o: DVec3| {
            let d = axis.dot(o);
            if d > 0.0 { scale * libm::pow(d, n) } else { 0.0 }
        }
    }
}

/// A code of an exponent in [0, 1], and back: the logarithm between the ends of [`EXPONENTS`].
#[must_use]
pub fn exponent_code(n: f64) -> f64 {
    let [lo, hi] = EXPONENTS;
    (libm::log(n / lo) / libm::log(hi / lo)).clamp(0.0, 1.0)
}

/// The exponent of a code; see [`exponent_code`].
#[must_use]
pub fn exponent(code: f64) -> f64 {
    let [lo, hi] = EXPONENTS;
    lo * libm::pow(hi / lo, code)
}
