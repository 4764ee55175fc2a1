//! The outputs of a table: which container, storage and options, and whether they can hold it.

use super::document::Entry;
use super::fault::{Fault, Faults};
use super::section::unknown_word;
use super::{Format, Stored, TOLERANCE, formats};
use crate::encode::{self, EncodeError, FileOption, Shape, Storage};
use crate::tables::{Bound, ChannelInfo};

/// A file to write.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Output {
    /// Container id: `exr`.
    pub container: String,
    /// Storage id: `half`.
    pub storage: String,
    /// Words of its options: `rgba`, `zstd`. In a plan: each once, in the order of
    /// [`FILE_OPTIONS`](crate::encode::FILE_OPTIONS).
    pub options: Vec<String>,
}

impl Output {
    /// An output without options.
    #[must_use]
    pub fn new(container: &str, storage: &str) -> Output {
        Output { container: container.to_owned(), storage: storage.to_owned(), options: Vec::new() }
    }

    /// The options; unknown words are left out.
    #[must_use]
    pub fn file_options(&self) -> Vec<FileOption> {
        self.options.iter().filter_map(|o| FileOption::find(o)).collect()
    }
}

/// `ktx2:half+rgba+zstd`.
impl std::fmt::Display for Output {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}:{}", self.container, self.storage)?;
        self.options.iter().try_for_each(|o| write!(f, "+{o}"))
    }
}

/// What a table is written to if its recipe does not say.
pub(super) fn default() -> Output {
    Output::new("exr", "half")
}

/// The outputs, and the storage of each as it was listed; none where it is not known.
pub(super) fn resolve(entry: &Entry, faults: &mut Faults) -> (Vec<Output>, Vec<Option<&'static Stored>>) {
    let Some(listed) = &entry.outputs else {
        let output = default();
        let stored = format(&output.container).and_then(|f| storage(f, &output.storage));
        return (vec![output], vec![stored]);
    };
    let path = format!("{}.outputs", entry.path);
    if listed.is_empty() {
        faults.value(path.clone(), Fault::Count { key: "outputs", got: 0, allowed: "1 or more".to_owned() });
    }
    let mut known = Vec::new();
    let mut stored = Vec::new();
    for (i, output) in listed.iter().enumerate() {
        let found = output.as_ref().and_then(|output| match check_output(output, &known) {
            Ok((output, stored)) => {
                known.push(output);
                Some(stored)
            }
            Err(fault) => {
                faults.value(format!("{path}[{i}]"), fault);
                None
            }
        });
        stored.push(found);
    }
    (known, stored)
}

/// The output with its options in order, and its storage.
fn check_output(output: &Output, before: &[Output]) -> Result<(Output, &'static Stored), Fault> {
    let Output { container, storage: id, .. } = output;
    let found = format(container)
        .ok_or_else(|| unknown_word("container", container, formats().iter().map(|f| f.container)))?;
    let stored = storage(found, id).ok_or_else(|| {
        unknown_word(&format!("{container} storage"), id, found.storages.iter().map(|s| s.id))
    })?;
    let offered = encode::encoder(container).map_or(&[][..], |e| e.options());
    if offered.is_empty() && !output.options.is_empty() {
        let why = format!("{container} takes no options");
        return Err(Fault::Container { why, remedy: "leave them out" });
    }
    let mut options = Vec::new();
    for word in &output.options {
        let option = offered.iter().find(|o| o.id() == word).ok_or_else(|| {
            unknown_word(&format!("{container} option"), word, offered.iter().map(|o| o.id()))
        })?;
        options.push(*option);
    }
    options.sort();
    options.dedup();
    if before.iter().any(|o| o.container == *container && o.storage == *id) {
        let why = "both would write the same file".to_owned();
        return Err(Fault::Twice { what: "output", got: format!("{container}:{id}"), why });
    }
    let options = options.iter().map(|o| o.id().to_owned()).collect();
    Ok((Output { options, ..output.clone() }, stored))
}

/// A container must be able to hold a table of this shape: channels, axes, options.
fn check_shapes(entry: &Entry, bound: &Bound, faults: &mut Faults) {
    for (i, output) in entry.outputs.iter().flatten().enumerate() {
        let known = output.as_ref().and_then(|o| {
            let options = o.file_options();
            let all = options.len() == o.options.len();
            all.then_some((encode::encoder(&o.container)?, Storage::find(&o.storage)?, options))
        });
        let Some((encoder, storage, options)) = known else { continue };
        let channels = bound.spec.layout.channels.len();
        let shape = Shape { grid: &bound.spec.grid, channels, storage, options: &options };
        let offered =
            encoder.storages().contains(&storage) && options.iter().all(|o| encoder.options().contains(o));
        if offered && let Err(error) = shape.check(encoder) {
            let remedy = match error {
                EncodeError::Conflict { .. } => "leave one of them out",
                _ => "take another container, storage or layout",
            };
            let fault = Fault::Container { why: error.to_string(), remedy };
            faults.value(format!("{}.outputs[{i}]", entry.path), fault);
        }
    }
}

fn format(container: &str) -> Option<&'static Format> {
    formats().iter().find(|f| f.container == container)
}

fn storage(format: &'static Format, id: &str) -> Option<&'static Stored> {
    format.storages.iter().find(|s| s.id == id)
}

/// Checks what depends on the table: its channels, their ranges, its axes.
pub(super) fn check(entry: &Entry, bound: &Bound, stored: &[Option<&'static Stored>], faults: &mut Faults) {
    check_storable(entry, bound, stored, faults);
    check_shapes(entry, bound, faults);
}

/// A table that names its file has one output; text round the numbers needs a file that is nothing but numbers.
pub(super) fn check_file(entry: &Entry, outputs: &[Output], faults: &mut Faults) {
    let fault = |why: String, remedy| Fault::Container { why, remedy };
    if entry.file.is_some() && outputs.len() > 1 {
        let why = format!("`file` names one file, and the table has {} outputs", outputs.len());
        faults.value(format!("{}.file", entry.path), fault(why, "leave one output, or leave `file` out"));
    }
    for (key, text) in ["before", "after"].into_iter().zip(&entry.around) {
        let bare = |o: &Output| encode::encoder(&o.container).is_some_and(|e| e.is_bare());
        if text.is_some()
            && let Some(output) = outputs.iter().find(|o| !bare(o))
        {
            let why = format!("{} has no place for `{key}`", output.container);
            faults.value(format!("{}.{key}", entry.path), fault(why, "take the container text or raw"));
        }
    }
}

/// A storage that spreads its steps over the range of a channel must have a step that is of use.
fn check_storable(entry: &Entry, bound: &Bound, stored: &[Option<&'static Stored>], faults: &mut Faults) {
    for (i, stored) in stored.iter().enumerate() {
        let Some(stored) = stored.filter(|s| s.bounded) else { continue };
        let half_step = |c: &&ChannelInfo| stored.half_step * (c.range[1] - c.range[0]);
        let wide = |c: &&ChannelInfo| half_step(c).is_nan() || half_step(c) > TOLERANCE[1];
        if let Some(channel) = bound.spec.layout.channels.iter().find(wide) {
            let fault = Fault::WideRange { storage: stored.id, channel: channel.id, range: channel.range };
            faults.value(format!("{}.outputs[{i}]", entry.path), fault);
        }
    }
}
