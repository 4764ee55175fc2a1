//! Names that become file names: the same on every system.

use super::fault::Fault;
use super::faults::Faults;
use super::map::MapDraft;
use super::output::{self, Output};
use super::place::Path;
use super::request::{Draft, TableRequest};
use crate::encode::{ENCODERS, Encoder};
use crate::math::shown::show;
use std::collections::HashSet;

/// Most characters of a name.
const LONGEST: usize = 64;

/// Names that Windows keeps for devices, with any extension and in any case.
const DEVICES: &[&str] = &["con", "prn", "aux", "nul"];

pub use crate::encode::beside::MANIFEST;

/// What is wrong with the name of a table, if anything: it becomes the stem of file names.
pub(super) fn table(name: &str) -> Option<Fault> {
    portable("table name", name)
}

/// Checks the file names that tables give themselves: portable, one output each, and no two tables in one file unless
/// the container takes them one behind the other.
pub(super) fn files(drafts: &[Draft], faults: &mut Faults) {
    for (i, draft) in drafts.iter().enumerate() {
        let Some(file) = &draft.request.file else { continue };
        let fault = portable("file name", file).or_else(|| {
            let stem = file.rsplit_once('.').map_or(file.as_str(), |(stem, _)| stem);
            let manifest =
                file.eq_ignore_ascii_case(MANIFEST).then(|| "the manifest has this name".to_owned());
            let why = manifest.or_else(|| {
                let others = drafts.iter().enumerate().filter(|(j, _)| i != *j);
                others.into_iter().find_map(|(j, other)| match &other.request.file {
                    Some(theirs) if j < i => shared(draft, file, other, theirs),
                    Some(_) => None,
                    None => (!other.holes.name && other.request.name.eq_ignore_ascii_case(stem))
                        .then(|| "a table of this name writes files of its own".to_owned()),
                })
            });
            why.map(|why| Fault::Twice { what: "file name", got: show(file), why })
        });
        if let Some(fault) = fault {
            faults.value(Path::table(i).key("file"), fault);
        }
    }
}

/// Checks the name of a table, which is `taken` by it.
pub(super) fn check(draft: &Draft, path: &Path, taken: &mut HashSet<String>, faults: &mut Faults) {
    if draft.holes.name {
        return;
    }
    let name = &draft.request.name;
    if let Some(fault) = table(name) {
        faults.value(path.key("name"), fault);
        return;
    }
    let stems = stems(name, draft.request.outputs.as_deref().unwrap_or_default());
    if let Some(stem) = stems.iter().find(|stem| taken.contains(*stem)) {
        let why = "file names must differ by more than case".to_owned();
        faults.value(path.key("name"), Fault::Twice { what: "table name", got: stem.clone(), why });
    }
    taken.extend(stems);
}

/// Checks the name of a map, which is `taken` by it with the names of its files.
pub(super) fn check_map(draft: &MapDraft, path: &Path, taken: &mut HashSet<String>, faults: &mut Faults) {
    if draft.no_name {
        return;
    }
    let name = &draft.request.name;
    if let Some(fault) = portable("map name", name) {
        faults.value(path.key("name"), fault);
        return;
    }
    let kinds = draft.request.kinds();
    let stems = kinds.iter().map(|k| format!("{name}.{}", k.id()).to_ascii_lowercase());
    let stems: Vec<String> = std::iter::once(name.to_ascii_lowercase()).chain(stems).collect();
    if let Some(stem) = stems.iter().find(|stem| taken.contains(*stem)) {
        let why = "names of maps and tables must differ by more than case".to_owned();
        faults.value(path.key("name"), Fault::Twice { what: "name", got: stem.clone(), why });
    }
    taken.extend(stems);
}

/// What a table takes for itself: its name, and, with two storages in one container, whose files are told apart by it,
/// `name.storage`.
fn stems(name: &str, outputs: &[Output]) -> Vec<String> {
    let mut stems = vec![name.to_ascii_lowercase()];
    for output in outputs {
        if outputs.iter().any(|o| o.is_in(output) && o.storage != output.storage) {
            stems.push(format!("{name}.{}", output.storage.id()).to_ascii_lowercase());
        }
    }
    stems.sort();
    stems.dedup();
    stems
}

/// File names of a table, one an output: `name.exr`, or `name.float.exr` where a container is used twice; or the one that
/// it gives itself.
pub(super) fn of_outputs(request: &TableRequest, outputs: &[Output]) -> Vec<String> {
    if let Some(file) = &request.file {
        return vec![file.clone()];
    }
    let one = |o: &Output| {
        let (name, extension) = (&request.name, o.encoder.extension());
        if outputs.iter().filter(|other| other.is_in(o)).count() > 1 {
            format!("{name}.{}.{extension}", o.storage.id())
        } else {
            format!("{name}.{extension}")
        }
    };
    outputs.iter().map(one).collect()
}

/// Why two tables cannot name these files.
fn shared(a: &Draft, file: &str, b: &Draft, theirs: &str) -> Option<String> {
    if !file.eq_ignore_ascii_case(theirs) {
        return None;
    }
    if file != theirs {
        return Some("file names must differ by more than case".to_owned());
    }
    let all = [a, b].map(|draft| output::listed(&draft.request));
    let whole =
        |ok: fn(&dyn Encoder) -> bool| all.iter().all(|l| !l.is_empty() && l.iter().all(|o| ok(o.encoder)));
    match () {
        () if whole(|e| e.is_bare()) => None,
        () if !whole(|e| e.joins()) => {
            let (bare, others): (Vec<_>, Vec<_>) =
                ENCODERS.iter().filter(|e| e.joins()).partition(|e| e.is_bare());
            let ids = |all: Vec<&&dyn Encoder>| all.iter().map(|e| e.id()).collect::<Vec<_>>().join(", ");
            Some(format!(
                "only containers without a header ({}) hold one table behind the other, and {} tables as parts or layers",
                ids(bare),
                ids(others)
            ))
        }
        () if a.request.outputs != b.request.outputs || lengths(a) != lengths(b) => {
            Some("the layers and parts of a file have one size, storage and options".to_owned())
        }
        () => None,
    }
}

/// Lengths of the axes, where they are given.
fn lengths(draft: &Draft) -> Vec<usize> {
    draft.request.request.axes.iter().flatten().map(|a| a.len).collect()
}

fn portable(what: &'static str, name: &str) -> Option<Fault> {
    let bad = |c: char| !(c.is_ascii_alphanumeric() || "._-".contains(c));
    let why = match () {
        () if name.contains(bad) => "has a character that is not portable in file names",
        () if name.starts_with(['.', '-']) => "starts with a dot or a hyphen",
        () if name.ends_with('.') => "ends with a dot",
        () => common(name)?,
    };
    let allowed = "1 to 64 of A-Z a-z 0-9 . _ -, not starting with . or -, not ending with .";
    Some(Fault::Name { what, got: show(name), why, allowed })
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
