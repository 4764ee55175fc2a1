//! The shared body of diffuse models: drawn by the cosine, integrated by a chart or in closed form.

use crate::integrate::{Chart, Estimate};
use crate::math::{frame, special};
use crate::models::{Brdf, Functional, Sample};
use glam::{DVec2, DVec3};
use std::f64::consts::FRAC_1_PI;
use std::fmt::Debug;

/// A diffuse lobe: what its model file says of it.
pub trait Reflector: Debug + Send + Sync {
    /// f in 1/sr for two directions above the surface.
    fn f(&self, wo: DVec3, wi: DVec3) -> f64;

    /// Directional albedo in closed form, if there is one; also at `mu_o` = 0.
    fn albedo(&self, _mu_o: f64) -> Option<f64> {
        None
    }

    /// Directional albedo by a rule that is better than the chart, if there is one.
    fn reduced(&self, _mu_o: f64, _tolerance: f64) -> Option<Estimate> {
        None
    }

    /// As [`Brdf::own_error`].
    fn own_error(&self, _mu_o: f64) -> f64 {
        0.0
    }

    /// Where the lobe is not smooth.
    fn chart(&self) -> Option<Chart>;
}

/// A [`Reflector`] as a model.
#[derive(Debug)]
pub struct Diffuse<R: Reflector>(pub R);

impl<R: Reflector> Brdf for Diffuse<R> {
    fn eval(&self, wo: DVec3, wi: DVec3) -> f64 {
        if frame::both_above(wo, wi) { self.0.f(wo, wi) } else { 0.0 }
    }

    fn sample(&self, _wo: DVec3, u: DVec2) -> Option<Sample> {
        cosine_sample(u)
    }

    fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        cosine_pdf(wo, wi)
    }

    fn chart(&self) -> Option<Chart> {
        self.0.chart()
    }

    fn reduced(&self, mu_o: f64, functionals: &[Functional], tolerance: f64) -> Option<Estimate> {
        let [Functional::One] = functionals else { return None };
        let Some(albedo) = self.0.albedo(mu_o) else { return self.0.reduced(mu_o, tolerance) };
        let mut e = Estimate::exact_one(albedo);
        e.error[0] += self.0.own_error(mu_o);
        Some(e)
    }

    fn own_error(&self, mu_o: f64) -> f64 {
        self.0.own_error(mu_o)
    }
}

/// A direction with density `mu_i / pi`: sin^2 = u1, azimuth 2 pi u2. `None` in the horizon.
#[must_use]
pub fn cosine_sample(u: DVec2) -> Option<Sample> {
    let (cos, sin) = special::circle(u.y);
    let r = u.x.sqrt();
    let z = (1.0 - u.x).max(0.0).sqrt();
    (z > 0.0).then(|| Sample { wi: DVec3::new(r * cos, r * sin, z), pdf: z * FRAC_1_PI })
}

/// Density of [`cosine_sample`], 1/sr.
#[must_use]
pub fn cosine_pdf(wo: DVec3, wi: DVec3) -> f64 {
    if frame::both_above(wo, wi) { wi.z * FRAC_1_PI } else { 0.0 }
}
