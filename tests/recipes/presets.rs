//! The presets are the files of `presets/`; each parses, binds and is named as its file.

use brdfbake::recipe::{PRESETS, preset};
use std::collections::BTreeSet;
use std::path::Path;

#[test]
fn presets_are_the_files_of_the_folder() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("presets");
    let files: BTreeSet<String> =
        std::fs::read_dir(&folder).unwrap().map(|f| f.unwrap().file_name().into_string().unwrap()).collect();
    let listed: BTreeSet<String> = PRESETS.iter().map(|p| format!("{}.toml", p.id)).collect();
    assert_eq!(files, listed);
    for p in PRESETS {
        assert_eq!(std::fs::read_to_string(folder.join(format!("{}.toml", p.id))).unwrap(), p.source);
    }
}

#[test]
fn every_preset_resolves() {
    for p in PRESETS {
        let plan = p.plan().unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(plan.name, p.id);
        assert!(plan.tables.iter().all(|t| t.waivers.is_empty()), "{}: a preset breaks no law", p.id);
        assert!(p.source.starts_with("# "), "{}: the first line says who needs it", p.id);
    }
    assert_eq!(PRESETS[0].id, "default");
    assert!(preset("default").is_some() && preset("nothing").is_none());
}

#[test]
fn default_tolerances_follow_the_finest_storage() {
    let tolerance = |id: &str, table: &str| {
        let plan = preset(id).unwrap().plan().unwrap();
        plan.tables.iter().find(|t| t.name == table).unwrap().tolerance.to_bits()
    };
    assert_eq!(tolerance("default", "ggx-dfg"), f64::to_bits(0.000_244_140_625));
    assert_eq!(tolerance("default", "kelemen-beckmann"), f64::to_bits(0.5 / 65535.0));
    assert_eq!(tolerance("energy-compensation", "ggx-e"), f64::to_bits(2.980_232_238_769_531_25e-8));
}
