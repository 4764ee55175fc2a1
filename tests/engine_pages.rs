//! The page of every engine says what a user of the released engine replaces, with which settings, how to see it, and what happens at
//! start-up.
#![allow(clippy::unwrap_used, reason = "test")]

use brdfbake::guide::{engine_page, plain};
use brdfbake::recipe::{ENGINES, Engine, Reader};

/// What the text beside the recipe of an engine says.
const PARTS: [&str; 4] =
    ["## Put it in place", "## Import settings", "## See that it took", "## At start-up"];

/// What import settings speak of, in one of these words each.
const SETTINGS: [&[&str]; 5] = [
    &["srgb", "colour space", "color space"],
    &["mipmap"],
    &["compress"],
    &["clamp"],
    &["filter", "linear()"],
];

/// Settings of textures are complete, and whether the engine makes the table itself is said first.
fn says_all(engine: &Engine, file: &str, section: impl Fn(&str) -> String) {
    let settings = section("## Import settings").to_lowercase();
    // arrays are compiled in or read by the processor
    let array = matches!(engine.reader, Reader::Fixed(_)) && settings.starts_with("not a texture: ");
    for words in SETTINGS {
        assert!(
            array || words.iter().any(|w| settings.contains(w)),
            "{file}: `## Import settings` does not say {}: {settings}",
            words[0]
        );
    }
    let start = section("## At start-up");
    assert!(
        ["Nothing is computed", "Computed: "].iter().any(|s| start.starts_with(s)),
        "{file}: `## At start-up` begins with `Nothing is computed` or `Computed: `: {start}"
    );
}

#[test]
fn every_engine_has_a_page_that_says_what_to_replace_and_how_to_see_it() {
    for engine in ENGINES {
        let file = format!("presets/engines/{}.md", engine.id);
        for part in PARTS {
            let text = engine.guide.split_once(&format!("{part}\n"));
            let text = text.unwrap_or_else(|| panic!("{file}: write a section `{part}`")).1;
            let words = text.split("\n## ").next().unwrap().split_whitespace().count();
            assert!(words >= 5, "{file}: section `{part}` has {words} words: say it");
        }
        says_all(engine, &file, |part| {
            let text = engine.guide.split_once(&format!("{part}\n")).unwrap().1;
            text.split("\n## ").next().unwrap().trim().to_owned()
        });
        let page = plain(&engine_page(engine, 1).unwrap());
        let command = format!("brdfbake bake --engine {}", engine.id);
        for part in
            engine.files.iter().flat_map(|f| [f.replaces, f.read]).chain([command.as_str(), engine.version])
        {
            let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
            assert!(
                words(&page).contains(&words(part)),
                "the page of {} does not have: {part}\n{page}",
                engine.id
            );
        }
    }
}
