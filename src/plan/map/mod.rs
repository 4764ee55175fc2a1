//! Parameter maps that are asked for, and planned: the same request whoever asks, a recipe, the command `map` or a scene.
//!
//! A planned map knows its images: that they are there, their sizes, channels and hashes, and so the names of all of its files. What
//! is in them is judged when it is baked.

mod images;
mod input;
mod judge;
mod output;
pub mod sbrdf;

pub use crate::picture::{Space, Wrap};
pub(crate) use images::ANISOTROPY;
pub use input::{AnisotropyInput, FromLobe, Input, RoughnessInput, Second, Source};
pub use output::{Held, Kind, Output};
pub use sbrdf::SbrdfRequest;

use super::fault::Fault;
use super::faults::Faults;
use super::identity::{self, Hasher};
use super::place::Path;
use crate::encode::mips;
use crate::functions::conversion::By;
use crate::maps::sbrdf::{NORMALISATION, Normalise};
use crate::maps::{self, Centre, Convention, Effort, Objective, Shape};
use crate::picture::halved;
use serde_json::{Value as Json, json};

/// What the map of the roughness holds beside it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Packing {
    /// The other channels of its image, with plain means.
    #[default]
    Image,
    /// Nothing.
    Single,
    /// R, G and B as glTF has them: occlusion, roughness, metallic. What is not there is 1.
    Gltf,
}

impl Packing {
    /// Every packing with its id.
    pub const ALL: [(&'static str, Packing); 3] =
        [("image", Packing::Image), ("single", Packing::Single), ("gltf", Packing::Gltf)];
}

/// Words of the keys of a map, as recipes have them.
pub mod words {
    use super::{By, Centre, Effort, Normalise, Objective, Shape, Space, Wrap};

    /// `normals`: what lobes stand about.
    pub const CENTRES: [(&str, Centre); 2] = [("mean", Centre::Mean), ("fit", Centre::Free)];
    /// `shape`.
    pub const SHAPES: [(&str, Shape); 3] =
        [("isotropic", Shape::Isotropic), ("anisotropic", Shape::Anisotropic), ("two", Shape::Two)];
    /// `effort`.
    pub const EFFORTS: [(&str, Effort); 2] = [("fast", Effort::Fast), ("exact", Effort::Exact)];
    /// `objective`.
    pub const OBJECTIVES: [(&str, Objective); 2] =
        [("normals", Objective::Normals), ("reflected", Objective::Reflected)];
    /// `wrap`.
    pub const WRAPS: [(&str, Wrap); 3] =
        [("repeat", Wrap::Repeat), ("mirror", Wrap::Mirror), ("clamp", Wrap::Clamp)];
    /// `space`.
    pub const SPACES: [(&str, Space); 2] = [("linear", Space::Linear), ("srgb", Space::Srgb)];
    /// `from.rule`.
    pub const RULES: [(&str, By); 2] = [("nearest", By::Nearest), ("formula", By::Formula)];

    /// `sbrdf.normalise`.
    pub const NORMALISE: [(&str, Normalise); 2] =
        [(Normalise::Incident.id(), Normalise::Incident), (Normalise::Largest.id(), Normalise::Largest)];

    /// The word of a value.
    pub fn of<T: PartialEq>(words: &[(&'static str, T)], value: &T) -> &'static str {
        words.iter().find(|(_, v)| v == value).map_or("", |(word, _)| word)
    }
}

/// A map that is asked for.
#[derive(Debug, Clone)]
pub struct MapRequest {
    /// How the names of its files begin: portable, and unique in a plan without regard to case.
    pub name: String,
    /// The normal map; the normals are flat without one.
    pub normal: Option<Input>,
    /// The roughness.
    pub roughness: RoughnessInput,
    /// Facets of two widths; round ones without it.
    pub anisotropy: Option<AnisotropyInput>,
    /// Lobes that are written in its place.
    pub sbrdf: Option<SbrdfRequest>,
    /// What is written beside it.
    pub packing: Packing,
    /// Factor of the roughness: `roughnessFactor` of glTF. What is written stands for a factor of 1.
    pub factor: f64,
    /// How a texel's lobe is found.
    pub filter: maps::Settings,
    /// Files that are written.
    pub outputs: Vec<Output>,
    /// Texels of a level that are measured against the texels of the maps themselves, beside the worst.
    pub check: usize,
    /// Measure every published rule at the same texels.
    pub compare: bool,
}

/// Texels of a level that are measured, if nothing else is said.
pub const CHECK: usize = 32;

impl MapRequest {
    /// The files that it reads.
    #[must_use]
    pub fn files_read(&self) -> Vec<std::path::PathBuf> {
        self.sources().filter(|s| matches!(s, Source::File(_))).map(Source::path).collect()
    }

    /// Images that it is made of.
    fn sources(&self) -> impl Iterator<Item = &Source> {
        let roughness = match &self.roughness {
            RoughnessInput::Image { image, .. } => Some(image),
            RoughnessInput::Constant(_) => None,
        };
        let lobes = self.sbrdf.iter().flat_map(SbrdfRequest::images).map(|(_, image)| image);
        let stretched = self.anisotropy.iter().filter_map(|a| a.image.as_ref());
        self.normal.iter().map(|n| &n.image).chain(roughness).chain(stretched).chain(lobes)
    }

    /// A map with the defaults of a recipe: the rule of this program about the mean normal, one width, KTX2.
    #[must_use]
    pub fn new(name: impl Into<String>, normal: Option<Input>, roughness: RoughnessInput) -> MapRequest {
        MapRequest {
            name: name.into(),
            normal,
            roughness,
            anisotropy: None,
            sbrdf: None,
            packing: Packing::default(),
            factor: 1.0,
            filter: maps::Settings {
                rule: &maps::rules::fit::RULE,
                centre: Centre::Mean,
                shape: Shape::Isotropic,
                effort: Effort::Fast,
                objective: Objective::Normals,
            },
            outputs: vec![Output::new(&crate::encode::ktx2::Ktx2)],
            check: CHECK,
            compare: false,
        }
    }

    /// Everything that was asked for under the keys of a recipe, but for the files of its images, which are told apart by what
    /// is in them.
    #[must_use]
    pub fn canonical(&self) -> Json {
        let Convention { green_down, derive_z, scale, mend } = Convention::default();
        let normal = self.normal.as_ref().map(|n| {
            let c = n.convention;
            let mut out = json!({ "channels": n.used() });
            let mut put = |key: &str, differs: bool, value: Json| {
                if differs {
                    out[key] = value;
                }
            };
            put("green", c.green_down != green_down, json!("down"));
            put("z", c.derive_z != derive_z, json!("derived"));
            put("scale", c.scale.to_bits() != scale.to_bits(), json!(c.scale));
            put("mend", c.mend != mend, json!(c.mend));
            put("signed", n.signed, json!(n.signed));
            put("resample", n.resample, json!(n.resample));
            put("wrap", n.resample, json!(n.wrap.map(|w| words::of(&words::WRAPS, &w))));
            out
        });
        let roughness = match &self.roughness {
            RoughnessInput::Constant(r) => json!(r),
            RoughnessInput::Image { channel, space, gloss, from, image: _ } => {
                let mut out =
                    json!({ "channel": channel, "space": words::of(&words::SPACES, space), "gloss": gloss });
                if let Some(from) = from {
                    let rule = words::of(&words::RULES, &from.by);
                    out["from"] = json!({ "lobe": from.conversion.id, "range": from.range, "log": from.log, "rule": rule });
                    if let Some(Second { channel, angle }) = &from.second {
                        out["from"]["second"] = json!({ "channel": channel, "angle": angle });
                    }
                }
                out
            }
        };
        let filter = &self.filter;
        // in their order: D after storage is that of the first
        let outputs: Vec<String> = self.outputs.iter().map(ToString::to_string).collect();
        let mut whole = json!({
            "normal": normal,
            "roughness": roughness,
            "packing": words::of(&Packing::ALL, &self.packing),
            "factor": self.factor,
            "rule": filter.rule.id,
            "normals": words::of(&words::CENTRES, &filter.centre),
            "shape": words::of(&words::SHAPES, &filter.shape),
            "effort": words::of(&words::EFFORTS, &filter.effort),
            "objective": words::of(&words::OBJECTIVES, &filter.objective),
            "outputs": outputs,
            "check": self.check,
            "compare": self.compare,
        });
        if let Some(AnisotropyInput { image, strength, rotation, wrap, resample }) = &self.anisotropy {
            let mut own = json!({ "image": image.is_some(), "strength": strength, "rotation": rotation });
            if *resample {
                own["wrap"] = json!(wrap.map(|w| words::of(&words::WRAPS, &w)));
            }
            whole["anisotropy"] = own;
        }
        if let Some(sbrdf) = &self.sbrdf {
            whole["sbrdf"] = sbrdf.canonical();
        }
        whole
    }
}

#[cfg(feature = "scene")]
impl MapRequest {
    /// Can it be made?
    ///
    /// # Errors
    /// What is wrong with it.
    pub(crate) fn possible(&self) -> Result<(), Vec<String>> {
        let mut faults = Faults::default();
        let _ = resolve(MapDraft::from(self.clone()), &Path::root(), &mut faults);
        let list: Vec<String> = faults.list.iter().map(|(_, fault)| fault.to_string()).collect();
        if list.is_empty() { Ok(()) } else { Err(list) }
    }
}

/// A map of a [`Plan`](super::Plan): every number in its range, its images found.
#[derive(Debug, Clone)]
pub struct PlannedMap {
    /// What was asked for.
    pub asked: MapRequest,
    /// Width and height of the first level, in texels.
    pub size: [usize; 2],
    /// Numbers in its images: texels times channels, of all of them.
    pub numbers: u64,
    /// Channels of the image of its roughness.
    packed: usize,
    /// Its images.
    pub inputs: Vec<identity::Input>,
    /// Hash over everything that the bytes of its files depend on; see [`identity`].
    pub identity: String,
}

impl PlannedMap {
    /// How the names of its files begin.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.asked.name
    }

    /// Number of its levels.
    #[must_use]
    pub fn levels(&self) -> usize {
        halved(self.size[0], self.size[1]).len()
    }

    /// Channels of a kind of map.
    #[must_use]
    pub fn channels(&self, kind: Kind) -> usize {
        self.asked.channels(kind, self.packed)
    }

    /// Names of its files, kind by kind and output by output.
    #[must_use]
    pub fn files(&self) -> Vec<String> {
        let mut names = Vec::new();
        for kind in self.asked.kinds() {
            for output in &self.asked.outputs {
                let [w, h] = if kind == Kind::Normalisation { NORMALISATION } else { self.size };
                let ends = mips::ends(output.encoder, halved(w, h).len());
                names.extend(ends.iter().map(|end| file(&self.asked.name, kind, end)));
            }
        }
        names
    }

    /// The map as a part of the plan of this name.
    pub(super) fn identified(mut self, plan: &str) -> PlannedMap {
        let hasher = Hasher::new("map")
            .part(plan.as_bytes())
            .part(self.asked.name.as_bytes())
            .part(self.asked.canonical().to_string().as_bytes())
            .inputs(&self.inputs);
        // files of a map name what it was made of
        let named = self.asked.sources().fold(hasher, |h, source| h.part(source.name().as_bytes()));
        self.identity = named.finish();
        self
    }
}

/// Name of a file of a map.
#[must_use]
pub fn file(name: &str, kind: Kind, end: &str) -> String {
    format!("{name}.{}{end}", kind.id())
}

/// A request as its asker could read it.
#[derive(Debug)]
pub(crate) struct MapDraft {
    pub(crate) request: MapRequest,
    /// Could its name not be read?
    pub(crate) no_name: bool,
    /// Could some other key of it not be read? Then it is not judged.
    pub(crate) holes: bool,
}

impl From<MapRequest> for MapDraft {
    fn from(request: MapRequest) -> MapDraft {
        MapDraft { request, no_name: false, holes: false }
    }
}

/// Resolves a map. None if it has a fault, or a part of it could not be read.
pub(super) fn resolve(draft: MapDraft, path: &Path, faults: &mut Faults) -> Option<PlannedMap> {
    if draft.holes {
        return None;
    }
    let before = faults.len();
    judge::judge(&draft.request, path, faults);
    let images = judge::images(&draft.request, path, faults);
    if faults.len() > before || draft.no_name {
        return None;
    }
    let judge::Looked { size, numbers, packed, inputs } = images?;
    Some(PlannedMap { asked: draft.request, size, numbers, packed, inputs, identity: String::new() })
}

/// A fault of a map.
fn fault(why: String, allowed: Option<String>, remedy: Option<&'static str>) -> Fault {
    Fault::Map { why, allowed, remedy }
}
