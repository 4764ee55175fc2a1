//! The file as it is written: every key read and of the right type, into requests. What they mean is judged by the plan.
//!
//! What cannot be read is a fault here, and a hole in the request. Lists are then shorter in the request than in the file, so
//! [`Origins`] leads from a place in the requests back to the one in the file.

use super::keys::{ROOT, TABLE, WAIVE};
use super::section::{Section, wrong};
use super::{index_file, read_axis, read_map, read_size};
use crate::grid::Axis;
use crate::grid::fit::Texels;
use crate::grid::provenance::Waiver;
use crate::math::shown::show;
use crate::models::Kind;
use crate::plan::fault::{Fault, unknown_word};
use crate::plan::faults::Faults;
use crate::plan::map::MapDraft;
use crate::plan::request::{Draft, Holes};
use crate::plan::resolve::check_count;
use crate::plan::{MAX_TABLES, Output, Part, Path, Place, Sizing, Step, TableRequest};
use crate::tables::driver::OnMiss;
use crate::tables::metal::NK_COLUMNS;
use crate::tables::spec::Request;
use serde_json::{Map, Value as Json};
use std::path::Path as File;
use toml::de::DeTable;

/// A recipe before it is resolved. A value that could not be read is missing here, or a hole in its request, and its fault is in the list.
#[derive(Debug, Default)]
pub(super) struct Document {
    pub(super) name: Option<String>,
    pub(super) tolerance: Option<f64>,
    pub(super) drafts: Vec<Draft>,
    pub(super) maps: Vec<MapDraft>,
    pub(super) origins: Origins,
}

/// Where the requests come from, one each.
#[derive(Debug, Default)]
pub(super) struct Origins {
    tables: Vec<Origin>,
    maps: Vec<Path>,
}

#[derive(Debug)]
enum Origin {
    /// A table of this file.
    Table {
        path: Path,
        /// For each list that may have lost entries: the number in the file of those that are left.
        lists: Vec<(&'static str, Vec<usize>)>,
    },
    /// A table of the engine that the file names: whatever is wrong with it is wrong with that key.
    Engine,
}

impl Origins {
    /// The place in the file of a place in the requests.
    pub(super) fn locate(&self, place: Place) -> Place {
        let [Step::Key(key), Step::Index(unit), rest @ ..] = place.path.steps() else { return place };
        if let Some(path) = self.maps.get(*unit).filter(|_| key == "map") {
            let path = rest.iter().fold(path.clone(), |path, step| path.then(step.clone()));
            return Place { path, part: place.part };
        }
        let Some(origin) = self.tables.get(*unit).filter(|_| key == "table") else { return place };
        let Origin::Table { path, lists } = origin else {
            return Place { path: Path::root().key("engine"), part: Part::Value };
        };
        let mut path = path.clone();
        let mut list: Option<&Vec<usize>> = None;
        for (depth, step) in rest.iter().enumerate() {
            let step = match (step, list.take()) {
                (Step::Index(i), Some(numbers)) => Step::Index(numbers.get(*i).copied().unwrap_or(*i)),
                (step, _) => step.clone(),
            };
            if let (0, Step::Key(key)) = (depth, &step) {
                list = lists.iter().find(|(name, _)| name == key).map(|(_, numbers)| numbers);
            }
            path = path.then(step);
        }
        Place { path, part: place.part }
    }
}

/// Reads the keys of a file. The images of its maps lie in `folder`.
pub(super) fn read(root: &DeTable<'_>, folder: &File, faults: &mut Faults) -> Document {
    let section = Section::new(root, &Path::root(), &ROOT, faults);
    let mut document = Document {
        name: section.text("name", faults),
        tolerance: section.number("tolerance", faults),
        ..Document::default()
    };
    if let Some(id) = section.text("engine", faults) {
        document.drafts = engine(&id, faults);
        document.origins.tables.extend(document.drafts.iter().map(|_| Origin::Engine));
    }
    let maps = section.tables("map", "[[map]]", faults).unwrap_or_default();
    let tables = section.tables("table", "[[table]]", faults);
    if tables.is_some() || section.get("map").is_some() {
        let others = maps.len() + usize::from(tables.is_none()) * document.drafts.len();
        check_count([tables.as_ref().map_or(0, Vec::len), others], faults);
    }
    for (path, map) in maps.into_iter().take(MAX_TABLES) {
        document.maps.push(read_map::read(map, &path, folder, faults));
        document.origins.maps.push(path);
    }
    for (path, table) in tables.into_iter().flatten().take(MAX_TABLES) {
        let (draft, origin) = entry(table, path, folder, faults);
        document.drafts.push(draft);
        document.origins.tables.push(origin);
    }
    document
}

/// The tables of an engine; what is wrong with them is wrong with the key `engine`.
fn engine(id: &str, faults: &mut Faults) -> Vec<Draft> {
    let path = Path::root().key("engine");
    if super::ENGINES.is_empty() {
        faults.value(path, Fault::without(&format!("engine {}", show(id)), "engines"));
        return Vec::new();
    }
    let Some(found) = super::engine(id) else {
        faults.value(path, unknown_word("engine", id, super::ENGINES.iter().map(|e| e.id)));
        return Vec::new();
    };
    let (root, _) = DeTable::parse_recoverable(found.recipe);
    let mut inner = Faults::default();
    let drafts = read(root.get_ref(), File::new(""), &mut inner).drafts;
    for (_, fault) in inner.list {
        faults.value(path.clone(), fault);
    }
    drafts
}

/// Entries of a list that could be read, each with its number in the file.
type Numbered<T> = Vec<(usize, Option<T>)>;

/// What is left of a list, and the number of each entry in the file; with how many were lost.
fn left<T>(list: Numbered<T>) -> (Vec<usize>, Vec<T>, usize) {
    let all = list.len();
    let (numbers, entries): (Vec<usize>, Vec<T>) =
        list.into_iter().filter_map(|(i, item)| Some((i, item?))).unzip();
    let lost = all - numbers.len();
    (numbers, entries, lost)
}

/// The number of a list's entry, by its path.
fn number(path: &Path) -> usize {
    match path.steps().last() {
        Some(Step::Index(i)) => *i,
        _ => 0,
    }
}

fn entry(table: &DeTable<'_>, path: Path, folder: &File, faults: &mut Faults) -> (Draft, Origin) {
    let section = Section::new(table, &path, &TABLE, faults);
    let (name, kind) = (section.text("name", faults), section.text("kind", faults));
    let mut size = read_size::read(&section, faults);
    let mut holes = Holes { name: name.is_none(), kind: kind.is_none(), ..Holes::default() };
    let mut lists = Vec::new();
    let mut kept = |key: &'static str, numbers: Vec<usize>| lists.push((key, numbers));
    let axes = axes(&section, size.as_mut(), faults).map(|list| {
        let (numbers, axes, lost) = left(list);
        holes.axes = lost > 0;
        kept("axis", numbers);
        axes
    });
    let outputs = outputs(&section, faults).map(|list| {
        let (numbers, outputs, lost) = left(list);
        holes.outputs = lost > 0;
        kept("outputs", numbers);
        outputs
    });
    let channels = channels(&section, faults).map(|list| {
        let (numbers, channels, _) = left(list);
        kept("channels", numbers);
        channels
    });
    let (numbers, waivers, _) = left(waivers(&section, faults));
    kept("waive", numbers);
    let mut params = params(&section, faults);
    files(&mut params, kind.as_deref(), folder, &section, faults);
    let request = TableRequest {
        name: name.unwrap_or_default(),
        file: section.text("file", faults),
        before: section.long_text("before", faults),
        after: section.long_text("after", faults),
        request: Request {
            kind: kind.unwrap_or_default(),
            layout: section.text("layout", faults),
            channels,
            model: section.text("model", faults),
            params,
            axes,
        },
        tolerance: section.number("tolerance", faults),
        outputs,
        on_miss: section.word("on-miss", &OnMiss::ALL.map(|m| (m.id(), m)), faults).unwrap_or_default(),
        reconstruction: section.word("reconstruction", &[("on", true), ("off", false)], faults),
        texels: section.word("texels", &Texels::ALL.map(|t| (t.id(), t)), faults).unwrap_or_default(),
        waivers,
        size,
    };
    (Draft { request, holes }, Origin::Table { path, lists })
}

/// The axes; those without a length are noted in `size`.
fn axes(section: &Section<'_>, size: Option<&mut Sizing>, faults: &mut Faults) -> Option<Numbered<Axis>> {
    let tables = section.tables("axis", "[[table.axis]]", faults)?;
    let open = |table: &&DeTable<'_>| size.is_some() && !table.contains_key("length");
    let searched: Vec<usize> = (0..tables.len()).filter(|i| open(&tables[*i].1)).collect();
    let axes = tables
        .into_iter()
        .enumerate()
        .map(|(i, (path, axis))| (number(&path), read_axis::read(axis, &path, searched.contains(&i), faults)))
        .collect();
    if let Some(size) = size {
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
                section.path("params").key(key.get_ref()),
                wrong(&show(key.get_ref()), value.get_ref(), "a finite number or a word"),
            ),
        }
    }
    params
}

/// Rows of an index in the place of the name of their file.
fn files(
    params: &mut Map<String, Json>,
    kind: Option<&str>,
    folder: &File,
    section: &Section<'_>,
    faults: &mut Faults,
) {
    let declared = kind.and_then(crate::tables::find).map_or(&[][..], |kind| kind.params);
    for param in declared {
        let index = matches!(param.kind, Kind::Rows { columns, .. } if columns == NK_COLUMNS);
        let Some(file) = params.get(param.id).and_then(Json::as_str).filter(|_| index) else { continue };
        match index_file::load(&folder.join(file)) {
            Ok(rows) => {
                params.insert(param.id.to_owned(), rows.iter().map(|r| Json::from(r.as_slice())).collect());
            }
            Err(index_file::Reason { why, io }) => {
                let fault = Fault::Index { file: file.to_owned(), why, io };
                faults.value(section.path("params").key(param.id), fault);
                params.remove(param.id);
            }
        }
    }
}

fn channels(section: &Section<'_>, faults: &mut Faults) -> Option<Numbered<String>> {
    let list = section.list("channels", "a list, such as [\"dfg.scale\", \"dfg.f82\"]", faults)?;
    let mut channels = Vec::new();
    // a list far too long is refused by its length alone
    for (i, item) in list.iter().enumerate().take(64) {
        let channel = item.get_ref().as_str().map(str::to_owned);
        if channel.is_none() {
            let fault = wrong(&format!("channels[{i}]"), item.get_ref(), "a word in quotes");
            faults.value(section.path("channels").index(i), fault);
        }
        channels.push((i, channel));
    }
    Some(channels)
}

fn outputs(section: &Section<'_>, faults: &mut Faults) -> Option<Numbered<Output>> {
    let list = section.list("outputs", "a list, such as [\"exr:half\"]", faults)?;
    if list.is_empty() || list.len() > 64 {
        let allowed = "1 to 64".to_owned();
        faults.value(section.path("outputs"), Fault::Count { key: "outputs", got: list.len(), allowed });
        return Some(vec![(0, None)]);
    }
    let mut outputs = Vec::new();
    for (i, item) in list.iter().enumerate() {
        let output = match item.get_ref().as_str() {
            Some(text) => Output::parse(text),
            None => Err(wrong(&format!("outputs[{i}]"), item.get_ref(), "a string, such as \"exr:half\"")),
        };
        let output = output.map_err(|fault| faults.value(section.path("outputs").index(i), fault));
        outputs.push((i, output.ok()));
    }
    Some(outputs)
}

fn waivers(section: &Section<'_>, faults: &mut Faults) -> Numbered<Waiver> {
    let expected = "a list, such as [{ law = \"energy\", reason = \"...\" }]";
    let mut waivers = Vec::new();
    for (path, table) in section.tables("waive", expected, faults).unwrap_or_default() {
        let waiver = Section::new(table, &path, &WAIVE, faults);
        let (law, reason) = (waiver.text("law", faults), waiver.text("reason", faults));
        waivers.push((number(&path), law.zip(reason).map(|(law, reason)| Waiver { law, reason })));
    }
    waivers
}
