//! The worst texels as a contact sheet draws them: what they stand for, and the lobe that is written.

use super::record::Place;
use crate::maps::{Footprint, Level, Surface};
use crate::picture::{Coverage, halved};
use serde::{Deserialize, Serialize};

/// Texels that are told so.
const TOLD: usize = 4;

/// Most facets of a texel.
const FACETS: usize = 12;

/// A texel with its footprint.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Pictured {
    /// Level.
    pub level: usize,
    /// Column.
    pub x: usize,
    /// Row.
    pub y: usize,
    /// Facets, merged to at most twelve: slopes along x and y, alpha, weight.
    pub facets: Vec<[f32; 4]>,
    /// The lobe: normal, alpha_max, alpha_min, angle.
    pub lobe: [f32; 6],
    /// The wide lobe beside it, of two: alpha and share.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wide: Option<[f32; 2]>,
}

/// The first of the worst texels.
pub(super) fn pictured(surface: &Surface, levels: &[Level<'_>], worst: &[Place]) -> Vec<Pictured> {
    worst.iter().take(TOLD).filter_map(|p| pictured_texel(surface, levels, p)).collect()
}

#[allow(clippy::cast_possible_truncation, reason = "rounded to f32 on purpose")]
fn pictured_texel(surface: &Surface, levels: &[Level<'_>], place: &Place) -> Option<Pictured> {
    let sizes = halved(surface.size[0], surface.size[1]);
    let cover = [0, 1].map(|axis| {
        let step = |k: usize| Coverage::new(sizes[k][axis], sizes[k + 1][axis]);
        (1..place.level).fold(step(0), |c, k| c.then(&step(k)))
    });
    let mut facets = Vec::new();
    for (y, wy) in cover[1].of(place.y) {
        for (x, wx) in cover[0].of(place.x) {
            facets.push(surface.facet(y * surface.size[0] + x, wx * wy));
        }
    }
    let merged = Footprint::new(facets)?.merged(FACETS);
    let facet = |f: &crate::maps::Facet| {
        let n = f.normal;
        [-n.x / n.z, -n.y / n.z, f.alpha, f.weight].map(|v| v as f32)
    };
    let texel = levels.get(place.level)?.at(place.y * levels[place.level].size[0] + place.x);
    let (lobe, wide) = (texel.lobe(), texel.second());
    let n = lobe.normal;
    Some(Pictured {
        level: place.level,
        x: place.x,
        y: place.y,
        facets: merged.facets.iter().map(facet).collect(),
        lobe: [n.x, n.y, n.z, lobe.alpha_max, lobe.alpha_min, lobe.angle].map(|v| v as f32),
        wide: (wide.share > 0.0).then_some([wide.alpha as f32, wide.share as f32]),
    })
}
