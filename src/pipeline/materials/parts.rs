//! The albedo of a stack of glTF layers, from tables of its parts.
//!
//! Base, glTF 2.0 Appendix B.3: metal and dielectric mixed by metalness, `E_metal = scale rho + bias`,
//! `E_dielectric = rho (1 - t) (1 - w (f + (1 - f) S)) + w (f0 scale + bias)`, where `S(mu) = int (1 - wo.wh)^5 mu_i / pi dwi` is what
//! Schlick's factor takes from a Lambertian lobe, `w` and the colour in f0 are those of `KHR_materials_specular`, `f` is the largest
//! channel of f0, and `t` the share of `KHR_materials_transmission` and `KHR_materials_diffuse_transmission`, which goes through. `KHR_materials_sheen` puts `s E_s + (1 - max(s) E_s) E` on it, and `KHR_materials_clearcoat`
//! `c F_c(mu) E_c + (1 - c F_c(mu)) E`, `F_c` being Schlick's factor of index 1.5 at the view and `E_c` the
//! albedo of the coat without it (its `fresnel_coat` mixes by the view cosine).

use super::Texel;
use crate::grid::{Axis, Quantity, Table, Texel as Place, Warp};
use crate::integrate::gauss;
use crate::pipeline::{InMemoryError, bake_until};
use crate::plan::TableRequest;
use crate::tables::default_axes::LEAST_ROUGHNESS;
use crate::tables::sheen_scaling::LEAST_SHEEN_ROUGHNESS;
use crate::tables::spec::Request;
use crate::terms::schlick;
use serde_json::json;
use std::f64::consts::PI;

/// Least view cosine that is judged.
const LEAST_MU: f64 = 0.05;
/// Views.
const VIEWS: usize = 20;
/// Rows of roughness, from [`LEAST_ROUGHNESS`] to 1; smoother lobes are read there.
const ROWS: usize = 100;
/// Rows of the roughness of sheen, from the clamp of productions to 1.
const SHEENS: usize = 32;

/// Tables of the parts.
#[derive(Debug)]
pub struct Parts {
    split: Table,
    sheen: Table,
    /// S at each view.
    lost: Vec<f64>,
    average: Table,
}

impl Parts {
    /// Bakes them, to 1e-5.
    ///
    /// # Errors
    /// [`InMemoryError`] if it is stopped.
    pub fn bake(cancel: &crate::cancel::Cancel, masking: &str) -> Result<Parts, InMemoryError> {
        let axis = |id: &str, len: usize, domain: [f64; 2]| {
            Quantity::find(id).map(|q| Axis::new(q, len, Place::Endpoint).over(domain).warped(Warp::Linear))
        };
        let view = || axis("mu", VIEWS, [LEAST_MU, 1.0]);
        let table = |kind: &str, model: &str, channel: &str, axes: [Option<Axis>; 2]| {
            let mut request = Request {
                kind: kind.to_owned(),
                model: Some(model.to_owned()),
                layout: Some(channel.to_owned()),
                axes: Some(axes.into_iter().flatten().collect()),
                ..Request::default()
            };
            if model == "ggx" {
                request.params.insert("masking".to_owned(), json!(masking));
            }
            let asked = TableRequest { tolerance: Some(1e-5), ..TableRequest::new("part", request) };
            bake_until(cancel, asked).map(|baked| baked.table().clone())
        };
        let rough = || axis("roughness", ROWS, [LEAST_ROUGHNESS, 1.0]);
        let split = table("dfg", "ggx", "scale-bias", [view(), rough()])?;
        let average = table("average-albedo", "ggx", "e-avg", [rough(), None])?;
        let cloth = axis("sheen_roughness", SHEENS, [LEAST_SHEEN_ROUGHNESS, 1.0]);
        let sheen = table("sheen-scaling", "charlie", "e", [view(), cloth])?;
        let lost =
            split.grid.axes().first().map(|a| (0..a.len).map(|i| schlick_lost(a.value(i, 0.0))).collect());
        Ok(Parts { split, sheen, lost: lost.unwrap_or_default(), average })
    }

    /// Views that are judged.
    fn views(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let axis = self.split.grid.axes().first();
        axis.into_iter().flat_map(|a| (0..a.len).map(move |i| (i, a.value(i, 0.0))))
    }
}

/// `S(mu) = int (1 - wo.wh)^5 mu_i / pi dwi`, with 24 x 48 nodes: exact to 1e-9, for the integrand is smooth.
fn schlick_lost(mu: f64) -> f64 {
    let (rule, sine) = (gauss::rule(24), (1.0 - mu * mu).max(0.0).sqrt());
    // x = mu_i^2 makes mu_i dmu_i even
    let over_mu = rule.integrate(0.0, 1.0, |x| {
        let (mu_i, sine_i) = (x.sqrt(), (1.0 - x).max(0.0).sqrt());
        rule.integrate(0.0, PI, |phi| {
            let cosine = mu * mu_i + sine * sine_i * libm::cos(phi);
            let half = ((1.0 + cosine) / 2.0).max(0.0).sqrt();
            schlick::weight(half)
        })
    });
    // twice for the other half of the circle, half for dx = 2 mu_i dmu_i
    over_mu / PI
}

/// Value of channel `c` of a table of views and rows, between rows.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "not negative, and below the length of an axis"
)]
fn row(table: &Table, view: usize, at: f64, c: usize) -> f64 {
    let axes = table.grid.axes();
    let (Some(axis), n) = (axes.last(), table.channels.len()) else { return 0.0 };
    let width = if axes.len() == 2 { axes[0].len } else { 1 };
    let [lo, hi] = axis.domain;
    let x = axis.index(at.clamp(lo, hi), 0.0).clamp(0.0, crate::grid::axis::count(axis.len - 1));
    let below = (x.floor() as usize).min(axis.len.saturating_sub(2));
    let part = x - crate::grid::axis::count(below);
    let value = |r: usize| table.values[(r * width + view) * n + c];
    value(below) + part * (value(below + 1) - value(below))
}

/// The layers of a texel.
#[derive(Debug)]
pub struct Stack<'a> {
    /// What the textures hold there.
    pub texel: &'a Texel,
    /// Tables of the parts.
    pub parts: &'a Parts,
}

impl Stack<'_> {
    /// The largest albedo over views and channels.
    #[must_use]
    pub fn largest_albedo(&self) -> f64 {
        let (t, p) = (self.texel, self.parts);
        let mut most = 0.0_f64;
        for (view, mu) in p.views() {
            let [scale, bias] = [0, 1].map(|c| row(&p.split, view, t.roughness, c));
            let sheen = if t.sheen > 0.0 { row(&p.sheen, view, t.sheen_roughness, 0) } else { 0.0 };
            let coat = [0, 1].map(|c| row(&p.split, view, t.coat_roughness, c));
            let brightest = t.f0.iter().copied().fold(0.0, f64::max);
            let below = 1.0 - t.specular * (brightest + (1.0 - brightest) * p.lost[view]);
            for channel in 0..3 {
                let rho = t.base[channel];
                let metal = scale * rho + bias;
                let diffuse = rho * (1.0 - t.through) * below;
                let dielectric = diffuse + t.specular * (t.f0[channel] * scale + bias);
                let base = dielectric + t.metallic * (metal - dielectric);
                let clothed = t.sheen_colour[channel] * sheen + (1.0 - t.sheen * sheen) * base;
                let all = if t.coat > 0.0 {
                    let fresnel = 0.04 + 0.96 * schlick::weight(mu);
                    t.coat * fresnel * (coat[0] + coat[1]) + (1.0 - t.coat * fresnel) * clothed
                } else {
                    clothed
                };
                most = most.max(all);
            }
        }
        most
    }

    /// What single scattering loses of the light that facets reflect: F (1 - E_avg), F the mean of the reflectance.
    #[must_use]
    pub fn lost(&self) -> f64 {
        let t = self.texel;
        let missing = 1.0 - row(&self.parts.average, 0, t.roughness, 0);
        let brightest = |of: [f64; 3]| of.into_iter().fold(0.0, f64::max);
        // mean of Schlick's factor over the hemisphere
        let mean = |f0: f64| f0 + (1.0 - f0) / 21.0;
        let dielectric = t.specular * mean(brightest(t.f0));
        (dielectric + t.metallic * (mean(brightest(t.base)) - dielectric)) * missing
    }
}
