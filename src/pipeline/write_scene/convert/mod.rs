//! Specular-glossiness materials of a scene as metallic-roughness: factors, pictures, and what each conversion costs.
//!
//! The formulas are those of [`spec_gloss`]. A material that is converted loses `KHR_materials_pbrSpecularGlossiness` and what it had for
//! readers without it; the archived extension is then no longer named. Pictures keep their size; where the two of a material
//! differ, the smaller is resampled. Old images and textures stay where they are: their indices are others' too.

mod apply;
mod read;

use crate::cancel::Cancel;
use crate::encode::exr::Exr;
use crate::encode::mips::{self, MipLevel, Mips};
use crate::encode::{EncodeError, Storage};
use crate::grid::Channel;
use crate::maps::spec_gloss;
use crate::picture::{halved, shrink};
use crate::pipeline::write_scene::{Request, SceneWriteError};
use crate::scene::write::{Draft, Raw};
use serde::Serialize;

/// The extension that is converted.
pub const NAME: &str = "KHR_materials_pbrSpecularGlossiness";

/// How materials are converted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mode {
    /// With `KHR_materials_specular` and ior 0: F0, F90 and roughness stay.
    Exact,
    /// By the published conversion, with the core of glTF alone: F0 changes.
    Solve,
}

/// What became of a material.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Converted {
    /// Its index.
    pub material: usize,
    /// Its name.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// How it was converted.
    pub mode: Mode,
    /// Width and height of the pictures; 1 x 1 for factors alone.
    pub size: [usize; 2],
    /// Largest error of F0 over texels and channels, by the formula.
    pub f0_error: f64,
    /// Column and row of that texel.
    pub at: [usize; 2],
    /// Mean over the texels of their largest error.
    pub f0_error_mean: f64,
    /// The same largest error of what is stored, codes of 8 bits.
    pub f0_error_stored: f64,
    /// Largest error of roughness by its code of 8 bits.
    pub roughness_error_stored: f64,
    /// In mode exact: by how much the diffuse part is scaled, seen at mu.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub diffuse_ratio: Vec<DiffuseRatio>,
    /// Error of F0 of each texel, rows from the top; the picture of it is written where a folder for errors is given.
    #[serde(skip)]
    pub errors: Vec<f32>,
}

/// How the diffuse part of an exact conversion changes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct DiffuseRatio {
    /// Cosine of the view.
    pub mu: f64,
    /// Diffuse part of glTF by that of specular-glossiness, under even light.
    pub ratio: f64,
}

/// Views that the ratio is told for.
const VIEWS: [f64; 5] = [1.0, 0.5, 0.2, 0.1, 0.02];

/// [`spec_gloss::diffuse_ratio`] at some views.
#[must_use]
pub fn diffuse_ratios() -> Vec<DiffuseRatio> {
    VIEWS.iter().map(|&mu| DiffuseRatio { mu, ratio: spec_gloss::diffuse_ratio(mu) }).collect()
}

/// The error of F0 of each texel as EXR files, by their names: one for each material that has pictures; smaller levels are means.
///
/// # Errors
/// [`EncodeError`] if the container does not take them.
pub fn error_maps(all: &[Converted], cancel: &Cancel) -> Result<Vec<(String, Vec<u8>)>, EncodeError> {
    let channels = [Channel {
        id: "f0.error".to_owned(),
        meaning: "largest difference of F0 to the specular colour, over the channels".to_owned(),
        range: [0.0, 1.0],
        role: String::new(),
    }];
    let mut out = Vec::new();
    for one in all.iter().filter(|c| c.size != [1, 1]) {
        let provenance_json = serde_json::to_string(one).unwrap_or_default();
        let mut levels = vec![MipLevel { size: one.size, values: one.errors.clone() }];
        for pair in halved(one.size[0], one.size[1]).windows(2) {
            let values = levels.last().map(|l| shrink(&l.values, pair[0], pair[1])).unwrap_or_default();
            levels.push(MipLevel { size: pair[1], values });
        }
        let mips = Mips {
            channels: &channels,
            levels: &levels,
            storage: Storage::Float,
            blocks: &[],
            provenance_json: &provenance_json,
            identity: "",
            cancel,
        };
        for (end, bytes) in mips::encode(&Exr, &mips)? {
            out.push((format!("material{}.f0-error{end}", one.material), bytes));
        }
    }
    Ok(out)
}

/// Why a material cannot be converted.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ConvertError {
    /// A number or an index that cannot be.
    #[error("{at} is {got}, allowed {allowed}")]
    Value {
        /// JSON path.
        at: String,
        /// What it is.
        got: String,
        /// What it may be.
        allowed: &'static str,
    },
    /// An image that is not there, of no format that is read, or damaged.
    #[error("{at}: {why}")]
    Image {
        /// JSON path.
        at: String,
        /// Why not.
        why: String,
    },
    /// Two textures that are not sampled alike.
    #[error(
        "materials[{material}]: its diffuse and its specular-glossiness texture differ in {what}, and the conversion by solving mixes them \
         texel by texel; mode exact keeps them apart"
    )]
    Coordinates {
        /// Index of the material.
        material: usize,
        /// `UV set`, `KHR_texture_transform` or `wrap mode`.
        what: &'static str,
    },
    /// An animation of what is no longer there.
    #[error(
        "an animation changes a number of {NAME} ({pointer}), and what is converted cannot follow it; take the animation out first"
    )]
    Animated {
        /// The JSON pointer.
        pointer: String,
    },
}

/// Converts every material of a draft that has the extension, and takes the extension off the lists.
///
/// # Errors
/// [`SceneWriteError::Convert`], and those of reading images.
pub(super) fn convert(
    draft: &mut Draft,
    request: &Request,
    stem: &str,
    mode: Mode,
) -> Result<Vec<Converted>, SceneWriteError> {
    let text = draft.parts.text.clone();
    let Ok(root) = Raw::new(&text) else { return Ok(Vec::new()) };
    if let Some(pointer) = animated(root) {
        return Err(ConvertError::Animated { pointer }.into());
    }
    let bin = draft.parts.bin.clone();
    let images = read::Images::new(root, bin.as_deref(), request);
    let mut writer = apply::Writer::new(root, stem);
    let mut out = Vec::new();
    for (index, material) in
        root.get("materials").and_then(Raw::items).unwrap_or_default().into_iter().enumerate()
    {
        let Some(own) = material.find(&["extensions", NAME]) else { continue };
        let source = read::SpecGloss::of(own, index, &images)?;
        let name = material.get("name").and_then(|n| n.value().as_str().map(str::to_owned));
        out.push(match mode {
            Mode::Exact => writer.exact(draft, &source, name)?,
            Mode::Solve => writer.solve(draft, material, &source, name)?,
        });
    }
    apply::declare(draft, root, mode, !out.is_empty());
    Ok(out)
}

/// A pointer of an animation to the extension.
fn animated(root: Raw<'_>) -> Option<String> {
    let animations = root.get("animations")?.items()?;
    let channels = animations.iter().filter_map(|a| a.get("channels")?.items()).flatten();
    let pointer = |channel: Raw<'_>| {
        let text = channel.find(&["target", "extensions", "KHR_animation_pointer", "pointer"])?.value();
        text.as_str().filter(|p| p.contains(&format!("/extensions/{NAME}/"))).map(str::to_owned)
    };
    channels.into_iter().find_map(pointer)
}
