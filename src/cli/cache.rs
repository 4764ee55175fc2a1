//! `brdfbake cache`.

use super::reuse::{self, CacheArgs};
use super::{Exit, Failure, output};

/// Shown behind the help.
const EXAMPLES: &str = "Examples:\n  brdfbake cache --cache-dir kept";

/// Arguments of `cache`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// What to do; without a word, tell what it holds.
    #[arg(value_enum, default_value = "show")]
    action: Action,
    #[command(flatten)]
    cache: CacheArgs,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Action {
    /// Print its folder, and how much it holds.
    Show,
    /// Remove all that it holds.
    Clear,
}

/// Runs it.
///
/// # Errors
/// [`Failure`] where there is no cache, or it cannot be read or cleared.
pub fn run(args: &Args) -> Result<Exit, Failure> {
    let cache = args.cache.cache().ok_or_else(reuse::none)?;
    let done = match args.action {
        Action::Show => cache.size(),
        Action::Clear => cache.clear(),
    };
    let folder = cache.folder().display().to_string();
    let size = done.map_err(|e| Failure::new(Exit::Io, format!("{folder}: {e}")))?;
    let removed = args.action == Action::Clear;
    let text = if args.json {
        serde_json::json!({ "folder": folder, "removed": removed, "units": size.units, "bytes": size.bytes })
            .to_string()
    } else {
        let what = if removed { "removed" } else { "held" };
        format!("{folder}: {} tables and maps {what}, {} kB", size.units, size.bytes.div_ceil(1000))
    };
    output::data(&text).map(|_| Exit::Done)
}
