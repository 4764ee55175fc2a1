//! `brdfbake map --anisotropy`, `--two-lobes`: facets of two widths, and two lobes for many.

use super::Failure;
use crate::maps::Shape;
use crate::picture::Wrap;
use crate::plan::map::{AnisotropyInput, Input};
use std::path::PathBuf;

/// Options of facets of two widths, and of what is written of them.
#[derive(Debug, clap::Args)]
pub(super) struct Facets {
    /// The facets have two widths, as KHR_materials_anisotropy has them: an image with the direction in R and G and the strength in B.
    #[arg(long, value_name = "FILE", requires = "anisotropic", conflicts_with = "two_lobes")]
    anisotropy: Option<PathBuf>,
    /// Strength of the anisotropy of the facets: a factor of the image's (1 if not given), or a number for all.
    #[arg(long, value_name = "NUMBER", requires = "anisotropic", conflicts_with = "two_lobes")]
    anisotropy_strength: Option<f64>,
    /// Turn of the direction of the facets, in radians against the clock from the tangent.
    #[arg(
        long,
        value_name = "RADIANS",
        requires = "anisotropic",
        conflicts_with = "two_lobes",
        allow_negative_numbers = true
    )]
    anisotropy_rotation: Option<f64>,
    /// Fit two lobes about one normal, a narrow and a wide one with its share, and write the wide one beside the roughness.
    #[arg(long, conflicts_with = "anisotropic")]
    two_lobes: bool,
}

impl Facets {
    /// What is written of a texel.
    pub(super) const fn shape(&self, anisotropic: bool) -> Shape {
        match (anisotropic, self.two_lobes) {
            (true, _) => Shape::Anisotropic,
            (_, true) => Shape::Two,
            _ => Shape::Isotropic,
        }
    }

    /// What is asked for, if anything is.
    pub(super) fn request(
        &self,
        normal: Option<&Input>,
        resample: bool,
    ) -> Result<Option<AnisotropyInput>, Failure> {
        let told = self.anisotropy.is_some() || self.anisotropy_strength.is_some();
        if self.anisotropy_rotation.is_some() && !told {
            let why = "there is nothing to turn; give --anisotropy or --anisotropy-strength";
            return Err(Failure::usage(format!("--anisotropy-rotation: {why}")));
        }
        Ok(told.then(|| AnisotropyInput {
            image: self.anisotropy.clone().map(Into::into),
            strength: self.anisotropy_strength.unwrap_or(1.0),
            rotation: self.anisotropy_rotation.unwrap_or(0.0),
            wrap: normal.map_or([Wrap::Repeat; 2], |n| n.wrap),
            resample,
        }))
    }
}
