//! The registry: one recipe an engine, one entry a table.

use brdfbake::recipe::{self, ENGINES, engine, parse};
use std::collections::BTreeSet;
use std::path::Path;

#[test]
fn engines_are_the_files_of_the_folder() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("presets/engines");
    let files: BTreeSet<String> =
        std::fs::read_dir(&folder).unwrap().map(|f| f.unwrap().file_name().into_string().unwrap()).collect();
    let listed: BTreeSet<String> =
        ENGINES.iter().flat_map(|e| [format!("{}.toml", e.id), format!("{}.md", e.id)]).collect();
    assert_eq!(files, listed);
    assert_eq!(2 * ENGINES.len(), listed.len(), "an id is used twice");
    for e in ENGINES {
        assert!(e.recipe.starts_with("# For "), "{}: the first line says who needs it", e.id);
        assert!(recipe::preset(e.id).is_none(), "{} is a preset too", e.id);
    }
    assert!(engine("bevy").is_some() && engine("frostbite").is_none());
}

#[test]
fn every_engine_resolves_to_its_files() {
    for e in ENGINES {
        let plan = e.plan().unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(plan.name, e.id);
        let tables: Vec<&str> = plan.tables.iter().map(|t| t.name()).collect();
        let files: Vec<&str> = e.files.iter().map(|f| f.table).collect();
        assert_eq!(tables, files, "{}", e.id);
        for (table, file) in plan.tables.iter().zip(e.files) {
            assert!(table.asked.file.is_some(), "{}: has no name of its own", table.name());
            assert!(table.asked.waivers.is_empty(), "{}: breaks no law", table.name());
            assert!(!file.replaces.is_empty() && !file.read.is_empty(), "{}", table.name());
        }
    }
}

#[test]
fn a_recipe_takes_the_tables_of_an_engine() {
    let alone = parse("name = 'bevy'\nengine = 'bevy'", "x.toml").unwrap();
    let own = engine("bevy").unwrap().plan().unwrap();
    assert_eq!(alone.hash, own.hash, "the same tables");
    assert_eq!(alone.canonical(), own.canonical(), "with every table written out");
    let more =
        parse("name = 'x'\nengine = 'bevy'\n[[table]]\nkind = 'dfg'\nname = 'more'", "x.toml").unwrap();
    assert_eq!(more.tables.len(), own.tables.len() + 1);
    let canonical = toml::to_string(&more.canonical()).unwrap();
    assert_eq!(parse(&canonical, "x.toml").unwrap().hash, more.hash, "the canonical form is a recipe");
    for (text, message) in [
        ("name = 'x'\nengine = 'bewy'", "did you mean `bevy`?"),
        ("name = 'x'\nengine = 1", "`engine` is an integer"),
        ("name = 'x'\nengine = 'bevy'\n[[table]]\nkind = 'dfg'\nname = 'bevy-dfg'", "is given twice"),
        ("name = 'x'\nengine = 'bevy'\n[[table]]\nkind = 'dfg'\nname = 'dfg'", "is given twice"),
    ] {
        let error = parse(text, "x.toml").unwrap_err().to_string();
        assert!(error.contains(message), "{error}");
    }
}
