//! `brdfbake inspect FILE`.

use super::{Exit, Failure, output};
use crate::cancel::Cancel;
use crate::encode::layout::Layout;
use crate::encode::{atomic, beside, read};
use crate::report::{self, recognise};
use std::path::PathBuf;

/// Shown behind the help.
const EXAMPLES: &str = concat!(
    "Examples:",
    "\n  brdfbake inspect textures/small.exr",
    "\n  brdfbake inspect textures/small.exr --json",
);

/// Arguments of `inspect`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Picture files (EXR, KTX2, DDS, PNG, HDR, NPY, MERL, bare numbers), from this program or any other.
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// How the numbers of bare files (.bin) lie, such as 128x64x2:half; without it the manifest beside them tells.
    #[arg(long, value_name = "WxHxC:STORAGE")]
    raw: Option<String>,
    /// Name the convention of a split sum or albedo that does not tell it: axes, rows, texels, model, channels; every candidate with its
    /// error.
    #[arg(long)]
    recognise: bool,
    /// Seed of the pixels that are compared.
    #[arg(long, value_name = "N", default_value_t = 1, requires = "recognise")]
    seed: u64,
    /// Print the provenance as JSON instead of text.
    #[arg(long)]
    json: bool,
    /// Draw a contact sheet of the files as PNG: channels, histograms, and the worst texels of parameter maps as lit spheres.
    #[arg(long, value_name = "FILE")]
    sheet: Option<PathBuf>,
}

/// Runs it.
///
/// # Errors
/// [`Failure`] when a file cannot be read, or the sheet not be written.
pub fn run(args: &Args, cancel: &Cancel) -> Result<Exit, Failure> {
    let layout = super::diff::layout(args.raw.as_deref(), &args.files)?;
    let mut images = Vec::new();
    for path in &args.files {
        let of_file = layout.as_ref().filter(|_| Layout::is_of(path));
        let bytes = read::load_until(cancel, path).map_err(|e| super::diff::read_failure(&e))?;
        let image = beside::read(path, &bytes, of_file, cancel).map_err(|e| {
            let name = path.display();
            let failure = Failure { message: format!("{name}: {e}"), ..super::diff::read_failure(&e) };
            failure.at("file", name.to_string())
        })?;
        let name = path.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
        if args.recognise {
            let found = recognise::recognise(&image, args.seed, cancel)?;
            let json = || serde_json::json!({ "file": name, "recognised": found }).to_string();
            output::data(&if args.json { json() } else { recognise::words(&name, found.as_ref()) })?;
        } else if args.json {
            output::data(&json(&name, &image))?;
        } else {
            output::data(&report::inspect(&name, &image))?;
        }
        if args.sheet.is_some() {
            images.push(image);
        }
    }
    if let Some(path) = &args.sheet {
        let bytes = report::sheet::sheet(&images).map_err(|e| Failure::new(Exit::Internal, e))?;
        atomic::write_all(&[(path.clone(), bytes)], cancel)?;
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
