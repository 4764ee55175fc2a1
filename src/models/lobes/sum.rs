//! Sums of lobes: each part keeps its own chart, and the draws go to the parts by fixed chances.

use crate::integrate::Chart;
use crate::models::{Brdf, Sample};
use glam::{DVec2, DVec3};

/// A part of a [`Sum`].
#[derive(Debug)]
pub struct Part {
    /// Factor of its value.
    pub weight: f64,
    /// How often it is drawn, relative to the others; near its albedo is best.
    pub chance: f64,
    /// The lobe.
    pub lobe: Box<dyn Brdf>,
}

impl Part {
    /// A part whose weight is its reflectance.
    pub fn new(reflectance: f64, lobe: impl Brdf + 'static) -> Part {
        Part { weight: reflectance, chance: reflectance, lobe: Box::new(lobe) }
    }

    /// A part with another weight.
    #[must_use]
    pub fn weighing(mut self, weight: f64) -> Part {
        self.weight = weight;
        self
    }
}

/// `f = sum of weight * lobe`.
#[derive(Debug)]
pub struct Sum {
    parts: Vec<Part>,
}

impl Sum {
    /// From parts of non-negative weight. Those without weight are left out, but for the first.
    #[must_use]
    pub fn new(mut parts: Vec<Part>) -> Sum {
        let black = parts.iter().all(|p| p.weight <= 0.0);
        parts.retain(|p| p.weight > 0.0 || black);
        let mut total: f64 = parts.iter().map(|p| p.chance).sum();
        if total <= 0.0 {
            parts.iter_mut().for_each(|p| p.chance = 1.0);
            total = parts.iter().map(|_| 1.0).sum();
        }
        parts.iter_mut().for_each(|p| p.chance /= total);
        Sum { parts }
    }
}

impl Brdf for Sum {
    fn eval(&self, wo: DVec3, wi: DVec3) -> f64 {
        self.parts.iter().map(|p| p.weight * p.lobe.eval(wo, wi)).sum()
    }

    /// The first number picks the part and is stretched to be used again.
    fn sample(&self, wo: DVec3, u: DVec2) -> Option<Sample> {
        let mut x = u.x;
        for (i, part) in self.parts.iter().enumerate() {
            if x < part.chance || i + 1 == self.parts.len() {
                let again = DVec2::new((x / part.chance).clamp(0.0, 1.0), u.y);
                let wi = part.lobe.sample(wo, again)?.wi;
                return Some(Sample { wi, pdf: self.pdf(wo, wi) });
            }
            x -= part.chance;
        }
        None
    }

    fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        self.parts.iter().map(|p| p.chance * p.lobe.pdf(wo, wi)).sum()
    }

    /// None of its own: see [`Brdf::parts`].
    fn chart(&self) -> Option<Chart> {
        None
    }

    fn turns(&self) -> bool {
        self.parts.iter().any(|p| p.lobe.turns())
    }

    fn parts(&self) -> Option<Vec<(f64, &dyn Brdf)>> {
        Some(self.parts.iter().map(|p| (p.weight, &*p.lobe)).collect())
    }
}
