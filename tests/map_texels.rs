//! Texels of written maps as parameters of models, and single levels of files.
#![allow(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "test"
)]

use crate::map_files::{normal_code, picture};
use crate::tolerance::{LOBE_DIGITS, LOBE_OVER_DIRECTIONS, MEASURED_MISS, SINGLE_ANGLES, STORED_MEAN};
use brdfbake::cancel::Cancel;
use brdfbake::encode::read::{read_bytes, read_level_until};
use brdfbake::functions::{Angles, Subject};
use brdfbake::maps::{Centre, Shape};
use brdfbake::pipeline::map::texel::{MapTexel, TexelError, TexelPlace};
use brdfbake::pipeline::map::{
    ColourInput, Input, MapRequest, NumberInput, Origin, Output, RoughnessInput, SbrdfRequest, run,
};
use brdfbake::pipeline::{Settings, fresh};
use glam::DVec3;
use serde_json::{Map, Value as Json, json};
use std::path::Path;
use std::process::Command;

fn request(dir: &Path) -> MapRequest {
    let slope = |x: u32, y: u32| [0.3 - 0.1 * f64::from(x % 3), 0.15 * f64::from(y % 4) - 0.2];
    let normal = picture(dir, "n.png", [8, 6], 3, |x, y, c| normal_code(slope(x, y), c));
    let roughness = picture(dir, "r.png", [8, 6], 1, |x, y, _| 60 + 20 * ((x + y) % 4) as u8);
    let request = MapRequest::new("m", Some(Input::new(normal)), RoughnessInput::new(roughness));
    let outputs = ["exr:roughness=float+normal=float+anisotropy=float", "ktx2", "png", "dds"];
    MapRequest { outputs: outputs.map(|o| Output::parse(o).unwrap()).to_vec(), check: 1, ..request }
}

fn bake(request: &MapRequest, out: &Path) {
    let settings = Settings { jobs: Some(1), ..Settings::new(out) };
    run(request, &settings, &Cancel::new(), &|_, _| {}).unwrap();
    assert!(
        fresh::stale(&brdfbake::plan::Plan::from_all("map", Vec::new(), vec![request.clone()]).unwrap(), out)
            .is_empty()
    );
}

fn texel(places: &[String], colour: usize) -> Result<MapTexel, TexelError> {
    let places: Vec<TexelPlace> = places.iter().map(|p| TexelPlace::parse(p).unwrap()).collect();
    MapTexel::read(&places, colour, &Cancel::new())
}

fn at(out: &Path, place: &str) -> String {
    out.join(place).display().to_string()
}

fn given(pairs: &[(&str, f64)]) -> Map<String, Json> {
    pairs.iter().map(|(k, v)| ((*k).to_owned(), json!(v))).collect()
}

fn angles(wi: [f64; 2], wo: [f64; 2]) -> Angles {
    Angles { wi_theta: Some(wi[0]), wi_phi: Some(wi[1]), wo_theta: Some(wo[0]), wo_phi: Some(wo[1]) }
}

fn direction([theta, phi]: [f64; 2]) -> DVec3 {
    DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
}

/// Every level of a file of all levels is the file of that level.
#[test]
fn levels_of_a_file_are_those_of_a_file_each() {
    let dir = tempfile::tempdir().unwrap();
    let mut request = request(dir.path());
    request.filter.centre = Centre::Free;
    let ends = ["exr", "ktx2", "dds", "png"]
        .map(|c| Output::parse(&format!("{c}:normal=unorm8")).or_else(|_| Output::parse(c)).unwrap());
    request.outputs = ends.to_vec();
    bake(&request, dir.path());
    for map in ["roughness", "normal", "error"] {
        for k in 0..4 {
            let own =
                read_bytes(&std::fs::read(dir.path().join(format!("m.{map}.mip{k}.png"))).unwrap()).unwrap();
            for end in ["exr", "ktx2", "dds"] {
                let bytes = std::fs::read(dir.path().join(format!("m.{map}.{end}"))).unwrap();
                let read = read_level_until(&Cancel::new(), &bytes, k).unwrap();
                assert_eq!([read.width, read.height], [own.width, own.height], "{map} {end} {k}");
                // the first channel; codes of signed numbers and floats stand for the same within a code
                let (a, b) = (&own.channels[0].values, &read.channels[0].values);
                let signed = |v: &f64| if map == "normal" && end == "exr" { 0.5 * v + 0.5 } else { *v };
                assert!(
                    a.iter().zip(b).all(|(x, y)| (x - signed(y)).abs() <= 1.01 / 255.0),
                    "{map} {end} {k}"
                );
            }
        }
        let bytes = std::fs::read(dir.path().join(format!("m.{map}.ktx2"))).unwrap();
        let fault = read_level_until(&Cancel::new(), &bytes, 4).unwrap_err().to_string();
        assert_eq!(fault, "ktx2: level 4 is not in the file, which has levels 0 to 3");
    }
}

/// A texel is what its numbers say by hand: a tilted lobe by its dot products, two widths in azimuths that are turned.
#[test]
fn a_texel_of_widths_is_the_model_in_its_frame() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("free");
    let mut request = request(dir.path());
    request.filter.centre = Centre::Free;
    bake(&request, &out);
    let read = |map: &str, channel: &str| {
        let bytes = std::fs::read(out.join(format!("m.{map}.exr"))).unwrap();
        let image = read_level_until(&Cancel::new(), &bytes, 1).unwrap();
        image.channel(channel).unwrap().values[image.width + 2]
    };
    let n = DVec3::new(read("normal", "normal.x"), read("normal", "normal.y"), read("normal", "normal.z"))
        .normalize();
    let alpha = read("roughness", "roughness").powi(2);
    let files = ["m.roughness.exr:2,1,1", "m.normal.exr:2,1,1"].map(|p| at(&out, p));
    let found = texel(&files, 1).unwrap().subject("ggx remark", &given(&[("f0", 0.3)])).unwrap();
    for (wi, wo) in [([0.4, 0.3], [0.7, 3.0]), ([0.2, -1.0], [0.5, 1.5]), ([1.2, 2.0], [0.1, 0.0])] {
        let (i, o) = (direction(wi), direction(wo));
        // the helper stands about z: the same angles, from dot products with the normal
        let (ci, co, cos) = (n.dot(i), n.dot(o), i.dot(o));
        let (si, so) = ((1.0 - ci * ci).sqrt(), (1.0 - co * co).sqrt());
        let phi = ((cos - ci * co) / (si * so)).clamp(-1.0, 1.0).acos();
        let (ti, to) = (DVec3::new(si, 0.0, ci), DVec3::new(so * phi.cos(), so * phi.sin(), co));
        let expected = crate::sbrdf::ggx(ti, to, alpha, 0.3) / co;
        let value = found.value(&angles(wi, wo)).unwrap();
        assert!((value - expected).abs() <= SINGLE_ANGLES * (1.0 + expected), "{value} {expected}");
    }
    // functions take a width, and no frame
    let width = texel(&files[..1], 1).unwrap();
    assert!(width.subject("lambda-ggx", &Map::new()).is_ok());
    assert!(matches!(
        texel(&files, 1).unwrap().subject("lambda-ggx", &Map::new()),
        Err(TexelError::NotOf { .. })
    ));
    assert!(matches!(width.subject("lambert", &Map::new()), Err(TexelError::NotOf { .. })));

    let out = dir.path().join("two");
    request.filter = MapRequest::new("m", None, RoughnessInput::Constant(0.5)).filter;
    request.filter.shape = Shape::Anisotropic;
    bake(&request, &out);
    let whole = texel(&[at(&out, "m:1,1,1")], 1).unwrap();
    let read = |map: &str, channel: &str| {
        let bytes = std::fs::read(out.join(format!("m.{map}.exr"))).unwrap();
        let image = read_level_until(&Cancel::new(), &bytes, 1).unwrap();
        image.channel(channel).unwrap().values[image.width + 1]
    };
    let least = read("roughness", "roughness").powi(2);
    let most = least + (1.0 - least) * read("anisotropy", "strength").powi(2);
    let angle = read("anisotropy", "direction.y").atan2(read("anisotropy", "direction.x"));
    assert!(most > 1.02 * least, "{most} {least}");
    // whichever container is found first: KTX2 of 8 bits is near, EXR is the same
    let near = whole.subject("ggx", &Map::new()).unwrap();
    let files = ["m.roughness.exr:1,1,1", "m.anisotropy.exr:1,1,1"].map(|p| at(&out, p));
    let same = texel(&files, 1).unwrap().subject("ggx", &Map::new()).unwrap();
    let plain = Subject::new("ggx", &given(&[("alpha_x", most), ("alpha_y", least)])).unwrap();
    for (wi, wo) in [([0.4, 0.3], [0.6, 3.0]), ([0.9, -1.0], [0.5, 1.5])] {
        let expected = plain.value(&angles([wi[0], wi[1] - angle], [wo[0], wo[1] - angle])).unwrap();
        let [value, coarse] = [&same, &near].map(|s| s.value(&angles(wi, wo)).unwrap());
        assert!((value - expected).abs() <= SINGLE_ANGLES * expected, "{value} {expected}");
        assert!((coarse - expected).abs() <= 0.05 * expected, "{coarse} {expected}");
    }
    assert!(matches!(whole.subject("ggx", &given(&[("alpha", 0.3)])), Err(TexelError::Given(_))));
}

/// Scratches on a smooth surface, as two lobes: named channels, D that is told and measured, and the sum of both in `eval`.
#[test]
fn two_lobes_are_written_and_read() {
    let dir = tempfile::tempdir().unwrap();
    let scratched = |x: u32, y: u32| {
        if (x + 5 * y).is_multiple_of(11) { [0.5, 0.1 * f64::from(y % 5) - 0.2] } else { [0.0, 0.0] }
    };
    let normal = picture(dir.path(), "n.png", [16, 16], 3, |x, y, c| normal_code(scratched(x, y), c));
    let mut request = MapRequest::new("m", Some(Input::new(normal)), RoughnessInput::Constant(0.25));
    request.filter.centre = Centre::Free;
    request.outputs = vec![Output::parse("exr").unwrap(), Output::parse("ktx2:wide=bc5").unwrap()];
    let out = dir.path().join("one");
    bake(&request, &out);
    let one = fresh_record(&request, &out);
    request.filter.shape = Shape::Two;
    let out = dir.path().join("two");
    bake(&request, &out);
    let two = fresh_record(&request, &out);
    assert_eq!(two.shape, "two");
    for (one, two) in one.levels.iter().zip(&two.levels).skip(2) {
        assert!(two.mean < 0.95 * one.mean, "{} {}", two.mean, one.mean);
        let measured = two.measured.as_ref().unwrap();
        let moved = (measured.stored_mean - measured.mean).abs();
        assert!(measured.miss < MEASURED_MISS && moved < STORED_MEAN, "{measured:?}");
    }
    let bytes = std::fs::read(out.join("m.wide.exr")).unwrap();
    let image = read_level_until(&Cancel::new(), &bytes, 2).unwrap();
    let wide = |c: &str| image.channel(c).unwrap().values[1];
    let share = wide("wide.weight");
    assert!(share > 0.02 && share < 0.3, "{share}");
    let told =
        texel(&["m.roughness.exr:1,0,2", "m.wide.exr:1,0,2", "m.normal.exr:1,0,2"].map(|p| at(&out, p)), 1)
            .unwrap();
    let alone = |alpha: f64| {
        let normal = texel(&[at(&out, "m.normal.exr:1,0,2")], 1).unwrap();
        normal.subject("ggx", &given(&[("alpha", alpha)])).unwrap()
    };
    let narrow = {
        let bytes = std::fs::read(out.join("m.roughness.exr")).unwrap();
        read_level_until(&Cancel::new(), &bytes, 2).unwrap().channel("roughness").unwrap().values[1]
    };
    let (a, b) = (alone(narrow * narrow), alone(wide("wide.roughness").powi(2)));
    let at = angles([0.4, 0.3], [0.6, 3.0]);
    let expected = (1.0 - share) * a.value(&at).unwrap() + share * b.value(&at).unwrap();
    let value = told.subject("ggx", &Map::new()).unwrap().value(&at).unwrap();
    assert!((value - expected).abs() <= SINGLE_ANGLES * expected, "{value} {expected}");
    // rules write one lobe, and so do SBRDF maps
    request.filter.rule = brdfbake::maps::rules::rule("toksvig").unwrap();
    request.filter.centre = Centre::Mean;
    let refused = run(&request, &Settings::new(&out), &Cancel::new(), &|_, _| {}).unwrap_err().to_string();
    assert!(refused.contains("rule toksvig writes one lobe"), "{refused}");
}

fn fresh_record(request: &MapRequest, out: &Path) -> brdfbake::pipeline::map::MapRecord {
    run(request, &Settings::new(out), &Cancel::new(), &|_, _| {}).unwrap().record
}

/// Lobes over their own integral reflect their albedos at every light; those over the largest are the model's.
#[test]
fn a_texel_of_lobes_reflects_its_albedos() {
    let dir = tempfile::tempdir().unwrap();
    for (name, normalise) in
        [("i", brdfbake::maps::sbrdf::Normalise::Incident), ("l", brdfbake::maps::sbrdf::Normalise::Largest)]
    {
        let out = dir.path().join(name);
        let origin = Origin::Metallic {
            base: ColourInput::Constant([0.9, 0.5, 0.2]),
            metallic: NumberInput::Constant(0.5),
        };
        let mut request = MapRequest::new("m", None, RoughnessInput::Constant(0.6));
        request.sbrdf = Some(SbrdfRequest { origin, lobes: 2, residual: None, normalise });
        request.outputs = vec![Output::parse("exr:albedo=float+shape=float").unwrap()];
        bake(&request, &out);
        let read = |map: &str, channel: &str| {
            let image = brdfbake::encode::read::read_file(&out.join(format!("m.{map}.exr"))).unwrap();
            image.channel(channel).unwrap().values[0]
        };
        let red = texel(&[at(&out, "m:0,0")], 0).unwrap();
        assert!(red.coloured() && red.words().contains("n "), "{}", red.words());
        let subject = red.subject("lafortune", &Map::new()).unwrap();
        for light in [[0.3, 0.4], [1.0, 2.0]] {
            let i = direction(light);
            let sum: f64 = crate::sbrdf::hemisphere(DVec3::new(-i.x, -i.y, i.z), 150, 80)
                .iter()
                .map(|(o, area)| {
                    let wo = [o.z.clamp(-1.0, 1.0).acos(), o.y.atan2(o.x)];
                    subject.value(&angles(light, wo)).unwrap() * o.z * area
                })
                .sum();
            let albedo = |j: usize| read(&format!("lobe{j}.albedo"), "albedo.r");
            let whole = read("diffuse", "diffuse.r") + albedo(1) + albedo(2);
            if name == "i" {
                assert!((sum - whole).abs() <= LOBE_OVER_DIRECTIONS, "{sum} {whole}");
            } else {
                assert!(sum <= whole + LOBE_DIGITS && sum > 0.5 * whole, "{sum} {whole}");
            }
        }
        assert!(matches!(red.subject("ggx", &Map::new()), Err(TexelError::NotOf { .. })));
        let given = red.subject("lafortune", &given(&[("rho_d", 0.5)]));
        assert!(matches!(given, Err(TexelError::Given(_))), "{given:?}");
        let part = texel(&[at(&out, "m.lobe1.shape.exr:0,0")], 0);
        assert!(matches!(part, Err(TexelError::Part { .. })), "{part:?}");
    }
}

/// What is refused, with the exit code.
#[test]
fn texels_that_tell_nothing_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("o");
    bake(&request(dir.path()), &out);
    let rows = dir.path().join("rows.csv");
    std::fs::write(&rows, "model,params_json,wi_theta,wi_phi,wo_theta,wo_phi\nggx,,0.3,0,0.4,3\n").unwrap();
    let run = |verb: &[&str], texel: &str| {
        let done = Command::new(env!("CARGO_BIN_EXE_brdfbake"))
            .args(verb)
            .args(["--texel", texel])
            .output()
            .unwrap();
        (done.status.code().unwrap(), String::from_utf8(done.stderr).unwrap())
    };
    let rows = rows.display().to_string();
    let eval: &[&str] = &["eval", &rows];
    let picture = dir.path().join("plot.png").display().to_string();
    for (verb, place, code, words) in [
        (eval, at(&out, "m:3,2"), 0, "texel: alpha = "),
        (&["plot", "ggx", "beckmann", "-o", &picture], at(&out, "m:3,2,1"), 0, "texel: alpha = "),
        (&["plot", "lambert", "-o", &picture], at(&out, "m:3,2"), 3, "lambert has no alpha"),
        (eval, at(&out, "m:8,2"), 3, "level 0 has 8 x 6 texels, and (8, 2) is none of them"),
        (eval, at(&out, "m.roughness.ktx2:0,0,4"), 3, "level 4 is not in the file"),
        (eval, at(&out, "m.error.ktx2:0,0"), 3, "distance, doubt are no parameters"),
        (eval, at(&out, "m.roughness.dds:0,0"), 3, "does not say what its channels are"),
        (eval, at(&out, "other:0,0"), 3, "no such file"),
        (
            eval,
            format!("{}:0,0", dir.path().join("n.png").display()),
            3,
            "does not say what its channels are",
        ),
        (eval, at(&out, "m"), 2, "is no texel"),
    ] {
        let (status, talk) = run(verb, &place);
        assert!(status == code && talk.contains(words), "{place}: {status} {talk}");
    }
}
