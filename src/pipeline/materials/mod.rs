//! Materials of a scene against rules: each texel of their textures, with the layers stacked as the glTF extensions say.
//!
//! A rule is a file in `rules` and a line in [`RULES`].

mod parts;
mod rules;
mod texels;

pub use parts::{Parts, Stack};
pub use rules::{Breaks, RULES, Rule};
pub use texels::{MaterialTexels, Texel};

use crate::plan::scene::{Pictures, SurveyOptions};
use crate::scene::{Limits, MaterialRef, SceneError, read};
use serde::Serialize;
use std::collections::HashMap;
use std::path::Path;

/// How materials are judged.
#[derive(Debug, Clone)]
pub struct Judging {
    /// The rules with their bounds.
    pub rules: Vec<(&'static Rule, f64)>,
    /// Root and limits of pictures.
    pub look: SurveyOptions,
}

impl Default for Judging {
    fn default() -> Judging {
        Judging { rules: RULES.iter().map(|r| (*r, r.bound)).collect(), look: SurveyOptions::default() }
    }
}

/// A rule that a material breaks.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Broken {
    /// The material.
    pub material: MaterialRef,
    /// Id of the rule.
    pub rule: &'static str,
    /// The bound.
    pub bound: f64,
    /// Texels that break it.
    pub count: usize,
    /// The same, of all texels.
    pub share: f64,
    /// The worst texel: column and row from the top left.
    pub texel: [usize; 2],
    /// Its value.
    pub value: f64,
}

/// What was found in the materials of a scene.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Review {
    /// Materials that were looked at.
    pub materials: usize,
    /// Texels that were looked at.
    pub texels: usize,
    /// Rules that are broken, by material, in the order of the file.
    pub broken: Vec<Broken>,
    /// Materials that could not be judged, and why.
    pub unknown: Vec<(MaterialRef, String)>,
    /// Materials that were judged more simply than they are, and how.
    pub simplified: Vec<(MaterialRef, String)>,
}

/// Judges the materials of a scene that are lit and in use.
///
/// # Errors
/// [`SceneError`] for a scene that is refused.
pub fn review(path: &Path, parts: &Parts, judging: &Judging) -> Result<Review, SceneError> {
    let scene = read(path, &Limits { colours: true, texels: true, ..Limits::default() })?;
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let maps = Pictures::new(judging.look.root.clone(), judging.look.pixels);
    let mut review = Review::default();
    for material in scene.materials.iter().filter(|m| m.used && m.lit && !m.is_unlit() && !m.is_replaced()) {
        let by = MaterialRef {
            file: scene.file_name.clone(),
            index: Some(material.index),
            name: material.name.clone(),
        };
        review.materials += 1;
        match MaterialTexels::read(material, &scene, folder, &maps) {
            Ok(texels) => {
                review.texels += texels.len();
                review.simplified.extend(texels.simplified.iter().map(|how| (by.clone(), how.clone())));
                review.broken.extend(judge(&texels, parts, judging, &by));
            }
            Err(why) => review.unknown.push((by, why)),
        }
    }
    Ok(review)
}

/// Every rule over every texel of a material.
fn judge(texels: &MaterialTexels, parts: &Parts, judging: &Judging, by: &MaterialRef) -> Vec<Broken> {
    let distinct = distinct(texels);
    let mut all = Vec::new();
    for (rule, bound) in &judging.rules {
        let mut count = 0;
        let mut worst: Option<(f64, usize, f64)> = None;
        for (texel, first, times) in &distinct {
            let Some(value) = (rule.measure)(texel, &Stack { texel, parts }) else { continue };
            let beyond = rule.breaks.by(value, *bound);
            if beyond > 0.0 {
                count += times;
                if worst.is_none_or(|(most, ..)| beyond > most) {
                    worst = Some((beyond, *first, value));
                }
            }
        }
        let share = crate::grid::axis::count(count) / crate::grid::axis::count(texels.len().max(1));
        if let Some((_, i, value)) = worst.filter(|_| share > rule.share) {
            let texel = [i % texels.width, i / texels.width];
            let material = by.clone();
            all.push(Broken { material, rule: rule.id, bound: *bound, count, share, texel, value });
        }
    }
    all
}

/// Texels repeat, and what a texel holds decides, not where it lies: each once, with the number of the first, and how many there are.
fn distinct(texels: &MaterialTexels) -> Vec<(Texel, usize, usize)> {
    let mut all: Vec<(Texel, usize, usize)> = Vec::new();
    let mut places = HashMap::new();
    for i in 0..texels.len() {
        let texel = texels.get(i);
        let place = *places.entry(texel.key()).or_insert(all.len());
        match all.get_mut(place) {
            Some((.., times)) => *times += 1,
            None => all.push((texel, i, 1)),
        }
    }
    all
}
