//! README and the guide: generated parts say what the registries say, what they link to is there, and their commands run.
//! `cargo bless` writes the generated parts anew.
#![allow(clippy::unwrap_used, reason = "test")]

use brdfbake::cli::{Cli, exit};
use brdfbake::encode::ENCODERS;
use brdfbake::guide::{TOPICS, engine_page, plain};
use brdfbake::models::MODELS;
use brdfbake::recipe::{self, ENGINES, PRESETS};
use brdfbake::scene::{Asks, EXTENSIONS};
use brdfbake::tables::{ModelUse, TABLES};
use brdfbake::verify::LAWS;
use clap::{CommandFactory, Parser};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Most words of README: what does not fit goes to a page of the guide.
const WORDS: usize = 1500;
/// Longest line that is printed, outside code.
const LINE: usize = 100;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn bless() -> bool {
    std::env::var_os("BLESS").is_some()
}

/// README and the pages: path and text.
fn pages() -> Vec<(PathBuf, String)> {
    let paths = TOPICS.iter().map(|t| root().join(format!("src/guide/{}.md", t.id)));
    let read = |path: PathBuf| (path.clone(), std::fs::read_to_string(path).unwrap());
    std::iter::once(root().join("README.md")).chain(paths).map(read).collect()
}

fn rows(header: &str, rows: impl Iterator<Item = String>) -> String {
    let columns = header.matches('|').count() - 1;
    let rule = format!("|{}", "---|".repeat(columns));
    let rows: Vec<String> = rows.collect();
    format!("{header}\n{rule}\n{}", rows.join("\n"))
}

fn models() -> String {
    rows(
        "| model | what | laws | source |",
        MODELS.iter().map(|m| {
            let law = |yes: bool, word: &str| if yes { word.to_owned() } else { format!("not {word}") };
            let laws = [law(m.laws.reciprocal, "reciprocal"), law(m.laws.passive, "passive")].join(", ");
            let sources: Vec<String> = m.sources.iter().map(|(c, eq)| format!("{} {eq}", c.key)).collect();
            format!("| `{}` | {} | {laws} | {} |", m.id, m.title, sources.join("; "))
        }),
    )
}

fn tables() -> String {
    rows(
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
    )
}

fn engines() -> String {
    rows(
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
    )
}

/// How far off shipped files are.
fn shipped() -> String {
    let errors = |[largest, mean]: [f64; 2]| format!("{largest:.1e}, {mean:.1e}");
    rows(
        "| engine | file | whole domain | practical | of |",
        ENGINES.iter().flat_map(|e| {
            e.files.iter().map(|f| {
                let [whole, practical, of] = match &f.shipped {
                    Some(s) => [errors(s.whole), errors(s.practical), s.source.to_owned()],
                    None if f.replaces.contains("made ") => {
                        ["none", "", "made when it starts; nothing is shipped"].map(str::to_owned)
                    }
                    None => ["not measured", "", "no copy of the file was at hand"].map(str::to_owned),
                };
                format!("| `{}` | {} | {whole} | {practical} | {of} |", e.id, f.replaces)
            })
        }),
    )
}

fn formats() -> String {
    rows(
        "| container | files | channels | storages | options | metadata inside |",
        ENCODERS.iter().map(|e| {
            let storages: Vec<&str> = e.storages().iter().map(|s| s.id()).collect();
            let options: Vec<String> = e.options().iter().map(|o| format!("`+{}`", o.id())).collect();
            let channels = match e.most_channels() {
                usize::MAX => "any".to_owned(),
                n => format!("to {n}"),
            };
            let inside = if e.holds_metadata() { "yes" } else { "no" };
            format!(
                "| `{}` | *.{} | {channels} | {} | {} | {inside} |",
                e.id(),
                e.extension(),
                storages.join(", "),
                options.join(" ")
            )
        }),
    )
}

fn extensions() -> String {
    rows(
        "| glTF extension | asks for |",
        EXTENSIONS.iter().map(|e| {
            let asks = match &e.asks {
                Asks::Nothing(why) => format!("nothing: {why}"),
                Asks::BaseLayer => "the tables of the base layer".to_owned(),
                Asks::Unlit => "nothing, whatever else the material says: its colour is constant".to_owned(),
                Asks::RoughnessTexture => {
                    "the tables of the base layer, over the roughness of its own texture".to_owned()
                }
                Asks::Layer([], _) => {
                    "nothing of its own: closed forms, and the tables of other layers".to_owned()
                }
                Asks::Layer(families, _) => format!("the `{}` tables", families.join("`, `")),
                Asks::AreaLights => "the `area-light` tables, over the roughness of every lobe".to_owned(),
                Asks::Replaced(by) => format!("nothing: {by} in place of glTF's material model"),
                Asks::Unknown(why) => format!("unknown: {why}"),
                Asks::NotYet { table, .. } => format!("{table}, for which there is no kind of table"),
            };
            format!("| `{}` | {asks} |", e.name)
        }),
    )
}

/// The generated parts, by the name in their markers.
fn sections() -> Vec<(&'static str, String)> {
    let laws = rows(
        "| law | finding | says |",
        LAWS.iter().map(|l| format!("| `{}` | BB{:04} | {} |", l.id, l.code, l.statement)),
    );
    let presets = rows("| preset | for |", PRESETS.iter().map(|p| format!("| `{}` | {} |", p.id, p.doc)));
    let pages: Vec<String> = ENGINES.iter().map(|e| engine_page(e, 3).unwrap()).collect();
    vec![
        ("models", models()),
        ("tables", tables()),
        ("laws", laws),
        ("presets", presets),
        ("engines", engines()),
        ("shipped", shipped()),
        ("engine pages", pages.join("\n").trim_end().to_owned()),
        ("formats", formats()),
        ("extensions", extensions()),
        ("exit codes", format!("```text\n{}\n```", exit::TABLE)),
    ]
}

#[test]
fn generated_parts_are_up_to_date() {
    let mut pages = pages();
    let marks: usize = pages.iter().map(|(_, text)| text.matches("<!-- generated: ").count()).sum();
    let sections = sections();
    assert_eq!(marks, sections.len(), "a marker without a section, or a section without its marker");
    for (name, expected) in sections {
        let (open, close) = (format!("<!-- generated: {name} -->\n"), format!("<!-- end: {name} -->"));
        let (path, text) = pages
            .iter_mut()
            .find(|(_, text)| text.contains(&open))
            .unwrap_or_else(|| panic!("no page has the markers of `{name}`: write {open}{close}"));
        let start = text.find(&open).unwrap() + open.len();
        let end = start + text[start..].find(&close).unwrap();
        if bless() {
            text.replace_range(start..end, &format!("{expected}\n"));
        } else {
            let path = path.display();
            assert_eq!(
                text[start..end].trim_end(),
                expected,
                "section {name} of {path}: run `cargo bless --test house readme`"
            );
        }
    }
    if bless() {
        for (path, text) in pages {
            if std::fs::read_to_string(&path).unwrap() != text {
                std::fs::write(path, text).unwrap();
            }
        }
    }
}

#[test]
fn readme_is_short_and_links_to_what_is_there() {
    let readme = std::fs::read_to_string(root().join("README.md")).unwrap();
    let words = readme.split_whitespace().count();
    assert!(words <= WORDS, "README.md has {words} words, {WORDS} at most: move a part to src/guide/");
    let mut linked = BTreeSet::new();
    for (_, behind) in readme.match_indices("](").map(|(at, _)| readme.split_at(at + 2)) {
        let target = behind.split(')').next().unwrap();
        if target.starts_with("http") {
            continue;
        }
        assert!(root().join(target).exists(), "README.md links to {target}, which is not there");
        linked
            .extend(target.strip_prefix("src/guide/").and_then(|t| t.strip_suffix(".md")).map(str::to_owned));
    }
    let topics: BTreeSet<String> = TOPICS.iter().map(|t| t.id.to_owned()).collect();
    assert_eq!(linked, topics, "README.md links to every page of the guide, and to no other");
    assert!(readme.contains("cargo run --release -- bake\n"), "the main command");
}

#[test]
fn every_page_is_listed_and_can_be_read_in_a_terminal() {
    let files: BTreeSet<String> = std::fs::read_dir(root().join("src/guide"))
        .unwrap()
        .filter_map(|f| f.unwrap().file_name().to_str().unwrap().strip_suffix(".md").map(str::to_owned))
        .collect();
    let topics: BTreeSet<String> = TOPICS.iter().map(|t| t.id.to_owned()).collect();
    assert_eq!(files, topics, "files of src/guide/ and lines of `topics!` in src/guide/mod.rs");
    for topic in TOPICS {
        assert!(
            topic.text.starts_with("# ") && topic.title().contains(": "),
            "{}: starts `# Topic: what of it`",
            topic.id
        );
        assert!(recipe::engine(topic.id).is_none(), "{} is an engine too", topic.id);
        let text = plain(topic.text);
        assert!(!text.contains("<!--") && !text.contains("```"), "{}: marks are left", topic.id);
        let code: Vec<String> = topic.text.lines().map(|l| format!("    {l}")).collect();
        for line in text.lines().filter(|l| l.chars().count() > LINE) {
            assert!(
                code.iter().any(|c| c == line),
                "{}: a printed line is longer than {LINE}: {line}",
                topic.id
            );
        }
    }
}

/// The code blocks of a language, with the page that they stand in.
fn blocks(language: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    for (path, text) in pages() {
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        for block in text.split(&format!("```{language}\n")).skip(1) {
            found.push((name.clone(), block.split("\n```").next().unwrap().to_owned()));
        }
    }
    found
}

/// Lines of `sh` blocks that run this program, without their comments.
fn commands() -> Vec<(String, Vec<String>)> {
    let mut found = Vec::new();
    for (page, block) in blocks("sh") {
        for line in block.lines().filter(|l| l.starts_with("brdfbake ")) {
            let line = line.split(" # ").next().unwrap();
            found.push((page.clone(), line.split_whitespace().map(str::to_owned).collect()));
        }
    }
    found
}

#[test]
fn recipes_of_the_pages_are_recipes() {
    let mut count = 0;
    for (page, block) in blocks("toml") {
        if block.contains("[[table]]") {
            recipe::parse(&block, &page).unwrap_or_else(|e| panic!("{page}: {e}"));
            count += 1;
        } else {
            block.parse::<toml::Table>().unwrap_or_else(|e| panic!("{page}: {e}\n{block}"));
        }
    }
    assert!(count >= 3, "{count} recipes");
}

#[test]
fn commands_of_the_pages_are_understood_and_every_verb_has_one() {
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    for (page, words) in commands() {
        if let Err(e) = Cli::try_parse_from(&words) {
            panic!("{page}: {}\n{e}", words.join(" "));
        }
        *seen.entry(words[1].clone()).or_default() += 1;
    }
    let page = &TOPICS.iter().find(|t| t.id == "command").unwrap().text;
    for verb in Cli::command().get_subcommands().map(|c| c.get_name().to_owned()).filter(|n| n != "help") {
        assert!(seen.contains_key(&verb), "no page has an example of `{verb}`");
        assert!(page.contains(&format!("\n| `{verb}` |")), "src/guide/command.md has no row for `{verb}`");
    }
}

/// The arguments with which an example is tried here; none for those that are slow or name files of the reader's.
fn cheap(words: &[String], out: &Path) -> Option<Vec<String>> {
    let mut args = words[1..].to_vec();
    let is_there =
        |a: &String| !a.contains(['/', '.']) || root().join(a).exists() || a.parse::<f64>().is_ok();
    if let Some(at) = args.iter().position(|a| a == "-o") {
        let file = out.join(Path::new(&args[at + 1]).file_name().unwrap());
        args[at + 1] = file.to_str().unwrap().to_owned();
    }
    match args[0].as_str() {
        "bake" if args.iter().any(|a| a == "--suggest") => None,
        "bake" => {
            args.push("--dry-run".to_owned());
            args.iter().all(|a| is_there(a) || a.starts_with(out.to_str().unwrap())).then_some(args)
        }
        "inspect" => args[1..].iter().all(|a| root().join(a).exists()).then_some(args),
        "albedo" | "plot" | "list" | "describe" | "guide" => Some(args),
        _ => None,
    }
}

#[test]
fn cheap_commands_of_the_pages_run() {
    let out = tempfile::tempdir().unwrap();
    let mut ran = BTreeSet::new();
    for (page, words) in commands() {
        let Some(args) = cheap(&words, out.path()) else { continue };
        let done =
            Command::new(env!("CARGO_BIN_EXE_brdfbake")).args(&args).current_dir(root()).output().unwrap();
        let message = String::from_utf8_lossy(&done.stderr);
        assert!(done.status.success(), "{page}: {}\n{message}", words.join(" "));
        ran.insert(args[0].clone());
    }
    let expected = ["albedo", "bake", "describe", "guide", "inspect", "list", "plot"];
    assert_eq!(ran, expected.map(str::to_owned).into(), "a verb lost the example that was tried");
}

#[test]
fn the_guide_is_printed() {
    let guide = |args: &[&str]| {
        let done = Command::new(env!("CARGO_BIN_EXE_brdfbake")).arg("guide").args(args).output().unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        (done.status.code().unwrap(), text(done.stdout), text(done.stderr))
    };
    let (code, list, _) = guide(&[]);
    assert_eq!(code, 0);
    for id in TOPICS.iter().map(|t| t.id).chain(ENGINES.iter().map(|e| e.id)) {
        assert!(list.lines().any(|l| l.split_whitespace().next() == Some(id)), "`guide` does not list {id}");
    }
    let (code, page, _) = guide(&["axes"]);
    assert!(code == 0 && page.starts_with("Axes: ") && !page.contains("**"), "{page}");
    let (code, page, _) = guide(&["three"]);
    assert!(code == 0 && page.contains("DFGLUTData.js") && page.contains("getDFGLUT()"), "{page}");
    for (wrong, hint) in
        [("axis", "did you mean `axes`?"), ("thre", "did you mean `three`?"), ("zzzzzz", "lists them")]
    {
        let (code, page, message) = guide(&[wrong]);
        assert!(code == 2 && page.is_empty() && message.contains(hint), "{wrong}: {code} {message}");
    }
}
