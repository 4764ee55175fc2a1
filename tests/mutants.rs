//! Mutants: small wrong changes that the tests must notice. `mutants/list.toml` keeps them; each names the test that is to fail.
//!
//! `cargo test --test house mutants` checks that the list fits the tree. The mutants themselves are made and run, one at a time in a
//! copy of the tree, by
//!
//! ```sh
//! cargo mutate                            # all of them: an hour on four cores
//! BRDFBAKE_MUTANTS=grid cargo mutate      # those with `grid` in their id
//! ```
//!
//! which is `BRDFBAKE_MUTANTS=all cargo test --test house -- --ignored --nocapture mutants_are`. Without the variable (`cargo long`) they are
//! skipped.
//!
//! A mutant is caught when its test binary still builds and the test fails. One that survives is an error, unless the list
//! gives the reason; so is one that is said to survive and does not.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "test")]

use crate::layout::binaries;
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct List {
    mutant: Vec<Mutant>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Mutant {
    id: String,
    /// The file that is changed.
    file: String,
    /// What is there now, exactly once.
    find: String,
    /// What is there then.
    replace: String,
    /// The test binary that is to fail; `lib` for the tests inside the library.
    test: String,
    /// The tests of it that are run.
    filter: String,
    /// Why nothing notices it, if so.
    survives: Option<String>,
}

/// Fewest mutants.
const LEAST: usize = 40;

/// Parts of the program that have mutants.
const AREAS: [&str; 8] = [
    "src/grid/",
    "src/verify/",
    "src/encode/",
    "src/plan/",
    "src/recipe/",
    "src/pipeline/transaction/",
    "src/cli/",
    "presets/engines/",
];

/// A test that takes longer does not end: that is a failure too.
const PATIENCE: Duration = Duration::from_secs(900);

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn list() -> Vec<Mutant> {
    let text = std::fs::read_to_string(root().join("tests/mutants/list.toml")).unwrap();
    toml::from_str::<List>(&text).unwrap_or_else(|e| panic!("{e}")).mutant
}

/// The file with the change; an error if it does not fit.
fn mutated(mutant: &Mutant, text: &str) -> Result<String, String> {
    let Mutant { id, file, find, replace, .. } = mutant;
    let found = text.matches(find.as_str()).count();
    if found != 1 {
        return Err(format!("{id}: `{find}` is in {file} {found} times, not once"));
    }
    let (old, new): (Vec<&str>, Vec<&str>) = (find.lines().collect(), replace.lines().collect());
    let changed = old.iter().zip(&new).filter(|(a, b)| a != b).count();
    if old.len() != new.len() || changed != 1 {
        return Err(format!("{id}: changes {changed} lines, not one"));
    }
    Ok(text.replacen(find.as_str(), replace, 1))
}

#[test]
fn the_list_fits_the_tree() {
    let all = list();
    let mut faults = Vec::new();
    let mut ids = BTreeSet::new();
    let binaries = binaries();
    for mutant in &all {
        if !ids.insert(mutant.id.as_str()) {
            faults.push(format!("{}: there are two of this id", mutant.id));
        }
        match std::fs::read_to_string(root().join(&mutant.file)) {
            Ok(text) => faults.extend(mutated(mutant, &text).err()),
            Err(e) => faults.push(format!("{}: {}: {e}", mutant.id, mutant.file)),
        }
        if mutant.test != "lib" && !binaries.contains(&mutant.test) {
            faults.push(format!(
                "{}: there is no test binary {}, but {}",
                mutant.id,
                mutant.test,
                binaries.join(", ")
            ));
        }
        if mutant.survives.as_ref().is_some_and(|why| why.trim().is_empty()) {
            faults.push(format!("{}: a survivor needs its reason", mutant.id));
        }
    }
    let engines = brdfbake::recipe::ENGINES.iter().map(|e| format!("presets/engines/{}.toml", e.id));
    for part in AREAS.iter().map(|a| (*a).to_owned()).chain(engines) {
        if !all.iter().any(|m| m.file.starts_with(&part)) {
            faults.push(format!("nothing in {part} has a mutant"));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert!(all.len() >= LEAST, "{} mutants", all.len());
}

#[test]
#[ignore = "builds and runs tests once a mutant: an hour"]
fn mutants_are_caught() {
    let Ok(wanted) = std::env::var("BRDFBAKE_MUTANTS") else {
        println!("SKIPPED: `cargo mutate` makes the mutants");
        return;
    };
    let all = wanted == "all";
    let chosen: Vec<Mutant> = list().into_iter().filter(|m| all || m.id.contains(&wanted)).collect();
    assert!(!chosen.is_empty(), "no mutant has `{wanted}` in its id");
    let workshop = Workshop::new();
    workshop.check_unchanged(&chosen);
    let mut wrong = Vec::new();
    for mutant in &chosen {
        let begun = Instant::now();
        let verdict = workshop.run(mutant);
        let seconds = begun.elapsed().as_secs();
        println!("{:<32} {seconds:>4} s  {verdict}", mutant.id);
        let said = mutant.survives.is_some();
        match verdict {
            Verdict::Caught if said => {
                wrong.push(format!("{}: is said to survive, and is caught", mutant.id))
            }
            Verdict::Survived if !said => wrong.push(format!("{}: survived", mutant.id)),
            Verdict::Broken(ref why) => wrong.push(format!("{}: does not build: {why}", mutant.id)),
            _ => {}
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    println!("{} mutants", chosen.len());
}

enum Verdict {
    Caught,
    Survived,
    Broken(String),
}

impl std::fmt::Display for Verdict {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Verdict::Caught => "caught",
            Verdict::Survived => "SURVIVED",
            Verdict::Broken(_) => "DOES NOT BUILD",
        })
    }
}

/// A copy of the tree that is changed, built and put back.
struct Workshop {
    tree: PathBuf,
    target: PathBuf,
}

impl Workshop {
    fn new() -> Workshop {
        // kept between runs: only what changed is built again
        let home = Path::new(env!("CARGO_TARGET_TMPDIR")).join("mutants");
        let workshop = Workshop { tree: home.join("tree"), target: home.join("target") };
        copy(&root(), &workshop.tree);
        workshop
    }

    fn cargo(&self, mutant: &Mutant, run: bool) -> Output {
        let mut command = Command::new(std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned()));
        command.current_dir(&self.tree).args(["test", "--quiet"]);
        match mutant.test.as_str() {
            "lib" => command.arg("--lib"),
            test => command.args(["--test", test]),
        };
        if run {
            command.args(["--", &mutant.filter]);
        } else {
            command.arg("--no-run");
        }
        // the time goes into building
        command.env("CARGO_TARGET_DIR", &self.target).env("CARGO_PROFILE_TEST_OPT_LEVEL", "1");
        command.env_remove("BRDFBAKE_MUTANTS").stdout(Stdio::piped()).stderr(Stdio::piped());
        let child = command.spawn().unwrap();
        let id = child.id();
        let (sender, receiver) = std::sync::mpsc::channel();
        std::thread::spawn(move || sender.send(child.wait_with_output()));
        match receiver.recv_timeout(PATIENCE) {
            Ok(output) => output.unwrap(),
            Err(_) => {
                let _ = Command::new("kill").arg(id.to_string()).status();
                receiver.recv().unwrap().unwrap()
            }
        }
    }

    /// Every test that a mutant names passes without it, and is there.
    fn check_unchanged(&self, mutants: &[Mutant]) {
        let mut done: BTreeMap<(&str, &str), ()> = BTreeMap::new();
        for mutant in mutants {
            if done.insert((&mutant.test, &mutant.filter), ()).is_some() {
                continue;
            }
            let output = self.cargo(mutant, true);
            let text = String::from_utf8_lossy(&output.stdout);
            let ran =
                text.lines().filter(|l| l.starts_with("running ")).any(|l| !l.starts_with("running 0 "));
            let name = format!("{} of {}", mutant.filter, mutant.test);
            assert!(output.status.success(), "{name} fails without a mutant:\n{text}");
            assert!(ran, "{name}: there is no such test");
        }
    }

    fn run(&self, mutant: &Mutant) -> Verdict {
        let path = self.tree.join(&mutant.file);
        let text = std::fs::read_to_string(&path).unwrap();
        std::fs::write(&path, mutated(mutant, &text).unwrap()).unwrap();
        let built = self.cargo(mutant, false);
        let verdict = if built.status.success() {
            if self.cargo(mutant, true).status.success() { Verdict::Survived } else { Verdict::Caught }
        } else {
            Verdict::Broken(String::from_utf8_lossy(&built.stderr).into_owned())
        };
        std::fs::write(&path, text).unwrap();
        verdict
    }
}

/// Makes `to` what `from` is, and leaves alone what is the same: builds go by the time of a file.
fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    let mut kept = BTreeSet::new();
    for entry in std::fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let name = entry.file_name();
        if name == "target" || name == ".git" {
            continue;
        }
        let (from, to) = (entry.path(), to.join(&name));
        kept.insert(name);
        if from.is_dir() {
            copy(&from, &to);
            continue;
        }
        let bytes = std::fs::read(&from).unwrap();
        if !std::fs::read(&to).is_ok_and(|old| old == bytes) {
            std::fs::write(&to, bytes).unwrap();
        }
    }
    for entry in std::fs::read_dir(to).unwrap() {
        let entry = entry.unwrap();
        if !kept.contains(&entry.file_name()) {
            let path = entry.path();
            if path.is_dir() {
                std::fs::remove_dir_all(path).unwrap()
            } else {
                std::fs::remove_file(path).unwrap()
            }
        }
    }
}
