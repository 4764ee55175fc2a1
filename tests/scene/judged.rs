//! Rules over the texels of materials. Albedos are those of the model `gltf`, which is integrated by itself.

use super::planned::{textured_with, write_png};
use crate::tolerance::{FEW_ROUNDINGS, SINGLE_ANGLES};
use brdfbake::cancel::Cancel;
use brdfbake::pipeline::materials::{Broken, Judging, Parts, RULES, Review, Stack, Texel, review};
use brdfbake::tables::spec::Request;
use serde_json::json;
use std::path::Path;
use std::sync::OnceLock;

/// Rows of roughness are read linearly between a hundred of them.
const ROWS: f64 = 2e-3;
/// Tables of the parts are baked to 1e-5, and averages are read as linearly.
const TABLES: f64 = 1e-4;

fn parts() -> &'static Parts {
    static PARTS: OnceLock<Parts> = OnceLock::new();
    PARTS.get_or_init(|| Parts::bake(&Cancel::new(), "separable").unwrap())
}

/// The largest albedo of the model over the views that are judged.
fn model(texel: &Texel) -> f64 {
    let mut request = Request { kind: "albedo".into(), model: Some("gltf".into()), ..Request::default() };
    let axis = brdfbake::grid::Axis::new(
        brdfbake::grid::Quantity::find("mu").unwrap(),
        20,
        brdfbake::grid::Texel::Endpoint,
    );
    request.axes = Some(vec![axis.over([0.05, 1.0])]);
    for (id, value) in [
        ("base_color", texel.base[0]),
        ("metallic", texel.metallic),
        ("roughness", texel.roughness),
        ("sheen", texel.sheen),
        ("sheen_roughness", texel.sheen_roughness),
        ("clearcoat", texel.coat),
        ("clearcoat_roughness", texel.coat_roughness),
    ] {
        request.params.insert(id.to_owned(), json!(value));
    }
    request.params.insert("masking".to_owned(), json!("separable"));
    let bound = request.bind().unwrap();
    let grid = &bound.spec.grid;
    let at = |i: usize| bound.baker.texel(grid.texel(i).values(), 1e-5).unwrap().value[0];
    (0..grid.len()).map(at).fold(0.0, f64::max)
}

fn grey(base: f64, roughness: f64, metallic: f64) -> Texel {
    Texel {
        base: [base; 3],
        roughness,
        metallic,
        f0: [0.04; 3],
        specular: 1.0,
        sheen_roughness: 0.5,
        coat_roughness: 0.1,
        ..Texel::default()
    }
}

#[test]
fn the_albedo_of_the_stack_is_that_of_the_model() {
    let mut seen = Vec::new();
    for (base, roughness, metallic) in [(0.8, 0.3, 0.0), (1.0, 0.1, 0.0), (0.9, 0.7, 1.0), (0.5, 1.0, 0.5)] {
        let bare = grey(base, roughness, metallic);
        seen.push(bare);
        seen.push(Texel { coat: 0.75, coat_roughness: 0.2, ..bare });
    }
    for texel in seen {
        let ours = Stack { texel: &texel, parts: parts() }.largest_albedo();
        let theirs = model(&texel);
        assert!((ours - theirs).abs() < ROWS, "{ours} against {theirs}: {texel:?}");
    }
    // a white smooth dielectric reflects nearly twice at grazing: its parts are weighed by different factors
    assert!(Stack { texel: &grey(1.0, 0.1, 0.0), parts: parts() }.largest_albedo() > 1.5);
}

#[test]
fn a_sheen_takes_from_below_what_it_reflects() {
    // the model takes the larger of both directions' albedos: no more is left than by the view's alone
    let texel = Texel { sheen: 0.8, sheen_colour: [0.8; 3], ..grey(0.5, 0.6, 0.0) };
    let (ours, theirs) = (Stack { texel: &texel, parts: parts() }.largest_albedo(), model(&texel));
    assert!(ours >= theirs - TABLES && ours - theirs < 0.05, "{ours} against {theirs}");
}

/// `KHR_materials_specular`: `w (f0 c + (1 - f0 c) (1 - v.h)^5)` lies on what is left of the base; what goes through is not reflected.
#[test]
fn weight_and_colour_of_the_specular_layer_and_what_goes_through_are_in_the_stack() {
    let albedo = |texel: Texel| Stack { texel: &texel, parts: parts() }.largest_albedo();
    let bare = grey(0.6, 0.5, 0.0);
    // without weight only the Lambertian lobe is left, whole: its albedo is the colour
    assert!((albedo(Texel { specular: 0.0, ..bare }) - 0.6).abs() < FEW_ROUNDINGS);
    assert!((albedo(Texel { specular: 0.0, through: 0.75, ..bare }) - 0.15).abs() < FEW_ROUNDINGS);
    // F0 = 1 in a channel takes all light from the base; that channel reflects as a white metal does
    let mirror = Texel { f0: [1.0, 0.0, 0.0], ..bare };
    assert!((albedo(mirror) - albedo(grey(1.0, 0.5, 1.0))).abs() < FEW_ROUNDINGS);
    // a half of the weight is the mean of both
    let half = albedo(Texel { specular: 0.5, base: [0.0; 3], ..bare });
    assert!((half - 0.5 * albedo(Texel { base: [0.0; 3], ..bare })).abs() < FEW_ROUNDINGS);
}

#[test]
fn what_the_stack_leaves_out_is_told() {
    let folder = tempfile::tempdir().unwrap();
    write_png(&folder.path().join("mr.png"), 2, &[[0, 128, 0], [0, 128, 255]]);
    let material = |more: &str| {
        let text = format!(
            r#"{{ "asset": {{ "version": "2.0" }}, "images": [{{ "uri": "mr.png" }}], "textures": [{{ "source": 0 }}],
                "materials": [{{ {more} }}], "meshes": [{{ "primitives": [{{ "attributes": {{ "NORMAL": 1 }}, "material": 0 }}] }}] }}"#
        );
        reviewed(folder.path(), &text)
    };
    let told =
        |more: &str| material(more).simplified.into_iter().map(|(_, how)| how).collect::<Vec<_>>().join("; ");
    assert!(
        told(r#""extensions": { "KHR_materials_anisotropy": { "anisotropyStrength": 0.5 } }"#)
            .contains("alike")
    );
    assert_eq!(told(r#""extensions": { "KHR_materials_anisotropy": { "anisotropyStrength": 0 } }"#), "");
    let pair = |more: &str| {
        told(&format!(
            r#""pbrMetallicRoughness": {{ "baseColorTexture": {{ "index": 0 {more} }}, "metallicRoughnessTexture": {{ "index": 0 }} }}"#
        ))
    };
    assert_eq!(pair(""), "");
    assert!(pair(r#", "texCoord": 1"#).contains("UV sets"));
    // the texture of the weight is alpha, that of the colour sRGB: 1 and a channel of 0 here
    let specular = r#""pbrMetallicRoughness": { "metallicFactor": 0, "baseColorFactor": [0.5, 0.5, 0.5, 1] },
        "extensions": { "KHR_materials_specular": { "specularColorTexture": { "index": 0 }, "specularColorFactor": [9, 9, 9] } }"#;
    let found = material(specular);
    assert_eq!((found.texels, found.unknown.len()), (2, 0));
    let gloss = material(r#""extensions": { "KHR_materials_pbrSpecularGlossiness": {} }"#);
    assert!(gloss.unknown[0].1.contains("convert"), "{gloss:?}");
    let toon = material(r#""extensions": { "VRMC_materials_mtoon": {} }"#);
    assert_eq!(toon.materials, 0);
}

fn reviewed(folder: &Path, text: &str) -> Review {
    let file = folder.join("a.gltf");
    std::fs::write(&file, text).unwrap();
    review(&file, parts(), &Judging::default()).unwrap()
}

fn broken<'a>(review: &'a Review, rule: &str) -> Option<&'a Broken> {
    review.broken.iter().find(|b| b.rule == rule)
}

#[test]
fn texels_are_counted_and_the_worst_is_named() {
    let folder = tempfile::tempdir().unwrap();
    // roughness in green, metalness in blue: one texel of eight is half a metal, two are smoother than 0.045
    let texels = [
        [0, 128, 0],
        [0, 5, 0],
        [0, 128, 128],
        [0, 128, 0],
        [0, 10, 255],
        [0, 128, 255],
        [0, 128, 0],
        [0, 128, 0],
    ];
    write_png(&folder.path().join("mr.png"), 4, &texels);
    let text = textured_with("mr.png", r#""roughnessFactor": 1, "baseColorFactor": [0.2, 0.2, 0.2, 1], "#);
    let found = reviewed(folder.path(), &text);
    assert_eq!((found.materials, found.texels, found.unknown.len()), (1, 8, 0));
    let half = broken(&found, "half-metal").unwrap();
    assert_eq!((half.count, half.texel), (1, [2, 0]));
    assert!((half.value - 127.0 / 255.0).abs() < SINGLE_ANGLES, "{}", half.value);
    let smooth = broken(&found, "smooth-float").unwrap();
    assert_eq!((smooth.count, smooth.share, smooth.texel), (2, 0.25, [1, 0]));
    assert!(broken(&found, "dark-base").is_none() && broken(&found, "bright-base").is_none());
}

#[test]
fn base_colours_are_judged_as_codes_and_only_of_dielectrics() {
    let folder = tempfile::tempdir().unwrap();
    let with = |colour: &str, metallic: &str| {
        let text = format!(
            r#"{{ "asset": {{ "version": "2.0" }}, "materials": [{{ "pbrMetallicRoughness": {{ "roughnessFactor": 0.5,
                "metallicFactor": {metallic}, "baseColorFactor": [{colour}, {colour}, {colour}, 1] }} }}],
                "meshes": [{{ "primitives": [{{ "attributes": {{ "NORMAL": 1 }}, "material": 0 }}] }}] }}"#
        );
        reviewed(folder.path(), &text)
    };
    // linear 0.0123 is code 30, 0.8714 code 240 (IEC 61966-2-1)
    assert!(broken(&with("0.0120", "0"), "dark-base").is_some());
    assert!(broken(&with("0.0130", "0"), "dark-base").is_none());
    assert!(broken(&with("0.89", "0"), "bright-base").is_some());
    assert!(broken(&with("0.85", "0"), "bright-base").is_none());
    assert!(broken(&with("0.89", "1"), "bright-base").is_none());
}

#[test]
fn rough_metals_lose_energy_and_unknown_pictures_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let text = |rough: &str| {
        format!(
            r#"{{ "asset": {{ "version": "2.0" }}, "materials": [{{ "pbrMetallicRoughness": {{ "roughnessFactor": {rough} }} }}],
                "meshes": [{{ "primitives": [{{ "attributes": {{ "NORMAL": 1 }}, "material": 0 }}] }}] }}"#
        )
    };
    let rough = reviewed(folder.path(), &text("1"));
    // separable GGX at alpha = 1: E(mu) = 2 (1 - ln 2) / (1 + mu), E_avg = 4 (1 - ln 2)^2 = 0.376630
    let lost = broken(&rough, "lost-energy").unwrap();
    assert!((lost.value - (1.0 - 0.376_630)).abs() < TABLES, "{}", lost.value);
    assert!(broken(&reviewed(folder.path(), &text("0.2")), "lost-energy").is_none());
    let missing = reviewed(folder.path(), &textured_with("none.png", ""));
    assert_eq!((missing.unknown.len(), missing.texels), (1, 0));
}

#[test]
fn rules_have_ids_of_their_own() {
    for (i, rule) in RULES.iter().enumerate() {
        assert!(RULES[..i].iter().all(|other| other.id != rule.id), "{}", rule.id);
    }
}
