//! The matrices of transformed cosines, fitted to a model: the lobes that area lights are shaded with.
//!
//! A shader takes the corners of a light through the inverse matrix, in the frame with the normal as z and the view in
//! the xz plane, and adds the edges up in closed form. The energy is in the table `ltc-magnitude`.

use super::ltc_fit::{self, Family, Fitted, Known};
use super::role::{Distance, Entry, Fitted as Kind, Light, Lobe, Side};
use super::sweep::Sweep;
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Setting, Source, Spec, TableInfo, TexelError,
    finite,
};
use crate::cite;
use crate::grid::Axis;
use crate::grid::provenance::{Residual, Spread};
use crate::grid::table::{Extreme, Table};
use crate::integrate::{Estimate, MAX_CHANNELS};
use crate::models::Params;
use crate::terms::ltc::Inverse;
use rayon::prelude::*;

/// Entries have no bounds of their own: over `m33` they grow as 1 / alpha.
const WIDE: [f64; 2] = [-3.4e38, 3.4e38];
const UNIT: [f64; 2] = [0.0, 1.0];

const fn entry(id: &'static str, meaning: &'static str, entry: Entry) -> ChannelInfo {
    ChannelInfo { id, meaning, range: WIDE, role: Role::Matrix(Lobe::White, entry) }
}

const fn unit(id: &'static str, meaning: &'static str, role: Role) -> ChannelInfo {
    ChannelInfo { id, meaning, range: UNIT, role }
}

const fn distance(family: Kind, distance: Distance) -> Role {
    Role::FitDistance(Lobe::White, family, distance)
}

const M11: ChannelInfo = entry("ltc.m11", "m11 / m22 of the inverse matrix", Entry::M11);
const M31: ChannelInfo = entry("ltc.m31", "m31 / m22 of the inverse matrix (row z, column x)", Entry::M31);
const M13: ChannelInfo = entry("ltc.m13", "m13 / m22 of the inverse matrix (row x, column z)", Entry::M13);
const M33: ChannelInfo = entry("ltc.m33", "m33 / m22 of the inverse matrix", Entry::M33);
const L3: ChannelInfo = ChannelInfo {
    id: "ltc.l3",
    meaning: "(int |f mu_i / E - D|^3 / int (f mu_i / E)^3)^(1/3), E = int f mu_i",
    range: [0.0, 2.0],
    role: distance(Kind::Even, Distance::Cubic),
};
const VARIATION: ChannelInfo = unit(
    "ltc.variation",
    "1/2 int |f mu_i / E - D|, E = int f mu_i",
    distance(Kind::Even, Distance::Variation),
);

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "ltc-matrix",
    title: "LTC matrices",
    formula: "the M^-1 that makes int |f mu_i / E - D|^3 least; D(w) = max(0, v.z) det(M^-1) / (pi |v|^4), v = M^-1 w",
    sources: &[Source::new(cite::HEITZ_2016, "Eq. 1 and 3 (D), section 4 (the fit)")],
    coordinates: &["mu"],
    layouts: &[
        Layout {
            id: "over-m22",
            doc: "M^-1 = [[m11, 0, m13], [0, 1, 0], [m31, 0, m33]], as Heitz and Hill's code, three.js, Bevy, PlayCanvas and Ogre read it",
            channels: &[M11, M31, M13, M33],
        },
        Layout {
            id: "over-m33",
            doc: "M^-1 = [[z11, 0, z13], [0, z22, 0], [z31, 0, 1]], as HDRP reads it; grows as 1 / alpha. A lobe that does not see the normal has no such matrix: there z31 = 0",
            channels: &[
                entry("ltc.z11", "m11 / m33 of the inverse matrix", Entry::Z11),
                entry("ltc.z31", "m31 / m33 of the inverse matrix (row z, column x)", Entry::Z31),
                entry("ltc.z22", "m22 / m33 of the inverse matrix", Entry::Z22),
                entry("ltc.z13", "m13 / m33 of the inverse matrix (row x, column z)", Entry::Z13),
            ],
        },
        Layout {
            id: "residual",
            doc: "how far the fitted lobes are from the model",
            channels: &[L3, VARIATION],
        },
        Layout {
            id: "over-m22-residual",
            doc: "the matrix as over-m22, and how far its lobe is from the model",
            channels: &[M11, M31, M13, M33, L3, VARIATION],
        },
        Layout {
            id: "sheared",
            doc: "M^-1 = [[a, 0, b], [0, a, 0], [0, 0, 1]] and the albedo, as the sheen of Zeltner et al. is stored",
            channels: &[
                entry("ltc.a", "a of the sheared lobe nearest to the model", Entry::A),
                entry("ltc.b", "b of the sheared lobe nearest to the model", Entry::B),
                unit(
                    "ltc.reflectance",
                    "int f mu_i dwi",
                    Role::Albedo(Lobe::White, Light::Reflected, Side::Above),
                ),
            ],
        },
    ],
    mix: Mix::Free(&[
        ChannelInfo {
            id: "ltc.sheared-l3",
            meaning: "as ltc.l3, of the sheared lobe",
            range: [0.0, 2.0],
            role: distance(Kind::Sheared, Distance::Cubic),
        },
        unit(
            "ltc.sheared-variation",
            "as ltc.variation, of the sheared lobe",
            distance(Kind::Sheared, Distance::Variation),
        ),
    ]),
    model: ModelUse::Any("ggx"),
    params: &[],
    laws: &["range", "energy", "lobe", "cross-check", "reciprocity", "honest"],
    axes: default_axes,
    // two numbers fit a lobe that is half below the horizon less surely than four
    least_tolerance: |s| if s.holds("ltc.a") || s.holds("ltc.b") { 2.5e-3 } else { 1e-3 },
    blended: true,
    notes: "The error of a matrix entry is that of the residual of its lobe (ltc.l3), which is what a fit promises: broad lobes and grazing views \
        leave the matrix loose, and other matrices fit as well. Levels are raised until the entries agree too, or end. How well the lobe fits is \
        in the channels ltc.l3 and ltc.variation and, as largest and mean, in every file. Ask for 1e-3, not less. A \
        mirror has no matrix: keep alpha at 1e-5 or more. Nor has a lobe whose cube has no integral, as that of V-shaped grooves for a view in \
        the horizon: by default its views begin at cos 1.57, where Heitz and Hill's fitter begins. Of a model with a Fresnel factor that can be split off, f is taken without it. \
        The file's channels go by name: EXR sorts them.",
    bind,
};

/// alpha = 1e-5, as Heitz and Hill's fitter clamps it.
const LEAST_ROUGHNESS: f64 = 0.003_162_277_660_168_379_5;

/// cos 1.57, the most grazing view of the same fitter.
const LEAST_MU: f64 = 0.000_796_326_710_733_263_3;

/// Most texels in the horizon whose lobes are looked at.
const LOOKED_AT: usize = 16;

struct Matrix {
    sweep: Sweep,
    roles: Vec<Role>,
    parts: Vec<Part>,
}

/// What a channel is.
#[derive(Clone, Copy)]
enum Part {
    Entry(Entry),
    Distance(Kind, Distance),
    Albedo,
}

fn part(role: Role) -> Option<Part> {
    match role {
        Role::Matrix(_, entry) => Some(Part::Entry(entry)),
        Role::FitDistance(_, family, distance) => Some(Part::Distance(family, distance)),
        Role::Albedo(..) => Some(Part::Albedo),
        _ => None,
    }
}

/// Those of Heitz and Hill, whose readers know them; from broader lobes on where entries grow as 1 / alpha, beyond a half.
fn default_axes(setting: &Setting<'_>) -> Vec<Axis> {
    let grows = |role: Role| {
        use Entry::{A, B, Z11, Z13, Z22, Z31};
        matches!(role, Role::Matrix(_, Z11 | Z13 | Z22 | Z31 | A | B))
    };
    let grows = setting.layout.channels.iter().any(|c| grows(c.role));
    let mut axes = super::ltc_magnitude::axes(if grows { 0.1 } else { LEAST_ROUGHNESS });
    let model = setting.model.and_then(|info| {
        let params = Params::resolve(info.id, info.params, []).ok()?;
        (info.build)(&params).ok()
    });
    if model.is_some_and(|m| ltc_fit::has_pole(&*m)) {
        axes.iter_mut().filter(|a| a.quantity.id == "mu").for_each(|a| a.clamp = Some([LEAST_MU, 1.0]));
    }
    axes
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    // seen askew, an anisotropic lobe is not even in y and has no matrix of this form
    if let Some(axis) = ["phi", "rotation"].into_iter().find(|id| spec.axis(id).is_some()) {
        let allowed =
            "mu and the numbers of the model: the lobe must be even about the plane of view".to_owned();
        return Err(BindError::IdleAxis { kind: INFO.id, axis, allowed });
    }
    let splits = spec.model.as_ref().is_some_and(|(info, _)| info.splits);
    let sweep = Sweep::new(spec, splits)?;
    sweep.refuse_mirrors(spec.kind.id, "is a mirror: a delta has no lobe to fit")?;
    let parts = spec.each(part)?;
    if parts.iter().any(|p| family(*p).is_some()) {
        refuse_poles(spec, &sweep)?;
    }
    Ok(Box::new(Matrix { sweep, roles: spec.roles(), parts }))
}

/// Refuses views in the horizon of a model whose lobe has no integral of its cube there.
fn refuse_poles(spec: &Spec, sweep: &Sweep) -> Result<(), BindError> {
    let grid = &spec.grid;
    let in_horizon: Vec<usize> =
        (0..grid.len()).filter(|t| sweep.mu(grid.texel(*t).values()).abs() <= 0.0).collect();
    for texel in in_horizon.iter().step_by(in_horizon.len().div_ceil(LOOKED_AT).max(1)) {
        // what the model refuses is told with its place when it is baked
        if sweep.model(grid.texel(*texel).values()).is_ok_and(|m| ltc_fit::has_pole(&*m)) {
            let why = "has no fit at mu = 0: the integral of the cube of its lobe is infinite there; give the axis mu \
                `clamp = [0.0008, 1]`, or a domain without 0";
            return Err(BindError::Model { kind: spec.kind.id, model: sweep.info().id.to_owned(), why });
        }
    }
    Ok(())
}

/// Which fit a channel is taken from; an albedo comes with either.
fn family(part: Part) -> Option<Family> {
    match part {
        Part::Entry(Entry::A | Entry::B) | Part::Distance(Kind::Sheared, _) => Some(Family::Sheared),
        Part::Entry(_) | Part::Distance(Kind::Even, _) => Some(Family::Even),
        Part::Albedo => None,
    }
}

impl Baker for Matrix {
    fn texel(&self, at: &[f64], tolerance: f64) -> Result<Estimate, TexelError> {
        let (model, view) = (self.sweep.model(at)?, self.sweep.view(at));
        let mut e = Estimate { evaluations: 0, ..Estimate::exact([0.0; MAX_CHANNELS]) };
        let sheared = self.parts.iter().any(|p| family(*p) == Some(Family::Sheared));
        let shared = if sheared { Family::Sheared } else { Family::Even };
        for wanted in [Family::Even, Family::Sheared] {
            let mine = |part: Part| family(part).unwrap_or(shared) == wanted;
            if !self.parts.iter().any(|p| mine(*p)) {
                continue;
            }
            let fit = |family| ltc_fit::fit(&*model, view, family, |f| known(f, tolerance));
            let mut fitted = fit(wanted)?;
            e.evaluations = e.evaluations.saturating_add(fitted.evaluations);
            if fitted.fit.inverse.m33 <= 0.0 && self.parts.iter().any(|p| mine(*p) && over_m33(*p)) {
                fitted = fit(Family::Level)?;
                e.evaluations = e.evaluations.saturating_add(fitted.evaluations);
            }
            for (i, part) in self.parts.iter().enumerate().filter(|(_, p)| mine(**p)) {
                let of = channel(*part, &fitted);
                (e.value[i], e.error[i]) = (of.value, of.error);
            }
        }
        finite(e, self.parts.len())
    }

    fn rule(&self) -> String {
        format!("Newton's method on nodes of the model's chart and of the lobe; chart: {}", self.sweep.rule())
    }

    fn distance(&self, at: &[f64], values: &[f64]) -> Option<[f64; 2]> {
        let inverse = stored(&self.roles, values)?;
        let (fit, _) = ltc_fit::judged(&*self.sweep.model(at).ok()?, self.sweep.view(at), &inverse).ok()?;
        Some([fit.l3, 2.0 * fit.variation])
    }

    fn residuals(&self, table: &Table) -> Vec<Residual> {
        let judged: Vec<Option<[f64; 2]>> =
            (0..table.grid.len()).into_par_iter().map(|texel| self.judge(table, texel)).collect();
        let of = |k: usize, channel: &ChannelInfo| {
            let (mut worst, mut largest, mut sum, mut count) = (0, 0.0, 0.0, 0.0);
            for (texel, pair) in judged.iter().enumerate() {
                let Some(value) = pair.map(|p| p[k]) else { continue };
                sum += value;
                count += 1.0;
                if value > largest {
                    (worst, largest) = (texel, value);
                }
            }
            let largest =
                Extreme { value: largest, channel: channel.id.to_owned(), at: table.coordinates(worst) };
            let spread = Spread { largest, mean: sum / f64::max(count, 1.0) };
            (count > 0.0).then(|| Residual { meaning: channel.meaning.to_owned(), spread })
        };
        [of(0, &L3), of(1, &VARIATION)].into_iter().flatten().collect()
    }
}

impl Matrix {
    /// L3 error and total variation of the matrix of a texel, if the table holds one.
    fn judge(&self, table: &Table, texel: usize) -> Option<[f64; 2]> {
        let [l3, l1] = self.distance(table.grid.texel(texel).values(), table.at(texel))?;
        Some([l3, 0.5 * l1])
    }
}

/// The inverse matrix that the values of a texel hold, in whichever layout.
#[must_use]
pub fn stored(roles: &[Role], values: &[f64]) -> Option<Inverse> {
    let get = |entry: Entry| {
        let is = |role: &Role| matches!(role, Role::Matrix(_, e) if *e == entry);
        roles.iter().position(is).and_then(|i| values.get(i)).copied()
    };
    if let (Some(m11), Some(m31), Some(m13), Some(m33)) =
        (get(Entry::M11), get(Entry::M31), get(Entry::M13), get(Entry::M33))
    {
        return Some(Inverse { m11, m13, m22: 1.0, m31, m33 });
    }
    if let (Some(m11), Some(m31), Some(m22), Some(m13)) =
        (get(Entry::Z11), get(Entry::Z31), get(Entry::Z22), get(Entry::Z13))
    {
        return Some(Inverse { m11, m13, m22, m31, m33: 1.0 });
    }
    let (a, b) = (get(Entry::A)?, get(Entry::B)?);
    Some(Inverse { m11: a, m13: b, m22: a, m31: 0.0, m33: 1.0 })
}

/// A channel of a fit.
struct Value {
    value: f64,
    /// Estimate: of a matrix entry that of the residual of its lobe, which is what the table promises.
    error: f64,
}

/// Is a fit as good as it is asked for, whatever channels are taken from it? Its lobe is, and its entries over `m33`, which agree last.
/// NaN is not.
fn known(fitted: &Fitted, tolerance: f64) -> Known {
    let (m, error) = (&fitted.fit.inverse, &fitted.error);
    let largest = [m.m11, m.m22, m.m13, m.m31].into_iter().map(f64::abs).fold(0.0, f64::max);
    let entries = error.entries * (1.0 + largest / m.m33.abs()) / m.m33.abs();
    match [error.l3, error.variation, error.albedo].iter().all(|e| *e <= tolerance) {
        false => Known::Neither,
        true if entries <= tolerance => Known::Wholly,
        true => Known::Lobe,
    }
}

/// Is it an entry over `m33`, which means nothing where that is not positive?
fn over_m33(part: Part) -> bool {
    matches!(part, Part::Entry(Entry::Z11 | Entry::Z31 | Entry::Z22 | Entry::Z13))
}

fn channel(part: Part, fitted: &Fitted) -> Value {
    let (m, fit, error) = (&fitted.fit.inverse, &fitted.fit, &fitted.error);
    let entry = |value: f64| Value { value, error: error.l3 };
    let over = |v: f64| entry(v / m.m33);
    let plain = |value: f64, error: f64| Value { value, error };
    match part {
        Part::Entry(Entry::M11) => entry(m.m11),
        Part::Entry(Entry::M31) => entry(m.m31),
        Part::Entry(Entry::M13) => entry(m.m13),
        Part::Entry(Entry::M33) => entry(m.m33),
        Part::Entry(Entry::Z11) => over(m.m11),
        Part::Entry(Entry::Z31) => over(m.m31),
        Part::Entry(Entry::Z22 | Entry::A) => over(m.m22),
        Part::Entry(Entry::Z13 | Entry::B) => over(m.m13),
        Part::Distance(_, Distance::Cubic) => plain(fit.l3, error.l3),
        Part::Distance(_, Distance::Variation) => plain(fit.variation, error.variation),
        Part::Albedo => plain(fit.albedo, error.albedo),
    }
}
