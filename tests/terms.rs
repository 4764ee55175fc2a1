//! The closed-form terms against high-precision reference values and identities.
#![allow(clippy::float_cmp, reason = "exact results are asserted exactly")]
#![allow(clippy::excessive_precision, reason = "reference values are quoted with all their digits")]
#![allow(clippy::unwrap_used, reason = "a test may fail by panicking")]

#[path = "terms/diffusion.rs"]
mod diffusion;
#[path = "terms/fresnel.rs"]
mod fresnel;
#[path = "terms/kelemen.rs"]
mod kelemen;
#[path = "terms/lobes.rs"]
mod lobes;
#[path = "terms/metals.rs"]
mod metals;
#[path = "terms/microfacet.rs"]
mod microfacet;
#[path = "terms/phase.rs"]
mod phase;
#[path = "terms/sampling.rs"]
mod sampling;
#[path = "terms/schlick.rs"]
mod schlick;
#[path = "terms/sheen.rs"]
mod sheen;
#[path = "terms/student_t.rs"]
mod student_t;
#[path = "terms/thin_film.rs"]
mod thin_film;
#[path = "terms/transformed.rs"]
mod transformed;
#[path = "terms/values.rs"]
mod values;
