//! A surface is either a metal or not.

use super::{Breaks, Rule};

pub(super) static RULE: Rule = Rule {
    id: "half-metal",
    title: "metalness is near 0 or near 1 (no further from both than the bound) but on edges",
    measure: |texel, _| Some(texel.metallic.min(1.0 - texel.metallic)),
    breaks: Breaks::Above,
    bound: 0.1,
    share: 0.05,
};
