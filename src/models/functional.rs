//! Weights of `v = wo . wh` under which a model is integrated: the channels of split sums.

use crate::integrate::Crease;
use crate::models::microfacet::Fresnel;
use crate::terms::{fresnel, schlick};

/// The weight g_j of a channel, a function of `v = wo . wh`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Functional {
    /// g = 1: the directional albedo.
    One,
    /// g = (1 - v)^5: the part that follows F90.
    Schlick,
    /// g = 1 - (1 - v)^5: the part that follows F0.
    SchlickComplement,
    /// g = v (1 - v)^6 / (1/7 (6/7)^6), which is 1 at v = 1/7: the part that follows the deviation from Schlick at 82 degrees.
    F82,
    /// g = (1 - v)^e.
    Power(f64),
    /// g = max(0, (F(v) - F0) / (1 - F0)) of a dielectric of relative index eta; Schlick's cosine replaced by the exact curve, which
    /// dips below F0 near Brewster's angle.
    Dielectric(f64),
}

impl Functional {
    /// The weight at `v`.
    #[must_use]
    pub fn at(self, v: f64) -> f64 {
        let m = 1.0 - v;
        let fc = (m * m) * (m * m) * m;
        match self {
            Functional::One => 1.0,
            Functional::Schlick => fc,
            Functional::SchlickComplement => 1.0 - fc,
            Functional::F82 => v * fc * m * schlick::F82_SCALE,
            Functional::Power(e) => libm::pow(m.max(0.0), e),
            Functional::Dielectric(eta) => relative_fresnel(v, eta),
        }
    }

    /// Where the weight is not smooth.
    #[must_use]
    pub fn crease(self) -> Option<Crease> {
        match self {
            Functional::Dielectric(eta) => Fresnel::Dielectric { eta }.crease().or_else(|| dip(eta)),
            // a point: wm along wo
            Functional::Power(e) if e.fract().abs() > 0.0 && e < SMOOTH => {
                Some(Crease { at: 1.0, width: 0.0 })
            }
            _ => None,
        }
    }
}

/// Where the exact curve falls to F0 before it dips below it: a corner of the weight; none where it does not dip.
fn dip(eta: f64) -> Option<Crease> {
    let f0 = fresnel::dielectric(1.0, eta).unpolarised();
    let above = |v: f64| fresnel::dielectric(v, eta).unpolarised() > f0;
    let (mut low, mut high) = (0.0, 1.0 - 1e-3);
    if above(high) {
        return None;
    }
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        if above(middle) { low = middle } else { high = middle }
    }
    Some(Crease { at: low, width: 0.0 })
}

/// Powers of `1 - v` above this are smooth enough where they vanish.
const SMOOTH: f64 = 6.0;

/// `(F - F0) / (1 - F0)`; 0 at eta = 1, where nothing is reflected.
fn relative_fresnel(v: f64, eta: f64) -> f64 {
    let f0 = fresnel::dielectric(1.0, eta).unpolarised();
    ((fresnel::dielectric(v, eta).unpolarised() - f0) / (1.0 - f0)).max(0.0)
}
