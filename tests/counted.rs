//! Tests do not get lost: each binary counts its own, and `tests/counted.txt` keeps the number.
#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "test")]

use std::path::Path;
use std::process::Command;

const KEPT: &str = "tests/counted.txt";

/// The tests that this binary would run, long ones included.
fn here() -> usize {
    let list = Command::new(std::env::current_exe().unwrap())
        .args(["--list", "--include-ignored", "--format", "terse"])
        .output()
        .unwrap();
    assert!(list.status.success(), "{}", String::from_utf8_lossy(&list.stderr));
    String::from_utf8(list.stdout).unwrap().lines().filter(|l| l.ends_with(": test")).count()
}

/// Binary and number of a line.
fn row(line: &str) -> (&str, usize) {
    let (name, number) =
        line.split_once(' ').unwrap_or_else(|| panic!("{KEPT}: {line:?} is no `NAME NUMBER`"));
    (name, number.parse().unwrap_or_else(|e| panic!("{KEPT}: {line:?}: {e}")))
}

#[test]
fn no_test_is_lost() {
    let name = env!("CARGO_CRATE_NAME");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(KEPT);
    let text = std::fs::read_to_string(&path).unwrap();
    let found = here();
    if std::env::var_os("BLESS").is_some() {
        let others = text.lines().filter(|l| row(l).0 != name).map(str::to_owned);
        let mut lines: Vec<String> = others.chain([format!("{name} {found}")]).collect();
        lines.sort();
        std::fs::write(&path, lines.join("\n") + "\n").unwrap();
        return;
    }
    let kept = text.lines().map(row).find(|(n, _)| *n == name).map(|(_, number)| number);
    let kept = kept.unwrap_or_else(|| panic!("{KEPT} has no line `{name} {found}`: write it"));
    assert!(
        found >= kept,
        "{name} has {found} tests, {KEPT} says {kept}: a module is no longer named, or tests were taken out. If that is meant, \
         write `{name} {found}`"
    );
}
