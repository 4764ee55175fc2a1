//! Visibility V = G2 / (4 mu_o mu_i) of a rough surface over both cosines, and G2 itself.

use super::masking::{DISTRIBUTION, SCHLICK, direction, schlick};
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Setting, Source, Spec, TableInfo, TexelError,
};
use crate::cite;
use crate::grid::{Axis, Warp};
use crate::integrate::{Estimate, MAX_CHANNELS};
use crate::models::{Param, Preset};
use crate::terms::schlick_masking;
use crate::terms::smith::Ndf;
use crate::terms::{beckmann::Beckmann, ggx::Ggx};

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "visibility",
    title: "Visibility V and masking-shadowing G2",
    formula: "V = G2 / (4 mu_o mu_i); correlated: G2 = 1 / (1 + Lambda_o + Lambda_i), separable: G2 = G1(mu_o) G1(mu_i)",
    sources: &[
        Source::new(cite::HEITZ_2014, "Eq. 98 (separable), Eq. 99 (correlated)")
            .when("distribution", &["ggx", "beckmann"]),
        Source::new(cite::SCHLICK_1994, "Eq. 19 (number recalled)").when("distribution", SCHLICK),
    ],
    coordinates: &["mu", "mu_i"],
    layouts: &[
        Layout {
            id: "visibility",
            doc: "specular = F D texel",
            channels: &[ChannelInfo {
                id: "visibility",
                meaning: "G2 / (4 mu_o mu_i)",
                range: [0.0, 3.4e38],
                role: Role::Visibility,
            }],
        },
        Layout {
            id: "g2",
            doc: "part of the facets facing both directions that is hidden from neither",
            channels: &[ChannelInfo {
                id: "g2",
                meaning: "G2(mu_o, mu_i)",
                range: [0.0, 1.0],
                role: Role::MaskingShadowing,
            }],
        },
    ],
    mix: Mix::Layouts,
    model: ModelUse::None,
    params: &[
        DISTRIBUTION,
        Param::choice("masking", "how the two directions go together", &["correlated", "separable"]),
        Param::number("alpha", "alpha", "width of the distribution", [0.0, 2.0], Preset::Value(0.25)),
    ],
    laws: &["finite", "range", "honest"],
    axes: default_axes,
    least_tolerance: |_| 0.0,
    blended: true,
    notes: "V is symmetric. Where both cosines are 0 the correlated form counts as 0: there is no reflection. Schlick's form is separable. \
        Axes: mu, mu_i and alpha or roughness.",
    bind,
};

fn default_axes(setting: &Setting<'_>) -> Vec<Axis> {
    let mut axes = super::masking::axes(&["mu", "mu_i"], 32, 16, [0.1, 1.0]);
    if setting.layout.id != "g2" {
        for axis in &mut axes {
            if axis.quantity.base_id() == "alpha" {
                axis.warp = Warp::Power(0.5);
            } else {
                // where both cosines are 0 there is no value
                axis.domain = [0.01, 1.0];
            }
        }
    }
    axes
}

struct Table {
    mu_o: usize,
    mu_i: usize,
    axis: Option<usize>,
    alpha: f64,
    distribution: &'static str,
    correlated: bool,
    visibility: bool,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    Ok(Box::new(Table {
        mu_o: spec.coordinate("mu")?,
        mu_i: spec.coordinate("mu_i")?,
        axis: spec.axis("alpha"),
        alpha: spec.params.number("alpha")?,
        distribution: spec.params.choice("distribution")?,
        correlated: spec.params.choice("masking")? == "correlated",
        visibility: spec.roles().contains(&Role::Visibility),
    }))
}

impl Table {
    fn value(&self, mu_o: f64, mu_i: f64, alpha: f64) -> f64 {
        let (wo, wi) = (direction(mu_o), direction(mu_i));
        if let Some(k) = schlick(self.distribution, alpha) {
            return if self.visibility {
                schlick_masking::visibility(k, mu_o, mu_i)
            } else {
                schlick_masking::g1(k, mu_o) * schlick_masking::g1(k, mu_i)
            };
        }
        let ndf: &dyn Ndf = match self.distribution {
            "beckmann" => &Beckmann::isotropic(alpha),
            _ => &Ggx::isotropic(alpha),
        };
        match (self.visibility, self.correlated) {
            (true, true) => ndf.visibility(wo, wi),
            (true, false) => ndf.visibility_separable(wo, wi),
            (false, true) => ndf.g2(wo, wi),
            (false, false) => ndf.g2_separable(wo, wi),
        }
    }
}

impl Baker for Table {
    fn texel(&self, at: &[f64], _tolerance: f64) -> Result<Estimate, TexelError> {
        let alpha = self.axis.map_or(self.alpha, |i| at[i]);
        let mut value = [0.0; MAX_CHANNELS];
        value[0] = self.value(at[self.mu_o], at[self.mu_i], alpha);
        super::closed_form(value, 1)
    }

    fn rule(&self) -> String {
        "closed form".to_owned()
    }
}
