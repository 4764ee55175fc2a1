//! Every reader under inputs that are damaged: an error, never a panic.
//!
//! The corpus is what the tests and the repository hold: a file of every container and storage, presets, scenes, pictures. An input is one
//! of it under a few seeded changes. The short form, some hundred inputs a reader, runs with the others; the long one runs as many
//! as fit into so many seconds a reader:
//!
//! ```sh
//! BRDFBAKE_FUZZ_SECONDS=600 cargo test --release --test files -- --ignored --nocapture fuzz
//! ```
//! (`BRDFBAKE_FUZZ_READER` names one of them). What makes a reader panic is written into `target/fuzz/READER`; when it is mended it is kept in `tests/fuzz/found/READER`, which
//! every run reads first.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "test")]

mod change;
mod readers;

use change::Random;
use readers::{READERS, Reader};
use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Inputs of a reader in the short form.
const SHORT: usize = 300;

/// Most inputs that are kept of a reader which fails again and again.
const SHOWN: usize = 5;

fn repository() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn found(reader: &Reader) -> Vec<PathBuf> {
    let folder = repository().join("tests/fuzz/found").join(reader.id);
    let entries = std::fs::read_dir(folder).into_iter().flatten();
    let mut paths: Vec<PathBuf> = entries.map(|e| e.unwrap().path()).collect();
    paths.sort();
    paths
}

/// Is it taken? None for a panic.
fn read(reader: &Reader, bytes: &[u8]) -> Option<bool> {
    catch_unwind(AssertUnwindSafe(|| (reader.read)(bytes))).ok()
}

/// Inputs of a reader, and those of them that it took.
#[derive(Default)]
struct Counts {
    all: usize,
    taken: usize,
}

/// Reads changed seeds while `more` says so; the inputs that made it panic, as files.
fn fuzz(reader: &Reader, seed: u64, mut more: impl FnMut(usize) -> bool) -> (Counts, Vec<PathBuf>) {
    let seeds = (reader.seeds)();
    assert!(!seeds.is_empty(), "{} has no seeds", reader.id);
    let mut random = Random::new(seed);
    let mut failed = Vec::new();
    let mut count = Counts::default();
    while more(count.all) && failed.len() < SHOWN {
        let bytes = change::change(&mut random, &seeds, reader.words);
        let read = read(reader, &bytes);
        if read.is_none() {
            let folder = repository().join("target/fuzz").join(reader.id);
            std::fs::create_dir_all(&folder).unwrap();
            let path = folder.join(format!("{seed}-{}", count.all));
            std::fs::write(&path, &bytes).unwrap();
            failed.push(path);
        }
        count.all += 1;
        count.taken += usize::from(read == Some(true));
    }
    (count, failed)
}

#[test]
fn changed_files_are_errors() {
    for reader in READERS {
        for path in found(reader) {
            assert!(read(reader, &std::fs::read(&path).unwrap()).is_some(), "{}", path.display());
        }
        let unchanged = (reader.seeds)();
        assert!(
            unchanged.iter().any(|bytes| read(reader, bytes) == Some(true)),
            "{}: no seed is taken",
            reader.id
        );
        let (count, failed) = fuzz(reader, 1, |n| n < SHORT);
        assert!(failed.is_empty(), "{} panics on {failed:?}", reader.id);
        // changes that are all refused, or all taken, reach nothing
        let Counts { all, taken } = count;
        assert!(taken > 0 && taken < all, "{}: {taken} of {all} are taken", reader.id);
    }
}

#[test]
#[ignore = "long: so many seconds a reader as BRDFBAKE_FUZZ_SECONDS says"]
fn changed_files_are_errors_for_long() {
    let variable = std::env::var("BRDFBAKE_FUZZ_SECONDS").ok().and_then(|s| s.parse().ok());
    let (seconds, start) = (Duration::from_secs(variable.unwrap_or(10)), Instant::now());
    // other inputs in every run; the seed is in the names of what is found
    let seed = u64::from(std::process::id());
    let mut all = Vec::new();
    let only = std::env::var("BRDFBAKE_FUZZ_READER").ok();
    for reader in READERS.iter().filter(|r| only.as_ref().is_none_or(|o| o == r.id)) {
        let begun = Instant::now();
        let (count, failed) = fuzz(reader, seed, |_| begun.elapsed() < seconds);
        println!(
            "{}: {} inputs, {} taken, {} made it panic",
            reader.id,
            count.all,
            count.taken,
            failed.len()
        );
        all.extend(failed);
    }
    println!("{} s", start.elapsed().as_secs());
    assert!(all.is_empty(), "{all:?}");
}

/// What is taken from outside: bytes, text, a folder whose files are read.
const FROM_OUTSIDE: [&str; 4] = ["(bytes: &[u8]", "(source: &str,", "(text: &str) ->", "(folder: &Path) ->"];

/// Functions of such a form that read nothing: one removes files that were left behind, one escapes what is printed.
const NO_READERS: [&str; 2] = ["encode/atomic.rs sweep", "math/shown.rs show"];

/// Public functions of the library that take bytes or text from outside: each is in the table of readers.
#[test]
fn every_reader_is_among_them() {
    let mut taken = BTreeSet::new();
    let mut folders = vec![repository().join("src")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let source = std::fs::read_to_string(&path).unwrap_or_default();
            let name =
                path.strip_prefix(repository().join("src")).unwrap().to_str().unwrap().replace('\\', "/");
            if name.starts_with("cli/") {
                continue;
            }
            let takes = |line: &&str| {
                let signature = line.trim_start();
                let from_outside = FROM_OUTSIDE.iter().any(|a| signature.contains(a));
                signature.starts_with("pub fn ") && from_outside
            };
            for line in source.lines().filter(takes) {
                let function = line.trim_start().trim_start_matches("pub fn ").split('(').next().unwrap();
                taken.insert(format!("{name} {function}"));
            }
        }
    }
    let covered: BTreeSet<String> = READERS.iter().flat_map(|r| r.covers).map(|c| (*c).to_owned()).collect();
    let missing: Vec<&String> =
        taken.difference(&covered).filter(|f| !NO_READERS.contains(&f.as_str())).collect();
    assert!(missing.is_empty(), "no reader in tests/fuzz/readers.rs covers {missing:?}: add a line there");
}
