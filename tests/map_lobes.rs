//! Lobes at each texel, and lobes of two numbers: from files to files.
#![allow(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "test"
)]

use crate::map_files::picture;
use crate::sbrdf::ggx;
use crate::tolerance::{FIT_EXACT, LOBE_DIGITS, LOBE_OVER_DIRECTIONS, SINGLE_ANGLES};
use brdfbake::cancel::Cancel;
use brdfbake::encode::read::read_file;
use brdfbake::functions::conversion::{By, conversion};
use brdfbake::functions::{Angles, Subject};
use brdfbake::maps::sbrdf::{CosineLobe, Normalise, exponent};
use brdfbake::maps::{Effort, Shape};
use brdfbake::picture::Space;
use brdfbake::pipeline::audit::{State, audit};
use brdfbake::pipeline::map::AnisotropyInput;
use brdfbake::pipeline::map::texel::{MapTexel, TexelPlace};
use brdfbake::pipeline::map::{
    ColourInput, FromLobe, MapError, MapOutcome, MapRequest, NumberInput, Origin, Output, RoughnessInput,
    SbrdfRequest, Second, run,
};
use brdfbake::pipeline::{Settings, fresh};
use brdfbake::plan::Plan;
use brdfbake::recipe;
use glam::DVec3;
use serde_json::{Map, json};
use std::f64::consts::{FRAC_1_PI, FRAC_PI_2, PI};
use std::path::{Path, PathBuf};

fn output(text: &str) -> Output {
    Output::parse(text).unwrap()
}

fn request(roughness: RoughnessInput, outputs: &[&str]) -> MapRequest {
    let request = MapRequest::new("s", None, roughness);
    MapRequest { outputs: outputs.iter().map(|o| output(o)).collect(), check: 4, ..request }
}

fn bake(request: &MapRequest, out: &Path, jobs: usize) -> Result<MapOutcome, MapError> {
    let settings = Settings { jobs: Some(jobs), ..Settings::new(out) };
    run(request, &settings, &Cancel::new(), &|_, _| {})
}

fn channel(out: &Path, map: &str, name: &str) -> Vec<f64> {
    read_file(&out.join(format!("s.{map}.exr"))).unwrap().channel(name).unwrap().values.clone()
}

/// A recipe to files: what the maps hold, on every level, with any number of threads; the folder is what its plan says.
#[test]
fn parameter_maps_become_lobes() {
    let dir = tempfile::tempdir().unwrap();
    picture(dir.path(), "r.png", [4, 2], 1, |x, y, _| 100 + 10 * (x + 4 * y) as u8);
    picture(dir.path(), "b.png", [4, 2], 3, |x, y, c| if c == 0 { 255 } else { 20 * (x + 4 * y) as u8 });
    let text = "name = 'map'\n[[map]]\nname = 's'\nroughness = 'r.png'\noutputs = ['exr', 'ktx2', 'png', 'dds']\ncheck = 4\n\
                sbrdf = { model = 'lafortune', lobes = 2, normalise = 'largest', base = 'b.png', metallic = 0.5 }\n";
    let file = dir.path().join("recipe.toml");
    std::fs::write(&file, text).unwrap();
    let plan = recipe::load(&file).unwrap();
    let asked = &plan.maps[0].asked;
    let sbrdf = asked.sbrdf.as_ref().unwrap();
    let image = ColourInput::Image { image: dir.path().join("b.png").into(), space: Space::Srgb };
    assert_eq!(sbrdf.origin, Origin::Metallic { base: image, metallic: NumberInput::Constant(0.5) });
    let (out, other) = (dir.path().join("1"), dir.path().join("3"));
    let done = bake(asked, &out, 1).unwrap();
    let told = done.record.sbrdf.as_ref().unwrap();
    assert!(told.storage[1] < 0.01 && told.reciprocal, "{:?}", told.storage);
    assert_eq!([told.levels.len(), told.lobes, told.fitted], [3, 2, 2]);
    bake(asked, &other, 3).unwrap();
    let manifest = |p: &Path| std::fs::read(p.join("manifest.json")).unwrap();
    assert_eq!(manifest(&out), manifest(&other));
    // what is planned is there, whole and fresh; another number of lobes is another map
    assert_eq!(done.files.len(), plan.files().len());
    assert!(audit(&out).unwrap().files.iter().all(|f| f.state == State::Whole));
    assert_eq!(fresh::stale(&plan, &out), Vec::<String>::new());
    let mut more = asked.clone();
    more.sbrdf.as_mut().unwrap().lobes = 3;
    assert!(!fresh::stale(&Plan::from_all("map", Vec::new(), vec![more]).unwrap(), &out).is_empty());

    let [first, second] = ["lobe1.albedo", "lobe2.albedo"].map(|map| {
        let [r, g, b] = ["albedo.r", "albedo.g", "albedo.b"].map(|c| channel(&out, map, c));
        (0..8).map(|t| 0.2126 * r[t] + 0.7152 * g[t] + 0.0722 * b[t]).collect::<Vec<_>>()
    });
    assert!(first.iter().zip(&second).all(|(a, b)| a >= b));
    for map in ["lobe1.shape", "lobe2.shape"] {
        let [x, y, z] = ["c.x", "c.y", "c.z"].map(|c| channel(&out, map, c));
        for t in 0..8 {
            let largest = x[t].abs().max(y[t].abs()).max(z[t].abs());
            assert!((largest - 1.0).abs() < SINGLE_ANGLES, "{map} {t}: {largest}");
        }
    }
    // what the files of the second texel reflect, at light and viewer off the fit's own, is near to GGX over a diffuse floor
    let (alpha, base) = ((110.0f64 / 255.0).powi(2), [1.0, Space::Srgb.decode(20.0 / 255.0).into()]);
    let at = |map: &str, name: &str| channel(&out, map, name)[1];
    let lobes = ["lobe1", "lobe2"].map(|lobe| {
        let [albedo, shape] = ["albedo", "shape"].map(|m| format!("{lobe}.{m}"));
        let axis = DVec3::new(at(&shape, "c.x"), at(&shape, "c.y"), at(&shape, "c.z"));
        let weights = ["albedo.r", "albedo.g"].map(|c| at(&albedo, c) * at(&albedo, "constant"));
        (axis, exponent(at(&shape, "exponent")), weights)
    });
    let diffuse = ["diffuse.r", "diffuse.g"].map(|c| at("diffuse", c));
    let (mut off, mut whole) = (0.0, 0.0);
    for (c, base) in base.into_iter().enumerate() {
        for mu in [0.9f64, 0.6, 0.35] {
            let i = DVec3::new((1.0 - mu * mu).sqrt(), 0.0, mu);
            for (o, area) in crate::sbrdf::hemisphere(DVec3::new(-i.x, 0.0, i.z), 120, 48) {
                let lobe =
                    |(axis, n, w): &(DVec3, f64, [f64; 2])| w[c] * (*axis * i).dot(o).max(0.0).powf(*n);
                let f = diffuse[c] * FRAC_1_PI + lobes.iter().map(lobe).sum::<f64>();
                let f0 = 0.5 * 0.04 + 0.5 * base;
                let fresnel = f0 + (1.0 - f0) * (1.0 - i.dot((i + o).normalize())).powi(5);
                let truth = ggx(i, o, alpha, f0) + (1.0 - fresnel) * 0.5 * base * FRAC_1_PI * o.z;
                off += area * (f * o.z - truth).abs();
                whole += area * truth;
            }
        }
    }
    // by Schwarz's inequality the residual of the norm bounds the integral of the difference
    let residual = channel(&out, "residual", "residual")[1];
    assert!(off / whole < 2f64.sqrt() * residual, "{} residual {residual}", off / whole);
    assert!(
        (residual - told.levels[0].largest).abs() < 0.1
            && residual <= told.levels[0].largest + LOBE_OVER_DIRECTIONS
    );
    assert!(off / whole < 0.3, "{}", off / whole);
    let text = brdfbake::report::inspect("x", &read_file(&out.join("s.lobe1.shape.ktx2")).unwrap());
    assert!(text.contains("2 lobes of Lafortune, largest integral, reciprocal"), "{text}");
}

/// A table in half and difference angles, written as the published reader takes it, of one lobe along the mirror direction.
fn merl(n: f64) -> Vec<u8> {
    let mut planes = vec![0.0; 90 * 90 * 180];
    for (k, slot) in planes.iter_mut().enumerate() {
        let (h, d, p) = (k / 180 / 90, k / 180 % 90, k % 180);
        let part = (h as f64 + 0.5) / 90.0;
        let (theta_h, theta_d) = (FRAC_PI_2 * part * part, FRAC_PI_2 * (d as f64 + 0.5) / 90.0);
        let phi_d = PI * (p as f64 + 0.5) / 180.0;
        let local = DVec3::new(theta_d.sin() * phi_d.cos(), theta_d.sin() * phi_d.sin(), theta_d.cos());
        let turn = |v: DVec3| {
            let (s, c) = theta_h.sin_cos();
            DVec3::new(c * v.x + s * v.z, v.y, c * v.z - s * v.x)
        };
        let (i, o) = (turn(local), turn(DVec3::new(-local.x, -local.y, local.z)));
        let mirror = DVec3::new(-i.x, -i.y, i.z);
        *slot = if i.z > 0.0 && o.z > 0.0 {
            0.05 + 0.2 * (n + 2.0) / (2.0 * PI) * mirror.dot(o).max(0.0).powf(n)
        } else {
            -1.0
        };
    }
    let mut bytes: Vec<u8> = [90i32, 90, 180].iter().flat_map(|v| v.to_le_bytes()).collect();
    for scale in [1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0] {
        bytes.extend(planes.iter().flat_map(|v| (v / scale).to_le_bytes()));
    }
    bytes
}

/// One lobe of known shape in a table comes back; the lobes that are not needed are black; a bad table is told with its texel.
#[test]
fn a_tabulated_lobe_is_found_and_a_bad_table_is_told() {
    let dir = tempfile::tempdir().unwrap();
    let (path, out) = (dir.path().join("phong.binary"), dir.path().join("out"));
    let bytes = merl(50.0);
    std::fs::write(&path, &bytes).unwrap();
    let mut request = request(RoughnessInput::Constant(1.0), &["exr"]);
    request.sbrdf = Some(SbrdfRequest {
        origin: Origin::Tabulated(path.clone().into()),
        lobes: 2,
        residual: Some(0.05),
        normalise: Normalise::Largest,
    });
    let done = bake(&request, &out, 2).unwrap();
    let told = done.record.sbrdf.as_ref().unwrap();
    assert_eq!([told.lobes, told.fitted], [2, 1], "{:?}", told.levels);
    let texel = |map: &str, name: &str| channel(&out, map, name)[0];
    let n = exponent(texel("lobe1.shape", "exponent"));
    assert!((n / 50.0 - 1.0).abs() < 0.05, "{n}");
    assert!((texel("lobe1.albedo", "albedo.g") - 0.2).abs() < 0.01);
    assert!(texel("lobe2.albedo", "albedo.g").abs() <= 0.0);
    assert!((texel("diffuse", "diffuse.b") - 0.05 * PI).abs() < 0.005);
    assert!((texel("lobe1.shape", "c.x") + texel("lobe1.shape", "c.z")).abs() < 0.02);

    std::fs::remove_dir_all(&out).unwrap();
    let mut broken = bytes.clone();
    let at = 12 + 8 * (90 * 90 * 180 + 180 * 90 * 2 + 180 * 3 + 4);
    broken[at..at + 8].copy_from_slice(&f64::NAN.to_le_bytes());
    for (bad, expected) in [
        (&bytes[..bytes.len() - 8], "phong.binary: merl: the file has"),
        (&bytes[4..], "phong.binary: "),
        (broken.as_slice(), "phong.binary: colour 1, texel [2, 3, 4] (theta_h, theta_d, phi_d) is NaN"),
    ] {
        std::fs::write(&path, bad).unwrap();
        let message = bake(&request, &out, 2).unwrap_err().to_string();
        assert!(message.contains(expected), "{message}");
        assert!(!out.exists(), "something was written");
    }
}

/// What cannot be is refused with the key, or the file and its texel, and nothing is written.
#[test]
fn lobes_that_cannot_be_are_told() {
    let dir = tempfile::tempdir().unwrap();
    picture(dir.path(), "r.png", [4, 2], 1, |_, _, _| 90);
    picture(dir.path(), "small.png", [2, 2], 3, |_, _, _| 90);
    let nan = dir.path().join("nan.exr");
    let bad = |x, y| (0.5f32, if (x, y) == (2, 1) { f32::NAN } else { 0.5 }, 0.0f32);
    exr::prelude::write_rgb_file(&nan, 4, 2, bad).unwrap();
    let out = dir.path().join("out");
    for (keys, expected) in [
        ("lobes = 0", "lobes = 0 is out of range"),
        ("lobes = 4", "lobes = 4 is out of range"),
        ("lobes = 1.5", "lobes"),
        ("residual = 0", "residual = 0 is out of range"),
        ("base = [1, 0.5]", "base"),
        ("base = [1, 0.5, 2]", "base = 2 is out of range"),
        ("base = 'small.png'", "small.png has 2 x 2 texels"),
        ("metallic = { file = 'r.png', channel = 'M' }", "no channel `M`; there is Y"),
        ("metallic = 0.5, brdf = 'r.png'", "a tabulated BRDF has colours of its own"),
        ("brdf = 'r.png'", "is no table of the MERL database"),
        ("normalise = 'mean'", "normalise"),
        ("base = { file = 'nan.exr' }", "nan.exr: level 0, texel (2, 1): a value is not finite"),
    ] {
        let roughness = if keys.starts_with("brdf") { "" } else { "roughness = 'r.png'\n" };
        let text = format!(
            "name = 'm'\n[[map]]\nname = 's'\n{roughness}sbrdf = {{ model = 'lafortune', {keys} }}\n"
        );
        let file = dir.path().join("recipe.toml");
        std::fs::write(&file, text).unwrap();
        let message = match recipe::load(&file) {
            Err(e) => e.to_string(),
            Ok(plan) => bake(&plan.maps[0].asked, &out, 1).unwrap_err().to_string(),
        };
        assert!(message.contains(expected), "{keys}: {message}");
        assert!(!out.exists(), "{keys}: something was written");
    }
}

/// Facets of two widths: Cx is not Cy, the tangent is that of the facets, and what the files reflect is as near as they say.
#[test]
fn brushed_facets_have_lobes_with_a_tangent() {
    let dir = tempfile::tempdir().unwrap();
    let mut request =
        request(RoughnessInput::Constant(0.5), &["exr:albedo=float+shape=float+anisotropy=float"]);
    let (strength, rotation) = (0.7, 0.4f64);
    request.anisotropy = Some(AnisotropyInput { strength, rotation, ..AnisotropyInput::default() });
    request.filter.shape = Shape::Anisotropic;
    let origin =
        Origin::Metallic { base: ColourInput::Constant([0.9; 3]), metallic: NumberInput::Constant(1.0) };
    request.sbrdf = Some(SbrdfRequest { origin, lobes: 3, residual: None, normalise: Normalise::Incident });
    let done = bake(&request, dir.path(), 2).unwrap();
    let told = done.record.sbrdf.as_ref().unwrap();
    let at = |map: &str, name: &str| channel(dir.path(), map, name)[0];
    let (x, y) = (at("tangent", "tangent.x"), at("tangent", "tangent.y"));
    assert!(
        (x - rotation.cos()).abs() < SINGLE_ANGLES && (y - rotation.sin()).abs() < SINGLE_ANGLES,
        "{x} {y}"
    );
    let turned = |j: usize| at(&format!("lobe{j}.shape"), "c.x") / at(&format!("lobe{j}.shape"), "c.y");
    assert!((1..=3).any(|j| (turned(j) - 1.0).abs() > 0.02), "{:?}", [1, 2, 3].map(turned));
    let place = TexelPlace::parse(&format!("{}:0,0", dir.path().join("s").display())).unwrap();
    let lobes =
        MapTexel::read(&[place], 1, &Cancel::new()).unwrap().subject("lafortune", &Map::new()).unwrap();
    let (low, high) = (0.25, 0.25 + 0.75 * strength * strength);
    let params = json!({ "alpha_x": high, "alpha_y": low, "f0": 0.9 });
    let truth = Subject::new("ggx", params.as_object().unwrap()).unwrap();
    let (mut off, mut whole) = (0.0, 0.0);
    for mu in [0.95f64, 0.75, 0.5, 0.3] {
        for azimuth in [0.2f64, 0.9, 1.5, 2.6] {
            let i = DVec3::new(
                (1.0 - mu * mu).sqrt() * azimuth.cos(),
                (1.0 - mu * mu).sqrt() * azimuth.sin(),
                mu,
            );
            for (o, area) in crate::sbrdf::hemisphere(DVec3::new(-i.x, -i.y, i.z), 60, 48) {
                let wo = [o.z.clamp(-1.0, 1.0).acos(), o.y.atan2(o.x)];
                let value = |subject: &Subject, turn: f64| {
                    let (wi_theta, wi_phi) = (Some(mu.acos()), Some(azimuth - turn));
                    let angles =
                        Angles { wi_theta, wi_phi, wo_theta: Some(wo[0]), wo_phi: Some(wo[1] - turn) };
                    subject.value(&angles).unwrap() * o.z * area
                };
                let (a, b) = (value(&lobes, 0.0), value(&truth, rotation));
                off += (a - b).abs();
                whole += b;
            }
        }
    }
    assert!(off / whole < 2.0 * told.levels[0].mean, "{} residual {:?}", off / whole, told.levels);
}

/// A level against what its footprint reflects: told of the fast way, and followed by the reference mode, which comes nearer.
#[test]
fn levels_of_lobes_are_measured_and_refitted() {
    let dir = tempfile::tempdir().unwrap();
    let code = |x: u32, y: u32| if (x + y).is_multiple_of(2) { 80 } else { 190 };
    let roughness = picture(dir.path(), "r.png", [2, 2], 1, |x, y, _| code(x, y));
    let base = picture(dir.path(), "b.png", [2, 2], 3, |x, y, c| {
        if (x + y).is_multiple_of(2) { 250 } else { [240, 90, 60][c] }
    });
    let mut request = request(RoughnessInput::new(roughness), &["exr:albedo=float+shape=float"]);
    let origin = Origin::Metallic {
        base: ColourInput::Image { image: base.into(), space: Space::Linear },
        metallic: NumberInput::Constant(1.0),
    };
    request.sbrdf = Some(SbrdfRequest { origin, lobes: 2, residual: None, normalise: Normalise::Incident });
    let (mut told, mut off) = (Vec::new(), Vec::new());
    for effort in [Effort::Fast, Effort::Exact] {
        request.filter.effort = effort;
        let out = dir.path().join(format!("{effort:?}"));
        let done = bake(&request, &out, 2).unwrap();
        let level = &done.record.sbrdf.as_ref().unwrap().levels[1];
        let measured = level.measured.unwrap();
        assert!(measured.texels == 1 && measured.refit <= measured.mean, "{measured:?}");
        told.push(if effort == Effort::Exact { level.mean } else { measured.mean });
        let at = |map: &str, name: &str| {
            let bytes = std::fs::read(out.join(format!("s.{map}.exr"))).unwrap();
            let image = brdfbake::encode::read::read_level_until(&Cancel::new(), &bytes, 1).unwrap();
            image.channel(name).unwrap().values[0]
        };
        let lobes = ["lobe1", "lobe2"].map(|lobe| {
            let [albedo, shape] = ["albedo", "shape"].map(|m| format!("{lobe}.{m}"));
            let c = ["c.x", "c.y", "c.z"].map(|c| at(&shape, c));
            (CosineLobe { c, n: exponent(at(&shape, "exponent")) }, at(&albedo, "albedo.r"))
        });
        let diffuse = at("diffuse", "diffuse.r");
        let (mut sum, mut whole) = (0.0, 0.0);
        for mu in [0.97f64, 0.75, 0.6, 0.35] {
            let i = DVec3::new((1.0 - mu * mu).sqrt(), 0.0, mu);
            for (o, area) in crate::sbrdf::hemisphere(DVec3::new(-i.x, 0.0, i.z), 120, 48) {
                let lobe = |(lobe, w): &(CosineLobe, f64)| w * lobe.power(i, o) / lobe.norm(i);
                let f = diffuse * FRAC_1_PI + lobes.iter().map(lobe).sum::<f64>();
                let facet = |code: f64, f0: f64| 0.5 * ggx(i, o, (code / 255.0f64).powi(2), f0 / 255.0);
                let truth = facet(80.0, 250.0) + facet(190.0, 240.0);
                sum += area * (f * o.z - truth).abs();
                whole += area * truth;
            }
        }
        off.push(sum / whole);
        assert!(off[off.len() - 1] < 2f64.sqrt() * told[told.len() - 1], "{effort:?}: {off:?} {told:?}");
    }
    assert!(told[1] <= told[0] + SINGLE_ANGLES && off[1] < 1.02 * off[0], "{told:?} {off:?}");
}

/// Codes of lobes in an image of three channels.
fn from(map: PathBuf, id: &str, range: [f64; 2], second: Option<Second>) -> RoughnessInput {
    let mut input = RoughnessInput::new(map);
    let RoughnessInput::Image { from, channel, .. } = &mut input else { unreachable!() };
    *channel = "R".into();
    let (conversion, by) = (conversion(id).unwrap(), By::Nearest);
    *from = Some(FromLobe { conversion, range, log: false, by, second });
    input
}

/// Ward's widths and angle: two widths that are 0.8729 of them along the turned axes, on every level of a constant map; the certificate is
/// written beside it.
#[test]
fn two_numbers_and_an_angle_become_anisotropy() {
    let dir = tempfile::tempdir().unwrap();
    // 0.2 and 0.4 on [0, 1]; a quarter of half a turn is 45 degrees
    let map = picture(dir.path(), "w.png", [4, 2], 3, |_, _, c| [51, 102, 64][c]);
    let second = Some(Second { channel: "G".into(), angle: Some("B".into()) });
    let mut request = request(from(map, "ward", [0.001, 1.0], second), &["exr"]);
    let refused = bake(&request, dir.path(), 1).unwrap_err().to_string();
    assert!(refused.contains("ward tells of two widths"), "{refused}");
    request.filter.shape = Shape::Anisotropic;
    let done = bake(&request, dir.path(), 2).unwrap();
    let told = done.record.conversion.as_ref().unwrap();
    assert!((told.distance[1] - 0.179_768).abs() < LOBE_DIGITS && told.energy[0] > 0.0, "{told:?}");
    assert!((channel(dir.path(), "conversion", "distance")[5] - 0.179_768).abs() < LOBE_DIGITS);
    assert!((channel(dir.path(), "conversion", "energy")[5] - told.energy[1]).abs() < LOBE_DIGITS);
    let read = |name: &str, id: &str| channel(dir.path(), name, id)[0];
    let [x, y] = [0.2, 0.4].map(|c| 0.872_911 * (0.001 + 0.999 * c));
    let roughness = read("roughness", "roughness");
    assert!((roughness * roughness - x).abs() < LOBE_DIGITS, "{roughness}");
    let strength = read("anisotropy", "strength");
    assert!((strength - ((y - x) / (1.0 - x)).sqrt()).abs() < LOBE_DIGITS, "{strength}");
    // the wide axis is the second one, a quarter of a turn further
    let angle = PI * 64.0 / 255.0 - FRAC_PI_2;
    let (c, s) = (read("anisotropy", "direction.x"), read("anisotropy", "direction.y"));
    assert!((c * angle.sin() - s * angle.cos()).abs() < LOBE_DIGITS, "{c} {s}");
    for level in &done.record.levels[1..] {
        let near = (f64::from(level.roughness[0]) - roughness).abs() < SINGLE_ANGLES;
        assert!(near && f64::from(level.largest) < FIT_EXACT, "{level:?}");
    }
}

/// More pairs than are converted one by one are read between, and what that costs is told; widths stay what `to-ggx` tells.
#[test]
fn many_numbers_are_read_between() {
    let dir = tempfile::tempdir().unwrap();
    let map = picture(dir.path(), "n.png", [24, 24], 3, |x, y, c| [10 * x, 10 * y, 0][c] as u8);
    let second = Some(Second { channel: "G".into(), angle: None });
    let mut request = request(from(map, "disney", [0.2, 0.6], second), &["exr"]);
    request.filter.shape = Shape::Anisotropic;
    let expected = {
        let from = request.roughness.from().unwrap();
        let number = |c: u32| from.number(f64::from(10 * c) / 255.0);
        from.conversion.convert([number(7), number(18)], By::Nearest)
    };
    let done = bake(&request, dir.path(), 2).unwrap();
    let told = done.record.conversion.as_ref().unwrap();
    assert!(told.between > 0.0 && told.between < 0.01 && !told.worst.is_empty(), "{told:?}");
    // GGX is told in other numbers: nothing is lost, nothing gained
    assert!(told.distance[1] < FIT_EXACT && told.gained.texels == 0, "{told:?}");
    let narrow = expected.alphas[0].min(expected.alphas[1]).sqrt();
    let r = channel(dir.path(), "roughness", "roughness")[18 * 24 + 7];
    assert!((r - narrow).abs() < 0.01, "{r} {narrow}");
    // wider than a map can hold: D is that of what is written
    let map = picture(dir.path(), "wide.png", [2, 2], 3, |_, _, _| 255);
    let second = Some(Second { channel: "G".into(), angle: None });
    let wide = MapRequest { roughness: from(map, "disney", [0.0, 1.0], second), ..request.clone() };
    let told = bake(&wide, dir.path(), 1).unwrap().record.conversion.unwrap();
    assert!(told.distance[0] > 0.1, "{told:?}");
}

/// Phong's lobe reflects less at grazing than GGX: a finding with its texels, and both maps agree with the record.
#[test]
fn gained_energy_is_a_finding() {
    let dir = tempfile::tempdir().unwrap();
    let map = picture(dir.path(), "n.png", [4, 2], 3, |x, _, _| if x == 3 { 50 } else { 10 });
    let request = request(from(map, "phong", [0.0, 255.0], None), &["exr"]);
    let done = bake(&request, dir.path(), 2).unwrap();
    let told = done.record.conversion.as_ref().unwrap();
    let (_, gap) = conversion("phong").unwrap().certified([50.0; 2], By::Nearest).unwrap();
    assert!(gap.gained > 0.1 && told.gained.texels == 8, "{told:?}");
    let energy = channel(dir.path(), "conversion", "energy");
    assert!((energy[3] - gap.largest).abs() < LOBE_OVER_DIRECTIONS, "{energy:?} {gap:?}");
    let largest = energy.iter().fold(0.0f64, |m, v| m.max(*v));
    assert!(
        (largest - told.energy[1]).abs() < LOBE_OVER_DIRECTIONS
            && told.worst[0].energy >= told.worst[7].energy
    );
}
