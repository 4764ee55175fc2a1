//! What a file says of itself: one JSON text in every output, equal in all containers.
//!
//! It holds no clock, host, path or thread count: the same recipe gives the same bytes.

use super::axis::Axis;
use super::table::{Channel, Extreme};
use serde::{Deserialize, Serialize};

/// Version of the metadata layout; raised when a field changes its meaning.
///
/// Version 2: a law's `held` became `result` (`held`, `broken`, `not checked`) with `why` and counts; `tolerance_met`; `verified`
/// asks for a law that says what the numbers mean. Files of version 1 are read.
pub const SCHEMA: u32 = 2;

/// Name of the attribute, key or chunk that holds the provenance in a file.
pub const ATTRIBUTE: &str = "brdfbake";

/// Everything needed to use, check and re-make a table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    /// Version of this layout, [`SCHEMA`].
    pub schema: u32,
    /// Program and version.
    pub tool: String,
    /// Name of the recipe, and the identity of the table.
    pub recipe: RecipeId,
    /// Name of the table in its recipe; also the file stem.
    pub name: String,
    /// Which kind of table, its formula and sources.
    pub table: Subject,
    /// Which model, if the table has one.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub model: Option<Subject>,
    /// Axes, fastest first (x, y, z of the texture).
    pub axes: Vec<AxisRecord>,
    /// Channels in file order.
    pub channels: Vec<Channel>,
    /// Integration: rule, tolerance asked for, largest estimate, evaluations.
    pub integration: Integration,
    /// Where the values are parameters of fits: how far the fits are from what they were fitted to.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub residuals: Vec<Residual>,
    /// How the values are stored and what the rounding costs.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub encoding: Option<Encoding>,
    /// How far a bilinear reader is from fresh integrals.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub reconstruction: Option<Reconstruction>,
    /// What the texels hold, where they are not the values at their places.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub texels: Option<TexelRecord>,
    /// How the lengths of the axes were found, if they were searched.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub size: Option<SizeRecord>,
    /// What came of every law of the table.
    pub laws: Vec<LawRecord>,
    /// True if no law is broken or waived, the tolerance is met, and a law other than `finite` and `range` was held.
    pub verified: bool,
    /// Is every texel's estimate within the tolerance? None in files of version 1.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub tolerance_met: Option<bool>,
    /// Laws let through by the recipe, with the reason given there.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub waived: Vec<Waiver>,
}

/// How the lengths of the axes were found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SizeRecord {
    /// Largest error of reading that was asked for, rounding included.
    pub error: f64,
    /// Over the `whole` or the `practical` domain.
    pub domain: String,
    /// Were other warps tried?
    pub warps_searched: bool,
    /// Longest axis that was allowed.
    pub longest: usize,
    /// Tables that were tried in full.
    pub trials: usize,
    /// Error of reading of the table that was found, as the search measured it.
    pub reached: f64,
}

/// The recipe that a file came from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RecipeId {
    /// Name of the recipe.
    pub name: String,
    /// The identity of the table: blake3 over everything that the bytes of its files depend on.
    pub hash: String,
}

/// A table kind or a model: id, parameters, formula, sources.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Subject {
    /// Registry id.
    pub id: String,
    /// Title.
    pub title: String,
    /// The formula, as in `describe`.
    pub formula: String,
    /// Fixed parameters (those that no axis sweeps).
    pub params: serde_json::Map<String, serde_json::Value>,
    /// Sources with equation numbers.
    pub sources: Vec<String>,
}

/// The schema (JSON Schema 2020-12) of an [`AxisRecord`]: what each key means, and the order of domain, warp, direction, texel
/// convention and offset.
pub const AXIS_SCHEMA: &str = include_str!("axis.schema.json");

/// An axis with its maps spelled out; its JSON is that of [`AXIS_SCHEMA`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AxisRecord {
    /// The axis itself.
    #[serde(flatten)]
    pub axis: Axis,
    /// Symbol.
    pub symbol: String,
    /// Unit.
    pub unit: String,
    /// How a derived quantity becomes its base, such as `alpha = roughness * roughness`.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub base: Option<String>,
    /// The texture coordinate that a shader computes from a value.
    pub coordinate: String,
}

impl AxisRecord {
    /// Spells out the maps of an axis.
    #[must_use]
    pub fn new(axis: &Axis) -> AxisRecord {
        AxisRecord {
            symbol: axis.quantity.symbol.to_owned(),
            unit: axis.quantity.unit.to_owned(),
            base: axis.quantity.base_formula(),
            coordinate: axis.coordinate_formula(),
            axis: axis.clone(),
        }
    }
}

/// How the texels were integrated.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Integration {
    /// The rule, in words.
    pub rule: String,
    /// Tolerance asked for (absolute, per channel).
    pub tolerance: f64,
    /// Largest estimated error and where it lies.
    pub largest_error: Extreme,
    /// Integrand evaluations in all.
    pub evaluations: u64,
    /// Texels whose estimate is above the tolerance (0 unless the recipe allows it).
    pub missed: u64,
}

/// How values were rounded.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Encoding {
    /// Storage id: `half`, `float`, `unorm16`, ...
    pub storage: String,
    /// Largest difference between the value (the integral, or what was fitted to it) and the stored one.
    pub largest_error: f64,
    /// Values of the components of a pixel that follow the channels and hold none: `[0, 1]` for two channels as RGBA.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub fill: Vec<f64>,
    /// Names of the components in the file, where they are not the ids of the channels: `[R, G, B]`, for two channels and one of
    /// [`Encoding::fill`], or for one channel written three times.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub names: Vec<String>,
}

/// Errors of the reader's reconstruction, against fresh integrals between the texels.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Reconstruction {
    /// The filter that was assumed.
    pub filter: String,
    /// Points at which it was compared.
    pub points: u64,
    /// Over the whole domain.
    pub whole: Spread,
    /// Over `mu >= 0.05` and `roughness >= 0.09`, if the table has such axes.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub practical: Option<Spread>,
}

/// What fitted texels hold, and what that gains.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TexelRecord {
    /// What the recipe asks for: `least-squares`, `minimax` or `auto`.
    pub asked: String,
    /// What this file holds: that, or `exact` where fitting gained nothing, or a blend; `by-channel` if that differs.
    pub held: String,
    /// What each channel holds, if that differs.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub by_channel: Vec<ChannelTexels>,
    /// What it means for who uses the numbers.
    pub meaning: String,
    /// Points of the truth that they were fitted to, weighted by their area in axis coordinates.
    pub samples: u64,
    /// Largest difference between a texel and the value at its place.
    pub largest_change: f64,
    /// Errors of reading for each choice, as stored; none if the recipe does not measure them.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub choices: Vec<ChoiceRecord>,
}

/// What one channel holds.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ChannelTexels {
    /// Channel id.
    pub channel: String,
    /// `exact`, `least-squares`, `minimax`, or a blend of them such as `0.25 exact + 0.75 minimax`.
    pub held: String,
}

/// Errors of reading for one choice of texels.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ChoiceRecord {
    /// `exact`, `least-squares` or `minimax`.
    pub texels: String,
    /// Over the whole domain.
    pub whole: Spread,
    /// Over the practical domain, if the table has such axes.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub practical: Option<Spread>,
}

/// A measure of how far fitted values are from what they were fitted to, over all texels.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Residual {
    /// The measure, as a formula.
    pub meaning: String,
    /// Its largest and mean value.
    #[serde(flatten)]
    pub spread: Spread,
}

/// Largest and mean error of a set of points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// The largest, with its channel and place.
    pub largest: Extreme,
    /// Mean over points and channels.
    pub mean: f64,
}

/// What came of one law.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(from = "AnyLawRecord")]
pub struct LawRecord {
    /// Law id.
    pub law: String,
    /// What came of it.
    pub result: LawResult,
    /// Why it was not checked, or why some of what it looked at could not be judged.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub why: Option<String>,
    /// Distance to the bound, positive when it holds; see the law for its meaning. None where it is beyond all numbers.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub margin: Option<f64>,
    /// Where the margin is smallest.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub at: String,
    /// How many values, rows or pairs were judged.
    pub checked: u64,
    /// How many were looked at and could not be judged.
    #[serde(skip_serializing_if = "is_zero")]
    pub unchecked: u64,
}

/// Whether a law held.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum LawResult {
    /// Everywhere where it looked.
    #[serde(rename = "held")]
    Held,
    /// Not everywhere.
    #[serde(rename = "broken")]
    Broken,
    /// It found nothing that it could judge.
    #[default]
    #[serde(rename = "not checked")]
    NotChecked,
}

impl LawResult {
    /// In words, as in files.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            LawResult::Held => "held",
            LawResult::Broken => "broken",
            LawResult::NotChecked => "not checked",
        }
    }
}

impl LawRecord {
    /// A law that looked: result, margin, place, numbers of what was and was not judged, and why not.
    #[must_use]
    pub fn seen(
        law: String,
        result: LawResult,
        margin: f64,
        at: String,
        counts: [u64; 2],
        why: Option<String>,
    ) -> LawRecord {
        let [checked, unchecked] = counts;
        LawRecord { law, result, why, margin: margin.is_finite().then_some(margin), at, checked, unchecked }
    }

    /// Did it hold?
    #[must_use]
    pub fn held(&self) -> bool {
        self.result == LawResult::Held
    }
}

#[allow(clippy::trivially_copy_pass_by_ref, reason = "the signature that serde asks for")]
fn is_zero(n: &u64) -> bool {
    *n == 0
}

/// A law as files of any version hold it. In version 1 a law that found nothing to check held with margin 0.
#[derive(Deserialize)]
struct AnyLawRecord {
    law: String,
    result: Option<LawResult>,
    held: Option<bool>,
    why: Option<String>,
    margin: Option<f64>,
    #[serde(default)]
    at: String,
    #[serde(default)]
    checked: u64,
    #[serde(default)]
    unchecked: u64,
}

impl From<AnyLawRecord> for LawRecord {
    fn from(any: AnyLawRecord) -> LawRecord {
        let AnyLawRecord { law, result, held, why, margin, at, checked, unchecked } = any;
        let told = match held {
            Some(true) => LawResult::Held,
            Some(false) => LawResult::Broken,
            None => LawResult::NotChecked,
        };
        LawRecord { law, result: result.unwrap_or(told), why, margin, at, checked, unchecked }
    }
}

/// A broken law that the recipe lets through.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Waiver {
    /// Law id.
    pub law: String,
    /// Reason given in the recipe.
    pub reason: String,
}
