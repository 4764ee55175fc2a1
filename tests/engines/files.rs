//! Names, text round the numbers, and several tables in one file.

use crate::support::{bake, numbers};
use brdfbake::recipe::parse;

const TABLE: &str = "[[table]]\nkind = 'fresnel-schlick'\n";

/// A small table with these keys.
fn table(name: &str, keys: &str) -> String {
    format!("{TABLE}name = '{name}'\n{keys}\n[[table.axis]]\nid = 'mu'\nlength = 3\n")
}

fn message(tables: &str) -> String {
    parse(&format!("name = 'x'\n{tables}"), "x.toml").unwrap_err().to_string()
}

#[test]
fn a_table_names_its_file() {
    let out = tempfile::tempdir().unwrap();
    let text =
        table("a", "file = 'lut.inc'\noutputs = ['text:half']\nbefore = '// one\n'\nafter = ' // end'");
    let text = text.replace("'// one\n'", "\"// one\\n\"");
    let plan = parse(&format!("name = 'x'\n{text}"), "x.toml").unwrap();
    let files = bake(&plan, out.path());
    let written = std::fs::read_to_string(&files[0]).unwrap();
    assert!(written.starts_with("// one\n0x") && written.ends_with(" // end"), "{written}");
    assert_eq!(files[0].file_name().unwrap(), "lut.inc");
    assert_eq!(plan.tables[0].canonical["file"], "lut.inc");
}

#[test]
fn tables_in_one_file_follow_each_other() {
    let out = tempfile::tempdir().unwrap();
    let one = |name: &str| {
        let around = format!("before = \"{name}[] = {{\\n\"\nafter = \"\\n}};\\n\"");
        table(name, &format!("file = 'both.h'\noutputs = ['text:float']\n{around}"))
    };
    let plan = parse(&format!("name = 'x'\n{}{}", one("a"), one("b")), "x.toml").unwrap();
    let files = bake(&plan, out.path());
    assert_eq!(files[0], files[1]);
    let written = std::fs::read_to_string(&files[0]).unwrap();
    let lists = numbers(&written);
    assert_eq!(lists.len(), 2, "{written}");
    assert_eq!(lists[0], lists[1]);
    assert!(written.starts_with("a[] = {\n") && written.contains("};\nb[] = {\n"), "{written}");
    let manifest = std::fs::read_to_string(out.path().join("manifest.json")).unwrap();
    let manifest: serde_json::Value = serde_json::from_str(&manifest).unwrap();
    for table in manifest["tables"].as_array().unwrap() {
        assert_eq!(table["files"][0]["bytes"], written.len(), "the size of the whole file");
        assert_eq!(
            table["files"][0]["blake3"],
            blake3::hash(written.as_bytes()).to_hex().to_string(),
            "its hash"
        );
    }
}

#[test]
fn names_that_cannot_be_are_refused() {
    let one = |keys: &str| message(&table("a", keys));
    assert!(one("file = 'a/b.h'").contains("file name `a/b.h` has a character that is not portable"));
    assert!(one("file = 'Manifest.json'").contains("the manifest has this name"));
    assert!(one("file = 'a.exr'\noutputs = ['exr:half', 'png:unorm8']").contains("the table has 2 outputs"));
    assert!(one("before = 'x'").contains("exr has no place for `before`"));
    assert!(one("file = 1").contains("`file` is an integer"));
    let two = |a: &str, b: &str| message(&format!("{}{}", table("a", a), table("b", b)));
    assert!(
        two("file = 'x.exr'\noutputs = ['exr:half']", "file = 'x.exr'\noutputs = ['exr:half']")
            .contains("only containers without a header")
    );
    let text = "outputs = ['text:half']\n";
    assert!(
        two(&format!("{text}file = 'x.h'"), &format!("{text}file = 'X.h'"))
            .contains("file names must differ by more than case")
    );
    assert!(two("", "file = 'A.exr'").contains("a table of this name writes files of its own"));
}
