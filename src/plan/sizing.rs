//! `size = "auto"`: lengths of axes that follow from an error of reading.

use super::fault::Fault;
use super::faults::Faults;
use super::place::Path;
use super::request::TableRequest;
use serde::ser::SerializeStruct;
use serde::{Serialize, Serializer};

/// Largest error of reading if none is given.
const DEFAULT_ERROR: f64 = 1.0 / 1024.0;

/// Errors of reading that can be asked for.
const ERRORS: [f64; 2] = [1e-7, 0.5];

/// Longest axes that can be asked for.
const LENGTHS: [f64; 2] = [8.0, 2048.0];

/// Length that stands in until the search has found one.
pub(crate) const PROVISIONAL: usize = 8;

/// What the lengths of a table must achieve.
#[derive(Debug, Clone, PartialEq)]
pub struct Sizing {
    /// Largest absolute error of a reader between and at the texels, rounding included.
    pub error: f64,
    /// Over the practical part of the domain only?
    pub practical: bool,
    /// Other warps than the given ones may be used.
    pub warps: bool,
    /// Longest axis to try.
    pub longest: usize,
    /// Numbers of the axes that are searched.
    pub axes: Vec<usize>,
}

impl Default for Sizing {
    fn default() -> Sizing {
        Sizing { error: DEFAULT_ERROR, practical: false, warps: false, longest: 256, axes: Vec::new() }
    }
}

/// Under the keys of a recipe. The axes are those without a length.
impl Serialize for Sizing {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut fields = serializer.serialize_struct("Sizing", 4)?;
        fields.serialize_field("error", &self.error)?;
        fields.serialize_field("domain", if self.practical { "practical" } else { "whole" })?;
        fields.serialize_field("warps", if self.warps { "search" } else { "keep" })?;
        fields.serialize_field("longest", &self.longest)?;
        fields.end()
    }
}

/// Checks the numbers, and that there is something to find.
pub(super) fn check(request: &TableRequest, path: &Path, faults: &mut Faults) {
    let Some(size) = &request.size else { return };
    let path = path.key("size");
    let mut range = |key: &str, got: f64, [min, max]: [f64; 2]| {
        if !(min..=max).contains(&got) {
            faults.value(path.key(key), Fault::Range { key: key.to_owned(), got, min, max });
        }
    };
    range("error", size.error, ERRORS);
    range("longest", size.longest as f64, LENGTHS);
    if request.request.axes.is_some() && size.axes.is_empty() {
        faults.value(path, Fault::NothingToSize);
    }
}
