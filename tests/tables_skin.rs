//! Tables of skin, volumes, Fresnel factors, sampling and tabulated BRDFs, against values that this program did not make.
#![allow(clippy::unwrap_used, reason = "test")]

mod diffusion;
mod fresnel;
mod helpers;
mod importance;
mod line;
mod merl;
mod preintegrated;
mod volume;
