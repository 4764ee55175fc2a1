//! What can be wrong with a request: one enum, whose variants carry what was given and what is allowed.

use crate::grid::{AxisError, GridError};
use crate::math::figures::exact as number;
use crate::math::nearest::nearest;
use crate::math::shown::show;
use crate::models::ParamError;
use crate::tables::BindError;

/// A fault of a request, or of the text that it was read from. `Display` says what is wrong and what was given; [`Fault::allowed`] and [`Fault::remedy`] go on.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    /// Not TOML.
    #[error("{0}")]
    Syntax(String),
    /// Not UTF-8.
    #[error("the file is not UTF-8 text")]
    NotUtf8,
    /// Larger than [`MAX_BYTES`](crate::recipe::MAX_BYTES).
    #[error("the file has {bytes} bytes or more")]
    FileTooLarge {
        /// Size, as far as it was read.
        bytes: usize,
        /// The limit.
        limit: usize,
    },
    /// A key that has no meaning at its place.
    #[error("unknown key `{key}`")]
    UnknownKey {
        /// The key.
        key: String,
        /// Where: `[[table.axis]]`.
        section: &'static str,
        /// The keys there are.
        allowed: String,
        /// The nearest one.
        suggestion: Option<String>,
    },
    /// A required key that is not there.
    #[error("{section} has no `{key}`")]
    MissingKey {
        /// Where: `[[table.axis]]`.
        section: &'static str,
        /// The key.
        key: &'static str,
        /// What to write.
        example: &'static str,
    },
    /// A value of the wrong type.
    #[error("`{key}` is {got}")]
    Type {
        /// The key.
        key: String,
        /// The type given.
        got: &'static str,
        /// The type wanted.
        expected: &'static str,
        /// What to write instead.
        remedy: Option<&'static str>,
    },
    /// A word or id that is not offered.
    #[error("unknown {what} `{got}`")]
    Word {
        /// What it names: `quantity`, `texel`, `law`.
        what: String,
        /// The word given.
        got: String,
        /// The words there are.
        allowed: String,
        /// The nearest one.
        suggestion: Option<String>,
    },
    /// A number outside its range, or not a number.
    #[error("{key} = {} is out of range", number(*got))]
    Range {
        /// The key.
        key: String,
        /// The number given.
        got: f64,
        /// Least.
        min: f64,
        /// Largest.
        max: f64,
    },
    /// A list with too few or too many entries.
    #[error("`{key}` has {got} {}", if *got == 1 { "entry" } else { "entries" })]
    Count {
        /// The key.
        key: &'static str,
        /// Entries given.
        got: usize,
        /// What is allowed.
        allowed: String,
    },
    /// A size to be found for a table whose axes all have a length.
    #[error("`size` has nothing to find: every axis has a `length`")]
    NothingToSize,
    /// A text that is empty or too long.
    #[error("`{key}` {}", if *got == 0 { "is empty".to_owned() } else { format!("has {got} characters") })]
    TextLength {
        /// The key.
        key: String,
        /// Characters given.
        got: usize,
        /// The limit.
        limit: usize,
    },
    /// A name that is not portable.
    #[error("{what} `{got}` {why}")]
    Name {
        /// `recipe name` or `table name`.
        what: &'static str,
        /// The name.
        got: String,
        /// What is wrong with it.
        why: &'static str,
        /// The rule.
        allowed: &'static str,
    },
    /// Something that may be there once.
    #[error("{what} `{got}` is given twice")]
    Twice {
        /// What: `table name`, `waiver of law`, `parameter`.
        what: &'static str,
        /// Its value.
        got: String,
        /// Why that matters.
        why: String,
    },
    /// A warp table that is not one of the forms.
    #[error("this is not a warp: {why}")]
    WarpForm {
        /// What is wrong.
        why: &'static str,
    },
    /// An output that is not `container:storage`, with or without options.
    #[error("output `{got}` is not of the form `container:storage` or `container:storage+option`")]
    OutputForm {
        /// The text given.
        got: String,
        /// The containers there are.
        allowed: String,
    },
    /// A storage that spreads its steps over the range of a channel, and a channel with a very wide range.
    #[error("{storage} cannot store channel {channel}: its range is too wide")]
    WideRange {
        /// Storage id.
        storage: &'static str,
        /// Channel id.
        channel: &'static str,
        /// Range of the channel.
        range: [f64; 2],
    },
    /// A container that cannot hold the table: too many channels, options that exclude each other.
    #[error("{why}")]
    Container {
        /// What it cannot hold.
        why: String,
        /// What to do about it.
        remedy: &'static str,
    },
    /// A waiver for a law that is not checked.
    #[error("table {kind} does not check law `{law}`")]
    IdleWaiver {
        /// Table kind.
        kind: &'static str,
        /// The law.
        law: String,
        /// The laws that it checks.
        allowed: String,
    },
    /// A swept parameter that leaves its range on the axis.
    #[error("axis {axis} runs over [{}, {}]", number(.got[0]), number(.got[1]))]
    SweptRange {
        /// Axis id.
        axis: &'static str,
        /// The ends of the axis, in its own quantity.
        got: [f64; 2],
        /// Model or kind that has the parameter.
        owner: &'static str,
        /// What it takes, in the quantity of the axis.
        allowed: [f64; 2],
        /// Where the axis goes by another quantity than the parameter: its map and the range of the parameter, in words.
        map: Option<String>,
    },
    /// A Fresnel parameter of a table that splits the Fresnel factor off.
    #[error("{key} = {} has no effect: table {kind} splits the Fresnel factor off", number(*got))]
    SplitFresnel {
        /// Table kind.
        kind: &'static str,
        /// `f0` or `f90`.
        key: &'static str,
        /// The value given.
        got: f64,
    },
    /// A law that the model does not claim, and that it breaks on these axes.
    #[error("{model} does not keep law{} {}: {what}", if .laws.len() == 1 { "" } else { "s" }, .laws.join(", "))]
    Unclaimed {
        /// The model.
        model: &'static str,
        /// Table kind.
        kind: &'static str,
        /// The laws.
        laws: Vec<&'static str>,
        /// What was found, and where.
        what: String,
    },
    /// A model that has no finite value on these axes.
    #[error("{model} has no value on these axes: {what}")]
    NoValue {
        /// The model.
        model: &'static str,
        /// What was found, and where.
        what: String,
    },
    /// A map that cannot be made as it was asked for.
    #[error("{why}")]
    Map {
        /// Why not.
        why: String,
        /// What is allowed.
        allowed: Option<String>,
        /// What to do about it.
        remedy: Option<&'static str>,
    },
    /// An image that cannot be read.
    #[error("{}: {why}", show(file))]
    Image {
        /// The file.
        file: String,
        /// Why not.
        why: String,
        /// Is it the system that cannot?
        io: bool,
    },
    /// A file of n and k that cannot be read.
    #[error("{}: {why}", show(file))]
    Index {
        /// The file.
        file: String,
        /// Why not.
        why: String,
        /// Is it the system that cannot?
        io: bool,
    },
    /// The table cannot be bound.
    #[error("{}", bind_message(.0))]
    Bind(BindError),
}

impl Fault {
    /// What is allowed instead, or the nearest thing.
    #[must_use]
    pub fn allowed(&self) -> Option<String> {
        let between = |min: f64, max: f64| format!("allowed: {} to {}", number(min), number(max));
        match self {
            Fault::FileTooLarge { limit, .. } => Some(format!("allowed: {limit} bytes")),
            Fault::UnknownKey { suggestion, .. } => suggestion.as_deref().map(did_you_mean),
            Fault::Word { suggestion, allowed, .. } => Some(hint(suggestion.as_deref(), allowed)),
            Fault::Type { expected, .. } => Some(format!("expected {expected}")),
            Fault::Range { min, max, .. } => Some(between(*min, *max)),
            Fault::Count { allowed, .. } => Some(format!("allowed: {allowed}")),
            Fault::TextLength { limit, .. } => Some(format!("allowed: 1 to {limit} characters")),
            Fault::Name { allowed, .. } => Some(format!("allowed: {allowed}")),
            Fault::Twice { why, .. } => Some(why.clone()),
            Fault::OutputForm { allowed, .. } => Some(format!("containers are {allowed}")),
            Fault::IdleWaiver { allowed, .. } => Some(format!("it checks {allowed}")),
            Fault::SweptRange { axis, owner, allowed: [min, max], map, .. } => {
                let map = map.as_deref().map_or_else(String::new, |m| format!(" ({m})"));
                Some(format!("{owner} takes {axis} from {} to {}{map}", number(*min), number(*max)))
            }
            Fault::SplitFresnel { .. } => Some("allowed: 1".to_owned()),
            Fault::Map { allowed, .. } => allowed.clone(),
            Fault::Unclaimed { model, kind, .. } => {
                Some(format!("table {kind} checks what {model} does not claim (`brdfbake describe {model}`)"))
            }
            Fault::Bind(
                BindError::Unknown { suggestion, allowed, .. }
                | BindError::Param(ParamError::Unknown { suggestion, allowed, .. }),
            ) => Some(hint(suggestion.as_deref(), allowed)),
            Fault::Bind(BindError::Param(ParamError::Range { min, max, .. })) => Some(between(*min, *max)),
            Fault::Bind(BindError::Param(ParamError::Kind { allowed, .. })) => {
                Some(format!("expected {allowed}"))
            }
            _ => None,
        }
    }

    /// What to do about it.
    #[must_use]
    pub fn remedy(&self) -> Option<String> {
        let text = match self {
            Fault::UnknownKey { section, allowed, .. } => return Some(format!("{section} has {allowed}")),
            Fault::Word { suggestion: Some(_), allowed, .. } => return Some(format!("there is {allowed}")),
            Fault::Bind(
                BindError::Unknown { suggestion: Some(_), allowed, .. }
                | BindError::Param(ParamError::Unknown { suggestion: Some(_), allowed, .. }),
            ) => return Some(format!("there is {allowed}")),
            Fault::MissingKey { example, .. } => return Some(format!("add `{example}`")),
            Fault::Type { remedy, .. } => (*remedy)?,
            Fault::NotUtf8 => "save it as UTF-8",
            Fault::NothingToSize => "leave out the `length` of the axes to be searched, or leave out `size`",
            Fault::WarpForm { .. } => {
                "write { power = p }, { one-minus-power = p } or { coupled = \"alpha\", power = 2.0, scale = 1.0, exponent = 1.0 }"
            }
            Fault::OutputForm { .. } => "write it like \"exr:half\"; `brdfbake list formats` has all",
            Fault::Container { remedy, .. } => remedy,
            Fault::WideRange { .. } => "store it as half or float, or take a layout with bounded channels",
            Fault::SweptRange { .. } => "give the axis a domain inside that range",
            Fault::SplitFresnel { .. } => "leave it out; the shader applies F0 and F90",
            Fault::Unclaimed { laws, .. } => {
                let one = |law: &&str| format!("{{ law = \"{law}\", reason = \"...\" }}");
                let all: Vec<String> = laws.iter().map(one).collect();
                return Some(format!(
                    "give the axes ends between which it holds, or waive it: waive = [{}]",
                    all.join(", ")
                ));
            }
            Fault::NoValue { .. } => "move the axis off that end, or take another model",
            Fault::Map { remedy, .. } => (*remedy)?,
            Fault::Image { io: true, .. } | Fault::Index { io: true, .. } => {
                "paths are relative to the folder of the recipe"
            }
            Fault::Image { io: false, .. } => "take a PNG, JPEG, EXR, KTX2, DDS or HDR image",
            Fault::Index { .. } => "take a CSV or a tabulated YAML of refractiveindex.info",
            Fault::Bind(e) => bind_remedy(e)?,
            _ => return None,
        };
        Some(text.to_owned())
    }
}

fn bind_message(error: &BindError) -> String {
    match error {
        BindError::Unknown { what: "table", got, .. } => format!("unknown table kind `{}`", show(got)),
        BindError::ChannelTwice { got } => format!("channel `{}` is given twice", show(got)),
        BindError::Unknown { what, got, .. } => format!("unknown {what} `{}`", show(got)),
        BindError::Param(ParamError::Unknown { model, key, .. }) => {
            format!("{model} has no parameter `{}`", show(key))
        }
        BindError::Param(ParamError::Range { model, key, got, .. }) => {
            format!("{model}: {key} = {} is out of range", number(*got))
        }
        BindError::Param(ParamError::Kind { model, key, got, .. }) => {
            format!("{model}: {key} cannot be {}", show(got))
        }
        other => other.to_string(),
    }
}

fn bind_remedy(error: &BindError) -> Option<&'static str> {
    match error {
        BindError::MissingAxis { .. } => {
            Some("add a [[table.axis]] for it, or leave all axes out to get the kind's own")
        }
        BindError::IdleAxis { .. } => Some("leave the axis out"),
        BindError::OneParam { .. } => Some("leave one of them out"),
        BindError::ChannelTwice { .. } => Some("a file has one channel of a name; leave one out"),
        BindError::NoMix { .. } => Some("name a layout instead"),
        BindError::LayoutAndChannels { .. } => {
            Some("leave one of them out; a layout is a list of channels with a name")
        }
        BindError::Both { .. } => Some("leave the parameter out, or the axis"),
        BindError::Model { why, .. } if why.starts_with("given") => Some("leave the model out"),
        BindError::Grid(GridError::Size(_)) => Some("make an axis shorter"),
        BindError::Grid(GridError::Twice(_)) => Some("leave one of them out"),
        BindError::Grid(GridError::Axis(AxisError::Domain { .. })) => {
            Some("write the low end first; to turn the axis round, use direction = \"descending\"")
        }
        _ => None,
    }
}

fn did_you_mean(word: impl AsRef<str>) -> String {
    format!("did you mean `{}`?", word.as_ref())
}

fn hint(suggestion: Option<&str>, allowed: &str) -> String {
    suggestion.map_or_else(|| format!("there is {allowed}"), did_you_mean)
}

/// A word that is not among those offered.
pub(crate) fn unknown_word<'a>(what: &str, got: &str, words: impl Iterator<Item = &'a str> + Clone) -> Fault {
    Fault::Word {
        what: what.to_owned(),
        got: show(got),
        allowed: words.clone().collect::<Vec<_>>().join(", "),
        suggestion: slip(got, words),
    }
}

/// The nearest word, if `got` is short enough to be a slip of one.
pub(crate) fn slip<'a>(got: &str, words: impl Iterator<Item = &'a str>) -> Option<String> {
    if got.len() > 64 {
        return None;
    }
    nearest(got, words).map(str::to_owned)
}
