//! Transmittance of a medium over the length of the path, in colour: fog, water, coloured glass.

use super::default_axes::axis;
use super::role::Band;
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Setting, Source, Spec, TableInfo, TexelError,
};
use crate::cite;
use crate::grid::{Axis, Warp};
use crate::integrate::{Estimate, MAX_CHANNELS};
use crate::models::{DefaultValue, Param};
use crate::terms::medium;

const fn sigma(id: &'static str, doc: &'static str, preset: f64) -> Param {
    Param { unit: "1/length", ..Param::number(id, "sigma_t", doc, [0.0, 1e9], DefaultValue::Value(preset)) }
}

const fn passed(id: &'static str, meaning: &'static str, band: Band) -> ChannelInfo {
    ChannelInfo { id, meaning, range: [0.0, 1.0], role: Role::Passed(band) }
}

const fn lost(id: &'static str, meaning: &'static str, band: Band) -> ChannelInfo {
    ChannelInfo { id, meaning, range: [0.0, 1.0], role: Role::Lost(band) }
}

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "beer-lambert",
    title: "Transmittance of a homogeneous medium",
    formula: "T(d) = exp(-sigma_t d)",
    sources: &[
        Source::new(cite::CHANDRASEKHAR_1960, "section 7"),
        Source::new(cite::POPE_FRY_1997, "absorption at 650, 550 and 450 nm, in 1/m (the defaults)")
            .by_default(),
    ],
    coordinates: &["path"],
    layouts: &[
        Layout {
            id: "transmitted",
            doc: "what passes",
            channels: &[
                passed("transmitted.r", "exp(-sigma_r d)", Band::Red),
                passed("transmitted.g", "exp(-sigma_g d)", Band::Green),
                passed("transmitted.b", "exp(-sigma_b d)", Band::Blue),
            ],
        },
        Layout {
            id: "lost",
            doc: "what does not: 1 - T with its own digits",
            channels: &[
                lost("lost.r", "1 - exp(-sigma_r d)", Band::Red),
                lost("lost.g", "1 - exp(-sigma_g d)", Band::Green),
                lost("lost.b", "1 - exp(-sigma_b d)", Band::Blue),
            ],
        },
    ],
    mix: Mix::Layouts,
    model: ModelUse::None,
    params: &[
        sigma("sigma_r", "extinction, red", 0.340),
        sigma("sigma_g", "extinction, green", 0.0565),
        sigma("sigma_b", "extinction, blue", 0.00922),
    ],
    laws: &["finite", "range", "monotone", "honest"],
    axes: default_axes,
    least_tolerance: |_| 0.0,
    blended: true,
    notes: "The defaults are pure water at 650, 550 and 450 nm, d in metres: with fresnel-dielectric at eta 1.333 all that clear water needs. \
        d runs along the refracted ray; it is not the vertical depth.",
    bind,
};

fn default_axes(_: &Setting<'_>) -> Vec<Axis> {
    axis("path", 256, [0.0, 50.0], Warp::Power(0.25)).into_iter().collect()
}

struct Table {
    path: usize,
    sigma: [f64; 3],
    lost: bool,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    Ok(Box::new(Table {
        path: spec.coordinate("path")?,
        sigma: spec.params.numbers(["sigma_r", "sigma_g", "sigma_b"])?,
        lost: spec.roles().iter().any(|role| matches!(role, Role::Lost(_))),
    }))
}

impl Baker for Table {
    fn texel(&self, at: &[f64], _tolerance: f64) -> Result<Estimate, TexelError> {
        let mut value = [0.0; MAX_CHANNELS];
        for (v, &sigma) in value.iter_mut().zip(&self.sigma) {
            let d = at[self.path];
            *v = if self.lost { medium::loss(sigma, d) } else { medium::transmittance(sigma, d) };
        }
        super::closed_form(value, 3)
    }

    fn rule(&self) -> String {
        "closed form".to_owned()
    }
}
