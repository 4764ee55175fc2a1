//! The matrices of transformed cosines, fitted to a model: the lobes that area lights are shaded with.
//!
//! A shader takes the corners of a light through the inverse matrix, in the frame with the normal as z and the view in
//! the xz plane, and adds the edges up in closed form. The energy is in the table `ltc-magnitude`.

use super::ltc_fit::{self, Family, Fitted};
use super::sweep::Sweep;
use super::{Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Setting, Spec, TableInfo, TexelError, finite};
use crate::cite;
use crate::grid::Axis;
use crate::grid::provenance::{Residual, Spread};
use crate::grid::table::{Extreme, Table};
use crate::integrate::{Estimate, MAX_CHANNELS};
use crate::terms::ltc::Inverse;
use rayon::prelude::*;

/// Entries have no bounds of their own: over `m33` they grow as 1 / alpha.
const WIDE: [f64; 2] = [-3.4e38, 3.4e38];
const UNIT: [f64; 2] = [0.0, 1.0];

const fn entry(id: &'static str, meaning: &'static str) -> ChannelInfo {
    ChannelInfo { id, meaning, range: WIDE }
}

const fn unit(id: &'static str, meaning: &'static str) -> ChannelInfo {
    ChannelInfo { id, meaning, range: UNIT }
}

const M11: ChannelInfo = entry("ltc.m11", "m11 / m22 of the inverse matrix");
const M31: ChannelInfo = entry("ltc.m31", "m31 / m22 of the inverse matrix (row z, column x)");
const M13: ChannelInfo = entry("ltc.m13", "m13 / m22 of the inverse matrix (row x, column z)");
const M33: ChannelInfo = entry("ltc.m33", "m33 / m22 of the inverse matrix");
const L3: ChannelInfo = ChannelInfo {
    id: "ltc.l3",
    meaning: "(int |f mu_i / E - D|^3 / int (f mu_i / E)^3)^(1/3), E = int f mu_i",
    range: [0.0, 2.0],
};
const VARIATION: ChannelInfo = unit("ltc.variation", "1/2 int |f mu_i / E - D|, E = int f mu_i");

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "ltc-matrix",
    title: "LTC matrices",
    formula: "the M^-1 that makes int |f mu_i / E - D|^3 least; D(w) = max(0, v.z) det(M^-1) / (pi |v|^4), v = M^-1 w",
    sources: &[(cite::HEITZ_2016, "Eq. 1 and 3 (D), section 4 (the fit)")],
    coordinates: &["mu"],
    layouts: &[
        Layout {
            id: "over-m22",
            doc: "M^-1 = [[m11, 0, m13], [0, 1, 0], [m31, 0, m33]], as Heitz and Hill's code, three.js, Bevy, PlayCanvas and Ogre read it",
            channels: &[M11, M31, M13, M33],
        },
        Layout {
            id: "over-m33",
            doc: "M^-1 = [[z11, 0, z13], [0, z22, 0], [z31, 0, 1]], as HDRP reads it; grows as 1 / alpha",
            channels: &[
                entry("ltc.z11", "m11 / m33 of the inverse matrix"),
                entry("ltc.z31", "m31 / m33 of the inverse matrix (row z, column x)"),
                entry("ltc.z22", "m22 / m33 of the inverse matrix"),
                entry("ltc.z13", "m13 / m33 of the inverse matrix (row x, column z)"),
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
                entry("ltc.a", "a of the sheared lobe nearest to the model"),
                entry("ltc.b", "b of the sheared lobe nearest to the model"),
                unit("ltc.reflectance", "int f mu_i dwi"),
            ],
        },
    ],
    mix: Mix::Free(&[
        ChannelInfo { id: "ltc.sheared-l3", meaning: "as ltc.l3, of the sheared lobe", range: [0.0, 2.0] },
        unit("ltc.sheared-variation", "as ltc.variation, of the sheared lobe"),
    ]),
    model: ModelUse::Any("ggx"),
    params: &[],
    laws: &["range", "lobe", "reciprocity"],
    axes: default_axes,
    least_tolerance: |_| 1e-3,
    blended: true,
    notes: "The error of a matrix entry is that of the residual of its lobe (ltc.l3), which is what a fit promises: broad lobes and grazing views \
        leave the matrix loose, and other matrices fit as well. Levels are raised until the entries agree too, or end. How well the lobe fits is \
        in the channels ltc.l3 and ltc.variation and, as largest and mean, in every file. Ask for 1e-3, not less. A \
        mirror has no matrix: keep alpha at 1e-5 or more. Of a model with a Fresnel factor that can be split off, f is taken without it. \
        The file's channels go by name: EXR sorts them.",
    bind,
};

/// alpha = 1e-5, as Heitz and Hill's fitter clamps it.
const LEAST_ROUGHNESS: f64 = 0.003_162_277_660_168_379_5;

/// Those of Heitz and Hill, whose readers know them; from broader lobes on where entries grow as 1 / alpha, beyond a half.
fn default_axes(setting: &Setting<'_>) -> Vec<Axis> {
    let grows = ["ltc.z11", "ltc.z31", "ltc.z22", "ltc.z13", "ltc.a", "ltc.b"].iter().any(|id| setting.holds(id));
    super::ltc_magnitude::axes(if grows { 0.1 } else { LEAST_ROUGHNESS })
}

struct Matrix {
    sweep: Sweep,
    channels: Vec<&'static str>,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    // seen askew, an anisotropic lobe is not even in y and has no matrix of this form
    if spec.axis("phi").is_some() {
        let allowed =
            "mu and the numbers of the model: the lobe must be even about the plane of view".to_owned();
        return Err(BindError::IdleAxis { kind: INFO.id, axis: "phi", allowed });
    }
    let splits = spec.model.as_ref().is_some_and(|(info, _)| info.splits);
    let sweep = Sweep::new(spec, splits)?;
    sweep.refuse_mirrors(spec.kind.id, "is a mirror: a delta has no lobe to fit")?;
    Ok(Box::new(Matrix { sweep, channels: spec.layout.ids().collect() }))
}

/// Which fit a channel is taken from.
fn family(id: &str) -> Family {
    match id {
        "ltc.a" | "ltc.b" | "ltc.sheared-l3" | "ltc.sheared-variation" => Family::Sheared,
        _ => Family::Even,
    }
}

impl Baker for Matrix {
    fn texel(&self, at: &[f64], tolerance: f64) -> Result<Estimate, TexelError> {
        let (model, view) = (self.sweep.model(at)?, self.sweep.view(at));
        let mut e = Estimate { evaluations: 0, ..Estimate::exact([0.0; MAX_CHANNELS]) };
        for wanted in [Family::Even, Family::Sheared] {
            let sheared = self.channels.iter().any(|id| family(id) == Family::Sheared);
            // the albedo comes with either
            let mine = |id: &str| {
                if id == "ltc.reflectance" && sheared {
                    wanted == Family::Sheared
                } else {
                    family(id) == wanted
                }
            };
            if !self.channels.iter().any(|id| mine(id)) {
                continue;
            }
            let fitted = ltc_fit::fit(&*model, view, wanted, |f| {
                // NaN is not content
                self.channels.iter().filter(|id| mine(id)).all(|id| channel(id, f).spread <= tolerance)
            })?;
            e.evaluations = e.evaluations.saturating_add(fitted.evaluations);
            for (i, id) in self.channels.iter().enumerate().filter(|(_, id)| mine(id)) {
                let of = channel(id, &fitted);
                (e.value[i], e.error[i]) = (of.value, of.error);
            }
        }
        finite(e, self.channels.len())
    }

    fn rule(&self) -> String {
        format!("Newton's method on nodes of the model's chart and of the lobe; chart: {}", self.sweep.rule())
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
        let inverse = stored(table, texel)?;
        let point = table.grid.texel(texel);
        let model = self.sweep.model(point.values()).ok()?;
        let fit = ltc_fit::judge(&*model, self.sweep.view(point.values()), &inverse, JUDGED_AT).ok()?;
        Some([fit.l3, fit.variation])
    }
}

/// Level of the charts at which the lobes of a finished table are measured.
const JUDGED_AT: f64 = 11.0;

/// The inverse matrix that a texel holds, in whichever layout.
#[must_use]
pub fn stored(table: &Table, texel: usize) -> Option<Inverse> {
    let values = table.at(texel);
    let get = |id: &str| table.channels.iter().position(|c| c.id == id).map(|i| values[i]);
    if let (Some(m11), Some(m31), Some(m13), Some(m33)) =
        (get("ltc.m11"), get("ltc.m31"), get("ltc.m13"), get("ltc.m33"))
    {
        return Some(Inverse { m11, m13, m22: 1.0, m31, m33 });
    }
    if let (Some(m11), Some(m31), Some(m22), Some(m13)) =
        (get("ltc.z11"), get("ltc.z31"), get("ltc.z22"), get("ltc.z13"))
    {
        return Some(Inverse { m11, m13, m22, m31, m33: 1.0 });
    }
    let (a, b) = (get("ltc.a")?, get("ltc.b")?);
    Some(Inverse { m11: a, m13: b, m22: a, m31: 0.0, m33: 1.0 })
}

/// A channel of a fit.
struct Value {
    value: f64,
    /// Estimate: of a matrix entry that of the residual of its lobe, which is what the table promises.
    error: f64,
    /// What the value itself still moves by from level to level: what the fit tries to bring below the tolerance.
    spread: f64,
}

fn channel(id: &str, fitted: &Fitted) -> Value {
    let (m, fit, error) = (&fitted.fit.inverse, &fitted.fit, &fitted.error);
    let entry = |value: f64, spread: f64| Value { value, error: error.l3, spread };
    // over m33, an error of m33 counts too
    let over_m33 = |v: f64| entry(v / m.m33, error.entries * (1.0 + (v / m.m33).abs()) / m.m33.abs());
    let plain = |value: f64, error: f64| Value { value, error, spread: error };
    match id {
        "ltc.m11" => entry(m.m11, error.entries),
        "ltc.m31" => entry(m.m31, error.entries),
        "ltc.m13" => entry(m.m13, error.entries),
        "ltc.m33" => entry(m.m33, error.entries),
        "ltc.z11" => over_m33(m.m11),
        "ltc.z31" => over_m33(m.m31),
        "ltc.z22" | "ltc.a" => over_m33(m.m22),
        "ltc.z13" | "ltc.b" => over_m33(m.m13),
        "ltc.l3" | "ltc.sheared-l3" => plain(fit.l3, error.l3),
        "ltc.variation" | "ltc.sheared-variation" => plain(fit.variation, error.variation),
        _ => plain(fit.albedo, error.albedo),
    }
}
