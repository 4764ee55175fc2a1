//! The sheen of Zeltner, Burley and Chiang: multiple scattering in a layer of upright fibres, as one transformed cosine a texel.
//!
//! The layer is solved, not sampled ([`slab`](crate::integrate::slab)): scattering of all orders, the first in closed form.
//! The authors walked at random for two days and ended each walk after 16 events, which at grazing views of thin fibres is too early.

use super::ltc_fit::{self, Sheared};
use super::role::Entry;
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Setting, Source, Spec, TableInfo, TexelError,
    finite,
};
use crate::cite;
use crate::grid::provenance::{Residual, Spread};
use crate::grid::table::{Extreme, Table};
use crate::grid::{Axis, Quantity, Texel};
use crate::integrate::slab::{Medium, Slab};
use crate::integrate::{Estimate, MAX_CHANNELS, Trust, gauss};
use crate::models::{DefaultValue, Param, ParamError};
use crate::terms::sggx;
use glam::DVec3;
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

const A: ChannelInfo = ChannelInfo {
    id: "sheen.a",
    meaning: "a of the sheared lobe",
    range: [0.0, 2.0],
    role: Role::FibreLobe(Entry::A, None),
};
const B: ChannelInfo = ChannelInfo {
    id: "sheen.b",
    meaning: "b of the sheared lobe",
    range: [-1.0, 1.0],
    role: Role::FibreLobe(Entry::B, None),
};
const R: ChannelInfo = unit("sheen.reflectance", "R, the albedo of the layer", Role::FibreAlbedo(None));
const L3: ChannelInfo = ChannelInfo {
    id: "sheen.l3",
    meaning: "(int |f mu_i / R - D|^3 / int (f mu_i / R)^3)^(1/3), over dtheta dphi",
    range: [0.0, 2.0],
    role: Role::FibreDistance,
};

const fn unit(id: &'static str, meaning: &'static str, role: Role) -> ChannelInfo {
    ChannelInfo { id, meaning, range: [0.0, 1.0], role }
}

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "sheen-ltc",
    title: "Sheen of a layer of fibres, as a transformed cosine",
    formula: "R = int f mu_i dwi of a layer of SGGX fibres, sigma = r^2; a and b make int |f mu_i / R - D|^3 dtheta dphi least; \
        D(w) = w.z / pi (a / |v|^2)^2, v = (a w.x + b w.z, a w.y, w.z)",
    sources: &[
        Source::new(cite::ZELTNER_2022, "section 3 (the layer, the lobe and the fit)"),
        Source::new(cite::HEITZ_2015, "Eq. 10, 11 and 13 (the fibres)"),
    ],
    coordinates: &["mu"],
    layouts: &[
        Layout { id: "a-b-r", doc: "M^-1 = [[a, 0, b], [0, a, 0], [0, 0, 1]] and R", channels: &[A, B, R] },
        Layout {
            id: "a-b-r-residual",
            doc: "the same, and how far the lobe is from the layer",
            channels: &[A, B, R, L3],
        },
        Layout { id: "r", doc: "R alone, which takes no fit", channels: &[R] },
        Layout {
            id: "babylon",
            doc: "a = 0.005 + 0.875 r, b = -0.18 + 0.182 g, R = 0.75 b, for eight bits; ends at the ends",
            channels: &[
                unit(
                    "sheen.a-unit",
                    "(a - 0.005) / 0.875, no less than 0, no more than 1",
                    Role::FibreLobe(Entry::A, Some([0.005, 0.875])),
                ),
                unit(
                    "sheen.b-unit",
                    "(b + 0.18) / 0.182, no less than 0, no more than 1",
                    Role::FibreLobe(Entry::B, Some([-0.18, 0.182])),
                ),
                unit("sheen.reflectance-unit", "R / 0.75, no more than 1", Role::FibreAlbedo(Some(0.75))),
            ],
        },
    ],
    mix: Mix::Layouts,
    model: ModelUse::None,
    params: &[Param::number(
        "r",
        "r",
        "roughness of the fibres, sigma = r^2",
        RANGE,
        DefaultValue::Value(0.5),
    )],
    laws: &["finite", "range", "cross-check"],
    axes: default_axes,
    least_tolerance: |_| 2e-3,
    blended: true,
    notes: "Unit depth, density and albedo, black ground. The authors' table stores zeros for a and b below R = 3e-6; here they are \
        fitted down to R = 1e-7, and below that to light that was scattered once. Along the normal the lobe is round. Errors are those of \
        the best lobe: how well it fits is in the channel sheen.l3. Each roughness is a layer that is solved once, for all views.",
    bind,
};

/// Range of the roughness.
const RANGE: [f64; 2] = [0.01, 1.0];

fn default_axes(_: &Setting<'_>) -> Vec<Axis> {
    let axis = |id| {
        let q = Quantity::find(id)?;
        Some(Axis { clamp: Some(RANGE), ..Axis::new(q, 32, Texel::Endpoint) })
    };
    ["mu", "r"].into_iter().filter_map(axis).collect()
}

/// Order of the polynomials, Fourier modes and nodes a panel of the fit, from coarse to fine.
const LEVELS: [(usize, usize, usize); 6] =
    [(4, 5, 6), (5, 7, 8), (6, 10, 10), (7, 14, 12), (8, 20, 14), (10, 24, 16)];

/// Where less is reflected, a and b are those of single scattering.
const DARK: f64 = 1e-7;

/// Where the search for the lobe starts, as a and b.
const STARTS: [[f64; 2]; 3] = [[0.7, -0.02], [0.25, -0.1], [0.08, -0.03]];

/// The fibres as a medium.
struct Fibres {
    sigma: f64,
}

impl Medium for Fibres {
    fn extinction(&self, theta: f64) -> f64 {
        let (sin, cos) = libm::sincos(theta);
        sggx::projected_area(self.sigma, DVec3::new(sin, 0.0, cos))
    }

    fn kernel(&self, from: f64, to: f64, difference: f64, modes: &mut [f64]) {
        sggx::kernel_modes(self.sigma, from, to, difference, modes);
    }

    fn width(&self) -> f64 {
        self.sigma
    }
}

/// Solved layers by roughness and level, each by the thread that needs it first.
type Solved = Mutex<BTreeMap<(u64, usize), Arc<OnceLock<Option<Slab>>>>>;

/// What a channel is.
#[derive(Clone, Copy)]
enum Part {
    /// a or b; coded: from where and over which length.
    Lobe {
        b: bool,
        coded: Option<[f64; 2]>,
    },
    Reflectance {
        scale: Option<f64>,
    },
    Distance,
}

fn part(role: Role) -> Option<Part> {
    match role {
        Role::FibreLobe(entry, coded) => Some(Part::Lobe { b: entry == Entry::B, coded }),
        Role::FibreAlbedo(scale) => Some(Part::Reflectance { scale }),
        Role::FibreDistance => Some(Part::Distance),
        _ => None,
    }
}

struct Sheen {
    mu: usize,
    roughness: Option<usize>,
    fixed: f64,
    parts: Vec<Part>,
    /// Does any channel need a fit?
    fits: bool,
    solved: Solved,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    let parts = spec.each(part)?;
    let fits = parts.iter().any(|p| !matches!(p, Part::Reflectance { .. }));
    Ok(Box::new(Sheen {
        mu: spec.coordinate("mu")?,
        roughness: spec.axis("r"),
        fixed: spec.params.number("r")?,
        parts,
        fits,
        solved: Mutex::default(),
    }))
}

/// What is known of a texel at one level.
#[derive(Debug, Clone, Copy)]
struct FoundMatrix {
    lobe: Sheared,
    reflectance: f64,
}

impl Baker for Sheen {
    fn texel(&self, at: &[f64], tolerance: f64) -> Result<Estimate, TexelError> {
        let (mu, sigma) = (at[self.mu], self.sigma(at)?);
        let mut found: Vec<FoundMatrix> = Vec::new();
        let mut e = Estimate { evaluations: 0, ..Estimate::exact([0.0; MAX_CHANNELS]) };
        for level in 0..LEVELS.len() {
            let next = self.level(sigma, mu, level, found.last())?;
            e.evaluations = e.evaluations.saturating_add(next.lobe.evaluations.max(1));
            found.push(next);
            let [.., first, second, last] = found.as_slice() else { continue };
            for (i, part) in self.parts.iter().enumerate() {
                let of = |f: &FoundMatrix| channel(*part, f);
                e.value[i] = of(last);
                e.error[i] =
                    TRUST.error(level, (of(first) - of(second)).abs(), (of(second) - of(last)).abs());
            }
            if e.largest_error() <= tolerance {
                break;
            }
        }
        finite(e, self.parts.len())
    }

    fn rule(&self) -> String {
        "Galerkin's method in the polar angle, Fourier modes in the azimuth, exact in depth; Newton's method for the lobe; order raised until three agree".to_owned()
    }

    fn residuals(&self, table: &Table) -> Vec<Residual> {
        let of = |id: &str| table.channels.iter().position(|c| c.id == id);
        let Some(channel) = of(L3.id) else { return Vec::new() };
        let values: Vec<f64> = (0..table.grid.len()).map(|texel| table.at(texel)[channel]).collect();
        let Some(worst) = (0..values.len()).max_by(|&p, &q| values[p].total_cmp(&values[q])) else {
            return Vec::new();
        };
        let largest =
            Extreme { value: values[worst], channel: L3.id.to_owned(), at: table.coordinates(worst) };
        let spread = Spread { largest, mean: values.iter().sum::<f64>() / values.len() as f64 };
        vec![Residual { meaning: L3.meaning.to_owned(), spread }]
    }
}

/// The error of the last of three levels: a quarter of the difference before, or the last difference, whichever is more.
///
/// Differences fall by 3 to 20 from level to level, so the last one is a bound; that before guards against chance. Measured in
/// `tests/sheen.rs`.
const TRUST: Trust = Trust { gain: &[1.0], memory: &[0.25] };

/// Value of a channel.
fn channel(part: Part, found: &FoundMatrix) -> f64 {
    match part {
        Part::Lobe { b, coded } => {
            let value = if b { found.lobe.b } else { found.lobe.a };
            coded.map_or(value, |[from, length]| ((value - from) / length).clamp(0.0, 1.0))
        }
        Part::Reflectance { scale } => {
            scale.map_or(found.reflectance, |scale| (found.reflectance / scale).min(1.0))
        }
        Part::Distance => found.lobe.l3,
    }
}

impl Sheen {
    /// `sigma = r^2` at a point.
    fn sigma(&self, at: &[f64]) -> Result<f64, TexelError> {
        let r = self.roughness.map_or(self.fixed, |i| at[i]);
        if (RANGE[0]..=RANGE[1]).contains(&r) {
            return Ok(r * r);
        }
        let [min, max] = RANGE;
        Err(ParamError::Range { model: INFO.id, key: "r", got: r, min, max }.into())
    }

    /// The texel at one level; the lobe of the level before is where the search starts.
    fn level(
        &self,
        sigma: f64,
        mu: f64,
        level: usize,
        before: Option<&FoundMatrix>,
    ) -> Result<FoundMatrix, TexelError> {
        let cell = {
            let mut solved = self.solved.lock().unwrap_or_else(PoisonError::into_inner);
            Arc::clone(solved.entry((sigma.to_bits(), level)).or_default())
        };
        let (order, modes, nodes) = LEVELS[level];
        let modes = if self.fits { modes } else { 1 };
        let slab = cell.get_or_init(|| Slab::solve(&Fibres { sigma }, order, modes));
        let slab = slab.as_ref().ok_or(TexelError::NoRule { what: "a layer of fibres as thin as these" })?;
        let theta = libm::acos(mu.clamp(0.0, 1.0));
        let reflectance = slab.reflected(theta);
        let mut found =
            FoundMatrix { lobe: Sheared { a: 1.0, b: 0.0, l3: 0.0, evaluations: 0 }, reflectance };
        if self.fits {
            let points = lobe(slab, sigma, theta, nodes, reflectance >= DARK);
            let last = before.map(|b| [b.lobe.a, b.lobe.b]);
            let starts = last.as_ref().map_or(&STARTS[..], std::slice::from_ref);
            let fit = ltc_fit::nearest_sheared(points.into_iter(), starts, theta <= 0.0);
            found.lobe = fit.ok_or(TexelError::NoWidth)?;
        }
        Ok(found)
    }
}

/// The density `f mu_i / R` on nodes over half the hemisphere, with weights of dtheta dphi.
fn lobe(slab: &Slab, sigma: f64, theta_o: f64, order: usize, multiple: bool) -> Vec<(DVec3, f64, f64)> {
    let rule = gauss::rule(order);
    let azimuths = azimuths(rule);
    let wo = {
        let (sin, cos) = libm::sincos(theta_o);
        DVec3::new(sin, 0.0, cos)
    };
    let rest = slab.multiple(theta_o);
    let mut modes = Vec::new();
    let mut out = Vec::new();
    let mut albedo = 0.0;
    for edge in slab.edges().windows(2) {
        for (x, w) in rule.nodes.iter().zip(&rule.weights) {
            let theta = edge[0] + (edge[1] - edge[0]) * x;
            let width = (edge[1] - edge[0]) * w;
            let (sin, cos) = libm::sincos(theta);
            modes.clear();
            if multiple {
                rest.modes(theta, &mut modes);
            }
            for &(cos_phi, sin_phi, weight) in &azimuths {
                let wi = DVec3::new(sin * cos_phi, sin * sin_phi, cos);
                let f = sggx::single_scattering(sigma, wo, wi) + series(&modes, cos_phi);
                albedo += 2.0 * width * weight * sin * cos * f;
                out.push((wi, f * cos, width * weight));
            }
        }
    }
    out.iter_mut().for_each(|point| point.1 /= albedo);
    out
}

/// Cosine, sine and weight of azimuths in [0, pi]: single scattering swings within an angle of the far side.
fn azimuths(rule: &gauss::Rule) -> Vec<(f64, f64, f64)> {
    let mut out = Vec::new();
    for (from, to) in [(0.0, 0.0625), (0.0625, 0.125), (0.125, 0.25), (0.25, 0.5), (0.5, 1.0)] {
        for (x, w) in rule.nodes.iter().zip(&rule.weights) {
            let (sin, cos) = libm::sincos(PI * (from + (to - from) * x));
            out.push((-cos, sin, PI * (to - from) * w));
        }
    }
    out
}

/// `c_0 + 2 sum c_m cos(m phi)` by Clenshaw's recurrence.
fn series(modes: &[f64], cos: f64) -> f64 {
    let Some((first, rest)) = modes.split_first() else { return 0.0 };
    let (mut b1, mut b2) = (0.0, 0.0);
    for c in rest.iter().rev() {
        (b1, b2) = (2.0 * c + 2.0 * cos * b1 - b2, b1);
    }
    first + cos * b1 - b2
}
