//! What energy compensation reads: the complement of the white albedo, the lobe made of it, and Turquin's factor.
//!
//! Kulla and Conty add `F_ms (1 - E(mu_o))(1 - E(mu_i)) / (pi (1 - E_avg)) = F_ms lobe(mu_o) lobe(mu_i)`; Turquin multiplies the
//! single scattering by `1 + F0 turquin(mu_o)`. 1 - E is stored instead of E because it keeps its digits where E is near 1.

use super::average_albedo::average;
use super::default_axes::{coupled, view_and_roughness, white_albedo};
use super::integral::{Functional, integrate};
use super::memo::Memo;
use super::refine::{Refinement, largest, refined};
use super::role::{Lobe, Side};
use super::sweep::Sweep;
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Setting, Source, Spec, TableInfo, TexelError,
};
use crate::cite;
use crate::grid::{Axis, Warp};
use crate::integrate::{Estimate, MAX_CHANNELS};
use std::f64::consts::PI;

const MISSING: ChannelInfo = ChannelInfo {
    id: "ms.missing",
    meaning: "1 - E(mu)",
    range: [0.0, 1.0],
    role: Role::Complement(Lobe::White, Side::Above),
};
const MISSING_AVG: ChannelInfo = ChannelInfo {
    id: "ms.missing-avg",
    meaning: "1 - E_avg, E_avg = 2 int E mu dmu; the same for every mu",
    range: [0.0, 1.0],
    role: Role::AverageComplement(Lobe::White, Side::Above),
};
const LOBE: ChannelInfo = ChannelInfo {
    id: "ms.lobe",
    meaning: "(1 - E(mu)) / sqrt(pi (1 - E_avg)); 0 where nothing is missing",
    range: [0.0, 1e4],
    role: Role::CompensationLobe(Lobe::White),
};
const TURQUIN: ChannelInfo = ChannelInfo {
    id: "ms.turquin",
    meaning: "1 / E(mu) - 1",
    range: [0.0, 16.0],
    role: Role::Gain(Lobe::White),
};

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "compensation",
    title: "Energy compensation of a reflecting lobe",
    formula: "1 - E, 1 - E_avg, (1 - E) / sqrt(pi (1 - E_avg)), 1 / E - 1, all of the white lobe (F = 1)",
    sources: &[
        Source::new(cite::KULLA_CONTY_2017, "the slides on energy conservation (f_ms)")
            .of(|role| !matches!(role, Role::Gain(_))),
        Source::new(cite::TURQUIN_2019, "Eq. 16, by MaterialX").of(|role| matches!(role, Role::Gain(_))),
    ],
    coordinates: &["mu"],
    layouts: &[
        Layout {
            id: "missing",
            doc: "f_ms = F_ms missing(mu_o) missing(mu_i) / (pi missing_avg)",
            channels: &[MISSING, MISSING_AVG],
        },
        Layout { id: "lobe", doc: "f_ms = F_ms lobe(mu_o) lobe(mu_i)", channels: &[LOBE] },
        Layout { id: "turquin", doc: "f = f_single (1 + F0 turquin(mu_o))", channels: &[TURQUIN] },
    ],
    mix: Mix::Free(&[]),
    model: ModelUse::Split("ggx"),
    params: &[],
    laws: &["finite", "range", "reciprocity", "complement", "honest"],
    axes: default_axes,
    least_tolerance: |_| 0.0,
    blended: true,
    notes: "E is that of F = 1. The errors of E and E_avg are carried through to each channel. lobe grows without bound where mu and \
        alpha go to 0 together (2.8 at alpha = 0.01): give its axis an end. F_ms of a colour is a factor of the shader: F_avg^2 E_avg / \
        (1 - F_avg (1 - E_avg)), or with F_avg once as on the slides.",
    bind,
};

fn default_axes(setting: &Setting<'_>) -> Vec<Axis> {
    let mut axes = match setting.layout.id {
        "lobe" => view_and_roughness(coupled(2.0, 4.0, 1.0), Warp::Power(0.5)),
        "turquin" => view_and_roughness(coupled(2.0, 8.0, 1.0), Warp::Linear),
        _ => white_albedo(),
    };
    if setting.holds("ms.lobe")
        && let Some(roughness) = axes.last_mut()
    {
        // it has no bound as mu and roughness go to 0
        roughness.domain = [0.1, 1.0];
    }
    axes
}

/// What a channel is made of.
#[derive(Clone, Copy, PartialEq)]
enum Part {
    Missing,
    MissingAverage,
    Lobe,
    Gain,
}

struct Compensation {
    sweep: Sweep,
    parts: Vec<Part>,
    average: bool,
    averages: Memo<Estimate>,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    let parts = spec.each(|role| match role {
        Role::Complement(..) => Some(Part::Missing),
        Role::AverageComplement(..) => Some(Part::MissingAverage),
        Role::CompensationLobe(_) => Some(Part::Lobe),
        Role::Gain(_) => Some(Part::Gain),
        _ => None,
    })?;
    let average = parts.iter().any(|p| [Part::MissingAverage, Part::Lobe].contains(p));
    Ok(Box::new(Compensation { sweep: Sweep::new(spec, true)?, parts, average, averages: Memo::new() }))
}

impl Compensation {
    /// The channels, with E and `E_avg` to `inner`.
    fn at(&self, at: &[f64], inner: f64) -> Result<Estimate, TexelError> {
        let model = self.sweep.model(at)?;
        let e = integrate(&*model, self.sweep.view(at), &[Functional::One], inner)?;
        let mut all = Estimate { value: [0.0; MAX_CHANNELS], error: [0.0; MAX_CHANNELS], ..e };
        let avg = if self.average {
            let params = self.sweep.params(at)?;
            self.averages.get(&params, inner, || average(&*model, params.optional("alpha"), inner))?
        } else {
            Estimate::exact([0.0; MAX_CHANNELS])
        };
        // the average is shared by the texels of a row and counted by none: who computed it depends on the threads
        let (albedo, error) = (e.value[0], e.error[0]);
        // the errors of quadrature may put E a little above 1
        let (missing, missing_avg) = ((1.0 - albedo).max(0.0), (1.0 - avg.value[0]).max(0.0));
        for (c, part) in self.parts.iter().enumerate() {
            (all.value[c], all.error[c]) = match part {
                Part::Missing => (missing, error),
                Part::MissingAverage => (missing_avg, avg.error[0]),
                Part::Gain if albedo > 0.0 => (missing / albedo, error / (albedo * albedo)),
                Part::Lobe if missing_avg > 0.0 => {
                    let root = (PI * missing_avg).sqrt();
                    let value = missing / root;
                    (value, error / root + 0.5 * value * avg.error[0] / missing_avg)
                }
                Part::Gain | Part::Lobe => (0.0, 0.0),
            };
        }
        Ok(all)
    }
}

impl Baker for Compensation {
    fn texel(&self, at: &[f64], tolerance: f64) -> Result<Estimate, TexelError> {
        let how = Refinement { tolerance, first: tolerance, share: 0.3, least: 1e-14 };
        refined(how, |inner| self.at(at, inner), |e| largest(e, self.parts.len()))
    }

    fn rule(&self) -> String {
        format!("one-dimensional reduction where the model has one; else {}", self.sweep.rule())
    }
}
