//! Random walks through a layer of upright fibres: the same light as the solved layer, event by event and never cut.

use super::seeds::Seeds;
use crate::math::special;
use crate::terms::sggx;
use glam::DVec3;

/// Most events of a walk; one that is still inside then counts as lost. Not one in 1e9 lives as long.
const MOST: usize = 1 << 20;

/// The part of `count` walks that leaves on the side of the view, in a layer of unit depth that absorbs nothing.
pub(super) fn reflected(sigma: f64, mu: f64, count: u32, seed: u64) -> f64 {
    let mut seeds = Seeds::new(seed);
    let hits = (0..count).filter(|_| walk(&mut seeds, sigma, mu)).count();
    hits as f64 / f64::from(count)
}

/// Does a walk leave where it came from?
fn walk(seeds: &mut Seeds, sigma: f64, mu: f64) -> bool {
    let mut travel = DVec3::new(-((1.0 - mu) * (1.0 + mu)).max(0.0).sqrt(), 0.0, -mu);
    let mut depth = 0.0;
    for _ in 0..MOST {
        let path = -libm::log1p(-seeds.unit()) / sggx::projected_area(sigma, travel);
        depth -= path * travel.z;
        if !(0.0..=1.0).contains(&depth) {
            break;
        }
        // a visible normal of the ellipsoid is one of the unit sphere, seen along the stretched direction, stretched
        let stretch = DVec3::new(1.0, 1.0, sigma);
        let seen = (-travel * stretch).normalize();
        let radius = seeds.unit().sqrt();
        let (cos, sin) = special::circle(seeds.unit());
        let (t, b) = seen.any_orthonormal_pair();
        let up = ((1.0 - radius) * (1.0 + radius)).max(0.0).sqrt();
        let normal = ((radius * cos * t + radius * sin * b + up * seen) * stretch).normalize();
        travel -= 2.0 * travel.dot(normal) * normal;
    }
    travel.z > 0.0 && depth < 0.0
}
