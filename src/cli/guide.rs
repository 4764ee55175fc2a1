//! `brdfbake guide [TOPIC]`: the pages of the guide as plain text.

use super::{Exit, Failure, output};
use crate::guide::{TOPICS, engine_page, plain, topic};
use crate::math::nearest::hint;
use crate::recipe::{self, ENGINES};

/// Shown behind the help.
const EXAMPLES: &str =
    concat!("Examples:", "\n  brdfbake guide", "\n  brdfbake guide recipes", "\n  brdfbake guide three",);

/// Arguments of `guide`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// A topic, or an engine; the list of topics if not given.
    topic: Option<String>,
}

/// Runs it.
///
/// # Errors
/// [`Failure`] with [`Exit::Usage`] if there is no such page.
pub fn run(args: &Args) -> Result<Exit, Failure> {
    let text = match &args.topic {
        None => contents(),
        Some(id) => page(id)?,
    };
    output::data(&text)?;
    Ok(Exit::Done)
}

/// The list of topics.
fn contents() -> String {
    let width = TOPICS.iter().map(|t| t.id.len()).max().unwrap_or(0);
    let mut text = "Topics of `brdfbake guide TOPIC`:\n".to_owned();
    for topic in TOPICS {
        text.push_str(&format!("  {:width$}  {}\n", topic.id, topic.title()));
    }
    text.push_str("\nHow to use a table in an engine, `brdfbake guide ENGINE`:\n");
    let width = ENGINES.iter().map(|e| e.id.len()).max().unwrap_or(0);
    for engine in ENGINES {
        text.push_str(&format!("  {:width$}  {}\n", engine.id, engine.title));
    }
    text.push_str("\nOf any one model, table, law, container or quantity: `brdfbake describe ID`.\n");
    text
}

fn page(id: &str) -> Result<String, Failure> {
    if let Some(topic) = topic(id) {
        return Ok(plain(topic.text));
    }
    if let Some(engine) = recipe::engine(id) {
        return Ok(plain(&engine_page(engine, 1).map_err(|e| Failure::new(Exit::Unsupported, e))?));
    }
    let ids = TOPICS.iter().map(|t| t.id).chain(ENGINES.iter().map(|e| e.id));
    let hint = hint(id, ids);
    Err(Failure::usage(format!("the guide has no page `{id}`{hint} (`brdfbake guide` lists them)")))
}
