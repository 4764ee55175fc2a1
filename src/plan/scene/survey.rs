//! Scenes to needs: files read in parallel, each with its pictures, joined in the order in which they were named.

use super::Pictures;
use crate::scene::{self, Joined, Limits, Needs, Reader, SceneError, Warning};
use rayon::prelude::*;
use std::path::{Path, PathBuf};

/// How scenes are looked at.
#[derive(Debug, Clone)]
pub struct SurveyOptions {
    /// The folder below which files may be read; that of each scene if none.
    pub root: Option<PathBuf>,
    /// Most pixels of an image.
    pub pixels: u64,
    /// How a shader takes roughness.
    pub reader: Reader,
}

impl Default for SurveyOptions {
    fn default() -> SurveyOptions {
        SurveyOptions { root: None, pixels: super::PIXELS, reader: Reader::default() }
    }
}

/// A scene that was read.
#[derive(Debug, Clone, PartialEq)]
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
    pub warnings: Vec<Warning>,
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
    let names = names(files);
    let pictures = Pictures::new(options.root.clone(), options.pixels);
    let one = |(path, name): (&PathBuf, &String)| look(path, name, &pictures, options.reader);
    let read: Vec<_> = files.par_iter().zip(&names).map(one).collect();
    let mut faults = Vec::new();
    let mut scenes = Vec::with_capacity(files.len());
    let mut joined = Joined::default();
    for result in read {
        match result {
            Ok((scene, needs)) => {
                scenes.push(scene);
                joined.add(needs);
            }
            Err(fault) => faults.push(fault),
        }
    }
    if faults.is_empty() { Ok(Survey { scenes, needs: joined.needs() }) } else { Err(faults) }
}

fn look(
    path: &Path,
    name: &str,
    pictures: &Pictures,
    reader: Reader,
) -> Result<(Surveyed, Needs), SceneError> {
    let (mut scene, hash) = scene::read_hashed(path, &Limits::default())?;
    name.clone_into(&mut scene.file_name);
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let look = pictures.look(&scene, folder);
    let needs = scene::analyse_with(&scene, &look, reader);
    let (materials, images) = (scene.materials.len(), scene.images.len());
    Ok((Surveyed { file: scene.file_name, hash, materials, images, warnings: scene.warnings }, needs))
}

/// The paths below the folder that all of them share: no more of the machine than tells them apart.
fn names(files: &[PathBuf]) -> Vec<String> {
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
