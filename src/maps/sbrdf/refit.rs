//! The lobes of a smaller level against what its footprint reflects: every facet with its own normal, widths and colours.
//!
//! Between roughness and lobes the fast way goes through one lobe of GGX a texel and means of colours ([`curve`](super::curve)). Here the
//! target is the mean of the facets' own reflectance in the frame of the texel; the residual is against that, and [`refit`] follows it
//! with shapes and albedos, from the lobes of the fast way on.

use super::super::lobe::Lobe;
use super::super::reflected::{Prepared, reflected};
use super::Normalise;
use super::curve::{Placed, Texel, placed};
use super::fit::{Problem, Shape};
use super::nodes::Directions;
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// A facet of a footprint with its colours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coloured {
    /// Its lobe, in the frame of the mesh.
    pub lobe: Lobe,
    /// Its share.
    pub weight: f64,
    /// F0 of red, green and blue.
    pub f0: [f64; 3],
    /// Diffuse colour.
    pub diffuse: [f64; 3],
}

/// Steps of a refit.
const STEPS: usize = 20;

/// What a footprint reflects in the frame of the lobe that was filtered from it, of red, green and blue; of two widths if `stretched`.
#[must_use]
pub fn problem(footprint: &[Coloured], filtered: &Lobe, stretched: bool, normalise: Normalise) -> Problem {
    let base =
        if stretched { *filtered } else { Lobe::isotropic(filtered.normal, filtered.alpha_min) }.axes();
    let directions = match stretched {
        true => Directions::stretched([filtered.alpha_max, filtered.alpha_min]),
        false => Directions::new(filtered.alpha_min),
    };
    let facets: Vec<(Prepared, DVec3, &Coloured)> = footprint
        .iter()
        .map(|f| {
            let n = f.lobe.normal;
            let normal = DVec3::new(base[0].dot(n), base[1].dot(n), base[2].dot(n));
            (Prepared::new(&f.lobe).within(&base), normal, f)
        })
        .collect();
    let mut targets: [Vec<Option<f64>>; 3] = [Vec::new(), Vec::new(), Vec::new()];
    for (i, views) in directions.lights.iter().zip(&directions.views) {
        for (o, _) in views {
            let x = 1.0 - i.dot((*i + *o).normalize());
            let s = x * x * x * x * x;
            let mut sum = [0.0; 3];
            for (prepared, normal, facet) in &facets {
                let light = facet.weight * reflected(prepared, *i, *o);
                let lit = normal.dot(*i) > 0.0;
                let floor =
                    if lit { facet.weight * FRAC_1_PI * (1.0 - s) * normal.dot(*o).max(0.0) } else { 0.0 };
                for (c, sum) in sum.iter_mut().enumerate() {
                    let f0 = facet.f0[c];
                    *sum += light * (f0 + (1.0 - f0) * s) + floor * facet.diffuse[c] * (1.0 - f0);
                }
            }
            targets.iter_mut().zip(sum).for_each(|(t, v)| t.push(Some(v)));
        }
    }
    Problem::new(directions, &targets, &[1.0 / 3.0; 3], normalise)
}

/// Relative residual of the lobes of a texel: that of the worst of its colours, black ones aside. `constants`: a reader takes the constant
/// that is written.
#[must_use]
pub fn residual(problem: &Problem, texel: &Texel, constants: bool) -> f64 {
    let lobes: Vec<_> = texel.lobes.iter().map(|p| p.lobe).collect();
    let own = |p: &Placed| if constants { p.constant * p.lobe.largest() } else { 1.0 };
    let of = |c: usize| {
        let albedos: Vec<f64> = std::iter::once(texel.diffuse[c])
            .chain(texel.lobes.iter().map(|p| p.albedo[c] * own(p)))
            .collect();
        problem.left(&lobes, &albedos, c)
    };
    (0..3).map(of).fold(0.0, f64::max)
}

/// Lobes that follow the footprint, from those of a texel on; with their residual. They are never farther from it.
#[must_use]
pub fn refit(problem: &Problem, texel: &Texel, constants: bool) -> Texel {
    let start: Vec<Shape> = texel.lobes.iter().map(|p| Shape::of(&p.lobe)).collect();
    let mut found = placed(&problem.finish(&problem.descend(&start, STEPS)));
    let before = residual(problem, texel, constants);
    found.residual = residual(problem, &found, constants);
    if found.residual <= before { found } else { Texel { residual: before, ..texel.clone() } }
}
