//! A list of faults with their places, as checks find them.

use super::fault::Fault;
use super::place::{Part, Path, Place};

/// The faults found so far, with their places in the request.
#[derive(Debug, Default)]
pub(crate) struct Faults {
    pub(crate) list: Vec<(Place, Fault)>,
    /// Faults that were not kept.
    pub(crate) dropped: usize,
}

/// Faults that are kept; a file of a million unknown keys needs no more.
const KEPT: usize = 10_000;

impl Fault {
    /// What this build leaves out.
    pub(crate) fn without(what: &str, feature: &str) -> Fault {
        let why =
            format!("{what} needs the feature `{feature}` of the crate, which this build does not have");
        Fault::Container { why, remedy: "build the crate with that feature" }
    }
}

impl Faults {
    /// A fault of the value at `path`; of what it is missing in, if there is no such value.
    pub(crate) fn value(&mut self, path: Path, fault: Fault) {
        self.push(Place { path, part: Part::Value }, fault);
    }

    /// A fault of the key at `path`.
    pub(crate) fn key(&mut self, path: Path, fault: Fault) {
        self.push(Place { path, part: Part::Key }, fault);
    }

    pub(crate) fn push(&mut self, place: Place, fault: Fault) {
        if self.list.len() < KEPT {
            self.list.push((place, fault));
        } else {
            self.dropped += 1;
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    pub(crate) fn len(&self) -> usize {
        self.list.len()
    }
}
