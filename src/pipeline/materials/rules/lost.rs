//! Rough metals darken where light that bounces between facets is left out.

use super::{Breaks, Rule};

pub(super) static RULE: Rule = Rule {
    id: "lost-energy",
    title: "single scattering loses little of what facets reflect; beyond it, compensation is seen",
    measure: |_, stack| Some(stack.lost()),
    breaks: Breaks::Above,
    bound: 0.05,
    share: 0.0,
};
