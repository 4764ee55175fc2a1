//! What a sheen leaves to the layers below it, by its directional albedo.
//!
//! `f = f_sheen + min(scaling(mu_o), scaling(mu_i)) f_base`, `scaling = 1 - sheen E(mu)`: the albedo scaling of the glTF sheen
//! extension, with `sheen` the largest component of the colour. A shader that has the colour reads E and forms it itself.

use super::default_axes::axis;
use super::integral::{Functional, integrate};
use super::role::{Light, Lobe, Side};
use super::sweep::Sweep;
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Setting, Source, Spec, TableInfo, TexelError,
};
use crate::cite;
use crate::grid::{Axis, Warp};
use crate::integrate::{Estimate, MAX_CHANNELS};
use crate::models::{DefaultValue, Param};

const SCALING: ChannelInfo = ChannelInfo {
    id: "sheen.scaling",
    meaning: "max(0, 1 - sheen E(mu))",
    range: [0.0, 1.0],
    role: Role::Scaling(Lobe::Model),
};
const E: ChannelInfo = ChannelInfo {
    id: "sheen.e",
    meaning: "int f(wo, wi) mu_i dwi of the sheen",
    range: [0.0, 1.0],
    role: Role::Albedo(Lobe::Model, Light::Reflected, Side::Above),
};

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "sheen-scaling",
    title: "Albedo scaling below a sheen",
    formula: "scaling = 1 - sheen E(mu), E = int f_sheen mu_i dwi",
    sources: &[Source::new(cite::KHR_SHEEN, "the albedo scaling technique")],
    coordinates: &["mu"],
    layouts: &[
        Layout {
            id: "scaling",
            doc: "factor of the base: the smaller one of wo and wi",
            channels: &[SCALING],
        },
        Layout { id: "e", doc: "albedo of the sheen: base *= 1 - max(sheen colour) * e", channels: &[E] },
        Layout { id: "e-scaling", doc: "both", channels: &[E, SCALING] },
    ],
    mix: Mix::Free(&[]),
    model: ModelUse::Any("charlie"),
    params: &[Param::number(
        "sheen",
        "s",
        "largest component of the sheen colour",
        [0.0, 1.0],
        DefaultValue::Value(1.0),
    )],
    laws: &["finite", "range", "honest"],
    axes: default_axes,
    least_tolerance: |_| 0.0,
    blended: true,
    notes: "Axis sheen_roughness is glTF's; roughness, r or alpha of Charlie is its square. The model need not be reciprocal: E belongs to the view. \
        By default the axis begins at 0.27 (r = 0.073), the clamp of productions, and mu at 1e-3: below them E exceeds 1, and a scaled \
        base would be negative.",
    bind,
};

/// Where the roughness of sheen begins, glTF's: the clamp of productions, r = 0.073. Below it E exceeds 1 at grazing views.
pub const LEAST_SHEEN_ROUGHNESS: f64 = 0.27;

fn default_axes(_: &Setting<'_>) -> Vec<Axis> {
    let mu = axis("mu", 64, [1e-3, 1.0], Warp::Power(0.25));
    let roughness = axis("sheen_roughness", 32, [LEAST_SHEEN_ROUGHNESS, 1.0], Warp::Linear);
    [mu, roughness].into_iter().flatten().collect()
}

struct Scaling {
    sweep: Sweep,
    scaling: Vec<bool>,
    sheen: f64,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    Ok(Box::new(Scaling {
        sweep: Sweep::new(spec, false)?,
        scaling: spec.each(|role| match role {
            Role::Scaling(_) => Some(true),
            Role::Albedo(..) => Some(false),
            _ => None,
        })?,
        sheen: spec.params.number("sheen")?,
    }))
}

impl Baker for Scaling {
    fn texel(&self, at: &[f64], tolerance: f64) -> Result<Estimate, TexelError> {
        let model = self.sweep.model(at)?;
        let e = integrate(&*model, self.sweep.view(at), &[Functional::One], tolerance)?;
        let mut all = Estimate { value: [0.0; MAX_CHANNELS], error: [0.0; MAX_CHANNELS], ..e };
        for (c, scaling) in self.scaling.iter().enumerate() {
            (all.value[c], all.error[c]) = if *scaling {
                ((1.0 - self.sheen * e.value[0]).max(0.0), self.sheen * e.error[0])
            } else {
                (e.value[0], e.error[0])
            };
        }
        Ok(all)
    }

    fn rule(&self) -> String {
        self.sweep.rule()
    }
}
