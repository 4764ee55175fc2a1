//! From a scene to the tables that it asks for, with every reason, and to all that was left out.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use serde::Serialize;

use super::Scene;
use super::extension::{self, Asks, GGX};
use super::material::{Interval, Material, MaterialExtension, State};
use crate::math::shown::show;

/// A material as reports name it.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct MaterialRef {
    /// Position in the file; none for glTF's default material.
    pub index: Option<usize>,
    /// Its name, as in the file.
    pub name: Option<String>,
}

impl fmt::Display for MaterialRef {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.index, &self.name) {
            (None, _) => f.write_str("the default material"),
            (Some(index), None) => write!(f, "#{index}"),
            (Some(index), Some(name)) => write!(f, "#{index} \"{}\"", show(name)),
        }
    }
}

/// Who asks for a table, and why.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AskedBy {
    /// The material.
    pub material: MaterialRef,
    /// The layer and its roughness.
    pub why: String,
    /// Smallest and largest roughness that this layer can have.
    pub roughness: [f64; 2],
}

/// A table family that the scene asks for.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Need {
    /// Id of the table family: `ggx`.
    pub table: &'static str,
    /// Smallest and largest roughness over all who ask; perceptual, in [0, 1].
    pub roughness: [f64; 2],
    /// Who asks, in the file's order. Never empty.
    pub asked_by: Vec<AskedBy>,
}

/// Why something asks for no table here.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum LeftOutKind {
    /// It needs none: the picture is complete without it.
    AsksForNothing,
    /// It is never seen.
    Unused,
    /// It needs a table that cannot be baked yet: the picture is not complete.
    NotSupported,
    /// What it needs is not known.
    Unknown,
}

/// Something that was looked at and asks for no table. Nothing is left out in silence.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LeftOut {
    /// Why, in one word for programs.
    pub kind: LeftOutKind,
    /// An extension, `material`, `base layer`, or `file`.
    pub what: String,
    /// Why, in words.
    pub why: String,
    /// The materials that it concerns; empty if it concerns the file.
    pub materials: Vec<MaterialRef>,
}

impl fmt::Display for LeftOut {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const SHOWN: usize = 4;
        write!(f, "{}: {}", show(&self.what), self.why)?;
        for (i, material) in self.materials.iter().take(SHOWN).enumerate() {
            write!(f, "{}{material}", if i == 0 { " (" } else { ", " })?;
        }
        match self.materials.len() {
            0 => Ok(()),
            n if n > SHOWN => write!(f, " and {} more)", n - SHOWN),
            _ => f.write_str(")"),
        }
    }
}

/// All that a scene asks for and all that it does not.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Needs {
    /// The tables to bake.
    pub needs: Vec<Need>,
    /// All else that was looked at.
    pub left_out: Vec<LeftOut>,
}

/// What a scene asks for.
///
/// Each lit material that is used asks for the GGX table of its base layer, and each of its extensions for what
/// the [registry](extension::EXTENSIONS) says. Primitives without a material ask for glTF's default material
/// (metallic 1, roughness 1). A texture on roughness asks for [0, factor], an animation for [0, 1].
///
/// ```
/// use brdfbake::scene::{self, Limits};
/// let text = r#"{ "asset": { "version": "2.0" },
///     "materials": [ { "name": "steel", "pbrMetallicRoughness": { "roughnessFactor": 0.4 } } ],
///     "meshes": [ { "primitives": [ { "attributes": {}, "material": 0 } ] } ] }"#;
/// let scene = scene::read_slice(text.as_bytes(), "steel.gltf", &Limits::default())?;
/// let needs = scene::analyse(&scene);
/// assert_eq!((needs.needs[0].table, needs.needs[0].roughness), ("ggx", [0.4, 0.4]));
/// # Ok::<(), scene::SceneError>(())
/// ```
#[must_use]
pub fn analyse(scene: &Scene) -> Needs {
    let mut needs = Collector::default();
    if scene.primitives == 0 {
        needs.leave(
            LeftOutKind::AsksForNothing,
            "file",
            "it has no mesh primitive, so nothing is shaded",
            None,
        );
    }
    for material in &scene.materials {
        needs.material(material);
    }
    if scene.default_material_used {
        let by = MaterialRef { index: None, name: None };
        let count = scene.primitives_without_material;
        let noun = if count == 1 { "primitive" } else { "primitives" };
        let why = format!("base layer, roughness 1 ({count} {noun} without a material)");
        needs.ask(GGX, by, why, Interval::constant(1.0));
    }
    needs.declared(scene);
    needs.out
}

/// Collects; `places` finds the entry of a reason without a search, for a hostile file has a million of them.
#[derive(Default)]
struct Collector {
    out: Needs,
    places: BTreeMap<(LeftOutKind, String, String), usize>,
}

impl Collector {
    fn ask(&mut self, table: &'static str, material: MaterialRef, why: String, roughness: Interval) {
        let [lo, hi] = [roughness.lo, roughness.hi];
        let by = AskedBy { material, why, roughness: [lo, hi] };
        match self.out.needs.iter_mut().find(|need| need.table == table) {
            Some(need) => {
                need.roughness = [need.roughness[0].min(lo), need.roughness[1].max(hi)];
                need.asked_by.push(by);
            }
            None => self.out.needs.push(Need { table, roughness: [lo, hi], asked_by: vec![by] }),
        }
    }

    /// Equal reasons share one entry: a file with 50 anisotropic materials is one line.
    fn leave(&mut self, kind: LeftOutKind, what: &str, why: &str, material: Option<MaterialRef>) {
        let next = self.out.left_out.len();
        let place = *self.places.entry((kind, what.to_owned(), why.to_owned())).or_insert(next);
        if place == next {
            let [what, why] = [what.to_owned(), why.to_owned()];
            self.out.left_out.push(LeftOut { kind, what, why, materials: Vec::new() });
        }
        if let Some(left) = self.out.left_out.get_mut(place) {
            left.materials.extend(material);
        }
    }

    fn material(&mut self, material: &Material) {
        let by = MaterialRef { index: Some(material.index), name: material.name.clone() };
        if !material.used {
            return self.leave(LeftOutKind::Unused, "material", "no mesh primitive uses it", Some(by));
        }
        if material.unlit() {
            let why = "a constant colour, whatever else the material says";
            return self.leave(LeftOutKind::AsksForNothing, "KHR_materials_unlit", why, Some(by));
        }
        self.base_layer(material, &by);
        for extension in &material.extensions {
            self.extension(extension, &by);
        }
    }

    /// The base layer asks unless it is black, or unless only an extension describes the material.
    fn base_layer(&mut self, material: &Material, by: &MaterialRef) {
        let replaced = material.extensions.iter().any(|e| e.name == "KHR_materials_pbrSpecularGlossiness");
        if replaced && !material.metallic_roughness {
            return;
        }
        // KHR_materials_specular: a factor of 0 disables the reflection, F90 included.
        if material.base_is_black() {
            let why = "no reflection: specularFactor = 0 and metallicFactor = 0";
            return self.leave(LeftOutKind::AsksForNothing, "base layer", why, Some(by.clone()));
        }
        let mut why = format!("base layer, roughness {}", material.roughness);
        for e in &material.extensions {
            if matches!(
                extension::find(&e.name).map(|x| &x.asks),
                Some(Asks::BaseLayer | Asks::RoughnessTexture)
            ) {
                why.push_str(", ");
                why.push_str(&e.name);
            }
        }
        self.ask(GGX, by.clone(), why, material.roughness);
    }

    fn extension(&mut self, extension: &MaterialExtension, by: &MaterialRef) {
        let by = by.clone();
        let name = extension.name.as_str();
        let asks = extension::find(name).map(|x| &x.asks);
        if let State::Off(why) = &extension.state {
            return self.leave(LeftOutKind::AsksForNothing, name, &format!("off: {why}"), Some(by));
        }
        match (asks, extension.roughness) {
            (Some(Asks::Lobe(lobe)), Some(roughness)) => {
                self.ask(lobe.table, by, format!("{}, roughness {roughness}", lobe.layer), roughness);
            }
            (Some(Asks::NotYet { table, .. }), _) => {
                self.leave(LeftOutKind::NotSupported, name, &not_yet(table), Some(by));
            }
            (Some(Asks::Nothing(why)), _) => self.leave(LeftOutKind::AsksForNothing, name, why, Some(by)),
            // Named with the base layer already, or returned before.
            (Some(Asks::BaseLayer | Asks::RoughnessTexture | Asks::Unlit | Asks::Lobe(_)), _) => {}
            (None, _) => self.leave(LeftOutKind::Unknown, name, UNKNOWN, Some(by)),
        }
    }

    /// The extensions that the file declares and no material has brought up yet.
    fn declared(&mut self, scene: &Scene) {
        let lit = scene.materials.iter().filter(|m| m.used && !m.unlit()).flat_map(|m| &m.extensions);
        let mut seen: BTreeSet<&str> = lit.map(|e| e.name.as_str()).collect();
        if scene.materials.iter().any(|m| m.used && m.unlit()) {
            seen.insert("KHR_materials_unlit");
        }
        let all_required: BTreeSet<&String> = scene.extensions_required.iter().collect();
        let mut done = BTreeSet::new();
        for name in scene.extensions_required.iter().chain(&scene.extensions_used) {
            let known = extension::find(name);
            let required = known.is_none() && all_required.contains(name);
            if !done.insert(name) || (seen.contains(name.as_str()) && !required) {
                continue;
            }
            match known.map(|x| &x.asks) {
                None if required => self.leave(LeftOutKind::Unknown, name, UNKNOWN_REQUIRED, None),
                None => self.leave(LeftOutKind::Unknown, name, UNKNOWN, None),
                Some(Asks::Nothing(why)) => self.leave(LeftOutKind::AsksForNothing, name, why, None),
                // A light or a graph belongs to the file; a material extension without a material does nothing.
                Some(Asks::NotYet { table, .. }) if !name.contains("_materials_") => {
                    self.leave(LeftOutKind::NotSupported, name, &not_yet(table), None);
                }
                Some(_) => self.leave(LeftOutKind::AsksForNothing, name, NOT_THERE, None),
            }
        }
    }
}

const NOT_THERE: &str = "declared, but no lit material in use has it";
const UNKNOWN: &str = "unknown extension: what it asks for is not known";
const UNKNOWN_REQUIRED: &str = "unknown extension that the file requires: only materials were read, \
    and what it asks for is not known";

fn not_yet(table: &str) -> String {
    format!("not supported yet; asks for: {table}")
}
