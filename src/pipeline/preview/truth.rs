//! What a surface shows, by integration: no table, no prefiltered picture.
//!
//! The lobe is `F0 (1 - Fc) + Fc` times the model without its Fresnel factor, so that `int f L mu_i dwi` of the sky is a sum of moments
//! of the lobe, which depend on the view cosine alone: they are integrated at [`NODES`] cosines by the rules that bake tables and
//! interpolated by cubics. The panel is integrated at every pixel by drawn directions.

use super::environment::{Panel, Sky};
use crate::grid::axis::count;
use crate::integrate::sobol::Sobol;
use crate::integrate::{Nodes, Sums, View, ladder};
use crate::models::{self, Brdf, ParamError, Params};
use glam::{DMat3, DVec3};
use rayon::prelude::*;
use std::f64::consts::FRAC_PI_2;

/// View cosines at which moments are integrated.
const NODES: usize = 256;
/// Tolerance of a moment.
const TOLERANCE: f64 = 1e-6;

/// Moments of a lobe over the incident direction, in the plane of the view: 1, x, z, xx, zz, xz; with weights 1 - Fc and Fc.
type Moments = [[f64; 6]; 2];

/// A lobe of one width.
#[derive(Debug)]
pub(super) struct Truth {
    model: Box<dyn Brdf>,
    nodes: Vec<Moments>,
    /// Largest error of a moment: estimates, and interpolation measured between the nodes.
    pub(super) error: f64,
}

/// The angle of a node of the interpolation; dense at the horizon, where lobes are narrow.
fn angle(x: f64) -> f64 {
    FRAC_PI_2 * (1.0 - (1.0 - x) * (1.0 - x))
}

impl Truth {
    /// Integrates the GGX lobe of a roughness.
    pub(super) fn new(roughness: f64) -> Result<Truth, ParamError> {
        let given = serde_json::json!({ "alpha": roughness * roughness });
        let given = given.as_object().cloned().unwrap_or_default();
        let info = &models::ggx::INFO;
        let params = Params::resolve_over(info.id, info.params, &serde_json::Map::new(), &given)?;
        let model = (info.build)(&params)?;
        let at = |x: f64| moments(&*model, libm::cos(angle(x)).max(0.0));
        let all: Vec<(Moments, f64)> =
            (0..NODES).into_par_iter().map(|i| at(count(i) / count(NODES - 1))).collect();
        let mut error = all.iter().map(|(_, e)| *e).fold(0.0, f64::max);
        let nodes: Vec<Moments> = all.into_iter().map(|(m, _)| m).collect();
        let mut truth = Truth { model, nodes, error };
        for i in (3..NODES - 3).step_by(24) {
            let x = (count(i) + 0.5) / count(NODES - 1);
            let (fresh, _) = moments(&*truth.model, libm::cos(angle(x)).max(0.0));
            let read = truth.at_node(x);
            for (a, b) in fresh.iter().flatten().zip(read.iter().flatten()) {
                error = error.max((a - b).abs());
            }
        }
        truth.error = error;
        Ok(truth)
    }

    /// Moments at a view cosine.
    pub(super) fn moments(&self, mu: f64) -> Moments {
        let x = 1.0 - (1.0 - libm::acos(mu.clamp(0.0, 1.0)) / FRAC_PI_2).max(0.0).sqrt();
        self.at_node(x)
    }

    /// By the cubic through four nodes.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "in [0, NODES - 4]")]
    fn at_node(&self, x: f64) -> Moments {
        let f = x * count(NODES - 1);
        let first = (f.floor() - 1.0).clamp(0.0, count(NODES - 4)) as usize;
        let t = f - count(first);
        let weights = [
            -(t - 1.0) * (t - 2.0) * (t - 3.0) / 6.0,
            t * (t - 2.0) * (t - 3.0) / 2.0,
            -t * (t - 1.0) * (t - 3.0) / 2.0,
            t * (t - 1.0) * (t - 2.0) / 6.0,
        ];
        let mut sum = [[0.0; 6]; 2];
        for (w, node) in weights.iter().zip(&self.nodes[first..first + 4]) {
            for (s, m) in sum.iter_mut().flatten().zip(node.iter().flatten()) {
                *s += w * m;
            }
        }
        sum
    }

    /// The light of the sky that leaves along `view`, split into the parts that F0 scales and that it does not.
    pub(super) fn sky(&self, sky: &Sky, frame: &DMat3, moments: &Moments) -> [[f64; 3]; 2] {
        moments.map(|[one, x, z, xx, zz, xz]| {
            let [tangent, bitangent, normal] = [frame.x_axis, frame.y_axis, frame.z_axis];
            let yy = one - xx - zz;
            [0, 1, 2].map(|c| {
                let (l, q) = (sky.linear[c], sky.square[c]);
                let square = xx * tangent.dot(q * tangent)
                    + yy * bitangent.dot(q * bitangent)
                    + zz * normal.dot(q * normal)
                    + 2.0 * xz * tangent.dot(q * normal);
                sky.constant[c] * one + l.dot(tangent * x + normal * z) + square
            })
        })
    }

    /// The same of the panel, of radiance 1, and an estimate of its error: half the difference of two halves of the directions.
    pub(super) fn panel(
        &self,
        panel: &Panel,
        (from, frame): (DVec3, &DMat3),
        mu: f64,
        draws: u32,
        seed: u32,
    ) -> ([f64; 2], f64) {
        let wo = DVec3::new((1.0 - mu * mu).max(0.0).sqrt(), 0.0, mu);
        let points = Sobol::new(u64::from(seed));
        let mut halves = [[0.0; 2]; 2];
        for i in 0..draws {
            let u = points.point(i);
            let Some(sample) = self.model.sample(wo, u).filter(|s| s.pdf > 0.0) else { continue };
            if !panel.is_met(from, *frame * sample.wi) {
                continue;
            }
            let value = self.model.eval(wo, sample.wi) * sample.wi.z / sample.pdf;
            let m = 1.0 - wo.dot((wo + sample.wi).normalize());
            let fc = m * m * m * m * m;
            let half = &mut halves[(i % 2) as usize];
            half[0] += value * (1.0 - fc);
            half[1] += value * fc;
        }
        let n = f64::from(draws.max(1));
        let [a, b] = halves;
        ([(a[0] + b[0]) / n, (a[1] + b[1]) / n], (a[0] + a[1] - b[0] - b[1]).abs() / n)
    }
}

/// Integrates the moments at a view cosine; with their largest estimated error.
fn moments(model: &dyn Brdf, mu: f64) -> (Moments, f64) {
    let mut values = [0.0; crate::integrate::BATCH];
    let mut error: f64 = 0.0;
    let mut pass = |schlick: bool| {
        let mut add = |nodes: &Nodes, sums: &mut Sums| {
            model.eval_nodes(nodes, &mut values);
            for (i, value) in values.iter().enumerate().take(nodes.len) {
                let m = 1.0 - nodes.cos_d[i];
                let fc = m * m * m * m * m;
                let f = value * nodes.weight[i] * nodes.mu_i[i] * if schlick { fc } else { 1.0 - fc };
                let wi = nodes.wi(i);
                for (s, g) in sums.iter_mut().zip([1.0, wi.x, wi.z, wi.x * wi.x, wi.z * wi.z, wi.x * wi.z]) {
                    *s += f * g;
                }
            }
        };
        let Some(chart) = model.chart() else { return [0.0; 6] };
        let e = ladder::integrate(&chart, View::from(mu), 6, TOLERANCE, &mut add);
        error = error.max(e.largest_error());
        [0, 1, 2, 3, 4, 5].map(|i| e.value[i])
    };
    ([pass(false), pass(true)], error)
}
