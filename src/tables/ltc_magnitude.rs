//! The energy of a transformed cosine: what a shader multiplies the fitted lobe with.
//!
//! A shader scales the form factor of a light by `F0 magnitude + (F90 - F0) fresnel`.

use super::integral::{Functional, integrate};
use super::role::{Lobe, Weight};
use super::sweep::Sweep;
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Source, Spec, TableInfo, TexelError,
};
use crate::cite;
use crate::grid::{Axis, Direction, Grid, Quantity, Texel, Warp};
use crate::integrate::{Estimate, MAX_CHANNELS};
use crate::terms::sphere_light;

const UNIT: [f64; 2] = [0.0, 1.0];

const MAGNITUDE: ChannelInfo = ChannelInfo {
    id: "ltc.magnitude",
    meaning: "int f mu_i dwi, f without its Fresnel factor",
    range: UNIT,
    role: Role::Split(Lobe::White, Weight::One, 1.0),
};
const FRESNEL: ChannelInfo = ChannelInfo {
    id: "ltc.fresnel",
    meaning: "int f (1 - wo.wh)^5 mu_i dwi, f without its Fresnel factor",
    range: UNIT,
    role: Role::Split(Lobe::White, Weight::Schlick, 1.0),
};
const ZERO: ChannelInfo =
    ChannelInfo { id: "ltc.zero", meaning: "0: not used", range: UNIT, role: Role::Unused };
const SPHERE: ChannelInfo = ChannelInfo {
    id: "ltc.sphere",
    meaning: "form factor of a sphere cut by the horizon over sin^2(sigma), by the coordinates of the texture: \
        x = (cos(omega) + 1) / 2, y = sin^2(sigma)",
    range: UNIT,
    role: Role::SphereForm,
};

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "ltc-magnitude",
    title: "LTC magnitude and Fresnel terms",
    formula: "magnitude = int f mu_i dwi, fresnel = int f (1 - wo.wh)^5 mu_i dwi",
    sources: &[
        Source::new(cite::HEITZ_2016, "section 4 (the norm of a lobe)").of(|role| role != Role::SphereForm),
        Source::new(cite::SNYDER_1996, "irradiance of a spherical light")
            .of(|role| matches!(role, Role::SphereForm)),
    ],
    coordinates: &["mu"],
    layouts: &[
        Layout {
            id: "magnitude-fresnel",
            doc: "scale = F0 * magnitude + (F90 - F0) * fresnel",
            channels: &[MAGNITUDE, FRESNEL],
        },
        Layout {
            id: "packed",
            doc: "the second texture of area lights: magnitude, fresnel, 0, form factor of a sphere",
            channels: &[MAGNITUDE, FRESNEL, ZERO, SPHERE],
        },
    ],
    mix: Mix::Free(&[]),
    model: ModelUse::Any("ggx"),
    params: &[],
    laws: &["finite", "range", "energy", "cross-check", "reciprocity", "honest"],
    axes: |setting| if setting.layout.id == "packed" { axes(0.0) } else { super::default_axes::split_sum() },
    least_tolerance: |_| 0.0,
    blended: true,
    notes: "Of a model with a Fresnel factor that can be split off, f is taken without it. The sphere channel is not a function of view and \
        roughness: it sits on the texture's own two coordinates, whatever the axes are, and a clamp on an axis must not \
        reach beyond one texel.",
    bind,
};

/// Roughness by `sqrt(1 - mu)` on endpoints, 64 x 64, as the engines have it.
pub(super) fn axes(least_roughness: f64) -> Vec<Axis> {
    ["roughness", "mu"]
        .into_iter()
        .filter_map(Quantity::find)
        .map(|q| {
            let axis = Axis::new(q, 64, Texel::Endpoint);
            if q.id == "mu" {
                Axis { direction: Direction::Descending, ..axis.warped(Warp::OneMinusPower(0.5)) }
            } else {
                Axis { clamp: (least_roughness > 0.0).then_some([least_roughness, 1.0]), ..axis }
            }
        })
        .collect()
}

/// What a channel is.
#[derive(Clone, Copy)]
enum Part {
    Magnitude,
    Fresnel,
    Zero,
    Sphere,
}

struct Magnitude {
    sweep: Sweep,
    grid: Grid,
    parts: Vec<Part>,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    let splits = spec.model.as_ref().is_some_and(|(info, _)| info.splits);
    let parts = spec.each(|role| match role {
        Role::Split(_, Weight::One, _) => Some(Part::Magnitude),
        Role::Split(_, Weight::Schlick, _) => Some(Part::Fresnel),
        Role::Unused => Some(Part::Zero),
        Role::SphereForm => Some(Part::Sphere),
        _ => None,
    })?;
    Ok(Box::new(Magnitude { sweep: Sweep::new(spec, splits)?, grid: spec.grid.clone(), parts }))
}

impl Baker for Magnitude {
    fn texel(&self, at: &[f64], tolerance: f64) -> Result<Estimate, TexelError> {
        let model = self.sweep.model(at)?;
        let functionals = [Functional::One, Functional::Schlick];
        let both = integrate(&*model, self.sweep.view(at), &functionals, tolerance)?;
        let mut e = Estimate { evaluations: both.evaluations, ..Estimate::exact([0.0; MAX_CHANNELS]) };
        for (i, part) in self.parts.iter().enumerate() {
            (e.value[i], e.error[i]) = match part {
                Part::Magnitude => (both.value[0], both.error[0]),
                Part::Fresnel => (both.value[1], both.error[1]),
                Part::Sphere => (self.sphere(at), 1e-12),
                Part::Zero => (0.0, 0.0),
            };
        }
        Ok(e)
    }

    fn rule(&self) -> String {
        self.sweep.rule()
    }
}

impl Magnitude {
    /// The form factor at the texture's coordinates; a value on the clamp of an axis counts as the end of the axis.
    fn sphere(&self, at: &[f64]) -> f64 {
        let Some(point) = self.grid.point(at) else { return 0.0 };
        let index = self.grid.index(&point);
        let coordinate = |i: usize| {
            let Some(axis) = self.grid.axes().get(i) else { return 0.0 };
            let index = index[i];
            let last = (axis.len - 1) as f64;
            let value = axis.quantity.from_base(at[i]);
            let clamped =
                axis.clamp.is_some_and(|[lo, hi]| (value - lo).abs() < 1e-12 || (value - hi).abs() < 1e-12);
            let index = if clamped && index < 1.0 {
                0.0
            } else if clamped && index > last - 1.0 {
                last
            } else {
                index
            };
            axis.coordinate(index)
        };
        sphere_light::form_factor(2.0 * coordinate(0) - 1.0, coordinate(1))
    }
}
