//! Presets and engines: no law of theirs was not checked without its reason.

use super::support::bake;
use crate::listed::shipped;
use brdfbake::grid::provenance::LawRecord;
use brdfbake::plan::Plan;
use brdfbake::recipe::{ENGINES, PRESETS, parse};
use brdfbake::verify;

/// Laws of shipped tables that find nothing to check, with the reason that their files give.
const REASONS: &[(&str, &str, &str)] = &[];

fn plans() -> Vec<(String, Plan)> {
    let preset = |p: &'static brdfbake::recipe::Preset| (p.id.to_owned(), parse(p.source, p.id).unwrap());
    let engine = |e: &'static brdfbake::recipe::Engine| (e.id.to_owned(), e.plan().unwrap());
    PRESETS.iter().map(preset).chain(ENGINES.iter().map(engine)).collect()
}

/// The fault of a law that looked at nothing without a known reason.
fn unchecked(name: &str, law: &LawRecord) -> Option<String> {
    let why = law.why.clone().unwrap_or_default();
    let known = |(n, l, w): &&(&str, &str, &str)| *n == name && *l == law.law && why.contains(w);
    let fault = || format!("{name}: {} was not checked: {why}", law.law);
    (law.checked == 0 && REASONS.iter().find(known).is_none()).then(fault)
}

fn look() {
    let (mut faults, mut seen) = (Vec::new(), Vec::new());
    for (plan, tables) in plans().iter().map(|(id, p)| (id, &p.tables)) {
        for planned in tables {
            let start = std::time::Instant::now();
            let bound = &planned.bound;
            // one table under many names
            let what = format!("{:?} {}", bound.spec, planned.tolerance);
            if seen.contains(&what) {
                continue;
            }
            seen.push(what);
            let name = format!("{plan}/{}", planned.name());
            let table = bake(bound, planned.tolerance);
            match verify::check(bound, table, planned.tolerance, &planned.asked.waivers) {
                Err(findings) => faults.extend(findings.iter().map(|f| format!("{name}: {f}"))),
                Ok((verified, _)) => {
                    faults.extend(verified.laws().iter().filter_map(|l| unchecked(&name, l)));
                    if !verified.verified() && planned.asked.waivers.is_empty() && verified.tolerance_met() {
                        faults.push(format!("{name}: not verified"));
                    }
                }
            }
            println!("{name}: {:.2} s", start.elapsed().as_secs_f64());
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// On short axes, by what their manifests say: they are baked for `listed` too.
#[test]
fn no_law_of_a_shipped_table_is_left_unchecked() {
    let mut faults = Vec::new();
    for (plan, tables) in shipped() {
        for table in tables.as_ref().unwrap_or_else(|e| panic!("{plan}: {e}")) {
            let said = &table.provenance;
            let name = format!("{plan}/{}", said.name);
            faults.extend(said.laws.iter().filter_map(|l| unchecked(&name, l)));
            if !said.verified && said.waived.is_empty() && said.tolerance_met == Some(true) {
                faults.push(format!("{name}: not verified"));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
#[ignore = "long: minutes; whole tables, run by `cargo long`"]
fn no_law_of_a_shipped_table_is_left_unchecked_in_full() {
    look();
}
