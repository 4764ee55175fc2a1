//! Light that fog scatters once on its way from a lamp to a surface: Sun and others, 2005.
//!
//! All the light of [`airlight`](super::airlight), weighted by the n-th power of the cosine to an axis that is theta away from the lamp
//! (the normal for n = 1, the mirrored view for the lobe of Phong), is `beta I / (2 pi D) G_n`:
//!
//! ```text
//! G_n(T, theta) = int e^(-T cos gamma) / sin gamma (F(T sin gamma, pi/2) - F(T sin gamma, gamma / 2)) max(0, cos)^n dw
//!               = int_0^pi e^-T int_(gamma/2)^(pi/2) exp(-T sin gamma (tan xi - tan(gamma / 2))) dxi C_n(gamma, theta) dgamma
//! ```
//! where C_n is the integral of the power over the azimuth round the lamp: the singularity in the direction of the lamp is gone.

use super::airlight::{RULE, fading, inner_breaks};
use super::default_axes::axis;
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, OwnNumber, Quadrature, Role, Source, Spec,
    TableInfo, TexelError,
};
use crate::cite;
use crate::grid::Warp;
use crate::integrate::{Estimate, line};
use crate::models::{DefaultValue, Param};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "airlight-surface",
    title: "Light that fog scatters once towards a surface",
    formula: "G_n = int e^(-tau cos g) / sin g (F(tau sin g, pi/2) - F(tau sin g, g/2)) max(0, cos)^n dw, F as airlight has it",
    sources: &[Source::new(cite::SUN_2005, "section 5, G_0 and G_n; derived again in the docs of the kind")],
    coordinates: &["tau", "mu_i"],
    layouts: &[Layout {
        id: "surface",
        doc: "the light of the fog on a surface; n = 1 for a diffuse one",
        channels: &[ChannelInfo {
            id: "airlight.g",
            meaning: "G_n(tau, acos(mu_i)); the irradiance is beta I / (2 pi D) times that of n = 1",
            range: [0.0, PI * (FRAC_PI_2 + 1.0)],
            role: Role::Own(&SURFACE),
        }],
    }],
    mix: Mix::Layouts,
    model: ModelUse::None,
    params: &[Param::number(
        "n",
        "n",
        "power of the cosine: 1 for the irradiance, else that of a lobe of Phong",
        [1.0, 1000.0],
        DefaultValue::Value(1.0),
    )],
    laws: &["finite", "range", "monotone", "honest"],
    axes: |_| {
        let tau = axis("tau", 64, [0.0, 10.0], Warp::Power(0.25));
        tau.into_iter().chain(axis("mu_i", 64, [0.0, 1.0], Warp::Linear)).collect()
    },
    least_tolerance: |_| 0.0,
    blended: true,
    notes: "Scattering is isotropic with albedo 1: multiply by the albedo of the medium. tau is beta D, D the distance of the lamp; mu_i \
        the cosine between the axis and the lamp. The paper calls n = 1 G_0, and leaves another power of beta D in front.",
    bind,
};

static SURFACE: OwnNumber = OwnNumber {
    name: "light of fog on a surface",
    trend: Some(("tau", -1.0)),
    truth: |spec, at, target, quad| {
        let (tau, mu) = (at[spec.axis("tau")?], at[spec.axis("mu_i")?]);
        let axis = Axial { cos: mu, n: spec.number("n", at).ok()? };
        let theta = libm::acos(mu);
        let inner = target / 100.0;
        let mut off = 0.0f64;
        let (value, error) = quad(&axis.breaks(theta), 0.5 * target, &mut |gamma| {
            let (along, e) = along_ray(tau, gamma, inner, quad);
            let (round, r) = axis.by(gamma, inner, quad);
            off = off.max(e * round + r * along);
            along * round
        });
        Some((value, error + PI * off))
    },
};

/// `e^-tau int_(gamma/2)^(pi/2) ...` along the ray itself: at `cos gamma + sin gamma sinh w` from the eye, in units of D.
fn along_ray(tau: f64, gamma: f64, target: f64, quad: &Quadrature<'_>) -> (f64, f64) {
    let (sin, cos) = libm::sincos(gamma);
    let first = if sin > 0.0 { libm::asinh(-cos / sin).max(-FAR) } else { -cos.signum() * FAR };
    let fade = libm::log(1.0 / (tau * sin + 1e-300)).clamp(-FAR, FAR);
    let breaks = inner_breaks(first, FAR, [-8.0, 0.0, 8.0, fade]);
    let (value, error) = quad(&breaks, target, &mut |w| {
        0.5 * libm::exp(-tau * (cos + sin * libm::exp(w)).max(0.0)) / libm::cosh(w)
    });
    (value, error + 1e-16)
}

/// Where 1 / cosh has no digits left.
const FAR: f64 = 38.0;

/// The n-th power of the cosine to an axis.
struct Axial {
    /// Of the angle between the axis and the lamp.
    cos: f64,
    n: f64,
}

impl Axial {
    /// `cos = a + b cos(phi)` at an azimuth, and the last azimuth at which it is positive.
    fn parts(&self, gamma: f64) -> (f64, f64, f64) {
        let (sin, cos) = libm::sincos(gamma);
        let (a, b) = (cos * self.cos, sin * ((1.0 - self.cos) * (1.0 + self.cos)).sqrt());
        let last = if a >= b { PI } else { libm::acos((-a / b).clamp(-1.0, 1.0)) };
        (a, b, if a <= -b { 0.0 } else { last })
    }

    /// `C_n`, as the bakers have it: closed for n = 1.
    fn round(&self, gamma: f64, tolerance: f64) -> (f64, f64) {
        let (a, b, last) = self.parts(gamma);
        if self.n <= 1.0 {
            return (2.0 * (a * last + b * libm::sin(last)), 1e-15);
        }
        let e = line::integrate(&self.azimuths(last), 1, tolerance, &mut |phi, out| {
            out[0] = 2.0 * libm::pow((a + b * libm::cos(phi)).max(0.0), self.n);
        });
        (e.value[0], e.error[0])
    }

    /// `C_n` by another quadrature.
    fn by(&self, gamma: f64, target: f64, quad: &Quadrature<'_>) -> (f64, f64) {
        let (a, b, last) = self.parts(gamma);
        quad(&self.azimuths(last), target, &mut |phi| {
            2.0 * libm::pow((a + b * libm::cos(phi)).max(0.0), self.n)
        })
    }

    fn azimuths(&self, last: f64) -> Vec<f64> {
        inner_breaks(0.0, last, [1.0, 3.0, 9.0, 27.0].map(|k| k / self.n.sqrt()))
    }

    /// Ends of panels over gamma: kinks where the horizon of the axis begins and ends, and the scale of the power.
    fn breaks(&self, theta: f64) -> Vec<f64> {
        let width = 1.0 / self.n.sqrt();
        let mut all = vec![0.0, PI, FRAC_PI_2 - theta, FRAC_PI_2 + theta, theta];
        all.extend([-6.0, -2.0, 2.0, 6.0].map(|k| theta + k * width));
        all.retain(|b| (0.0..=PI).contains(b));
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    }
}

struct Surface {
    tau: usize,
    mu: usize,
    n: f64,
    swept: Option<usize>,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    let (tau, mu) = (spec.coordinate("tau")?, spec.coordinate("mu_i")?);
    Ok(Box::new(Surface { tau, mu, n: spec.params.number("n")?, swept: spec.axis("n") }))
}

impl Surface {
    /// The outer integral, and the errors of the inner ones at their worst.
    fn light(tau: f64, axis: &Axial, tolerance: f64) -> Estimate {
        // C_n is at most 2 pi, the inner integral at most pi/2
        let part = 0.02 * tolerance / TAU;
        let (mut off, mut inner) = (0.0f64, 0u32);
        let depth = libm::exp(-tau);
        let breaks = axis.breaks(libm::acos(axis.cos));
        let mut e = line::integrate(&breaks, 1, 0.5 * tolerance, &mut |gamma, out| {
            let ray = fading(tau * libm::sin(gamma), 0.5 * gamma, FRAC_PI_2, part);
            let (round, error) = axis.round(gamma, part);
            off = off.max(depth * (ray.error[0] * round + ray.value[0] * error));
            inner = inner.saturating_add(ray.evaluations);
            out[0] = depth * ray.value[0] * round;
        });
        e.error[0] += PI * off;
        e.evaluations = inner;
        e
    }
}

impl Baker for Surface {
    fn texel(&self, at: &[f64], tolerance: f64) -> Result<Estimate, TexelError> {
        let axis = Axial { cos: at[self.mu], n: self.swept.map_or(self.n, |i| at[i]) };
        super::finite(Surface::light(at[self.tau], &axis, tolerance), 1)
    }

    fn rule(&self) -> String {
        RULE.to_owned()
    }
}
