//! The keys of the lobes of a map: a part of [`keys`](super::keys).

use super::keys::{FILE, Is, Keys, ids, key, needed};
use crate::plan::map::{sbrdf, words};

/// Lobes at each texel.
pub(super) static SBRDF: Keys = Keys::new(
    "sbrdf",
    &[
        needed("model", Is::Word(|| vec![sbrdf::MODEL]), "model = \"lafortune\"", "The model of a lobe."),
        key("lobes", Is::Count, "Lobes of a texel, 1 to 3."),
        key("residual", Is::Number, "Fit fewer lobes if the relative residual stays below this."),
        key("normalise", Is::Word(|| ids(&words::NORMALISE)), "What a lobe is divided by."),
        key(sbrdf::BASE, Is::Any(COLOURS), "Linear base colour, or an image of it."),
        key(sbrdf::METALLIC, Is::Any(NUMBERS), "A number, or an image."),
        key(sbrdf::BRDF, Is::Text, "A tabulated BRDF in place of the maps."),
    ],
);

static COLOURS: &[Is] = &[Is::Number, Is::Text, Is::List(&Is::Number, [3, 3]), Is::Section(&COLOUR)];
static NUMBERS: &[Is] = &[Is::Number, Is::Text, Is::Section(&NUMBER)];

/// How an image of colours is read.
pub(super) static COLOUR: Keys = Keys::new(
    sbrdf::BASE,
    &[FILE, key("space", Is::Word(|| ids(&words::SPACES)), "How the codes are spread.")],
);

/// How an image of a number is read.
pub(super) static NUMBER: Keys =
    Keys::new(sbrdf::METALLIC, &[FILE, key("channel", Is::Text, "Its channel.")]);
