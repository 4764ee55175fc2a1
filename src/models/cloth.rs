//! The body of cloth lobes: broad, brightest at grazing, sampled by a uniform hemisphere.
//!
//! The sources say that nothing better than uniform directions is needed; a cosine would starve the rim.

use super::{Brdf, Functional, Sample};
use crate::integrate::{BATCH, Chart, Estimate, Nodes};
use crate::math::{frame, special};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;
use std::fmt::Debug;

/// A cloth lobe.
pub trait Cloth: Debug + Send + Sync {
    /// f for two directions above the surface.
    fn value(&self, wo: DVec3, wi: DVec3) -> f64;

    /// The coordinates in which it is smooth: those of broad lobes, if nothing else is said.
    fn chart(&self) -> Chart {
        Chart::Broad { kinks: false, floor: 0.0 }
    }

    /// As [`Brdf::eval_nodes`].
    fn values(&self, nodes: &Nodes, out: &mut [f64; BATCH]) {
        let wo = nodes.wo_above();
        for (i, o) in out[..nodes.len].iter_mut().enumerate() {
            let wi = nodes.wi(i);
            *o = if frame::both_above(wo, wi) { self.value(wo, wi) } else { 0.0 };
        }
    }

    /// As [`Brdf::reduced`].
    fn reduced(&self, _mu_o: f64, _functionals: &[Functional], _tolerance: f64) -> Option<Estimate> {
        None
    }
}

/// A model that is a cloth lobe.
#[derive(Debug)]
pub struct ClothLobe<C: Cloth>(pub C);

impl<C: Cloth> Brdf for ClothLobe<C> {
    fn eval(&self, wo: DVec3, wi: DVec3) -> f64 {
        if frame::both_above(wo, wi) { self.0.value(wo, wi) } else { 0.0 }
    }

    fn sample(&self, _wo: DVec3, u: DVec2) -> Option<Sample> {
        let (cos, sin) = special::circle(u.y);
        let r = ((1.0 - u.x) * (1.0 + u.x)).max(0.0).sqrt();
        (u.x > 0.0).then(|| Sample { wi: DVec3::new(r * cos, r * sin, u.x), pdf: 1.0 / TAU })
    }

    fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        if frame::both_above(wo, wi) { 1.0 / TAU } else { 0.0 }
    }

    fn chart(&self) -> Option<Chart> {
        Some(self.0.chart())
    }

    fn eval_nodes(&self, nodes: &Nodes, out: &mut [f64; BATCH]) {
        self.0.values(nodes, out);
    }

    fn reduced(&self, mu_o: f64, functionals: &[Functional], tolerance: f64) -> Option<Estimate> {
        self.0.reduced(mu_o, functionals, tolerance)
    }
}
