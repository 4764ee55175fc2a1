//! The outputs of a bake as one transaction, through the command: two at once, killed, locked, in the way; and `verify`.
#![allow(clippy::unwrap_used, reason = "test")]

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::OnceLock;

const A: &str = "tests/writes/two-a.toml";
const B: &str = "tests/writes/two-b.toml";
const MANIFEST: &str = "manifest.json";
const LOCK: &str = ".brdfbake-lock";
const STAGING: &str = ".brdfbake-tmp-bake";

fn command(args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_brdfbake"));
    command.args(args).current_dir(env!("CARGO_MANIFEST_DIR")).env("NO_COLOR", "1");
    command
}

fn brdfbake(args: &[&str]) -> Output {
    command(args).output().unwrap()
}

fn err(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

fn out(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn bake(recipe: &str, folder: &Path) -> Output {
    brdfbake(&["bake", recipe, "-q", "-o", text(folder)])
}

/// Every file of a folder, hidden ones too.
fn held(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|e| e.unwrap());
    entries.map(|e| (e.file_name().into_string().unwrap(), fs::read(e.path()).unwrap_or_default())).collect()
}

/// What the two recipes write.
fn expected() -> &'static [BTreeMap<String, Vec<u8>>; 2] {
    static EXPECTED: OnceLock<[BTreeMap<String, Vec<u8>>; 2]> = OnceLock::new();
    EXPECTED.get_or_init(|| {
        [A, B].map(|recipe| {
            let folder = tempfile::tempdir().unwrap();
            let o = bake(recipe, folder.path());
            assert_eq!(o.status.code(), Some(0), "{}", err(&o));
            let files = held(folder.path());
            assert_eq!(files.len(), 37);
            files
        })
    })
}

fn verify(folder: &Path, more: &[&str]) -> (i32, String) {
    // the bytes alone: what the numbers are is looked at in `rechecked.rs`
    let o = brdfbake(&[&["verify", "--hashes", text(folder)], more].concat());
    (o.status.code().unwrap(), out(&o) + &err(&o))
}

/// A folder with the files of the first recipe.
fn folder_of_a() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    expected()[0].iter().for_each(|(name, bytes)| fs::write(folder.path().join(name), bytes).unwrap());
    folder
}

#[test]
fn two_bakes_into_one_folder_do_not_mix() {
    for round in 0..20 {
        let root = tempfile::tempdir().unwrap();
        // every other time the folder must be made, too
        let folder = if round % 2 == 0 { root.path().to_owned() } else { root.path().join("out") };
        let start = |recipe| command(&["bake", recipe, "-q", "-o", text(&folder)]).spawn().unwrap();
        for mut child in [start(A), start(B)] {
            assert_eq!(child.wait().unwrap().code(), Some(0));
        }
        let files = held(&folder);
        assert!(expected().contains(&files), "round {round}: {:?}", files.keys());
        assert_eq!(verify(&folder, &["--strict", "-q"]).0, 0);
    }
}

/// Starts a bake of the second recipe into a folder and kills it as soon as something is so.
fn kill_when(folder: &Path, so: impl Fn() -> bool) {
    let mut child = command(&["bake", B, "-q", "-o", text(folder)]).spawn().unwrap();
    while !so() && child.try_wait().unwrap().is_none() {
        std::hint::spin_loop();
    }
    child.kill().unwrap();
    child.wait().unwrap();
}

#[test]
fn a_bake_that_is_killed_between_renames_is_finished_by_the_next() {
    let mut hits = 0;
    for _ in 0..100 {
        let folder = folder_of_a();
        let manifest = folder.path().join(MANIFEST);
        kill_when(folder.path(), || !manifest.exists());
        if manifest.exists() {
            // too late: it had ended
            assert_eq!(verify(folder.path(), &["-q"]).0, 0);
            continue;
        }
        hits += 1;
        let (code, told) = verify(folder.path(), &[]);
        assert_eq!(code, 4, "{told}");
        assert!(told.contains("killed while it replaced files"), "{told}");
        // a recipe that fails finishes the work all the same, before it bakes
        let recipe = folder.path().join("recipe.toml");
        fs::write(&recipe, "name = 'x'\n[[table]]\nkind = 'albedo'\nname = 'x'\nmodel = 'cook-torrance-1982'\ntolerance = 1e-2\naxis = [{ id = 'mu', length = 8 }, { id = 'roughness', length = 8 }]\n").unwrap();
        let o = brdfbake(&["bake", text(&recipe), "-o", text(folder.path())]);
        assert_eq!(o.status.code(), Some(4), "{}", err(&o));
        assert!(err(&o).contains("a run that was killed had left files"), "{}", err(&o));
        assert_eq!(verify(folder.path(), &["--strict"]).0, 0);
        fs::remove_file(recipe).unwrap();
        assert_eq!(held(folder.path()), expected()[1]);
        // and so does another bake
        if hits == 3 {
            return;
        }
    }
    panic!("{hits} of 100 bakes were killed in time");
}

#[test]
fn a_bake_that_is_killed_before_it_replaces_files_is_cleaned_up() {
    let folder = folder_of_a();
    fs::write(folder.path().join("recipe.toml"), fs::read(A).unwrap()).unwrap();
    let staging = folder.path().join(STAGING);
    kill_when(folder.path(), || staging.join("new/t0.csv").exists());
    if held(folder.path()).contains_key(STAGING) {
        let (code, told) = verify(folder.path(), &["--strict"]);
        assert_eq!(code, 0, "{told}");
        assert!(told.contains("a bake was killed in the folder"), "{told}");
    }
    // what earlier versions left
    fs::write(folder.path().join(".brdfbake-tmp-123-4"), b"half").unwrap();
    let o = brdfbake(&["golden", "check", text(folder.path())]);
    assert_eq!(o.status.code(), Some(0), "{}{}", out(&o), err(&o));
    let o = brdfbake(&["diff", "-q", text(folder.path()), text(folder.path())]);
    assert_eq!(o.status.code(), Some(0), "{}", err(&o));
    assert_eq!(bake(A, folder.path()).status.code(), Some(0));
    fs::remove_file(folder.path().join("recipe.toml")).unwrap();
    assert_eq!(held(folder.path()), expected()[0]);
}

#[test]
fn a_bake_waits_for_another_one() {
    let folder = folder_of_a();
    let lock = File::create(folder.path().join(LOCK)).unwrap();
    lock.lock().unwrap();
    let o = brdfbake(&["bake", B, "--lock-timeout", "0.2", "-o", text(folder.path())]);
    assert_eq!(o.status.code(), Some(5), "{}", err(&o));
    for part in ["waiting for another run", "did not end within 0.2 s", "--lock-timeout"] {
        assert!(err(&o).contains(part), "{part}: {}", err(&o));
    }
    assert_eq!(brdfbake(&["bake", B, "--lock-timeout", "-1"]).status.code(), Some(2));
    // it bakes when the other one is done
    let mut child = command(&["bake", B, "-o", text(folder.path())]).stderr(Stdio::piped()).spawn().unwrap();
    let mut lines = BufReader::new(child.stderr.take().unwrap()).lines();
    assert!(lines.any(|line| line.unwrap().contains("waiting for another run")));
    drop(lock);
    lines.for_each(drop);
    assert_eq!(child.wait().unwrap().code(), Some(0));
    assert_eq!(held(folder.path()), expected()[1]);
}

#[test]
fn what_is_in_the_way_is_found_before_anything_is_baked() {
    let folder = folder_of_a();
    let path = |name: &str| -> PathBuf { folder.path().join(name) };
    fs::remove_file(path("t7.npy")).unwrap();
    fs::create_dir(path("t7.npy")).unwrap();
    let before = held(folder.path());
    for more in [&["--dry-run"][..], &["--message-format", "json"]] {
        let o = brdfbake(&[&["bake", B, "-o", text(folder.path())], more].concat());
        assert_eq!(o.status.code(), Some(5), "{}", err(&o));
        assert!(err(&o).contains("t7.npy") && err(&o).contains("a folder of this name"), "{}", err(&o));
        // one object of the fault, where objects are asked for
        let told: Vec<_> = out(&o).lines().map(str::to_owned).collect();
        let is_json = more.contains(&"json");
        assert!(told.len() == usize::from(is_json), "{told:?}");
        assert!(told.iter().all(|line| line.contains("\"exit\":5") && line.contains("t7.npy")), "{told:?}");
    }
    assert_eq!(held(folder.path()), before);
    let o = bake(B, &path("t1.csv").join("out"));
    assert_eq!(o.status.code(), Some(5), "{}", err(&o));
    #[cfg(unix)]
    for name in ["t7.npy", MANIFEST] {
        let _ = fs::remove_dir(path("t7.npy"));
        let _ = fs::remove_file(path(name));
        std::os::unix::fs::symlink(path("nowhere"), path(name)).unwrap();
        let o = bake(B, folder.path());
        assert_eq!(o.status.code(), Some(5), "{}", err(&o));
        assert!(err(&o).contains("leads nowhere"), "{}", err(&o));
        fs::remove_file(path(name)).unwrap();
    }
}

#[test]
fn verify_names_what_is_wrong() {
    let folder = folder_of_a();
    let path = |name: &str| -> PathBuf { folder.path().join(name) };
    let (code, told) = verify(folder.path(), &[]);
    assert_eq!(code, 0, "{told}");
    assert!(told.contains("all 36 files are those of its manifest (recipe two-a"), "{told}");
    // files of its own are no outputs; others are told, and fail only if that is asked for
    fs::write(path("recipe.toml"), b"x").unwrap();
    assert_eq!(verify(folder.path(), &["--strict"]).0, 0);
    fs::write(path("stray.exr"), &expected()[1]["t3.exr"]).unwrap();
    let (code, told) = verify(folder.path(), &[]);
    assert!(code == 0 && told.contains("stray.exr: not in the manifest: table t3 of recipe two-b"), "{told}");
    assert_eq!(verify(folder.path(), &["--strict"]).0, 4);
    // bytes that changed
    let mut bytes = expected()[0]["t1.csv"].clone();
    bytes[40] ^= 1;
    fs::write(path("t1.csv"), &bytes).unwrap();
    fs::remove_file(path("t2.npy")).unwrap();
    let (code, told) = verify(folder.path(), &[]);
    assert_eq!(code, 4, "{told}");
    for part in ["t1.csv: ", "the manifest lists", "t2.npy: missing", "34 of 36 files"] {
        assert!(told.contains(part), "{part}: {told}");
    }
    assert!(!told.contains("mixture"), "{told}");
    // a file of another bake
    fs::write(path("t0.exr"), &expected()[1]["t0.exr"]).unwrap();
    let (code, told) = verify(folder.path(), &[]);
    assert_eq!(code, 4, "{told}");
    for part in ["t0.exr: of another bake, table t0 of recipe two-b", "a mixture of bakes: 33 of 36"] {
        assert!(told.contains(part), "{part}: {told}");
    }
    let (code, told) = verify(folder.path(), &["--json"]);
    let json: serde_json::Value = serde_json::from_str(&told).unwrap();
    assert_eq!(code, 4);
    assert_eq!(json["verdict"], "mixture");
    let state = |name: &str| {
        let files = json["files"].as_array().unwrap();
        files.iter().find(|f| f["file"] == name).unwrap()["state"].clone()
    };
    assert_eq!(
        (state("t0.exr"), state("t2.npy"), state("t4.exr")),
        ("changed".into(), "missing".into(), "whole".into())
    );
}

#[test]
fn verify_needs_a_manifest_of_its_folder() {
    let folder = folder_of_a();
    let manifest = folder.path().join(MANIFEST);
    let good = fs::read_to_string(&manifest).unwrap();
    fs::remove_file(&manifest).unwrap();
    let (code, told) = verify(folder.path(), &[]);
    assert!(code == 4 && told.contains("has no manifest.json"), "{told}");
    for (text, fault) in [
        ("{".to_owned(), "EOF"),
        (good.replace("t3.npy", "../t3.npy"), "is not the name of a file in its folder"),
        (good.replace("t3.npy", "t4.npy"), "lists t4.npy twice"),
    ] {
        fs::write(&manifest, text).unwrap();
        let (code, told) = verify(folder.path(), &[]);
        assert!(code == 3 && told.contains(fault), "{told}");
    }
    let (code, told) = verify(&folder.path().join("nowhere"), &[]);
    assert!(code == 5 && told.contains("nowhere"), "{told}");
}

#[test]
fn threads_are_bounded_however_they_are_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    for verb in [&["bake", A, "-o", text(folder.path())][..], &["laws", "ggx"], &["fit", "ggx"]] {
        for number in ["100000000", "1025", "99999999999999999999999999"] {
            let o = command(verb).env("RAYON_NUM_THREADS", number).output().unwrap();
            assert_eq!(o.status.code(), Some(2), "{verb:?}: {}", err(&o));
            assert!(err(&o).contains("at most 1024 threads"), "{verb:?}: {}", err(&o));
        }
    }
    // the option is stronger, and what is no number is none
    for (variable, jobs) in [("100000000", "2"), ("many", "1")] {
        let o = command(&["bake", A, "-q", "-j", jobs, "-o", text(folder.path())])
            .env("RAYON_NUM_THREADS", variable)
            .output()
            .unwrap();
        assert_eq!(o.status.code(), Some(0), "{}", err(&o));
    }
}

#[test]
fn a_plan_that_does_not_fit_in_memory_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let recipe = folder.path().join("large.toml");
    let table = |i: usize| {
        format!(
            "[[table]]\nkind = 'fresnel-schlick'\nname = 't{i}'\nreconstruction = 'off'\noutputs = ['csv:double']\n\
             [[table.axis]]\nid = 'mu'\nlength = 8192\n[[table.axis]]\nid = 'f0'\nlength = 8192\n"
        )
    };
    fs::write(&recipe, format!("name = 'x'\n{}", (0..4).map(table).collect::<String>())).unwrap();
    let target = folder.path().join("out");
    // large first: what it costs
    let o = brdfbake(&["bake", text(&recipe), "-o", text(&target), "--dry-run"]);
    assert_eq!(o.status.code(), Some(3), "{}", err(&o));
    assert!(err(&o).contains("268435456 texels") && err(&o).contains("--yes-large"), "{}", err(&o));
    for more in [&["--dry-run"][..], &[], &["--memory", "2GiB"]] {
        let o = brdfbake(&[&["bake", text(&recipe), "--yes-large", "-o", text(&target)], more].concat());
        assert_eq!(o.status.code(), Some(5), "{}", err(&o));
        for part in ["table t0 takes up to", "of memory", "shorter axes", "--memory"] {
            assert!(err(&o).contains(part), "{part}: {}", err(&o));
        }
        assert!(!target.exists() && out(&o).is_empty());
    }
    // allowed, it is planned
    let o = brdfbake(&[
        "bake",
        text(&recipe),
        "--yes-large",
        "--dry-run",
        "--memory",
        "1TB",
        "-o",
        text(&target),
    ]);
    assert_eq!(o.status.code(), Some(0), "{}", err(&o));
    assert_eq!(brdfbake(&["bake", A, "--memory", "lots"]).status.code(), Some(2));
    assert_eq!(brdfbake(&["bake", A, "-q", "--memory", "100kB", "-o", text(&target)]).status.code(), Some(5));
}

#[test]
fn two_outputs_of_one_name_are_refused_before_anything_is_baked() {
    let folder = tempfile::tempdir().unwrap();
    let recipe = folder.path().join("x.toml");
    let one = "[[table]]\nkind = 'fresnel-schlick'\nname = 'x'\noutputs = ['exr:half', 'exr:float']\n";
    let two = "[[table]]\nkind = 'fresnel-schlick'\nname = 'y'\nfile = 'X.Half.exr'\n";
    fs::write(&recipe, format!("name = 'x'\n{one}{two}")).unwrap();
    for more in [&["--dry-run"][..], &[]] {
        let o = brdfbake(&[&["bake", text(&recipe), "-o", text(&folder.path().join("out"))], more].concat());
        assert_eq!(o.status.code(), Some(3), "{}", err(&o));
        assert!(err(&o).contains("x.half.exr and X.Half.exr"), "{}", err(&o));
    }
}
