//! The registries are complete and consistent: one file an entry, ids in kebab-case, sources with equation numbers.
#![allow(clippy::unwrap_used, reason = "test")]

use brdfbake::functions;
use brdfbake::grid::Quantity;
use brdfbake::models::{DefaultValue, Kind, MODELS, Param, Params};
use brdfbake::tables::{ModelUse, TABLES};
use brdfbake::verify::LAWS;
use std::collections::BTreeSet;
use std::path::Path;

/// Names of the files of a room that hold an entry: those with `pub static NAME`.
fn entries(room: &str, marker: &str) -> BTreeSet<String> {
    let dir = Path::new(env!("CARGO_MANIFEST_DIR")).join("src").join(room);
    std::fs::read_dir(dir)
        .unwrap()
        .map(|e| e.unwrap().path())
        .filter(|p| p.extension().is_some_and(|e| e == "rs"))
        .filter(|p| std::fs::read_to_string(p).unwrap().contains(marker))
        .map(|p| p.file_stem().unwrap().to_string_lossy().replace('_', "-"))
        .collect()
}

fn check_id(id: &str) {
    assert!(
        id.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-'),
        "{id} is not kebab-case"
    );
}

fn check_params(owner: &str, params: &[Param]) {
    for (i, p) in params.iter().enumerate() {
        assert!(!p.doc.is_empty(), "{owner}.{}: no doc", p.id);
        assert!(params[..i].iter().all(|q| q.id != p.id), "{owner}.{} twice", p.id);
        match p.kind {
            Kind::Number { min, max, preset } => {
                assert!(min < max, "{owner}.{}: empty range", p.id);
                match preset {
                    DefaultValue::Value(v) => {
                        assert!((min..=max).contains(&v), "{owner}.{}: default out of range", p.id)
                    }
                    DefaultValue::Of(id) => {
                        assert!(params[..i].iter().any(|q| q.id == id), "{owner}.{}: `{id}`", p.id)
                    }
                }
            }
            Kind::Choice(words) => assert!(words.len() > 1, "{owner}.{}: nothing to choose", p.id),
            Kind::Rows { columns, preset } => {
                assert!(!columns.is_empty(), "{owner}.{}: rows of nothing", p.id);
                for row in preset {
                    assert_eq!(row.len(), columns.len(), "{owner}.{}: default row", p.id);
                }
            }
        }
    }
}

#[test]
fn models_are_complete() {
    let ids: BTreeSet<String> = MODELS.iter().map(|m| m.id.to_owned()).collect();
    assert_eq!(ids.len(), MODELS.len(), "an id is used twice");
    assert_eq!(ids, entries("models", "pub static INFO: ModelInfo"), "files and registry differ");
    for m in MODELS {
        check_id(m.id);
        check_params(m.id, m.params);
        assert!(!m.sources.is_empty() && m.sources.iter().all(|s| !s.1.is_empty()), "{}: sources", m.id);
        assert!(!m.known.is_empty(), "{}: no known value", m.id);
        assert!(!m.formula.is_empty() && !m.notes.is_empty(), "{}: formula or notes", m.id);
        for a in m.also {
            let taken = MODELS.iter().flat_map(|o| o.also).filter(|b| b.name == a.name).count();
            assert!(taken == 1 && !ids.contains(a.name), "{} is not the name of one model", a.name);
        }
        if m.splits {
            assert!(["f0", "f90"].iter().all(|id| m.params.iter().any(|p| p.id == *id)), "{}: f0, f90", m.id);
        }
    }
}

#[test]
fn functions_are_complete() {
    let ids: BTreeSet<&str> = functions::all().map(|f| f.id).collect();
    assert_eq!(ids.len(), functions::all().count(), "an id is used twice");
    assert_eq!(functions::FAMILIES.len(), entries("functions", "pub static ALL: &[FunctionInfo]").len());
    for f in functions::all() {
        check_id(f.id);
        check_params(f.id, f.params);
        assert!(!f.sources.is_empty() && f.sources.iter().all(|s| !s.1.is_empty()), "{}: sources", f.id);
        assert!(!f.known.is_empty(), "{}: no known value", f.id);
        assert!([f.title, f.formula, f.notes, f.unit].iter().all(|t| !t.is_empty()), "{}: a text", f.id);
        assert!(f.range[0] < f.range[1], "{}: range", f.id);
        for a in f.also {
            for (key, _) in a.set {
                assert!(f.params.iter().any(|p| p.id == *key), "{}: {} implies {key}", f.id, a.name);
            }
        }
    }
}

#[test]
fn tables_are_complete() {
    let ids: BTreeSet<String> = TABLES.iter().map(|t| t.id.to_owned()).collect();
    assert_eq!(ids.len(), TABLES.len(), "an id is used twice");
    assert_eq!(ids, entries("tables", "pub static INFO: TableInfo"), "files and registry differ");
    for t in TABLES {
        check_id(t.id);
        check_params(t.id, t.params);
        assert!(!t.sources.is_empty() && t.sources.iter().all(|s| !s.place.is_empty()), "{}: sources", t.id);
        assert!(
            !t.layouts.is_empty() && t.layouts.iter().all(|l| !l.channels.is_empty()),
            "{}: layouts",
            t.id
        );
        assert!(t.coordinates.iter().all(|c| Quantity::find(c).is_some()), "{}: coordinates", t.id);
        assert!(t.laws.iter().all(|l| LAWS.iter().any(|law| law.id == *l)), "{}: laws", t.id);
        if let ModelUse::Any(id) | ModelUse::Split(id) = t.model {
            assert!(MODELS.iter().any(|m| m.id == id), "{}: default model", t.id);
        }
        let request = brdfbake::tables::spec::Request { kind: t.id.to_owned(), ..Default::default() };
        request.bind().unwrap_or_else(|e| panic!("{} does not bind with its defaults: {e}", t.id));
    }
}

#[test]
fn laws_are_complete() {
    let ids: BTreeSet<&str> = LAWS.iter().map(|l| l.id).collect();
    assert_eq!(ids.len(), LAWS.len(), "an id is used twice");
    let codes: BTreeSet<u16> = LAWS.iter().map(|l| l.code).collect();
    assert_eq!(codes.len(), LAWS.len(), "a finding number is used twice");
    let used: BTreeSet<&str> = TABLES.iter().flat_map(|t| t.laws).copied().collect();
    assert_eq!(ids, used, "a law that no table checks, or a table that checks a law that is not");
}

#[test]
fn sources_are_in_the_bibliography() {
    let keys: BTreeSet<&str> = brdfbake::cite::ALL.iter().map(|c| c.key).collect();
    assert_eq!(keys.len(), brdfbake::cite::ALL.len(), "a key is used twice");
}

#[test]
fn what_is_not_declared_is_an_error_and_no_number() {
    for m in MODELS {
        let params = Params::resolve(m.id, m.params, []).unwrap();
        for wrong in ["", "nothing", "Alpha", "alpha "] {
            let message = format!("{}: it declares no `{wrong}` that is a parameter", m.id);
            assert_eq!(params.number(wrong).unwrap_err().to_string(), message);
            assert_eq!(params.choice(wrong).unwrap_err().to_string(), message);
            assert_eq!(params.rows(wrong).unwrap_err().to_string(), message);
            assert_eq!(params.numbers([wrong]).unwrap_err().to_string(), message);
        }
        // a parameter of another type is not declared either
        for p in m.params {
            let [number, choice, rows] =
                [params.number(p.id).is_ok(), params.choice(p.id).is_ok(), params.rows(p.id).is_ok()];
            let kind = [
                matches!(p.kind, Kind::Number { .. }),
                matches!(p.kind, Kind::Choice(_)),
                matches!(p.kind, Kind::Rows { .. }),
            ];
            assert_eq!([number, choice, rows], kind, "{}.{}", m.id, p.id);
        }
    }
}
