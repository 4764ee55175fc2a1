//! Filter rules: from the footprint of a texel to the lobe that is written. One file a rule.
//!
//! The rule of this program is [`fit`]; the others are published, and stand here for comparison and for engines that expect
//! them. All of them but the fit stand about the normalised mean normal.

pub mod filament;
pub mod fit;
pub mod keep;
pub mod lean;
pub mod the_order;
pub mod toksvig;
pub mod variance;
pub mod vmf;

use super::fit::{Centre, Fitted, Fitter, Shape};
use super::footprint::Footprint;
use super::lobe::Lobe;
use crate::cite::Cite;

/// A way from a footprint to a lobe.
#[derive(Debug)]
pub struct Rule {
    /// Id: kebab-case.
    pub id: &'static str,
    /// Title.
    pub title: &'static str,
    /// Formula; |N| is the length of the mean normal, α² the mean of the facets' squares.
    pub formula: &'static str,
    /// Sources with equation numbers.
    pub sources: &'static [(Cite, &'static str)],
    /// What to know before using it.
    pub notes: &'static str,
    /// True if it can give a lobe with two widths.
    pub anisotropic: bool,
    /// How it works.
    pub method: Method,
}

/// How a rule comes to its lobe.
#[derive(Debug, Clone, Copy)]
pub enum Method {
    /// By search: see [`super::fit`].
    Fit,
    /// By a formula. The result may be wider than α = 1; it is cut there, and told.
    Formula(fn(&Footprint) -> Lobe),
}

/// Every rule, the default first.
pub static RULES: &[&Rule] = &[
    &fit::RULE,
    &keep::RULE,
    &toksvig::RULE,
    &lean::RULE,
    &variance::RULE,
    &vmf::RULE,
    &the_order::RULE,
    &filament::RULE,
];

/// Looks a rule up by its id.
#[must_use]
pub fn rule(id: &str) -> Option<&'static Rule> {
    RULES.iter().copied().find(|r| r.id == id)
}

impl Rule {
    /// The lobe of a footprint, never narrower than its narrowest facet, with D and its doubt. A constant footprint is its own answer,
    /// to the bit.
    #[must_use]
    pub fn apply(&self, fitter: &mut Fitter, footprint: &Footprint, centre: Centre, shape: Shape) -> Fitted {
        let formula = match self.method {
            Method::Formula(formula) if !footprint.is_constant() => formula,
            _ => return fitter.fit(footprint, centre, shape),
        };
        let free = formula(footprint);
        let lobe = free.within(footprint.least, 1.0);
        let (distance, doubt) = fitter.distance(&lobe, footprint);
        Fitted { lobe, wide: None, distance, doubt, at_limit: free.alpha_max > 1.0 }
    }
}

/// An isotropic lobe about the mean normal.
fn about_mean(footprint: &Footprint, square: f64) -> Lobe {
    Lobe::isotropic(footprint.normal(), square.max(0.0).sqrt())
}

/// 1/κ of the von Mises-Fisher distribution with this mean, (1 − |N|²)/(3 |N| − |N|³).
///
/// Source: [Banerjee2005](crate::cite::BANERJEE_2005) Eq. 4.4 in three dimensions.
fn vmf_width(footprint: &Footprint) -> f64 {
    let length = footprint.mean.length();
    footprint.spread / (length * (3.0 - length * length))
}
