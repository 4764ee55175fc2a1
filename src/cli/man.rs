//! `brdfbake man [VERB]`: manual pages, made from the same text as `--help`.

use super::{Cli, Exit, Failure, output};
use crate::cancel::Cancel;
use crate::encode::atomic;
use crate::math::nearest::offer;
use clap::{Command, CommandFactory};
use clap_mangen::Man;
use std::path::PathBuf;

/// Shown behind the help.
const EXAMPLES: &str =
    concat!("Examples:", "\n  brdfbake man", "\n  brdfbake man bake", "\n  brdfbake man --out pages",);

/// Arguments of `man`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// The page of this verb; that of the command itself if none is given.
    verb: Option<String>,
    /// Write all pages into this folder: brdfbake.1, brdfbake-bake.1 and so on.
    #[arg(short, long, value_name = "DIR", conflicts_with = "verb")]
    out: Option<PathBuf>,
}

/// Runs it.
///
/// # Errors
/// [`Failure`] with [`Exit::Usage`] for a verb that there is not, or if a page cannot be written.
pub fn run(args: &Args, cancel: &Cancel) -> Result<Exit, Failure> {
    let mut whole = Cli::command().disable_help_subcommand(true);
    whole.build();
    if let Some(out) = &args.out {
        let mut files = vec![(out.join("brdfbake.1"), page(&whole)?)];
        for verb in whole.get_subcommands() {
            files.push((out.join(format!("brdfbake-{}.1", verb.get_name())), page(verb)?));
        }
        std::fs::create_dir_all(out).map_err(|e| Failure::io(out.display(), &e))?;
        atomic::write_all(&files, cancel)?;
        return Ok(Exit::Done);
    }
    let command = match &args.verb {
        None => &whole,
        Some(name) => whole.find_subcommand(name).ok_or_else(|| {
            let verbs: Vec<&str> = whole.get_subcommands().map(Command::get_name).collect();
            Failure::usage(format!("no verb `{name}`{}", offer(name, verbs)))
        })?,
    };
    output::data(&String::from_utf8_lossy(&page(command)?))?;
    Ok(Exit::Done)
}

/// A page. It has no date: the same version gives the same bytes.
fn page(command: &Command) -> Result<Vec<u8>, Failure> {
    let mut page = Vec::new();
    let name = command.get_display_name().unwrap_or_else(|| command.get_name()).to_owned();
    let man = Man::new(command.clone()).title(name).manual("brdfbake").date("");
    man.render(&mut page).map_err(|e| Failure::new(Exit::Internal, e))?;
    Ok(page)
}
