//! The file as it is written: every key read and of the right type, nothing looked up yet but quantities.

use super::fault::{Fault, Faults};
use super::outputs::Output;
use super::read_axis;
use super::section::{Section, unknown_word, wrong};
use super::sizing::{self, Sizing};
use super::{MAX_TABLES, formats};
use crate::grid::Axis;
use crate::grid::fit::Texels;
use crate::grid::provenance::Waiver;
use crate::tables::driver::OnMiss;
use serde_json::{Map, Value as Json};
use toml::de::DeTable;

const ROOT: &[&str] = &["name", "tolerance", "engine", "table"];
const TABLE: &[&str] = &[
    "kind",
    "name",
    "file",
    "before",
    "after",
    "layout",
    "channels",
    "model",
    "params",
    "tolerance",
    "outputs",
    "on-miss",
    "reconstruction",
    "size",
    "texels",
    "waive",
    "axis",
];

/// A recipe before it is resolved. What could not be read is none, and a fault has been reported for it.
#[derive(Debug, Default)]
pub(super) struct Document {
    pub(super) name: Option<String>,
    pub(super) tolerance: Option<f64>,
    pub(super) tables: Vec<Entry>,
}

/// A table of a recipe before it is resolved.
#[derive(Debug, Default)]
pub(super) struct Entry {
    /// `table[0]`.
    pub(super) path: String,
    pub(super) name: Option<String>,
    /// Name of its one file, instead of the one made from `name`.
    pub(super) file: Option<String>,
    /// Text before and behind the numbers of that file.
    pub(super) around: [Option<String>; 2],
    pub(super) kind: Option<String>,
    pub(super) layout: Option<String>,
    /// A channel that could not be read is none.
    pub(super) channels: Option<Vec<Option<String>>>,
    pub(super) model: Option<String>,
    pub(super) params: Map<String, Json>,
    pub(super) tolerance: Option<f64>,
    pub(super) outputs: Option<Vec<Option<Output>>>,
    pub(super) on_miss: OnMiss,
    /// None: as the kind is read.
    pub(super) reconstruction: Option<bool>,
    /// Axes without a length are searched.
    pub(super) size: Option<Sizing>,
    pub(super) texels: Texels,
    pub(super) waivers: Vec<Option<Waiver>>,
    /// None: the kind's own. An axis that could not be read is none.
    pub(super) axes: Option<Vec<Option<Axis>>>,
}

/// Reads the keys of a file.
pub(super) fn read(root: &DeTable<'_>, faults: &mut Faults) -> Document {
    let section = Section::new(root, "", "the recipe", ROOT, faults);
    section.require("name", "name = \"my-tables\"", faults);
    if section.get("engine").is_none() {
        section.require("table", "[[table]]", faults);
    }
    let mut document = Document {
        name: section.text("name", faults),
        tolerance: section.number("tolerance", faults),
        tables: Vec::new(),
    };
    if let Some(id) = section.text("engine", faults) {
        document.tables = engine(&id, faults);
    }
    let Some(tables) = section.tables("table", "[[table]]", faults) else { return document };
    if tables.is_empty() || tables.len() > MAX_TABLES {
        let allowed = format!("1 to {MAX_TABLES}");
        faults.key("table", Fault::Count { key: "table", got: tables.len(), allowed });
    }
    for (path, table) in tables.into_iter().take(MAX_TABLES) {
        document.tables.push(entry(table, path, faults));
    }
    document
}

/// The tables of an engine; what is wrong with them is wrong with the key `engine`.
fn engine(id: &str, faults: &mut Faults) -> Vec<Entry> {
    let Some(found) = super::engine(id) else {
        faults.value("engine", unknown_word("engine", id, super::ENGINES.iter().map(|e| e.id)));
        return Vec::new();
    };
    let (root, _) = DeTable::parse_recoverable(found.recipe);
    let mut inner = Faults::default();
    let tables = read(root.get_ref(), &mut inner).tables;
    for (_, fault) in inner.list {
        faults.value("engine", fault);
    }
    tables.into_iter().map(|entry| Entry { path: "engine".to_owned(), ..entry }).collect()
}

fn entry(table: &DeTable<'_>, path: String, faults: &mut Faults) -> Entry {
    let section = Section::new(table, &path, "[[table]]", TABLE, faults);
    section.require("kind", "kind = \"dfg\"", faults);
    section.require("name", "name = \"ggx-dfg\"", faults);
    let on_miss = section.word("on-miss", &[("fail", OnMiss::Fail), ("report", OnMiss::Report)], faults);
    let mut size = sizing::read(&section, faults);
    let axes = axes(&section, size.as_mut(), faults);
    let texels = section.word("texels", &Texels::ALL.map(|t| (t.id(), t)), faults).unwrap_or_default();
    Entry {
        name: section.text("name", faults),
        file: section.text("file", faults),
        around: ["before", "after"].map(|key| section.long_text(key, faults)),
        kind: section.text("kind", faults),
        layout: section.text("layout", faults),
        channels: channels(&section, faults),
        model: section.text("model", faults),
        params: params(&section, faults),
        tolerance: section.number("tolerance", faults),
        outputs: outputs(&section, faults),
        on_miss: on_miss.unwrap_or_default(),
        reconstruction: section.word("reconstruction", &[("on", true), ("off", false)], faults),
        waivers: waivers(&section, faults),
        size,
        texels,
        axes,
        path,
    }
}

/// The axes; those without a length are noted in `size`.
fn axes(section: &Section<'_>, size: Option<&mut Sizing>, faults: &mut Faults) -> Option<Vec<Option<Axis>>> {
    let tables = section.tables("axis", "[[table.axis]]", faults)?;
    let open = |table: &&DeTable<'_>| size.is_some() && !table.contains_key("length");
    let searched: Vec<usize> = (0..tables.len()).filter(|i| open(&tables[*i].1)).collect();
    let axes = tables
        .into_iter()
        .enumerate()
        .map(|(i, (path, axis))| read_axis::read(axis, &path, searched.contains(&i), faults))
        .collect();
    if let Some(size) = size {
        if searched.is_empty() {
            faults.value(section.path("size"), Fault::NothingToSize);
        }
        size.axes = searched;
    }
    Some(axes)
}

fn params(section: &Section<'_>, faults: &mut Faults) -> Map<String, Json> {
    let mut params = Map::new();
    let Some(value) = section.get("params") else { return params };
    let Some(table) = value.as_table() else {
        faults.value(section.path("params"), wrong("params", value, "a table, such as { f0 = 0.04 }"));
        return params;
    };
    for (key, value) in table {
        match read_axis::param(value.get_ref()) {
            Some(json) => drop(params.insert(key.get_ref().to_string(), json)),
            None => faults.value(
                super::span::join(&section.path("params"), key.get_ref()),
                wrong(&super::fault::show(key.get_ref()), value.get_ref(), "a finite number or a word"),
            ),
        }
    }
    params
}

fn channels(section: &Section<'_>, faults: &mut Faults) -> Option<Vec<Option<String>>> {
    let list = section.list("channels", "a list, such as [\"dfg.scale\", \"dfg.f82\"]", faults)?;
    let mut channels = Vec::new();
    // a list far too long is refused by its length alone
    for (i, item) in list.iter().enumerate().take(64) {
        let channel = item.get_ref().as_str().map(str::to_owned);
        if channel.is_none() {
            let fault = wrong(&format!("channels[{i}]"), item.get_ref(), "a word in quotes");
            faults.value(format!("{}[{i}]", section.path("channels")), fault);
        }
        channels.push(channel);
    }
    Some(channels)
}

fn outputs(section: &Section<'_>, faults: &mut Faults) -> Option<Vec<Option<Output>>> {
    let list = section.list("outputs", "a list, such as [\"exr:half\"]", faults)?;
    if list.is_empty() || list.len() > 64 {
        let allowed = "1 to 64".to_owned();
        faults.value(section.path("outputs"), Fault::Count { key: "outputs", got: list.len(), allowed });
        return Some(vec![None]);
    }
    let mut outputs = Vec::new();
    for (i, item) in list.iter().enumerate() {
        let path = format!("{}[{i}]", section.path("outputs"));
        let output = item.get_ref().as_str().and_then(|text| text.split_once(':'));
        if output.is_none() {
            let fault = match item.get_ref().as_str() {
                Some(got) => Fault::OutputForm { got: super::fault::show(got), allowed: containers() },
                None => wrong(&format!("outputs[{i}]"), item.get_ref(), "a string, such as \"exr:half\""),
            };
            faults.value(path, fault);
        }
        outputs.push(output.map(|(container, rest)| {
            let mut words = rest.split('+').map(|w| w.trim().to_owned());
            let storage = words.next().unwrap_or_default();
            Output { container: container.to_owned(), storage, options: words.collect() }
        }));
    }
    Some(outputs)
}

/// `exr, ktx2, ...`.
fn containers() -> String {
    formats().iter().map(|f| f.container).collect::<Vec<_>>().join(", ")
}

fn waivers(section: &Section<'_>, faults: &mut Faults) -> Vec<Option<Waiver>> {
    let expected = "a list, such as [{ law = \"energy\", reason = \"...\" }]";
    let mut waivers = Vec::new();
    for (path, table) in section.tables("waive", expected, faults).unwrap_or_default() {
        let waiver = Section::new(table, &path, "waive", &["law", "reason"], faults);
        waiver.require("law", "law = \"energy\"", faults);
        waiver.require("reason", "reason = \"why this table may break it\"", faults);
        let (law, reason) = (waiver.text("law", faults), waiver.text("reason", faults));
        waivers.push(law.zip(reason).map(|(law, reason)| Waiver { law, reason: reason.trim().to_owned() }));
    }
    waivers
}
