//! The schema of recipes is that of the reader. CI asks Python's jsonschema; here it is asked where it is installed.

use super::support::{code, err, out};
use std::process::Command;

#[test]
fn presets_keep_the_schema_and_damaged_recipes_do_not() {
    let asked = Command::new("python3").args(["-c", "import jsonschema, tomllib"]).output();
    if !asked.is_ok_and(|o| o.status.success()) {
        eprintln!("SKIPPED: python3 with jsonschema and tomllib is not installed");
        return;
    }
    let o = Command::new("python3")
        .args([
            "tests/foreign/recipe_schema.py",
            env!("CARGO_BIN_EXE_brdfbake"),
            "tests/bad",
            "presets",
            "out-examples",
        ])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    assert_eq!(code(&o), 0, "{}", err(&o));
    assert!(out(&o).contains("keep their schema"), "{}", out(&o));
}
