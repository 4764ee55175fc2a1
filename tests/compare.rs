//! Comparison of pictures, JSON and folders; files on disk; reports.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::float_cmp,
    reason = "tests: the differences are exact"
)]

use crate::sample;
use brdfbake::cancel::Cancel;
use brdfbake::encode::atomic::{TEMPORARY, WriteError, sweep, write_all};
use brdfbake::encode::diff::{self, Tolerance};
use brdfbake::encode::diff_files::{self, DiffError, FileDiff, PathDiff};
use brdfbake::encode::first_difference;
use brdfbake::encode::read::{Image, Plane, Sample, read_bytes};
use brdfbake::encode::{Storage, encoder};
use brdfbake::grid::Provenance;
use brdfbake::grid::provenance::{LawRecord, LawResult, Reconstruction, Spread, Waiver};
use brdfbake::report;
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};

static GO: Cancel = Cancel::new();

fn image(values: &[f64]) -> Image {
    let plane = |name: &str, values: Vec<f64>| Plane {
        name: name.to_owned(),
        sample: Sample::Half,
        range: [0.0, 1.0],
        values,
    };
    let width = values.len() / 2;
    Image {
        format: "exr",
        width,
        height: 2,
        channels: vec![plane("a", values.to_vec()), plane("b", vec![0.0; values.len()])],
        provenance: None,
        warnings: Vec::new(),
    }
}

fn exact(a: &Image, b: &Image) -> diff::ImageDiff {
    diff::images(a, b, Tolerance::default())
}

#[test]
fn numbers_of_a_difference() {
    let a = image(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    assert!(exact(&a, &a).equal());
    // Half steps: 2^-9 at 2 and 3, 2^-8 at 4.
    let b = image(&[1.0, 2.0, 3.0 + 1.0 / 256.0, 4.0 + 3.0 / 256.0, 5.0, 6.0]);
    let d = exact(&a, &b);
    let c = &d.channels[0];
    assert!(!d.equal());
    assert_eq!((c.largest, c.ulps, c.different, c.outside), (3.0 / 256.0, 3.0, 2, 2));
    assert_eq!(c.rmse, ((1.0 + 9.0) / 65536.0 / 6.0_f64).sqrt());
    let w = c.worst.unwrap();
    assert_eq!((w.x, w.y, w.a, w.b), (0, 1, 4.0, 4.0 + 3.0 / 256.0));
    assert_eq!(d.worst().unwrap().name, "a");
    assert!(d.channels[1].worst.is_none());

    let outside = |absolute, ulps| diff::images(&a, &b, Tolerance { absolute, ulps }).channels[0].outside;
    assert_eq!(outside(1.0 / 256.0, 0.0), 1);
    assert_eq!(outside(3.0 / 256.0, 0.0), 0);
    assert_eq!(outside(0.0, 2.0), 1);
    assert_eq!(outside(0.0, 3.0), 0);
}

#[test]
fn the_coarser_storage_counts() {
    let a = image(&[1.0, 1.0]);
    let mut b = image(&[1.0, 1.0 + 1.0 / 1024.0]);
    b.channels[0].sample = Sample::Float;
    let d = exact(&a, &b);
    assert_eq!(d.channels[0].ulps, 1.0);
    assert_eq!(d.notes, ["channel `a`: half against float"]);
    assert!(
        exact(&image(&[1.0, 1.0]), &{
            let mut c = image(&[1.0, 1.0]);
            c.channels[0].sample = Sample::Float;
            c
        })
        .equal()
    );
}

#[test]
fn nan_and_infinity() {
    let (nan, inf) = (f64::NAN, f64::INFINITY);
    let a = image(&[nan, inf, -inf, 0.0]);
    assert!(exact(&a, &a).equal());
    for (i, other) in [(0, 1.0), (1, -inf), (2, 5.0), (3, nan), (3, inf)] {
        let mut b = a.clone();
        b.channels[0].values[i] = other;
        let d = diff::images(&a, &b, Tolerance { absolute: 1e300, ulps: 1e9 });
        assert_eq!((d.channels[0].largest, d.channels[0].ulps, d.channels[0].rmse), (inf, inf, inf));
        assert!(!d.equal());
        let json = serde_json::to_value(&d).unwrap();
        assert_eq!(json["channels"][0]["largest"], "inf");
    }
    // A negative zero is equal to zero.
    assert!(exact(&image(&[0.0, 0.0]), &image(&[-0.0, 0.0])).equal());
}

#[test]
fn shapes_are_told_in_words() {
    let a = image(&[1.0, 2.0]);
    let mut b = image(&[1.0, 2.0, 3.0, 4.0]);
    b.channels[1].name = "c".to_owned();
    let d = exact(&a, &b);
    let expected = [
        "size: 1 x 2 against 2 x 2",
        "channel `b` is in the first only",
        "channel `c` is in the second only",
    ];
    assert_eq!(d.shape, expected);
    assert!(!d.equal() && d.channels.is_empty());
    // The order of channels does not count: EXR sorts them.
    let mut b = a.clone();
    b.channels.reverse();
    assert!(exact(&a, &b).equal());
}

#[test]
fn json_names_the_first_difference() {
    let at = |a: Value, b: Value| first_difference(&a, &b).map(|d| (d.path, d.a, d.b));
    let some = |s: &str| Some(s.to_owned());
    assert_eq!(at(json!({"a": 1, "b": [1, 2]}), json!({"b": [1, 2], "a": 1})), None);
    let a = json!({"t": [{"hash": "x"}, {"hash": "y"}]});
    let b = json!({"t": [{"hash": "x"}, {"hash": "z"}]});
    assert_eq!(at(a, b), Some(("t[1].hash".to_owned(), some("\"y\""), some("\"z\""))));
    assert_eq!(at(json!({"a": 1}), json!({})), Some(("a".to_owned(), some("1"), None)));
    assert_eq!(at(json!([1]), json!([1, null])), Some(("[1]".to_owned(), None, some("null"))));
    assert_eq!(at(json!(1), json!("1")), Some((String::new(), some("1"), some("\"1\""))));
}

/// Two folders with one file of each fate.
fn folders() -> (tempfile::TempDir, PathBuf, PathBuf) {
    let root = tempfile::tempdir().unwrap();
    let (a, b) = (root.path().join("a"), root.path().join("b"));
    let t = sample::table(&["v"], |_, x| x);
    let mut p = sample::provenance(&t, Storage::Half);
    let exr = |p: &Provenance| sample::file(encoder("exr").unwrap(), &t, Storage::Half, p);
    let first = exr(&p);
    p.tool = "brdfbake 0.2.0".to_owned();
    let second = exr(&p);
    let changed = sample::table(&["v"], |i, x| if i == 8 { 0.0 } else { x });
    let third = sample::file(encoder("exr").unwrap(), &changed, Storage::Half, &p);
    let files: Vec<(PathBuf, Vec<u8>)> = vec![
        (a.join("same.exr"), first.clone()),
        (b.join("same.exr"), first.clone()),
        (a.join("metadata.exr"), first.clone()),
        (b.join("metadata.exr"), second),
        (a.join("sub/value.EXR"), first),
        (b.join("sub/value.EXR"), third),
        (a.join("manifest.json"), b"{\"a\": 1, \"b\": 2}".to_vec()),
        (b.join("manifest.json"), b"{\"b\":2,\"a\":1}".to_vec()),
        (a.join("note.txt"), b"hello".to_vec()),
        (b.join("note.txt"), b"help".to_vec()),
        (a.join("old.png"), b"?".to_vec()),
        (b.join("new.png"), b"?".to_vec()),
    ];
    write_all(&files, &GO).unwrap();
    fs::write(a.join(format!("{TEMPORARY}1-1")), b"rubbish").unwrap();
    (root, a, b)
}

#[test]
fn folders_are_compared_file_by_file() {
    let (_root, a, b) = folders();
    let PathDiff::Folder(d) = diff_files::paths(&a, &b, Tolerance::default()).unwrap() else { panic!() };
    let fate = |name: &str| &d.files.iter().find(|(n, _)| n == name).unwrap().1;
    assert_eq!(d.files.len(), 7);
    assert_eq!(*fate("same.exr"), FileDiff::Identical);
    assert_eq!(*fate("manifest.json"), FileDiff::Json { difference: None });
    assert_eq!(*fate("note.txt"), FileDiff::Bytes { offset: 3, sizes: [5, 4] });
    assert_eq!(*fate("old.png"), FileDiff::OnlyFirst);
    assert_eq!(*fate("new.png"), FileDiff::OnlySecond);
    let FileDiff::Image(m) = fate("metadata.exr") else { panic!() };
    assert!(m.equal() && m.metadata.as_ref().unwrap().path == "tool");
    let FileDiff::Image(v) = fate("sub/value.EXR") else { panic!() };
    let w = v.channels[0].worst.unwrap();
    assert!(!v.equal() && (w.x, w.y, w.b) == (1, 1, 0.0));
    assert!(!d.equal());

    let text = report::diff("a", "b", &PathDiff::Folder(d));
    for part in [
        "a and b: different\n",
        "sub/value.EXR: different\n",
        "worst at x = 1, y = 1: ",
        "first difference at tool",
        "5 against 4 bytes, different from offset 3 on",
        "7 files, 4 different\n",
    ] {
        assert!(text.contains(part), "`{part}` is not in\n{text}");
    }
    let same = diff_files::paths(&a, &a, Tolerance::default()).unwrap();
    assert!(same.equal() && report::diff("a", "a", &same).starts_with("a and a: equal\n"));
}

#[test]
fn what_cannot_be_compared_is_an_error() {
    let (_root, a, b) = folders();
    let paths = |x: &Path, y: &Path| diff_files::paths(x, y, Tolerance::default()).unwrap_err();
    assert!(matches!(paths(&a, &b.join("note.txt")), DiffError::Kinds { .. }));
    assert!(matches!(paths(&a.join("none"), &b.join("note.txt")), DiffError::Io { .. }));
    assert!(matches!(paths(&a.join("old.png"), &a.join("same.exr")), DiffError::Read { .. }));
    fs::write(a.join("manifest.json"), b"{").unwrap();
    assert!(matches!(paths(&a, &b), DiffError::Json { .. }));
}

#[test]
fn files_are_written_whole_and_only_when_they_change() {
    let root = tempfile::tempdir().unwrap();
    let path = |name: &str| root.path().join(name);
    let files = |x: &str| vec![(path("x/one"), x.as_bytes().to_vec()), (path("x/y/two"), b"2".to_vec())];
    let written = |files: &[_]| write_all(files, &GO).map(|w| (w.written, w.unchanged)).unwrap();
    assert_eq!(written(&files("1")), (2, 0));
    assert_eq!(written(&files("1")), (0, 2));
    assert_eq!(written(&files("3")), (1, 1));
    assert_eq!(fs::read(path("x/one")).unwrap(), b"3");

    let stop = Cancel::new();
    stop.set();
    assert!(matches!(write_all(&files("4"), &stop), Err(WriteError::Cancelled)));
    let twice = [files("4"), files("5")].concat();
    assert!(matches!(write_all(&twice, &GO), Err(WriteError::Twice(p)) if p == path("x/one")));
    let folder = [files("4"), vec![(path("x/y"), vec![])]].concat();
    assert!(
        matches!(write_all(&folder, &GO), Err(WriteError::InTheWay { path: p, what: "a folder" }) if p == path("x/y"))
    );
    // A file stands where a folder is needed.
    let below = [files("4"), vec![(path("x/one/three"), vec![])]].concat();
    assert!(matches!(write_all(&below, &GO), Err(WriteError::Folder { .. })));

    assert_eq!(fs::read(path("x/one")).unwrap(), b"3", "nothing was replaced");
    let names = |d: PathBuf| fs::read_dir(d).unwrap().count();
    assert_eq!((names(path("x")), names(path("x/y"))), (2, 1), "no temporary file is left");
}

#[test]
fn temporary_files_of_killed_processes_are_swept() {
    let root = tempfile::tempdir().unwrap();
    let path = |name: &str| root.path().join(name);
    let (dead, alive, kept) =
        (path(&format!("{TEMPORARY}1-1")), path(&format!("{TEMPORARY}1-2")), path("brdfbake-tmp-"));
    for path in [&dead, &alive, &kept] {
        fs::write(path, b"half").unwrap();
    }
    let writing = fs::File::open(&alive).unwrap();
    writing.lock().unwrap();
    assert_eq!(sweep(root.path()).unwrap(), 1);
    assert!(!dead.exists() && alive.exists() && kept.exists());
    drop(writing);
    assert_eq!(sweep(root.path()).unwrap(), 1);
    assert!(!alive.exists());
}

#[cfg(unix)]
#[test]
fn who_has_a_file_open_keeps_what_it_opened() {
    use std::io::Read;
    let root = tempfile::tempdir().unwrap();
    let path = root.path().join("file");
    write_all(&[(path.clone(), b"old".to_vec())], &GO).unwrap();
    let mut reader = fs::File::open(&path).unwrap();
    write_all(&[(path.clone(), b"new".to_vec())], &GO).unwrap();
    let mut text = String::new();
    reader.read_to_string(&mut text).unwrap();
    assert_eq!(
        (text.as_str(), fs::read(&path).unwrap()),
        ("old", b"new".to_vec()),
        "replaced, not overwritten"
    );
}

#[cfg(unix)]
#[test]
fn files_have_the_usual_permissions() {
    use std::os::unix::fs::PermissionsExt;
    let root = tempfile::tempdir().unwrap();
    let mode = |name: &str| fs::metadata(root.path().join(name)).unwrap().permissions().mode();
    fs::write(root.path().join("usual"), b"").unwrap();
    write_all(&[(root.path().join("ours"), vec![1])], &GO).unwrap();
    assert_eq!(mode("ours"), mode("usual"));
}

#[test]
fn inspect_tells_everything() {
    let t = sample::table(&["dfg.scale", "dfg.bias"], |_, x| x);
    let mut p = sample::provenance(&t, Storage::Unorm16);
    p.laws[0].result = LawResult::Broken;
    p.laws[0].margin = Some(-1e-3);
    p.laws.push(LawRecord {
        law: "honest".to_owned(),
        why: Some("the rule has no value".to_owned()),
        ..LawRecord::default()
    });
    p.tolerance_met = Some(false);
    p.waived = vec![Waiver { law: "energy".to_owned(), reason: "single scattering \u{1b}[31m".to_owned() }];
    p.verified = false;
    let largest = p.integration.largest_error.clone();
    let whole = Spread { largest, mean: 1.25e-4 };
    p.reconstruction = Some(Reconstruction {
        filter: "bilinear".to_owned(),
        points: 48,
        practical: Some(whole.clone()),
        whole,
    });
    let image = read_bytes(&sample::file(encoder("png").unwrap(), &t, Storage::Unorm16, &p)).unwrap();
    let text = report::inspect("dfg.png", &image);
    let expected = fs::read_to_string("tests/sample/inspect.txt").unwrap_or_default();
    if std::env::var_os("BLESS").is_some() {
        fs::write("tests/sample/inspect.txt", &text).unwrap();
    } else {
        assert_eq!(text, expected.replace("\r\n", "\n"), "BLESS=1 writes tests/sample/inspect.txt anew");
    }
    assert!(!text.contains('\u{1b}'));
}

#[test]
fn a_file_without_metadata_is_called_so() {
    let mut a = image(&[0.25, f64::NAN, f64::INFINITY, 0.75]);
    let text = report::inspect("x.exr", &a);
    let expected = "x.exr: exr, 2 x 2 pixels, 2 channels\n\
                    Channels\n  \
                    a               half, min 0.25, max 0.75, mean 0.5, 1 NaN, 1 infinite\n  \
                    b               half, min 0, max 0, mean 0\n\
                    Nothing in the file says what it holds: no axes, no channels' meaning, no error.\n";
    assert_eq!(text, expected);
    a.channels[0].values = vec![f64::NAN; 4];
    assert!(report::inspect("x.exr", &a).contains("half, 4 NaNs\n"));
}

#[test]
fn a_file_that_contradicts_its_metadata_is_caught() {
    let t = sample::table(&["v"], |_, x| x);
    let mut p = sample::provenance(&t, Storage::Float);
    p.axes[0].axis.len = 8;
    p.channels[0].id = "w".to_owned();
    let image = read_bytes(&sample::file(encoder("exr").unwrap(), &t, Storage::Half, &p)).unwrap();
    let expected = [
        "the metadata tells of 8 x 5 texels, the picture has 7 x 5",
        "the metadata tells of channel `w`, the picture has none",
        "the picture has channel `v`, the metadata does not name it",
        "the metadata says float, channel `v` is stored as half",
    ];
    assert_eq!(image.contradictions(), expected);
    assert!(report::inspect("x", &image).contains("  warning         the metadata tells of 8 x 5"));
}
