//! Two round lobes about one normal, a narrow and a wide one with its share: what scratches on a smooth surface look like.
//!
//! The density is `(1 - share) D(alpha) + share D(wide)`. The search goes over the logarithm of the narrow width, that of the ratio of both,
//! the share, and with a free normal its slopes, by the method of Nelder and Mead: from the best single lobe, on nodes that are dense about
//! it and about lobes three and nine times as wide, and then about what was found. A second lobe that wins less than a hundredth of D is left
//! out. Deterministic.

use super::fit::{Centre, Effort, Fitted, Fitter};
use super::footprint::Footprint;
use super::lobe::{self, Facet, LEAST_ALPHA, Lobe};
use crate::math::simplex;
use glam::DVec3;

/// The wide lobe beside a narrow one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wide {
    /// Its width.
    pub alpha: f64,
    /// Its share of the density; 0 where one lobe is enough.
    pub share: f64,
}

/// Where the search begins: logarithm of the ratio of the widths, and the share of the wide lobe.
const STARTS: [[f64; 2]; 3] = [[0.7, 0.4], [1.6, 0.15], [2.5, 0.05]];

/// Charts of the first nodes, in widths of the single lobe.
const CHARTS: [f64; 3] = [0.8, 3.0, 9.0];

/// Part of D that a second lobe has to win.
const WORTH: f64 = 0.01;

/// Steps of the first search from each start, and of the second.
const STEPS: [usize; 2] = [45, 60];

/// What is sought: two lobes about a normal of the frame of the nodes.
#[derive(Debug, Clone, Copy)]
struct Pair {
    normal: DVec3,
    narrow: f64,
    wide: Wide,
}

impl Fitter {
    /// The nearest two lobes, from the nearest single one.
    pub(super) fn two(
        &mut self,
        footprint: &Footprint,
        facets: &[Facet],
        single: Fitted,
        centre: Centre,
    ) -> Fitted {
        let least = footprint.least.max(LEAST_ALPHA);
        let start = single.lobe.alpha_min.max(least);
        let base = lobe::frame(single.lobe.normal);
        let charts = CHARTS.map(|k| [(k * start).min(1.0); 2]);
        let exact = self.effort == Effort::Exact;
        self.place(&base, &charts, 0, facets);
        let mass = footprint.mass;
        let make = |p: &[f64]| pair(p, least);
        let search = |fitter: &Fitter, from: &[f64], step: f64, steps: usize| {
            let rounds = if exact { 3 } else { 1 };
            simplex::minimise(from, step, rounds, steps, &mut |p| fitter.apart(&make(p), &base, mass).0)
        };
        let from = |[ratio, share]: [f64; 2]| vec![libm::log(start), ratio, share];
        let tried = STARTS.map(|s| search(self, &from(s), 0.3, STEPS[0]));
        let value = |p: &Vec<f64>| self.apart(&make(p), &base, mass).0;
        let mut best = tried[0].clone();
        for other in &tried[1..] {
            if value(other) < value(&best) {
                best.clone_from(other);
            }
        }
        let found = make(&best);
        let charts = [found.narrow, found.wide.alpha].map(|a| [a; 2]);
        // more nodes where narrow facets stand apart under a wide lobe
        let last = self.level(found.wide.alpha / least);
        self.place(&base, &charts, last, facets);
        if centre == Centre::Free {
            // slopes in widths of the narrow lobe
            best.extend([0.0, 0.0]);
        }
        let best = search(self, &best, 0.15, STEPS[1] + 20 * (best.len() - 3));
        let found = make(&best);
        let (distance, doubt) = self.apart(&found, &base, mass);
        let alone = Pair { normal: DVec3::Z, narrow: start, wide: Wide { alpha: start, share: 0.0 } };
        if distance > (1.0 - WORTH) * self.apart(&alone, &base, mass).0 {
            let wide = Some(Wide { alpha: single.lobe.alpha_min, share: 0.0 });
            return Fitted { wide, ..single };
        }
        let normal = base[0] * found.normal.x + base[1] * found.normal.y + base[2] * found.normal.z;
        Fitted {
            lobe: Lobe::isotropic(normal, found.narrow),
            wide: Some(found.wide),
            distance,
            doubt: doubt + footprint.merge_error,
            at_limit: found.wide.alpha >= 1.0 - 1e-6,
        }
    }

    /// Places the nodes on one of the fine lattices.
    fn place(&mut self, base: &[DVec3; 3], charts: &[[f64; 2]], lattice: usize, facets: &[Facet]) {
        self.nodes.place(base, charts, &self.fine[lattice], facets);
    }

    /// D of two lobes on the nodes, with its doubt.
    fn apart(&self, pair: &Pair, base: &[DVec3; 3], mass: f64) -> (f64, f64) {
        let Pair { normal, narrow, wide } = *pair;
        let up = base[0] * normal.x + base[1] * normal.y + base[2] * normal.z;
        let above = |alpha: f64| Lobe::isotropic(up, alpha).mass();
        let own = (1.0 - wide.share) * above(narrow) + wide.share * above(wide.alpha);
        let (overlap, doubt) = self.nodes.two(normal, [1.0 / narrow, 1.0 / wide.alpha], wide.share);
        (0.5 * (mass + own) - overlap, doubt)
    }

    /// D between two lobes and a footprint, with its doubt.
    #[must_use]
    pub fn distance_of_two(&mut self, lobe: &Lobe, wide: Wide, footprint: &Footprint) -> (f64, f64) {
        let facets: Vec<Facet> = footprint.facets.iter().map(|f| f.wide(LEAST_ALPHA)).collect();
        let narrow = lobe.alpha_min.max(LEAST_ALPHA);
        let wide = Wide { alpha: wide.alpha.max(LEAST_ALPHA), ..wide };
        let base = lobe::frame(lobe.normal);
        let lattice = self.level(wide.alpha / narrow);
        self.place(&base, &[[narrow; 2], [wide.alpha; 2]], lattice, &facets);
        let (distance, doubt) = self.apart(&Pair { normal: DVec3::Z, narrow, wide }, &base, footprint.mass);
        (distance, doubt + footprint.merge_error)
    }
}

/// The lobes of the variables, within their bounds.
fn pair(p: &[f64], least: f64) -> Pair {
    let narrow = libm::exp(p[0]).clamp(least, 1.0);
    let alpha = (narrow * libm::exp(p[1].abs())).min(1.0);
    let normal = match p.get(3).zip(p.get(4)) {
        Some((x, y)) => DVec3::new(narrow * x, narrow * y, 1.0).normalize(),
        None => DVec3::Z,
    };
    Pair { normal, narrow, wide: Wide { alpha, share: p[2].clamp(0.0, 1.0) } }
}
