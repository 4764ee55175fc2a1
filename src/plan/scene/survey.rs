//! Scenes to needs: files read in parallel, each with its pictures, joined in the order in which they were named.

use super::Pictures;
use super::kept::{self, Kept};
use crate::scene::{self, Joined, Limits, Needs, Reader, SceneError};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Which texels of an image count.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Texels {
    /// All.
    #[default]
    Whole,
    /// Those that the meshes cover, as the sampler reads them at the image's own size.
    Referenced,
}

impl Texels {
    /// All of them.
    pub const ALL: [Texels; 2] = [Texels::Whole, Texels::Referenced];

    /// Id.
    #[must_use]
    pub const fn id(self) -> &'static str {
        match self {
            Texels::Whole => "whole",
            Texels::Referenced => "referenced",
        }
    }
}

/// How scenes are looked at.
#[derive(Debug, Clone)]
pub struct SurveyOptions {
    /// The folder below which files may be read; that of each scene if none.
    pub root: Option<PathBuf>,
    /// Most pixels of an image.
    pub pixels: u64,
    /// How a shader takes roughness.
    pub reader: Reader,
    /// Which texels count.
    pub texels: Texels,
}

impl Default for SurveyOptions {
    fn default() -> SurveyOptions {
        SurveyOptions {
            root: None,
            pixels: super::PIXELS,
            reader: Reader::default(),
            texels: Texels::default(),
        }
    }
}

/// A scene that was read.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Surveyed {
    /// Its path below the folder that all scenes share, `/` between names.
    pub file: String,
    /// blake3 of the file, in hex.
    pub hash: String,
    /// Number of materials.
    pub materials: usize,
    /// Number of images that were looked at.
    pub images: usize,
    /// What is odd about it.
    pub warnings: Vec<String>,
}

/// What scenes need, together.
#[derive(Debug, Clone, PartialEq)]
pub struct Survey {
    /// The scenes, in the order in which they were named.
    pub scenes: Vec<Surveyed>,
    /// What they need.
    pub needs: Needs,
}

/// Reads scenes and their pictures.
///
/// # Errors
/// Every scene that is refused, in order; then nothing is planned.
pub fn survey(files: &[PathBuf], options: &SurveyOptions) -> Result<Survey, Vec<SceneError>> {
    survey_with(files, options, &mut Kept::default()).map(|(survey, _)| survey)
}

/// As [`survey`], with what earlier runs found; what is new is kept. Says also how many files were read.
///
/// # Errors
/// As [`survey`].
pub fn survey_with(
    files: &[PathBuf],
    options: &SurveyOptions,
    kept: &mut Kept,
) -> Result<(Survey, usize), Vec<SceneError>> {
    let names = names(files);
    let pictures = Pictures::new(options.root.clone(), options.pixels);
    let known: &Kept = kept;
    let one = |path: &PathBuf| match known.find(path) {
        Some(entry) => Ok(FoundFile { all: (entry.scene.clone(), entry.needs.clone()), new: None }),
        None => look(path, &pictures, options),
    };
    let read: Vec<_> = files.par_iter().map(one).collect();
    let (mut faults, mut count) = (Vec::new(), 0);
    let mut scenes = Vec::with_capacity(files.len());
    let mut joined = Joined::default();
    for ((result, path), name) in read.into_iter().zip(files).zip(names) {
        match result {
            Ok(FoundFile { all, new }) => {
                if let Some((before, touched)) = new {
                    count += 1;
                    kept.keep(path, before, touched, &all);
                }
                let (mut scene, mut needs) = all;
                needs.rename(&scene.file, &name);
                scene.file = name;
                scenes.push(scene);
                joined.add(needs);
            }
            Err(fault) => faults.push(fault),
        }
    }
    if faults.is_empty() { Ok((Survey { scenes, needs: joined.needs() }, count)) } else { Err(faults) }
}

/// Of a scene that was read now: size and time of change of its file before, and the files of its pictures.
type New = (Option<kept::Stamp>, Vec<PathBuf>);

/// What was found in a scene.
struct FoundFile {
    all: (Surveyed, Needs),
    new: Option<New>,
}

fn look(path: &Path, pictures: &Pictures, options: &SurveyOptions) -> Result<FoundFile, SceneError> {
    let before = kept::stamp(path);
    let (scene, hash) = {
        let texels = options.texels == Texels::Referenced;
        scene::read_hashed(path, &Limits { texels, ..Limits::default() })?
    };
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let look = pictures.look(&scene, folder);
    let needs = scene::analyse_with(&scene, &look, options.reader);
    let touched = pictures.files(&scene, folder);
    let (materials, images) = (scene.materials.len(), scene.images.len());
    let warnings = scene.warnings.iter().map(ToString::to_string).collect();
    let all = (Surveyed { file: scene.file_name, hash, materials, images, warnings }, needs);
    Ok(FoundFile { all, new: Some((before, touched)) })
}

/// The paths below the folder that all of them share: no more of the machine than tells them apart.
pub(super) fn names(files: &[PathBuf]) -> Vec<String> {
    let parents: Vec<Vec<_>> =
        files.iter().map(|f| f.parent().map(|p| p.components().collect()).unwrap_or_default()).collect();
    let first = parents.first().cloned().unwrap_or_default();
    let shared = (0..first.len()).take_while(|i| parents.iter().all(|p| p.get(*i) == first.get(*i))).count();
    let name = |file: &PathBuf| {
        let parts = file.components().skip(shared).map(|c| c.as_os_str().to_string_lossy().into_owned());
        parts.collect::<Vec<_>>().join("/")
    };
    files.iter().map(name).collect()
}
