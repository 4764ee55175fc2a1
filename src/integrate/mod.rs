//! Quadrature rules and charts. Every rule returns an `Estimate`: a value with its error.
//! This room knows directions and measures, but no BRDF.

pub mod gauss;
pub mod hammersley;
pub mod sobol;
