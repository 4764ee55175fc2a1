//! No surface reflects more than it gets.

use super::{Breaks, Rule};

pub(super) static RULE: Rule = Rule {
    id: "albedo",
    title: "E of the stack, the largest of its views with mu >= 0.05 and of its channels, is at most 1",
    measure: |_, stack| Some(stack.largest_albedo()),
    breaks: Breaks::Above,
    bound: 1.001,
    share: 0.0,
};
