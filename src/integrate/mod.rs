//! Quadrature rules and charts. This room knows directions and measures, but no BRDF.
//!
//! A [`Chart`] spreads nodes over the hemisphere of incident directions so that the peak, the horizon and the plane
//! of incidence are coordinate lines, and so are the creases of a Fresnel factor ([`crease`]); [`refracted`] is the chart of what an interface lets through. [`ladder`] raises its level as the
//! one stopping rule says ([`stop`]): three levels, and a trust that is measured for each chart. Where a model
//! has no chart, [`adaptive`] subdivides the hemisphere instead.

pub mod adaptive;
pub mod broad;
pub mod chart;
pub mod crease;
pub mod density;
pub mod ellipse;
pub mod facet;
pub mod fibre;
pub mod four;
pub mod gauss;
pub mod graded;
pub mod half_vector;
pub mod hammersley;
pub mod hemisphere;
pub mod ladder;
pub mod line;
pub mod lobe;
pub mod nodes;
pub mod refracted;
mod refracted_row;
pub mod slab;
pub mod sobol;
pub mod stop;
pub mod view;

pub use chart::Chart;
pub use crease::Crease;
pub use ellipse::{Edge, FacetLobe};
pub use nodes::{BATCH, MAX_PANELS, Nodes};
pub use stop::{Estimate, MAX_CHANNELS, Sums, Trust};
pub use view::View;
