//! Tables as values: what is on which axis, where a texel sits, and how a shader will read between texels.
//!
//! The same [`Axis`] is used by the baker (where to integrate), by the reader ([`lookup`]), by metadata and by
//! reports, so that no two of them can disagree.

#[cfg(feature = "unstable")]
pub mod axis;
#[cfg(not(feature = "unstable"))]
pub(crate) mod axis;
pub(crate) mod expression;
#[cfg(feature = "unstable")]
pub mod fit;
#[cfg(not(feature = "unstable"))]
pub(crate) mod fit;
#[cfg(feature = "unstable")]
pub mod layout;
#[cfg(not(feature = "unstable"))]
pub(crate) mod layout;
pub mod lookup;
pub mod provenance;
#[cfg(feature = "unstable")]
pub mod quantity;
#[cfg(not(feature = "unstable"))]
pub(crate) mod quantity;
pub(crate) mod scalar;
#[cfg(feature = "unstable")]
pub mod table;
#[cfg(not(feature = "unstable"))]
pub(crate) mod table;
pub(crate) mod warp;

pub use axis::{Axis, AxisError, Direction, Texel};
pub use fit::{Objective, Texels};
pub use layout::{Grid, GridError, Point};
pub use provenance::Provenance;
pub use quantity::{Base, BaseMap, Quantity};
pub use table::{Channel, Extreme, Table};
pub use warp::Warp;
