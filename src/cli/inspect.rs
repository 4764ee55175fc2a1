//! `brdfbake inspect FILE`.

use super::{Exit, Failure, output};
use crate::cancel::Cancel;
use crate::encode::read;
use crate::report;
use std::path::PathBuf;

/// Arguments of `inspect`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Picture files (EXR, KTX2, DDS, PNG, HDR, NPY), from this program or any other.
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Print the provenance as JSON instead of text.
    #[arg(long)]
    json: bool,
}

/// Runs it.
///
/// # Errors
/// [`Failure`] when a file cannot be read.
pub fn run(args: &Args, cancel: &Cancel) -> Result<Exit, Failure> {
    for path in &args.files {
        let image = read::read_file_until(cancel, path).map_err(|e| super::diff::read_failure(&e))?;
        let name = path.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
        if args.json {
            output::data(&json(&name, &image))?;
        } else {
            output::data(&report::inspect(&name, &image))?;
        }
    }
    Ok(Exit::Done)
}

/// The provenance, or what is known of a file without one.
fn json(name: &str, image: &crate::encode::Image) -> String {
    let channels: Vec<&str> = image.channels.iter().map(|c| c.name.as_str()).collect();
    let provenance = image.known().map(|p| serde_json::to_value(p).unwrap_or_default());
    serde_json::json!({
        "file": name, "width": image.width, "height": image.height, "channels": channels, "provenance": provenance,
    })
    .to_string()
}
