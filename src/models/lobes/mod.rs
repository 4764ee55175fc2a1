//! What models are put together from: lobes that several of them share, and sums of lobes.
//!
//! Nothing in here is a model of its own: a model file names its lobes, their weights and its parameters.

mod blinn;
mod cosine;
mod diffuse;
mod sum;
mod ward;

pub use blinn::Blinn;
pub use cosine::Cosine;
pub use diffuse::{Diffuse, Reflector, cosine_pdf, cosine_sample};
pub use sum::{Part, Sum};
pub use ward::{Norm, Ward};

/// What a lobe of the first models is divided by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Over {
    /// Nothing: the lobe is a BRDF.
    Nothing,
    /// The incident cosine, which cancels the one of the reflection integral.
    Cosine,
}
