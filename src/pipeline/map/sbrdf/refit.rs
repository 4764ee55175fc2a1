//! Levels of lobes against what their footprints reflect: measured at some texels, or followed at all of them.

use super::super::check::under;
use super::{Colours, texels};
use crate::cancel::{Cancel, Cancelled};
use crate::maps::sbrdf::curve::Texel;
use crate::maps::sbrdf::refit::{Coloured, problem, refit, residual};
use crate::maps::{Effort, Level, Shape, Surface};
use crate::picture::{Coverage, halved};
use crate::plan::map::{MapRequest, SbrdfRequest};
use crate::verify::seeds::Seeds;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Facets of a footprint that are told apart: a regular choice where there are more.
const FACETS: usize = 144;

/// Texels of a level that are measured.
const MEASURED: usize = 8;

/// Residuals against the footprints themselves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MeasuredLobes {
    /// Texels: a seeded choice, or all.
    pub texels: usize,
    /// Mean.
    pub mean: f64,
    /// Largest.
    pub largest: f64,
    /// Mean after a fit to the footprint itself, which the reference mode writes.
    pub refit: f64,
}

/// What stands under the levels.
pub(super) struct Footprints<'a> {
    pub(super) request: &'a MapRequest,
    pub(super) sbrdf: &'a SbrdfRequest,
    pub(super) surface: &'a Surface,
    pub(super) colours: &'a Colours,
    pub(super) levels: &'a [Level<'a>],
}

impl Footprints<'_> {
    /// Measures every level but the first; in the reference mode its texels are replaced by their refits.
    pub(super) fn follow(
        &self,
        lobes: &mut [texels::Flat],
        cancel: &Cancel,
    ) -> Result<Vec<Option<MeasuredLobes>>, Cancelled> {
        let sizes = halved(self.surface.size[0], self.surface.size[1]);
        let exact = self.request.filter.effort == Effort::Exact;
        let mut cover = [0, 1].map(|axis| Coverage::new(self.surface.size[axis], self.surface.size[axis]));
        let mut out = vec![None];
        for k in 1..lobes.len().min(self.levels.len()) {
            cover = [0, 1].map(|axis| cover[axis].then(&Coverage::new(sizes[k - 1][axis], sizes[k][axis])));
            let (level, flat) = (&self.levels[k], &lobes[k].1);
            let stride = flat.len() / level.len().max(1);
            let chosen: Vec<usize> = match level.len() {
                n if exact || n <= MEASURED => (0..n).collect(),
                n => (0..MEASURED as u64).map(|i| Seeds::new((k as u64) << 32 | i).index(n)).collect(),
            };
            let one = |texel: &usize| -> Result<(f64, Texel), Cancelled> {
                cancel.check()?;
                let own = texels::get(&flat[texel * stride..(texel + 1) * stride]);
                let (x, y) = (texel % level.size[0], texel / level.size[0]);
                let filtered = level.at(*texel).lobe();
                let stretched = self.request.filter.shape == Shape::Anisotropic;
                let problem =
                    problem(&self.footprint(&cover, x, y), &filtered, stretched, self.sbrdf.normalise);
                let constants = self.sbrdf.constants();
                Ok((residual(&problem, &own, constants), refit(&problem, &own, constants)))
            };
            let found: Vec<(f64, Texel)> = chosen.par_iter().map(one).collect::<Result<_, _>>()?;
            let n = found.len().max(1) as f64;
            out.push(Some(MeasuredLobes {
                texels: found.len(),
                mean: found.iter().map(|f| f.0).sum::<f64>() / n,
                largest: found.iter().map(|f| f.0).fold(0.0, f64::max),
                refit: found.iter().map(|f| f.1.residual).sum::<f64>() / n,
            }));
            if exact {
                let slots = lobes[k].1.chunks_exact_mut(stride);
                slots.zip(&found).for_each(|(slot, (_, texel))| texels::put(texel, slot));
            }
        }
        Ok(out)
    }

    fn footprint(&self, cover: &[Coverage; 2], x: usize, y: usize) -> Vec<Coloured> {
        let width = self.surface.size[0];
        let facet = |(texel, weight): (usize, f64)| {
            let [a, b, c, d, e, f] = self.colours.at(texel);
            let lobe = self.surface.facet(texel, weight).lobe();
            Coloured { lobe, weight, f0: [a, b, c], diffuse: [d, e, f] }
        };
        under(width, cover, x, y, FACETS).into_iter().map(facet).collect()
    }
}
