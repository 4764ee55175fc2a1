//! Visibility V = G2 / (4 mu_o mu_i) of a rough surface over both cosines, and G2 itself.

use super::masking::{DISTRIBUTION, Masking, Number, SOURCES, charlie_hidden};
use super::normals::{ALPHA, EXPONENT, GAMMA};
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Setting, Source, Spec, TableInfo, TexelError,
};
use crate::cite;
use crate::grid::{Axis, Warp};
use crate::integrate::{Estimate, View};
use crate::math::frame;
use crate::models::normals::{Pair, direction};
use crate::models::{DefaultValue, Param, normals};
use crate::terms::{schlick_masking, vcavity};
use std::f64::consts::PI;

/// Masking of each direction, and how the two go together.
const ALL_SOURCES: [Source; SOURCES.len() + 1] = {
    let both = Source::new(cite::HEITZ_2014, "Eq. 98 (separable), Eq. 99 (correlated)")
        .when("distribution", &normals::IDS);
    let mut all = [both; SOURCES.len() + 1];
    let mut i = 0;
    while i < SOURCES.len() {
        all[i] = SOURCES[i];
        i += 1;
    }
    all
};

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "visibility",
    title: "Visibility V and masking-shadowing G2",
    formula: "V = G2 / (4 mu_o mu_i); correlated: G2 = 1 / (1 + Lambda_o + Lambda_i), separable: G2 = G1(mu_o) G1(mu_i); V-cavities: \
        G2 = min(1, 2 h.z mu_o / (wo . h), 2 h.z mu_i / (wi . h))",
    sources: &ALL_SOURCES,
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
        ALPHA,
        GAMMA,
        EXPONENT,
        Param {
            unit: "rad",
            ..Param::number(
                "phi",
                "phi",
                "of vcavity: azimuth between both directions; pi is the plane of incidence",
                [0.0, 2.0 * PI],
                DefaultValue::Value(PI),
            )
        },
    ],
    laws: &["finite", "range", "honest"],
    axes: default_axes,
    least_tolerance: |_| 0.0,
    blended: true,
    notes: "V is symmetric. Where both cosines are 0 the correlated form counts as 0: there is no reflection. Schlick's form is separable. \
        Axes: mu, mu_i, alpha or roughness (n of blinn-phong), gamma of student-t and gtr; phi of vcavity, which has no width and one form.",
    bind,
};

fn default_axes(setting: &Setting<'_>) -> Vec<Axis> {
    let mut axes = super::masking::axes(&["mu", "mu_i"], 32, 16, [0.1, 1.0], setting);
    if setting.layout.id != "g2" {
        for axis in &mut axes {
            if axis.quantity.base_id() == "alpha" {
                axis.warp = Warp::Power(0.5);
            } else if axis.quantity.id != "n" {
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
    phi: Number,
    masking: Masking,
    correlated: bool,
    visibility: bool,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    Ok(Box::new(Table {
        mu_o: spec.coordinate("mu")?,
        mu_i: spec.coordinate("mu_i")?,
        phi: Number::of(spec, "phi")?,
        masking: Masking::new(spec, &["phi"])?,
        correlated: spec.params.choice("masking")? == "correlated",
        visibility: spec.roles().contains(&Role::Visibility),
    }))
}

impl Table {
    /// Value and error, from cosines and the hidden areas of both.
    fn of(&self, mu: [f64; 2], hidden: [[f64; 2]; 2]) -> [f64; 2] {
        let above = if self.visibility { 0.25 } else { mu[0] * mu[1] };
        let [value, error] = Pair { mu, hidden }.over(self.correlated, above);
        let g1 = |i: usize| mu[i] / (mu[i] + hidden[i][0]);
        // the same, as a product
        [if self.visibility || self.correlated { value } else { g1(0) * g1(1) }, error]
    }

    fn rational(&self, k: f64, [mu_o, mu_i]: [f64; 2]) -> f64 {
        if self.visibility {
            schlick_masking::visibility(k, mu_o, mu_i)
        } else {
            schlick_masking::g1(k, mu_o) * schlick_masking::g1(k, mu_i)
        }
    }

    /// Of V-shaped grooves, whose facets are the half vectors; 0 where a cosine is.
    fn grooves(&self, [mu_o, mu_i]: [f64; 2], phi: f64) -> f64 {
        let (wo, wi) = (direction(mu_o), View { mu: mu_i, phi }.direction());
        let Some(h) = frame::half_vector(wo, wi) else { return 0.0 };
        let g2 = vcavity::g2(wo, wi, h.wh, h.cos_d);
        let both = mu_o * mu_i;
        match self.visibility {
            false => g2,
            true if both > 0.0 => 0.25 * g2 / both,
            true => 0.0,
        }
    }
}

impl Baker for Table {
    fn texel(&self, at: &[f64], tolerance: f64) -> Result<Estimate, TexelError> {
        let mu = [at[self.mu_o], at[self.mu_i]];
        let mut evaluations = 1;
        let [value, error] = match &self.masking {
            Masking::Smith(swept) => {
                let shape = swept.shape(at)?;
                let both = mu.map(|mu| swept.normals().hidden(shape, mu, 0.1 * tolerance));
                evaluations = both[0].evaluations.max(both[1].evaluations);
                self.of(mu, both.map(|e| [e.value[0], e.error[0]]))
            }
            Masking::Rational(k, alpha) => [self.rational(schlick_masking::k(*k, alpha.at(at)), mu), 0.0],
            Masking::Charlie(alpha) => {
                let alpha = alpha.at(at);
                self.of(mu, [[charlie_hidden(alpha, mu[0])?, 0.0], [charlie_hidden(alpha, mu[1])?, 0.0]])
            }
            Masking::Grooves => [self.grooves(mu, self.phi.at(at)), 0.0],
        };
        let mut e = Estimate::exact_one(value);
        e.error[0] += error;
        e.evaluations = evaluations;
        super::finite(e, 1)
    }

    fn rule(&self) -> String {
        self.masking.rule()
    }
}
