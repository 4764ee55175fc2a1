//! The Fresnel factor of a microfacet model.

use crate::integrate::{BATCH, Crease, FacetLobe, Nodes};
use crate::terms::{fresnel, schlick};

/// Which Fresnel factor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fresnel {
    /// `F0 + (F90 - F0)(1 - v)^5`; F0 = F90 = 1 is the white model.
    Schlick {
        /// Reflectance at normal incidence.
        f0: f64,
        /// Reflectance at grazing incidence.
        f90: f64,
    },
    /// The exact dielectric, unpolarised.
    Dielectric {
        /// Relative index.
        eta: f64,
    },
    /// The exact conductor, unpolarised.
    Conductor {
        /// Real part of the relative index.
        eta: f64,
        /// Extinction coefficient.
        k: f64,
    },
}

/// A branch point farther than this from the real cosines leaves F smooth for the rules.
const FELT: f64 = 0.2;

impl Fresnel {
    /// F at `v = wo . wh`.
    #[must_use]
    pub fn at(&self, v: f64) -> f64 {
        match *self {
            Fresnel::Schlick { f0, f90 } => schlick::schlick(f0, f90, v),
            Fresnel::Dielectric { eta } => fresnel::dielectric(v, eta).unpolarised(),
            Fresnel::Conductor { eta, k } => fresnel::conductor(v, eta, k).unpolarised(),
        }
    }

    /// The value if F does not depend on the angle.
    #[must_use]
    pub fn constant(&self) -> Option<f64> {
        match *self {
            Fresnel::Schlick { f0, f90 } if (f0 - f90).abs() == 0.0 => Some(f0),
            _ => None,
        }
    }

    /// Where F has the branch point of its square root near the directions that are integrated over.
    ///
    /// `sqrt(N^2 - 1 + v^2)` vanishes at `v^2 = 1 - N^2`: for a dielectric seen from the denser side at the cosine of the
    /// critical angle, for a conductor with n < 1 and a small k at a complex v near it.
    #[must_use]
    pub fn crease(&self) -> Option<Crease> {
        let (n, k) = self.index()?;
        // v^2 = x - i y, v = p - i q
        let (x, y) = ((1.0 - n) * (1.0 + n) + k * k, 2.0 * n * k);
        let length = libm::hypot(x, y);
        let at = (0.5 * (length + x)).max(0.0).sqrt();
        let width = if at > 0.0 { 0.5 * y / at } else { f64::INFINITY };
        (at > 0.0 && at < 1.0 + FELT && width < FELT).then_some(Crease { at: at.min(1.0), width })
    }

    /// Width in v over which F changes at grazing incidence: the distance of its nearest singularity.
    ///
    /// The parallel part has its pole at `v = -1 / sqrt(N^2 + 1)`; the branch point is a matter of [`Fresnel::crease`] where it is near
    /// the real cosines, else at the distance `|sqrt(N^2 - 1)|`.
    #[must_use]
    pub fn slope(&self) -> f64 {
        let Some((n, k)) = self.index() else { return f64::INFINITY };
        let from = |one: f64| libm::hypot((n - k) * (n + k) + one, 2.0 * n * k).sqrt();
        let branch = if self.crease().is_some() { f64::INFINITY } else { from(-1.0) };
        (1.0 / from(1.0)).min(branch)
    }

    /// What the chart of facets must know of F.
    #[must_use]
    pub fn marks(&self, facets: FacetLobe) -> FacetLobe {
        FacetLobe { crease: self.crease(), slope: self.slope(), ..facets }
    }

    /// Real and imaginary part of the relative index.
    fn index(&self) -> Option<(f64, f64)> {
        match *self {
            Fresnel::Schlick { .. } => None,
            Fresnel::Dielectric { eta } => Some((eta, 0.0)),
            Fresnel::Conductor { eta, k } => Some((eta, k)),
        }
    }

    /// Multiplies a batch by F.
    pub fn scale_nodes(&self, nodes: &Nodes, out: &mut [f64; BATCH]) {
        if self.constant().is_some_and(|c| (c - 1.0).abs() == 0.0) {
            return;
        }
        for (o, v) in out[..nodes.len].iter_mut().zip(&nodes.cos_d) {
            *o *= self.at(*v);
        }
    }
}
