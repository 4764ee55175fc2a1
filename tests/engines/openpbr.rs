//! OpenPBR's tables against the shipped lists, code by code: which integrals those hold, and how far off they are.

use crate::common::shared;
use crate::engines::support::{bake, npy, numbers, plan};
use crate::tolerance::near;
use rayon::prelude::*;
use std::path::Path;

const CODES: f64 = 65535.0;

/// Largest and mean difference of a table from its half (or all) of a shipped list, at every `step`th texel along roughness and ior
/// and every other cosine, both ends included.
fn difference(dir: &Path, table: &str, list: &str, step: usize) -> [f64; 2] {
    let shipped = npy(&dir.join(format!("{list}.npy")));
    let plan = plan("openpbr", |name| name == table);
    let planned = &plan.tables[0];
    let grid = &planned.bound.spec.grid;
    // the half above 1 comes second
    let first = if table.ends_with("-inside") { 0 } else { shipped.len() - grid.len() };
    let lengths: Vec<usize> = grid.axes().iter().map(|a| a.len).collect();
    let taken = |i: &usize| {
        let mut rest = *i;
        lengths.iter().enumerate().all(|(axis, len)| {
            let at = rest % len;
            rest /= len;
            let each = if axis == 0 { 2 } else { step };
            at.is_multiple_of(each) || at == len - 1
        })
    };
    let texels: Vec<usize> = (0..grid.len()).filter(taken).collect();
    let off = |i: &usize| {
        let e = planned.bound.baker.texel(grid.texel(*i).values(), 1e-4).unwrap();
        (e.value[0] - shipped[first + i] / CODES).abs()
    };
    let all: Vec<f64> = texels.par_iter().map(off).collect();
    [all.iter().copied().fold(0.0, f64::max), all.iter().sum::<f64>() / all.len() as f64]
}

/// Their generator is Monte Carlo, whose noise is not known: the largest differences are of single texels.
#[test]
fn lists_of_openpbr() {
    let Some(dir) = shared().map(|d| d.join("oracles/engines/openpbr")) else { return };
    let mut wrong = Vec::new();
    for (table, list, step, bounds) in [
        ("metal", "ideal_metal_energy_complement", 1, [1.5e-3, 1.1e-4]),
        ("metal-avg", "ideal_metal_avg_energy_complement", 1, [4e-4, 1e-4]),
        ("opaque", "opaque_dielectric_energy_complement", 10, [6e-5, 6e-6]),
        ("opaque-inside", "opaque_dielectric_energy_complement", 10, [6e-4, 3e-5]),
        ("opaque-avg", "opaque_dielectric_avg_energy_complement", 10, [8e-5, 1.5e-5]),
        ("opaque-avg-inside", "opaque_dielectric_avg_energy_complement", 10, [3e-4, 6e-5]),
        ("dielectric", "ideal_dielectric_energy_complement", 15, [1.8e-3, 3e-4]),
        ("dielectric-inside", "ideal_dielectric_energy_complement", 15, [1.4e-3, 2e-4]),
        ("dielectric-avg", "ideal_dielectric_avg_energy_complement", 15, [3e-4, 4e-5]),
        ("dielectric-avg-inside", "ideal_dielectric_avg_energy_complement", 15, [4e-4, 6e-5]),
    ] {
        let found = difference(&dir, &format!("openpbr-{table}"), list, step);
        println!("{table}: largest {:.2e}, mean {:.2e}", found[0], found[1]);
        if found.iter().zip(bounds).any(|(f, b)| *f > b) {
            wrong.push(format!("{table}: {found:?}, at most {bounds:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The list that is not made here keeps reciprocity: (1 - r) over the mean of the other side is the same from both sides. What scales
/// it is not published.
#[test]
fn the_shipped_share_is_no_share_of_ours() {
    let Some(dir) = shared().map(|d| d.join("oracles/engines/openpbr")) else { return };
    let [mean, ratio] = ["ideal_dielectric_avg_energy_complement", "ideal_dielectric_reflection_ratio"]
        .map(|list| npy(&dir.join(format!("{list}.npy"))));
    let [above, inside] = [32 * (16 + 4) + 16, 32 * (15 - 4) + 16];
    let passed = |i: usize| 1.0 - ratio[i] / CODES;
    let quotient = passed(above) / passed(inside) * mean[above] / mean[inside];
    near!(quotient, 1.0, 2e-3, "{quotient}");
}

/// The file is what the header includes between braces: codes, commas, nothing else.
#[test]
fn lists_are_codes() {
    let out = tempfile::tempdir().unwrap();
    let files = bake(&plan("openpbr", |name| name.starts_with("openpbr-metal")), out.path());
    for (file, count) in files.iter().zip([1024, 32]) {
        let text = std::fs::read_to_string(file).unwrap();
        let codes: Vec<u16> = text.split(',').map(|n| n.trim().parse().unwrap()).collect();
        assert_eq!(codes.len(), count, "{}", file.display());
        assert_eq!(codes[0], 0, "nothing is missing of a mirror");
    }
}

/// Cycles' transform of the colour-matching functions: the integrals against the shipped discrete transform, and both between rows.
#[test]
fn transforms_of_cycles() {
    let out = tempfile::tempdir().unwrap();
    let file = bake(&plan("cycles", |name| name == "cycles-thin-film-cmf"), out.path()).remove(0);
    let own = numbers(&std::fs::read_to_string(&file).unwrap()).concat();
    assert_eq!(own.len(), 512 * 6);
    let Some(dir) = shared() else { return };
    let shipped = npy(&dir.join("oracles/engines/cycles/thin_film_cmf.npy"));
    let worst = |list: &[f64]| {
        let pairs = list.iter().zip(&own);
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    // it wraps round at its end, where the transform of z is still alive
    let off = worst(&shipped);
    assert!((7e-3..7.6e-3).contains(&off), "{off}");
    let planned = &plan("cycles", |name| name == "cycles-thin-film-cmf").tables[0].bound;
    let half = |list: &[f64]| {
        let one = |k: usize| {
            let opd =
                0.5 * (planned.spec.grid.texel(k).values()[0] + planned.spec.grid.texel(k + 1).values()[0]);
            let e = planned.baker.texel(&[opd], 1e-6).unwrap();
            let line = |c: usize| 0.5 * (list[6 * k + c] + list[6 * (k + 1) + c]);
            (0..6).map(|c| (line(c) - e.value[c]).abs()).fold(0.0, f64::max)
        };
        (0..511).step_by(7).map(one).fold(0.0, f64::max)
    };
    let [own, shipped] = [half(&own), half(&shipped)];
    println!("between the rows: {own:.2e}, shipped {shipped:.2e}");
    assert!((0.015..0.0175).contains(&own) && (0.011..0.0145).contains(&shipped), "{own} {shipped}");
}
