//! The Fresnel factor of a microfacet model.

use crate::integrate::{BATCH, Nodes};
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
