//! `brdfbake schema`: the JSON schema of recipes.

use super::{Exit, Failure, output};
use crate::recipe;

/// Shown behind the help.
const EXAMPLES: &str = "Examples:\n  brdfbake schema";

/// Arguments of `schema`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {}

/// Runs it.
///
/// # Errors
/// [`Failure`] if it cannot be written.
pub fn run(_: &Args) -> Result<Exit, Failure> {
    let text = serde_json::to_string_pretty(&recipe::schema());
    output::data(&text.map_err(|e| Failure::new(Exit::Internal, e))?)?;
    Ok(Exit::Done)
}
