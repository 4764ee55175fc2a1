//! The body of half-vector lobes that draw their normals from `D cos`: `f = F(v) D(wh) V(wo, wi)`, `v = wo . wh`.
//!
//! For distributions without a sampler of visible normals, and for visibilities that are not Smith's. The weight of a draw,
//! `F V 4 v mu_i / cos_h`, is unbounded at grazing for some; the density is exact all the same.

use super::grooves::Grooves;
use super::microfacet::Fresnel;
use super::{Brdf, Functional, Sample};
use crate::integrate::{BATCH, Chart, Estimate, Nodes};
use crate::math::frame::{self, HalfVector};
use glam::{DVec2, DVec3};
use std::fmt::Debug;

/// What tells one half-vector lobe from another.
pub trait Facets: Debug + Send + Sync {
    /// The distribution of normals, 1/sr.
    fn d(&self, wm: DVec3) -> f64;

    /// A normal with density `D cos`.
    fn sample_d(&self, u: DVec2) -> DVec3;

    /// Visibility, `G2 / (4 mu_o mu_i)` or what stands for it; both directions are above the surface.
    fn visibility(&self, wo: DVec3, wi: DVec3, h: &HalfVector) -> f64;

    /// The coordinates in which it is smooth.
    fn chart(&self) -> Option<Chart>;

    /// As [`Brdf::own_error`].
    fn own_error(&self, _mu_o: f64) -> f64 {
        0.0
    }

    /// Largest angle of a normal from the macronormal that matters to E, for V-shaped grooves: they have a
    /// rule of their own.
    fn groove_reach(&self) -> Option<f64> {
        None
    }

    /// Heights `wm.z` between which D is smooth on one scale, for grooves whose facets have a long tail.
    fn groove_heights(&self) -> Vec<f64> {
        Vec::new()
    }
}

/// A half-vector lobe.
#[derive(Debug)]
pub struct HalfVectorLobe<L: Facets> {
    /// D, V and the chart.
    pub facets: L,
    /// F.
    pub fresnel: Fresnel,
    /// True if the width is 0: a mirror, without a density.
    pub flat: bool,
}

impl<L: Facets> Brdf for HalfVectorLobe<L> {
    fn eval(&self, wo: DVec3, wi: DVec3) -> f64 {
        if self.flat || !frame::both_above(wo, wi) {
            return 0.0;
        }
        let Some(h) = frame::half_vector(wo, wi) else { return 0.0 };
        self.fresnel.at(h.cos_d) * self.facets.d(h.wh) * self.facets.visibility(wo, wi, &h)
    }

    fn sample(&self, wo: DVec3, u: DVec2) -> Option<Sample> {
        let wm = self.facets.sample_d(u);
        if wo.dot(wm) <= 0.0 {
            return None;
        }
        let wi = frame::reflect(wo, wm);
        (wi.z > 0.0).then(|| Sample { wi, pdf: self.pdf(wo, wi) })
    }

    fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        match frame::half_vector(wo, wi) {
            Some(h) if frame::both_above(wo, wi) => self.facets.d(h.wh) * h.wh.z / (4.0 * h.cos_d),
            _ => 0.0,
        }
    }

    fn chart(&self) -> Option<Chart> {
        self.facets.chart()
    }

    /// By the half vectors of the nodes: that of two directions has the rounding of both, which is a part of the width of a narrow
    /// lobe.
    fn eval_nodes(&self, nodes: &Nodes, out: &mut [f64; BATCH]) {
        let wo = nodes.wo_above();
        for (i, o) in out[..nodes.len].iter_mut().enumerate() {
            let (wi, cos_d) = (nodes.wi(i), nodes.cos_d[i]);
            *o = if !self.flat && frame::both_above(wo, wi) && cos_d > 0.0 {
                let h = HalfVector { wh: nodes.wh(i), cos_d, length_squared: 4.0 * cos_d * cos_d };
                self.fresnel.at(cos_d) * self.facets.d(h.wh) * self.facets.visibility(wo, wi, &h)
            } else {
                0.0
            };
        }
    }

    fn reduced(&self, mu_o: f64, functionals: &[Functional], tolerance: f64) -> Option<Estimate> {
        let reach = self.facets.groove_reach()?;
        let d = |wm| self.facets.d(wm);
        let heights = self.facets.groove_heights();
        Some(Grooves { d: &d, heights: &heights, reach, fresnel: self.fresnel }.integrate(
            mu_o,
            functionals,
            tolerance,
        ))
    }

    fn own_error(&self, mu_o: f64) -> f64 {
        if self.flat { 0.0 } else { self.facets.own_error(mu_o) }
    }

    fn mirror(&self, mu_o: f64) -> Option<f64> {
        self.flat.then(|| self.fresnel.at(mu_o))
    }
}

/// V-cavity visibility, `min(1, 2 h.z mu / v) / (4 mu_o mu_i)` with the minimum taken before the division.
pub(super) fn vcavity_visibility(wo: DVec3, wi: DVec3, h: &HalfVector) -> f64 {
    let larger = wo.z.max(wi.z);
    // min(1 / (mu_o mu_i), 2 h.z / (v larger)): the small cosine cancels in the second
    let open = 1.0 / (wo.z * wi.z);
    0.25 * open.min(2.0 * h.wh.z / (h.cos_d * larger))
}
