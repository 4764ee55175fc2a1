//! Files that hold several tables taken apart, and RGBD that does not say so.

use super::read::{Claim, Image, Plane};
use crate::grid::Provenance;

impl Image {
    /// The tables of the file, each as a picture of its own; the picture itself where it holds one, or does not say.
    #[must_use]
    pub fn into_parts(self) -> Vec<Image> {
        let Some(Claim::Several(all)) = &self.provenance else { return vec![self] };
        let part = |p: &Provenance| {
            let own = |plane: &Plane| {
                let (part, name) = plane.name.split_once('.')?;
                (part == p.name).then(|| Plane { name: name.to_owned(), ..plane.clone() })
            };
            Image {
                channels: self.channels.iter().filter_map(own).collect(),
                provenance: Some(Claim::Known(Box::new(p.clone()))),
                ..self.clone()
            }
        };
        all.iter().map(part).collect()
    }
}

/// The three values of RGBD of four components in [0, 1].
#[must_use]
pub fn raw_rgbd([r, g, b, d]: [f64; 4]) -> [f64; 3] {
    // codes are whole numbers of 255ths
    [r, g, b].map(|v| libm::pow(v, 2.2) / d.max(1.0 / 255.0))
}
