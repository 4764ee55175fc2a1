//! The outputs of a table: container, storage and options, and whether they can hold it.

use super::TOLERANCE;
use super::fault::{Fault, unknown_word};
use super::faults::Faults;
use super::place::Path;
use super::request::{Draft, TableRequest};
use crate::encode::{self, ENCODERS, EncodeError, Encoder, FileOption, Shape, Storage};
use crate::grid::Grid;
use crate::math::shown::show;
use crate::tables::{Bound, ChannelInfo};
use serde::{Serialize, Serializer};

/// A file to write. `Display` writes it as recipes do: `ktx2:half+rgba+zstd`.
#[derive(Debug, Clone)]
pub struct Output {
    /// The container.
    pub encoder: &'static dyn Encoder,
    /// How a number is stored: one of [`Encoder::storages`].
    pub storage: Storage,
    /// Options of the container, each once, in the order of [`FILE_OPTIONS`](crate::encode::FILE_OPTIONS).
    pub options: Vec<FileOption>,
}

impl Output {
    /// An output without options.
    #[must_use]
    pub fn new(encoder: &'static dyn Encoder, storage: Storage) -> Output {
        Output { encoder, storage, options: Vec::new() }
    }

    /// What a table is written to if nothing is said.
    #[must_use]
    pub fn preset() -> Output {
        Output::new(&encode::exr::Exr, Storage::Half)
    }

    /// Reads `container:storage`, with `+option` behind it or not.
    ///
    /// # Errors
    /// [`Fault`] for a container that there is not, a storage or an option that it does not have, or another form.
    pub fn parse(text: &str) -> Result<Output, Fault> {
        let Some((container, rest)) = text.split_once(':') else {
            let allowed = ENCODERS.iter().map(|e| e.id()).collect::<Vec<_>>().join(", ");
            return Err(Fault::OutputForm { got: show(text), allowed });
        };
        let mut words = rest.split('+').map(str::trim);
        let id = words.next().unwrap_or_default();
        let encoder = encode::encoder(container)
            .ok_or_else(|| unknown_word("container", container, ENCODERS.iter().map(|e| e.id())))?;
        let storage = encoder.storages().iter().find(|s| s.id() == id).ok_or_else(|| {
            unknown_word(&format!("{container} storage"), id, encoder.storages().iter().map(|s| s.id()))
        })?;
        if !storage.is_written() {
            return Err(Fault::without(&format!("storage `{id}`"), "blocks"));
        }
        let mut output = Output::new(encoder, *storage);
        let offered = encoder.options();
        for word in words {
            if word == FileOption::Zstd.id() && container == "ktx2" && !cfg!(feature = "zstd") {
                return Err(Fault::without("option `zstd`", "zstd"));
            }
            if offered.is_empty() {
                let why = format!("{container} takes no options");
                return Err(Fault::Container { why, remedy: "leave them out" });
            }
            let option = offered.iter().find(|o| o.id() == word).ok_or_else(|| {
                unknown_word(&format!("{container} option"), word, offered.iter().map(|o| o.id()))
            })?;
            output.options.push(*option);
        }
        Ok(output.ordered())
    }

    /// The output with a further option.
    #[must_use]
    pub fn with(mut self, option: FileOption) -> Output {
        self.options.push(option);
        self.ordered()
    }

    /// What the container has to hold.
    #[must_use]
    pub fn shape<'a>(&'a self, grid: &'a Grid, channels: usize) -> Shape<'a> {
        Shape { grid, channels, storage: self.storage, options: &self.options }
    }

    /// Would both write a file of the same name?
    #[must_use]
    pub fn clashes(&self, other: &Output) -> bool {
        self.is_in(other) && self.storage == other.storage
    }

    /// Are both in the same container?
    #[must_use]
    pub fn is_in(&self, other: &Output) -> bool {
        self.encoder.id() == other.encoder.id()
    }

    fn ordered(mut self) -> Output {
        self.options.sort();
        self.options.dedup();
        self
    }
}

impl PartialEq for Output {
    fn eq(&self, other: &Output) -> bool {
        self.clashes(other) && self.options == other.options
    }
}

impl Eq for Output {}

impl std::fmt::Display for Output {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}:{}", self.encoder.id(), self.storage.id())?;
        self.options.iter().try_for_each(|o| write!(f, "+{}", o.id()))
    }
}

impl Serialize for Output {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// The outputs of a request: those that it lists, or the default.
pub(super) fn listed(request: &TableRequest) -> Vec<Output> {
    request.outputs.clone().unwrap_or_else(|| vec![Output::preset()])
}

/// Checks what does not depend on the rest of the table: at least one, and none twice.
pub(super) fn check_list(draft: &Draft, path: &Path, faults: &mut Faults) {
    let Some(listed) = &draft.request.outputs else { return };
    let path = path.key("outputs");
    if listed.is_empty() && !draft.holes.outputs {
        faults.value(path.clone(), Fault::Count { key: "outputs", got: 0, allowed: "1 or more".to_owned() });
    }
    for (i, output) in listed.iter().enumerate() {
        if listed.iter().take(i).any(|before| before.clashes(output)) {
            let got = format!("{}:{}", output.encoder.id(), output.storage.id());
            let why = "both would write the same file".to_owned();
            faults.value(path.index(i), Fault::Twice { what: "output", got, why });
        }
    }
}

/// A table that names its file has one output; text round the numbers needs a file that is nothing but numbers.
pub(super) fn check_file(request: &TableRequest, path: &Path, faults: &mut Faults) {
    let outputs = listed(request);
    let fault = |why: String, remedy| Fault::Container { why, remedy };
    if request.file.is_some() && outputs.len() > 1 {
        let why = format!("`file` names one file, and the table has {} outputs", outputs.len());
        faults.value(path.key("file"), fault(why, "leave one output, or leave `file` out"));
    }
    for (key, text) in [("before", &request.before), ("after", &request.after)] {
        if text.is_some()
            && let Some(output) = outputs.iter().find(|o| !o.encoder.is_bare())
        {
            let why = format!("{} has no place for `{key}`", output.encoder.id());
            faults.value(path.key(key), fault(why, "take a container without a header, such as text"));
        }
    }
}

/// Checks what depends on the table: its channels, their ranges, its axes. The default output is not checked for ranges it cannot
/// fail on, and no key of the request would be at fault.
pub(super) fn check(request: &TableRequest, bound: &Bound, path: &Path, faults: &mut Faults) {
    let channels = &bound.spec.layout.channels;
    for (i, output) in request.outputs.iter().flatten().enumerate() {
        let path = path.key("outputs").index(i);
        if output.storage.is_bounded()
            && let Some(channel) = channels.iter().find(|c| is_wide(output.storage, c))
        {
            let storage = output.storage.id();
            let fault = Fault::WideRange { storage, channel: channel.id, range: channel.range };
            faults.value(path.clone(), fault);
        }
        if let Err(error) = output.shape(&bound.spec.grid, channels.len()).check(output.encoder) {
            let remedy = match error {
                EncodeError::Conflict { .. } => "leave one of them out",
                _ => "take another container, storage or layout",
            };
            faults.value(path, Fault::Container { why: error.to_string(), remedy });
        }
    }
}

/// A storage that spreads its steps over the range of a channel must have a step that is of use.
fn is_wide(storage: Storage, channel: &ChannelInfo) -> bool {
    let half_step = storage.default_tolerance() * (channel.range[1] - channel.range[0]);
    half_step.is_nan() || half_step > TOLERANCE[1]
}

#[cfg(test)]
mod tests {
    use super::Output;

    /// What `parse` says, by whether the feature is there.
    fn is_told(output: &str, feature: &str, is_there: bool) {
        let parsed = Output::parse(output).map_err(|fault| fault.to_string());
        let names = format!("needs the feature `{feature}` of the crate");
        let told = parsed.as_ref().err().is_some_and(|e| e.contains(&names));
        assert!(if is_there { parsed.is_ok() } else { told }, "{output}, {feature} {is_there}: {parsed:?}");
    }

    #[test]
    fn what_a_build_leaves_out_is_refused_with_its_feature() {
        is_told("dds:bc6h", "blocks", cfg!(feature = "blocks"));
        is_told("ktx2:bc4", "blocks", cfg!(feature = "blocks"));
        is_told("ktx2:half+zstd", "zstd", cfg!(feature = "zstd"));
    }
}
