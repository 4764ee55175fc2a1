//! The library in other people's programs: a table in memory, a recipe in a build script.
#![allow(clippy::unwrap_used, reason = "test")]

use brdfbake::build;
use brdfbake::encode::read::read_bytes;
use brdfbake::grid::{Axis, Quantity, Texel};
use brdfbake::pipeline::InMemoryError;
use brdfbake::plan::{Output, TableRequest};
use brdfbake::tables::spec::Request;

fn albedo(model: &str) -> TableRequest {
    let axis = |id| Axis::new(Quantity::find(id).unwrap(), 4, Texel::Center);
    let request = Request {
        kind: "albedo".into(),
        model: Some(model.into()),
        axes: Some(vec![axis("mu"), axis("roughness")]),
        ..Request::default()
    };
    TableRequest { tolerance: Some(1e-6), ..TableRequest::new("e", request) }
}

#[test]
fn a_table_in_memory_is_that_of_a_file() {
    let baked = brdfbake::bake(albedo("ggx")).unwrap();
    assert_eq!(baked.table().values.len(), 16);
    assert!(baked.table().errors.iter().all(|e| (0.0..=1e-6).contains(e)));
    assert!(baked.findings().is_empty() && baked.provenance().verified);
    let bytes = baked.encode(&Output::parse("exr:float").unwrap()).unwrap();
    let read = read_bytes(&bytes).unwrap();
    for (got, wanted) in read.channels[0].values.iter().zip(&baked.table().values) {
        // rounded to float and no more
        assert!((got - wanted).abs() <= f64::from(f32::EPSILON), "{got}, not {wanted}");
    }
}

#[test]
fn what_cannot_be_baked_in_memory_says_why() {
    let unknown = brdfbake::bake(albedo("ggxx")).unwrap_err();
    assert!(matches!(unknown, InMemoryError::Plan(_)) && unknown.to_string().contains("ggx"), "{unknown}");
    let broken = brdfbake::bake(albedo("cook-torrance-1982")).unwrap_err();
    assert!(matches!(broken, InMemoryError::Bake(_)) && broken.to_string().contains("law"), "{broken}");
}

#[test]
fn a_build_script_gets_the_lines_that_cargo_needs() {
    let dir = tempfile::tempdir().unwrap();
    let recipe = dir.path().join("tables.toml");
    let text = "name = 'x'\n[[table]]\nkind = 'albedo'\nname = 'e'\noutputs = ['exr:half']\n\
        axis = [{ id = 'mu', length = 4 }, { id = 'roughness', length = 4 }]\n";
    std::fs::write(&recipe, text).unwrap();
    let out = dir.path().join("out");
    let built = build::recipe(&recipe, &out).unwrap();
    assert_eq!(built.lines, [format!("cargo::rerun-if-changed={}", recipe.display())]);
    assert!(out.join("e.exr").is_file() && built.outcome.written == 2);
    assert_eq!(build::recipe(&recipe, &out).unwrap().outcome.written, 0);
    std::fs::write(&recipe, text.replace("albedo", "albdo")).unwrap();
    let fault = build::recipe(&recipe, &out).unwrap_err().to_string();
    assert!(fault.contains("albedo") && fault.contains("tables.toml:3"), "{fault}");
}
