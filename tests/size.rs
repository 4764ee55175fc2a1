//! `size = "auto"`: the table that is found holds what was asked for, against integrals from elsewhere.
#![allow(clippy::unwrap_used, reason = "test")]

use crate::tolerance::ASKED_3;
use brdfbake::cancel::Cancel;
use brdfbake::encode::read;
use brdfbake::grid::lookup;
use brdfbake::pipeline::{PipelineError, Settings, Silent, run};
use brdfbake::plan::Plan;
use brdfbake::recipe::parse;
use std::path::Path;

const FACTORED: &str = r#"
name = "auto"
[[table]]
kind = "dfg"
name = "t"
layout = "factored"
size = { error = 1e-3 }
outputs = ["exr:half"]
[[table.axis]]
id = "mu"
warp = { coupled = "alpha", power = 2.5, scale = 2.0 }
[[table.axis]]
id = "roughness"
domain = [0.01, 1.0]
warp = "sqrt"
"#;

fn bake(plan: &Plan, out: &Path, jobs: usize) -> Result<brdfbake::pipeline::Outcome, PipelineError> {
    let settings = Settings { jobs: Some(jobs), ..Settings::new(out) };
    run(plan, &settings, &Cancel::new(), &Silent)
}

#[test]
fn the_found_table_reads_to_within_the_error_at_values_from_elsewhere() {
    let plan = parse(FACTORED, "auto.toml").unwrap();
    let dir = tempfile::tempdir().unwrap();
    let outcome = bake(&plan, dir.path(), 2).unwrap();
    let record = &outcome.manifest.tables[0];
    let size = record.provenance.size.as_ref().unwrap();
    assert!(size.reached <= ASKED_3 && record.size.iter().product::<usize>() <= 64 * 64, "{:?}", record.size);
    // the same grid again, to read the stored numbers with
    let lengths = format!("length = {}", record.size[0]);
    let fixed = FACTORED
        .replace("size = { error = 1e-3 }\n", "")
        .replace("id = \"mu\"", &format!("id = \"mu\"\n{lengths}"))
        .replace("id = \"roughness\"", &format!("id = \"roughness\"\nlength = {}", record.size[1]));
    let fixed = parse(&fixed, "fixed.toml").unwrap();
    let grid = &fixed.tables[0].bound.spec.grid;
    let image = read::read_file(&dir.path().join("t.exr")).unwrap();
    let channel = |id: &str| image.channels.iter().find(|c| c.name == id).unwrap().values.clone();
    let (loss, rest) = (channel("dfg.loss"), channel("dfg.rest"));
    let stored: Vec<f64> = loss.iter().zip(&rest).flat_map(|(a, b)| [*a, *b]).collect();
    // scale and bias by two other quadratures, at the texel centres of a 32 x 32 table
    let mut seen = 0;
    for line in include_str!("values/dfg.csv").lines().filter(|l| !l.starts_with(['#', 'm'])) {
        let [mu, roughness, scale, bias] =
            line.split(',').map(|c| c.parse::<f64>().unwrap()).collect::<Vec<_>>()[..]
        else {
            panic!("{line}")
        };
        if roughness < 0.01 {
            continue;
        }
        let x = [mu, roughness * roughness];
        let point = grid.point(&x).unwrap();
        let mut out = [0.0; 2];
        lookup::read(grid, &stored, &point, &mut out);
        let albedo = 1.0 - out[0];
        let got_bias = albedo * libm::pow(1.0 - mu, 5.0) + out[1];
        let got_scale = albedo - got_bias;
        assert!(
            (got_bias - bias).abs() <= ASKED_3 && (got_scale - scale).abs() <= ASKED_3,
            "{line}: {got_scale} {got_bias}"
        );
        seen += 1;
    }
    assert!(seen > 200, "{seen}");
}

#[test]
fn the_same_table_is_found_by_any_number_of_threads() {
    let searched = FACTORED
        .replace("size = { error = 1e-3 }", "size = { error = 4e-3, warps = \"search\" }")
        .replace("outputs", "tolerance = 1e-4\noutputs");
    let plan = parse(&searched, "auto.toml").unwrap();
    let bytes = |jobs| {
        let dir = tempfile::tempdir().unwrap();
        bake(&plan, dir.path(), jobs).unwrap();
        std::fs::read(dir.path().join("t.exr")).unwrap()
    };
    assert_eq!(bytes(1), bytes(3));
}

#[test]
fn an_error_out_of_reach_is_refused_with_the_best_that_there_is() {
    let hard = FACTORED.replace("error = 1e-3", "error = 2e-4, longest = 32");
    let plan = parse(&hard, "auto.toml").unwrap();
    let dir = tempfile::tempdir().unwrap();
    let error = bake(&plan, dir.path(), 2).unwrap_err();
    assert!(matches!(error, PipelineError::Size { longest: 32, .. }), "{error}");
    assert!(error.to_string().contains("no table with axes up to 32"), "{error}");
    assert!(std::fs::read_dir(dir.path()).unwrap().next().is_none());
}

#[test]
fn axes_with_a_length_keep_it() {
    let half = FACTORED.replace("id = \"mu\"", "id = \"mu\"\nlength = 64");
    let plan = parse(&half, "auto.toml").unwrap();
    assert_eq!(plan.tables[0].asked.size.as_ref().unwrap().axes, [1]);
    let dir = tempfile::tempdir().unwrap();
    assert_eq!(bake(&plan, dir.path(), 2).unwrap().manifest.tables[0].size[0], 64);
    // the canonical form is itself a recipe, with the size still to be found
    let canonical = &plan.tables[0].canonical();
    assert!(
        canonical["axis"][1].get("length").is_none() && canonical["size"]["error"] == 1e-3,
        "{canonical}"
    );
}
