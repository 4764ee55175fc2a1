//! `brdfbake plot MODEL`: the lobe as a polar plot in the plane of incidence, as SVG or PNG.

use super::{Exit, Failure, albedo, output};
use crate::cancel::Cancel;
use crate::encode::atomic;
use crate::math::figures::exact;
use crate::report::plot::{self, Scale};
use std::path::PathBuf;
use std::sync::Arc;

/// Arguments of `plot`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Model id, or another of its names.
    model: String,
    /// A parameter, as key=value; may be given several times.
    #[arg(short, long = "param", value_name = "KEY=VALUE")]
    params: Vec<String>,
    /// Angles of incidence in degrees, separated by commas.
    #[arg(long, value_name = "DEGREES", value_delimiter = ',', default_value = "0,30,60,80")]
    angles: Vec<f64>,
    /// How a value becomes a radius.
    #[arg(long, value_enum, default_value = "log")]
    scale: Scale,
    /// Output files, .svg or .png; may be given several times. Default: MODEL.svg
    #[arg(short, long = "out", value_name = "FILE")]
    out: Vec<PathBuf>,
}

/// Runs it.
///
/// # Errors
/// [`Failure`] for an unknown model, a bad parameter or angle, a delta model, or a file that cannot be written.
pub fn run(args: &Args, cancel: &Arc<Cancel>) -> Result<Exit, Failure> {
    if let Some(bad) = args.angles.iter().find(|a| !(0.0..90.0).contains(*a)) {
        return Err(Failure::usage(format!(
            "--angles {} outside [0, 90): degrees from the normal",
            exact(bad)
        )));
    }
    let given = albedo::parse_params(&args.params)?;
    let (info, model) = albedo::build(&args.model, &given)?;
    if model.mirror(1.0).is_some() {
        let message = format!("{} is a mirror with these parameters: a delta has no lobe to draw", info.id);
        return Err(Failure::new(Exit::Unsupported, message));
    }
    let set: Vec<String> = args.params.clone();
    let figure = plot::polar(info.title, &set.join(", "), &*model, &args.angles, args.scale);
    let default = [PathBuf::from(format!("{}.svg", info.id))];
    let targets = if args.out.is_empty() { &default[..] } else { &args.out[..] };
    let mut files = Vec::new();
    for path in targets {
        let bytes = match path.extension().and_then(|e| e.to_str()) {
            Some("svg") => figure.svg().into_bytes(),
            Some("png") => figure.png().map_err(|e| Failure::new(Exit::Internal, e))?,
            _ => {
                return Err(Failure::usage(format!("{}: a plot is written as .svg or .png", path.display())));
            }
        };
        files.push((path.clone(), bytes));
    }
    atomic::write_all(&files, cancel)?;
    for (path, _) in &files {
        output::talk(&format!("{}", path.display()));
    }
    Ok(Exit::Done)
}
