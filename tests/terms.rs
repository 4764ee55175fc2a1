//! The closed-form terms against high-precision reference values and identities.
#![allow(clippy::float_cmp, reason = "exact results are asserted exactly")]
#![allow(clippy::excessive_precision, reason = "reference values are quoted with all their digits")]
#![allow(clippy::unwrap_used, reason = "a test may fail by panicking")]

mod diffusion;
mod fresnel;
mod kelemen;
mod lobes;
mod metals;
mod microfacet;
mod phase;
mod sampling;
mod schlick;
mod sheen;
mod student_t;
mod thin_film;
mod transformed;
mod values;
