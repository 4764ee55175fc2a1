//! Where the texture coordinates of meshes lie, for whoever tells which texels they cover.
//!
//! Accessors are described here and read there. One that cannot be described bars its primitive with the reason, and refuses no
//! file: the whole image counts then.
//!
//! Source: glTF 2.0 §3.6.2 (accessors), §3.7.2 (meshes), `KHR_mesh_quantization`, `KHR_texture_transform`.

use super::Limits;
use super::embedded::{Texture, at_uri};
use super::error::Fault;
use super::image::Source;
use super::json::Node;
use super::maps::placed;
use super::material::Material;
use crate::picture::Wrap;
use std::collections::{BTreeMap, BTreeSet};

/// How a material reads an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Reading {
    /// The material.
    pub material: usize,
    /// The set of texture coordinates.
    pub tex_coord: u64,
    /// Bits of offset, rotation and scale.
    transform: [u64; 5],
    /// What lies beyond the border.
    pub wrap: [Wrap; 2],
    /// Are texels mixed?
    pub linear: bool,
    /// Is its transform animated?
    pub moves: bool,
}

impl Reading {
    pub(super) fn new(
        material: usize,
        info: &Node<'_>,
        texture: Texture,
        moves: bool,
    ) -> Result<Reading, Fault> {
        let (tex_coord, transform) = placed(info)?;
        let Texture { wrap, linear, .. } = texture;
        Ok(Reading { material, tex_coord, transform: transform.map(f64::to_bits), wrap, linear, moves })
    }

    /// Does another texture of the material have the same place for the same point of a mesh?
    #[must_use]
    pub fn meets(&self, other: &Reading) -> bool {
        let of = |r: &Reading| (r.tex_coord, r.transform, r.wrap, r.moves);
        of(self) == of(other)
    }

    /// Coordinates of a mesh as the texture is read at: `offset + R scale uv`, with R as engines turn it, counter-clockwise where v
    /// points down: `u' = cos r u + sin r v`, `v' = cos r v - sin r u`.
    #[must_use]
    pub fn place(&self, uv: [f64; 2]) -> [f64; 2] {
        let [x, y, turn, across, down] = self.transform.map(f64::from_bits);
        let (sine, cosine) = libm::sincos(turn);
        let (u, v) = (uv[0] * across, uv[1] * down);
        [x + cosine * u + sine * v, y + cosine * v - sine * u]
    }
}

/// The meshes that read images.
#[derive(Debug, Default)]
pub struct Geometry {
    /// The buffers of their accessors, by position in the file.
    pub buffers: BTreeMap<usize, Source>,
    /// The primitives.
    pub primitives: Vec<Primitive>,
    /// Those of each material that reads an image.
    pub of_material: BTreeMap<usize, Vec<usize>>,
}

/// A mesh primitive.
#[derive(Debug)]
pub struct Primitive {
    /// JSON path, for messages.
    pub at: String,
    /// How its vertices are joined, as OpenGL numbers it.
    pub mode: u64,
    /// Texture coordinates by their set, or why they cannot be read.
    pub sets: BTreeMap<u64, Result<Accessor, String>>,
    /// Indices, or why they cannot be read.
    pub indices: Option<Result<Accessor, String>>,
    /// Is it compressed by `KHR_draco_mesh_compression`? Accessors without a buffer view are then in there.
    pub draco: bool,
}

/// Numbers in a buffer.
#[derive(Debug, Clone)]
pub struct Accessor {
    /// Number of elements.
    pub count: u64,
    /// Numbers of an element: 1 to 3.
    pub numbers: u64,
    /// Their type.
    pub component: Component,
    /// Are integers divided by their largest?
    pub normalized: bool,
    /// The bytes; zeros if none.
    pub view: Option<View>,
    /// Where the first element begins in them.
    pub offset: u64,
    /// Elements that are replaced.
    pub sparse: Option<Sparse>,
}

/// A part of a buffer.
#[derive(Debug, Clone)]
pub struct View {
    /// Position of the buffer in the file.
    pub buffer: usize,
    /// First byte.
    pub offset: u64,
    /// Number of bytes.
    pub length: u64,
    /// From one element to the next; packed if none.
    pub stride: Option<u64>,
    /// The extension that it is compressed by.
    pub compressed: Option<&'static str>,
}

/// Elements that replace others.
#[derive(Debug, Clone)]
pub struct Sparse {
    /// How many.
    pub count: u64,
    /// Which, rising: bytes, where they begin there, and type.
    pub indices: (View, u64, Component),
    /// By what: bytes, and where they begin there.
    pub values: (View, u64),
}

/// Type of a number in a buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Component {
    /// Signed, 8 bits.
    I8,
    /// Unsigned, 8 bits.
    U8,
    /// Signed, 16 bits.
    I16,
    /// Unsigned, 16 bits.
    U16,
    /// Unsigned, 32 bits.
    U32,
    /// Floating point, 32 bits.
    F32,
}

/// As OpenGL numbers them.
const COMPONENTS: [(u64, Component); 6] = [
    (5120, Component::I8),
    (5121, Component::U8),
    (5122, Component::I16),
    (5123, Component::U16),
    (5125, Component::U32),
    (5126, Component::F32),
];

/// Types of indices.
const UNSIGNED: &str = "a component type of indices: 5121, 5123 or 5125";
/// Types of texture coordinates, with those of `KHR_mesh_quantization`.
const COORDINATES: &str = "a component type of coordinates: 5120, 5121, 5122, 5123 or 5126";

/// What an accessor holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Elements {
    /// Places in lists.
    Index,
    /// Texture coordinates.
    Pair,
    /// Positions, normals.
    Vector,
}

/// Extensions of buffer views that are not decoded.
const COMPRESSED: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];

impl Component {
    /// Bytes.
    #[must_use]
    pub const fn size(self) -> u64 {
        match self {
            Component::I8 | Component::U8 => 1,
            Component::I16 | Component::U16 => 2,
            Component::U32 | Component::F32 => 4,
        }
    }

    fn read(node: &Node<'_>, elements: Elements) -> Result<Component, Fault> {
        let indices = elements == Elements::Index;
        let code = node.whole()?;
        let known = COMPONENTS.iter().find(|(c, _)| *c == code).map(|(_, component)| *component);
        let unsigned = |c: &Component| matches!(c, Component::U8 | Component::U16 | Component::U32);
        known.filter(|c| if indices { unsigned(c) } else { *c != Component::U32 }).ok_or_else(|| {
            Fault::Type {
                at: node.path(),
                got: code.to_string(),
                expected: if indices { UNSIGNED } else { COORDINATES },
            }
        })
    }
}

/// The primitives whose materials read images, with the texture coordinates that they are read by.
pub(super) fn read(
    root: &Node<'_>,
    materials: &[Material],
    bin: Option<&[u8]>,
    limits: &Limits,
) -> Result<Geometry, Fault> {
    let sets = |m: &Material| m.sampled(false).filter_map(|s| s.reading).map(|r| r.tex_coord).collect();
    let wanted: Vec<BTreeSet<u64>> = materials.iter().map(sets).collect();
    let mut out = Geometry::default();
    let Some(meshes) = root.get("meshes")? else { return Ok(out) };
    for mesh in meshes.items()? {
        let Some(primitives) = mesh.get("primitives")? else { continue };
        for node in primitives.items()? {
            let mut reads = materials_of(&node, materials)?;
            reads.retain(|m| !wanted[*m].is_empty());
            if reads.is_empty() {
                continue;
            }
            for material in &reads {
                out.of_material.entry(*material).or_default().push(out.primitives.len());
            }
            let sets: BTreeSet<u64> = reads.iter().flat_map(|m| &wanted[*m]).copied().collect();
            out.primitives.push(primitive(root, &node, &sets)?);
        }
    }
    let accessors = out.primitives.iter().flat_map(|p| p.sets.values().chain(&p.indices)).flatten();
    let used: BTreeSet<usize> = accessors.flat_map(Accessor::views).map(|v| v.buffer).collect();
    out.buffers = buffers(root, &used, bin, limits)?;
    Ok(out)
}

/// Where the bytes of buffers are.
pub(super) fn buffers(
    root: &Node<'_>,
    used: &BTreeSet<usize>,
    bin: Option<&[u8]>,
    limits: &Limits,
) -> Result<BTreeMap<usize, Source>, Fault> {
    let mut out = BTreeMap::new();
    let Some(buffers) = root.get("buffers")? else { return Ok(out) };
    for &index in used {
        let Some(buffer) = buffers.item(index)? else { continue };
        let source = match (buffer.get("uri")?, bin) {
            (Some(uri), _) => at_uri(&uri, None, limits)?,
            (None, Some(bin)) if index == 0 => Source::Embedded(bin.to_vec()),
            (None, _) => Source::Missing(format!("buffers[{index}] has no bytes")),
        };
        out.insert(index, source);
    }
    Ok(out)
}

/// The materials that a primitive has: its own, those of variants, and those that stand in for them at a distance.
fn materials_of(node: &Node<'_>, materials: &[Material]) -> Result<BTreeSet<usize>, Fault> {
    let mut open = Vec::new();
    if let Some(own) = node.get("material")? {
        open.push(own.index("materials", materials.len())?);
    }
    if let Some(extensions) = node.get("extensions")?
        && let Some(variants) = extensions.get("KHR_materials_variants")?
    {
        for mapping in variants.need("mappings", "an array of mappings")?.items()? {
            let material = mapping.need("material", "the index of a material")?;
            open.push(material.index("materials", materials.len())?);
        }
    }
    let mut all = BTreeSet::new();
    while let Some(index) = open.pop() {
        if all.insert(index) {
            open.extend(materials.get(index).into_iter().flat_map(|m| &m.lods));
        }
    }
    Ok(all)
}

fn primitive(root: &Node<'_>, node: &Node<'_>, sets: &BTreeSet<u64>) -> Result<Primitive, Fault> {
    let at = node.path();
    let extensions = node.get("extensions")?;
    let draco = extensions.map(|e| e.get("KHR_draco_mesh_compression").map(|d| d.is_some()));
    let mut found = BTreeMap::new();
    for set in sets {
        let key = format!("TEXCOORD_{set}");
        let coordinates = match moved(node, &key)? {
            true => Err(format!("{at}: morph targets move its {key}")),
            false => coordinates(root, node, &key).map_err(|fault| fault.to_string()),
        };
        found.insert(*set, coordinates);
    }
    let indices =
        node.get("indices")?.map(|i| accessor(root, &i, Elements::Index).map_err(|fault| fault.to_string()));
    let mode = node.get("mode")?.map_or(Ok(4), |mode| mode.whole())?;
    Ok(Primitive { at, mode, sets: found, indices, draco: draco.transpose()?.unwrap_or(false) })
}

fn coordinates(root: &Node<'_>, primitive: &Node<'_>, key: &str) -> Result<Accessor, Fault> {
    let attributes = primitive.need("attributes", "an object of accessors")?;
    let index = attributes.need(key, "an accessor, since a texture of the material is read by it")?;
    accessor(root, &index, Elements::Pair)
}

/// Do morph targets change an attribute?
fn moved(primitive: &Node<'_>, key: &str) -> Result<bool, Fault> {
    let Some(targets) = primitive.get("targets")? else { return Ok(false) };
    for target in targets.items()? {
        if target.get(key)?.is_some() {
            return Ok(true);
        }
    }
    Ok(false)
}

/// An accessor of some elements.
pub(super) fn accessor(root: &Node<'_>, index: &Node<'_>, elements: Elements) -> Result<Accessor, Fault> {
    let list = root.need("accessors", "an array of accessors")?;
    let index = index.index("accessors", list.len()?)?;
    let Some(node) = list.item(index)? else {
        return Err(Fault::Missing { at: list.path(), expected: "an accessor" });
    };
    let kind = node.need("type", "the type of an element")?;
    let (expected, numbers) = match elements {
        Elements::Index => ("SCALAR", 1),
        Elements::Pair => ("VEC2", 2),
        Elements::Vector => ("VEC3", 3),
    };
    if kind.text()? != expected {
        let got = format!("\"{}\"", crate::math::shown::show(kind.text()?));
        return Err(Fault::Type { at: kind.path(), got, expected });
    }
    let component = node.need("componentType", "a component type")?;
    Ok(Accessor {
        count: node.need("count", "the number of elements")?.whole()?,
        numbers,
        component: Component::read(&component, elements)?,
        normalized: node.get("normalized")?.map_or(Ok(false), |flag| flag.flag())?,
        view: node.get("bufferView")?.map(|v| view(root, &v)).transpose()?,
        offset: node.whole_or_zero("byteOffset")?,
        sparse: node.get("sparse")?.map(|s| sparse(root, &s)).transpose()?,
    })
}

fn sparse(root: &Node<'_>, node: &Node<'_>) -> Result<Sparse, Fault> {
    let part = |key: &'static str| -> Result<(View, u64), Fault> {
        let part = node.need(key, "bytes of a sparse accessor")?;
        let bytes = view(root, &part.need("bufferView", "the index of a buffer view")?)?;
        Ok((bytes, part.whole_or_zero("byteOffset")?))
    };
    let indices = node.need("indices", "bytes of a sparse accessor")?;
    let component = Component::read(&indices.need("componentType", "a component type")?, Elements::Index)?;
    let (bytes, offset) = part("indices")?;
    Ok(Sparse {
        count: node.need("count", "the number of elements")?.whole()?,
        indices: (bytes, offset, component),
        values: part("values")?,
    })
}

fn view(root: &Node<'_>, index: &Node<'_>) -> Result<View, Fault> {
    let list = root.need("bufferViews", "an array of buffer views")?;
    let index = index.index("bufferViews", list.len()?)?;
    let Some(node) = list.item(index)? else {
        return Err(Fault::Missing { at: list.path(), expected: "a buffer view" });
    };
    let buffers = root.need("buffers", "an array of buffers")?.len()?;
    let mut compressed = None;
    if let Some(extensions) = node.get("extensions")? {
        for name in COMPRESSED {
            compressed = extensions.get(name)?.map(|_| name).or(compressed);
        }
    }
    Ok(View {
        buffer: node.need("buffer", "the index of a buffer")?.index("buffers", buffers)?,
        offset: node.whole_or_zero("byteOffset")?,
        length: node.need("byteLength", "the number of bytes")?.whole()?,
        stride: node.get("byteStride")?.map(|n| n.whole()).transpose()?,
        compressed,
    })
}

impl Accessor {
    /// The buffer views that it reads.
    pub(super) fn views(&self) -> impl Iterator<Item = &View> {
        let sparse = self.sparse.iter().flat_map(|s| [&s.indices.0, &s.values.0]);
        self.view.iter().chain(sparse)
    }
}
