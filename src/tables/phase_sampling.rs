//! Angles with the density of a phase function: the inverse of its cumulative distribution.

use super::default_axes::axis;
use super::phase_function::{PARAMS, SOURCES, Swept};
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Setting, Spec, TableInfo, TexelError,
};
use crate::grid::{Axis, Warp};
use crate::integrate::{Estimate, MAX_CHANNELS};
use std::f64::consts::{PI, TAU};

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "phase-sampling",
    title: "Angles that sample a phase function",
    formula: "cos theta(u) with 2 pi int_-1^cos theta p dcos = u",
    sources: SOURCES,
    coordinates: &["u"],
    layouts: &[
        Layout {
            id: "cosine",
            doc: "cosine of the deflection; the azimuth is 2 pi times a second number",
            channels: &[ChannelInfo {
                id: "cos_theta",
                meaning: "cos theta(u)",
                range: [-1.0, 1.0],
                role: Role::PhaseQuantile { angle: false },
            }],
        },
        Layout {
            id: "angle",
            doc: "the deflection itself, falling from pi to 0: finer near the peak",
            channels: &[ChannelInfo {
                id: "theta",
                meaning: "theta(u), rad",
                range: [0.0, PI],
                role: Role::PhaseQuantile { angle: true },
            }],
        },
    ],
    mix: Mix::Layouts,
    model: ModelUse::None,
    params: PARAMS,
    laws: &["range", "monotone", "honest"],
    axes: default_axes,
    least_tolerance: |_| 0.0,
    blended: true,
    notes: "u = 1 is forward. Axes: u, and the numbers of the phase function: g, draine_alpha; diameter of fog.",
    bind,
};

fn default_axes(setting: &Setting<'_>) -> Vec<Axis> {
    let power = if setting.layout.id == "angle" { 0.5 } else { 0.25 };
    axis("u", 256, [0.0, 1.0], Warp::Power(power)).into_iter().collect()
}

struct Table {
    u: usize,
    swept: Swept,
    phase: &'static str,
    angle: bool,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    Ok(Box::new(Table {
        u: spec.coordinate("u")?,
        swept: Swept::new(spec)?,
        phase: spec.params.choice("phase")?,
        angle: spec.roles().contains(&Role::PhaseQuantile { angle: true }),
    }))
}

impl Baker for Table {
    fn texel(&self, at: &[f64], _tolerance: f64) -> Result<Estimate, TexelError> {
        let phase = self.swept.at(at)?;
        let cos = phase.sample(at[self.u]);
        let mut value = [0.0; MAX_CHANNELS];
        value[0] = if self.angle { libm::acos(cos) } else { cos };
        let mut e = Estimate::exact(value);
        // roots are found to the rounding of the distribution, whose slope is 2 pi p; an error of the cosine is more of the
        // angle near 0 or pi
        let root = match self.phase {
            "fog" => 1e-12,
            "draine" => 1e-14,
            _ => 0.0,
        };
        let slope = TAU * phase.at(libm::acos(cos));
        let error = 4.0 * f64::EPSILON + (root / slope).min(2.0);
        e.error[0] = if self.angle { error / libm::sin(value[0]).max(1e-7) } else { error };
        super::finite(e, 1)
    }

    fn rule(&self) -> String {
        match self.phase {
            "draine" | "fog" => "Newton's method in a bracket on the closed cumulative distribution",
            _ => "closed form",
        }
        .to_owned()
    }
}
