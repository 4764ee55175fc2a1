//! Average albedo: the hemispherical mean of the directional albedo, for energy compensation.

use super::integral::{Functional, integrate};
use super::sweep::Sweep;
use super::{Baker, BindError, ChannelInfo, Layout, ModelUse, Spec, TableInfo, TexelError};
use crate::cite;
use crate::grid::{Axis, Quantity, Texel};
use crate::integrate::graded::{Graded, Order};
use crate::integrate::{Estimate, MAX_CHANNELS, View};
use crate::models::Brdf;
use std::f64::consts::FRAC_PI_2;

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "average-albedo",
    title: "Average albedo E_avg",
    formula: "E_avg = 2 int_0^1 E(mu) mu dmu",
    sources: &[(cite::KULLA_CONTY_2017, "slide 'Average albedo'")],
    coordinates: &[],
    layouts: &[Layout {
        id: "e-avg",
        doc: "the average albedo",
        channels: &[ChannelInfo { id: "e-avg", meaning: "2 int_0^1 E(mu) mu dmu", range: [0.0, 1.0] }],
    }],
    extra: &[],
    model: ModelUse::Any("ggx"),
    params: &[],
    laws: &["finite", "range", "energy", "reciprocity"],
    axes: default_axes,
    notes: "Integrated directly, not from a baked E table: no interpolation error enters. Axes: any number parameter of the model.",
    bind,
};

fn default_axes() -> Vec<Axis> {
    Quantity::find("roughness").map(|q| Axis::new(q, 32, Texel::Endpoint)).into_iter().collect()
}

struct AverageAlbedo {
    sweep: Sweep,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    Ok(Box::new(AverageAlbedo { sweep: Sweep::new(spec, false)? }))
}

impl Baker for AverageAlbedo {
    fn texel(&self, at: &[f64], tolerance: f64) -> Result<Estimate, TexelError> {
        let params = self.sweep.params(at);
        let model = (self.sweep.info().build)(&params)?;
        // E changes on the scale mu ~ alpha; a model without alpha is smooth.
        let alpha = params.number("alpha");
        let scale = if alpha.is_finite() { alpha.clamp(1e-4, 1.0) } else { 1.0 };
        average(&*model, scale, tolerance)
    }

    fn rule(&self) -> String {
        format!(
            "Gauss-Legendre in mu graded at alpha, over albedos to a quarter of the tolerance ({})",
            self.sweep.rule()
        )
    }
}

/// `2 int E mu dmu`, averaged over the azimuth for a model that depends on it, with the order raised until two orders agree; inner errors are added by their weights.
///
/// # Errors
/// As [`integrate`].
pub fn average(model: &dyn Brdf, scale: f64, tolerance: f64) -> Result<Estimate, TexelError> {
    let mut previous: Option<f64> = None;
    let mut evaluations = 0u32;
    let mut result = Estimate::exact([0.0; MAX_CHANNELS]);
    for level in [6.0, 9.0, 13.0, 19.0, 27.0, 38.0] {
        let rule = Graded::new(scale, Order(1.0, 0.25), level);
        let (mut value, mut inner) = (0.0, 0.0);
        let azimuths = azimuths(model, level);
        for (&mu, &w) in rule.node[..rule.len].iter().zip(&rule.weight) {
            for &phi in &azimuths {
                let e = integrate(model, View { mu, phi }, &[Functional::One], 0.25 * tolerance)?;
                let weight = 2.0 * mu * w / azimuths.len() as f64;
                evaluations = evaluations.saturating_add(e.evaluations);
                value += weight * e.value[0];
                inner += weight * e.error[0];
            }
        }
        let outer = previous.map_or(f64::INFINITY, |p| (value - p).abs());
        result.value[0] = value;
        result.error[0] = outer + inner;
        result.evaluations = evaluations;
        if result.error[0] <= tolerance {
            break;
        }
        previous = Some(value);
    }
    Ok(result)
}

/// View azimuths to average over: midpoints of equal parts of a quarter, since both tangents are lines of symmetry.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "levels are small and positive")]
fn azimuths(model: &dyn Brdf, level: f64) -> Vec<f64> {
    if !model.turns() {
        return vec![0.0];
    }
    let count = (0.5 * level).round() as usize;
    let step = FRAC_PI_2 / count as f64;
    (0..count).map(|i| (i as f64 + 0.5) * step).collect()
}
