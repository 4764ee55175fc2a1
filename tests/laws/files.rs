//! What files, reports and exit codes say of the laws.

use super::support::{bake, pairs};
use brdfbake::encode::read::{Claim, read_bytes};
use brdfbake::grid::provenance::{LawResult, Provenance, SCHEMA};
use brdfbake::report;
use brdfbake::tables::source;
use brdfbake::tables::spec::Request;
use brdfbake::verify;
use std::path::Path;
use std::process::{Command, Output};

fn brdfbake(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_brdfbake")).args(args).env("NO_COLOR", "1").output().unwrap()
}

fn code(o: &Output) -> i32 {
    o.status.code().unwrap()
}

fn err(o: &Output) -> String {
    String::from_utf8(o.stderr.clone()).unwrap()
}

/// Bakes one table of a recipe; the output, and what the file says.
fn baked(table: &str, more: &[&str]) -> (tempfile::TempDir, Output, Option<Provenance>) {
    let dir = tempfile::tempdir().unwrap();
    let recipe = dir.path().join("recipe.toml");
    std::fs::write(&recipe, format!("name = \"test\"\n[[table]]\nname = \"t\"\n{table}")).unwrap();
    let out = dir.path().join("out");
    let text = |p: &Path| p.to_str().unwrap().to_owned();
    let (recipe, target) = (text(&recipe), text(&out));
    let mut args = vec!["bake", &recipe, "-o", &target];
    args.extend(more);
    let o = brdfbake(&args);
    let file = std::fs::read(out.join("t.exr")).ok();
    let p = file.map(|bytes| read_bytes(&bytes).unwrap().known().unwrap().clone());
    (dir, o, p)
}

const AXES: &str = "[[table.axis]]\nid = \"mu\"\nlength = 8\ndomain = [0.1, 1]\n[[table.axis]]\nid = \"roughness\"\nlength = 8\n";

#[test]
fn a_table_of_another_lobe_does_not_borrow_the_laws_of_the_model() {
    let (_dir, o, p) = baked(&format!("kind = \"dfg\"\nchannels = [\"dfg.cloth\"]\n{AXES}"), &[]);
    assert_eq!(code(&o), 0, "{}", err(&o));
    let p = p.unwrap();
    let laws: Vec<&str> = p.laws.iter().map(|l| l.law.as_str()).collect();
    // no white albedo, no split: nothing is said of them
    assert_eq!(laws, ["finite", "range", "cross-check", "reciprocity", "honest"]);
    assert!(p.laws.iter().all(|l| l.held() && l.checked > 0), "{:?}", p.laws);
    assert!(p.verified && p.tolerance_met == Some(true));
    assert_eq!(p.channels[0].role, "albedo");
    // and the sources are those of the cloth
    assert!(p.table.sources.iter().any(|s| s.starts_with("EstevezKulla2017")), "{:?}", p.table.sources);
    assert!(p.table.sources.iter().all(|s| !s.starts_with("Karis2013")), "{:?}", p.table.sources);
}

#[test]
fn a_law_that_cannot_look_says_so_and_strict_refuses_it() {
    let mirror = format!(
        "kind = \"albedo\"\nmodel = \"mirror\"\n{}",
        AXES.split("[[").take(2).collect::<Vec<_>>().join("[[")
    );
    let (_dir, o, p) = baked(&mirror, &[]);
    assert_eq!(code(&o), 0, "{}", err(&o));
    assert!(err(&o).contains("reciprocity") && err(&o).contains("not checked:"), "{}", err(&o));
    let p = p.unwrap();
    let law = |id: &str| p.laws.iter().find(|l| l.law == id).unwrap();
    assert_eq!(law("reciprocity").result, LawResult::NotChecked);
    assert!(law("reciprocity").why.as_ref().unwrap().contains("mirror"));
    assert_eq!(law("reciprocity").margin, None);
    // what was checked still counts
    assert!(law("honest").held() && p.verified);
    let json = serde_json::to_value(law("reciprocity")).unwrap();
    assert_eq!(json["result"], "not checked");
    let (_dir, o, p) = baked(&mirror, &["--strict"]);
    assert_eq!(code(&o), 4);
    assert!(
        p.is_none() && err(&o).contains("nothing was written") && err(&o).contains("reciprocity"),
        "{}",
        err(&o)
    );
    let (_dir, o, _) = baked(&mirror, &["--message-format", "json"]);
    let lines = String::from_utf8(o.stdout.clone()).unwrap();
    let lines: Vec<serde_json::Value> = lines.lines().map(|l| serde_json::from_str(l).unwrap()).collect();
    let finding = lines.iter().find(|l| l["reason"] == "finding").unwrap();
    assert_eq!(
        (finding["result"].as_str(), finding["severity"].as_str()),
        (Some("not checked"), Some("warning"))
    );
    let finished = lines.iter().find(|l| l["reason"] == "table-finished").unwrap();
    assert_eq!((&finished["verified"], &finished["tolerance_met"]), (&true.into(), &true.into()));
    assert!(finished["laws"].as_array().unwrap().iter().any(|l| l["result"] == "not checked"));
}

#[test]
fn texels_that_miss_the_tolerance_are_not_verified() {
    let table = format!(
        "kind = \"albedo\"\nmodel = \"torrance-sparrow\"\nparams = {{ f0 = 0.04 }}\ntolerance = 1e-12\non-miss = \"report\"\n{AXES}"
    );
    let (_dir, o, p) = baked(&table, &[]);
    assert_eq!(code(&o), 0, "{}", err(&o));
    assert!(err(&o).contains("miss the tolerance"), "{}", err(&o));
    let p = p.unwrap();
    assert!(p.integration.missed > 0 && p.tolerance_met == Some(false) && !p.verified);
    let text = report::inspect(
        "t.exr",
        &read_bytes(&std::fs::read(_dir.path().join("out/t.exr")).unwrap()).unwrap(),
    );
    assert!(text.contains("no: texels miss the tolerance"), "{text}");
    let (_dir, o, p) = baked(&table, &["--strict"]);
    assert_eq!(code(&o), 4);
    assert!(p.is_none());
    // a waiver has its reason in the recipe: strict does not ask again
    let broken = "kind = \"albedo\"\nmodel = \"ward\"\nwaive = [{ law = \"energy\", reason = \"as published\" }, { law = \"range\", reason = \"as published\" }]\n\
        [[table.axis]]\nid = \"mu\"\nlength = 6\ndomain = [0.001, 1]\n[[table.axis]]\nid = \"alpha\"\nlength = 4\ndomain = [0.2, 0.6]\n";
    let (_dir, o, p) = baked(broken, &["--strict"]);
    assert_eq!(code(&o), 0, "{}", err(&o));
    let p = p.unwrap();
    assert!(!p.verified && p.tolerance_met == Some(true) && !p.waived.is_empty());
    assert!(p.laws.iter().any(|l| l.law == "energy" && l.result == LawResult::Broken));
}

#[test]
fn formal_laws_alone_verify_nothing() {
    let pair = pairs().into_iter().find(|p| p.name() == "gaussian-fit weights").unwrap();
    let bound = pair.bind(3);
    let (verified, _) = verify::check(&bound, bake(&bound, 1e-3), 1e-3, &[]).unwrap();
    assert!(verified.verified());
    // the same without the law that adds the weights up
    let only = |law: &str| verify::find(law).unwrap().formal;
    assert!(only("finite") && only("range") && !only("total"));
}

#[test]
fn files_of_version_1_are_read_and_newer_ones_are_not_taken_for_known() {
    let bytes = include_bytes!("version-1.exr");
    let image = read_bytes(bytes).unwrap();
    let p = image.known().unwrap();
    assert_eq!((p.schema, SCHEMA), (1, 2));
    assert!(p.laws.iter().all(|l| l.held() && l.margin.is_some()) && p.tolerance_met.is_none());
    let text = report::inspect("old.exr", &image);
    assert!(text.contains("metadata version 1") && text.contains("not stated"), "{text}");
    // the version is raised in place, the text keeps its length
    let at = bytes.windows(10).position(|w| w == b"\"schema\":1").unwrap();
    let mut newer = bytes.to_vec();
    newer[at + 9] = b'9';
    let claim = read_bytes(&newer).unwrap().provenance;
    assert!(
        matches!(claim, Some(Claim::Unknown { ref fault, .. }) if fault.contains("version 9")),
        "{claim:?}"
    );
}

#[test]
fn sources_are_those_of_the_channels_and_parameters() {
    for pair in pairs() {
        let bound = pair.bind(2);
        let lines = source::lines(&bound.spec);
        assert!(!lines.is_empty(), "{}: no source", pair.name());
    }
    let of = |kind: &str, layout: &str, params: &str| {
        let request = Request {
            kind: kind.to_owned(),
            layout: Some(layout.to_owned()),
            params: serde_json::from_str(params).unwrap(),
            ..Request::default()
        };
        source::lines(&request.bind().unwrap().spec)
            .into_iter()
            .map(|l| l.split(' ').next().unwrap().to_owned())
            .collect::<Vec<_>>()
    };
    assert_eq!(of("dfg", "scale-bias", "{}"), ["Karis2013"]);
    assert_eq!(of("dfg", "f82", "{}"), ["Karis2013", "Kutz2021"]);
    assert_eq!(of("dfg", "multiscatter-diffuse", "{}"), ["Karis2013", "Burley2012"]);
    assert_eq!(of("ltc-magnitude", "magnitude-fresnel", "{}"), ["Heitz2016"]);
    assert_eq!(of("fresnel-conductor", "rgb", "{}"), ["BornWolf1999", "Polyanskiy2024"]);
    assert_eq!(of("fresnel-conductor", "rgb", r#"{"metal": "index"}"#), ["BornWolf1999"]);
    assert_eq!(of("diffusion-profile", "ring", r#"{"profile": "burley"}"#), ["ChristensenBurley2015"]);
    assert_eq!(of("phase-function", "density", r#"{"phase": "rayleigh"}"#), ["BornWolf1999"]);
    assert_eq!(of("compensation", "turquin", "{}"), ["Turquin2019"]);
    assert_eq!(of("masking", "g1", r#"{"distribution": "schlick"}"#), ["Schlick1994"]);
}
