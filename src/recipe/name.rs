//! Names that become file names: the same on every system.

use super::fault::{Fault, show};

/// Most characters of a name.
const LONGEST: usize = 64;

/// Names that Windows keeps for devices, with any extension and in any case.
const DEVICES: &[&str] = &["con", "prn", "aux", "nul"];

/// What is wrong with the name of a table, if anything: it becomes the stem of file names.
pub(super) fn table(name: &str) -> Option<Fault> {
    let bad = |c: char| !(c.is_ascii_alphanumeric() || "._-".contains(c));
    let why = match () {
        () if name.contains(bad) => "has a character that is not portable in file names",
        () if name.starts_with(['.', '-']) => "starts with a dot or a hyphen",
        () if name.ends_with('.') => "ends with a dot",
        () => common(name)?,
    };
    let allowed = "1 to 64 of A-Z a-z 0-9 . _ -, not starting with . or -, not ending with .";
    Some(Fault::Name { what: "table name", got: show(name), why, allowed })
}

/// What is wrong with the name of a recipe, if anything.
pub(super) fn recipe(name: &str) -> Option<Fault> {
    let bad = |c: char| !(c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-');
    let why = match () {
        () if name.contains(bad) => "has a character other than a-z, 0-9 and -",
        () if name.starts_with('-') => "starts with a hyphen",
        () => common(name)?,
    };
    let allowed = "1 to 64 of a-z 0-9 -, not starting with -";
    Some(Fault::Name { what: "recipe name", got: show(name), why, allowed })
}

fn common(name: &str) -> Option<&'static str> {
    let stem = name.split('.').next().unwrap_or(name).to_ascii_lowercase();
    let numbered = |prefix: &str| {
        stem.strip_prefix(prefix).is_some_and(|n| n.len() == 1 && n.bytes().all(|b| b.is_ascii_digit()))
    };
    match () {
        () if name.is_empty() => Some("is empty"),
        () if name.len() > LONGEST => Some("is too long"),
        () if DEVICES.contains(&stem.as_str()) || numbered("com") || numbered("lpt") => {
            Some("is a device on Windows")
        }
        () => None,
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn portable_names_pass_and_others_do_not() {
        for good in ["ggx-dfg", "E_avg", "a", "table.v2", "0", "com", "com10", "nullable", "a..b"] {
            assert_eq!(super::table(good), None, "{good}");
        }
        let long = "x".repeat(65);
        for bad in [
            "", "a/b", "a\\b", "a:b", "..", ".hidden", "-rf", "x.", "nul", "NUL.exr", "Com1", "lpt9.a", "é",
            " a", &long,
        ] {
            assert!(super::table(bad).is_some(), "{bad}");
        }
        for (name, good) in
            [("default", true), ("Default", false), ("a.b", false), ("-a", false), ("con", false)]
        {
            assert_eq!(super::recipe(name).is_none(), good, "{name}");
        }
    }
}
