//! `size` to a [`Sizing`]. Ranges are checked later, by the plan.
//!
//! ```toml
//! size = "auto"                                                    # error 2^-10 over the whole domain
//! size = { error = 1e-3, domain = "practical", warps = "search" }  # the same, asked for in full
//! ```
//! Axes that have a `length` keep it; the others are searched. `warps = "search"` also tries other warps on those.

use super::keys::SIZE;
use super::section::{Section, wrong};
use crate::plan::Sizing;
use crate::plan::fault::unknown_word;
use crate::plan::faults::Faults;
use toml::de::DeValue;

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
            let size = Section::new(table, &path, &SIZE, faults);
            let preset = Sizing::default();
            Some(Sizing {
                error: size.number("error", faults).unwrap_or(preset.error),
                practical: size
                    .word("domain", &[("whole", false), ("practical", true)], faults)
                    .unwrap_or(preset.practical),
                warps: size
                    .word("warps", &[("keep", false), ("search", true)], faults)
                    .unwrap_or(preset.warps),
                longest: size.count("longest", faults).unwrap_or(preset.longest),
                axes: Vec::new(),
            })
        }
        other => {
            let expected = "the word \"auto\", or a table { error = 1e-3 }";
            faults.value(section.path("size"), wrong("size", other, expected));
            None
        }
    }
}
