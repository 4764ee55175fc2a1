//! The split-sum table: the environment BRDF of a rough surface under a uniform sky, with the Fresnel factor split off.
//!
//! A shader multiplies its prefiltered radiance by `F0 * scale + F90 * bias`, or, in the multiscatter layout, by
//! `mix(fc, total, F0)`, and can add the energy lost to multiple scattering by `1 + F0 (1 / total - 1)`.

use super::integral::{Functional, integrate};
use super::sweep::Sweep;
use super::{Baker, BindError, ChannelInfo, Layout, ModelUse, Spec, TableInfo, TexelError};
use crate::cite;
use crate::grid::{Axis, Quantity, Texel, Warp};
use crate::integrate::Estimate;

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "dfg",
    title: "Split-sum DFG",
    formula: "scale = int (f/F) (1 - Fc) mu_i dwi, bias = int (f/F) Fc mu_i dwi, Fc = (1 - wo.wh)^5",
    sources: &[(cite::KARIS_2013, "section 'Environment BRDF', Eq. 8")],
    coordinates: &["mu", "alpha"],
    layouts: &[
        Layout {
            id: "scale-bias",
            doc: "specular = F0 * scale + F90 * bias",
            channels: &[
                ChannelInfo { id: "dfg.scale", meaning: "int (f/F) (1 - Fc) mu_i dwi", range: [0.0, 1.0] },
                ChannelInfo { id: "dfg.bias", meaning: "int (f/F) Fc mu_i dwi", range: [0.0, 1.0] },
            ],
        },
        Layout {
            id: "multiscatter",
            doc: "specular = mix(fc, total, F0), F90 = 1; energy compensation 1 + F0 (1 / total - 1)",
            channels: &[
                ChannelInfo { id: "dfg.fc", meaning: "int (f/F) Fc mu_i dwi", range: [0.0, 1.0] },
                ChannelInfo {
                    id: "dfg.total",
                    meaning: "int (f/F) mu_i dwi = E(mu, alpha), white",
                    range: [0.0, 1.0],
                },
            ],
        },
    ],
    model: ModelUse::Split("ggx"),
    params: &[],
    laws: &["finite", "range", "energy", "split", "cross-check", "reciprocity"],
    axes: default_axes,
    notes: "alpha = 0 is the mirror: scale = 1 - (1 - mu)^5, bias = (1 - mu)^5.",
    bind,
};

/// `sqrt(mu)` and roughness on endpoints, 64 x 64: see README, "Which axes".
fn default_axes() -> Vec<Axis> {
    view_and_roughness(64)
}

/// `sqrt(mu)` by roughness on endpoints, the best axes that need no coupling.
pub(super) fn view_and_roughness(len: usize) -> Vec<Axis> {
    ["mu", "roughness"]
        .into_iter()
        .filter_map(Quantity::find)
        .map(|q| {
            let warp = if q.id == "mu" { Warp::Power(0.5) } else { Warp::Linear };
            Axis::new(q, len, Texel::Endpoint).warped(warp)
        })
        .collect()
}

struct Dfg {
    sweep: Sweep,
    functionals: [Functional; 2],
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    let sweep = Sweep::new(spec, true)?;
    let functionals = match spec.layout.id {
        "multiscatter" => [Functional::Schlick, Functional::One],
        _ => [Functional::SchlickComplement, Functional::Schlick],
    };
    Ok(Box::new(Dfg { sweep, functionals }))
}

impl Baker for Dfg {
    fn texel(&self, at: &[f64], tolerance: f64) -> Result<Estimate, TexelError> {
        let model = self.sweep.model(at)?;
        integrate(&*model, self.sweep.view(at), &self.functionals, tolerance)
    }

    fn rule(&self) -> String {
        self.sweep.rule()
    }
}
