//! What is seen at each pixel of a mesh: the nearest triangle under the middle of the pixel, seen along -z without perspective.
//!
//! A depth buffer, not a tree: every triangle is looked at once, and equal depths go to the first. No light is blocked by other parts
//! and none comes from there, in both pictures.

use super::{Hit, PreviewError};
use crate::grid::axis::count;
use crate::plan::scene::Triangle;
use glam::{DMat3, DVec2, DVec3};

/// A normal that is bent away from the view is taken to be as far round as this: engines clamp the cosine.
const LEAST_COSINE: f64 = 1e-3;

/// Triangles inside the unit sphere round the origin, each with the number of its surface.
#[derive(Debug, Clone)]
pub struct Mesh(Vec<(Triangle, usize)>);

impl Mesh {
    /// Moves and shrinks triangles so that the middle of their box lies at the origin and the farthest corner at 1, and turns them by
    /// so many degrees round the upright axis.
    ///
    /// # Errors
    /// [`PreviewError::NoMaterial`] if there is no triangle.
    pub fn new(triangles: Vec<(Triangle, usize)>, degrees: f64, file: &str) -> Result<Mesh, PreviewError> {
        let corners = || triangles.iter().flat_map(|(t, _)| t.corners);
        let none =
            || PreviewError::NoMaterial { file: file.to_owned(), why: "no triangle to shade".to_owned() };
        let first = corners().next().ok_or_else(none)?;
        let (lo, hi) = corners().fold((first, first), |(lo, hi), c| (lo.min(c), hi.max(c)));
        let middle = 0.5 * (lo + hi);
        let size = corners().map(|c| (c - middle).length()).fold(0.0, f64::max);
        if !(size > 0.0 && size.is_finite()) {
            return Err(none());
        }
        let (sine, cosine) = libm::sincos(degrees.to_radians());
        let turn = DMat3::from_cols(DVec3::new(cosine, 0.0, -sine), DVec3::Y, DVec3::new(sine, 0.0, cosine));
        let placed = |(t, surface): (Triangle, usize)| {
            let corners = t.corners.map(|c| turn * ((c - middle) / size));
            (Triangle { corners, normals: t.normals.map(|n| turn * n), ..t }, surface)
        };
        Ok(Mesh(triangles.into_iter().map(placed).collect()))
    }

    /// What is seen at each pixel of a square picture of [-1, 1], rows from the top.
    pub(super) fn hits(&self, size: usize) -> Vec<Option<Hit>> {
        let mut hits: Vec<Option<Hit>> = vec![None; size * size];
        for (triangle, surface) in &self.0 {
            draw(triangle, *surface, size, &mut hits);
        }
        hits
    }
}

fn draw(t: &Triangle, surface: usize, size: usize, hits: &mut [Option<Hit>]) {
    let half = 0.5 * count(size);
    // pixels from the left and from the top
    let flat = t.corners.map(|c| DVec2::new((c.x + 1.0) * half, (1.0 - c.y) * half));
    let [a, b, c] = flat;
    // rows go down: the front is clockwise there
    let area = (b - a).perp_dot(c - a);
    let front = area < 0.0;
    if area == 0.0 || (!front && !t.two_sided) {
        return;
    }
    let lo = a.min(b).min(c);
    let hi = a.max(b).max(c);
    for y in span(lo.y, hi.y, size) {
        for x in span(lo.x, hi.x, size) {
            let p = DVec2::new(count(x) + 0.5, count(y) + 0.5);
            let weight = |u: DVec2, v: DVec2| (v - u).perp_dot(p - u) / area;
            let w = [weight(b, c), weight(c, a), weight(a, b)];
            if w.iter().any(|w| *w < 0.0) {
                continue;
            }
            let mix = |of: &[DVec3; 3]| of[0] * w[0] + of[1] * w[1] + of[2] * w[2];
            let at = mix(&t.corners);
            let Some(hit) = hits.get_mut(y * size + x) else { continue };
            if hit.is_some_and(|h| h.at.z >= at.z) {
                continue;
            }
            let normal = mix(&t.normals).try_normalize().unwrap_or(t.normals[0]);
            *hit = Some(Hit { surface, at, normal: facing(if front { normal } else { -normal }) });
        }
    }
}

/// A normal that looks to the viewer.
fn facing(normal: DVec3) -> DVec3 {
    if normal.z >= LEAST_COSINE {
        return normal;
    }
    DVec3::new(normal.x, normal.y, LEAST_COSINE).normalize()
}

/// Pixels whose middle may lie between two places.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "held within the picture")]
fn span(lo: f64, hi: f64, size: usize) -> std::ops::Range<usize> {
    let hold = |v: f64| v.clamp(0.0, count(size)) as usize;
    hold((lo - 0.5).ceil())..hold((hi - 0.5).floor() + 1.0)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "test")]
    use super::Mesh;
    use crate::plan::scene::Triangle;
    use glam::DVec3;

    fn square(z: f64, flipped: bool) -> [Triangle; 2] {
        let p = |x: f64, y: f64| DVec3::new(x, y, z);
        let one = |corners: [DVec3; 3]| {
            let [a, b, c] = corners;
            let corners = if flipped { [a, c, b] } else { corners };
            Triangle { corners, normals: [DVec3::Z; 3], material: None, two_sided: false }
        };
        [one([p(-1.0, -1.0), p(1.0, -1.0), p(1.0, 1.0)]), one([p(-1.0, -1.0), p(1.0, 1.0), p(-1.0, 1.0)])]
    }

    /// A square of half diagonal 1 about the middle of the box covers `2 / 4` of the picture; the nearer of two is seen, the back is not.
    #[test]
    fn the_nearest_front_is_seen_once_a_pixel() {
        let far = square(0.0, false).map(|t| (t, 0));
        let mesh = Mesh::new(far.to_vec(), 0.0, "x").unwrap();
        let hits = mesh.hits(200);
        let seen = hits.iter().flatten().count();
        // 141.4 pixels a side, and the diagonal counts once
        assert!((seen as f64 - 20000.0).abs() < 300.0, "{seen}");
        let back = square(0.0, true).map(|t| (t, 0));
        assert!(Mesh::new(back.to_vec(), 0.0, "x").unwrap().hits(50).iter().all(Option::is_none));
        // turned by half a turn the back is in front
        assert!(Mesh::new(back.to_vec(), 180.0, "x").unwrap().hits(50).iter().any(Option::is_some));
        let mut both = far.to_vec();
        both.extend(square(0.5, false).map(|t| (t, 1)));
        let hits = Mesh::new(both, 0.0, "x").unwrap().hits(50);
        assert!(hits.iter().flatten().all(|h| h.surface == 1) && hits.iter().any(Option::is_some));
        assert!(Mesh::new(Vec::new(), 0.0, "x").is_err());
    }
}
