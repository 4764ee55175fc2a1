//! `brdfbake completions SHELL`.

use super::{Cli, Exit, Failure, output};
use clap::CommandFactory;
use clap_complete::{Shell, generate};

/// Shown behind the help.
const EXAMPLES: &str = "Examples:\n  brdfbake completions bash";

/// Arguments of `completions`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// The shell.
    #[arg(value_enum)]
    shell: Shell,
}

/// Runs it.
///
/// # Errors
/// [`Failure`] if it cannot be written.
pub fn run(args: &Args) -> Result<Exit, Failure> {
    let mut script = Vec::new();
    generate(args.shell, &mut Cli::command(), "brdfbake", &mut script);
    output::data(&String::from_utf8_lossy(&script))?;
    Ok(Exit::Done)
}
