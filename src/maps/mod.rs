//! SBRDF parameter maps: textures that hold the parameters of a BRDF at each texel, filtered to smaller levels.
//!
//! A texel of a smaller level stands for a *footprint* of facets, each with a normal and a width. What light sees of it is the
//! mean of the facets' lobes; what a texture can hold is one lobe. [`fit`] finds the nearest one; [`rules`] holds that
//! and the published formulas, for comparison. See [`lobe`] for the frames, [`footprint`] for the sums.
//! The manual is the page [`maps`](crate::guide::maps) of the guide.

mod descent;
pub mod filter;
pub mod fit;
pub mod footprint;
pub mod lobe;
mod nodes;
pub mod reflected;
mod round;
pub mod rules;
pub mod sbrdf;
pub mod signs;
pub mod spec_gloss;
pub mod surface;
pub mod turned;
pub mod two;

pub use filter::{FilterError, Level, Objective, Settings, Texel, filter};
pub use fit::{Centre, Effort, Fitted, Fitter, Shape};
pub use footprint::Footprint;
pub use lobe::{Facet, Lobe};
pub use rules::{RULES, Rule};
pub use surface::{Convention, Field, Surface, TexelFault};
pub use two::Wide;
