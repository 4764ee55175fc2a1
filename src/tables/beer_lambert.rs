//! Transmittance of a medium over the length of the path, in colour: fog, water, coloured glass.

use super::default_axes::axis;
use super::{Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Setting, Spec, TableInfo, TexelError};
use crate::cite;
use crate::grid::{Axis, Warp};
use crate::integrate::{Estimate, MAX_CHANNELS};
use crate::models::{Param, Preset};
use crate::terms::medium;

const fn sigma(id: &'static str, doc: &'static str, preset: f64) -> Param {
    Param { unit: "1/length", ..Param::number(id, "sigma_t", doc, [0.0, 1e9], Preset::Value(preset)) }
}

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "beer-lambert",
    title: "Transmittance of a homogeneous medium",
    formula: "T(d) = exp(-sigma_t d)",
    sources: &[
        (cite::CHANDRASEKHAR_1960, "section 7"),
        (cite::POPE_FRY_1997, "Table 3 (the defaults; values recalled)"),
    ],
    coordinates: &["path"],
    layouts: &[
        Layout {
            id: "transmitted",
            doc: "what passes",
            channels: &[
                ChannelInfo { id: "transmitted.r", meaning: "exp(-sigma_r d)", range: [0.0, 1.0] },
                ChannelInfo { id: "transmitted.g", meaning: "exp(-sigma_g d)", range: [0.0, 1.0] },
                ChannelInfo { id: "transmitted.b", meaning: "exp(-sigma_b d)", range: [0.0, 1.0] },
            ],
        },
        Layout {
            id: "lost",
            doc: "what does not: 1 - T with its own digits",
            channels: &[
                ChannelInfo { id: "lost.r", meaning: "1 - exp(-sigma_r d)", range: [0.0, 1.0] },
                ChannelInfo { id: "lost.g", meaning: "1 - exp(-sigma_g d)", range: [0.0, 1.0] },
                ChannelInfo { id: "lost.b", meaning: "1 - exp(-sigma_b d)", range: [0.0, 1.0] },
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
    laws: &["finite", "range", "monotone"],
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
        sigma: ["sigma_r", "sigma_g", "sigma_b"].map(|id| spec.params.number(id)),
        lost: spec.layout.id == "lost",
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
