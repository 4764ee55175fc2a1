//! What holds at the ends of what is declared: models, functions and tables on grids of extremes and at seeded points, in 64 bits, and
//! terms and axis maps in 32 bits.
//!
//! # What is looked for
//! NaN, infinity, negative values, values beyond the declared range, energy gained by a model that claims none, f(wo, wi) and f(wi, wo)
//! that differ where they must not, estimates that independent rules refute, what is refused inside a declared domain, and digits lost.
//!
//! # Digits
//! The noise of a value is half its largest second difference over [`STENCIL`] inputs that lie a few rounding steps apart, where a smooth
//! function is a straight line. What the rounding of the inputs explains is [`ALLOWED`] times condition number times 2^-53; the digits that
//! are kept are those of the noise relative to the value, after what conditioning explains is taken off. Terms that have a form of 32
//! bits are compared with their form of 64 bits instead, which has 29 more.

mod function;
mod grid;
mod model;
mod noise;
pub mod single;
mod table;

use crate::cancel::{Cancel, Cancelled};
use crate::functions::{self, FunctionInfo};
use crate::math::nearest::nearest;
use crate::models::{self, MODELS, ModelInfo};
use crate::tables::{self, TABLES, TableInfo};
use rayon::prelude::*;
use serde::Serialize;

/// Inputs of a look at rounding.
pub const STENCIL: usize = 8;
/// Digits that a value must keep beyond what conditioning explains: half of them.
pub const LEAST_DIGITS: f64 = 8.0;
/// How many times condition number times rounding step a difference may be.
pub const ALLOWED: f64 = 8.0;

/// Something whose declared domain is walked.
#[derive(Debug, Clone, Copy)]
pub enum Subject {
    /// A reflectance model.
    Model(&'static ModelInfo),
    /// A function.
    Function(&'static FunctionInfo),
    /// A kind of table: its texels, and its axes in 32 bits.
    Table(&'static TableInfo),
    /// A term that has a form of 32 bits.
    Single(&'static single::Term),
}

/// What was found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Stress {
    /// `model`, `function`, `table` or `term`.
    pub kind: &'static str,
    /// Registry id.
    pub id: &'static str,
    /// Values that were looked at.
    pub points: u64,
    /// Sets of parameters that the subject refuses, and points where it says that it has no value.
    pub refused: u64,
    /// Decimal digits that are kept at the worst point, beyond what the rounding of the inputs explains.
    pub digits: Worst,
    /// The same in 32 bits; for a table, the largest error of an axis map in texels.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub single: Option<Worst>,
    /// Most evaluations of an integral.
    pub evaluations: Worst,
    /// What does not hold.
    pub faults: Vec<Fault>,
    /// How many there are; the first of each sort is listed.
    pub faulty: u64,
}

/// The worst of something, and where.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Worst {
    /// The value.
    pub value: f64,
    /// Where.
    pub at: String,
}

/// What does not hold.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Fault {
    /// What sort.
    pub fault: &'static str,
    /// Figures.
    pub message: String,
    /// Where.
    pub at: String,
}

impl Stress {
    fn new(kind: &'static str, id: &'static str) -> Stress {
        Stress {
            kind,
            id,
            points: 0,
            refused: 0,
            digits: Worst { value: noise::MOST_DIGITS, at: String::new() },
            single: None,
            evaluations: Worst::default(),
            faults: Vec::new(),
            faulty: 0,
        }
    }

    /// Does all hold?
    #[must_use]
    pub fn holds(&self) -> bool {
        self.faulty == 0
    }

    fn blame(&mut self, fault: &'static str, message: String, at: impl FnOnce() -> String) {
        self.faulty += 1;
        if self.faults.iter().all(|f| f.fault != fault) {
            self.faults.push(Fault { fault, message, at: at() });
        }
    }

    fn digits(&mut self, kept: f64, at: impl FnOnce() -> String) {
        if kept < self.digits.value {
            self.digits = Worst { value: kept, at: at() };
        }
    }

    fn evaluated(&mut self, count: u32, at: impl FnOnce() -> String) {
        if f64::from(count) > self.evaluations.value {
            self.evaluations = Worst { value: f64::from(count), at: at() };
        }
    }
}

/// No subject of this name.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("no model, function, table or term `{got}`{}", .near.as_deref().map(|s| format!("; did you mean `{s}`?")).unwrap_or_default())]
pub struct UnknownSubject {
    /// What was asked for.
    pub got: String,
    /// The nearest.
    pub near: Option<String>,
}

impl Subject {
    /// Everything: models, functions, tables, terms of 32 bits, in the order of their registries.
    pub fn all() -> impl Iterator<Item = Subject> {
        let models = MODELS.iter().map(|m| Subject::Model(m));
        let tables = TABLES.iter().map(|t| Subject::Table(t));
        let terms = single::TERMS.iter().map(Subject::Single);
        models.chain(functions::all().map(Subject::Function)).chain(tables).chain(terms)
    }

    /// By id; models before functions before tables before terms.
    ///
    /// # Errors
    /// [`UnknownSubject`], with the nearest.
    pub fn find(id: &str) -> Result<Subject, UnknownSubject> {
        let model = models::find(id).map(|(m, _)| Subject::Model(m));
        let function = || functions::find(id).map(|(f, _)| Subject::Function(f));
        let table = || tables::find(id).map(Subject::Table);
        let term = || single::TERMS.iter().find(|t| t.id == id).map(Subject::Single);
        model.or_else(function).or_else(table).or_else(term).ok_or_else(|| UnknownSubject {
            got: id.to_owned(),
            near: nearest(id, Subject::all().map(|s| s.id())).map(str::to_owned),
        })
    }

    /// Registry id.
    #[must_use]
    pub fn id(self) -> &'static str {
        match self {
            Subject::Model(m) => m.id,
            Subject::Function(f) => f.id,
            Subject::Table(t) => t.id,
            Subject::Single(t) => t.id,
        }
    }

    /// Walks the declared domain.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn stress(self, cancel: &Cancel) -> Result<Stress, Cancelled> {
        match self {
            Subject::Model(m) => model::stress(m, cancel),
            Subject::Function(f) => function::stress(f, cancel),
            Subject::Table(t) => table::stress(t, cancel),
            Subject::Single(t) => Ok(t.stress()),
        }
    }
}

/// Walks the domains of subjects, on all threads.
///
/// # Errors
/// [`Cancelled`].
pub fn stress(subjects: &[Subject], cancel: &Cancel) -> Result<Vec<Stress>, Cancelled> {
    subjects.par_iter().map(|s| s.stress(cancel)).collect()
}
