//! The generated parts of README.md say what the registries say. `cargo bless` writes them anew.
#![allow(clippy::unwrap_used, reason = "test")]

use brdfbake::cli::exit;
use brdfbake::models::MODELS;
use brdfbake::recipe::{ENGINES, PRESETS};
use brdfbake::tables::{ModelUse, TABLES};
use brdfbake::verify::LAWS;

fn rows(header: &str, rows: impl Iterator<Item = String>) -> String {
    let columns = header.matches('|').count() - 1;
    let rule = format!("|{}", "---|".repeat(columns));
    let rows: Vec<String> = rows.collect();
    format!("{header}\n{rule}\n{}", rows.join("\n"))
}

fn sections() -> Vec<(&'static str, String)> {
    let models = rows(
        "| model | what | laws | source |",
        MODELS.iter().map(|m| {
            let law = |yes: bool, word: &str| if yes { word.to_owned() } else { format!("not {word}") };
            let laws = [law(m.laws.reciprocal, "reciprocal"), law(m.laws.passive, "passive")].join(", ");
            let sources: Vec<String> = m.sources.iter().map(|(c, eq)| format!("{} {eq}", c.key)).collect();
            format!("| `{}` | {} | {laws} | {} |", m.id, m.title, sources.join("; "))
        }),
    );
    let tables = rows(
        "| table | what | layouts | model | laws checked |",
        TABLES.iter().map(|t| {
            let layouts: Vec<String> = t.layouts.iter().map(|l| format!("`{}`", l.id)).collect();
            let model = match t.model {
                ModelUse::None => "none".to_owned(),
                ModelUse::Any(id) => format!("any, default `{id}`"),
                ModelUse::Split(id) => format!("splits F off, default `{id}`"),
            };
            format!("| `{}` | {} | {} | {model} | {} |", t.id, t.title, layouts.join(", "), t.laws.join(", "))
        }),
    );
    let laws = rows(
        "| law | finding | says |",
        LAWS.iter().map(|l| format!("| `{}` | BB{:04} | {} |", l.id, l.code, l.statement)),
    );
    let presets = rows("| preset | for |", PRESETS.iter().map(|p| format!("| `{}` | {} |", p.id, p.doc)));
    let engines = rows(
        "| engine | version | file | takes the place of |",
        ENGINES.iter().flat_map(|e| {
            let plan = e.plan().unwrap();
            let files: Vec<String> = plan.tables.iter().flat_map(|t| t.files()).collect();
            let row = move |(i, file): (usize, String)| {
                let (id, version) = (format!("`{}`", e.id), e.version.to_owned());
                let [id, version] = if i == 0 { [id, version] } else { [String::new(), String::new()] };
                format!("| {id} | {version} | `{file}` | {} |", e.files[i].replaces)
            };
            files.into_iter().enumerate().map(row).collect::<Vec<_>>()
        }),
    );
    let codes = format!("```text\n{}\n```", exit::TABLE);
    vec![
        ("models", models),
        ("tables", tables),
        ("laws", laws),
        ("presets", presets),
        ("engines", engines),
        ("exit codes", codes),
    ]
}

#[test]
fn generated_parts_are_up_to_date() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/README.md");
    let mut readme = std::fs::read_to_string(path).unwrap();
    for (name, expected) in sections() {
        let (open, close) = (format!("<!-- generated: {name} -->\n"), format!("\n<!-- end: {name} -->"));
        let start =
            readme.find(&open).unwrap_or_else(|| panic!("README.md has no section {name}")) + open.len();
        let end = start + readme[start..].find(&close).unwrap();
        if std::env::var_os("BLESS").is_some() {
            readme.replace_range(start..end, &expected);
        } else {
            assert_eq!(
                &readme[start..end],
                expected,
                "section {name} of README.md: run `cargo bless --test house readme`"
            );
        }
    }
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(path, readme).unwrap();
    }
}

#[test]
fn commands_in_the_readme_exist() {
    if std::env::var_os("BLESS").is_some() {
        return; // the other test is writing the file
    }
    let readme = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/README.md")).unwrap();
    assert!(readme.contains("cargo run --release -- bake\n"), "the main command");
    for verb in ["bake", "inspect", "diff", "golden", "eval", "albedo", "laws", "plot", "list", "describe"] {
        assert!(readme.contains(&format!("brdfbake {verb}")), "no example of {verb}");
    }
}
