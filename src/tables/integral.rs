//! Channels of a table that are integrals over incident directions; see [`crate::models::integral`].

use super::{TexelError, finite};
use crate::integrate::{Estimate, View};
pub use crate::models::Functional;
use crate::models::{Brdf, Rules, integral};

/// Integrates the functionals of a model at a view to an absolute tolerance by the best rule that the model knows.
///
/// # Errors
/// [`TexelError::NotFinite`] with the channel.
pub fn integrate(
    model: &dyn Brdf,
    view: impl Into<View>,
    functionals: &[Functional],
    tolerance: f64,
) -> Result<Estimate, TexelError> {
    finite(integral::integrate(model, view, functionals, tolerance, Rules::All), functionals.len())
}

/// The same in the chart of the model, whatever else it knows.
///
/// # Errors
/// [`TexelError::NotFinite`] with the channel.
pub fn integrate_in_chart(
    model: &dyn Brdf,
    view: impl Into<View>,
    functionals: &[Functional],
    tolerance: f64,
) -> Result<Estimate, TexelError> {
    finite(integral::integrate(model, view, functionals, tolerance, Rules::Nodes), functionals.len())
}
