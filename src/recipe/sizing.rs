//! `size = "auto"`: lengths of axes that follow from an error of reading.
//!
//! ```toml
//! size = "auto"                                                    # error 2^-10 over the whole domain
//! size = { error = 1e-3, domain = "practical", warps = "search" }  # the same, asked for in full
//! ```
//! Axes that have a `length` keep it; the others are searched. `warps = "search"` also tries other warps on those.

use super::fault::{Fault, Faults};
use super::section::{Section, unknown_word, wrong};
use serde_json::{Value as Json, json};
use toml::de::DeValue;

/// Largest error of reading if none is given.
const DEFAULT_ERROR: f64 = 1.0 / 1024.0;

/// Errors of reading that can be asked for.
const ERRORS: [f64; 2] = [1e-7, 0.5];

/// Longest axes that can be asked for.
const LENGTHS: [usize; 2] = [8, 2048];

/// Length that stands in until the search has found one.
pub(super) const PROVISIONAL: usize = 8;

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

impl Sizing {
    /// Under the keys of a recipe.
    pub(super) fn canonical(&self) -> Json {
        json!({
            "error": self.error,
            "domain": if self.practical { "practical" } else { "whole" },
            "warps": if self.warps { "search" } else { "keep" },
            "longest": self.longest,
        })
    }
}

/// Reads `size`; the axes are filled in later.
pub(super) fn read(section: &Section<'_>, faults: &mut Faults) -> Option<Sizing> {
    match section.get("size")? {
        DeValue::String(word) if word == "auto" => Some(Sizing::default()),
        DeValue::String(word) => {
            faults.value(section.path("size"), unknown_word("size", word, std::iter::once("auto")));
            None
        }
        DeValue::Table(table) => {
            let path = section.path("size");
            let keys = &["error", "domain", "warps", "longest"];
            let size = Section::new(table, &path, "size", keys, faults);
            let mut sizing = Sizing::default();
            if let Some(error) = size.number("error", faults) {
                let [min, max] = ERRORS;
                if !(min..=max).contains(&error) {
                    let fault = Fault::Range { key: "error".to_owned(), got: error, min, max };
                    faults.value(size.path("error"), fault);
                }
                sizing.error = error;
            }
            sizing.practical =
                size.word("domain", &[("whole", false), ("practical", true)], faults).unwrap_or(false);
            sizing.warps = size.word("warps", &[("keep", false), ("search", true)], faults).unwrap_or(false);
            if let Some(longest) = size.count("longest", faults) {
                let [min, max] = LENGTHS;
                if !(min..=max).contains(&longest) {
                    let (got, min, max) = (longest as f64, min as f64, max as f64);
                    faults.value(
                        size.path("longest"),
                        Fault::Range { key: "longest".to_owned(), got, min, max },
                    );
                }
                sizing.longest = longest;
            }
            Some(sizing)
        }
        other => {
            faults.value(
                section.path("size"),
                wrong("size", other, "the word \"auto\", or a table { error = 1e-3 }"),
            );
            None
        }
    }
}
