//! The part of the flux that crosses a rough interface, over facet slopes as in [`crate::sweep::facets`].
//!
//! `T = int P22 (1 - F) (c + s x) G2(wo, wt) / mu_o dx dy` over the facets that face wo and refract across.

use crate::sweep::facets::quadratic;
use crate::sweep::quad::{Edge, Setting, Sum, mark, sharp, sorted};
use brdfbake::terms::fresnel;
use brdfbake::terms::refraction::{self, Across};
use brdfbake::terms::smith::Ndf;
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI};

/// An isotropic interface seen from above.
pub(crate) struct Interface {
    pub(crate) mu: f64,
    pub(crate) alpha: f64,
    pub(crate) eta: f64,
    pub(crate) across: Across,
    pub(crate) ndf: Box<dyn Ndf>,
    /// Density of slopes in units of the width, times rho^2.
    pub(crate) density: fn(f64, f64) -> f64,
    pub(crate) end: f64,
}

impl Interface {
    fn sine(&self) -> f64 {
        ((1.0 - self.mu) * (1.0 + self.mu)).sqrt()
    }

    fn critical(&self) -> f64 {
        if self.eta < 1.0 { ((1.0 - self.eta) * (1.0 + self.eta)).sqrt() } else { 0.0 }
    }

    pub(crate) fn integrate(&self, setting: &Setting, tolerance: f64) -> Sum {
        let (c, s) = (self.mu, self.sine());
        let mut breaks = vec![FRAC_PI_2];
        if self.eta < 1.0 {
            let line = self.critical();
            for kappa in [(line * line - c * c).max(0.0).sqrt(), line, self.eta] {
                if kappa <= s {
                    breaks.extend([(kappa / s).acos(), PI - (kappa / s).acos()]);
                }
            }
        }
        let breaks = sorted(mark(0.0), mark(PI), breaks.into_iter().map(sharp).collect());
        let mut sum = setting.pieces(&breaks, tolerance, &mut |at, tolerance, _| {
            self.ray(
                setting,
                if at.x > 1.5 && at.x < 1.65 { (FRAC_PI_2 - at.x).sin() } else { at.x.cos() },
                tolerance,
            )
        });
        sum.value *= 2.0;
        sum.error *= 2.0;
        sum
    }

    /// The facets of one azimuth: cosine to the plane of incidence.
    fn ray(&self, setting: &Setting, cos: f64, tolerance: f64) -> f64 {
        let (c, a) = (self.mu, self.alpha);
        let sp = self.sine() * cos * a;
        // facets that look away
        let last = if sp < 0.0 { (c / -sp).min(self.end) } else { self.end };
        let away = sp < 0.0 && c / -sp <= self.end;
        let mut inner = vec![mark(1.0)];
        if self.eta < 1.0 {
            let line = self.critical();
            inner.extend(
                quadratic(sp * sp - line * line * a * a, c * sp, (c - line) * (c + line))
                    .into_iter()
                    .filter(|rho| c + sp * rho > 0.0)
                    .map(sharp),
            );
            let known = sorted(mark(0.0), mark(last), inner.clone());
            for pair in known.windows(2) {
                self.crossings(sp, pair[0].at, pair[1].at, &mut inner);
            }
        }
        let breaks = sorted(sharp(0.0), Edge { at: last, sharp: away }, inner);
        let count = breaks.len() - 2;
        setting
            .pieces(&breaks, tolerance, &mut |at, _, i| {
                let facing = if away && i == count { -sp * at.to } else { c + sp * at.x };
                self.at(cos, at.x, facing)
            })
            .value
    }

    /// Where the refracted direction passes the horizon.
    fn crossings(&self, sp: f64, from: f64, to: f64, found: &mut Vec<Edge>) {
        let lo = if from > 0.0 { from } else { 1e-12_f64.min(0.1 * to) };
        let count = 48;
        let at = |k: u32| lo * (to.min(1e30) / lo).powf(f64::from(k) / f64::from(count));
        let height = |rho: f64| self.refracted(sp, rho, self.mu + sp * rho).map(|(z, ..)| z);
        for k in 0..count {
            let (mut x, mut y) = (at(k), at(k + 1));
            let (Some(low), Some(high)) = (height(x), height(y)) else { continue };
            if (low < 0.0) == (high < 0.0) {
                continue;
            }
            for _ in 0..70 {
                let middle = 0.5 * (x + y);
                if height(middle).is_some_and(|z| (z < 0.0) == (low < 0.0)) { x = middle } else { y = middle }
            }
            found.push(sharp(x));
        }
    }

    /// Height of the refracted direction, its factor of wm, and the cosine to the facet.
    fn refracted(&self, _sp: f64, rho: f64, facing: f64) -> Option<(f64, f64, f64)> {
        let root = (rho * self.alpha).hypot(1.0);
        let v = (facing / root).min(1.0);
        let cos_t = fresnel::cos_refracted(v, self.eta)?;
        let factor = (1.0 - self.eta) * (1.0 + self.eta) / (self.eta * self.eta) / (v / self.eta + cos_t);
        Some((factor / root - self.mu / self.eta, factor, v))
    }

    fn at(&self, cos: f64, rho: f64, facing: f64) -> f64 {
        if !(facing > 0.0) {
            return 0.0;
        }
        let Some((z, factor, v)) = self.refracted(0.0, rho, facing) else { return 0.0 };
        if !(z < 0.0) {
            return 0.0;
        }
        let r = rho * self.alpha;
        let root = r.hypot(1.0);
        let sin = ((1.0 - cos) * (1.0 + cos)).max(0.0).sqrt();
        let (wo, wm) = (DVec3::new(self.sine(), 0.0, self.mu), DVec3::new(r * cos, r * sin, 1.0) / root);
        let wt = factor * wm - wo / self.eta;
        let wt = DVec3::new(wt.x, wt.y, z);
        let through = fresnel::dielectric_transmittance(v, self.eta).unpolarised();
        (self.density)(rho, 2.0) / rho * through * facing * self.masking_over_mu(wo, wt)
    }

    /// `G2 / mu_o`.
    fn masking_over_mu(&self, wo: DVec3, wt: DVec3) -> f64 {
        let mu_t = -wt.z;
        match self.across {
            Across::Separable => mu_t / (self.ndf.facing_area(wo) * self.ndf.facing_area(wt)),
            Across::Sum => mu_t / self.ndf.masked_area(wo, wt),
            Across::Beta => {
                if self.mu > 0.0 {
                    refraction::g2(self.across, &*self.ndf, wo, wt) / self.mu
                } else {
                    0.0
                }
            }
        }
    }
}
