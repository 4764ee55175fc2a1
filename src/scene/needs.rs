//! What scenes ask for, with every reason, and all that was left out.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;

use serde::{Deserialize, Serialize};

use super::factor::Interval;
use crate::math::shown::show;

/// A material as reports name it.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct MaterialRef {
    /// Name of the scene's file.
    pub file: String,
    /// Position in the file; none for glTF's default material.
    pub index: Option<usize>,
    /// Its name, as in the file.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub name: Option<String>,
}

impl fmt::Display for MaterialRef {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.index, &self.name) {
            (None, _) => f.write_str("the default material"),
            (Some(index), None) => write!(f, "#{index}"),
            (Some(index), Some(name)) => write!(f, "#{index} \"{}\"", show(name)),
        }
    }
}

/// An id: one of this program's own words.
pub type Id = Cow<'static, str>;

/// The values of a quantity over all who ask.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Range {
    /// Smallest.
    pub lo: f64,
    /// Largest.
    pub hi: f64,
    /// The values, rising, if they are constants and at most [`MOST_VALUES`].
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub values: Option<Vec<f64>>,
}

/// Most values that a [`Range`] lists.
pub const MOST_VALUES: usize = 8;

impl Range {
    pub(super) fn new(of: Interval) -> Range {
        Range { lo: of.lo, hi: of.hi, values: of.value().map(|v| vec![v]) }
    }

    pub(super) fn join(&mut self, other: &Range) {
        self.lo = self.lo.min(other.lo);
        self.hi = self.hi.max(other.hi);
        let both = self.values.take().zip(other.values.as_ref()).map(|(mut all, more)| {
            all.extend(more);
            all.sort_by(f64::total_cmp);
            all.dedup();
            all
        });
        self.values = both.filter(|all| all.len() <= MOST_VALUES);
    }

    /// The only value, if there is only one.
    #[must_use]
    pub fn value(&self) -> Option<f64> {
        (self.lo.to_bits() == self.hi.to_bits()).then_some(self.lo)
    }
}

/// Who asks for a table, and why.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AskedBy {
    /// The material; none if the file as a whole asks.
    pub material: MaterialRef,
    /// The layer.
    pub layer: Id,
    /// The layer and its ranges, in words.
    pub why: String,
    /// Smallest and largest value of each quantity that this layer can have.
    pub ranges: BTreeMap<Id, [f64; 2]>,
}

/// A table family that the scenes ask for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Need {
    /// Id of the table family: `ggx`.
    pub table: Id,
    /// What it must cover, by quantity.
    pub ranges: BTreeMap<Id, Range>,
    /// Who asks, in the file's order. Never empty.
    pub asked_by: Vec<AskedBy>,
}

/// Why something asks for no table here.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LeftOutKind {
    /// It needs none: the picture is complete without it.
    AsksForNothing,
    /// It is never seen.
    Unused,
    /// Another material model takes the place of glTF's: nothing here knows it.
    ReplacedShading,
    /// It needs a table that cannot be baked: the picture is not complete.
    NotSupported,
    /// What it needs is not known.
    Unknown,
}

/// Something that was looked at and asks for no table. Nothing is left out in silence.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LeftOut {
    /// Why, in one word for programs.
    pub kind: LeftOutKind,
    /// An extension, `material`, `base layer`, or `file`.
    pub what: String,
    /// Why, in words.
    pub why: String,
    /// The materials that it concerns; empty if it concerns the file.
    pub materials: Vec<MaterialRef>,
}

impl fmt::Display for LeftOut {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const SHOWN: usize = 4;
        write!(f, "{}: {}", show(&self.what), self.why)?;
        for (i, material) in self.materials.iter().take(SHOWN).enumerate() {
            write!(f, "{}{material}", if i == 0 { " (" } else { ", " })?;
        }
        match self.materials.len() {
            0 => Ok(()),
            n if n > SHOWN => write!(f, " and {} more)", n - SHOWN),
            _ => f.write_str(")"),
        }
    }
}

/// All that scenes ask for and all that they do not.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Needs {
    /// The tables to bake.
    pub needs: Vec<Need>,
    /// All else that was looked at.
    pub left_out: Vec<LeftOut>,
}

impl Needs {
    /// Gives the scene's file another name, wherever it is named.
    pub fn rename(&mut self, from: &str, to: &str) {
        let askers = self.needs.iter_mut().flat_map(|n| &mut n.asked_by).map(|a| &mut a.material);
        let others = self.left_out.iter_mut().flat_map(|l| &mut l.materials);
        for material in askers.chain(others).filter(|m| m.file == from) {
            to.clone_into(&mut material.file);
        }
    }

    /// Is something needed and not baked, or not known?
    #[must_use]
    pub fn in_doubt(&self) -> bool {
        self.left_out.iter().any(|l| matches!(l.kind, LeftOutKind::NotSupported | LeftOutKind::Unknown))
    }
}
