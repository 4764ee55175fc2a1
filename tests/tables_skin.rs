//! Tables of skin, volumes, Fresnel factors, sampling and tabulated BRDFs, against values that this program did not make.
#![allow(clippy::unwrap_used, reason = "test")]

mod common;
#[path = "tables_skin/diffusion.rs"]
mod diffusion;
#[path = "tables_skin/fresnel.rs"]
mod fresnel;
#[path = "tables_skin/helpers.rs"]
mod helpers;
#[path = "tables_skin/importance.rs"]
mod importance;
#[path = "tables_skin/line.rs"]
mod line;
#[path = "tables_skin/merl.rs"]
mod merl;
#[path = "tables_skin/preintegrated.rs"]
mod preintegrated;
#[path = "tables_skin/volume.rs"]
mod volume;
