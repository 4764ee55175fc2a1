//! A coat over a sheen is told only where the two together break the bound: neither extension knows the other's table.

use super::{Breaks, Rule};

pub(super) static RULE: Rule = Rule {
    id: "coated-cloth",
    title: "E of a stack with a coat over a sheen is at most 1",
    measure: |texel, stack| (texel.coat > 0.0 && texel.sheen > 0.0).then(|| stack.largest_albedo()),
    breaks: Breaks::Above,
    bound: 1.001,
    share: 0.0,
};
