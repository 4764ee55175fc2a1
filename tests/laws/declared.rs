//! Each kind, layout or free channel, with each law that is declared for it, is really looked at.

use super::support::{bake, pairs};
use brdfbake::tables::TABLES;
use brdfbake::verify::{self, LAWS};
use std::collections::BTreeSet;

/// The tolerance of the tables: that of half floats, the most usual storage.
const TOLERANCE: f64 = 2.5e-4;

fn look(longest: usize) {
    let mut faults = Vec::new();
    for pair in pairs() {
        let start = std::time::Instant::now();
        let bound = pair.bind(longest);
        let declared: BTreeSet<&str> = verify::declared(&bound.spec).map(|l| l.id).collect();
        let table = bake(&bound, TOLERANCE);
        let baked = start.elapsed();
        let name = pair.name();
        let laws = match verify::check(&bound, table, TOLERANCE, &[]) {
            Ok((verified, _)) => verified.laws().to_vec(),
            Err(findings) => {
                faults.extend(findings.iter().map(|f| format!("{name}: {f}")));
                continue;
            }
        };
        println!(
            "{name}: {:.2} s + {:.2} s, {}",
            baked.as_secs_f64(),
            (start.elapsed() - baked).as_secs_f64(),
            laws.iter().map(|l| format!("{} {}", l.law, l.checked)).collect::<Vec<_>>().join(", ")
        );
        let seen: BTreeSet<&str> = laws.iter().map(|l| l.law.as_str()).collect();
        if seen != declared {
            faults.push(format!("{name}: {declared:?} declared, {seen:?} listed"));
        }
        for law in &laws {
            if law.checked == 0 || !law.held() {
                faults.push(format!("{name}: {} looked at nothing: {:?}", law.law, law.why));
            }
        }
        // something says what the numbers mean
        if laws.iter().all(|l| verify::find(&l.law).unwrap().formal) {
            faults.push(format!("{name}: no law but formal ones"));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn every_declared_law_looks_at_something() {
    look(3);
}

#[test]
#[ignore = "long: minutes; every table on its whole default axes, run by `cargo long`"]
fn every_declared_law_looks_at_something_on_the_whole_default_axes() {
    look(usize::MAX);
}

#[test]
fn every_law_that_a_kind_declares_concerns_one_of_its_tables() {
    for kind in TABLES {
        let of_kind = || pairs().into_iter().filter(|p| p.kind.id == kind.id);
        for law in kind.laws {
            let law = LAWS.iter().find(|l| l.id == *law).unwrap();
            let concerned = of_kind().any(|p| (law.concerns)(&p.bind(2).spec));
            assert!(concerned, "{} declares {}, which concerns none of its tables", kind.id, law.id);
        }
    }
}
