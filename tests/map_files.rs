//! From maps to files: what must not change, what must be told, and what readers of other makes find.
#![allow(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::float_cmp,
    reason = "test"
)]

use crate::tolerance::{LOBE_DIGITS, SINGLE_ANGLES};
use brdfbake::cancel::Cancel;
use brdfbake::encode::Storage;
use brdfbake::maps::{Centre, Effort, Objective, Shape};
use brdfbake::picture::{Picture, read_bytes};
use brdfbake::pipeline::map::{Input, MapOutcome, MapRequest, Output, RoughnessInput, run};
use brdfbake::pipeline::{self, audit};
use brdfbake::plan::map::Held;
use std::path::{Path, PathBuf};

/// An 8-bit PNG.
pub(crate) fn picture(
    folder: &Path,
    name: &str,
    size: [u32; 2],
    channels: usize,
    code: impl Fn(u32, u32, usize) -> u8,
) -> PathBuf {
    let path = folder.join(name);
    let mut encoder = png::Encoder::new(std::fs::File::create(&path).unwrap(), size[0], size[1]);
    encoder.set_color(if channels == 1 { png::ColorType::Grayscale } else { png::ColorType::Rgb });
    let mut data = Vec::new();
    for y in 0..size[1] {
        for x in 0..size[0] {
            data.extend((0..channels).map(|c| code(x, y, c)));
        }
    }
    encoder.write_header().unwrap().write_image_data(&data).unwrap();
    path
}

/// Codes of the normal of a slope.
pub(crate) fn normal_code(slope: [f64; 2], c: usize) -> u8 {
    let length = (1.0 + slope[0] * slope[0] + slope[1] * slope[1]).sqrt();
    let n = [-slope[0] / length, -slope[1] / length, 1.0 / length];
    ((n[c] * 0.5 + 0.5) * 255.0).round() as u8
}

fn image(path: PathBuf) -> RoughnessInput {
    RoughnessInput::new(path)
}

fn output(text: &str) -> Output {
    Output::parse(text).unwrap()
}

fn request(normal: Option<PathBuf>, roughness: RoughnessInput) -> MapRequest {
    let request = MapRequest::new("m", normal.map(Input::new), roughness);
    MapRequest { outputs: vec![output("png")], check: 16, ..request }
}

fn bake(request: &MapRequest, out: &Path) -> MapOutcome {
    run(request, &pipeline::Settings::new(out), &Cancel::new(), &|_, _| {}).unwrap()
}

fn level(out: &Path, map: &str, k: usize) -> Picture {
    read_bytes(&std::fs::read(out.join(format!("m.{map}.mip{k}.png"))).unwrap()).unwrap()
}

fn codes(picture: &Picture, channel: &str) -> Vec<u32> {
    picture.plane(channel).unwrap().values.iter().map(|v| (v * 255.0).round() as u32).collect()
}

/// Flat normals, of full length and short: 77 stays 77 on every level, whatever the rule.
#[test]
fn constant_maps_are_left_to_the_bit() {
    let dir = tempfile::tempdir().unwrap();
    let roughness = picture(dir.path(), "r.png", [8, 4], 1, |_, _, _| 77);
    for (name, blue) in [("flat.png", 255), ("short.png", 253)] {
        let normal = picture(dir.path(), name, [8, 4], 3, |_, _, c| if c == 2 { blue } else { 128 });
        for rule in brdfbake::maps::RULES {
            let mut request = request(Some(normal.clone()), image(roughness.clone()));
            request.filter.rule = rule;
            let out = dir.path().join(rule.id);
            let done = bake(&request, &out);
            assert_eq!(done.record.levels.len(), 4);
            for k in 0..4 {
                assert!(
                    codes(&level(&out, "roughness", k), "Y").iter().all(|c| *c == 77),
                    "{name} {}",
                    rule.id
                );
                assert!(codes(&level(&out, "error", k), "R").iter().all(|c| *c == 0));
            }
        }
    }
}

/// Ridges of 15 degrees along y and pyramids: r of level 1 by the reference of reflected light, found by another program.
#[test]
fn the_reference_of_reflected_light_is_found() {
    let dir = tempfile::tempdir().unwrap();
    let s = 15f64.to_radians().tan();
    let pyramid = |x: u32, y: u32| match (x % 2, y % 2) {
        (0, 0) => [s, 0.0],
        (1, 0) => [-s, 0.0],
        (0, _) => [0.0, s],
        _ => [0.0, -s],
    };
    let ridge = |x: u32, _: u32| if x.is_multiple_of(2) { [s, 0.0] } else { [-s, 0.0] };
    let roughness = picture(dir.path(), "r.png", [2, 2], 1, |_, _, _| 128);
    let first = picture(dir.path(), "p.png", [2, 2], 3, |x, y, c| normal_code(pyramid(x, y), c));
    let second = picture(dir.path(), "d.png", [2, 2], 3, |x, y, c| normal_code(ridge(x, y), c));
    for (normal, expected, error) in [(first, 0.6134, 0.1232), (second.clone(), 0.6336, 0.2119)] {
        let mut request = request(Some(normal), image(roughness.clone()));
        request.filter.effort = Effort::Exact;
        request.filter.objective = Objective::Reflected;
        let done = bake(&request, &dir.path().join("o"));
        let level = &done.record.levels[1];
        assert!(
            (f64::from(level.roughness[0]) - expected).abs() < 0.002,
            "{:?}, not {expected}",
            level.roughness
        );
        assert!((f64::from(level.largest) - error).abs() < 0.001, "{}, not {error}", level.largest);
    }
    let mut request = request(Some(second), image(roughness));
    request.filter.effort = Effort::Exact;
    request.filter.objective = Objective::Reflected;
    request.filter.shape = Shape::Anisotropic;
    request.outputs = vec![output("exr")];
    let out = dir.path().join("a");
    let done = bake(&request, &out);
    let level = &done.record.levels[1];
    assert!((f64::from(level.largest) - 0.1473).abs() < 0.001, "{}", level.largest);
    assert!((f64::from(level.roughness[0]).powi(2) - 0.2982).abs() < 0.002, "{:?}", level.roughness);
}

/// Pyramids of 15 degrees under r = 26/255: four lobes that no lobe fits are listed.
#[test]
fn hopeless_texels_are_listed() {
    let dir = tempfile::tempdir().unwrap();
    let s = 15f64.to_radians().tan();
    let slope = |x: u32, y: u32| match (x % 2, y % 2) {
        (0, 0) => [s, 0.0],
        (1, 0) => [-s, 0.0],
        (0, _) => [0.0, s],
        _ => [0.0, -s],
    };
    let normal = picture(dir.path(), "n.png", [4, 4], 3, |x, y, c| normal_code(slope(x, y), c));
    let done = bake(&request(Some(normal), RoughnessInput::Constant(26.0 / 255.0)), dir.path());
    assert_eq!(done.record.levels[1].hopeless, 4);
    assert_eq!(done.record.worst[0].level, 1);
    assert!(done.record.worst[0].distance > 0.5);
}

/// Facets of 30 degrees and a factor: what is written stands above the factor, for a factor of 1.
#[test]
fn a_factor_is_inside_the_map() {
    let dir = tempfile::tempdir().unwrap();
    let s = 30f64.to_radians().tan();
    let slope =
        |x: u32, y: u32| [if x.is_multiple_of(2) { s } else { -s }, if y.is_multiple_of(2) { s } else { -s }];
    let normal = picture(dir.path(), "n.png", [4, 4], 3, |x, y, c| normal_code(slope(x, y), c));
    let roughness = picture(dir.path(), "r.png", [4, 4], 1, |_, _, _| 128);
    let mut request = request(Some(normal), image(roughness));
    request.factor = 0.5;
    let done = bake(&request, dir.path());
    assert!((done.record.levels[0].roughness[0] - 0.5 * 128.0 / 255.0).abs() < SINGLE_ANGLES as f32);
    assert!(done.record.levels[1].roughness[0] > 0.5, "{:?}", done.record.levels[1].roughness);
}

/// Grooves along y: the wide axis lies along x, and the strength is that of the two widths.
#[test]
fn grooves_are_written_as_anisotropy() {
    let dir = tempfile::tempdir().unwrap();
    let slope = |x: u32| 0.5 * f64::from((x * 7) % 8) / 8.0 - 0.22;
    for turned in [false, true] {
        let normal = picture(dir.path(), "n.png", [8, 8], 3, |x, y, c| {
            normal_code(if turned { [0.0, slope(y)] } else { [slope(x), 0.0] }, c)
        });
        let mut request = request(Some(normal), RoughnessInput::Constant(0.3));
        request.filter.shape = Shape::Anisotropic;
        let out = dir.path().join(format!("{turned}"));
        let done = bake(&request, &out);
        let [w, h] = done.record.levels[2].size;
        assert_eq!([w, h], [2, 2]);
        let map = level(&out, "anisotropy", 2);
        let [x, y, s] = ["R", "G", "B"].map(|c| codes(&map, c)[0]);
        let along = if turned { y } else { x };
        assert!(!(5..=250).contains(&along), "{x} {y}");
        assert!(s > 60, "strength {s}");
        // level 0 has no axis: direction (1, 0), strength 0
        let first = level(&out, "anisotropy", 0);
        assert!(codes(&first, "R").iter().all(|c| *c == 255) && codes(&first, "B").iter().all(|c| *c == 0));
        let measured = done.record.levels[2].measured.as_ref().unwrap();
        assert!(measured.stored_mean < measured.mean + 0.01, "{measured:?}");
    }
}

/// A map of Blinn-Phong exponents: nearest widths, and D of the first level.
#[test]
fn exponents_are_converted_with_their_distance() {
    use brdfbake::functions::conversion::{By, conversion};
    use brdfbake::pipeline::map::FromLobe;
    let dir = tempfile::tempdir().unwrap();
    let exponents = picture(dir.path(), "n.png", [2, 2], 1, |_, _, _| 255);
    let mut request = request(None, image(exponents));
    let RoughnessInput::Image { from, .. } = &mut request.roughness else { unreachable!() };
    let blinn_phong = conversion("blinn-phong").unwrap();
    *from = Some(FromLobe {
        conversion: blinn_phong,
        range: [1.0, 100.0],
        log: true,
        by: By::Nearest,
        second: None,
    });
    let done = bake(&request, dir.path());
    let level = &done.record.levels[0];
    assert!((f64::from(level.roughness[0]).powi(2) - 0.1227).abs() < LOBE_DIGITS, "{:?}", level.roughness);
    assert!((f64::from(level.largest) - 0.1755).abs() < LOBE_DIGITS, "{}", level.largest);
}

/// The contact sheet: tiles of the channels, histograms, and spheres of the worst texels, of which the left half is the wider one here.
#[test]
fn a_contact_sheet_shows_maps_and_the_worst_texels() {
    let dir = tempfile::tempdir().unwrap();
    // facets that no lobe tells of: two narrow ones far apart
    let normal = picture(dir.path(), "n.png", [4, 4], 3, |x, _, c| {
        normal_code([if x.is_multiple_of(2) { 0.5 } else { -0.5 }, 0.0], c)
    });
    let mut request = request(Some(normal), RoughnessInput::Constant(0.3));
    request.outputs = vec![output("ktx2")];
    let done = bake(&request, dir.path());
    assert!(done.record.pictured.iter().any(|p| p.facets.len() == 4), "{:?}", done.record.pictured);
    let images: Vec<_> = ["error", "roughness"]
        .map(|map| brdfbake::encode::read::read_file(&dir.path().join(format!("m.{map}.ktx2"))).unwrap())
        .into();
    let text = brdfbake::report::inspect("m.error.ktx2", &images[0]);
    assert!(text.contains("Histograms") && text.contains('█') && text.contains("worst"), "{text}");
    let sheet = read_bytes(&brdfbake::report::sheet::sheet(&images).unwrap()).unwrap();
    // three channels, their histograms, four spheres
    assert_eq!([sheet.width, sheet.height], [4 * 168 + 8, 3 * 168 + 8]);
    // both halves of the first sphere are lit somewhere
    let lit = |from: usize| {
        let tile = (0..160).flat_map(|y| (from..from + 70).map(move |x| (2 * 168 + 8 + y) * sheet.width + x));
        tile.map(|i| sheet.planes[0].values[i]).fold(0.0, f32::max)
    };
    assert!(lit(8 + 5) > 0.3 && lit(8 + 85) > 0.3, "{} {}", lit(8 + 5), lit(8 + 85));
}

/// Packed channels keep plain means; roughness is filtered among them.
#[test]
fn other_channels_keep_their_means() {
    let dir = tempfile::tempdir().unwrap();
    let slope = |x: u32| [if x.is_multiple_of(2) { 0.3 } else { -0.3 }, 0.0];
    let normal = picture(dir.path(), "n.png", [5, 3], 3, |x, _, c| normal_code(slope(x), c));
    let packed = picture(dir.path(), "r.png", [5, 3], 3, |x, y, c| match c {
        0 => (10 * x + 50 * y) as u8,
        1 => 100,
        _ => 200,
    });
    bake(&request(Some(normal), image(packed)), dir.path());
    let first = level(dir.path(), "roughness", 1);
    // 5 x 3 to 2 x 1: (0 + 10 + 20/2)/2.5 = 8 and 32, with the mean 50 of the rows
    assert_eq!(codes(&first, "R"), [58, 82]);
    assert_eq!(codes(&first, "B"), [200, 200]);
    assert!(codes(&first, "G").iter().all(|g| *g > 110));
    assert_eq!(codes(&level(dir.path(), "roughness", 2), "R"), [70]);
}

/// A rough normal map, of any size.
fn bumps(dir: &Path, size: u32) -> PathBuf {
    let at = |x: u32, y: u32, k: u32| {
        let z = (u64::from(x) * 0x9e37_79b9 + u64::from(y) * 0x85eb_ca6b + u64::from(k) * 0xc2b2_ae35)
            ^ 0x2545_f491;
        let z = (z ^ (z >> 15)).wrapping_mul(0xd168_aaad) & 0xffff_ffff;
        ((z ^ (z >> 15)) & 0xffff) as f64 / 65536.0 - 0.5
    };
    picture(dir, "bumps.png", [size, size], 3, |x, y, c| {
        normal_code([0.6 * at(x, y, 0), 0.3 * at(x, y, 1)], c)
    })
}

#[test]
fn every_container_holds_every_level() {
    let dir = tempfile::tempdir().unwrap();
    let normal = bumps(dir.path(), 16);
    let mut request = request(Some(normal), RoughnessInput::Constant(0.4));
    request.filter.centre = Centre::Free;
    request.outputs = ["ktx2", "dds", "exr", "png"].map(output).to_vec();
    request.outputs[0] =
        request.outputs[0].stored(Held::Normal, Storage::Bc5).stored(Held::Roughness, Storage::Bc4);
    let out = dir.path().join("o");
    let done = bake(&request, &out);
    assert_eq!(done.written, 3 * 3 + 3 * 5 + 1);
    for (map, format) in
        [("roughness", ktx2::Format::BC4_UNORM_BLOCK), ("normal", ktx2::Format::BC5_UNORM_BLOCK)]
    {
        let bytes = std::fs::read(out.join(format!("m.{map}.ktx2"))).unwrap();
        let file = ktx2::Reader::new(&bytes).unwrap();
        let header = file.header();
        assert_eq!((header.format, header.level_count), (Some(format), 5));
        let lengths: Vec<usize> = file.levels().map(|l| l.data.len()).collect();
        let block = if map == "normal" { 16 } else { 8 };
        assert_eq!(lengths, [16 * block, 4 * block, block, block, block]);
    }
    use dds::DataRegion;
    let dds = std::fs::read(out.join("m.roughness.dds")).unwrap();
    let decoder = dds::Decoder::new(std::io::Cursor::new(&dds)).unwrap();
    let layout = decoder.layout().texture().unwrap();
    assert_eq!(layout.mipmaps(), 5);
    assert_eq!(layout.iter_mips().map(|m| m.data_len()).sum::<u64>(), 256 + 64 + 16 + 4 + 1);
    let exr = std::fs::read(out.join("m.roughness.exr")).unwrap();
    let meta = exr::meta::MetaData::read_from_buffered(std::io::Cursor::new(&exr), true).unwrap();
    let header = &meta.headers[0];
    let exr::meta::BlockDescription::Tiles(tiles) = header.blocks else { panic!("no tiles") };
    assert_eq!(tiles.level_mode, exr::meta::attribute::LevelMode::MipMap);
    assert_eq!(tiles.rounding_mode, exr::math::RoundingMode::Down);
    // one tile a level
    assert_eq!(header.chunk_count, 5);
    let largest = brdfbake::encode::read::read_bytes(&exr).unwrap();
    let coarse = &level(&out, "roughness", 0).planes[0].values;
    let fine = &largest.channel("roughness").unwrap().values;
    assert!(coarse.iter().zip(fine).all(|(c, f)| (f64::from(*c) - f).abs() <= 0.5 / 255.0 + SINGLE_ANGLES));
    let audit = audit::audit(&out).unwrap();
    assert!(audit.files.iter().all(|f| f.state == audit::State::Whole));
}

#[test]
fn any_number_of_threads_writes_the_same_bytes() {
    let dir = tempfile::tempdir().unwrap();
    let normal = bumps(dir.path(), 32);
    let mut request = request(Some(normal), RoughnessInput::Constant(0.3));
    request.filter.centre = Centre::Free;
    request.filter.shape = Shape::Anisotropic;
    let manifest = |jobs: usize| {
        let out = dir.path().join(format!("j{jobs}"));
        let settings = pipeline::Settings { jobs: Some(jobs), ..pipeline::Settings::new(&out) };
        run(&request, &settings, &Cancel::new(), &|_, _| {}).unwrap();
        std::fs::read(out.join("manifest.json")).unwrap()
    };
    assert_eq!(manifest(1), manifest(3));
}

/// The measurement against the texels themselves agrees with what the filter told, and the fit is nearer than the rules.
#[test]
fn what_is_told_is_what_is_measured() {
    let dir = tempfile::tempdir().unwrap();
    let normal = bumps(dir.path(), 64);
    let mut request = request(Some(normal), RoughnessInput::Constant(0.25));
    request.compare = true;
    request.check = 200;
    let done = bake(&request, dir.path());
    for (k, level) in done.record.levels.iter().enumerate().skip(1) {
        let measured = level.measured.as_ref().unwrap();
        assert!(
            measured.miss <= 2.0 * f64::from(level.doubt) + 0.01,
            "level {k}: {measured:?}, {}",
            level.doubt
        );
        for rule in measured.rules.iter().filter(|r| r.rule != "lean") {
            assert!(
                measured.mean <= 1.05 * rule.mean + 1e-3,
                "level {k}: {} is nearer: {measured:?}",
                rule.rule
            );
        }
    }
}

#[test]
fn bad_input_is_told_and_nothing_is_written() {
    let dir = tempfile::tempdir().unwrap();
    let flat = |x: u32, y: u32, c: usize| match (x, y, c) {
        (2, 1, _) => 128,
        (_, _, 2) => 255,
        _ => 128,
    };
    // 128 is 0.004 of a normal: a length of 0.007 is one still; 127 and 128 mixed are not
    let hole = picture(
        dir.path(),
        "hole.png",
        [4, 4],
        3,
        |x, y, c| if (x, y) == (2, 1) { 0 } else { flat(0, 0, c) },
    );
    let small = picture(dir.path(), "small.png", [2, 2], 1, |_, _, _| 90);
    let sound = picture(dir.path(), "sound.png", [4, 4], 3, |_, _, c| flat(0, 0, c));
    let cut = dir.path().join("cut.png");
    let bytes = std::fs::read(&sound).unwrap();
    std::fs::write(&cut, &bytes[..bytes.len() - 20]).unwrap();
    let out = dir.path().join("out");
    let fails = |request: &MapRequest| {
        let failed = run(request, &pipeline::Settings::new(&out), &Cancel::new(), &|_, _| {});
        assert!(!out.exists(), "something was written");
        failed.unwrap_err().to_string()
    };
    let message = fails(&request(Some(hole.clone()), RoughnessInput::Constant(0.5)));
    assert!(
        message.contains("hole.png: level 0, texel (2, 1): the normal points along the surface or into it"),
        "{message}"
    );
    let message = fails(&request(Some(sound.clone()), image(small.clone())));
    assert!(
        message.contains("sound.png has 4 x 4 texels") && message.contains("small.png has 2 x 2:"),
        "{message}"
    );
    let message = fails(&request(Some(cut), RoughnessInput::Constant(0.5)));
    assert!(message.contains("cut.png: png:"), "{message}");
    let message = fails(&request(Some(dir.path().join("none.png")), RoughnessInput::Constant(0.5)));
    assert!(message.contains("none.png"), "{message}");
    let message = fails(&request(Some(sound.clone()), RoughnessInput::Constant(1.5)));
    assert_eq!(message, "map[0].roughness: roughness = 1.5 is out of range; allowed: 0 to 1");
    let message = fails(&request(None, RoughnessInput::Constant(0.5)));
    assert!(message.contains("nothing to filter"), "{message}");
    let mut wrong = request(Some(sound.clone()), RoughnessInput::Constant(0.5));
    wrong.normal.as_mut().unwrap().channels[2] = "Z".into();
    let message = fails(&wrong);
    assert!(message.contains("no channel `Z`; there is R, G, B"), "{message}");
    // a packed map in one block channel
    let mut packed = request(None, image(sound.clone()));
    packed.outputs = vec![output("ktx2:roughness=bc4")];
    let message = fails(&packed);
    assert!(message.contains("cannot hold 3 channels"), "{message}");
    // mended, resampled
    let mut mended = request(Some(hole), image(small));
    mended.normal.as_mut().unwrap().convention.mend = true;
    mended.normal.as_mut().unwrap().resample = true;
    bake(&mended, &out);
}

/// NaN in an EXR, written by the library's own encoder.
#[test]
fn a_number_that_is_none_is_told() {
    use exr::prelude::write_rgb_file;
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("nan.exr");
    write_rgb_file(&path, 3, 2, |x, y| (0.0f32, if (x, y) == (1, 1) { f32::NAN } else { 0.5 }, 0.0f32))
        .unwrap();
    let failed = run(
        &request(None, image(path)),
        &pipeline::Settings::new(dir.path().join("out")),
        &Cancel::new(),
        &|_, _| {},
    );
    let message = failed.unwrap_err().to_string();
    assert!(message.contains("nan.exr: level 0, texel (1, 1): a value is not finite"), "{message}");
}

/// The widest lobe there is, under normals that would widen it: it stays, and it is told.
#[test]
fn a_roughness_of_one_stays_one() {
    let dir = tempfile::tempdir().unwrap();
    let normal = bumps(dir.path(), 32);
    for (centre, shape) in [(Centre::Mean, Shape::Isotropic), (Centre::Free, Shape::Anisotropic)] {
        let mut request = request(Some(normal.clone()), RoughnessInput::Constant(1.0));
        (request.filter.centre, request.filter.shape) = (centre, shape);
        for rule in brdfbake::maps::RULES.iter().filter(|r| r.id == "fit" || centre == Centre::Mean) {
            request.filter.rule = rule;
            let done = bake(&request, &dir.path().join("o"));
            assert!(done.record.levels.iter().all(|l| l.roughness == [1.0, 1.0]), "{}", rule.id);
        }
    }
}
