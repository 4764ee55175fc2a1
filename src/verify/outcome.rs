//! What came of looking: held, broken, or not checked, and why.

use crate::grid::provenance::{LawRecord, LawResult};

/// The outcome of a law.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// It held everywhere where it looked.
    Held(Seen),
    /// It is broken somewhere.
    Broken(Seen),
    /// It found nothing that it could judge, for this reason.
    NotChecked(String),
}

/// What a law saw.
#[derive(Debug, Clone, PartialEq)]
pub struct Seen {
    /// Smallest distance to the bound, negative where the law is broken.
    pub margin: f64,
    /// Where it is smallest.
    pub at: String,
    /// How many values (or rows, or pairs) were judged.
    pub checked: u64,
    /// How many were looked at and could not be judged.
    pub unchecked: u64,
    /// Why the first of those could not.
    pub why: Option<String>,
}

impl Outcome {
    /// True unless it was not checked, or is broken.
    #[must_use]
    pub fn held(&self) -> bool {
        matches!(self, Outcome::Held(_))
    }

    /// As a file holds it.
    #[must_use]
    pub fn record(self, law: &str) -> LawRecord {
        let law = law.to_owned();
        match self {
            Outcome::NotChecked(why) => LawRecord { law, why: Some(why), ..LawRecord::default() },
            Outcome::Held(s) => {
                LawRecord::seen(law, LawResult::Held, s.margin, s.at, [s.checked, s.unchecked], s.why)
            }
            Outcome::Broken(s) => {
                LawRecord::seen(law, LawResult::Broken, s.margin, s.at, [s.checked, s.unchecked], s.why)
            }
        }
    }
}

/// Gathers what a law sees, value by value.
#[derive(Debug, Clone, PartialEq)]
pub struct Watch {
    margin: f64,
    at: String,
    checked: u64,
    unchecked: u64,
    why: Option<String>,
}

impl Default for Watch {
    fn default() -> Watch {
        Watch { margin: f64::INFINITY, at: String::new(), checked: 0, unchecked: 0, why: None }
    }
}

impl Watch {
    /// A value was judged: its distance to the bound, and its place. The smallest is kept; NaN counts as broken.
    pub fn see(&mut self, margin: f64, at: impl FnOnce() -> String) {
        let margin = if margin.is_nan() { f64::NEG_INFINITY } else { margin };
        self.checked += 1;
        if margin < self.margin || self.checked == 1 {
            self.margin = margin;
            self.at = at();
        }
    }

    /// A value could not be judged.
    pub fn miss(&mut self, why: impl FnOnce() -> String) {
        self.unchecked += 1;
        if self.why.is_none() {
            self.why = Some(why());
        }
    }

    /// True once a value is beyond the bound.
    #[must_use]
    pub fn is_broken(&self) -> bool {
        self.checked > 0 && self.margin < 0.0
    }

    /// Number of values that were judged.
    #[must_use]
    pub fn checked(&self) -> u64 {
        self.checked
    }

    /// Why the first value that could not be judged could not.
    #[must_use]
    pub fn why(&self) -> Option<&str> {
        self.why.as_deref()
    }

    /// Adds what was seen elsewhere; of equal margins the first is kept.
    pub fn join(&mut self, other: Watch) {
        if other.checked > 0 && (other.margin < self.margin || self.checked == 0) {
            self.margin = other.margin;
            self.at = other.at;
        }
        self.checked += other.checked;
        self.unchecked += other.unchecked;
        if self.why.is_none() {
            self.why = other.why;
        }
    }

    /// What came of it. `nothing` is the reason if nothing was looked at at all.
    #[must_use]
    pub fn outcome(self, nothing: &str) -> Outcome {
        if self.checked == 0 {
            return Outcome::NotChecked(self.why.unwrap_or_else(|| nothing.to_owned()));
        }
        let broken = self.is_broken();
        let seen = Seen {
            margin: self.margin,
            at: self.at,
            checked: self.checked,
            unchecked: self.unchecked,
            why: self.why,
        };
        if broken { Outcome::Broken(seen) } else { Outcome::Held(seen) }
    }
}
