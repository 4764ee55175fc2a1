//! No input makes the reader panic, and what it refuses it explains.

use brdfbake::recipe::{PRESETS, parse};
use proptest::prelude::*;

fn survives(source: &str) {
    if let Err(error) = parse(source, "fuzz.toml") {
        assert!(!error.diagnostics.is_empty());
        assert!(error.to_string().starts_with("error: "), "{error}");
        for d in &error.diagnostics {
            assert!(d.line >= 1 && d.column >= 1 && !d.message.is_empty());
        }
    }
}

/// Pieces that reach deeper than random bytes do.
const PIECES: &[&str] = &[
    "name",
    "tolerance",
    "table",
    "[[table]]\n",
    "[[table.axis]]\n",
    "[table]\n",
    "kind",
    "axis",
    "params",
    "waive",
    "warp",
    "domain",
    "length",
    "id",
    "outputs",
    " = ",
    "\"dfg\"",
    "\"albedo\"",
    "\"mu\"",
    "\"roughness\"",
    "\"x\"",
    "64",
    "-1",
    "1e999",
    "nan",
    "-inf",
    "0x7fffffffffffffff",
    "99999999999999999999999",
    "[",
    "]",
    "{",
    "}",
    ",",
    ".",
    "\n",
    "\"",
    "'''",
    "#",
    "\u{feff}",
    "\u{0}",
    "é",
    "漢",
    "\r",
    "\t",
    "\u{202e}",
    "true",
    "1979-05-27",
    "coupled",
    "power",
    "= 0.5\n",
    "\"exr:half\"",
    "law",
    "reason",
];

proptest! {
    #![proptest_config(ProptestConfig { cases: 512, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_bytes(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        survives(&String::from_utf8_lossy(&bytes));
    }

    #[test]
    fn random_pieces(pieces in prop::collection::vec(0..PIECES.len(), 0..60)) {
        let source: String = pieces.iter().map(|&i| PIECES[i]).collect();
        survives(&source);
        survives(&format!("name = 'x'\n[[table]]\nkind = 'dfg'\nname = 'a'\n{source}"));
    }

    #[test]
    fn mutated_default(
        edits in prop::collection::vec((any::<prop::sample::Index>(), 0..6u8, 0..PIECES.len()), 1..8),
    ) {
        let mut text: Vec<char> = PRESETS[0].source.chars().collect();
        for (at, what, piece) in edits {
            let i = at.index(text.len());
            match what {
                0 => drop(text.remove(i)),
                1 => text.truncate(i.max(1)),
                2 => { let line = text[i..].iter().position(|&c| c == '\n').unwrap_or(0); text.drain(i..i + line); }
                3 => { let c = text[i]; text.insert(i, c); }
                _ => drop(text.splice(i..i, PIECES[piece].chars())),
            }
            if text.is_empty() { text.push(' '); }
        }
        survives(&text.iter().collect::<String>());
    }
}

#[test]
fn deep_nesting_is_refused_without_a_stack_overflow() {
    for (open, close) in [("[", "]"), ("{ a = ", "}")] {
        for n in [50, 5000, 100_000] {
            survives(&format!("a = {}{}\n", open.repeat(n), close.repeat(n)));
        }
    }
    for n in [70, 5000, 200_000] {
        survives(&format!("{}a = 1\n", "a.".repeat(n)));
        survives(&format!("[{}a]\n", "a.".repeat(n)));
        survives(&format!("[[table]]\n[{}a]\n", "table.".repeat(n)));
    }
    // dotted keys in nested inline tables: the two limits multiply
    let step = format!("{}a = {{ ", "a.".repeat(70));
    survives(&format!("x = {{ {} {}\n", step.repeat(70), "}".repeat(71)));
}

#[test]
fn one_long_line_is_read_in_reasonable_time() {
    survives(&format!("name = [{}]\n", "'x', ".repeat(150_000)));
    survives(&"= ".repeat(400_000));
    survives(&format!(
        "name = 'x'\n[[table]]\nkind = 'dfg'\nname = 'a'\nwaive = [{}]\n",
        "{}, ".repeat(200_000)
    ));
    survives(&format!("[[table]]\n{} = 1\n", "k".repeat(900_000)));
}
