//! `verify` on files: each fault is found and named, sound files are not blamed.
#![allow(clippy::unwrap_used, reason = "test")]

use brdfbake::cancel::Cancel;
use brdfbake::encode::read::{Image, read_bytes};
use brdfbake::encode::{EncodeInput, Label, Storage, encoder};
use brdfbake::grid::{Axis, Provenance, Quantity, Texel};
use brdfbake::pipeline::Baked;
use brdfbake::pipeline::recheck::{self, Asked, Beside, Kind, Recheck, SAMPLES, Verdict, recheck};
use brdfbake::plan::{Output, TableRequest};
use brdfbake::tables::spec::Request;
use brdfbake::verify::seeds::Seeds;
use std::path::Path;
use std::process::{Command, Output as Ran};
use std::sync::OnceLock;

const LEN: usize = 12;

/// A split sum whose axes have the same length, so that they can be swapped.
fn baked() -> &'static Baked {
    static BAKED: OnceLock<Baked> = OnceLock::new();
    BAKED.get_or_init(|| {
        let axis = |id| Axis::new(Quantity::find(id).unwrap(), LEN, Texel::Center);
        let request = Request {
            kind: "dfg".into(),
            layout: Some("scale-bias".into()),
            axes: Some(vec![axis("mu"), axis("roughness")]),
            ..Request::default()
        };
        let mut asked = TableRequest::new("t", request);
        asked.tolerance = Some(1e-6);
        asked.reconstruction = Some(true);
        brdfbake::bake(asked).unwrap()
    })
}

fn file(output: &str) -> Vec<u8> {
    baked().encode(&Output::parse(output).unwrap()).unwrap()
}

/// A file of the table with other numbers and other words: what `change` makes of `[texel][channel]` and of the metadata.
fn mutant(output: &str, change: impl FnOnce(&mut Vec<f64>, &mut Provenance)) -> Vec<u8> {
    let image = read_bytes(&file(output)).unwrap();
    let mut p = image.known().unwrap().clone();
    let storage = Storage::find(&p.encoding.as_ref().unwrap().storage).unwrap();
    let n = p.channels.len();
    let mut values: Vec<f64> =
        (0..LEN * LEN * n).map(|i| image.channel(&p.channels[i % n].id).unwrap().values[i / n]).collect();
    change(&mut values, &mut p);
    let table = baked().table();
    let round = |(i, v): (usize, &f64)| storage.quantise(*v, table.channels[i % n].range).unwrap_or(*v);
    let values: Vec<f64> = values.iter().enumerate().map(round).collect();
    let json = serde_json::to_string(&p).unwrap();
    let input = EncodeInput {
        grid: &table.grid,
        channels: &table.channels,
        values: &values,
        blocks: &[],
        errors: &[],
        storage,
        options: &[],
        label: Label { name: "t", identity: &p.recipe.hash, provenance_json: &json },
        cancel: &Cancel::new(),
    };
    encoder(output.split(':').next().unwrap()).unwrap().encode(&input).unwrap()
}

fn look(bytes: &[u8]) -> Recheck {
    let cancel = Cancel::new();
    let asked = Asked { seed: 3, samples: SAMPLES, cancel: &cancel };
    let image: Image = read_bytes(bytes).unwrap();
    recheck(image, asked).pop().unwrap()
}

/// The name of what is found first, and all words.
fn named(bytes: &[u8]) -> (Option<Kind>, String) {
    let found = look(bytes);
    let words: Vec<&str> = found.faults.iter().map(|f| f.message.as_str()).collect();
    (found.faults.first().map(|f| f.fault), words.join("; "))
}

#[test]
fn sound_files_are_whole() {
    for output in [
        "exr:float",
        "exr:half",
        "ktx2:half+zstd",
        "png:unorm16",
        "ktx2:unorm8",
        "ktx2:r11g11b10",
        "ktx2:rgb9e5",
    ] {
        let found = look(&file(output));
        assert!(found.faults.is_empty() && found.is_checked(), "{output}: {found:?}");
        let sampled = found.sampled.unwrap();
        assert!(sampled.judged >= SAMPLES && sampled.finds_one_in_twenty > 0.999, "{sampled:?}");
    }
}

#[test]
fn one_texel_in_twenty_moved_is_corruption() {
    let mut seeds = Seeds::new(11);
    let bytes = mutant("exr:float", |values, p| {
        let step = 5.0 * (p.integration.largest_error.value + p.integration.tolerance);
        for _ in 0..LEN * LEN / 20 {
            values[2 * seeds.index(LEN * LEN)] -= step;
        }
    });
    let (kind, words) = named(&bytes);
    assert_eq!(kind, Some(Kind::Corrupted), "{words}");
    assert!(words.contains("dfg.scale") && words.contains("mu ="), "{words}");
}

#[test]
fn numbers_that_are_none_are_corruption() {
    // behind the encoder's back: a half of the pixels becomes NaN
    let mut bytes = file("ktx2:half");
    let at = bytes.len() - 2 * 7;
    bytes[at..at + 2].copy_from_slice(&[0x00, 0x7e]);
    let (kind, words) = named(&bytes);
    assert_eq!(kind, Some(Kind::Corrupted), "{words}");
    assert!(words.contains("NaN"), "{words}");
}

#[test]
fn coarser_numbers_are_named() {
    let through = |storage: Storage| {
        move |values: &mut Vec<f64>, _: &mut Provenance| {
            values.iter_mut().for_each(|v| *v = storage.quantise(*v, [0.0, 1.0]).unwrap());
        }
    };
    for (output, storage) in [
        ("exr:half", Storage::Unorm8),
        ("exr:float", Storage::Half),
        ("exr:float", Storage::Unorm16),
        ("png:unorm16", Storage::Unorm8),
    ] {
        let (kind, words) = named(&mutant(output, through(storage)));
        assert_eq!(kind, Some(Kind::Requantised), "{output} {}: {words}", storage.id());
        assert!(words.contains(storage.id()), "{words}");
    }
    // the file says float and holds halves
    let (kind, words) =
        named(&mutant("exr:half", |_, p| p.encoding.as_mut().unwrap().storage = "float".into()));
    assert_eq!(kind, Some(Kind::Requantised), "{words}");
}

#[test]
fn texels_in_other_places_are_named() {
    let move_texels = |from: fn(usize, usize) -> (usize, usize)| {
        move |values: &mut Vec<f64>, _: &mut Provenance| {
            let old = values.clone();
            for i in 0..values.len() {
                let (x, y) = from(i / 2 % LEN, i / 2 / LEN);
                values[i] = old[2 * (y * LEN + x) + i % 2];
            }
        }
    };
    for (from, kind, word) in [
        ((|x, y| (LEN - 1 - x, y)) as fn(usize, usize) -> (usize, usize), Kind::Flipped, "along mu"),
        (|x, y| (x, LEN - 1 - y), Kind::Flipped, "along roughness"),
        (|x, y| (LEN - 1 - x, LEN - 1 - y), Kind::Flipped, "along mu and roughness"),
        (|x, y| (y, x), Kind::AxesSwapped, "mu runs along roughness"),
    ] {
        let (found, words) = named(&mutant("exr:half", move_texels(from)));
        assert_eq!(found, Some(kind), "{words}");
        assert!(words.contains(word), "{words}");
    }
    let swap =
        |values: &mut Vec<f64>, _: &mut Provenance| values.chunks_exact_mut(2).for_each(|t| t.swap(0, 1));
    let (found, words) = named(&mutant("exr:half", swap));
    assert_eq!(found, Some(Kind::ChannelsSwapped), "{words}");
    assert!(words.contains("dfg.scale") && words.contains("dfg.bias"), "{words}");
}

#[test]
fn labels_that_lie_are_named() {
    type Lie = fn(&mut Provenance);
    let lies: [(&str, Lie); 7] = [
        ("shifted", |p| p.axes[1].axis.offset = 1.0),
        ("roughness", |p| p.axes[1].axis.quantity = Quantity::find("alpha").unwrap()),
        ("model ggx", |p| p.model.as_mut().unwrap().id = "beckmann".into()),
        ("coordinate", |p| p.axes[0].coordinate = "1 - mu".into()),
        ("texels, the picture has", |p| p.axes[0].axis.len = LEN + 1),
        ("channel dfg.bias: it says", |p| p.channels[1].meaning = "1".into()),
        ("reading", |p| p.reconstruction.as_mut().unwrap().whole.largest.value *= 1e-3),
    ];
    for (i, (word, lie)) in lies.into_iter().enumerate() {
        let bytes = mutant("ktx2:float", |_, p| {
            lie(p);
            // labels that are derived follow
            for a in p.axes.iter_mut().filter(|_| i < 2) {
                *a = brdfbake::grid::provenance::AxisRecord::new(&a.axis);
            }
        });
        let (kind, words) = named(&bytes);
        let expected = if word == "reading" { Kind::Reading } else { Kind::Mislabelled };
        assert_eq!(kind, Some(expected), "{word}: {words}");
        assert!(word == "reading" || words.contains(word), "{word}: {words}");
    }
}

fn verify(paths: &[&Path], more: &[&str]) -> (i32, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_brdfbake"));
    let Ran { status, stdout, stderr } = command.arg("verify").args(more).args(paths).output().unwrap();
    (status.code().unwrap(), String::from_utf8(stdout).unwrap() + &String::from_utf8(stderr).unwrap())
}

#[test]
fn files_that_end_early_are_truncated() {
    let folder = tempfile::tempdir().unwrap();
    for output in ["exr:half", "ktx2:half", "ktx2:half+zstd", "png:unorm16", "dds:half", "npy:float"] {
        let whole = file(output);
        let path = folder.path().join("t.bin");
        std::fs::write(&path, &whole[..whole.len() * 4 / 5]).unwrap();
        let cancel = Cancel::new();
        let asked = Asked { seed: 1, samples: SAMPLES, cancel: &cancel };
        let found = recheck::check(&path, &Beside::load(folder.path()), asked).unwrap();
        assert_eq!(found.verdict, Verdict::Faulty, "{output}");
        assert_eq!(found.tables[0].faults[0].fault, Kind::Truncated, "{output}: {found:?}");
    }
}

/// The bytes of maps are compared with the manifest that lists them.
#[test]
fn bytes_of_maps_are_compared() {
    let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("out-examples/08-maps");
    let folder = tempfile::tempdir().unwrap();
    for name in ["manifest.json", "map.roughness.ktx2"] {
        std::fs::copy(example.join(name), folder.path().join(name)).unwrap();
    }
    let path = folder.path().join("map.roughness.ktx2");
    let cancel = Cancel::new();
    let asked = Asked { seed: 1, samples: SAMPLES, cancel: &cancel };
    let verdict = || recheck::check(&path, &Beside::load(folder.path()), asked).unwrap().verdict;
    assert_eq!(verdict(), Verdict::BytesWhole);
    let mut bytes = std::fs::read(&path).unwrap();
    *bytes.last_mut().unwrap() ^= 1;
    std::fs::write(&path, bytes).unwrap();
    assert_eq!(verdict(), Verdict::Faulty);
}

/// Containers without metadata are checked through the manifest beside them, and not without it.
#[test]
fn the_manifest_tells_of_files_that_do_not() {
    let folder = tempfile::tempdir().unwrap();
    let recipe = folder.path().join("r.toml");
    let outputs = r#"["npy:float", "raw:half", "dds:half", "csv:double"]"#;
    let axes = "axis = [{ id = 'mu', length = 9 }, { id = 'eta', length = 9 }]";
    std::fs::write(
        &recipe,
        format!(
            "name = 'x'\n[[table]]\nkind = 'fresnel-dielectric'\nname = 'f'\noutputs = {outputs}\n{axes}\n"
        ),
    )
    .unwrap();
    let out = folder.path().join("out");
    let mut command = Command::new(env!("CARGO_BIN_EXE_brdfbake"));
    assert!(command.args(["bake", "-q", "-o"]).args([&out, &recipe]).status().unwrap().success());
    let (code, told) = verify(&[&out], &[]);
    assert!(
        code == 0 && told.contains("numbers of 3 of 4 files") && told.contains("csv are not read back"),
        "{told}"
    );
    for name in ["f.npy", "f.bin", "f.dds"] {
        let path = out.join(name);
        let (code, told) = verify(&[&path], &[]);
        assert!(
            code == 0 && told.contains("81 of 81 texels judged") && told.contains("hash     held"),
            "{name}: {told}"
        );
        // a bit of the last number
        let mut bytes = std::fs::read(&path).unwrap();
        let at = bytes.len() - 1;
        bytes[at] ^= 4;
        std::fs::write(&path, &bytes).unwrap();
        let (code, told) = verify(&[&path], &["--json"]);
        let json: serde_json::Value = serde_json::from_str(&told).unwrap();
        assert_eq!(
            (code, &json["verdict"], &json["tables"][0]["faults"][0]["fault"]),
            (4, &"faulty".into(), &"corrupted".into()),
            "{told}"
        );
        // without manifest nothing is known
        let alone = folder.path().join(name);
        std::fs::write(&alone, &bytes).unwrap();
        let (code, told) = verify(&[&alone], &[]);
        assert!(code == 3, "{name}: {told}");
    }
    let other = folder.path().join("r.toml");
    assert_eq!(verify(&[&other], &[]).0, 3);
}

/// A table of an engine: as baked, with rows moved by one, and upside down.
#[test]
fn files_of_engines_are_compared_with_what_they_stand_for() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let mut command = Command::new(env!("CARGO_BIN_EXE_brdfbake"));
    assert!(command.args(["bake", "-q", "--engine", "three", "-o"]).arg(&out).status().unwrap().success());
    let own = out.join("DFGLUTData.js");
    let (code, told) = verify(&[&own], &["--engine", "three"]);
    assert!(
        code == 0 && told.contains("three-dfg of three") && told.contains("as the engine reads it"),
        "{told}"
    );
    // the same numbers, roughness upside down
    let text = std::fs::read_to_string(&own).unwrap();
    let is_row = |l: &&str| l.trim_start().starts_with("0x");
    let mut words: Vec<String> = text
        .lines()
        .filter(is_row)
        .flat_map(|l| l.split(','))
        .map(|w| w.trim().to_owned())
        .filter(|w| !w.is_empty())
        .collect();
    assert_eq!(words.len(), 16 * 16 * 2);
    for row in words.chunks_exact_mut(32) {
        let old = row.to_vec();
        for (i, w) in row.iter_mut().enumerate() {
            w.clone_from(&old[2 * (15 - i / 2) + i % 2]);
        }
    }
    let turned = folder.path().join("turned.js");
    std::fs::write(&turned, words.join(",\n")).unwrap();
    let (code, told) = verify(&[&turned], &["--engine", "three", "--json"]);
    assert_eq!(code, 4, "{told}");
    let json: serde_json::Value = serde_json::from_str(&told).unwrap();
    let convention = json["conventions"][0].as_str().unwrap();
    assert!(convention.contains("roughness") && convention.contains("the other direction"), "{convention}");
    let (code, told) = verify(&[&turned], &["--engine", "osl"]);
    assert!(code == 3 && told.contains("512 numbers"), "{told}");
}
