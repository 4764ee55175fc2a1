//! `brdfbake converge [TABLE | MODEL]...`: error against evaluations, time and bytes, as numbers and charts.

use super::{Exit, Failure, output};
use crate::cancel::Cancel;
use crate::encode::atomic;
use crate::math::nearest::nearest;
use crate::models::{self, MODELS};
use crate::report::chart::Chart as Picture;
use crate::report::{converge as report, reading};
use crate::tables::spec::{Bound, Request};
use crate::tables::{self, TABLES};
use crate::verify::converge::{Asked, Chart, ConvergeError, LEAST_POWER, MOST_POWER, converge};
use std::path::PathBuf;

/// Shown behind the help.
const EXAMPLES: &str = "Examples:\n  brdfbake converge ggx --texels 16 --power 8 -o charts";

/// Arguments of `converge`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Kinds of tables whose channels are integrals of a lobe (dfg, albedo), and models, whose albedo is looked at; default: dfg.
    subjects: Vec<String>,
    /// Seed of texels and points.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Texels that are looked at.
    #[arg(long, value_name = "N", default_value_t = 256)]
    texels: usize,
    /// The largest budget of a sampler is 2^K evaluations of a texel, K from 4 to 20.
    #[arg(long, value_name = "K", default_value_t = 16)]
    power: u32,
    /// Compare with the JSON file of another run.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["json", "quiet"])]
    compare: Option<PathBuf>,
    /// Also time against error, of this machine: files of their own, that differ from run to run.
    #[arg(long)]
    timings: bool,
    /// Also bytes against the error of reading, by axes and storage, and formulas.
    #[arg(long)]
    bytes: bool,
    /// Print the chart as JSON, an object a line for each subject; no files unless there is --out.
    #[arg(long)]
    json: bool,
    /// Folder for the files: NAME.csv, .json, .svg, .png, and those of NAME-time and NAME-bytes. Default: converge
    #[arg(short, long, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// Print nothing.
    #[arg(short, long, conflicts_with = "json")]
    quiet: bool,
}

/// Runs it.
///
/// # Errors
/// [`Failure`] for an unknown subject, one without estimators, or a file that cannot be read or written.
pub fn run(args: &Args, cancel: &Cancel) -> Result<Exit, Failure> {
    if !(LEAST_POWER..=MOST_POWER).contains(&args.power) {
        let message = format!("--power {} outside [{LEAST_POWER}, {MOST_POWER}]", args.power);
        return Err(Failure::usage(message));
    }
    if args.texels == 0 {
        return Err(Failure::usage("--texels 0: at least one texel is looked at"));
    }
    if args.json && args.out.is_none() && (args.timings || args.bytes) {
        let option = if args.timings { "--timings" } else { "--bytes" };
        return Err(Failure::usage(format!(
            "{option} writes files, and --json alone writes none; add --out"
        )));
    }
    let names: Vec<&str> = match args.subjects.as_slice() {
        [] => vec!["dfg"],
        some => some.iter().map(String::as_str).collect(),
    };
    let bound: Vec<(&str, Bound)> =
        names.into_iter().map(|n| Ok((n, subject(n)?))).collect::<Result<_, Failure>>()?;
    let before = args.compare.as_ref().map(read).transpose()?;
    for (name, bound) in &bound {
        converge_table(name, bound, before.as_ref(), args, cancel)?;
    }
    Ok(Exit::Done)
}

fn converge_table(
    name: &str,
    bound: &Bound,
    before: Option<&Chart>,
    args: &Args,
    cancel: &Cancel,
) -> Result<(), Failure> {
    let asked = Asked { seed: args.seed, texels: args.texels, power: args.power, cancel };
    let (chart, times) = converge(bound, asked).map_err(failure)?;
    cancel.check()?;
    let json = serde_json::to_string(&chart).map_err(|e| Failure::new(Exit::Internal, e))?;
    let mut files: Vec<(String, Vec<u8>)> = vec![
        (format!("{name}.csv"), report::csv(&chart).into_bytes()),
        (format!("{name}.json"), format!("{json}\n").into_bytes()),
    ];
    let mut pictures = vec![(name.to_owned(), report::chart(&chart))];
    let times = if args.timings { times } else { Vec::new() };
    if args.timings {
        files.push((format!("{name}-time.csv"), report::time_csv(&chart, &times).into_bytes()));
        pictures.push((format!("{name}-time"), report::time_chart(&chart, &times)));
    }
    if args.bytes {
        let readings = reading::readings(bound, cancel)?;
        files.push((format!("{name}-bytes.csv"), reading::csv(&readings).into_bytes()));
        pictures.push((format!("{name}-bytes"), reading::chart(&chart.subject, &readings)));
    }
    for (stem, picture) in pictures {
        files.extend(drawn(&stem, &picture)?);
    }
    let default = PathBuf::from("converge");
    let out = match (&args.out, args.json) {
        (Some(out), _) => Some(out),
        (None, false) => Some(&default),
        (None, true) => None,
    };
    if let Some(out) = out {
        std::fs::create_dir_all(out).map_err(|e| Failure::io(out.display(), &e))?;
        let files: Vec<(PathBuf, Vec<u8>)> = files.into_iter().map(|(f, b)| (out.join(f), b)).collect();
        atomic::write_all(&files, cancel)?;
    }
    let text = match (args.json, before) {
        (true, _) => json,
        (_, Some(before)) => format!("{}\n{}", report::text(&chart, &times), report::compare(before, &chart)),
        _ => report::text(&chart, &times),
    };
    if !args.quiet {
        output::data(&text)?;
    }
    Ok(())
}

fn drawn(stem: &str, picture: &Picture) -> Result<[(String, Vec<u8>); 2], Failure> {
    let png = picture.png().map_err(|e| Failure::new(Exit::Internal, e))?;
    Ok([(format!("{stem}.svg"), picture.svg().into_bytes()), (format!("{stem}.png"), png)])
}

/// A table on its default axes, or the albedo of a model.
fn subject(name: &str) -> Result<Bound, Failure> {
    let request = match (tables::find(name), models::find(name)) {
        (Some(kind), _) => Request { kind: kind.id.to_owned(), ..Request::default() },
        (None, Some((model, _))) => {
            Request { kind: "albedo".to_owned(), model: Some(model.id.to_owned()), ..Request::default() }
        }
        (None, None) => {
            let ids = TABLES.iter().map(|t| t.id).chain(MODELS.iter().map(|m| m.id));
            let near = nearest(name, ids).map_or_else(String::new, |n| format!("; did you mean `{n}`?"));
            return Err(Failure::usage(format!("no table or model `{name}`{near}")));
        }
    };
    request.bind().map_err(|e| Failure::new(Exit::Unsupported, e))
}

fn read(path: &PathBuf) -> Result<Chart, Failure> {
    let text = std::fs::read_to_string(path).map_err(|e| Failure::io(path.display(), &e))?;
    serde_json::from_str(&text)
        .map_err(|e| Failure::input(format!("{}: not the JSON file of `converge`: {e}", path.display())))
}

fn failure(error: ConvergeError) -> Failure {
    match error {
        ConvergeError::Cancelled(stopped) => stopped.into(),
        ConvergeError::NoIntegral { .. } => Failure::new(Exit::Unsupported, error),
        error => Failure::new(Exit::Input, error),
    }
}
