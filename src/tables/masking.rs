//! Masking G1 of a rough surface over the cosine and the width.

use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Setting, Source, Spec, TableInfo, TexelError,
};
use crate::cite;
use crate::grid::{Axis, Quantity, Texel, Warp};
use crate::integrate::{Estimate, MAX_CHANNELS};
use crate::models::Param;
use crate::terms::schlick_masking::{self, K};
use crate::terms::smith::Ndf as _;
use crate::terms::{beckmann::Beckmann, ggx::Ggx};
use glam::DVec3;

/// Whose masking.
pub(super) const DISTRIBUTION: Param = Param::choice(
    "distribution",
    "Smith's masking of GGX or Beckmann, or Schlick's rational form with k = alpha/2, (r + 1)^2/8 or alpha sqrt(2/pi)",
    &["ggx", "beckmann", "schlick-ibl", "schlick-analytic", "schlick"],
);

/// Those that are Schlick's rational form.
pub(super) const SCHLICK: &[&str] = &["schlick-ibl", "schlick-analytic", "schlick"];

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "masking",
    title: "Masking G1",
    formula: "Smith: G1 = 1 / (1 + Lambda(mu)); Schlick: G1 = mu / (mu (1 - k) + k)",
    sources: &[
        Source::new(cite::HEITZ_2014, "Eq. 42 (Smith), Eq. 72 (Lambda of GGX)")
            .when("distribution", &["ggx"]),
        Source::new(cite::HEITZ_2014, "Eq. 42 (Smith), section 5.2 (Lambda of Beckmann)")
            .when("distribution", &["beckmann"]),
        Source::new(cite::SCHLICK_1994, "Eq. 19 (number recalled)").when("distribution", SCHLICK),
        Source::new(cite::KARIS_2013, "Eq. 4 (k)").when("distribution", &["schlick-ibl", "schlick-analytic"]),
    ],
    coordinates: &["mu", "alpha"],
    layouts: &[Layout {
        id: "g1",
        doc: "part of the facets facing a direction that is not hidden",
        channels: &[ChannelInfo {
            id: "g1",
            meaning: "G1(mu, alpha)",
            range: [0.0, 1.0],
            role: Role::Masking,
        }],
    }],
    mix: Mix::Layouts,
    model: ModelUse::None,
    params: &[DISTRIBUTION],
    laws: &["finite", "range", "monotone", "honest"],
    axes: default_axes,
    least_tolerance: |_| 0.0,
    blended: true,
    notes: "G1 falls to 0 at the horizon on the scale mu ~ alpha: couple the axis of mu to alpha, as the default axes do.",
    bind,
};

fn default_axes(_: &Setting<'_>) -> Vec<Axis> {
    axes(&["mu"], 64, 64, [0.01, 1.0])
}

/// Cosines on axes that open the corner where they and the width go to 0 together, then roughness.
pub(super) fn axes(cosines: &[&str], len: usize, widths: usize, domain: [f64; 2]) -> Vec<Axis> {
    let warp = Warp::Coupled { to: "alpha".to_owned(), power: 2.0, scale: 1.0, exponent: 1.0 };
    let cosines = cosines.iter().filter_map(|id| Quantity::find(id));
    let mut axes: Vec<Axis> =
        cosines.map(|q| Axis::new(q, len, Texel::Endpoint).warped(warp.clone())).collect();
    axes.extend(Quantity::find("roughness").map(|q| Axis::new(q, widths, Texel::Endpoint).over(domain)));
    axes
}

struct Table {
    mu: usize,
    alpha: usize,
    distribution: &'static str,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    Ok(Box::new(Table {
        mu: spec.coordinate("mu")?,
        alpha: spec.coordinate("alpha")?,
        distribution: spec.params.choice("distribution")?,
    }))
}

/// A direction of a cosine, in the plane of the tangent.
pub(super) fn direction(mu: f64) -> DVec3 {
    DVec3::new(((1.0 - mu) * (1.0 + mu)).max(0.0).sqrt(), 0.0, mu)
}

/// k of Schlick's form, if the distribution is one of its names.
pub(super) fn schlick(distribution: &str, alpha: f64) -> Option<f64> {
    let kind = match distribution {
        "schlick-ibl" => K::Ibl,
        "schlick-analytic" => K::Analytic,
        "schlick" => K::Schlick,
        _ => return None,
    };
    Some(schlick_masking::k(kind, alpha))
}

impl Baker for Table {
    fn texel(&self, at: &[f64], _tolerance: f64) -> Result<Estimate, TexelError> {
        let (mu, alpha) = (at[self.mu], at[self.alpha]);
        let mut value = [0.0; MAX_CHANNELS];
        value[0] = match schlick(self.distribution, alpha) {
            Some(k) => schlick_masking::g1(k, mu),
            None if self.distribution == "beckmann" => Beckmann::isotropic(alpha).g1(direction(mu)),
            None => Ggx::isotropic(alpha).g1(direction(mu)),
        };
        super::closed_form(value, 1)
    }

    fn rule(&self) -> String {
        "closed form".to_owned()
    }
}
