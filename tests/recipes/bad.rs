//! `tests/bad/FAULT.toml` gives exactly the message of `FAULT.txt`. `BLESS=1` writes the messages.
//!
//! Lists of a registry are written as `{models}` and so on, so that a new entry does not change the messages.

use brdfbake::grid::quantity::QUANTITIES;
use brdfbake::models::MODELS;
use brdfbake::plan::Fault;
use brdfbake::recipe::{LoadError, MAX_BYTES, RecipeError, load, parse};
use brdfbake::tables::TABLES;
use brdfbake::verify::LAWS;
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bad")
}

fn refused(source: &str, name: &str) -> RecipeError {
    match parse(source, name) {
        Ok(_) => panic!("{name} should be refused"),
        Err(e) => e,
    }
}

fn without_lists(text: &str) -> String {
    let list = |ids: Vec<&str>| ids.join(", ");
    text.replace(&list(MODELS.iter().map(|m| m.id).collect()), "{models}")
        .replace(&list(TABLES.iter().map(|t| t.id).collect()), "{tables}")
        .replace(&list(LAWS.iter().map(|l| l.id).collect()), "{laws}")
        .replace(&list(QUANTITIES.iter().map(|q| q.id).collect()), "{quantities}")
}

#[test]
fn every_fault_has_its_message() {
    let mut count = 0;
    let mut wrong = Vec::new();
    for file in std::fs::read_dir(folder()).unwrap() {
        let path = file.unwrap().path();
        if path.extension().is_none_or(|e| e != "toml") {
            continue;
        }
        count += 1;
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        let source = std::fs::read_to_string(&path).unwrap();
        let got = format!("{}\n", without_lists(&refused(&source, &name).to_string()));
        let expected = path.with_extension("txt");
        if std::env::var_os("BLESS").is_some_and(|v| v == "1") {
            std::fs::write(&expected, &got).unwrap();
        }
        let expected = std::fs::read_to_string(&expected).unwrap_or_default().replace("\r\n", "\n");
        if got != expected {
            wrong.push(format!("== {name}: got\n{got}== expected\n{expected}"));
        }
    }
    assert!(count >= 20, "{count} files");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn line_and_column_agree_with_what_is_shown() {
    for file in std::fs::read_dir(folder()).unwrap() {
        let path = file.unwrap().path();
        if path.extension().is_none_or(|e| e != "toml") {
            continue;
        }
        let source = std::fs::read_to_string(&path).unwrap();
        let error = refused(&source, "f.toml");
        let shown: Vec<String> = error
            .to_string()
            .lines()
            .filter_map(|l| l.split_once("--> f.toml:").map(|(_, at)| at.to_owned()))
            .collect();
        let told: Vec<String> =
            error.diagnostics.iter().map(|d| format!("{}:{}", d.line, d.column)).collect();
        assert_eq!(shown, told, "{}", path.display());
        let lines: Vec<usize> = error.diagnostics.iter().map(|d| d.line).collect();
        assert!(lines.is_sorted(), "{}: {lines:?}", path.display());
    }
}

#[test]
fn the_structured_form_names_key_and_place() {
    let source = "name = 'x'\n[[table]]\nkind = 'dfg'\nname = 'a'\n[[table.axis]]\nid = 'mu'\nlength = 0\n\
                  [[table.axis]]\nid = 'roughness'\nlength = 8\nwarp = { power = 1e9 }\n";
    let error = refused(source, "x.toml");
    let json = serde_json::to_value(&error.diagnostics).unwrap();
    assert_eq!(json[0]["key"], "table[0].axis[0].length");
    assert_eq!((json[0]["line"].as_u64(), json[0]["column"].as_u64()), (Some(7), Some(10)));
    assert_eq!(json[1]["key"], "table[0].axis[1].warp");
    assert_eq!((json[1]["line"].as_u64(), json[1]["column"].as_u64()), (Some(11), Some(8)));
    assert!(json[1]["message"].as_str().unwrap().contains("power"));
    assert_eq!(error.file, "x.toml");
}

#[test]
fn lists_with_entries_that_cannot_be_read_keep_their_places() {
    let source = "name = 'x'\nengine = 'bevy'\n[[table]]\nkind = 'dfg'\nname = 'a'\noutputs = ['exr:haf', 'exr:half', 'exr:half']\n\
                  waive = [1, { law = 'energy', reason = 'e' }, { law = 'energy', reason = 'e' }]\nchannels = [2, 'dfg.scale', 'dfg.scal']\n\
                  [[table.axis]]\nid = 'mu'\n[[table.axis]]\nid = 'roughness'\nlength = 8\nclamp = [2, 3]\n";
    let error = refused(source, "x.toml");
    let keys: Vec<(&str, usize)> = error.diagnostics.iter().map(|d| (d.key.as_str(), d.line)).collect();
    assert_eq!(
        keys,
        [
            ("table[0].outputs[0]", 6),
            ("table[0].outputs[2]", 6),
            ("table[0].waive[0]", 7),
            ("table[0].waive[2].law", 7),
            ("table[0].channels[0]", 8),
            ("table[0].channels[2]", 8),
            ("table[0].axis[0]", 9),
            ("table[0].axis[1].clamp", 14),
        ],
        "{error}"
    );
}

#[test]
fn a_byte_order_mark_and_crlf_do_not_move_columns() {
    let error = refused("\u{feff}nam = 'x'\r\ntolerance = 3\r\n", "x.toml");
    let at: Vec<(usize, usize)> = error.diagnostics.iter().map(|d| (d.line, d.column)).collect();
    assert_eq!(at, [(1, 1), (1, 1), (1, 1), (2, 13)]);
    assert!(!error.to_string().contains('\r'));
}

#[test]
fn large_files_are_refused_and_faults_are_capped() {
    let long = format!("# {}\n", "x".repeat(MAX_BYTES));
    let error = refused(&long, "x.toml");
    assert!(matches!(error.diagnostics[0].fault, Fault::FileTooLarge { .. }), "{error}");
    let many: String = (0..30_000).map(|i| format!("key{i} = 1\n")).collect();
    let error = refused(&many, "x.toml");
    assert_eq!(error.diagnostics.len(), 50);
    assert_eq!(error.hidden, 30_000 + 2 - 50);
    let tables: String =
        (0..257).map(|i| format!("[[table]]\nkind = 'average-albedo'\nname = 't{i}'\n")).collect();
    let error = refused(&format!("name = 'x'\n{tables}"), "x.toml");
    assert_eq!(error.diagnostics.len(), 1, "{error}");
    assert!(error.to_string().contains("`table` has 257 entries"), "{error}");
}

#[test]
fn loading_tells_the_system_from_the_recipe() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.toml");
    assert!(matches!(load(&path), Err(LoadError::Io { .. })));
    assert!(matches!(load(folder.path()), Err(LoadError::NotAFile { .. })));
    std::fs::write(&path, b"name = 'x'\n# caf\xe9\n").unwrap();
    let Err(LoadError::Recipe(error)) = load(&path) else { panic!("not UTF-8") };
    assert_eq!((error.diagnostics[0].line, error.diagnostics[0].column), (2, 6));
    std::fs::write(&path, vec![b' '; MAX_BYTES + 5]).unwrap();
    let Err(LoadError::Recipe(error)) = load(&path) else { panic!("too large") };
    assert!(matches!(error.diagnostics[0].fault, Fault::FileTooLarge { .. }), "{error}");
    std::fs::write(&path, "name = 'x'\n[[table]]\nkind = 'dfg'\nname = 'a'\n").unwrap();
    assert_eq!(load(&path).unwrap().name, "x");
}
