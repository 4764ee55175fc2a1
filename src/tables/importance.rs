//! Directions that sample a model: the inverse of its own cumulative distribution, for any model.
//!
//! For a view, light directions have the density `f(wo, wi) mu_i / E`. It is split as Lawrence and others split theirs:
//! the first number u chooses the angle theta by the marginal `m(theta) = sin cos int f dphi`, the second one v the
//! azimuth by the conditional density at that theta. The azimuth runs from wo (v = 0) over the mirror direction (v = 1/2
//! for isotropic models) back to wo: the map is continuous but for that seam.
//!
//! Both cumulative distributions are pieces of Legendre series ([`crate::integrate::density`]), made to a part of the tolerance until the
//! direction itself, moved by what they leave out, stays within the tolerance.

use super::role::{Component, Lobe};
use super::sweep::Sweep;
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Setting, Source, Spec, TableInfo, TexelError,
};
use crate::cite;
use crate::grid::{Axis, Quantity, Texel};
use crate::integrate::density::Density;
use crate::integrate::{Estimate, MAX_CHANNELS, View, line};
use crate::models::Brdf;
use glam::DVec3;
use std::collections::HashMap;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::{Arc, Mutex, PoisonError};

const fn channel(id: &'static str, meaning: &'static str, component: Component) -> ChannelInfo {
    let range = match component {
        Component::X | Component::Y => [-1.0, 1.0],
        Component::Z => [0.0, 1.0],
        Component::Azimuth => [0.0, TAU],
    };
    ChannelInfo { id, meaning, range, role: Role::Direction(Lobe::Model, component) }
}

const X: ChannelInfo = channel("wi.x", "x of the light direction", Component::X);
const Y: ChannelInfo = channel("wi.y", "y of it", Component::Y);
const Z: ChannelInfo = channel("wi.z", "z of it, mu_i", Component::Z);
const PDF: ChannelInfo = ChannelInfo {
    id: "pdf",
    meaning: "f mu_i / E, 1/sr",
    range: [0.0, 3.4e38],
    role: Role::DirectionDensity(Lobe::Model),
};

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "importance",
    title: "Directions that sample a model",
    formula: "theta(u): int_0^theta m = u int_0^(pi/2) m, m = sin cos int f dphi; phi(v): int_0^phi f = v int_0^(2 pi) f at that theta",
    sources: &[Source::new(cite::LAWRENCE_2004, "section 4, marginal and conditional distributions")],
    coordinates: &["u", "v", "mu"],
    layouts: &[
        Layout {
            id: "direction-pdf",
            doc: "light direction for a view in the xz plane, to be normalised after filtering, and its density per steradian",
            channels: &[X, Y, Z, PDF],
        },
        Layout { id: "direction", doc: "the same without the density", channels: &[X, Y, Z] },
        Layout {
            id: "angles",
            doc: "cosine to the normal, and azimuth from the view direction",
            channels: &[
                channel("mu_i", "cosine of the light direction", Component::Z),
                channel("phi", "azimuth from wo, rad", Component::Azimuth),
            ],
        },
    ],
    mix: Mix::Layouts,
    model: ModelUse::Any("ggx"),
    params: &[],
    laws: &["range", "monotone", "total", "honest"],
    axes: default_axes,
    least_tolerance: |_| 0.0,
    blended: false,
    notes: "u = 0 is the normal, u = 1 the horizon. Axes: u, v, mu, phi (the view azimuth, for anisotropic models) and any number parameter of the model. \
        A light reflected below the horizon does not exist here: the density is that of the reflected light alone.",
    bind,
};

fn default_axes(_: &Setting<'_>) -> Vec<Axis> {
    let axis = |id: &str, len| Quantity::find(id).map(|q| Axis::new(q, len, Texel::Center));
    let roughness = axis("roughness", 4).map(|a| a.over([0.2, 1.0]));
    [axis("u", 32), axis("v", 32), axis("mu", 8), roughness].into_iter().flatten().collect()
}

/// Parts of the tolerance to which the distributions are made, one after another.
const PARTS: [f64; 5] = [0.1, 1e-2, 1e-3, 1e-4, 1e-6];

/// Distances from the mirror direction and from wo at which the panels end, rad.
const NEAR: [f64; 4] = [0.005, 0.03, 0.15, 0.5];

struct Importance {
    sweep: Sweep,
    u: usize,
    v: usize,
    parts: Vec<Option<Component>>,
    /// Marginals by the bits of everything but u and v, and the part of the tolerance: texels of one view share them.
    marginals: Mutex<HashMap<Vec<u64>, Arc<Density>>>,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    let sweep = Sweep::new(spec, false)?;
    if let Some((info, params)) = &spec.model
        && (info.build)(params).is_ok_and(|m| m.mirror(1.0).is_some())
    {
        let why = "is a mirror: its one direction needs no table";
        return Err(BindError::Model { kind: spec.kind.id, model: info.id.to_owned(), why });
    }
    Ok(Box::new(Importance {
        sweep,
        u: spec.coordinate("u")?,
        v: spec.coordinate("v")?,
        parts: spec.each(|role| match role {
            Role::Direction(_, component) => Some(Some(component)),
            Role::DirectionDensity(_) => Some(None),
            _ => None,
        })?,
        marginals: Mutex::new(HashMap::new()),
    }))
}

/// The view direction; in the horizon the limit for grazing views.
fn view_direction(view: View) -> DVec3 {
    let (sin, [cos_phi, sin_phi]) = (view.sine(), view.azimuth());
    DVec3::new(sin * cos_phi, sin * sin_phi, view.mu.max(1e-150))
}

/// Light direction at an angle to the normal and an azimuth from the view's.
fn light_direction(view: View, theta: f64, phi: f64) -> DVec3 {
    let (sin, cos) = libm::sincos(theta);
    let (sin_phi, cos_phi) = libm::sincos(view.phi + phi);
    DVec3::new(sin * cos_phi, sin * sin_phi, cos)
}

/// Azimuths at which panels end, from wo over the mirror direction and back; half of it for isotropic models.
fn azimuths(model: &dyn Brdf) -> Vec<f64> {
    let half: Vec<f64> =
        [0.0].into_iter().chain(NEAR).chain(NEAR.into_iter().rev().map(|n| PI - n)).chain([PI]).collect();
    if !model.turns() {
        return half;
    }
    half.iter().copied().chain(half.iter().rev().map(|x| TAU - x)).collect()
}

/// The marginal density over theta, its integral (the directional albedo) to `part` of itself.
#[must_use]
pub fn marginal(model: &dyn Brdf, view: View, part: f64) -> Density {
    let theta_o = libm::acos(view.mu);
    let mut breaks = vec![0.0, FRAC_PI_2];
    breaks.extend(NEAR.into_iter().flat_map(|n| [theta_o - n, theta_o + n]).chain([theta_o]));
    breaks.retain(|x| (0.0..=FRAC_PI_2).contains(x));
    breaks.sort_by(f64::total_cmp);
    let azimuths = azimuths(model);
    let wo = view_direction(view);
    let factor = if model.turns() { 1.0 } else { 2.0 };
    let build = |tolerance: f64| {
        Density::new(&breaks, tolerance, &mut |theta| {
            let (sin, cos) = libm::sincos(theta);
            let measure = factor * sin * cos.max(0.0);
            if measure <= 0.0 {
                return (0.0, 0.0, 0);
            }
            let e = line::integrate(&azimuths, 1, 0.1 * tolerance / measure, &mut |phi, out| {
                out[0] = model.eval(wo, light_direction(view, theta, phi));
            });
            (measure * e.value[0], measure * e.error[0], e.evaluations)
        })
    };
    // the size of the albedo first, roughly
    let rough = build(1e-2).total;
    build(part * rough.max(1e-12))
}

/// The conditional density over the azimuth at an angle.
fn conditional(model: &dyn Brdf, view: View, theta: f64, part: f64) -> Density {
    let wo = view_direction(view);
    let azimuths = azimuths(model);
    let f = &mut |phi: f64| (model.eval(wo, light_direction(view, theta, phi)), 0.0, 1);
    let rough = Density::new(&azimuths, f64::INFINITY, f);
    let mut density = Density::new(&azimuths, part * rough.total, f);
    density.evaluations += rough.evaluations;
    density
}

/// The azimuth of a number, and its error.
fn azimuth(density: &Density, v: f64, turns: bool) -> (f64, f64) {
    if turns {
        return density.quantile(v);
    }
    // symmetric: the half from wo to the mirror direction serves both sides
    let (phi, error) = density.quantile(1.0 - (2.0 * v - 1.0).abs());
    (if v > 0.5 { TAU - phi } else { phi }, error)
}

impl Importance {
    fn marginal(&self, model: &dyn Brdf, at: &[f64], part: f64) -> Arc<Density> {
        let others = at.iter().enumerate().filter(|(i, _)| *i != self.u && *i != self.v);
        let key: Vec<u64> = others.map(|(_, v)| v.to_bits()).chain([part.to_bits()]).collect();
        let memo = || self.marginals.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = memo().get(&key) {
            return Arc::clone(known);
        }
        // made outside the lock: two threads may both make it, and get the same
        let made = Arc::new(marginal(model, self.sweep.view(at), part));
        memo().insert(key, Arc::clone(&made));
        made
    }

    /// Angle, azimuth, their errors, albedo with its error, evaluations of this texel.
    fn draw(&self, model: &dyn Brdf, at: &[f64], part: f64) -> Draw {
        let view = self.sweep.view(at);
        let marginal = self.marginal(model, at, part);
        let (theta, theta_error) = marginal.quantile(at[self.u]);
        let turns = model.turns();
        // in the horizon f vanishes, and its direction is that of the limit
        let inside = |theta: f64| theta.clamp(1e-9, FRAC_PI_2 - 1e-9);
        let density = conditional(model, view, inside(theta), part);
        let (phi, own) = azimuth(&density, at[self.v], turns);
        let moved = conditional(model, view, inside(theta + theta_error), part);
        let apart = (azimuth(&moved, at[self.v], turns).0 - phi).abs();
        Draw {
            theta,
            phi,
            error: [theta_error, own + apart],
            albedo: [marginal.total, marginal.error],
            evaluations: density.evaluations.saturating_add(moved.evaluations),
        }
    }
}

struct Draw {
    theta: f64,
    phi: f64,
    error: [f64; 2],
    albedo: [f64; 2],
    evaluations: u32,
}

impl Baker for Importance {
    fn texel(&self, at: &[f64], tolerance: f64) -> Result<Estimate, TexelError> {
        let model = self.sweep.model(at)?;
        let view = self.sweep.view(at);
        let mut e = Estimate::exact([0.0; MAX_CHANNELS]);
        let mut evaluations = 0u32;
        for part in PARTS {
            let draw = self.draw(&*model, at, part * tolerance);
            evaluations = evaluations.saturating_add(draw.evaluations);
            e = match self.parts.contains(&Some(Component::Azimuth)) {
                true => angles(&draw),
                false => direction(&*model, view, &draw, self.parts.contains(&None)),
            };
            if e.error[..4].iter().all(|e| *e <= tolerance) || e.value.iter().any(|v| v.is_nan()) {
                break;
            }
        }
        e.evaluations = evaluations;
        super::finite(e, 4)
    }

    fn rule(&self) -> String {
        "cumulative distributions as piecewise Legendre series of order 12 over adaptive panels, inner integrals by Gauss-Kronrod (7, 15)"
            .to_owned()
    }
}

fn angles(draw: &Draw) -> Estimate {
    let mut e = Estimate::exact([0.0; MAX_CHANNELS]);
    let (sin, cos) = libm::sincos(draw.theta);
    e.value[..2].copy_from_slice(&[cos.max(0.0), draw.phi.clamp(0.0, TAU)]);
    e.error[..2].copy_from_slice(&[(sin + draw.error[0]) * draw.error[0] + 1e-14, draw.error[1] + 1e-14]);
    e
}

fn direction(model: &dyn Brdf, view: View, draw: &Draw, pdf: bool) -> Estimate {
    let mut e = Estimate::exact([0.0; MAX_CHANNELS]);
    let wi = light_direction(view, draw.theta, draw.phi);
    let moved = draw.error[0] + libm::sin(draw.theta) * draw.error[1] + 1e-14;
    e.value[..3].copy_from_slice(&[wi.x, wi.y, wi.z.max(0.0)]);
    e.error[..3].fill(moved);
    if pdf {
        let [albedo, error] = draw.albedo;
        let value = model.eval(view_direction(view), wi) * wi.z.max(0.0) / albedo;
        // the density is that of the direction in the texel: only the albedo can be off
        e.value[3] = value;
        e.error[3] = value * (error / albedo + 1e-14);
    }
    e
}
