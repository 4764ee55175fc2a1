//! Directional albedo: the fraction of light from a uniform sky, or of light along wo, that a surface reflects; and of an
//! interface, that crosses it.

use super::role::{Light, Lobe, Side};
use super::sides::Sides;
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Setting, Source, Spec, TableInfo, TexelError,
};
use crate::cite;
use crate::grid::Axis;
use crate::integrate::Estimate;

const fn channel(id: &'static str, meaning: &'static str, light: Light, side: Side) -> ChannelInfo {
    ChannelInfo { id, meaning, range: [0.0, 1.0], role: Role::Albedo(Lobe::Model, light, side) }
}

const E: ChannelInfo = channel(
    "e",
    "int f(wo, wi) mu_i dwi; of models that transmit R + T, what is not lost between facets",
    Light::All,
    Side::Above,
);
const R: ChannelInfo = channel("r", "the reflected part", Light::Reflected, Side::Above);
const T: ChannelInfo = channel(
    "t",
    "the part of the flux along wo that crosses the surface (without 1 / eta^2)",
    Light::Transmitted,
    Side::Above,
);
const E_INSIDE: ChannelInfo =
    channel("e.inside", "R + T seen from inside, at 1 / eta", Light::All, Side::Inside);
const R_INSIDE: ChannelInfo =
    channel("r.inside", "the reflected part seen from inside, at 1 / eta", Light::Reflected, Side::Inside);
const T_INSIDE: ChannelInfo =
    channel("t.inside", "the part that crosses to the outside, at 1 / eta", Light::Transmitted, Side::Inside);

const LOST: ChannelInfo = ChannelInfo {
    id: "e.lost",
    meaning: "1 - e, what is lost between facets or crosses",
    range: [0.0, 1.0],
    role: Role::Complement(Lobe::Model, Side::Above),
};
const LOST_INSIDE: ChannelInfo = ChannelInfo {
    id: "e.lost.inside",
    meaning: "1 - e.inside",
    role: Role::Complement(Lobe::Model, Side::Inside),
    ..LOST
};

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "albedo",
    title: "Directional albedo E",
    formula: "E(mu) = int f(wo, wi) mu_i dwi; R and T over the two hemispheres of wi",
    sources: &[
        Source::new(cite::KULLA_CONTY_2017, "slide 'Directional albedo'"),
        Source::new(cite::WALTER_2007, "Eq. 21 (f of the light that crosses)").of(crosses),
    ],
    coordinates: &["mu"],
    layouts: &[
        Layout { id: "e", doc: "the directional albedo", channels: &[E] },
        Layout { id: "r", doc: "what is reflected", channels: &[R] },
        Layout { id: "t", doc: "what is transmitted", channels: &[T] },
        Layout { id: "r-t", doc: "what is reflected, what is transmitted", channels: &[R, T] },
        Layout { id: "both-sides", doc: "R + T from above and from inside", channels: &[E, E_INSIDE] },
        Layout {
            id: "both-sides-r-t",
            doc: "R and T from above, R and T from inside",
            channels: &[R, T, R_INSIDE, T_INSIDE],
        },
    ],
    mix: Mix::Free(&[LOST, LOST_INSIDE]),
    model: ModelUse::Any("ggx"),
    params: &[],
    laws: &["finite", "range", "energy", "cross-check", "reciprocity", "honest"],
    axes: default_axes,
    least_tolerance: |_| 0.0,
    blended: true,
    notes: "Axes: mu, phi (the view azimuth, for anisotropic models), and any number parameter of the model (alpha or roughness, f0, \
        eta, ...). t wants a model that transmits, inside one with eta; axes f0_root4 and f0_root4_inverse spread eta above and \
        below 1.",
    bind,
};

/// Channels that tell crossing light from reflected light, or see a surface from inside.
fn crosses(role: Role) -> bool {
    matches!(role, Role::Albedo(_, light, side) if light != Light::All || side == Side::Inside)
}

fn default_axes(_: &Setting<'_>) -> Vec<Axis> {
    super::default_axes::white_albedo()
}

struct Albedo {
    sides: Sides,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    Ok(Box::new(Albedo { sides: Sides::new(spec)? }))
}

impl Baker for Albedo {
    fn texel(&self, at: &[f64], tolerance: f64) -> Result<Estimate, TexelError> {
        self.sides.at(&self.sides.models(at)?, self.sides.sweep.view(at), tolerance)
    }

    fn rule(&self) -> String {
        format!("one-dimensional reduction where the model has one; else {}", self.sides.sweep.rule())
    }
}
