//! Average albedo: the hemispherical mean of the directional albedo, for energy compensation.

use super::integral::{Functional, integrate};
use super::sweep::Sweep;
use super::{Baker, BindError, ChannelInfo, Layout, ModelUse, Spec, TableInfo, TexelError};
use crate::cite;
use crate::grid::{Axis, Quantity, Texel};
use crate::integrate::graded::{Graded, Order};
use crate::integrate::{Estimate, MAX_CHANNELS};
use crate::models::Brdf;

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
        average(&*model, self.sweep.info().id, scale, tolerance)
    }

    fn rule(&self) -> String {
        format!(
            "Gauss-Legendre in mu graded at alpha, over albedos to a quarter of the tolerance ({})",
            self.sweep.rule()
        )
    }
}

/// `2 int E mu dmu` with the order raised until two orders agree; inner errors are added by their weights.
///
/// # Errors
/// As [`integrate`].
pub fn average(
    model: &dyn Brdf,
    id: &'static str,
    scale: f64,
    tolerance: f64,
) -> Result<Estimate, TexelError> {
    let mut previous: Option<f64> = None;
    let mut evaluations = 0u32;
    let mut result = Estimate::exact([0.0; MAX_CHANNELS]);
    for level in [6.0, 9.0, 13.0, 19.0, 27.0, 38.0] {
        let rule = Graded::new(scale, Order(1.0, 0.25), level);
        let (mut value, mut inner) = (0.0, 0.0);
        for (&mu, &w) in rule.node[..rule.len].iter().zip(&rule.weight) {
            let e = integrate(model, id, mu, &[Functional::One], 0.25 * tolerance)?;
            evaluations = evaluations.saturating_add(e.evaluations);
            value += 2.0 * mu * w * e.value[0];
            inner += 2.0 * mu * w * e.error[0];
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
