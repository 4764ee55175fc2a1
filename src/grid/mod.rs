//! Tables as values: what is on which axis, where a texel sits, and how a shader will read between texels.
//!
//! The same [`Axis`] is used by the baker (where to integrate), by the reader ([`lookup`]), by metadata and by
//! reports, so that no two of them can disagree.

pub mod axis;
pub mod expression;
pub mod fit;
pub mod layout;
pub mod lookup;
pub mod provenance;
pub mod quantity;
pub mod scalar;
pub mod table;
pub mod warp;

pub use axis::{Axis, AxisError, Direction, Texel};
pub use layout::{Grid, GridError};
pub use provenance::Provenance;
pub use quantity::Quantity;
pub use table::{Channel, Table};
pub use warp::Warp;
