//! Every key of a recipe file and what its value may be. The reader takes the keys of a section from here and is stopped, in
//! debug builds, where it reads one as something else; the schema ([`super::schema()`]) is written from the same lists.

use super::ENGINES;
pub(super) use super::sbrdf_keys::{COLOUR, NUMBER, SBRDF};
use crate::encode::ENCODERS;
use crate::encode::mips::containers;
use crate::functions::conversion::CONVERSIONS;
use crate::grid::fit::Texels;
use crate::grid::quantity::QUANTITIES;
use crate::maps::RULES;
use crate::models::MODELS;
use crate::plan::map::{Packing, words};
use crate::tables::TABLES;
use crate::tables::driver::OnMiss;
use crate::verify::LAWS;

/// What a value may be.
#[derive(Debug)]
pub(super) enum Is {
    /// A text that is not empty.
    Text,
    /// A text of any characters, empty or long.
    LongText,
    /// A text of this form, a regular expression.
    Form(fn() -> String),
    /// One of these words.
    Word(fn() -> Vec<&'static str>),
    /// A number.
    Number,
    /// An integer, not negative.
    Count,
    /// Two numbers.
    Pair,
    /// A list of so many entries, from and to.
    List(&'static Is, [usize; 2]),
    /// A table with keys of its own.
    Section(&'static Keys),
    /// A table whose keys are the parameters of models and kinds.
    Params,
    /// Any of these.
    Any(&'static [Is]),
}

/// A key.
#[derive(Debug)]
pub(super) struct Key {
    pub(super) id: &'static str,
    pub(super) is: Is,
    pub(super) need: Need,
    /// What it says, for editors that show the schema.
    pub(super) doc: &'static str,
}

/// Has it to be there? With a line that mends its absence.
#[derive(Debug)]
pub(super) enum Need {
    No,
    Always(&'static str),
    /// Unless one of these is there.
    Unless(&'static [&'static str], &'static str),
}

/// The keys of a section.
#[derive(Debug)]
pub(super) struct Keys {
    /// As written in the file: `[[table.axis]]`.
    pub(super) name: &'static str,
    pub(super) keys: &'static [Key],
    /// Keys that need not be there after all.
    pub(super) free: &'static [&'static str],
    /// Only one of the keys can be there.
    pub(super) alone: bool,
    /// Without the first key, the value of the second one is what the third says.
    pub(super) without: Option<(&'static str, &'static str, Is)>,
}

impl Keys {
    pub(super) const fn new(name: &'static str, keys: &'static [Key]) -> Keys {
        Keys { name, keys, free: &[], alone: false, without: None }
    }

    /// The names of the keys.
    pub(super) fn ids(&self) -> impl Iterator<Item = &'static str> + Clone + use<> {
        self.keys.iter().map(|k| k.id)
    }

    /// Can the value of a key be such a thing? For assertions.
    pub(super) fn takes(&self, id: &str, such: &dyn Fn(&Is) -> bool) -> bool {
        self.keys.iter().find(|k| k.id == id).is_some_and(|k| match &k.is {
            Is::Any(all) => all.iter().any(such),
            one => such(one),
        })
    }
}

pub(super) const fn key(id: &'static str, is: Is, doc: &'static str) -> Key {
    Key { id, is, need: Need::No, doc }
}

pub(super) const fn needed(id: &'static str, is: Is, example: &'static str, doc: &'static str) -> Key {
    Key { id, is, need: Need::Always(example), doc }
}

const SWITCH: Is = Is::Word(|| vec!["on", "off"]);
const NAMES: Is = Is::List(&Is::Text, [0, 64]);

/// The file as a whole.
pub(super) static ROOT: Keys = Keys::new(
    "the recipe",
    &[
        needed("name", Is::Text, "name = \"my-tables\"", "Name of the recipe: a-z, 0-9 and hyphens."),
        key("tolerance", Is::Number, "Tolerance of tables that have none: absolute, per channel."),
        key(
            "engine",
            Is::Word(|| ENGINES.iter().map(|e| e.id).collect()),
            "The tables of this engine, in its own files.",
        ),
        Key {
            id: "table",
            is: Is::List(&Is::Section(&TABLE), [1, 256]),
            need: Need::Unless(&["engine", "map"], "[[table]]"),
            doc: "Tables.",
        },
        key("map", Is::List(&Is::Section(&MAP), [1, 256]), "Normal and roughness maps with filtered levels."),
    ],
);

/// A table.
pub(super) static TABLE: Keys = Keys {
    without: Some(("size", "axis", Is::List(&Is::Section(&AXIS), [1, 4]))),
    ..Keys::new(
        "[[table]]",
        &[
            needed(
                "kind",
                Is::Word(|| TABLES.iter().map(|t| t.id).collect()),
                "kind = \"dfg\"",
                "What is tabulated.",
            ),
            needed(
                "name",
                Is::Text,
                "name = \"ggx-dfg\"",
                "Stem of the names of its files, unique in the recipe.",
            ),
            key("file", Is::Text, "Name of its one file, in place of the name and an extension."),
            key("before", Is::LongText, "Text before the numbers, in containers without header."),
            key("after", Is::LongText, "Text behind the numbers, in containers without header."),
            key("layout", Is::Word(layouts), "Channels of the kind that have a name together."),
            key("channels", NAMES, "Any channels of the kind, in file order, in place of a layout."),
            key("model", Is::Word(models), "The reflectance model."),
            key("params", Is::Params, "Parameters of the model and the kind that are held fixed."),
            key("tolerance", Is::Number, "Tolerance of every channel, absolute."),
            key("outputs", Is::List(&Is::Form(outputs), [1, 64]), "Files: container:storage, and +options."),
            key(
                "on-miss",
                Is::Word(|| OnMiss::ALL.map(OnMiss::id).to_vec()),
                "Fail, or report, where a texel misses the tolerance.",
            ),
            key("reconstruction", SWITCH, "Measure the error of a reader between the texels."),
            key(
                "size",
                Is::Any(&[Is::Word(|| vec!["auto"]), Is::Section(&SIZE)]),
                "Find the lengths of axes that have none.",
            ),
            key(
                "texels",
                Is::Word(|| Texels::ALL.map(Texels::id).to_vec()),
                "Exact values, or values fitted to the reader.",
            ),
            key("waive", Is::List(&Is::Section(&WAIVE), [0, 64]), "Laws that the table is known to break."),
            key(
                "axis",
                Is::List(&Is::Section(&SEARCHED), [1, 4]),
                "Axes: x (fastest), y, z; those of the kind if there are none.",
            ),
        ],
    )
};

static WARPS: &[Is] = &[Is::Word(warps), Is::Section(&WARP), Is::Section(&COUPLED)];

static AXIS_KEYS: &[Key] = &[
    needed("id", Is::Word(quantities), "id = \"mu\"", "The quantity."),
    needed("length", Is::Count, "length = 64", "Texels, 2 to 16384."),
    key("domain", Is::Pair, "Its two ends, the low one first."),
    key("warp", Is::Any(WARPS), "How texels lie between the ends."),
    key(
        "texel",
        Is::Word(|| vec!["center", "endpoint"]),
        "Does the first texel stand on the end of the domain?",
    ),
    key("direction", Is::Word(|| vec!["ascending", "descending"]), "Which end texel 0 holds."),
    key("offset", Is::Number, "Shift in texels."),
    key("clamp", Is::Pair, "Values are clamped to these before use."),
];

/// An axis.
pub(super) static AXIS: Keys = Keys::new("[[table.axis]]", AXIS_KEYS);

/// An axis whose length may be found.
pub(super) static SEARCHED: Keys = Keys { free: &["length"], ..Keys::new("[[table.axis]]", AXIS_KEYS) };

/// A warp without another axis.
pub(super) static WARP: Keys = Keys {
    alone: true,
    ..Keys::new(
        "warp",
        &[
            key("power", Is::Number, "w = v^p."),
            key("one-minus-power", Is::Number, "w = 1 - (1 - v)^p."),
            key("coupled", Is::Word(bases), "The quantity of another axis."),
        ],
    )
};

/// A warp that another axis bends.
pub(super) static COUPLED: Keys = Keys::new(
    "warp",
    &[
        needed("coupled", Is::Word(bases), "coupled = \"alpha\"", "The quantity of the other axis."),
        key("power", Is::Number, "w^power = v (1 + c) / (v + c)."),
        key("scale", Is::Number, "c = scale a^exponent."),
        key("exponent", Is::Number, "c = scale a^exponent."),
    ],
);

/// How lengths are found.
pub(super) static SIZE: Keys = Keys::new(
    "size",
    &[
        key("error", Is::Number, "Largest error of a reader."),
        key("domain", Is::Word(|| vec!["whole", "practical"]), "Where it must hold."),
        key("warps", Is::Word(|| vec!["keep", "search"]), "Try other warps, too?"),
        key("longest", Is::Count, "Longest axis."),
    ],
);

/// A law that is waived.
pub(super) static WAIVE: Keys = Keys::new(
    "waive",
    &[
        needed("law", Is::Word(|| LAWS.iter().map(|l| l.id).collect()), "law = \"energy\"", "The law."),
        needed(
            "reason",
            Is::Text,
            "reason = \"why this table may break it\"",
            "Why the table may break it; the file says so.",
        ),
    ],
);

/// A normal and a roughness map.
pub(super) static MAP: Keys = Keys::new(
    "[[map]]",
    &[
        needed("name", Is::Text, "name = \"bark\"", "How the names of its files begin."),
        key("normal", Is::Any(&[Is::Text, Is::Section(&NORMAL)]), "Normal map; flat without one."),
        key(
            "roughness",
            Is::Any(&[Is::Number, Is::Text, Is::Section(&ROUGHNESS)]),
            "A number, an image, or an image and how it is read.",
        ),
        key("anisotropy", Is::Section(&ANISOTROPY), "Facets of two widths, as KHR_materials_anisotropy."),
        key("sbrdf", Is::Section(&SBRDF), "Lobes at each texel, in place of the roughness."),
        key("packing", Is::Word(|| ids(&Packing::ALL)), "Channels that are written with the roughness."),
        key("factor", Is::Number, "Factor of the roughness."),
        key("rule", Is::Word(|| RULES.iter().map(|r| r.id).collect()), "Filter rule."),
        key("normals", Is::Word(|| ids(&words::CENTRES)), "What the lobes stand about."),
        key("shape", Is::Word(|| ids(&words::SHAPES)), "One width, two and a direction, or two lobes."),
        key("effort", Is::Word(|| ids(&words::EFFORTS)), "Fast, or every facet."),
        key("objective", Is::Word(|| ids(&words::OBJECTIVES)), "What the fit makes small."),
        key("outputs", Is::List(&Is::Form(map_outputs), [0, 64]), "Containers, with storages or not."),
        key("check", Is::Count, "Texels of a level that are measured, beside the worst."),
        key("compare", SWITCH, "Measure every published rule at the same texels."),
    ],
);

pub(super) const FILE: Key =
    needed("file", Is::Text, "file = \"bark.png\"", "The image, relative to the folder of the recipe.");

/// Facets of two widths.
pub(super) static ANISOTROPY: Keys = Keys::new(
    "anisotropy",
    &[
        key("file", Is::Text, "Direction in R and G, strength in B, relative to the folder of the recipe."),
        key("strength", Is::Number, "Factor of the strength."),
        key("rotation", Is::Number, "Turn of the direction in radians, against the clock."),
        key("resample", SWITCH, "Bring the smaller images to the largest size."),
    ],
);

/// How a normal map is read.
pub(super) static NORMAL: Keys = Keys::new(
    "normal",
    &[
        FILE,
        key("channels", Is::List(&Is::Text, [2, 3]), "Channels of x, y and z."),
        key("green", Is::Word(|| vec!["up", "down"]), "Where green grows."),
        key("z", Is::Word(|| vec!["stored", "derived"]), "Is z stored, or what is left of a unit length?"),
        key("scale", Is::Number, "Factor of x and y."),
        key("signed", SWITCH, "Numbers from -1 to 1, not codes."),
        key(
            "wrap",
            Is::Any(&[Is::Word(|| ids(&words::WRAPS)), Is::List(&Is::Word(|| ids(&words::WRAPS)), [2, 2])]),
            "What lies beyond the borders.",
        ),
        key("mend", SWITCH, "Take texels without a direction as flat."),
        key("resample", SWITCH, "Bring the smaller map to the size of the larger one."),
    ],
);

/// How a roughness map is read.
pub(super) static ROUGHNESS: Keys = Keys::new(
    "roughness",
    &[
        FILE,
        key("channel", Is::Text, "Its channel."),
        key("space", Is::Word(|| ids(&words::SPACES)), "How the codes are spread."),
        key("holds", Is::Word(|| vec!["roughness", "gloss"]), "Roughness, or 1 - roughness."),
        key("from", Is::Section(&FROM), "The codes tell of another lobe."),
    ],
);

/// The lobe that codes tell of.
pub(super) static FROM: Keys = Keys::new(
    "from",
    &[
        needed("lobe", Is::Word(lobes), "lobe = \"blinn-phong\"", "Its parametrisation."),
        needed("range", Is::Pair, "range = [1, 1024]", "Numbers that the codes 0 and 1 stand for."),
        key("log", SWITCH, "The codes are spread over the logarithm."),
        key("rule", Is::Word(|| ids(&words::RULES)), "The nearest lobe, or that of the same peak."),
        key("second", Is::Text, "Channel of the second number."),
        key("angle", Is::Text, "Channel of the angle of the first axis: codes 0 to 1 are half a turn."),
    ],
);

pub(super) fn ids<T>(list: &[(&'static str, T)]) -> Vec<&'static str> {
    list.iter().map(|(word, _)| *word).collect()
}

fn models() -> Vec<&'static str> {
    MODELS.iter().flat_map(|m| std::iter::once(m.id).chain(m.also.iter().map(|a| a.name))).collect()
}

fn layouts() -> Vec<&'static str> {
    let mut all: Vec<&str> = TABLES.iter().flat_map(|t| t.layouts).map(|l| l.id).collect();
    all.sort_unstable();
    all.dedup();
    all
}

fn warps() -> Vec<&'static str> {
    super::read_axis::WORDS.iter().map(|(word, _)| *word).collect()
}

fn quantities() -> Vec<&'static str> {
    QUANTITIES.iter().map(|q| q.id).collect()
}

/// Quantities that are not a function of another one.
fn bases() -> Vec<&'static str> {
    QUANTITIES.iter().filter(|q| q.base.is_none()).map(|q| q.id).collect()
}

fn lobes() -> Vec<&'static str> {
    CONVERSIONS.iter().map(|c| c.id).collect()
}

fn outputs() -> String {
    let one = |e: &&'static dyn crate::encode::Encoder| {
        let storages: Vec<&str> = e.storages().iter().map(|s| s.id()).collect();
        let options: Vec<&str> = e.options().iter().map(|o| o.id()).collect();
        let options =
            if options.is_empty() { String::new() } else { format!("( *\\+ *({}))*", options.join("|")) };
        format!("{}: *({}){options} *", e.id(), storages.join("|"))
    };
    format!("^({})$", ENCODERS.iter().map(one).collect::<Vec<_>>().join("|"))
}

fn map_outputs() -> String {
    let ids: Vec<&str> = containers().map(|e| e.id()).collect();
    format!("^({})(:.+)?$", ids.join("|"))
}
