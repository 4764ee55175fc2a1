//! The rules.

mod albedo;
mod coated_cloth;
mod dark_or_bright;
mod half_metal;
mod lost;
mod smooth;

use super::{Stack, Texel};

/// A rule over texels.
#[derive(Debug)]
pub struct Rule {
    /// Id.
    pub id: &'static str,
    /// What it says, and why that matters.
    pub title: &'static str,
    /// What the value is, of a texel that the rule is about.
    pub measure: fn(&Texel, &Stack<'_>) -> Option<f64>,
    /// When it is broken.
    pub breaks: Breaks,
    /// The bound, unless another one is asked for.
    pub bound: f64,
    /// The share of the texels beyond which it is told.
    pub share: f64,
}

/// On which side of its bound a rule is broken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Breaks {
    /// Above it.
    Above,
    /// Below it.
    Below,
}

impl Breaks {
    /// How far a value is beyond the bound; not above 0 if it is not.
    #[must_use]
    pub fn by(self, value: f64, bound: f64) -> f64 {
        match self {
            Breaks::Above => value - bound,
            Breaks::Below => bound - value,
        }
    }
}

/// Every rule.
pub static RULES: &[&Rule] = &[
    &albedo::RULE,
    &lost::RULE,
    &half_metal::RULE,
    &dark_or_bright::DARK,
    &dark_or_bright::BRIGHT,
    &smooth::HALF,
    &smooth::FLOAT,
    &coated_cloth::RULE,
];
