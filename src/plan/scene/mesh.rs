//! The triangles of a scene where its nodes place them.

use super::numbers::{Bytes, Numbers};
use super::pictures::Pictures;
use crate::scene::{Accessor, Meshes, Scene, Shape};
use glam::{DMat3, DMat4, DVec3};
use std::path::Path;

/// Most triangles of a scene.
const MOST: usize = 1 << 22;

/// A triangle in the space of the scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Triangle {
    /// Its corners, counter-clockwise where its front is seen.
    pub corners: [DVec3; 3],
    /// Unit normals at the corners, on the side of its front.
    pub normals: [DVec3; 3],
    /// Its material; glTF's default if none.
    pub material: Option<usize>,
    /// Is its back shown?
    pub two_sided: bool,
}

impl Pictures {
    /// The triangles of a scene in `folder` that was read with its meshes, and the primitives that are left out, with the reasons.
    #[must_use]
    pub fn triangles(&self, scene: &Scene, folder: &Path) -> (Vec<Triangle>, Vec<String>) {
        let bytes = |source, part| self.part(source, part, folder);
        let (mut all, mut left_out) = (Vec::new(), Vec::new());
        for (shape, matrix) in &scene.drawn.placed {
            let Some(shape) = scene.drawn.shapes.get(*shape) else { continue };
            let whole = all.len();
            if let Err(why) = add(&scene.drawn, shape, matrix, &bytes, &mut all) {
                all.truncate(whole);
                let why = format!("{}: {why}", shape.at);
                if !left_out.contains(&why) {
                    left_out.push(why);
                }
            }
        }
        (all, left_out)
    }
}

fn add<'a>(
    drawn: &'a Meshes,
    shape: &'a Shape,
    matrix: &DMat4,
    bytes: &Bytes<'a>,
    all: &mut Vec<Triangle>,
) -> Result<(), String> {
    let numbers = |accessor: &'a Result<Accessor, String>| {
        let accessor = accessor.as_ref().map_err(Clone::clone)?;
        if shape.draco && accessor.view.is_none() {
            return Err("compressed by KHR_draco_mesh_compression, which is not decoded".to_owned());
        }
        Numbers::new(accessor, &drawn.buffers, bytes)
    };
    let positions = numbers(&shape.positions)?;
    let normals = shape.normals.as_ref().map(numbers).transpose()?;
    let indices = shape.indices.as_ref().map(numbers).transpose()?;
    let linear = DMat3::from_mat4(*matrix);
    let size = linear.determinant();
    if !size.is_finite() || size.abs() < 1e-300 {
        return Err("a node squeezes it flat".to_owned());
    }
    let turned = linear.inverse().transpose();
    let vertices = positions.len();
    let count = indices.as_ref().map_or(vertices, Numbers::len);
    let (figures, of) = triangles(shape.mode, count)?;
    if usize::try_from(figures).map_or(true, |n| n > MOST.saturating_sub(all.len())) {
        return Err(format!("the scene has more than {MOST} triangles"));
    }
    for figure in 0..figures {
        let mut corners = [DVec3::ZERO; 3];
        let mut own = [DVec3::ZERO; 3];
        for (i, k) in of(figure).into_iter().enumerate() {
            let vertex = indices.as_ref().map_or(k, |i| i.index(k));
            if vertex >= vertices {
                return Err(format!("index {vertex}, and there are {vertices} positions"));
            }
            corners[i] = matrix.transform_point3(DVec3::from_array(positions.triple(vertex)));
            if let Some(normals) = normals.as_ref().filter(|n| vertex < n.len()) {
                own[i] = turned * DVec3::from_array(normals.triple(vertex));
            }
        }
        if corners.iter().any(|c| !c.is_finite()) {
            return Err("a position that is no number".to_owned());
        }
        if size < 0.0 {
            // a mirror turns the order of the corners round
            corners.swap(1, 2);
            own.swap(1, 2);
        }
        let [a, b, c] = corners;
        let Some(flat) = (b - a).cross(c - a).try_normalize() else { continue };
        let normals = own.map(|n| n.try_normalize().unwrap_or(flat));
        all.push(Triangle { corners, normals, material: shape.material, two_sided: shape.two_sided });
    }
    Ok(())
}

/// How many triangles there are, and the corners of each.
type Triangles = (u64, fn(u64) -> [u64; 3]);

/// How many triangles so many vertices make, and the corners of each (glTF 2.0 §3.7.2.1).
fn triangles(mode: u64, count: u64) -> Result<Triangles, String> {
    Ok(match mode {
        4 => (count / 3, |k| [3 * k, 3 * k + 1, 3 * k + 2]),
        5 => (count.saturating_sub(2), |k| [k, k + 1 + k % 2, k + 2 - k % 2]),
        6 => (count.saturating_sub(2), |k| [k + 1, k + 2, 0]),
        0..=3 => return Err("points and lines have no surface".to_owned()),
        other => return Err(format!("mode {other}, and there are 0 to 6")),
    })
}
