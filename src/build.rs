//! Recipes as a step of a Cargo build: one call in `build.rs`, which prints the lines that it returns.
//!
//! ```no_run
//! // build.rs
//! fn main() -> Result<(), Box<dyn std::error::Error>> {
//!     let built = brdfbake::build::recipe("tables.toml", std::env::var("OUT_DIR")?)?;
//!     println!("{}", built.lines.join("\n"));
//!     Ok(())
//! }
//! ```
//!
//! Then `include_bytes!(concat!(env!("OUT_DIR"), "/ggx-dfg.ktx2"))`. Cargo builds build scripts and what they use without
//! optimisation, which makes integration about seven times slower. In the `Cargo.toml` of the workspace:
//!
//! ```toml
//! [build-dependencies]
//! brdfbake = { version = "0.1", default-features = false }
//!
//! [profile.dev.build-override]
//! opt-level = 3
//! [profile.release.build-override]
//! opt-level = 3
//! ```

use crate::cancel::Cancel;
use crate::pipeline::{Event, Outcome, PipelineError, Progress, Settings, run};
use crate::recipe::{LoadError, load};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// What a step of a build did.
#[derive(Debug, Clone, PartialEq)]
pub struct Built {
    /// What was written.
    pub outcome: Outcome,
    /// What Cargo needs to know, a line each: run again when the recipe or an image of its maps changes, and a warning for each law that could not be
    /// checked. The library prints nothing: the build script does.
    pub lines: Vec<String>,
}

/// Why a build fails.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BuildError {
    /// The recipe cannot be read, or has faults: each with its line.
    #[error(transparent)]
    Recipe(#[from] LoadError),
    /// A texel misses its tolerance, a law is broken, or a file cannot be written.
    #[error(transparent)]
    Bake(#[from] PipelineError),
}

/// Collects findings as warnings.
#[derive(Debug, Default)]
struct Warnings(Mutex<Vec<String>>);

impl Progress for Warnings {
    fn event(&self, event: &Event<'_>) {
        if let Event::Finding { table, finding } = event {
            let line = format!("cargo::warning={table}: {finding}").replace(['\n', '\r'], " ");
            self.0.lock().unwrap_or_else(PoisonError::into_inner).push(line);
        }
    }
}

/// Bakes a recipe into a folder. Files whose bytes do not change are not written again.
///
/// # Errors
/// [`BuildError`]; the folder is then as it was.
pub fn recipe(recipe: impl AsRef<Path>, out: impl AsRef<Path>) -> Result<Built, BuildError> {
    let recipe = recipe.as_ref();
    let plan = load(recipe)?;
    let warnings = Warnings::default();
    let outcome = run(&plan, &Settings::new(out.as_ref()), &Cancel::new(), &warnings)?;
    let images = plan.maps.iter().flat_map(|m| m.asked.files_read());
    let read = std::iter::once(recipe.to_owned()).chain(images);
    let mut lines: Vec<String> = read.map(|p| format!("cargo::rerun-if-changed={}", p.display())).collect();
    lines.extend(warnings.0.into_inner().unwrap_or_else(PoisonError::into_inner));
    Ok(Built { outcome, lines })
}
