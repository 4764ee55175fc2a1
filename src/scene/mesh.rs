//! Meshes as the nodes of a scene place them, for whoever shades them: positions, normals, the material of each primitive.
//!
//! Skins and morph targets are at rest. An accessor that cannot be described bars its primitive with the reason.
//!
//! Source: glTF 2.0 §3.5 (scenes and nodes), §3.7.2 (meshes).

use super::Limits;
use super::error::Fault;
use super::geometry::{Accessor, Elements, accessor, buffers};
use super::image::Source;
use super::json::{Allowed, Node};
use glam::{DMat4, DQuat, DVec3};
use std::collections::{BTreeMap, BTreeSet};

/// Most nodes with a mesh.
const MOST: usize = 1 << 16;

/// Numbers of a transform.
const FINITE: Allowed = Allowed { lo: -1e30, hi: 1e30, also: None, text: "[-1e30, 1e30]" };

/// Primitives, and where they stand.
#[derive(Debug, Default)]
pub struct Meshes {
    /// The buffers of their accessors, by position in the file.
    pub buffers: BTreeMap<usize, Source>,
    /// The primitives.
    pub shapes: Vec<Shape>,
    /// Primitives with the matrices that nodes place them by.
    pub placed: Vec<(usize, DMat4)>,
}

/// A primitive.
#[derive(Debug)]
pub struct Shape {
    /// JSON path, for messages.
    pub at: String,
    /// How its vertices are joined, as OpenGL numbers it.
    pub mode: u64,
    /// Positions, or why they cannot be read.
    pub positions: Result<Accessor, String>,
    /// Normals, or why they cannot be read; flat if none.
    pub normals: Option<Result<Accessor, String>>,
    /// Indices, or why they cannot be read.
    pub indices: Option<Result<Accessor, String>>,
    /// Is it compressed by `KHR_draco_mesh_compression`?
    pub draco: bool,
    /// Its material; glTF's default if none.
    pub material: Option<usize>,
    /// Is its back shown?
    pub two_sided: bool,
}

/// The meshes of the scene that is shown, or all of them where the file shows none.
pub(super) fn read(root: &Node<'_>, bin: Option<&[u8]>, limits: &Limits) -> Result<Meshes, Fault> {
    let mut out = Meshes::default();
    let Some(meshes) = root.get("meshes")? else { return Ok(out) };
    let mut of_mesh: Vec<Vec<usize>> = Vec::new();
    for mesh in meshes.items()? {
        let mut own = Vec::new();
        if let Some(primitives) = mesh.get("primitives")? {
            for node in primitives.items()? {
                own.push(out.shapes.len());
                out.shapes.push(shape(root, &node)?);
            }
        }
        of_mesh.push(own);
    }
    for (mesh, matrix) in placed(root, of_mesh.len())? {
        out.placed.extend(of_mesh.get(mesh).into_iter().flatten().map(|s| (*s, matrix)));
    }
    if out.placed.is_empty() {
        out.placed = (0..out.shapes.len()).map(|s| (s, DMat4::IDENTITY)).collect();
    }
    let shapes = out.shapes.iter();
    let accessors = shapes.flat_map(|s| std::iter::once(&s.positions).chain(&s.normals).chain(&s.indices));
    let used: BTreeSet<usize> = accessors.flatten().flat_map(Accessor::views).map(|v| v.buffer).collect();
    out.buffers = buffers(root, &used, bin, limits)?;
    Ok(out)
}

fn shape(root: &Node<'_>, node: &Node<'_>) -> Result<Shape, Fault> {
    let said = |fault: Fault| fault.to_string();
    let attributes = node.need("attributes", "an object of accessors")?;
    let positions = match attributes.get("POSITION")? {
        Some(index) => accessor(root, &index, Elements::Vector).map_err(said),
        None => Err("it has no positions".to_owned()),
    };
    let normals = attributes.get("NORMAL")?.map(|i| accessor(root, &i, Elements::Vector).map_err(said));
    let indices = node.get("indices")?.map(|i| accessor(root, &i, Elements::Index).map_err(said));
    let mut draco = false;
    if let Some(extensions) = node.get("extensions")? {
        draco = extensions.get("KHR_draco_mesh_compression")?.is_some();
    }
    let (mut material, mut two_sided) = (None, false);
    if let (Some(index), Some(list)) = (node.get("material")?, root.get("materials")?) {
        let index = index.index("materials", list.len()?)?;
        material = Some(index);
        if let Some(own) = list.item(index)? {
            two_sided = own.get("doubleSided")?.map_or(Ok(false), |flag| flag.flag())?;
        }
    }
    let mode = node.get("mode")?.map_or(Ok(4), |mode| mode.whole())?;
    Ok(Shape { at: node.path(), mode, positions, normals, indices, draco, material, two_sided })
}

/// Meshes with their matrices, nodes in the order of the file's trees. A node that is met again is in a circle, or has two parents,
/// which glTF forbids: it stands once.
fn placed(root: &Node<'_>, meshes: usize) -> Result<Vec<(usize, DMat4)>, Fault> {
    let Some(nodes) = root.get("nodes")? else { return Ok(Vec::new()) };
    let count = nodes.len()?;
    let mut open: Vec<(usize, DMat4)> =
        roots(root, count)?.into_iter().map(|n| (n, DMat4::IDENTITY)).collect();
    open.reverse();
    let mut seen = vec![false; count];
    let mut out = Vec::new();
    while let Some((index, above)) = open.pop() {
        let (Some(node), Some(seen)) = (nodes.item(index)?, seen.get_mut(index)) else { continue };
        if std::mem::replace(seen, true) {
            continue;
        }
        let matrix = above * transform(&node)?;
        if let Some(mesh) = node.get("mesh")? {
            out.push((mesh.index("meshes", meshes)?, matrix));
            if out.len() > MOST {
                return Ok(out);
            }
        }
        if let Some(children) = node.get("children")? {
            let own: Result<Vec<usize>, Fault> = children.items()?.map(|c| c.index("nodes", count)).collect();
            open.extend(own?.into_iter().rev().map(|c| (c, matrix)));
        }
    }
    Ok(out)
}

/// The roots of the scene that is shown; without scenes every node.
fn roots(root: &Node<'_>, count: usize) -> Result<Vec<usize>, Fault> {
    let Some(scenes) = root.get("scenes")? else { return Ok((0..count).collect()) };
    let shown = root.get("scene")?.map_or(Ok(0), |s| s.index("scenes", scenes.len()?))?;
    let Some(scene) = scenes.item(shown)? else { return Ok((0..count).collect()) };
    let Some(nodes) = scene.get("nodes")? else { return Ok(Vec::new()) };
    nodes.items()?.map(|n| n.index("nodes", count)).collect()
}

fn transform(node: &Node<'_>) -> Result<DMat4, Fault> {
    if let Some(matrix) = node.get("matrix")? {
        return numbers::<16>(&matrix).map(|m| DMat4::from_cols_array(&m));
    }
    let three = |key: &str, default: f64| match node.get(key)? {
        Some(values) => numbers::<3>(&values).map(DVec3::from_array),
        None => Ok(DVec3::splat(default)),
    };
    let rotation = match node.get("rotation")? {
        Some(values) => DQuat::from_array(numbers::<4>(&values)?),
        None => DQuat::IDENTITY,
    };
    // one of length 0 turns nothing
    let rotation = if rotation.length_squared() > 0.0 { rotation.normalize() } else { DQuat::IDENTITY };
    Ok(DMat4::from_scale_rotation_translation(three("scale", 1.0)?, rotation, three("translation", 0.0)?))
}

fn numbers<const N: usize>(node: &Node<'_>) -> Result<[f64; N], Fault> {
    let mut out = [0.0; N];
    for (i, slot) in out.iter_mut().enumerate() {
        let Some(value) = node.item(i)? else {
            return Err(Fault::Missing { at: node.path(), expected: "numbers of a transform" });
        };
        *slot = value.number(&FINITE)?;
    }
    Ok(out)
}
