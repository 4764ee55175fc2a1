//! Bakeable tables: the trait, the registry, one file a table, and the one driver loop.
//!
//! To add a table: write `tables/NAME.rs` with a [`TableInfo`], add `pub(crate) mod NAME;` and one line to [`TABLES`].

pub(crate) mod airlight;
pub(crate) mod airlight_surface;
pub(crate) mod albedo;
#[cfg(feature = "unstable")]
pub mod average_albedo;
#[cfg(not(feature = "unstable"))]
pub(crate) mod average_albedo;
pub(crate) mod beer_lambert;
pub(crate) mod blackbody;
pub(crate) mod compensation;
pub(crate) mod default_axes;
pub(crate) mod dfg;
pub(crate) mod diffusion_kernel;
pub(crate) mod diffusion_profile;
pub(crate) mod diffusion_sampling;
#[cfg(feature = "unstable")]
pub mod driver;
#[cfg(not(feature = "unstable"))]
pub(crate) mod driver;
pub(crate) mod film_sensitivity;
pub(crate) mod fresnel_conductor;
pub(crate) mod fresnel_dielectric;
pub(crate) mod fresnel_schlick;
#[cfg(feature = "unstable")]
pub mod gaussian_fit;
#[cfg(not(feature = "unstable"))]
pub(crate) mod gaussian_fit;
pub(crate) mod generalised_schlick;
pub(crate) mod glass_compensation;
#[cfg(feature = "unstable")]
pub mod importance;
#[cfg(not(feature = "unstable"))]
pub(crate) mod importance;
pub mod integral;
pub(crate) mod kelemen_beckmann;
#[cfg(feature = "unstable")]
pub mod ltc_fit;
#[cfg(not(feature = "unstable"))]
pub(crate) mod ltc_fit;
pub(crate) mod ltc_magnitude;
#[cfg(feature = "unstable")]
pub mod ltc_matrix;
#[cfg(not(feature = "unstable"))]
pub(crate) mod ltc_matrix;
pub(crate) mod masking;
mod memo;
#[cfg(feature = "unstable")]
pub mod merl;
#[cfg(not(feature = "unstable"))]
pub(crate) mod merl;
pub(crate) mod metal;
pub(crate) mod ndf;
pub(crate) mod normals;
mod own;
mod parts;
pub(crate) mod phase_function;
pub(crate) mod phase_sampling;
pub(crate) mod preintegrated_skin;
#[cfg(feature = "unstable")]
pub mod profile;
#[cfg(not(feature = "unstable"))]
pub(crate) mod profile;
mod refine;
mod restated;
pub(crate) mod role;
pub(crate) mod selection;
pub(crate) mod sheen_ltc;
pub(crate) mod sheen_scaling;
mod sides;
pub(crate) mod skin_transmittance;
#[cfg(feature = "unstable")]
pub mod source;
#[cfg(not(feature = "unstable"))]
pub(crate) mod source;
pub mod spec;
pub(crate) mod spectrum;
#[cfg(feature = "unstable")]
pub mod sweep;
#[cfg(not(feature = "unstable"))]
pub(crate) mod sweep;
mod sweepable;
pub(crate) mod thin_film;
pub(crate) mod visibility;

use crate::grid::provenance::Residual;
use crate::grid::{Axis, Channel, Table, table::named};
use crate::integrate::Estimate;
use crate::math::figures::exact;
use crate::models::Param;
pub use default_axes::Setting;
pub use driver::{BakeError, OnMiss};
pub use own::{OwnNumber, OwnTruth, Quadrature};
pub use role::{Lobe, OtherLobe, Role, Weight};
pub use selection::Selection;
pub use source::Source;
pub use spec::{BindError, Bound, Spec};

/// Every table kind, in the order of `list tables`.
pub static TABLES: &[&TableInfo] = &[
    &dfg::INFO,
    &albedo::INFO,
    &average_albedo::INFO,
    &compensation::INFO,
    &glass_compensation::INFO,
    &generalised_schlick::INFO,
    &sheen_scaling::INFO,
    &sheen_ltc::INFO,
    &fresnel_dielectric::INFO,
    &fresnel_conductor::INFO,
    &fresnel_schlick::INFO,
    &thin_film::INFO,
    &film_sensitivity::INFO,
    &ndf::INFO,
    &masking::INFO,
    &visibility::INFO,
    &kelemen_beckmann::INFO,
    &ltc_matrix::INFO,
    &ltc_magnitude::INFO,
    &preintegrated_skin::INFO,
    &diffusion_profile::INFO,
    &diffusion_kernel::INFO,
    &diffusion_sampling::INFO,
    &gaussian_fit::INFO,
    &skin_transmittance::INFO,
    &phase_function::INFO,
    &phase_sampling::INFO,
    &beer_lambert::INFO,
    &airlight::INFO,
    &airlight_surface::INFO,
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

    /// How many texels that follow each other are computed together: 1, or a few where they share their work.
    fn group(&self) -> usize {
        1
    }

    /// The values of a group, or of what is left of one at the end of a table; see [`Baker::texel`].
    fn texels(&self, at: &[&[f64]], tolerance: f64) -> Vec<Result<Estimate, TexelError>> {
        at.iter().map(|at| self.texel(at, tolerance)).collect()
    }

    /// True where one texel costs as much as all of them, so that no plan looks at a few.
    fn is_whole(&self) -> bool {
        false
    }

    /// The rule in words, for metadata.
    fn rule(&self) -> String;

    /// What a shader makes of the channels, where that is not the channels themselves: what errors of reading are
    /// measured on.
    fn decoded(&self) -> Option<&'static [ChannelInfo]> {
        None
    }

    /// Turns the channels at a point into [`Baker::decoded`], in place.
    fn decode(&self, _at: &[f64], _values: &mut crate::integrate::Sums) {}

    /// Where the channels are the parameters of a lobe: how far the lobe of these values is from the model at a point, as L3 and L1
    /// error.
    fn distance(&self, _at: &[f64], _values: &[f64]) -> Option<[f64; 2]> {
        None
    }

    /// What the values themselves leave open where they are parameters of a fit: how far the fits are from what they were
    /// fitted to. Empty for tables of exact values.
    fn residuals(&self, _table: &Table) -> Vec<Residual> {
        Vec::new()
    }
}

/// Why a texel has no value. Whoever knows the point and the names of the channels adds them ([`TexelError::of`]).
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TexelError {
    /// NaN or infinity.
    #[error("channel {channel} is {}", exact(.value))]
    NotFinite {
        /// Channel number.
        channel: usize,
        /// The value.
        value: f64,
    },
    /// A lobe without width has no matrix.
    #[error("the model is a mirror here, a lobe without width; keep the axis off it with `clamp`")]
    NoWidth,
    /// Something that no rule here integrates.
    #[error("there is no rule for {what}")]
    NoRule {
        /// What.
        what: &'static str,
    },
    /// The model refuses its parameters here.
    #[error(transparent)]
    Param(#[from] crate::models::ParamError),
}

/// Values in closed form, if the first `channels` of them are finite.
fn closed_form(value: crate::integrate::Sums, channels: usize) -> Result<Estimate, TexelError> {
    finite(Estimate::exact(value), channels)
}

impl TexelError {
    /// The fault with the name of its channel.
    #[must_use]
    pub fn of<'a>(&self, mut channels: impl Iterator<Item = &'a str>) -> String {
        match self {
            TexelError::NotFinite { channel, value } => {
                let id = channels.nth(*channel).map_or_else(|| format!("channel {channel}"), str::to_owned);
                format!("{id} is {}", exact(value))
            }
            other => other.to_string(),
        }
    }
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
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChannelInfo {
    /// Name in files.
    pub id: &'static str,
    /// What the number is, as a formula.
    pub meaning: &'static str,
    /// Values that it can take.
    pub range: [f64; 2],
    /// What the number is to a law.
    pub role: Role,
}

impl ChannelInfo {
    /// As stored in tables and files.
    #[must_use]
    pub fn channel(&self) -> Channel {
        Channel {
            id: self.id.to_owned(),
            meaning: self.meaning.to_owned(),
            range: self.range,
            role: self.role.name().to_owned(),
        }
    }
}

/// Which channels of a kind may stand together in a table.
#[derive(Debug, Clone, Copy)]
pub enum Mix {
    /// Those of one layout, in its order: the layouts are different integrals.
    Layouts,
    /// Any of all layouts, and these besides.
    Free(&'static [ChannelInfo]),
}

impl Mix {
    /// Channels that are in no layout.
    #[must_use]
    pub fn extra(&self) -> &'static [ChannelInfo] {
        match self {
            Mix::Layouts => &[],
            Mix::Free(extra) => extra,
        }
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
    /// Sources with equation numbers, each with the channels and parameters that it is a source of.
    pub sources: &'static [Source],
    /// Quantities that must be on an axis.
    pub coordinates: &'static [&'static str],
    /// Channel layouts; the first is the default.
    pub layouts: &'static [Layout],
    /// Which channels may stand together.
    pub mix: Mix,
    /// What it wants of a model.
    pub model: ModelUse,
    /// Parameters of its own.
    pub params: &'static [Param],
    /// Laws checked on every bake, by id.
    pub laws: &'static [&'static str],
    /// Axes if the recipe gives none, for the channels and for the model that the kind takes by itself: those that read best.
    /// [`TableInfo::default_axes`] makes them fit other models.
    pub axes: fn(&Setting<'_>) -> Vec<Axis>,
    /// The least tolerance that a table has by default, whatever its outputs could hold: what its rule reaches everywhere on the
    /// default axes. 0 where that is any.
    pub least_tolerance: fn(&Setting<'_>) -> f64,
    /// Is it read between its texels? If not, the error of that is not measured unless the recipe asks for it.
    pub blended: bool,
    /// What to know before using it.
    pub notes: &'static str,
    /// Binds a resolved spec.
    pub bind: fn(&Spec) -> Result<Box<dyn Baker>, BindError>,
}

impl TableInfo {
    /// Every channel that a table of this kind can hold: those of the layouts in order, then the extra ones.
    #[must_use]
    pub fn pool(&self) -> Vec<ChannelInfo> {
        let mut pool: Vec<ChannelInfo> = Vec::new();
        for channel in self.layouts.iter().flat_map(|l| l.channels).chain(self.mix.extra()) {
            if pool.iter().all(|c| c.id != channel.id) {
                pool.push(*channel);
            }
        }
        pool
    }
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
