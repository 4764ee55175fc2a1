//! Footprints: the facets that a texel of a smaller level stands for, and what is known of them at a glance.

use super::lobe::{Facet, LEAST_ALPHA, Lobe, frame};
use glam::{DMat2, DVec2, DVec3};

/// Most facets that a lobe is fitted to; larger footprints are merged to as many, of neighbours in slope.
pub const MOST_FACETS: usize = 64;

/// Facets with their sums.
#[derive(Debug, Clone, PartialEq)]
pub struct Footprint {
    /// The facets; their weights sum to 1.
    pub facets: Vec<Facet>,
    /// Mean of the unit normals, not normalised.
    pub mean: DVec3,
    /// 1 − |mean|², as the mean square distance of the normals from their mean: it keeps its digits for flat footprints.
    pub spread: f64,
    /// Mean of α²; of two widths the mean of both.
    pub square: f64,
    /// Smallest α.
    pub least: f64,
    /// Part of the density that lies above the mesh.
    pub mass: f64,
    /// Estimate of the D that merging has cost; 0 where the facets are the texels themselves.
    pub merge_error: f64,
}

impl Footprint {
    /// The sums of these facets, whose normals are unit and whose weights sum to 1; none without facets, or where the normals
    /// cancel.
    #[must_use]
    pub fn new(facets: Vec<Facet>) -> Option<Footprint> {
        let (mut mean, mut square, mut least, mut mass) = (DVec3::ZERO, 0.0, f64::INFINITY, 0.0);
        for f in &facets {
            mean += f.normal * f.weight;
            square += 0.5 * (f.alpha * f.alpha + f.alpha_max * f.alpha_max) * f.weight;
            least = least.min(f.alpha);
            mass += f.mass() * f.weight;
        }
        let spread = facets.iter().map(|f| f.weight * (f.normal - mean).length_squared()).sum();
        let usable = mean.length_squared() > 1e-12 && mean.z > 0.0 && square.is_finite();
        usable.then_some(Footprint { facets, mean, spread, square, least, mass, merge_error: 0.0 })
    }

    /// The normalised mean of the unit normals: what the mips of a normal map hold.
    #[must_use]
    pub fn normal(&self) -> DVec3 {
        self.mean.normalize()
    }

    /// True if all facets are one, to the bit.
    #[must_use]
    pub fn is_constant(&self) -> bool {
        let bits = |f: &Facet| [f.alpha, f.alpha_max, f.angle].map(f64::to_bits);
        let same = |f: &Facet, g: &Facet| f.normal == g.normal && bits(f) == bits(g);
        self.facets.first().is_some_and(|first| self.facets.iter().all(|f| same(f, first)))
    }

    /// Density of the footprint: the weighted mean of the facets'. Unit sr⁻¹.
    #[must_use]
    pub fn density(&self, h: DVec3) -> f64 {
        self.facets.iter().map(|f| f.weight * f.density(h)).sum()
    }

    /// Slopes about a normal, in its [`frame`].
    ///
    /// Guard: facets near the horizon of `normal`, or behind it, count as 20 steep.
    #[must_use]
    pub fn slope(normal: DVec3, facet: DVec3) -> DVec2 {
        let [t, b, n] = frame(normal);
        DVec2::new(t.dot(facet), b.dot(facet)) / n.dot(facet).max(0.05)
    }

    /// Covariance of the slopes of the normals, in the frame of the mesh.
    ///
    /// Source: [Olano and Baker 2010](crate::cite::OLANO_BAKER_2010) (the covariance of the filtered map), by differences from the mean.
    #[must_use]
    pub fn covariance(&self) -> DMat2 {
        let slopes = || self.facets.iter().map(|f| (Footprint::slope(DVec3::Z, f.normal), f.weight));
        let mean: DVec2 = slopes().map(|(s, w)| s * w).sum();
        let outer = |s: DVec2| DMat2::from_cols(s * s.x, s * s.y);
        slopes().fold(DMat2::ZERO, |m, (s, w)| m + outer(s - mean) * w)
    }

    /// The footprint with at most `most` facets: again and again the part with the widest spread of normals and widths is cut at its mean;
    /// what is left in a part becomes one facet, widened by the spread in it. Equal facets are merged without loss.
    #[must_use]
    pub fn merged(mut self, most: usize) -> Footprint {
        if self.facets.len() <= most {
            return self;
        }
        let mut facets = std::mem::take(&mut self.facets);
        let unit = self.square.sqrt().max(LEAST_ALPHA);
        let mut parts = vec![Part::new(&facets, 0, unit)];
        while parts.len() < most {
            let widest = (0..parts.len()).fold(0, |w, i| if parts[i].cost > parts[w].cost { i } else { w });
            let Part { start, end, cost, key, mean } = parts[widest];
            if cost <= 0.0 {
                break;
            }
            let cut = start + partition(&mut facets[start..end], |f| KEYS[key](f) < mean);
            if cut == start || cut == end {
                parts[widest].cost = 0.0;
                continue;
            }
            parts[widest] = Part::new(&facets[start..cut], start, unit);
            parts.push(Part::new(&facets[cut..end], cut, unit));
        }
        parts.sort_by_key(|p| p.start);
        for part in parts {
            let (facet, loss) = merge(&facets[part.start..part.end]);
            self.facets.push(facet);
            self.merge_error += loss;
        }
        self
    }
}

/// What parts of a footprint are cut by.
const KEYS: [fn(&Facet) -> f64; 5] = [
    |f| f.normal.x,
    |f| f.normal.y,
    |f| f.alpha,
    // of two widths how much wider the one is, along x and along the diagonal
    |f| if f.is_round() { 0.0 } else { (f.alpha_max - f.alpha) * libm::cos(2.0 * f.angle) },
    |f| if f.is_round() { 0.0 } else { (f.alpha_max - f.alpha) * libm::sin(2.0 * f.angle) },
];

/// Facets in a row.
#[derive(Debug, Clone, Copy)]
struct Part {
    start: usize,
    end: usize,
    /// Weighted sum of squares of the key, from the mean.
    cost: f64,
    /// The key that varies most, and its mean.
    key: usize,
    mean: f64,
}

impl Part {
    /// `unit` is a width of the footprint: variations of slope and of width count alike.
    fn new(facets: &[Facet], start: usize, unit: f64) -> Part {
        let mut part = Part { start, end: start + facets.len(), cost: 0.0, key: 0, mean: 0.0 };
        let weight: f64 = facets.iter().map(|f| f.weight).sum();
        for (key, of) in KEYS.iter().enumerate() {
            let mean = facets.iter().map(|f| f.weight * of(f)).sum::<f64>() / weight;
            let square = |f: &Facet| (of(f) - mean) * (of(f) - mean) * f.weight;
            let cost = facets.iter().map(square).sum::<f64>();
            // rounding of equal values is no spread
            if cost > part.cost && cost > 1e-16 * unit * unit * weight {
                part = Part { cost, key, mean, ..part };
            }
        }
        part
    }
}

/// Moves those that are to the front, in order; returns how many.
fn partition(facets: &mut [Facet], first: impl Fn(&Facet) -> bool) -> usize {
    facets.sort_by_key(|f| !first(f));
    facets.iter().take_while(|f| first(f)).count()
}

/// One facet in place of several: mean normal, and α² that of the mean plus 1.8 times the variance of the slopes along an axis; and an
/// estimate of the D that it costs.
///
/// The factor is what brings GGX nearest to a few lobes that overlap (2 would match their curvature at the peak;
/// `tests/footprints.rs` measures what is lost).
fn merge(facets: &[Facet]) -> (Facet, f64) {
    if let [one] = facets {
        return (*one, 0.0);
    }
    let weight: f64 = facets.iter().map(|f| f.weight).sum();
    let mean = facets.iter().map(|f| f.normal * f.weight).sum::<DVec3>() / weight;
    let square = facets.iter().map(|f| f.alpha * f.alpha * f.weight).sum::<f64>() / weight;
    // the covariance of small slopes has the trace 1 - |N|^2
    let spread = facets.iter().map(|f| f.weight * (f.normal - mean).length_squared()).sum::<f64>() / weight;
    let variance = 0.5 * spread;
    let width = (square + 1.8 * variance).sqrt();
    let root = facets.iter().map(|f| f.alpha * f.weight).sum::<f64>() / weight;
    // a tenth: of the losses that were measured none is above a twelfth
    let loss = 0.1 * weight * (variance / (square + variance)).max((square / (root * root) - 1.0).max(0.0));
    let normal = mean.normalize();
    if facets.iter().all(Facet::is_round) {
        return (Facet::round(normal, width, weight), loss);
    }
    // the frames of neighbours differ by less than their normals do
    let tensor = facets.iter().fold(DMat2::ZERO, |m, f| m + f.square() * f.weight) * (1.0 / weight);
    (Facet::of(&Lobe::from_square(normal, tensor + DMat2::IDENTITY * (1.8 * variance)), weight), loss)
}
