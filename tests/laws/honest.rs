//! The power of the law `honest`: what it finds when values are moved by five times estimate plus tolerance.

use super::support::{bake, pairs};
use brdfbake::cancel::Cancel;
use brdfbake::grid::{Axis, Table, Texel};
use brdfbake::tables::spec::{Bound, Request};
use brdfbake::verify::seeds::Seeds;
use brdfbake::verify::{Case, Outcome, honest};

const TOLERANCE: f64 = 2.5e-4;

/// How far a mutant is moved: in estimates plus tolerances.
const MOVED: f64 = 5.0;

fn look(bound: &Bound, table: &Table) -> Outcome {
    let cancel = Cancel::new();
    (honest::LAW.check)(&Case { bound, table, tolerance: TOLERANCE, cancel: &cancel })
}

/// Moves a value; up where it is low, so that it stays what such a channel can be.
fn move_value(table: &mut Table, texel: usize, channel: usize) {
    let i = texel * table.channels.len() + channel;
    let [lo, hi] = table.channels[channel].range;
    let step = MOVED * (table.errors[i] + TOLERANCE);
    table.values[i] += if table.values[i] > 0.5 * (lo + hi) { -step } else { step };
}

/// A square table of two axes. Which texels are looked at depends on the grid, not on the kind: `masking`, whose rule is an
/// integral of one dimension, shows it for a hundredth of the time that `dfg` takes.
fn square(kind: &str, len: usize) -> (Bound, Table) {
    let pair = pairs().into_iter().find(|p| p.kind.id == kind && p.layout.is_some()).unwrap();
    let bound = pair.bind(len);
    let table = bake(&bound, TOLERANCE);
    assert_eq!(table.grid.len(), len * len, "{kind}");
    (bound, table)
}

/// Moves what `which` says in a channel; is it found?
fn found(bound: &Bound, table: &Table, channel: usize, which: impl Fn(usize) -> bool) -> bool {
    let mut mutant = table.clone();
    for texel in (0..table.grid.len()).filter(|t| which(*t)) {
        move_value(&mut mutant, texel, channel);
    }
    matches!(look(bound, &mutant), Outcome::Broken(_))
}

/// The chance that `drawn` of `all` texels hold none of `bad`.
fn missed(all: usize, drawn: usize, bad: usize) -> f64 {
    (0..bad).map(|i| (all - drawn).saturating_sub(i) as f64 / (all - i) as f64).product()
}

/// Tables with one texel in twenty moved are refuted, `count` of them.
fn refute(kind: &str, count: usize) {
    let (bound, table) = square(kind, 40);
    let Outcome::Held(seen) = look(&bound, &table) else { panic!("the table itself") };
    let (texels, channels) = (table.grid.len(), table.channels.len());
    let (judged, bad) = (usize::try_from(seen.checked).unwrap() / channels, texels / 20);
    assert!(judged >= 135 && seen.unchecked == 0, "{seen:?}");
    // the texels that are looked at do not depend on the values: the chance is that of drawing none of the bad ones
    let chance = missed(texels, judged, bad);
    println!(
        "{kind}: {judged} of {texels} texels judged; {bad} bad ones escape with probability {chance:.1e}"
    );
    assert!(chance < 1e-3);
    let mut seeds = Seeds::new(17);
    for _ in 0..count {
        let mut mutant = table.clone();
        let mut moved = vec![false; texels];
        while moved.iter().filter(|m| **m).count() < bad {
            let texel = seeds.index(texels);
            if !std::mem::replace(&mut moved[texel], true) {
                move_value(&mut mutant, texel, seeds.index(channels));
            }
        }
        assert!(matches!(look(&bound, &mutant), Outcome::Broken(_)), "{kind}");
    }
}

#[test]
fn five_percent_of_the_texels_do_not_escape() {
    refute("masking", 100);
    refute("dfg", 2);
}

#[test]
fn the_chance_holds_for_the_largest_tables() {
    // few rows and many columns, many rows and few columns, one row: 135 are drawn without replacement at least
    for texels in [136, 256, 4096, 1 << 20] {
        assert!(missed(texels, 135, texels.div_ceil(20)) < 1e-3, "{texels}");
    }
}

#[test]
fn no_row_and_no_column_escapes() {
    for (kind, len, step) in [("masking", 24, 1), ("dfg", 24, 23)] {
        let (bound, table) = square(kind, len);
        let last = table.channels.len() - 1;
        for line in (0..len).step_by(step) {
            assert!(found(&bound, &table, last, |t| t / len == line), "{kind}: row {line}");
            assert!(found(&bound, &table, last, |t| t % len == line), "{kind}: column {line}");
        }
    }
}

/// Every channel that has a rule: a texel of a small table, of which all are looked at, is found when it is moved, and the other
/// channels are not blamed. Two texels an axis, at their centres: at the ends some rules have nothing to say.
#[test]
fn every_channel_is_judged() {
    let mut faults = Vec::new();
    for pair in pairs() {
        let bound = pair.bind_to(|a| Axis { len: a.len.min(2), texel: Texel::Center, ..a });
        if !brdfbake::verify::declared(&bound.spec).any(|l| l.id == "honest") {
            continue;
        }
        let table = bake(&bound, TOLERANCE);
        for (c, channel) in table.channels.iter().enumerate() {
            let unruled = ["ltc.a", "ltc.b"].contains(&channel.id.as_str());
            let texel = table.grid.len() / 2;
            let mut mutant = table.clone();
            move_value(&mut mutant, texel, c);
            match look(&bound, &mutant) {
                Outcome::Broken(seen) if seen.at.starts_with(&channel.id) => {}
                // a density is that of the direction beside it
                Outcome::Broken(seen) if channel.id.starts_with("wi.") && seen.at.starts_with("pdf") => {}
                _ if unruled => {}
                other => faults.push(format!("{}, {}: {other:?}", pair.name(), channel.id)),
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// A wide tolerance is no licence: the bound is three estimates, not the tolerance.
#[test]
fn an_estimate_that_is_too_small_is_a_breach_within_the_tolerance() {
    let request = Request { kind: "average-albedo".to_owned(), ..Request::default() };
    let bound = request.bind().unwrap();
    let mut table = bake(&bound, TOLERANCE);
    assert!(look(&bound, &table).held());
    // the rule is sure to an eighth of the tolerance and better; the estimate lies by a hundred
    table.values[9] += 0.9 * TOLERANCE;
    table.errors[9] = 1e-2 * TOLERANCE;
    assert!(matches!(look(&bound, &table), Outcome::Broken(_)));
}
