//! Presets and engines: no law of theirs was not checked without its reason.

use super::support::bake;
use brdfbake::grid::{Axis, Grid};
use brdfbake::plan::{Plan, PlannedTable};
use brdfbake::recipe::{ENGINES, PRESETS, parse};
use brdfbake::tables::spec::{Bound, Spec};
use brdfbake::verify;

/// Laws of shipped tables that find nothing to check, with the reason that their files give.
const REASONS: &[(&str, &str, &str)] = &[];

fn plans() -> Vec<(String, Plan)> {
    let preset = |p: &'static brdfbake::recipe::Preset| (p.id.to_owned(), parse(p.source, p.id).unwrap());
    let engine = |e: &'static brdfbake::recipe::Engine| (e.id.to_owned(), e.plan().unwrap());
    PRESETS.iter().map(preset).chain(ENGINES.iter().map(engine)).collect()
}

/// The same table on shorter axes.
fn short(planned: &PlannedTable, longest: usize) -> Bound {
    let spec = &planned.bound.spec;
    let axes = spec.grid.axes().iter().map(|a| Axis { len: a.len.min(longest), ..a.clone() }).collect();
    let spec = Spec { grid: Grid::new(axes).unwrap(), ..spec.clone() };
    let baker = (spec.kind.bind)(&spec).unwrap();
    Bound { spec, baker }
}

fn look(longest: usize) {
    let (mut faults, mut seen) = (Vec::new(), Vec::new());
    for (plan, tables) in plans().iter().map(|(id, p)| (id, &p.tables)) {
        for planned in tables {
            let start = std::time::Instant::now();
            let bound = short(planned, longest);
            // one table under many names
            let what = format!("{:?} {}", bound.spec, planned.tolerance);
            if seen.contains(&what) {
                continue;
            }
            seen.push(what);
            let name = format!("{plan}/{}", planned.name());
            let table = bake(&bound, planned.tolerance);
            match verify::check(&bound, table, planned.tolerance, &planned.asked.waivers) {
                Err(findings) => faults.extend(findings.iter().map(|f| format!("{name}: {f}"))),
                Ok((verified, _)) => {
                    for law in verified.laws().iter().filter(|l| l.checked == 0) {
                        let why = law.why.clone().unwrap_or_default();
                        let known =
                            |(n, l, w): &&(&str, &str, &str)| *n == name && *l == law.law && why.contains(w);
                        if REASONS.iter().find(known).is_none() {
                            faults.push(format!("{name}: {} was not checked: {why}", law.law));
                        }
                    }
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

#[test]
fn no_law_of_a_shipped_table_is_left_unchecked() {
    look(3);
}

#[test]
#[ignore = "long: minutes; whole tables, run by `cargo long`"]
fn no_law_of_a_shipped_table_is_left_unchecked_in_full() {
    look(usize::MAX);
}
