//! The tables that engines load, by engine: `bake --engine bevy`, or `engine = "bevy"` in a recipe.
//!
//! An engine is a recipe, `presets/engines/NAME.toml`, and an entry here. The recipe holds all that is convention: axes and
//! their order, texels, direction, channels, storage, container and file name. The entry says which file each table takes
//! the place of, how the shader reads it, and how far off the shipped file is.
//!
//! What the shipped files are off by is measured like the tables of this program: read as the engine reads them, which is
//! bilinearly and without knowing of an `offset`, against fresh integrals between the texels (`tests/engines.rs`).

use super::{ENGINES, RecipeError, parse};
use crate::plan::Plan;

/// An engine and the tables that it loads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Engine {
    /// Id: the file name without `.toml`, and the name in the file.
    pub id: &'static str,
    /// Name.
    pub title: &'static str,
    /// The version whose conventions these are, and where they are written.
    pub version: &'static str,
    /// Can it read other axes?
    pub reader: Reader,
    /// The text of the recipe.
    pub recipe: &'static str,
    /// How to put the tables in place, import settings, how to see that it took, and what the engine computes at start-up:
    /// `presets/engines/NAME.md`.
    pub guide: &'static str,
    /// The files, in the order of the tables of the recipe.
    pub files: &'static [EngineFile],
    /// What its shaders do to roughness before they read.
    pub roughness: Roughness,
}

/// What shaders do to perceptual roughness before they read a table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Roughness {
    /// The smallest that they let through.
    pub at_least: f64,
    /// Do they add to it where normals differ within a pixel? Then it may be anything above.
    pub widens: bool,
    /// Where that is written; empty if nothing is known to be done.
    pub source: &'static str,
}

impl Roughness {
    /// Read as it stands in the material.
    pub const AS_IT_IS: Roughness = Roughness { at_least: 0.0, widens: false, source: "" };
}

/// What reads the tables of an engine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reader {
    /// A shader in this language, which can be told a warp.
    Shader(&'static str),
    /// Something that cannot, and why.
    Fixed(&'static str),
}

/// What becomes of a table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EngineFile {
    /// Name of the table in the recipe.
    pub table: &'static str,
    /// What the file takes the place of.
    pub replaces: &'static str,
    /// How the shader reads it: texture coordinates, then what it makes of the texel.
    pub read: &'static str,
    /// The file that the engine ships, if it was measured.
    pub shipped: Option<Shipped>,
}

/// How far off a shipped file is, as the engine reads it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shipped {
    /// Which file, with its licence.
    pub source: &'static str,
    /// Largest and mean error over the whole domain.
    pub whole: [f64; 2],
    /// The same where mu >= 0.05 and roughness >= 0.09.
    pub practical: [f64; 2],
}

/// Finds an engine by its id.
#[must_use]
pub fn engine(id: &str) -> Option<&'static Engine> {
    ENGINES.iter().find(|e| e.id == id)
}

impl Engine {
    /// Resolves its recipe.
    ///
    /// # Errors
    /// None for the engines in [`ENGINES`] (a test resolves them all), but where a feature is left out of the build: the
    /// recipe of Bevy wants feature `zstd`.
    pub fn plan(&self) -> Result<Plan, RecipeError> {
        parse(self.recipe, &format!("presets/engines/{}.toml", self.id))
    }
}

#[cfg(test)]
mod tests {
    use super::parse;

    #[test]
    fn an_engine_that_a_build_leaves_out_is_refused_with_its_feature() {
        let engine = parse("name = 'a'\nengine = 'bevy'", "a.toml").map_err(|e| e.to_string());
        let lacks = match (cfg!(feature = "engines"), cfg!(feature = "zstd")) {
            (false, _) => Some("engines"),
            (true, false) => Some("zstd"),
            (true, true) => None,
        };
        match (lacks, engine) {
            (None, engine) => assert!(engine.is_ok(), "{:?}", engine.err()),
            (Some(feature), engine) => {
                let told = engine.err().unwrap_or_default();
                assert!(told.contains(&format!("needs the feature `{feature}` of the crate")), "{told}");
            }
        }
    }
}
