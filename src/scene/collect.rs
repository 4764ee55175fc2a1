//! From a scene to what it asks for, material by material and layer by layer.

use std::collections::{BTreeMap, BTreeSet};

use super::Scene;
use super::asks::{Answer, Subject, base};
use super::extension::{self, AREA_LIGHT, Asks, GGX};
use super::factor::Interval;
use super::image::Look;
use super::material::{Material, MaterialExtension, State};
use super::needs::{AskedBy, Id, LeftOut, LeftOutKind, MaterialRef, Need, Needs, Range};
use super::reader::Reader;

/// What a scene asks for, its textures not looked at.
///
/// Each lit material that is used asks for the GGX tables of its base layer, and each of its extensions for what
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
/// assert_eq!(needs.needs[0].table, "ggx");
/// assert_eq!(needs.needs[0].ranges["roughness"].value(), Some(0.4));
/// # Ok::<(), scene::SceneError>(())
/// ```
#[must_use]
pub fn analyse(scene: &Scene) -> Needs {
    analyse_with(scene, &Look::none(), Reader::default())
}

/// What a scene asks for, with what its textures hold, by a shader that reads like this.
#[must_use]
pub fn analyse_with(scene: &Scene, look: &Look, reader: Reader) -> Needs {
    let mut all = Collector { reader, ..Collector::default() };
    all.scene(scene, look);
    all.lights(scene);
    all.out
}

/// Joins what scenes ask for: ranges grow, askers and reasons follow each other.
#[derive(Debug, Default)]
pub struct Joined(Collector);

impl Joined {
    /// Adds a scene's.
    pub fn add(&mut self, scene: Needs) {
        for need in scene.needs {
            match self.0.out.needs.iter_mut().find(|n| n.table == need.table) {
                Some(all) => {
                    for (id, range) in need.ranges {
                        all.ranges.entry(id).and_modify(|r| r.join(&range)).or_insert(range);
                    }
                    all.asked_by.extend(need.asked_by);
                }
                None => self.0.out.needs.push(need),
            }
        }
        for left in scene.left_out {
            self.0.leave(left.kind, &left.what, &left.why, left.materials);
        }
    }

    /// All of it.
    #[must_use]
    pub fn needs(self) -> Needs {
        self.0.out
    }
}

/// Collects; `places` finds the entry of a reason without a search, for a hostile file has a million of them.
#[derive(Debug, Default)]
struct Collector {
    reader: Reader,
    out: Needs,
    places: BTreeMap<(LeftOutKind, String, String), usize>,
}

impl Collector {
    fn scene(&mut self, scene: &Scene, look: &Look) {
        let file = |index, name| MaterialRef { file: scene.file_name.clone(), index, name };
        if scene.primitives == 0 {
            let why = "it has no mesh primitive, so nothing is shaded";
            self.leave(LeftOutKind::AsksForNothing, "file", why, None);
        }
        for material in &scene.materials {
            self.material(material, file(Some(material.index), material.name.clone()), look);
        }
        if scene.default_material_used {
            let count = scene.primitives_without_material;
            let noun = if count == 1 { "primitive" } else { "primitives" };
            let ranges = vec![
                ("roughness", self.reader.roughness(Interval::constant(1.0))),
                ("f0", Interval::constant(1.0)),
            ];
            let more = format!(" ({count} {noun} without a material)");
            self.ask(GGX, "base layer", file(None, None), ranges, &more);
        }
        self.declared(scene);
    }

    /// Area lights fall on every lobe of the scene.
    fn lights(&mut self, scene: &Scene) {
        const NAME: &str = "EXT_lights_area";
        if !scene.extensions_used.iter().chain(&scene.extensions_required).any(|e| e == NAME) {
            return;
        }
        let rough = self.out.needs.iter().filter_map(|n| n.ranges.get("roughness"));
        let (lo, hi) = rough.fold((1.0_f64, 0.0_f64), |(lo, hi), r| (lo.min(r.lo), hi.max(r.hi)));
        if lo > hi {
            return self.leave(LeftOutKind::AsksForNothing, NAME, "no lobe has a roughness", None);
        }
        let by = MaterialRef { file: scene.file_name.clone(), index: None, name: None };
        let spread = super::Spread::Constant;
        self.ask(AREA_LIGHT, "area lights", by, vec![("roughness", Interval { lo, hi, spread })], "");
    }

    fn ask(
        &mut self,
        table: &'static str,
        layer: &'static str,
        material: MaterialRef,
        ranges: Vec<(&'static str, Interval)>,
        more: &str,
    ) {
        // f0 and f90 choose channels; they are no reason that anybody would look for
        let told = ranges.iter().filter(|(id, _)| !matches!(*id, "f0" | "f90"));
        let told: Vec<String> = told.map(|(id, range)| format!("{id} {range}")).collect();
        let why = format!("{layer}, {}{more}", told.join(", "));
        let pairs = ranges.iter().map(|(id, range)| (Id::Borrowed(*id), [range.lo, range.hi])).collect();
        let by = AskedBy { material, layer: layer.into(), why, ranges: pairs };
        let new = ranges.into_iter().map(|(id, range)| (Id::Borrowed(id), Range::new(range)));
        match self.out.needs.iter_mut().find(|need| need.table == table) {
            Some(need) => {
                for (id, range) in new {
                    need.ranges.entry(id).and_modify(|all| all.join(&range)).or_insert(range);
                }
                need.asked_by.push(by);
            }
            None => {
                self.out.needs.push(Need { table: table.into(), ranges: new.collect(), asked_by: vec![by] })
            }
        }
    }

    /// Equal reasons share one entry: a file with 50 anisotropic materials is one line.
    fn leave(
        &mut self,
        kind: LeftOutKind,
        what: &str,
        why: &str,
        materials: impl IntoIterator<Item = MaterialRef>,
    ) {
        let next = self.out.left_out.len();
        let place = *self.places.entry((kind, what.to_owned(), why.to_owned())).or_insert(next);
        if place == next {
            let [what, why] = [what.to_owned(), why.to_owned()];
            self.out.left_out.push(LeftOut { kind, what, why, materials: Vec::new() });
        }
        if let Some(left) = self.out.left_out.get_mut(place) {
            left.materials.extend(materials);
        }
    }

    fn answer(&mut self, what: &str, answers: Vec<Answer>, by: &MaterialRef, more: &str) {
        for answer in answers {
            match answer {
                Answer::Ask { family, layer, ranges } => self.ask(family, layer, by.clone(), ranges, more),
                Answer::Nothing(why) => self.leave(LeftOutKind::AsksForNothing, what, &why, Some(by.clone())),
                Answer::Unknown(why) => self.leave(LeftOutKind::Unknown, what, &why, Some(by.clone())),
            }
        }
    }

    fn material(&mut self, material: &Material, by: MaterialRef, look: &Look) {
        if !material.used {
            return self.leave(LeftOutKind::Unused, "material", "no mesh primitive uses it", Some(by));
        }
        if material.asks(|asks| matches!(asks, Asks::Unlit)) {
            let why = "a constant colour, whatever else the material says";
            return self.leave(LeftOutKind::AsksForNothing, "KHR_materials_unlit", why, Some(by));
        }
        if !material.lit {
            let why = "points and lines without normals are a constant colour";
            return self.leave(LeftOutKind::AsksForNothing, "material", why, Some(by));
        }
        for extension in &material.extensions {
            if let Some(Asks::Replaced(model)) = extension::find(&extension.name).map(|x| &x.asks) {
                let why = format!("replaced shading: {model}; nothing else of the material counts");
                return self.leave(LeftOutKind::ReplacedShading, &extension.name, &why, Some(by));
            }
        }
        let subject = Subject { material, look, reader: &self.reader };
        let (base, named) = (base::asks(&subject), base_names(material));
        let layers: Vec<_> = material.extensions.iter().map(|e| (e, layer(&subject, e))).collect();
        // one line an image, however many of its channels count
        let images: BTreeMap<_, _> =
            material.sampled(false).map(|sampled| (sampled.image, sampled)).collect();
        for (image, sampled) in images {
            if let Some(why) = look.unknown(sampled) {
                let what = image.map_or_else(|| "texture".to_owned(), |i| format!("images[{i}]"));
                let why = format!("not known, so its whole range counts: {why}");
                self.leave(LeftOutKind::Unknown, &what, &why, Some(by.clone()));
            }
        }
        let uncovered: BTreeSet<_> =
            material.sampled(false).filter_map(|s| look.uncovered(s).map(|why| (s.image, why))).collect();
        for (image, why) in uncovered {
            let what = image.map_or_else(|| "texture".to_owned(), |i| format!("images[{i}]"));
            let why = format!("what the mesh covers is not known, so the whole image counts: {why}");
            self.leave(LeftOutKind::Unknown, &what, &why, Some(by.clone()));
        }
        self.answer("base layer", base, &by, &named);
        for (extension, said) in layers {
            self.extension(extension, said, &by, look);
        }
    }

    fn extension(&mut self, extension: &MaterialExtension, said: Vec<Answer>, by: &MaterialRef, look: &Look) {
        let name = extension.name.as_str();
        let by_it = || Some(by.clone());
        if let State::Off(why) = extension.state(look) {
            return self.leave(LeftOutKind::AsksForNothing, name, &format!("off: {why}"), by_it());
        }
        match extension::find(name).map(|x| &x.asks) {
            Some(Asks::Layer(..)) => self.answer(name, said, by, ""),
            Some(Asks::NotYet { table, .. }) => {
                self.leave(LeftOutKind::NotSupported, name, &not_yet(table), by_it());
            }
            Some(Asks::Nothing(why)) => self.leave(LeftOutKind::AsksForNothing, name, why, by_it()),
            Some(Asks::Unknown(why)) => self.leave(LeftOutKind::Unknown, name, why, by_it()),
            // Named with the base layer already, or returned before, or of the file.
            Some(
                Asks::BaseLayer | Asks::RoughnessTexture | Asks::Unlit | Asks::Replaced(_) | Asks::AreaLights,
            ) => {}
            None => self.leave(LeftOutKind::Unknown, name, UNKNOWN, by_it()),
        }
    }

    /// The extensions that the file declares and no material has brought up yet.
    fn declared(&mut self, scene: &Scene) {
        let lit = scene.materials.iter().filter(|m| m.used && m.lit).flat_map(|m| &m.extensions);
        let seen: BTreeSet<&str> = lit.map(|e| e.name.as_str()).collect();
        let all_required: BTreeSet<&String> = scene.extensions_required.iter().collect();
        let mut done = BTreeSet::new();
        for name in scene.extensions_required.iter().chain(&scene.extensions_used) {
            let known = extension::find(name);
            let required = known.is_none() && all_required.contains(name);
            if !done.insert(name) || (seen.contains(name.as_str()) && !required) {
                continue;
            }
            // A light or a graph belongs to the file; a material extension without a material does nothing.
            let of_the_file = !name.contains("_materials_");
            match known.map(|x| &x.asks) {
                None if required => self.leave(LeftOutKind::Unknown, name, UNKNOWN_REQUIRED, None),
                None => self.leave(LeftOutKind::Unknown, name, UNKNOWN, None),
                Some(Asks::Nothing(why)) => self.leave(LeftOutKind::AsksForNothing, name, why, None),
                Some(Asks::Unknown(why)) => self.leave(LeftOutKind::Unknown, name, why, None),
                // asked for when every lobe is known
                Some(Asks::AreaLights) => {}
                Some(Asks::Replaced(model)) if of_the_file => {
                    let why = format!("replaced shading: {model}");
                    self.leave(LeftOutKind::ReplacedShading, name, &why, None);
                }
                Some(Asks::NotYet { table, .. }) if of_the_file => {
                    self.leave(LeftOutKind::NotSupported, name, &not_yet(table), None);
                }
                Some(_) => self.leave(LeftOutKind::AsksForNothing, name, NOT_THERE, None),
            }
        }
    }
}

/// What an extension that is on makes of the material.
fn layer(subject: &Subject<'_>, extension: &MaterialExtension) -> Vec<Answer> {
    match extension::find(&extension.name).map(|x| &x.asks) {
        Some(Asks::Layer(_, asks)) if matches!(extension.state(subject.look), State::On(_)) => asks(subject),
        _ => Vec::new(),
    }
}

/// The extensions that change the base layer, for its reason.
fn base_names(material: &Material) -> String {
    let changes = |e: &&MaterialExtension| {
        matches!(extension::find(&e.name).map(|x| &x.asks), Some(Asks::BaseLayer | Asks::RoughnessTexture))
    };
    material.extensions.iter().filter(changes).map(|e| format!(", {}", e.name)).collect()
}

const NOT_THERE: &str = "declared, but no lit material in use has it";
const UNKNOWN: &str = "unknown extension: what it asks for is not known";
const UNKNOWN_REQUIRED: &str = "unknown extension that the file requires: only materials were read, \
    and what it asks for is not known";

fn not_yet(table: &str) -> String {
    format!("no table for it; asks for: {table}")
}
