//! A signal stops any verb, wherever it is: with 130, a line, and nothing half done.

use super::support::{SMALL, brdfbake, code, command, err, folder, names, text, write};
use std::io::{Read, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Only so that a test that fails ends at all.
const PATIENCE: Duration = Duration::from_secs(120);

/// Work that takes minutes and more, in each verb that works; `DIR` is a folder.
const LONG: &[&[&str]] = &[
    &["bake", "DIR/long.toml", "-q", "-o", "DIR/out"],
    // no integral: the time goes into blocks of BC6H
    &["bake", "DIR/blocks.toml", "-q", "-o", "DIR/out"],
    &["bake", "DIR/fitted.toml", "-q", "-o", "DIR/out"],
    &["bake", "DIR/sized.toml", "-q", "-o", "DIR/out"],
    &["bake", "--engine", "godot", "--suggest", "1e-6"],
    &["golden", "check", "DIR/golden"],
    &["golden", "bless", "DIR/golden"],
    &["fit", "-t", "preintegrated-skin", "--form", "rational", "-e", "1e-15"],
    &["laws"],
];

/// Verbs that wait for a file that somebody else is to write: `DIR/pipe` is a pipe.
const READING: &[&[&str]] = &[
    &["inspect", "DIR/pipe"],
    &["diff", "DIR/pipe", "DIR/pipe"],
    &["eval", "DIR/pipe"],
    &["eval", "DIR/pipe", "-o", "DIR/out/rows.csv"],
];

/// Verbs that wait for somebody to read what they print.
const PRINTING: &[&[&str]] = &[
    &["--help"],
    &["list", "functions"],
    &["describe", "ggx"],
    &["albedo", "lambert"],
    &["fit", "-t", "fresnel-dielectric", "-d", "1", "--form", "polynomial"],
    &["laws", "lambert"],
    &["bake", "DIR/small.toml", "--message-format", "json", "-o", "DIR/out"],
    &["bake", "DIR/many.toml", "--message-format", "json", "-o", "DIR/out/of/many"],
];

fn prepared() -> tempfile::TempDir {
    let dir = folder();
    let table = |kind: &str, keys: &str, axes: [(&str, u32); 2]| {
        let axis = |(id, n)| format!("[[table.axis]]\nid = \"{id}\"\nlength = {n}\n");
        format!(
            "name = \"long\"\n[[table]]\nkind = \"{kind}\"\nname = \"long\"\n{keys}\n{}{}",
            axis(axes[0]),
            axis(axes[1])
        )
    };
    let split = [("mu", 4000), ("roughness", 4000)];
    let long = table("dfg", "tolerance = 1e-11", split);
    let blocks = "outputs = [\"dds:bc6h\"]\nreconstruction = \"off\"";
    write(dir.path(), "blocks.toml", &table("fresnel-conductor", blocks, [("mu", 4096), ("k", 4096)]));
    let fitted = "texels = \"minimax\"\nreconstruction = \"off\"\ntolerance = 1e-2";
    write(dir.path(), "fitted.toml", &table("dfg", fitted, [("mu", 1000), ("roughness", 1000)]));
    let sized =
        "name = \"s\"\n[[table]]\nkind = \"dfg\"\nname = \"s\"\nsize = { error = 1e-7, longest = 2048 }\n";
    write(dir.path(), "sized.toml", sized);
    write(dir.path(), "long.toml", &long);
    write(dir.path(), "small.toml", SMALL);
    let many: String =
        (0..100).map(|i| SMALL.replace("name = \"test\"", "").replace("small", &format!("t{i}"))).collect();
    write(dir.path(), "many.toml", &format!("name = \"many\"\n{many}"));
    std::fs::create_dir(dir.path().join("golden")).unwrap();
    write(&dir.path().join("golden"), "recipe.toml", &long);
    dir
}

fn start(args: &[&str], dir: &Path, stdout: Stdio) -> Child {
    let args: Vec<String> = args.iter().map(|a| a.replace("DIR", text(dir))).collect();
    let args: Vec<&str> = args.iter().map(String::as_str).collect();
    // temporary folders are told by it
    let scratch = dir.join("scratch");
    std::fs::create_dir_all(&scratch).unwrap();
    let mut command = command(&args);
    command.env("TMPDIR", scratch).stdin(Stdio::piped()).stdout(stdout).stderr(Stdio::piped());
    command.spawn().unwrap()
}

fn kill(child: &Child, signal: &str) {
    let sent = Command::new("kill").args([&format!("-{signal}"), &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
}

/// Waits until the process has set its handler: before, a signal ends it as it ends any program.
fn settle(child: &Child) {
    let caught = || {
        let status = std::fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap_or_default();
        let line =
            status.lines().find_map(|l| l.strip_prefix("SigCgt:")).map(str::trim).unwrap_or("0").to_owned();
        // bit 1 is SIGINT
        u64::from_str_radix(&line, 16).is_ok_and(|set| set & 2 != 0)
    };
    let begun = Instant::now();
    while cfg!(target_os = "linux") && !caught() && begun.elapsed() < PATIENCE {
        std::thread::sleep(Duration::from_millis(5));
    }
    std::thread::sleep(Duration::from_millis(400));
}

/// Sends the signal, and sees that the process ends as it should.
fn interrupted(mut child: Child, signal: &str, args: &[&str], dir: &Path) {
    settle(&child);
    assert!(child.try_wait().unwrap().is_none(), "{args:?} ended before the signal");
    kill(&child, signal);
    let begun = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if begun.elapsed() > PATIENCE {
            child.kill().unwrap();
            panic!("{args:?} does not stop on {signal}");
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    let mut told = String::new();
    child.stderr.take().unwrap().read_to_string(&mut told).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(130), "{args:?} {signal}: {told}");
    let lines = told.lines().filter(|l| l.contains("interrupted")).count();
    assert_eq!(lines, 1, "{args:?} {signal}: {told}");
    assert!(names(&dir.join("out")).is_empty(), "{args:?}: {:?}", names(&dir.join("out")));
    assert!(names(&dir.join("scratch")).is_empty(), "{args:?}: {:?}", names(&dir.join("scratch")));
    assert_eq!(names(&dir.join("golden")), ["recipe.toml"], "{args:?}");
}

#[test]
fn work_stops() {
    let dir = prepared();
    for (i, args) in LONG.iter().enumerate() {
        let signal = ["INT", "TERM"][i % 2];
        interrupted(start(args, dir.path(), Stdio::null()), signal, args, dir.path());
    }
}

#[test]
fn reading_stops() {
    let dir = prepared();
    let made = Command::new("mkfifo").arg(dir.path().join("pipe")).status().unwrap();
    assert!(made.success());
    for (i, args) in READING.iter().enumerate() {
        let signal = ["TERM", "INT"][i % 2];
        interrupted(start(args, dir.path(), Stdio::null()), signal, args, dir.path());
    }
    // rows that never come
    interrupted(start(&["eval"], dir.path(), Stdio::null()), "INT", &["eval"], dir.path());
}

#[test]
fn printing_stops() {
    let dir = prepared();
    for (i, args) in PRINTING.iter().enumerate() {
        // a pipe that is full, and that nobody reads
        let mut idle = Command::new("sleep").arg("1000").stdin(Stdio::piped()).spawn().unwrap();
        let mut pipe = idle.stdin.take().unwrap();
        // but for a page where a bake is to be in the midst of its work: its folder is locked then
        let room = if args.iter().any(|a| a.contains("many")) { 1 << 12 } else { 0 };
        pipe.write_all(&vec![b'x'; (1 << 16) - room]).unwrap();
        let child = start(args, dir.path(), pipe.into());
        interrupted(child, ["INT", "TERM"][i % 2], args, dir.path());
        idle.kill().unwrap();
        idle.wait().unwrap();
    }
}

#[test]
fn a_second_signal_ends_it_too() {
    let dir = prepared();
    let mut child = start(&["eval"], dir.path(), Stdio::null());
    let rows = child.stdin.take();
    settle(&child);
    kill(&child, "INT");
    kill(&child, "TERM");
    let o = child.wait_with_output().unwrap();
    drop(rows);
    assert_eq!(code(&o), 130, "{}", err(&o));
    assert!(err(&o).contains("interrupted"), "{}", err(&o));
}

#[test]
fn earlier_outputs_stay() {
    let dir = prepared();
    let target = dir.path().join("kept");
    let o = brdfbake(&["bake", text(&dir.path().join("small.toml")), "-q", "-o", text(&target)]);
    assert_eq!(code(&o), 0, "{}", err(&o));
    let before = names(&target);
    let args = ["bake", "DIR/long.toml", "-q", "-o", "DIR/kept"];
    interrupted(start(&args, dir.path(), Stdio::null()), "INT", &args, dir.path());
    assert_eq!(names(&target), before);
}
