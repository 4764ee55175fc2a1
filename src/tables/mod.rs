//! Bakeable tables: the trait, the registry, one file a table, and the one driver loop.
//!
//! To add a table: write `tables/NAME.rs` with a [`TableInfo`], add `pub mod NAME;` and one line to [`TABLES`].

pub mod albedo;
pub mod average_albedo;
pub mod beer_lambert;
pub mod blackbody;
pub mod dfg;
pub mod diffusion_kernel;
pub mod diffusion_profile;
pub mod diffusion_sampling;
pub mod driver;
pub mod fresnel_conductor;
pub mod fresnel_dielectric;
pub mod fresnel_schlick;
pub mod gaussian_fit;
pub mod importance;
pub mod integral;
pub mod kelemen_beckmann;
pub mod masking;
pub mod merl;
pub mod ndf;
pub mod phase_function;
pub mod phase_sampling;
pub mod preintegrated_skin;
pub mod profile;
pub mod skin_transmittance;
pub mod spec;
pub mod spectrum;
pub mod sweep;
pub mod thin_film;
pub mod visibility;

use crate::cite::Cite;
use crate::grid::{Axis, Channel, table::named};
use crate::integrate::Estimate;
use crate::models::Param;
pub use spec::{BindError, Bound, Spec};

/// Every table kind, in the order of `list tables`.
pub static TABLES: &[&TableInfo] = &[
    &dfg::INFO,
    &albedo::INFO,
    &average_albedo::INFO,
    &fresnel_dielectric::INFO,
    &fresnel_conductor::INFO,
    &fresnel_schlick::INFO,
    &thin_film::INFO,
    &ndf::INFO,
    &masking::INFO,
    &visibility::INFO,
    &kelemen_beckmann::INFO,
    &preintegrated_skin::INFO,
    &diffusion_profile::INFO,
    &diffusion_kernel::INFO,
    &diffusion_sampling::INFO,
    &gaussian_fit::INFO,
    &skin_transmittance::INFO,
    &phase_function::INFO,
    &phase_sampling::INFO,
    &beer_lambert::INFO,
    &blackbody::INFO,
    &importance::INFO,
    &merl::INFO,
];

/// A table kind bound to a model, parameters and axes: computes one texel. Pure: no threads, no clamps, no output.
pub trait Baker: Send + Sync {
    /// The value of every channel at a point of the grid, to `tolerance` (absolute), with estimated errors.
    ///
    /// # Errors
    /// [`TexelError`] when a value is not finite or a parameter at this point is out of range.
    fn texel(&self, at: &[f64], tolerance: f64) -> Result<Estimate, TexelError>;

    /// The rule in words, for metadata.
    fn rule(&self) -> String;
}

/// Why a texel has no value. The driver adds where.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TexelError {
    /// NaN or infinity.
    #[error("channel {channel} is {value}")]
    NotFinite {
        /// Channel number.
        channel: usize,
        /// The value.
        value: f64,
    },
    /// The model refuses its parameters here.
    #[error(transparent)]
    Param(#[from] crate::models::ParamError),
}

/// Values in closed form, if the first `channels` of them are finite.
fn closed_form(value: crate::integrate::Sums, channels: usize) -> Result<Estimate, TexelError> {
    finite(Estimate::exact(value), channels)
}

/// An estimate of which the first `channels` values and errors are finite.
fn finite(e: Estimate, channels: usize) -> Result<Estimate, TexelError> {
    for (channel, (&value, &error)) in e.value.iter().zip(&e.error).take(channels).enumerate() {
        if !(value.is_finite() && error.is_finite()) {
            return Err(TexelError::NotFinite { channel, value });
        }
    }
    Ok(e)
}

/// A named set of channels of a table kind.
#[derive(Debug, Clone, Copy)]
pub struct Layout {
    /// Id, as in recipes.
    pub id: &'static str,
    /// One line of meaning: how a shader uses the channels.
    pub doc: &'static str,
    /// Channels in file order.
    pub channels: &'static [ChannelInfo],
}

/// A channel of a layout.
#[derive(Debug, Clone, Copy)]
pub struct ChannelInfo {
    /// Name in files.
    pub id: &'static str,
    /// What the number is, as a formula.
    pub meaning: &'static str,
    /// Values that it can take.
    pub range: [f64; 2],
}

impl ChannelInfo {
    /// As stored in tables and files.
    #[must_use]
    pub fn channel(&self) -> Channel {
        Channel { id: self.id.to_owned(), meaning: self.meaning.to_owned(), range: self.range }
    }
}

/// What a table kind wants of a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ModelUse {
    /// It has none.
    None,
    /// Any model; the default is named.
    Any(&'static str),
    /// A model whose Fresnel factor can be split off (`ModelInfo::splits`); the default is named.
    Split(&'static str),
}

/// Everything that is known of a table kind.
#[derive(Debug)]
pub struct TableInfo {
    /// Id: kebab-case, equal to the file name.
    pub id: &'static str,
    /// Title.
    pub title: &'static str,
    /// Formula.
    pub formula: &'static str,
    /// Sources with equation numbers.
    pub sources: &'static [(Cite, &'static str)],
    /// Quantities that must be on an axis.
    pub coordinates: &'static [&'static str],
    /// Channel layouts; the first is the default.
    pub layouts: &'static [Layout],
    /// What it wants of a model.
    pub model: ModelUse,
    /// Parameters of its own.
    pub params: &'static [Param],
    /// Laws checked on every bake, by id.
    pub laws: &'static [&'static str],
    /// Axes if the recipe gives none.
    pub axes: fn() -> Vec<Axis>,
    /// What to know before using it.
    pub notes: &'static str,
    /// Binds a resolved spec.
    pub bind: fn(&Spec) -> Result<Box<dyn Baker>, BindError>,
}

/// Finds a table kind by id.
#[must_use]
pub fn find(id: &str) -> Option<&'static TableInfo> {
    TABLES.iter().copied().find(|t| t.id == id)
}

/// A point of a table in words: `mu = 0.25, roughness = 0.5`.
#[must_use]
pub fn place(grid: &crate::grid::Grid, texel: usize) -> String {
    crate::grid::table::place(&named(grid, &grid.texel(texel)))
}
