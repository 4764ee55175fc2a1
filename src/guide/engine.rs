//! The page of an engine: what the registry knows of its tables, then how to put them in place.

use crate::grid::{Axis, Texel};
use crate::plan::PlannedTable;
use crate::recipe::{Engine, RecipeError};

/// The page of an engine in Markdown: files, axes and channels from its recipe, what each replaces and how it is read from its
/// entry, and the text beside the recipe. Headings are `level` deep.
///
/// # Errors
/// [`RecipeError`] where the recipe of the engine does not resolve: it wants a container that was left out of this build.
pub fn engine_page(engine: &Engine, level: usize) -> Result<String, RecipeError> {
    let plan = engine.plan()?;
    let heading = "#".repeat(level);
    let mut text = format!(
        "{heading} {} (`{}`)\n\nThe conventions are those of {}. `brdfbake bake --engine {} -o OUT` writes:\n\n\
         | file | takes the place of | texels | holds | read at; then |\n|---|---|---|---|---|\n",
        engine.title, engine.id, engine.version, engine.id
    );
    for (file, table) in engine.files.iter().zip(&plan.tables) {
        text.push_str(&format!(
            "| `{}` | {} | {} | {} | `{}` |\n",
            table.files().join("`, `"),
            file.replaces,
            texels(table),
            channels(table),
            file.read
        ));
    }
    text.push_str(&shipped(engine));
    for line in engine.guide.trim_end().lines() {
        let deeper = if line.starts_with('#') { heading.as_str() } else { "" };
        text.push_str(&format!("{deeper}{line}\n"));
    }
    Ok(text)
}

fn texels(table: &PlannedTable) -> String {
    let axes = &table.bound.spec.grid.axes();
    let lengths: Vec<String> = axes.iter().map(|a| a.len.to_string()).collect();
    let order: Vec<String> = axes.iter().map(axis).collect();
    let outputs: Vec<String> = table.outputs.iter().map(ToString::to_string).collect();
    format!("{}: {}; {}", lengths.join(" x "), order.join(", "), outputs.join(", "))
}

fn axis(axis: &Axis) -> String {
    let place = match axis.texel {
        Texel::Center => "at texel centres",
        Texel::Endpoint => "on the ends",
    };
    format!("{} {place}", axis.quantity.id)
}

fn channels(table: &PlannedTable) -> String {
    let ids: Vec<String> = table.bound.spec.channels().iter().map(|c| format!("`{}`", c.id)).collect();
    ids.join(", ")
}

/// How far off the shipped files are, where they were measured.
fn shipped(engine: &Engine) -> String {
    let mut text = "\n".to_owned();
    for file in engine.files {
        let Some(s) = &file.shipped else { continue };
        let both = |[largest, mean]: [f64; 2]| format!("{largest:.1e} at most and {mean:.1e} in the mean");
        text.push_str(&format!(
            "The shipped file that `{}` replaces ({}) is off, as its shader reads it, by {}; where mu >= 0.05 and roughness >= \
             0.09, by {}.\n\n",
            file.table,
            s.source,
            both(s.whole),
            both(s.practical)
        ));
    }
    text
}
