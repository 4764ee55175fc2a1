//! Average albedo: the hemispherical mean of the directional albedo, for energy compensation.

use super::integral::{Functional, integrate};
use super::role::{Light, Lobe, Side};
use super::sides::Sides;
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Setting, Source, Spec, TableInfo, TexelError,
};
use crate::cite;
use crate::grid::{Axis, Quantity, Texel};
use crate::integrate::graded::{Graded, Order};
use crate::integrate::stop::{Trust, climb};
use crate::integrate::{Estimate, View};
use crate::models::Brdf;
use crate::terms::fresnel;
use std::f64::consts::FRAC_PI_2;

const fn channel(id: &'static str, meaning: &'static str, light: Light, side: Side) -> ChannelInfo {
    ChannelInfo { id, meaning, range: [0.0, 1.0], role: Role::Average(Lobe::Model, light, side) }
}

const E: ChannelInfo = channel(
    "e-avg",
    "2 int_0^1 E(mu) mu dmu; of models that transmit the mean of R + T",
    Light::All,
    Side::Above,
);
const R: ChannelInfo = channel("r-avg", "2 int_0^1 R(mu) mu dmu", Light::Reflected, Side::Above);
const T: ChannelInfo = channel("t-avg", "2 int_0^1 T(mu) mu dmu", Light::Transmitted, Side::Above);
const E_INSIDE: ChannelInfo =
    channel("e-avg.inside", "the mean of R + T seen from inside, at 1 / eta", Light::All, Side::Inside);
const R_INSIDE: ChannelInfo =
    channel("r-avg.inside", "the mean of R seen from inside, at 1 / eta", Light::Reflected, Side::Inside);
const T_INSIDE: ChannelInfo = channel(
    "t-avg.inside",
    "the mean of T seen from inside, at 1 / eta; t-avg / eta^2",
    Light::Transmitted,
    Side::Inside,
);

const LOST: ChannelInfo = ChannelInfo {
    id: "e-avg.lost",
    meaning: "1 - e-avg",
    range: [0.0, 1.0],
    role: Role::AverageComplement(Lobe::Model, Side::Above),
};
const LOST_INSIDE: ChannelInfo = ChannelInfo {
    id: "e-avg.lost.inside",
    meaning: "1 - e-avg.inside",
    role: Role::AverageComplement(Lobe::Model, Side::Inside),
    ..LOST
};

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "average-albedo",
    title: "Average albedo E_avg",
    formula: "E_avg = 2 int_0^1 E(mu) mu dmu",
    sources: &[Source::new(cite::KULLA_CONTY_2017, "slide 'Average albedo'")],
    coordinates: &[],
    layouts: &[
        Layout { id: "e-avg", doc: "the average albedo", channels: &[E] },
        Layout { id: "r-t-avg", doc: "averages of what is reflected and transmitted", channels: &[R, T] },
        Layout { id: "both-sides", doc: "R + T from above and from inside", channels: &[E, E_INSIDE] },
    ],
    mix: Mix::Free(&[R_INSIDE, T_INSIDE, LOST, LOST_INSIDE]),
    model: ModelUse::Any("ggx"),
    params: &[],
    laws: &["finite", "range", "energy", "reciprocity", "honest"],
    axes: default_axes,
    least_tolerance: |_| 0.0,
    blended: true,
    notes: "Integrated directly, not from a baked E table: no interpolation error enters. Axes: any number parameter of the model.",
    bind,
};

fn default_axes(_: &Setting<'_>) -> Vec<Axis> {
    Quantity::find("roughness").map(|q| Axis::new(q, 64, Texel::Endpoint)).into_iter().collect()
}

struct AverageAlbedo {
    sides: Sides,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    Ok(Box::new(AverageAlbedo { sides: Sides::new(spec)? }))
}

impl Baker for AverageAlbedo {
    fn texel(&self, at: &[f64], tolerance: f64) -> Result<Estimate, TexelError> {
        let params = self.sides.sweep.params(at)?;
        let models = self.sides.models(at)?;
        let range = Range::of(params.optional("alpha"), params.optional("eta"), self.sides.inside());
        average_of(&range, models.turns(), self.sides.channels(), tolerance, |view, tolerance| {
            self.sides.at(&models, view, tolerance)
        })
    }

    fn rule(&self) -> String {
        format!(
            "Gauss-Legendre in mu graded at alpha, over albedos to a quarter of the tolerance ({})",
            self.sides.sweep.rule()
        )
    }
}

/// Where along mu an albedo changes: on the scale of alpha near 0 and, seen from the denser side, near the critical angle.
#[derive(Debug, Clone)]
pub struct Range {
    scale: f64,
    /// Panels: where each is graded, and its other end.
    panels: Vec<[f64; 2]>,
}

impl Range {
    /// For a width (none: a smooth albedo), a relative index if there is one, and the side it is seen from.
    #[must_use]
    pub fn of(alpha: Option<f64>, eta: Option<f64>, inside: bool) -> Range {
        let scale = alpha.map_or(1.0, |alpha| alpha.clamp(1e-4, 1.0));
        // total reflection: from inside for eta > 1, from above for eta < 1
        let denser = eta.map(|eta| if inside { eta.min(1.0 / eta) } else { eta });
        let critical = denser.filter(|eta| *eta < 1.0).map_or(0.0, fresnel::cos_critical);
        let panels = if critical > 0.0 {
            vec![[0.0, 0.5 * critical], [critical, 0.5 * critical], [critical, 1.0]]
        } else {
            vec![[0.0, 1.0]]
        };
        Range { scale, panels }
    }

    /// Panels, nodes in mu and weights of a level.
    fn nodes(&self, level: f64) -> Vec<(usize, f64, f64)> {
        let mut nodes = Vec::new();
        for (panel, [from, to]) in self.panels.iter().enumerate() {
            let length = (to - from).abs();
            let rule = Graded::new(self.scale / length.max(1e-9), Order(1.0, 0.25), level);
            for (x, w) in rule.node.iter().zip(&rule.weight) {
                nodes.push((panel, from + (to - from) * x, length * w));
            }
        }
        nodes
    }
}

/// `2 int E mu dmu`, averaged over the azimuth for a model that depends on it, with the order raised as [`stop`](crate::integrate::stop) says; inner errors are added by their weights.
///
/// # Errors
/// As [`integrate`].
pub fn average(model: &dyn Brdf, alpha: Option<f64>, tolerance: f64) -> Result<Estimate, TexelError> {
    let range = Range::of(alpha, None, false);
    average_of(&range, model.turns(), 1, tolerance, |view, tolerance| {
        integrate(model, view, &[Functional::One], tolerance)
    })
}

/// The same of several channels that `at` gives for a view and a tolerance.
///
/// # Errors
/// Those of `at`.
pub fn average_of(
    range: &Range,
    turns: bool,
    channels: usize,
    tolerance: f64,
    mut at: impl FnMut(View, f64) -> Result<Estimate, TexelError>,
) -> Result<Estimate, TexelError> {
    climb(TRUST, 0..LEVELS.len(), channels, tolerance, |j, level| {
        let azimuths = azimuths(turns, LEVELS[j]);
        for (panel, mu, w) in range.nodes(LEVELS[j]) {
            for &phi in &azimuths {
                let e = at(View { mu, phi }, 0.25 * tolerance)?;
                let weight = 2.0 * mu * w / azimuths.len() as f64;
                level.evaluations = level.evaluations.saturating_add(e.evaluations);
                for c in 0..channels {
                    level.panel(panel)[c] += weight * e.value[c];
                    level.inner[c] += weight * e.error[c];
                }
            }
        }
        Ok(())
    })
}

/// Levels of the rule in mu.
const LEVELS: [f64; 7] = [4.0, 6.0, 9.0, 13.0, 19.0, 27.0, 38.0];

/// Trust in them.
const TRUST: Trust = Trust { gain: &[1.0], memory: &[0.1] };

/// View azimuths to average over: midpoints of equal parts of a quarter, since both tangents are lines of symmetry.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "levels are small and positive")]
fn azimuths(turns: bool, level: f64) -> Vec<f64> {
    if !turns {
        return vec![0.0];
    }
    let count = (0.5 * level).round() as usize;
    let step = FRAC_PI_2 / count as f64;
    (0..count).map(|i| (i as f64 + 0.5) * step).collect()
}
