//! The body of rough dielectric interfaces that reflect and transmit.
//!
//! Both parts are integrated over facet normals, with `wo` fixed; T in the chart of [`refracted`]:
//!
//! ```text
//! R(mu) = int F D 4 c V mu_i dwm,  T(mu) = int (1 - F) D c G2(wo, wt) / mu dwm,  c = wo . wm
//! ```
//! R and T are the parts of the flux that arrives along `wo`; R + T <= 1, the rest is masked.

use super::microfacet::{Distribution, Fresnel, Masking};
use super::{Brdf, Btdf, Param, ParamError, Params, Sample};
use crate::integrate::refracted::{self, Facet, Interface};
use crate::integrate::stop::{Level, climb_sure};
use crate::integrate::{BATCH, Chart, Estimate, Nodes, View, ladder};
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

    /// The sums of T at a level of its chart.
    fn transmitted_albedo(&self, view: View, level: f64, out: &mut Level) {
        let wo = view.direction();
        let hidden = self.distribution.mu_lambda(wo);
        let mut count = 0;
        refracted::visit(view, &self.interface(), level, &mut |f: &Facet| {
            count += 1;
            let through = fresnel::transmittance_between(f.cos, f.cos_t, self.eta).unpolarised();
            let masked = self.g2_over_mu(wo, hidden, f.wt);
            out.panel(f.panel)[0] += f.weight * f.cos * through * self.distribution.d(f.wm) * masked;
        });
        out.count(count);
    }

    fn interface(&self) -> Interface {
        Interface { alpha: self.distribution.widths(), reach: self.distribution.reach(), eta: self.eta }
    }

    /// `G2(wo, wt) / mu_o`, finite at grazing; `hidden` is [`mu_lambda`](crate::terms::smith::Ndf::mu_lambda) of wo.
    fn g2_over_mu(&self, wo: DVec3, hidden: f64, wt: DVec3) -> f64 {
        let (mu, mu_t) = (wo.z, wt.z.abs());
        let quotient = |a: f64, b: f64| if b > 0.0 { a / b } else { 0.0 };
        match self.across {
            Across::Separable => quotient(mu_t, (mu + hidden) * (mu_t + self.distribution.mu_lambda(wt))),
            Across::Sum => {
                let hidden_t = self.distribution.mu_lambda(wt);
                quotient(mu_t, mu * mu_t + (mu * hidden_t + mu_t * hidden))
            }
            Across::Beta => quotient(refraction::g2(self.across, &self.distribution, wo, wt), mu),
        }
    }
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

    fn albedo(&self, view: View, tolerance: f64) -> Estimate {
        if self.flat {
            return Estimate::exact_one(fresnel::dielectric_transmittance(view.mu, self.eta).unpolarised());
        }
        let view = if self.turns() { view } else { view.in_plane() };
        let levels = ladder::first_level(tolerance)..ladder::LEVELS.len();
        climb_sure(self.interface().trust(), levels, 1, tolerance, |j, level| {
            self.transmitted_albedo(view, ladder::LEVELS[j], level);
        })
    }
}
