//! The microfacet distribution over the cosine of the microfacet normal and the width.

use super::default_axes::axis;
use super::normals::{ALPHA, EXPONENT, GAMMA, SOURCES, Swept, width_of};
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Setting, Spec, TableInfo, TexelError,
};
use crate::grid::{Axis, Warp};
use crate::integrate::{Estimate, MAX_CHANNELS};
use crate::models::{Param, ParamError, normals};

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "ndf",
    title: "Microfacet distribution D",
    formula: "D(mu_m); relative layout: D over its value at the normal, of charlie, velvet and sggx over that at the horizon",
    sources: &SOURCES,
    coordinates: &["mu_m"],
    layouts: &[
        Layout {
            id: "relative",
            doc: "of ggx, beckmann and student-t: D = texel / (pi alpha^2)",
            channels: &[ChannelInfo {
                id: "ndf.relative",
                meaning: "D(mu_m) over D at the normal (pi alpha^2 D of ggx, beckmann and student-t), or of cloth at the horizon",
                range: [0.0, 1.5],
                role: Role::Distribution { relative: true },
            }],
        },
        Layout {
            id: "absolute",
            doc: "D in 1/sr; at alpha below 0.0023 its peak does not fit a half float",
            channels: &[ChannelInfo {
                id: "ndf.d",
                meaning: "D(mu_m), 1/sr",
                range: [0.0, 3.4e38],
                role: Role::Distribution { relative: false },
            }],
        },
    ],
    mix: Mix::Free(&[]),
    model: ModelUse::None,
    params: &[
        Param::choice("distribution", "which distribution: every function `d-...`", &normals::IDS),
        ALPHA,
        GAMMA,
        EXPONENT,
    ],
    laws: &["finite", "range", "normalised", "honest"],
    axes: default_axes,
    least_tolerance: |_| 0.0,
    blended: true,
    notes: "Axes: mu_m, alpha or roughness (n of blinn-phong), gamma of student-t and gtr; any of the numbers may be fixed. The peak has \
        the width alpha: spread mu_m with `one-minus-power` (fine near mu_m = 1). At alpha -> 0 no fixed axis resolves it. The relative \
        form of Beckmann reaches 4 / e = 1.47 at alpha = 1, off the normal, as velvet does; student-t with gamma below 2 grows without \
        bound at the horizon. Relative values are in units of 1 / (pi alpha^2) for ggx, beckmann, student-t and velvet-2000, \
        (n + 2) / (2 pi) for blinn-phong, (2 + 1 / r) / (2 pi) for charlie, 5 / (pi (1 + 4 alpha^2)) for velvet-2007, 1 / (pi sigma) \
        for sggx, D(1) for gtr. The integral of D cos over the hemisphere is 1, sigma for sggx.",
    bind,
};

fn default_axes(setting: &Setting<'_>) -> Vec<Axis> {
    let width = match width_of(setting) {
        "n" => axis("n", 128, [1.0, 1000.0], Warp::Power(0.25)),
        _ => axis("roughness", 128, [0.05, 1.0], Warp::Power(0.5)),
    };
    [axis("mu_m", 128, [0.0, 1.0], Warp::OneMinusPower(0.2)), width].into_iter().flatten().collect()
}

struct Ndf {
    mu: usize,
    swept: Swept,
    /// For each channel: relative to the peak?
    relative: Vec<bool>,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    Ok(Box::new(Ndf {
        mu: spec.coordinate("mu_m")?,
        swept: Swept::new(spec)?.ok_or_else(|| ParamError::Undeclared {
            model: "ndf",
            key: "distribution".to_owned(),
            what: "a distribution",
        })?,
        relative: spec.each(|role| match role {
            Role::Distribution { relative } => Some(relative),
            _ => None,
        })?,
    }))
}

impl Baker for Ndf {
    fn texel(&self, at: &[f64], _tolerance: f64) -> Result<Estimate, TexelError> {
        let shape = self.swept.shape(at)?;
        let normals = self.swept.normals();
        let mut value = [0.0; MAX_CHANNELS];
        let d = normals.d(shape, at[self.mu]);
        for (v, relative) in value.iter_mut().zip(&self.relative) {
            *v = if *relative { d * normals.factor(shape) } else { d };
        }
        super::closed_form(value, self.relative.len())
    }

    fn rule(&self) -> String {
        "closed form".to_owned()
    }
}
