//! SBRDF parameter maps: textures that hold the parameters of a BRDF at each texel, filtered to smaller levels.
//!
//! A texel of a smaller level stands for a *footprint* of facets, each with a normal and a width. What light sees of it is the
//! mean of the facets' lobes; what a texture can hold is one lobe. [`fit`] finds the nearest one; [`rules`] holds that
//! and the published formulas, for comparison. See [`lobe`] for the frames, [`footprint`] for the sums.
//! The manual is the page [`maps`](crate::guide::maps) of the guide.

mod descent;
pub(crate) mod filter;
pub(crate) mod fit;
pub(crate) mod footprint;
pub(crate) mod lobe;
mod nodes;
pub(crate) mod reflected;
mod round;
#[cfg(feature = "unstable")]
pub mod rules;
#[cfg(not(feature = "unstable"))]
pub(crate) mod rules;
#[cfg(feature = "unstable")]
pub mod sbrdf;
#[cfg(not(feature = "unstable"))]
pub(crate) mod sbrdf;
pub(crate) mod signs;
#[cfg(feature = "unstable")]
pub mod spec_gloss;
#[cfg(not(feature = "unstable"))]
pub(crate) mod spec_gloss;
pub(crate) mod surface;
pub(crate) mod turned;
pub(crate) mod two;

pub use filter::{FilterError, Level, Objective, Settings, Texel, filter};
pub use fit::{Centre, Effort, Fitted, Fitter, Shape};
pub use footprint::Footprint;
pub use lobe::{Facet, Lobe};
pub use rules::{Method, RULES, Rule};
pub use sbrdf::Normalise;
pub use surface::{Convention, Field, Surface, TexelFault};
pub use two::Wide;
