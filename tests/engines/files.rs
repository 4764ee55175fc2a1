//! Names, text round the numbers, and several tables in one file.

use crate::engines::support::{bake, numbers};
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
    assert_eq!(plan.tables[0].canonical()["file"], "lut.inc");
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
fn tables_in_one_exr_are_its_parts() {
    let one = |name: &str, model: &str| {
        format!(
            "[[table]]\nkind = 'albedo'\nname = '{name}'\nfile = 'set.exr'\nmodel = '{model}'\n\
             [[table.axis]]\nid = 'mu'\nlength = 5\n[[table.axis]]\nid = 'alpha'\nlength = 3\ndomain = [0.1, 1.0]\n"
        )
    };
    let both = format!("name = 'x'\n{}{}", one("rough", "ggx"), one("steep", "beckmann"));
    let plan = parse(&both, "x.toml").unwrap();
    let out = tempfile::tempdir().unwrap();
    let files = bake(&plan, out.path());
    assert_eq!(files[0], files[1]);
    let bytes = std::fs::read(&files[0]).unwrap();
    // the same bytes again, with another number of threads
    let again = tempfile::tempdir().unwrap();
    let settings =
        brdfbake::pipeline::Settings { jobs: Some(1), ..brdfbake::pipeline::Settings::new(again.path()) };
    let cancel = brdfbake::cancel::Cancel::new();
    brdfbake::pipeline::run(&plan, &settings, &cancel, &brdfbake::pipeline::Silent).unwrap();
    assert_eq!(bytes, std::fs::read(again.path().join("set.exr")).unwrap());
    // each part holds what its table holds in a file of its own
    let set = brdfbake::encode::read::read_bytes(&bytes).unwrap();
    for (name, model) in [("rough", "ggx"), ("steep", "beckmann")] {
        let text = format!("name = 'x'\n{}", one(name, model)).replace("file = 'set.exr'\n", "");
        let alone = tempfile::tempdir().unwrap();
        let file = bake(&parse(&text, "x.toml").unwrap(), alone.path()).remove(0);
        let picture = brdfbake::encode::read::read_file(&file).unwrap();
        let part = set.channel(&format!("{name}.e")).unwrap();
        assert_eq!(part.values, picture.channels[0].values, "{name}");
    }
    let text = brdfbake::report::inspect::inspect("set.exr", &set);
    assert!(text.contains("Table 1 of 2, rough") && text.contains("Table 2 of 2, steep"), "{text}");
    let lengths = both.replacen("length = 5", "length = 6", 1);
    let message = parse(&lengths, "x.toml").unwrap_err().to_string();
    assert!(message.contains("one size, storage and options"), "{message}");
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
        two("file = 'x.png'\noutputs = ['png:unorm16']", "file = 'x.png'\noutputs = ['png:unorm16']")
            .contains("only containers without a header")
    );
    let text = "outputs = ['text:half']\n";
    assert!(
        two(&format!("{text}file = 'x.h'"), &format!("{text}file = 'X.h'"))
            .contains("file names must differ by more than case")
    );
    assert!(two("", "file = 'A.exr'").contains("a table of this name writes files of its own"));
}

/// What is told of a table whose rows an engine reads one texel off is what the engine gets, not what the best reader would.
#[test]
fn the_report_of_an_engine_is_as_it_reads() {
    let out = tempfile::tempdir().unwrap();
    let baked = std::process::Command::new(env!("CARGO_BIN_EXE_brdfbake"))
        .args(["bake", "--engine", "filament", "-o", out.path().to_str().unwrap()])
        .output()
        .unwrap();
    let told = String::from_utf8(baked.stderr).unwrap();
    assert!(baked.status.success(), "{told}");
    let text = std::fs::read_to_string(out.path().join("manifest.json")).unwrap();
    let manifest: serde_json::Value = serde_json::from_str(&text).unwrap();
    let mean = |key: &str| manifest["tables"][0]["files"][0][key]["practical"]["mean"].as_f64().unwrap();
    let (engine, known) = (mean("as_read"), mean("reconstruction"));
    assert!(engine > 3.0 * known, "{engine} and {known}");
    let line = told.lines().find(|l| l.contains("as the engine reads it")).unwrap_or(&told);
    assert!(line.contains(&format!("{engine:.1e} in the mean")), "{line}");
}
