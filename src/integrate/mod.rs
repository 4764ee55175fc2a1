//! Quadrature rules and charts. This room knows directions and measures, but no BRDF.
//!
//! A [`Chart`] spreads nodes over the hemisphere of incident directions so that the peak, the horizon and the plane
//! of incidence are coordinate lines; [`ladder`] raises its level until two levels agree to a tolerance.

pub mod broad;
pub mod chart;
pub mod facet;
pub mod gauss;
pub mod graded;
pub mod half_vector;
pub mod hammersley;
pub mod hemisphere;
pub mod ladder;
pub mod nodes;
pub mod sobol;

pub use chart::Chart;
pub use ladder::{Estimate, MAX_CHANNELS, Sums};
pub use nodes::{BATCH, MAX_PANELS, Nodes};
