//! `brdfbake list WHAT`: one line an entry, from the registries.

use super::{Exit, Failure, output};
use crate::encode::ENCODERS;
use crate::encode::option::words;
use crate::functions;
use crate::grid::quantity::QUANTITIES;
use crate::maps::RULES;
use crate::models::MODELS;
use crate::pipeline::materials;
use crate::recipe::{ENGINES, PRESETS};
use crate::tables::TABLES;
use crate::verify::LAWS;

/// What to list.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum What {
    /// Reflectance models.
    Models,
    /// Functions: distributions, masking, Fresnel factors, phase functions, profiles, samplers.
    Functions,
    /// Table kinds.
    Tables,
    /// Recipes that come with the program.
    Presets,
    /// Engines whose tables are baked in their own files.
    Engines,
    /// Containers and what they can store.
    Formats,
    /// Laws that are checked.
    Laws,
    /// Quantities that an axis can sweep.
    Quantities,
    /// Filter rules of parameter maps.
    Rules,
    /// Rules of `check` for the materials of scenes.
    Checks,
}

/// Shown behind the help.
const EXAMPLES: &str = concat!("Examples:", "\n  brdfbake list models", "\n  brdfbake list engines --json",);

/// Arguments of `list`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// What to list.
    #[arg(value_enum)]
    what: What,
    /// Print a JSON array of objects.
    #[arg(long)]
    json: bool,
}

/// Runs it.
///
/// # Errors
/// None; the signature is that of every verb.
pub fn run(args: &Args) -> Result<Exit, Failure> {
    let rows = rows(args.what);
    if args.json {
        let json: Vec<_> =
            rows.iter().map(|(id, text)| serde_json::json!({"id": id, "title": text})).collect();
        output::data(&serde_json::Value::from(json).to_string())?;
    } else {
        let width = rows.iter().map(|(id, _)| id.len()).max().unwrap_or(0);
        let lines: Vec<String> = rows.iter().map(|(id, text)| format!("{id:width$}  {text}")).collect();
        output::data(&lines.join("\n"))?;
    }
    Ok(Exit::Done)
}

fn rows(what: What) -> Vec<(String, String)> {
    let row = |id: &str, text: &str| (id.to_owned(), text.to_owned());
    match what {
        What::Models => MODELS.iter().map(|m| row(m.id, m.title)).collect(),
        What::Functions => functions::all().map(|f| row(f.id, f.title)).collect(),
        What::Tables => TABLES.iter().map(|t| row(t.id, t.title)).collect(),
        What::Presets => PRESETS.iter().map(|p| row(p.id, p.doc)).collect(),
        What::Engines => ENGINES.iter().map(|e| row(e.id, &format!("{}: {}", e.title, e.version))).collect(),
        What::Formats => ENCODERS
            .iter()
            .map(|e| {
                let storages: Vec<String> =
                    e.storages().iter().map(|s| format!("{}:{}", e.id(), s.id())).collect();
                let options = match e.options() {
                    [] => String::new(),
                    options => format!("; options +{}", words(options).replace(", ", ", +")),
                };
                (e.id().to_owned(), format!("*.{}: {}{options}", e.extension(), storages.join(", ")))
            })
            .collect(),
        What::Laws => LAWS.iter().map(|l| row(l.id, l.statement)).collect(),
        What::Rules => RULES.iter().map(|r| row(r.id, &format!("{}: {}", r.title, r.formula))).collect(),
        What::Checks => {
            materials::RULES.iter().map(|r| row(r.id, &format!("{}; bound {}", r.title, r.bound))).collect()
        }
        What::Quantities => QUANTITIES
            .iter()
            .map(|q| {
                let base = q.base_formula().map_or_else(String::new, |f| format!(" ({f})"));
                let unit = q.unit_words().map_or_else(String::new, |u| format!(", in {u}"));
                (q.id.to_owned(), format!("{}{unit}{base}", q.meaning))
            })
            .collect(),
    }
}
