//! The body of rough dielectric interfaces that reflect and transmit.
//!
//! Both parts are integrated over facet normals in [`facet`] coordinates, with `wo` fixed:
//!
//! ```text
//! R(mu) = int F D 4 c V mu_i dwm,  T(mu) = int (1 - F) D c G2(wo, wt) / mu dwm,  c = wo . wm
//! ```
//! R and T are the parts of the flux that arrives along `wo`; R + T <= 1, the rest is masked.

use super::microfacet::{Distribution, Fresnel, Masking};
use super::{Brdf, Btdf, Param, ParamError, Params, Sample};
use crate::integrate::facet::{self, Facet};
use crate::integrate::stop::{Level, Trust, climb_sure};
use crate::integrate::{BATCH, Chart, Estimate, Nodes};
use crate::math::frame;
use crate::terms::fresnel;
use crate::terms::refraction::{self, Across};
use glam::{DVec2, DVec3};

/// `masking` of an interface.
pub(super) const ACROSS: Param = Param::choice(
    "masking",
    "G1 G1 (separable); B(1 + Lambda_o, 1 + Lambda_i) across the surface (beta) or 1 / (1 + Lambda_o + Lambda_i) (sum), both with \
     1 / (1 + Lambda_o + Lambda_i) for reflection",
    &["separable", "beta", "sum"],
);

/// Levels of the rule: 4 nodes each in both coordinates of each panel.
const LEVELS: [f64; 11] = [2.0, 3.0, 4.5, 6.5, 9.0, 12.0, 16.0, 21.0, 27.0, 34.0, 43.0];

/// Trust in it.
const TRUST: Trust = Trust { gain: &[1.0], memory: &[0.3] };

/// Widths below which the coarsest levels see nothing of a peak at grazing views, and those views.
const NARROW: [f64; 2] = [1e-4, 0.01];

/// A rough dielectric interface.
#[derive(Debug)]
pub struct Glass<D: Distribution> {
    /// Facet normals.
    pub distribution: D,
    /// True if the widths are 0, or nothing changes across it: a smooth interface, or none.
    pub flat: bool,
    /// Index below over that above.
    pub eta: f64,
    /// Masking.
    pub across: Across,
}

/// Is the index the same on both sides? There is nothing then that facets could mask.
pub(super) fn no_interface(eta: f64) -> bool {
    (eta - 1.0).abs() == 0.0
}

/// The masking that the parameters name.
///
/// # Errors
/// [`ParamError`] where none is declared.
pub(super) fn across(params: &Params) -> Result<Across, ParamError> {
    Ok(match params.choice("masking")? {
        "separable" => Across::Separable,
        "beta" => Across::Beta,
        _ => Across::Sum,
    })
}

impl<D: Distribution> Glass<D> {
    fn masking(&self) -> Masking {
        if self.across == Across::Separable { Masking::Separable } else { Masking::Correlated }
    }

    /// Reflection of two directions above the surface, seen from a side: +1 above, -1 below.
    fn reflected(&self, wo: DVec3, wi: DVec3, side: f64) -> f64 {
        let Some(h) = frame::half_vector(wo, wi) else { return 0.0 };
        fresnel::dielectric(side * h.cos_d, self.eta).unpolarised()
            * self.distribution.d(h.wh)
            * self.masking().visibility(&self.distribution, wo, wi)
    }

    /// Ends of the panels in c for T.
    fn transmission_breaks(&self, mu: f64) -> Vec<f64> {
        let s = ((1.0 - mu) * (1.0 + mu)).sqrt();
        let mut breaks = vec![mu, s];
        let start = if self.eta < 1.0 { fresnel::cos_critical(self.eta) } else { 0.0 };
        if self.eta < 1.0 {
            // where the refracted direction of a facet in the plane of incidence passes the horizon
            let height = |c: f64, sign: f64| {
                let sin = ((1.0 - c) * (1.0 + c)).sqrt();
                c * mu + sign * sin * s - self.highest(c, mu)
            };
            for sign in [1.0, -1.0] {
                breaks.extend(roots(start, 1.0, |c| height(c, sign)));
            }
        }
        between(start, breaks)
    }

    /// From the denser side: the height `wm.z` above which a facet refracts to the upper side.
    fn highest(&self, c: f64, mu: f64) -> f64 {
        let r = 1.0 / self.eta;
        let cos_t = fresnel::cos_refracted(c, self.eta).unwrap_or(0.0);
        // r mu / (r c - cos_t) = r mu (r c + cos_t) / (r^2 - 1)
        r * mu * (r * c + cos_t) / ((r - 1.0) * (r + 1.0))
    }

    fn transmitted_albedo(&self, mu: f64, level: f64, out: &mut Level) {
        let wo = frame::from_mu(mu);
        let mut add = |f: &Facet| {
            out.count(1);
            let Some(wt) = fresnel::refract(wo, f.wm, self.eta) else { return };
            if wt.z < 0.0 && f.wm.z > 0.0 {
                let through = fresnel::dielectric_transmittance(f.cos, self.eta).unpolarised();
                out.panel(f.panel)[0] +=
                    f.weight * through * self.distribution.d(f.wm) * f.cos * self.g2_over_mu(wo, wt);
            }
        };
        let range = |row: &facet::Row| {
            let from = if self.eta < 1.0 { row.azimuth_of_height(self.highest(row.c, mu)) } else { 0.0 };
            (from, row.horizon())
        };
        facet::visit(mu, &self.transmission_breaks(mu), level, &range, &mut add);
    }

    /// `G2(wo, wt) / mu_o`, finite at grazing.
    fn g2_over_mu(&self, wo: DVec3, wt: DVec3) -> f64 {
        let (mu, mu_t) = (wo.z, wt.z.abs());
        let quotient = |a: f64, b: f64| if b > 0.0 { a / b } else { 0.0 };
        match self.across {
            Across::Separable => {
                let area = self.distribution.facing_area(wo) * self.distribution.facing_area(wt);
                quotient(mu_t, area)
            }
            Across::Sum => quotient(mu_t, self.distribution.masked_area(wo, wt)),
            Across::Beta => quotient(refraction::g2(self.across, &self.distribution, wo, wt), mu),
        }
    }
}

/// The breaks in (start, 1), in order, with both ends.
fn between(start: f64, mut breaks: Vec<f64>) -> Vec<f64> {
    breaks.retain(|b| *b > start && *b < 1.0);
    breaks.extend([start, 1.0]);
    breaks.sort_by(f64::total_cmp);
    breaks.dedup();
    breaks
}

/// Sign changes of a function in 64 steps, refined by bisection.
fn roots(lo: f64, hi: f64, f: impl Fn(f64) -> f64) -> Vec<f64> {
    let at = |i: u32| lo + (hi - lo) * f64::from(i) / 64.0;
    let mut found = Vec::new();
    for i in 0..64 {
        let (mut a, mut b) = (at(i), at(i + 1));
        let sign = f(a) > 0.0;
        if sign == (f(b) > 0.0) {
            continue;
        }
        for _ in 0..60 {
            let mid = 0.5 * (a + b);
            if (f(mid) > 0.0) == sign { a = mid } else { b = mid }
        }
        found.push(a);
    }
    found
}

impl<D: Distribution> Brdf for Glass<D> {
    /// Reflection for directions on one side, transmission for directions on opposite sides.
    fn eval(&self, wo: DVec3, wi: DVec3) -> f64 {
        if self.flat || wo.z * wi.z == 0.0 {
            return 0.0;
        }
        if wo.z * wi.z < 0.0 {
            return refraction::value(&self.distribution, self.across, self.eta, wo, wi);
        }
        let side = 1.0_f64.copysign(wo.z);
        let up = |w: DVec3| DVec3::new(w.x, w.y, w.z.abs());
        self.reflected(up(wo), up(wi), side)
    }

    fn sample(&self, wo: DVec3, u: DVec2) -> Option<Sample> {
        let wi = frame::reflect(wo, self.distribution.sample_visible(wo, u));
        (wi.z > 0.0).then(|| Sample { wi, pdf: Brdf::pdf(self, wo, wi) })
    }

    fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        match frame::half_vector(wo, wi) {
            Some(h) if frame::both_above(wo, wi) => self.distribution.d_visible(wo, h.wh) / (4.0 * h.cos_d),
            _ => 0.0,
        }
    }

    /// From the denser side total reflection is a crease.
    fn chart(&self) -> Option<Chart> {
        Some(Chart::facets(Fresnel::Dielectric { eta: self.eta }.marks(self.distribution.facets())))
    }

    fn eval_nodes(&self, nodes: &Nodes, out: &mut [f64; BATCH]) {
        self.distribution.dv_nodes(nodes, self.masking(), out);
        Fresnel::Dielectric { eta: self.eta }.scale_nodes(nodes, out);
    }

    fn turns(&self) -> bool {
        self.distribution.alpha().is_none()
    }

    fn mirror(&self, mu_o: f64) -> Option<f64> {
        self.flat.then(|| fresnel::dielectric(mu_o, self.eta).unpolarised())
    }

    fn transmission(&self) -> Option<&dyn Btdf> {
        Some(self)
    }
}

impl<D: Distribution> Btdf for Glass<D> {
    fn eval(&self, wo: DVec3, wi: DVec3) -> f64 {
        if self.flat || wo.z * wi.z >= 0.0 {
            return 0.0;
        }
        refraction::value(&self.distribution, self.across, self.eta, wo, wi)
    }

    fn sample(&self, wo: DVec3, u: DVec2) -> Option<Sample> {
        let wm = self.distribution.sample_visible(wo, u);
        if self.flat || wo.z <= 0.0 || wo.dot(wm) <= 0.0 {
            return None;
        }
        let wi = fresnel::refract(wo, wm, self.eta)?;
        (wi.z < 0.0).then(|| Sample { wi, pdf: Btdf::pdf(self, wo, wi) })
    }

    fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        if self.flat || wo.z <= 0.0 {
            return 0.0;
        }
        // the Jacobian of the facet has n_o^2, that of the sampled side has n_i^2 = eta^2 of it
        refraction::facet(wo, wi, self.eta).map_or(0.0, |f| {
            self.distribution.d_visible(wo, f.wm) * f.jacobian * self.eta * self.eta * f.cos_i.abs()
        })
    }

    fn albedo(&self, mu_o: f64, tolerance: f64) -> Option<Estimate> {
        if self.flat {
            return Some(Estimate::exact_one(
                fresnel::dielectric_transmittance(mu_o, self.eta).unpolarised(),
            ));
        }
        let alpha = self.distribution.alpha()?;
        let hidden = alpha < NARROW[0] && mu_o < NARROW[1];
        let finer = [hidden, tolerance < 1e-3, tolerance < 1e-6, tolerance < 1e-9];
        let first = finer.into_iter().filter(|f| *f).count();
        Some(climb_sure(TRUST, first..LEVELS.len(), 1, tolerance, |j, level| {
            self.transmitted_albedo(mu_o, LEVELS[j], level);
        }))
    }
}
