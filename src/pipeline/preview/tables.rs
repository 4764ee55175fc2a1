//! The tables and the materials of a preview.

use super::{Mesh, Style, Surface, Tables};
use crate::cancel::{Cancel, Cancelled};
use crate::grid::Table;
use crate::grid::axis::count;
use crate::models::ParamError;
use crate::pipeline::materials::MaterialTexels;
use crate::pipeline::{InMemoryError, bake_until};
use crate::plan::scene::{Pictures, SurveyOptions, Triangle};
use crate::plan::{Plan, PlannedTable, TableRequest};
use crate::recipe::{self, Engine};
use crate::report::split::Split;
use crate::scene::{Limits, Scene, SceneError, read};
use std::path::Path;

/// Why there is no preview.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PreviewError {
    /// Stopped from outside.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// A table could not be baked.
    #[error(transparent)]
    Bake(#[from] InMemoryError),
    /// A roughness that the model refuses.
    #[error(transparent)]
    Param(#[from] ParamError),
    /// A recipe that does not parse: a fault of the registry.
    #[error("{0}")]
    Recipe(String),
    /// No split sum of GGX over cosine and roughness.
    #[error("{0} reads no split sum of GGX over mu and roughness: there is nothing here to shade with")]
    NoSplit(
        /// The engine.
        String,
    ),
    /// A scene that is refused.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A scene without a material that can be shown.
    #[error("{file}: {why}")]
    NoMaterial {
        /// The scene.
        file: String,
        /// Why not.
        why: String,
    },
}

/// Bakes the tables of an engine, or of this program's own presets, as their readers get them.
///
/// # Errors
/// [`PreviewError`] for an engine without a split sum, and if a table cannot be baked.
pub fn tables_of(
    engine: Option<&Engine>,
    panel: bool,
    cancel: &Cancel,
) -> Result<(Tables, Style), PreviewError> {
    let preset = |id: &str| {
        let found = recipe::PRESETS.iter().find(|p| p.id == id);
        let found = found.ok_or_else(|| PreviewError::Recipe(format!("no preset `{id}`")))?;
        recipe::parse(found.source, id).map_err(|e| PreviewError::Recipe(e.to_string()))
    };
    let plans: Vec<Plan> = match engine {
        Some(engine) => vec![engine.plan().map_err(|e| PreviewError::Recipe(e.to_string()))?],
        None if panel => vec![preset("default")?, preset("ltc")?],
        None => vec![preset("default")?],
    };
    let all: Vec<&PlannedTable> = plans.iter().flat_map(|p| &p.tables).collect();
    let of = |kind: &str| {
        all.iter().copied().filter(|t| t.bound.spec.kind.id == kind && is_ggx(t)).collect::<Vec<_>>()
    };
    let split = of("dfg").into_iter().find_map(|t| Some((t, Split::of(&t.bound.spec.channels())?)));
    let name = || engine.map_or_else(|| "the preset".to_owned(), |e| e.title.to_owned());
    let (split, reading) =
        split.filter(|(_, r)| r.takes_f0()).ok_or_else(|| PreviewError::NoSplit(name()))?;
    let cosines = match (of("ltc-matrix").first(), of("ltc-magnitude").first()) {
        (Some(m), Some(s)) if panel && m.bound.spec.layout.id == "over-m22" => {
            Some([stored(m, cancel)?, stored(s, cancel)?])
        }
        _ => None,
    };
    let tables = Tables { split: stored(split, cancel)?, reading, cosines };
    let style = Style {
        least_roughness: engine.map_or(0.0, |e| e.roughness.at_least),
        three: engine.is_some_and(|e| e.id == "three"),
    };
    Ok((tables, style))
}

/// Is it a table of the GGX lobe, over its cosine and its width and nothing else?
fn is_ggx(table: &PlannedTable) -> bool {
    let spec = &table.bound.spec;
    let mut bases: Vec<&str> = spec.grid.axes().iter().map(|a| a.quantity.base_id()).collect();
    bases.sort_unstable();
    bases == ["alpha", "mu"] && spec.model.as_ref().is_some_and(|(info, _)| info.id == "ggx")
}

/// A table with the numbers of its first output, on the grid that a reader assumes.
fn stored(planned: &PlannedTable, cancel: &Cancel) -> Result<Table, PreviewError> {
    // what is read between its texels is seen in the picture
    let asked = TableRequest { reconstruction: Some(false), ..planned.asked.clone() };
    let baked = bake_until(cancel, asked)?;
    let values = match planned.outputs.first() {
        Some(output) => baked.stored(output).map_err(InMemoryError::from)?,
        None => baked.table().values.clone(),
    };
    let table = baked.table();
    let grid = table.grid.without_offset().unwrap_or_else(|| table.grid.clone());
    Ok(Table { grid, channels: table.channels.clone(), values, errors: Vec::new(), evaluations: Vec::new() })
}

/// The materials of a scene as spheres: the means of their texels. Beside them what is left out, and why.
///
/// # Errors
/// [`PreviewError::Scene`] for a scene that is refused, [`PreviewError::NoMaterial`] where none can be shown.
pub fn materials(path: &Path, options: &SurveyOptions) -> Result<(Vec<Surface>, Vec<String>), PreviewError> {
    let scene = read(path, &Limits { colours: true, ..Limits::default() })?;
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let maps = Pictures::new(options.root.clone(), options.pixels);
    let (surfaces, left_out) = surfaces(&scene, folder, &maps);
    if surfaces.is_empty() {
        let why = left_out.first().cloned().unwrap_or_else(|| "no lit material is in use".to_owned());
        return Err(PreviewError::NoMaterial { file: scene.file_name, why });
    }
    Ok((surfaces.into_iter().map(|(_, s)| s).collect(), left_out))
}

/// The materials of a scene, as [`materials`] has them, and the triangles that they are on, turned by so many degrees round the upright
/// axis. What stands in glTF's default material is a white metal of roughness 1.
///
/// # Errors
/// As [`materials`], and where there is no triangle.
pub fn mesh(
    path: &Path,
    degrees: f64,
    options: &SurveyOptions,
) -> Result<(Vec<Surface>, Mesh, Vec<String>), PreviewError> {
    let scene = read(path, &Limits { colours: true, meshes: true, ..Limits::default() })?;
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let maps = Pictures::new(options.root.clone(), options.pixels);
    let (mut known, mut left_out) = surfaces(&scene, folder, &maps);
    let (triangles, bad) = maps.triangles(&scene, folder);
    left_out.extend(bad);
    if triangles.iter().any(|t| t.material.is_none()) {
        let name = "default material".to_owned();
        known.push((None, Surface { name, base: [1.0; 3], metallic: 1.0, roughness: 1.0, f0: 0.04 }));
    }
    // only what a triangle has
    known.retain(|(index, _)| triangles.iter().any(|t| t.material == *index));
    let place = |t: &Triangle| known.iter().position(|(index, _)| *index == t.material);
    let drawn = triangles.into_iter().filter_map(|t| Some((t, place(&t)?))).collect();
    let mesh = Mesh::new(drawn, degrees, &scene.file_name)?;
    Ok((known.into_iter().map(|(_, s)| s).collect(), mesh, left_out))
}

/// Lit materials in use, by their number in the file, and those that cannot be shown.
fn surfaces(scene: &Scene, folder: &Path, maps: &Pictures) -> (Vec<(Option<usize>, Surface)>, Vec<String>) {
    let (mut surfaces, mut left_out) = (Vec::new(), Vec::new());
    for material in scene.materials.iter().filter(|m| m.used && m.lit && !m.is_unlit()) {
        let name = material.name.clone().unwrap_or_else(|| format!("material {}", material.index));
        match MaterialTexels::read(material, scene, folder, maps) {
            Ok(texels) => surfaces.push((Some(material.index), mean(name, &texels))),
            Err(why) => left_out.push(format!("{name}: {why}")),
        }
    }
    (surfaces, left_out)
}

fn mean(name: String, texels: &MaterialTexels) -> Surface {
    let n = count(texels.len());
    let mut surface = Surface { name, base: [0.0; 3], metallic: 0.0, roughness: 0.0, f0: 0.0 };
    for i in 0..texels.len() {
        let t = texels.get(i);
        for (sum, v) in surface.base.iter_mut().zip(t.base) {
            *sum += v / n;
        }
        surface.metallic += t.metallic / n;
        surface.roughness += t.roughness / n;
        surface.f0 += t.reflectance() / n;
    }
    surface
}
