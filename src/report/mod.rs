//! What a person reads: the contents of a file, the differences of two. Everything is returned as text; printing and
//! colours are left to the caller.
//!
//! The room stands above `encode`, whose pictures and comparisons it puts into words.

pub mod analytic;
pub mod chart;
pub mod converge;
pub mod diff;
pub mod difference;
mod drawing;
pub mod inspect;
mod inspect_map;
mod letters;
#[cfg(feature = "report")]
pub mod page;
pub mod plot;
pub mod reading;
pub mod recognise;
pub mod sheet;
pub mod split;
pub mod stress;
pub mod text;

pub use diff::diff;
pub use inspect::inspect;
