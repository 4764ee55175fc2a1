//! What `bake --engine` says of its tables, and what `describe` says of an engine.

use super::{Failure, output};
use crate::pipeline::Outcome;
use crate::plan::Plan;
use crate::recipe::{self, ENGINES, Engine};

/// The engine of this id and its plan.
pub(super) fn plan(id: &str) -> Result<(&'static Engine, Plan), Failure> {
    let engine = find(id)?;
    Ok((engine, engine.plan()?))
}

/// The engine of this id.
pub(super) fn find(id: &str) -> Result<&'static Engine, Failure> {
    recipe::engine(id).ok_or_else(|| {
        let ids: Vec<&str> = ENGINES.iter().map(|e| e.id).collect();
        Failure::input(format!("no engine `{id}`{}", crate::math::nearest::offer(id, ids)))
    })
}

/// One line a table: which file it replaces, and both errors as the engine reads them.
pub(super) fn report(engine: &Engine, outcome: &Outcome) {
    for (file, table) in engine.files.iter().zip(&outcome.manifest.tables) {
        let Some(record) = table.files.first() else { continue };
        let mut text = format!("  {} -> {}", record.file, file.replaces);
        if let Some(read) = record.as_read.as_ref().or(record.reconstruction.as_ref()) {
            let whole = [read.whole.largest.value, read.whole.mean];
            let practical = read.practical.as_ref().map(|p| [p.largest.value, p.mean]);
            text.push_str(&format!(
                "\n    as the engine reads it, between the texels: {}",
                errors(whole, practical)
            ));
            if let Some(shipped) = &file.shipped {
                text.push_str(&format!(
                    "\n    the shipped file: {}",
                    errors(shipped.whole, Some(shipped.practical))
                ));
            }
        }
        output::talk(&text);
    }
    output::talk(&format!(
        "  how to put them in place, and how to see that it took: brdfbake guide {}",
        engine.id
    ));
}

fn errors(whole: [f64; 2], practical: Option<[f64; 2]>) -> String {
    let both = |[largest, mean]: [f64; 2]| format!("{largest:.1e} at most, {mean:.1e} in the mean");
    let practical = practical
        .map_or_else(String::new, |p| format!("; where mu >= 0.05 and roughness >= 0.09, {}", both(p)));
    format!("{}{practical}", both(whole))
}

/// The page of an engine.
pub(super) fn page(engine: &Engine) -> String {
    let mut text = format!(
        "engine {}\n{}: {}\nhow to put its tables in place: brdfbake guide {}\n",
        engine.id, engine.title, engine.version, engine.id
    );
    for file in engine.files {
        text.push_str(&format!(
            "\n  {}\n    replaces: {}\n    read at: {}\n",
            file.table, file.replaces, file.read
        ));
        if let Some(s) = &file.shipped {
            text.push_str(&format!(
                "    shipped: {}, off by {}\n",
                s.source,
                errors(s.whole, Some(s.practical))
            ));
        }
    }
    text.push_str(&format!("\n{}", engine.recipe));
    text
}
