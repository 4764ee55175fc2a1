//! How far a generalised Schlick factor moves from F0 to F90 on a rough surface, under a uniform sky.
//!
//! With `F = F0 + (F90 - F0) s(wo.wh)`, the albedo is `E_white (F0 + (F90 - F0) s_mean)`. `s` is `(1 - v)^e`, or the curve of a
//! dielectric, `(F(v, eta) - F0) / (1 - F0)`.

use super::default_axes::{coupled, split_sum, view_and_roughness};
use super::integral::{Functional, integrate};
use super::refine::{Refinement, refined};
use super::role::{Lobe, Weight};
use super::sweep::Sweep;
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Setting, Source, Spec, TableInfo, TexelError,
};
use crate::cite;
use crate::grid::{Axis, Warp};
use crate::integrate::{BATCH, Estimate, MAX_CHANNELS, Nodes, Sums, View, adaptive, ladder};
use crate::models::{Brdf, DefaultValue, Param};

const fn channel(id: &'static str, meaning: &'static str, role: Role) -> ChannelInfo {
    ChannelInfo { id, meaning, range: [0.0, 1.0], role }
}

const MEAN: ChannelInfo =
    channel("schlick.s", "int (f/F) s mu_i dwi / int (f/F) mu_i dwi", Role::SplitMean(Lobe::White));
const PART: ChannelInfo =
    channel("schlick.part", "int (f/F) s mu_i dwi", Role::Split(Lobe::White, Weight::Curve, 1.0));
const VISIBLE: ChannelInfo = channel(
    "schlick.s-visible",
    "int s p dwi, p the density of visible normals; what falls below the horizon counts as 0 (Cycles)",
    Role::SampledMean(Lobe::White),
);

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "generalised-schlick",
    title: "Mean of a generalised Schlick factor",
    formula: "s = (1 - v)^e, or max(0, (F(v, eta) - F0) / (1 - F0)), v = wo.wh",
    sources: &[
        Source::new(cite::SCHLICK_1994, "Eq. 15 (F, with a free exponent)").when("curve", &["power"]),
        Source::new(cite::WALTER_2007, "Eq. 22 (F of a dielectric)").when("curve", &["dielectric"]),
    ],
    coordinates: &["mu"],
    layouts: &[
        Layout { id: "s", doc: "E = E_white (F0 + (F90 - F0) s)", channels: &[MEAN] },
        Layout { id: "part", doc: "E = F0 E_white + (F90 - F0) part", channels: &[PART] },
        Layout {
            id: "visible",
            doc: "as Cycles' ggx_gen_schlick tables: neither weighed by the masking of wi nor normalised",
            channels: &[VISIBLE],
        },
    ],
    mix: Mix::Free(&[]),
    model: ModelUse::Split("ggx"),
    params: &[
        Param::choice(
            "curve",
            "the power of 1 - v, or a dielectric's Fresnel factor",
            &["power", "dielectric"],
        ),
        Param::number("exponent", "e", "exponent, for curve = power", [0.0, 5e4], DefaultValue::Value(5.0)),
        Param::number(
            "eta",
            "eta",
            "relative index, for curve = dielectric",
            [1.0, 1e3],
            DefaultValue::Value(1.5),
        ),
    ],
    laws: &["finite", "range", "reciprocity", "honest"],
    axes: default_axes,
    least_tolerance: |_| 0.0,
    blended: true,
    notes: "Sweep exponent (or schlick_z, exponent = 5 (1 - z) / z) or eta (or f0_root4) on a third axis. With e = 5 the part is the \
        bias of `dfg`. At eta = 1 nothing is reflected and s is 0. visible takes the sampler of the model, which draws visible normals \
        for ggx and beckmann.",
    bind,
};

fn default_axes(setting: &Setting<'_>) -> Vec<Axis> {
    let scale = match setting.layout.id {
        "s" => 8.0,
        "visible" => 4.0,
        _ => return split_sum(),
    };
    view_and_roughness(coupled(4.0, scale, 0.25), Warp::Power(0.5))
}

/// What a channel is.
#[derive(Clone, Copy, PartialEq)]
enum Part {
    Mean,
    Weighed,
    Visible,
}

struct Schlick {
    sweep: Sweep,
    parts: Vec<Part>,
    dielectric: bool,
    /// Axis of the exponent or of eta, and its value where none sweeps it.
    axis: Option<usize>,
    fixed: f64,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    let dielectric = spec.params.choice("curve")? == "dielectric";
    let [id, other] = if dielectric { ["eta", "exponent"] } else { ["exponent", "eta"] };
    if let Some(idle) = spec.axis(other) {
        let axis = spec.grid.axes()[idle].quantity.id;
        return Err(BindError::IdleAxis { kind: spec.kind.id, axis, allowed: format!("mu, alpha, {id}") });
    }
    Ok(Box::new(Schlick {
        sweep: Sweep::new(spec, true)?,
        parts: spec.each(|role| match role {
            Role::SplitMean(_) => Some(Part::Mean),
            Role::Split(_, Weight::Curve, _) => Some(Part::Weighed),
            Role::SampledMean(_) => Some(Part::Visible),
            _ => None,
        })?,
        dielectric,
        axis: spec.axis(id),
        fixed: spec.params.number(id)?,
    }))
}

impl Schlick {
    fn curve(&self, at: &[f64]) -> Functional {
        let value = self.axis.map_or(self.fixed, |i| at[i]);
        if self.dielectric { Functional::Dielectric(value) } else { Functional::Power(value) }
    }
}

impl Baker for Schlick {
    fn texel(&self, at: &[f64], tolerance: f64) -> Result<Estimate, TexelError> {
        let (model, view, curve) = (self.sweep.model(at)?, self.sweep.view(at), self.curve(at));
        let mut all = Estimate { value: [0.0; MAX_CHANNELS], error: [0.0; MAX_CHANNELS], evaluations: 0 };
        let weighed = self.parts.iter().any(|p| *p != Part::Visible);
        let how = Refinement { tolerance, first: 0.25 * tolerance, share: 0.3, least: 1e-14 };
        let both = |inner| integrate(&*model, view, &[curve, Functional::One], inner);
        let error = |e: &Estimate| if self.parts.contains(&Part::Mean) { mean(e).1 } else { 0.0 };
        let part = if weighed { refined(how, both, error)? } else { all };
        let visible =
            if self.parts.contains(&Part::Visible) { visible(&*model, view, curve, tolerance)? } else { all };
        all.evaluations = part.evaluations.saturating_add(visible.evaluations);
        for (c, wanted) in self.parts.iter().enumerate() {
            (all.value[c], all.error[c]) = match wanted {
                Part::Weighed => (part.value[0], part.error[0]),
                Part::Visible => (visible.value[0], visible.error[0]),
                Part::Mean => mean(&part),
            };
        }
        Ok(all)
    }

    fn rule(&self) -> String {
        self.sweep.rule()
    }
}

/// s, the part that the curve weighs over the whole, with its error; 0 where nothing is reflected.
fn mean(part: &Estimate) -> (f64, f64) {
    let [s, e] = [part.value[0], part.value[1]];
    if e > 0.0 { (s / e, (part.error[0] + s / e * part.error[1]) / e) } else { (0.0, 0.0) }
}

/// The mean of the curve over the directions that the model's sampler draws.
fn visible(model: &dyn Brdf, view: View, curve: Functional, tolerance: f64) -> Result<Estimate, TexelError> {
    if model.mirror(view.mu).is_some() {
        let mut value = [0.0; MAX_CHANNELS];
        value[0] = curve.at(view.mu);
        return Ok(Estimate::exact(value));
    }
    let mut densities = [0.0; BATCH];
    let mut add = |nodes: &Nodes, sums: &mut Sums| {
        let wo = nodes.wo_above();
        for (i, p) in densities[..nodes.len].iter_mut().enumerate() {
            *p = model.pdf(wo, nodes.wi(i));
        }
        let term = |i: usize| densities[i] * nodes.weight[i] * curve.at(nodes.cos_d[i]);
        sums[0] += (0..nodes.len).map(term).sum::<f64>();
    };
    let mut e = match model.chart().map(|chart| chart.creased(curve.crease())) {
        Some(chart) => ladder::integrate(&chart, view, 1, tolerance, &mut add),
        None => adaptive::integrate(view, 1, tolerance, &mut add),
    };
    if !(e.value[0].is_finite() && e.error[0].is_finite()) {
        return Err(TexelError::NotFinite { channel: 0, value: e.value[0] });
    }
    // the trust in the chart is that in a lobe which masking ends at the horizon; a density has its tail there, which the last level
    // that did not see it through knows less of
    if e.error[0] > tolerance {
        e.error[0] *= 3.0;
    }
    Ok(e)
}
