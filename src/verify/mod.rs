//! Laws that a bake must obey, one file a law, checked before anything is written.
//!
//! A law never calls the baker's integrand where another rule exists: it goes to the model, to a closed form, or to
//! visible-normal sampling with scrambled Sobol points ([`cross_check`]).

pub mod baseline;
pub mod complement;
pub mod cross_check;
pub mod energy;
pub mod finding;
pub mod finite;
pub mod lobe;
pub mod monotone;
pub mod normalised;
pub mod range;
pub mod reciprocity;
pub mod reconstruction;
pub mod reversible;
pub mod seeds;
pub mod split;
pub mod survey;
pub mod tolerance;
pub mod total;

use crate::cancel::{Cancel, Cancelled};
use crate::grid::Table;
use crate::grid::provenance::{LawRecord, Waiver};
use crate::tables::Bound;
pub use finding::Finding;

/// Every law, in the order in which they are checked.
pub static LAWS: &[&Law] = &[
    &finite::LAW,
    &range::LAW,
    &monotone::LAW,
    &energy::LAW,
    &split::LAW,
    &normalised::LAW,
    &total::LAW,
    &reversible::LAW,
    &lobe::LAW,
    &cross_check::LAW,
    &complement::LAW,
    &reciprocity::LAW,
];

/// A law: what it says, and how it is checked on a baked table.
#[derive(Debug)]
pub struct Law {
    /// Id, as in table entries and waivers.
    pub id: &'static str,
    /// The law in one line.
    pub statement: &'static str,
    /// What the margin measures.
    pub margin: &'static str,
    /// Number of the finding that a breach gives.
    pub code: u16,
    /// Checks it.
    pub check: fn(&Case<'_>) -> Outcome,
}

/// What a law is checked on.
#[derive(Debug, Clone, Copy)]
pub struct Case<'a> {
    /// Table kind, model, parameters, axes.
    pub bound: &'a Bound,
    /// The baked values.
    pub table: &'a Table,
    /// Tolerance that was asked for.
    pub tolerance: f64,
    /// Set from outside to stop: what a law finds after that is thrown away.
    pub cancel: &'a Cancel,
}

impl Case<'_> {
    /// False once the check is to stop; loops of laws look at it.
    #[must_use]
    pub fn goes_on(&self) -> bool {
        !self.cancel.is_set()
    }
}

/// The outcome of a law: its smallest margin (negative when it is broken) and where.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// Distance to the bound.
    pub margin: f64,
    /// Where it is smallest.
    pub at: String,
}

impl Outcome {
    /// A law with nothing to check on this table.
    #[must_use]
    pub fn vacuous(why: &str) -> Outcome {
        Outcome { margin: 0.0, at: why.to_owned() }
    }

    /// Keeps the smaller margin; NaN counts as broken.
    pub fn tighten(&mut self, margin: f64, at: impl FnOnce() -> String) {
        let margin = if margin.is_nan() { f64::NEG_INFINITY } else { margin };
        if margin < self.margin || self.at.is_empty() {
            self.margin = margin;
            self.at = at();
        }
    }

    /// The largest margin there is, to be tightened.
    #[must_use]
    pub fn start() -> Outcome {
        Outcome { margin: f64::INFINITY, at: String::new() }
    }
}

/// A table whose laws were checked: the only thing that is encoded.
#[derive(Debug, Clone, PartialEq)]
pub struct Verified {
    table: Table,
    laws: Vec<LawRecord>,
    waived: Vec<Waiver>,
}

impl Verified {
    /// The table.
    #[must_use]
    pub fn table(&self) -> &Table {
        &self.table
    }

    /// The laws that were checked, with their margins.
    #[must_use]
    pub fn laws(&self) -> &[LawRecord] {
        &self.laws
    }

    /// Broken laws that were let through.
    #[must_use]
    pub fn waived(&self) -> &[Waiver] {
        &self.waived
    }
}

/// Finds a law by id.
#[must_use]
pub fn find(id: &str) -> Option<&'static Law> {
    LAWS.iter().copied().find(|l| l.id == id)
}

/// Checks every law of a table kind. Findings of waived laws are returned beside the verified table.
///
/// # Errors
/// The findings of the broken laws that are not waived.
pub fn check(
    bound: &Bound,
    table: Table,
    tolerance: f64,
    waivers: &[Waiver],
) -> Result<(Verified, Vec<Finding>), Vec<Finding>> {
    check_until(&Cancel::new(), bound, table, tolerance, waivers).unwrap_or_else(|Cancelled| Err(Vec::new()))
}

/// [`check`], until it is stopped.
///
/// # Errors
/// [`Cancelled`]; within, what [`check`] returns.
#[allow(clippy::type_complexity, reason = "the result of `check`, or none")]
pub fn check_until(
    cancel: &Cancel,
    bound: &Bound,
    table: Table,
    tolerance: f64,
    waivers: &[Waiver],
) -> Result<Result<(Verified, Vec<Finding>), Vec<Finding>>, Cancelled> {
    let case = Case { bound, table: &table, tolerance, cancel };
    let mut laws = Vec::new();
    let mut broken = Vec::new();
    let mut let_through = Vec::new();
    let mut waived = Vec::new();
    for law in LAWS.iter().filter(|l| bound.spec.kind.laws.contains(&l.id)) {
        let outcome = (law.check)(&case);
        cancel.check()?;
        let held = outcome.margin >= 0.0;
        if !held {
            let finding = Finding::broken(law, &outcome, &bound.spec);
            match waivers.iter().find(|w| w.law == law.id) {
                Some(w) => {
                    waived.push(w.clone());
                    let_through.push(finding.waived(&w.reason));
                }
                None => broken.push(finding),
            }
        }
        laws.push(LawRecord { law: law.id.to_owned(), held, margin: outcome.margin, at: outcome.at });
    }
    if !broken.is_empty() {
        return Ok(Err(broken));
    }
    Ok(Ok((Verified { table, laws, waived }, let_through)))
}
