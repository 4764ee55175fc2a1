//! Laws that a bake must obey, one file a law, checked before anything is written.
//!
//! A law finds its subject by the [`Role`](crate::tables::Role)s of the channels, never by their names, and says what came of
//! looking: it held, it is broken, or it was not checked and why. It never calls the baker's integrand where another rule
//! exists: it goes to the model, to a closed form, to visible-normal sampling with scrambled Sobol points ([`cross_check`]), or to
//! the rules of [`honest`].

#[cfg(feature = "unstable")]
pub mod baseline;
#[cfg(not(feature = "unstable"))]
pub(crate) mod baseline;
pub(crate) mod complement;
#[cfg(feature = "unstable")]
pub mod converge;
#[cfg(not(feature = "unstable"))]
pub(crate) mod converge;
#[cfg(feature = "unstable")]
pub mod cross_check;
#[cfg(not(feature = "unstable"))]
pub(crate) mod cross_check;
pub(crate) mod energy;
pub(crate) mod finding;
pub(crate) mod finite;
#[cfg(feature = "unstable")]
pub mod honest;
#[cfg(not(feature = "unstable"))]
pub(crate) mod honest;
mod linear;
pub(crate) mod lobe;
mod lobes;
pub(crate) mod monotone;
pub(crate) mod normalised;
mod outcome;
pub(crate) mod range;
pub(crate) mod reciprocity;
#[cfg(feature = "unstable")]
pub mod reconstruction;
#[cfg(not(feature = "unstable"))]
pub(crate) mod reconstruction;
pub(crate) mod reversible;
#[cfg(feature = "unstable")]
pub mod seeds;
#[cfg(not(feature = "unstable"))]
pub(crate) mod seeds;
pub(crate) mod split;
#[cfg(feature = "unstable")]
pub mod stress;
#[cfg(not(feature = "unstable"))]
pub(crate) mod stress;
#[cfg(feature = "unstable")]
pub mod survey;
#[cfg(not(feature = "unstable"))]
pub(crate) mod survey;
#[cfg(feature = "unstable")]
pub mod tolerance;
#[cfg(not(feature = "unstable"))]
pub(crate) mod tolerance;
pub(crate) mod total;
mod walk;

use crate::cancel::{Cancel, Cancelled, Steps, Tell, untold};
use crate::grid::Table;
use crate::grid::provenance::{LawRecord, Waiver};
use crate::tables::{Bound, Spec, driver};
pub use finding::{Finding, Severity, Verdict};
pub use outcome::{Outcome, Seen, Watch};
use rayon::prelude::*;

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
    &honest::LAW,
];

/// A law: what it says, of what, and how it is checked on a baked table.
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
    /// True for what any table of numbers obeys: it says nothing of what the numbers mean.
    pub formal: bool,
    /// Has it anything to say of the channels of a table?
    pub concerns: fn(&Spec) -> bool,
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

impl<'a> Case<'a> {
    /// False once the check is to stop; loops of laws look at it.
    #[must_use]
    pub fn goes_on(&self) -> bool {
        !self.cancel.is_set()
    }

    /// Value and error estimate of a channel of a texel.
    #[must_use]
    pub fn at(&self, texel: usize, channel: usize) -> (f64, f64) {
        let i = texel * self.table.channels.len() + channel;
        (self.table.values[i], self.table.errors[i])
    }

    /// Kind, layout, model, parameters and axes.
    #[must_use]
    pub fn spec(&self) -> &'a Spec {
        &self.bound.spec
    }
}

/// A table whose laws were checked: the only thing that is encoded.
#[derive(Debug, Clone, PartialEq)]
pub struct Verified {
    table: Table,
    laws: Vec<LawRecord>,
    waived: Vec<Waiver>,
    missed: usize,
}

impl Verified {
    /// The table.
    #[must_use]
    pub fn table(&self) -> &Table {
        &self.table
    }

    /// What came of every law of the table.
    #[must_use]
    pub fn laws(&self) -> &[LawRecord] {
        &self.laws
    }

    /// Broken laws that were let through.
    #[must_use]
    pub fn waived(&self) -> &[Waiver] {
        &self.waived
    }

    /// Texels whose estimate is above the tolerance.
    #[must_use]
    pub fn missed(&self) -> usize {
        self.missed
    }

    /// Is every estimate within the tolerance?
    #[must_use]
    pub fn tolerance_met(&self) -> bool {
        self.missed == 0
    }

    /// No law is broken or waived, the tolerance is met, and a law that says what the numbers mean was held.
    #[must_use]
    pub fn verified(&self) -> bool {
        let told = |l: &LawRecord| l.held() && find(&l.law).is_some_and(|law| !law.formal);
        self.waived.is_empty() && self.tolerance_met() && self.laws.iter().any(told)
    }
}

/// Finds a law by id.
#[must_use]
pub fn find(id: &str) -> Option<&'static Law> {
    LAWS.iter().copied().find(|l| l.id == id)
}

/// The laws that are checked on a table: those that its kind declares and that have something to say of its channels.
pub fn declared(spec: &Spec) -> impl Iterator<Item = &'static Law> {
    LAWS.iter().copied().filter(|l| spec.kind.laws.contains(&l.id) && (l.concerns)(spec))
}

/// Checks every law of a table. What does not stop a bake is returned beside the verified table: breaches that are waived, laws
/// that could not be checked, texels that miss the tolerance.
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
    check_telling(cancel, bound, table, tolerance, waivers, &untold)
}

/// [`check_until`], telling of each law.
///
/// # Errors
/// As [`check_until`].
#[allow(clippy::type_complexity, reason = "the result of `check`, or none")]
pub fn check_telling(
    cancel: &Cancel,
    bound: &Bound,
    table: Table,
    tolerance: f64,
    waivers: &[Waiver],
    tell: &Tell<'_>,
) -> Result<Result<(Verified, Vec<Finding>), Vec<Finding>>, Cancelled> {
    let case = Case { bound, table: &table, tolerance, cancel };
    let mut laws = Vec::new();
    let mut broken = Vec::new();
    let mut warnings = Vec::new();
    let mut waived = Vec::new();
    let declared: Vec<&Law> = declared(&bound.spec).collect();
    let steps = Steps::new(declared.len(), tell);
    let check = |law: &&Law| {
        let outcome = (law.check)(&case);
        steps.step();
        outcome
    };
    let outcomes: Vec<Outcome> = declared.par_iter().map(check).collect();
    cancel.check()?;
    for (law, outcome) in declared.into_iter().zip(outcomes) {
        match &outcome {
            Outcome::Held(_) => {}
            Outcome::NotChecked(why) => warnings.push(Finding::unchecked(law, why, &bound.spec)),
            Outcome::Broken(seen) => {
                let finding = Finding::broken(law, seen, &bound.spec);
                match waivers.iter().find(|w| w.law == law.id) {
                    Some(w) => {
                        waived.push(w.clone());
                        warnings.push(finding.waived(&w.reason));
                    }
                    None => broken.push(finding),
                }
            }
        }
        laws.push(outcome.record(law.id));
    }
    if !broken.is_empty() {
        return Ok(Err(broken));
    }
    let missed = driver::missed(&table, tolerance);
    if missed > 0 {
        warnings.push(Finding::missed(missed, tolerance, &table, &bound.spec));
    }
    Ok(Ok((Verified { table, laws, waived, missed }, warnings)))
}
