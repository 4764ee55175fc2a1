//! The document: versions, declared extensions, URIs, and which materials are used.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::Value;

use super::embedded;
use super::error::Fault;
use super::geometry::{self, Geometry};
use super::json::Node;
use super::material::{self, Animated, Material, Tables};
use super::mesh::{self, Meshes};
use super::uri::{Checked, check_uri};
use super::{ExternalFile, Limits, Scene, Warning};
use crate::math::shown::show;

/// The scene in a parsed document. The file's name is left empty.
pub(super) fn scene(tree: &Value, bin: Option<&[u8]>, limits: &Limits) -> Result<Scene, Fault> {
    let root = Node::root(tree);
    check_versions(&root)?;
    let count = |key| root.get(key)?.map_or(Ok(0), |section| section.len());
    let textures = embedded::textures(&root)?;
    let counts = Tables { materials: count("materials")?, textures: &textures, texels: limits.texels };
    let animated = animated(&root, counts)?;
    let mut materials = Vec::with_capacity(counts.materials);
    if let Some(section) = root.get("materials")? {
        let still = Animated::new();
        for (index, node) in section.items()?.enumerate() {
            materials.push(material::read(&node, index, counts, animated.get(&index).unwrap_or(&still))?);
        }
    }
    let usage = usage(&root, counts)?;
    mark_used(&mut materials, &usage);
    check_nodes(&root, usage.meshes)?;
    let mut scene = Scene {
        file_name: String::new(),
        materials,
        meshes: usage.meshes,
        primitives: usage.primitives,
        primitives_without_material: usage.without_material,
        default_material_used: usage.default_lit,
        extensions_used: names(&root, "extensionsUsed")?,
        extensions_required: names(&root, "extensionsRequired")?,
        external_files: external_files(&root, limits)?,
        images: Vec::new(),
        geometry: Geometry::default(),
        drawn: Meshes::default(),
        warnings: Vec::new(),
    };
    scene.warnings = declaration_warnings(&scene);
    let shaded = scene.materials.iter().filter(|m| m.used && m.lit);
    let wanted: BTreeSet<usize> = if limits.maps {
        let textures = shaded.flat_map(|m| [&m.maps.normal, &m.maps.roughness, &m.maps.anisotropy]);
        textures.flatten().filter_map(|t| t.image).collect()
    } else {
        shaded.flat_map(|m| m.sampled(limits.colours)).filter_map(|s| s.image).collect()
    };
    scene.images = embedded::images(&root, &wanted, bin, limits)?;
    if limits.texels {
        scene.geometry = geometry::read(&root, &scene.materials, bin, limits)?;
    }
    if limits.meshes {
        scene.drawn = mesh::read(&root, bin, limits)?;
    }
    Ok(scene)
}

/// `asset.version` must be 2.x, and so must `asset.minVersion` if it is there.
fn check_versions(root: &Node<'_>) -> Result<(), Fault> {
    let asset = root.need("asset", "an object with the version")?;
    let two = |at, text: &str| match text.split_once('.') {
        Some(("2", minor)) if !minor.is_empty() && minor.bytes().all(|b| b.is_ascii_digit()) => Ok(()),
        _ => Err(Fault::Version { at, got: show(text) }),
    };
    two("asset.version", asset.need("version", "a string such as \"2.0\"")?.text()?)?;
    match asset.get("minVersion")? {
        Some(version) => two("asset.minVersion", version.text()?),
        None => Ok(()),
    }
}

fn names(root: &Node<'_>, key: &str) -> Result<Vec<String>, Fault> {
    let Some(list) = root.get(key)? else { return Ok(Vec::new()) };
    list.items()?.map(|name| name.text().map(str::to_owned)).collect()
}

/// The material properties that animations change, by material: `KHR_animation_pointer`.
fn animated(root: &Node<'_>, counts: Tables<'_>) -> Result<BTreeMap<usize, Animated>, Fault> {
    let mut out: BTreeMap<usize, Animated> = BTreeMap::new();
    let Some(animations) = root.get("animations")? else { return Ok(out) };
    for animation in animations.items()? {
        let Some(channels) = animation.get("channels")? else { continue };
        for channel in channels.items()? {
            let Some(target) = channel.get("target")? else { continue };
            let Some(extensions) = target.get("extensions")? else { continue };
            let Some(extension) = extensions.get("KHR_animation_pointer")? else { continue };
            let node = extension.need("pointer", "a JSON pointer")?;
            let pointer = node.text()?;
            let Some((index, property)) = pointer.strip_prefix("/materials/").and_then(|p| p.split_once('/'))
            else {
                continue;
            };
            match index.parse::<u64>() {
                Ok(got) => match usize::try_from(got) {
                    Ok(index) if index < counts.materials => {
                        out.entry(index).or_default().insert(property.to_owned());
                    }
                    _ => {
                        return Err(Fault::Index {
                            at: node.path(),
                            got,
                            what: "materials",
                            len: counts.materials,
                        });
                    }
                },
                Err(_) => {
                    let got = format!("the string \"{}\"", show(pointer));
                    return Err(Fault::Type {
                        at: node.path(),
                        got,
                        expected: "/materials/<index>/<property>",
                    });
                }
            }
        }
    }
    Ok(out)
}

/// What the meshes use.
#[derive(Debug, Default)]
struct Usage {
    meshes: usize,
    primitives: usize,
    without_material: usize,
    /// Is glTF's default material on something that is lit?
    default_lit: bool,
    /// Materials, and whether something that is lit has them.
    materials: BTreeMap<usize, bool>,
}

impl Usage {
    fn add(&mut self, material: usize, lit: bool) {
        *self.materials.entry(material).or_default() |= lit;
    }
}

/// The materials that mesh primitives name, and those that a variant may put there instead.
fn usage(root: &Node<'_>, counts: Tables<'_>) -> Result<Usage, Fault> {
    let mut usage = Usage::default();
    let Some(meshes) = root.get("meshes")? else { return Ok(usage) };
    for mesh in meshes.items()? {
        usage.meshes += 1;
        for primitive in mesh.need("primitives", "an array of primitives")?.items()? {
            usage.primitives += 1;
            let lit = is_lit(&primitive)?;
            match primitive.get("material")? {
                Some(material) => usage.add(material.index("materials", counts.materials)?, lit),
                None => {
                    usage.without_material += 1;
                    usage.default_lit |= lit;
                }
            }
            let Some(extensions) = primitive.get("extensions")? else { continue };
            let Some(variants) = extensions.get("KHR_materials_variants")? else { continue };
            for mapping in variants.need("mappings", "an array of mappings")?.items()? {
                let material = mapping.need("material", "the index of a material")?;
                usage.add(material.index("materials", counts.materials)?, lit);
            }
        }
    }
    Ok(usage)
}

/// Triangles get flat normals where they have none; points and lines then have no normal to be lit by (glTF 2.0 §3.9.1, Point and
/// Line Materials).
fn is_lit(primitive: &Node<'_>) -> Result<bool, Fault> {
    /// The first mode of triangles; points and lines are below.
    const TRIANGLES: u64 = 4;
    let mode = primitive.get("mode")?.map_or(Ok(TRIANGLES), |mode| mode.whole())?;
    let Some(attributes) = primitive.get("attributes")? else { return Ok(mode >= TRIANGLES) };
    Ok(mode >= TRIANGLES || attributes.get("NORMAL")?.is_some())
}

/// Marks the materials in use, and those that stand in for them at a distance. Cycles end at what is marked.
fn mark_used(materials: &mut [Material], usage: &Usage) {
    let mut open: Vec<(usize, bool)> = usage.materials.iter().map(|(index, lit)| (*index, *lit)).collect();
    while let Some((index, lit)) = open.pop() {
        let new = |material: &&mut Material| !material.used || (lit && !material.lit);
        if let Some(material) = materials.get_mut(index).filter(new) {
            material.used = true;
            material.lit |= lit;
            open.extend(material.lods.iter().map(|lod| (*lod, lit)));
        }
    }
}

/// Nodes are not walked: their graph decides where a mesh stands, not what it is made of.
fn check_nodes(root: &Node<'_>, meshes: usize) -> Result<(), Fault> {
    let Some(nodes) = root.get("nodes")? else { return Ok(()) };
    for node in nodes.items()? {
        if let Some(mesh) = node.get("mesh")? {
            mesh.index("meshes", meshes)?;
        }
    }
    Ok(())
}

/// Every URI of a buffer or an image, checked and not opened.
fn external_files(root: &Node<'_>, limits: &Limits) -> Result<Vec<ExternalFile>, Fault> {
    let mut files = Vec::new();
    for section in ["buffers", "images"] {
        let Some(list) = root.get(section)? else { continue };
        for item in list.items()? {
            let Some(uri) = item.get("uri")? else { continue };
            let text = uri.text()?;
            match check_uri(text, limits.data_uri_bytes) {
                Ok(Checked::Data { .. }) => {}
                Ok(Checked::Inside(names) | Checked::Above(names)) => {
                    files.push(ExternalFile { at: uri.path(), path: names.join("/") })
                }
                Err(source) => return Err(Fault::Uri { at: uri.path(), uri: show(text), source }),
            }
        }
    }
    Ok(files)
}

/// Extensions that are there but not declared.
fn declaration_warnings(scene: &Scene) -> Vec<Warning> {
    let used: BTreeSet<&str> = scene.extensions_used.iter().map(String::as_str).collect();
    let on_materials: BTreeSet<&String> =
        scene.materials.iter().flat_map(|m| &m.extensions).map(|e| &e.name).collect();
    let missing = |name: &&String| !used.contains(name.as_str());
    let not_declared = on_materials.into_iter().filter(missing);
    let required: BTreeSet<&String> = scene.extensions_required.iter().collect();
    not_declared
        .map(|name| Warning::NotDeclared { extension: name.clone() })
        .chain(
            required
                .into_iter()
                .filter(missing)
                .map(|name| Warning::RequiredNotUsed { extension: name.clone() }),
        )
        .collect()
}
