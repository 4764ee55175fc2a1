//! Pictures of lobes: polar plots in a plane of incidence, directional albedos over the view, and maps of the hemisphere; of one
//! model or of several beside each other.

mod curves;
mod lobe;
#[cfg(feature = "report")]
mod map;

pub use curves::curves;
pub use lobe::polar;
#[cfg(feature = "report")]
pub use map::map;

use super::drawing::Drawing;
use crate::cancel::Cancelled;
use crate::models::Brdf;
use crate::picture::PictureError;
use crate::tables::TexelError;

/// How a value becomes a radius or a colour; the largest value reaches the rim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum Scale {
    /// Proportional to f.
    Linear,
    /// Proportional to the square root of f.
    Sqrt,
    /// Four decades below the largest value, then nothing.
    Log,
}

/// Decades that the logarithmic scale shows.
const DECADES: f64 = 4.0;

/// Least cosine of the directions that set the scale: some lobes grow without bound towards the horizon, and would leave nothing to
/// see of the rest. Within 0.6 degrees of the horizon they are cut at the rim.
const LEAST_COSINE: f64 = 0.01;

impl Scale {
    /// Where a value stands between nothing and the largest one.
    fn part(self, f: f64, top: f64) -> f64 {
        if !(f > 0.0 && top > 0.0) {
            return 0.0;
        }
        let part = match self {
            Scale::Linear => f / top,
            Scale::Sqrt => (f / top).sqrt(),
            Scale::Log => 1.0 + libm::log10(f / top) / DECADES,
        };
        part.clamp(0.0, 1.0)
    }

    fn words(self) -> String {
        match self {
            Scale::Linear => "f".to_owned(),
            Scale::Sqrt => "square root of f".to_owned(),
            Scale::Log => format!("log f, {DECADES} decades"),
        }
    }
}

/// A model with its parameters.
#[derive(Debug, Clone)]
pub struct Subject<'a> {
    /// What it is called in the picture: its title, and its parameters.
    pub name: String,
    /// The model.
    pub model: &'a dyn Brdf,
}

/// Why a plot cannot be drawn.
#[derive(Debug, thiserror::Error)]
pub enum PlotError {
    /// It was stopped.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// An albedo has no value.
    #[error(transparent)]
    Texel(#[from] TexelError),
}

/// From where the light comes, and how values are shown.
#[derive(Debug, Clone, PartialEq)]
pub struct Look {
    /// Angles of incidence in degrees.
    pub degrees: Vec<f64>,
    /// Azimuth of the plane of incidence from the tangent, in degrees.
    pub azimuth: f64,
    /// How a value becomes a radius or a colour.
    pub scale: Scale,
}

/// A drawn plot.
#[derive(Debug, Clone)]
pub struct Figure(Drawing);

impl Figure {
    /// The plot as SVG.
    #[must_use]
    pub fn svg(&self) -> String {
        self.0.svg()
    }

    /// The plot as an 8-bit RGB PNG, with the same words.
    ///
    /// # Errors
    /// What the PNG encoder says.
    pub fn png(&self) -> Result<Vec<u8>, PictureError> {
        self.0.png()
    }
}

/// The azimuth in words, where it matters.
fn azimuth(subjects: &[Subject<'_>], look: &Look) -> String {
    if subjects.iter().any(|s| s.model.turns()) {
        return format!("; azimuth {} deg from the tangent", crate::math::figures::short(look.azimuth));
    }
    String::new()
}
