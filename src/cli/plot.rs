//! `brdfbake plot MODEL...`: lobes as polar plots or maps of the hemisphere, or albedos as curves; as SVG or PNG.

use super::texel::Texels;
use super::{Exit, Failure, albedo, output};
use crate::cancel::Cancel;
use crate::encode::atomic;
use crate::math::figures::exact;
use crate::models::{self, Brdf, ModelInfo, Params};
use crate::pipeline::map::texel::MapTexel;
use crate::report::plot::{self, Figure, Look, PlotError, Scale, Subject};
use serde_json::{Map, Value as Json};
use std::path::PathBuf;
use std::sync::Arc;

/// Shown behind the help.
const EXAMPLES: &str = concat!(
    "Examples:",
    "\n  brdfbake plot ggx --param alpha=0.3 -o lobe.svg",
    "\n  brdfbake plot ggx beckmann --sweep alpha=0.2,0.4 --angles 45 -o widths.png",
    "\n  brdfbake plot ward --param alpha_x=0.1 --param alpha_y=0.4 --show map --azimuth 30 -o ward.png",
    "\n  brdfbake plot oren-nayar eon --show albedo -o albedo.svg",
    "\n  brdfbake plot ggx --texel maps/map:3,1,1 -o texel.svg",
);

/// Most lobes in a picture.
const MOST: usize = 24;

/// What to draw.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Show {
    /// f in the plane of incidence as a polar plot; below the horizon what is transmitted.
    Lobe,
    /// f over the whole hemisphere as colours.
    Map,
    /// The directional albedo over the cosine of the view.
    Albedo,
}

/// Arguments of `plot`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Model ids, or others of their names; several are drawn beside each other.
    #[arg(required = true)]
    models: Vec<String>,
    /// A parameter, as key=value, of each model that has it; may be given several times.
    #[arg(short, long = "param", value_name = "KEY=VALUE")]
    params: Vec<String>,
    /// A parameter with several values, each of which is drawn.
    #[arg(long, value_name = "KEY=V1,V2,...")]
    sweep: Option<String>,
    #[command(flatten)]
    texels: Texels,
    /// What to draw.
    #[arg(long, value_enum, default_value = "lobe")]
    show: Show,
    /// Angles of incidence in degrees, separated by commas; 0,30,60,80 if not given, of maps 0,45,75.
    #[arg(long, value_name = "DEGREES", value_delimiter = ',')]
    angles: Vec<f64>,
    /// Azimuth of the plane of incidence, or of the view of an albedo, from the tangent, in degrees; 0 if not given. It matters to
    /// anisotropic models only.
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true)]
    azimuth: Option<f64>,
    /// How a value becomes a radius or a colour; log if not given.
    #[arg(long, value_enum)]
    scale: Option<Scale>,
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
        let message = format!("--angles {} outside [0, 90): degrees from the normal", exact(bad));
        return Err(Failure::usage(message));
    }
    if let Some(bad) = args.azimuth.filter(|a| !(-360.0..=360.0).contains(a)) {
        return Err(Failure::usage(format!("--azimuth {} outside [-360, 360] degrees", exact(bad))));
    }
    let texel = args.texels.read(cancel)?;
    let built = build(args, texel.as_ref())?;
    let title = match built.as_slice() {
        [one] => one.info.title.to_owned(),
        _ => heading(args, &built),
    };
    let subjects: Vec<Subject<'_>> =
        built.iter().map(|b| Subject { name: b.name(built.len() > 1), model: &*b.model }).collect();
    if args.azimuth.is_some() && !subjects.iter().any(|s| s.model.turns()) {
        return Err(Failure::usage("--azimuth: nothing here depends on it; these models are isotropic"));
    }
    let figure = draw(args, &title, &subjects, cancel)?;
    let default = [PathBuf::from(format!("{}.svg", built[0].info.id))];
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

fn draw(args: &Args, title: &str, subjects: &[Subject<'_>], cancel: &Cancel) -> Result<Figure, Failure> {
    let azimuth = args.azimuth.unwrap_or(0.0);
    if args.show == Show::Albedo {
        let idle = [("--angles", !args.angles.is_empty()), ("--scale", args.scale.is_some())];
        if let Some((option, _)) = idle.iter().find(|(_, given)| *given) {
            return Err(Failure::usage(format!("{option} tells of lobes, and albedos are drawn")));
        }
        return plot::curves(title, subjects, azimuth, cancel).map_err(|e| match e {
            PlotError::Cancelled(stopped) => stopped.into(),
            PlotError::Texel(e) => Failure::new(Exit::of_texel(&e), e.of(["E"].into_iter())),
        });
    }
    let degrees = match (args.angles.is_empty(), args.show) {
        (false, _) => args.angles.clone(),
        (true, Show::Map) => vec![0.0, 45.0, 75.0],
        (true, _) => vec![0.0, 30.0, 60.0, 80.0],
    };
    let count = degrees.len() * subjects.len();
    if count > MOST {
        return Err(Failure::usage(format!("{count} lobes in one picture; at most {MOST}")));
    }
    let look = Look { degrees, azimuth, scale: args.scale.unwrap_or(Scale::Log) };
    Ok(match args.show {
        Show::Map => plot::map(title, subjects, &look),
        _ => plot::polar(title, subjects, &look),
    })
}

/// A model that is drawn.
struct Built {
    info: &'static ModelInfo,
    /// Those that are shown.
    params: Map<String, Json>,
    /// What a texel tells.
    texel: Option<String>,
    model: Box<dyn Brdf>,
}

impl Built {
    /// The parameters in words, behind the model if there are several.
    fn name(&self, with_model: bool) -> String {
        let value = |v: &Json| v.as_f64().map_or_else(|| v.to_string().replace('"', ""), exact);
        let mut words: Vec<String> = self.params.iter().map(|(k, v)| format!("{k} = {}", value(v))).collect();
        if with_model {
            words.insert(0, self.info.id.to_owned());
        }
        words.extend(self.texel.clone());
        words.join(", ")
    }
}

/// Every model with every value of the sweep.
fn build(args: &Args, texel: Option<&MapTexel>) -> Result<Vec<Built>, Failure> {
    let given = albedo::parse_params(&args.params)?;
    let (key, values) = match &args.sweep {
        None => (String::new(), vec![None]),
        Some(sweep) => {
            let (key, values) = swept(sweep)?;
            if given.contains_key(&key) {
                return Err(Failure::input(format!(
                    "--sweep {sweep}: `{key}` is a --param, too; leave one out"
                )));
            }
            (key, values.into_iter().map(Some).collect())
        }
    };
    let several = args.models.len() > 1;
    let mut used: Vec<&str> = Vec::new();
    let mut all = Vec::new();
    for (i, name) in args.models.iter().enumerate() {
        if args.models[..i].contains(name) {
            return Err(Failure::usage(format!("model {name} is given twice; leave one out")));
        }
        let (info, implied) = models::find(name).ok_or_else(|| albedo::unknown_model(name))?;
        // one model says by itself what it does not know
        let knows = |key: &str| !several || info.param(key).is_some();
        used.extend(given.keys().map(String::as_str).chain([key.as_str()]).filter(|k| knows(k)));
        for value in values.iter().take(if knows(&key) { values.len() } else { 1 }) {
            let mut params: Map<String, Json> =
                given.iter().filter(|(k, _)| knows(k)).map(|(k, v)| (k.clone(), v.clone())).collect();
            params.extend(value.iter().filter(|_| knows(&key)).map(|v| (key.clone(), v.clone())));
            let model = match texel {
                Some(texel) => texel.model((info, implied), &params).map_err(Failure::input)?,
                None => albedo::build(name, &params)?.1,
            };
            if model.mirror(1.0).is_some() {
                let message =
                    format!("{} is a mirror with these parameters: a delta has no lobe to draw", info.id);
                return Err(Failure::new(Exit::Unsupported, message));
            }
            if !several && values.len() == 1 && texel.is_none() {
                // there is room for what was left as it is
                let implied = models::implied_values(implied);
                let resolved = Params::resolve_over(info.id, info.params, &implied, &params);
                params = resolved.map_err(Failure::input)?.to_json(&[]);
            }
            all.push(Built { info, params, texel: texel.map(MapTexel::words), model });
        }
    }
    let keys = given.keys().map(String::as_str).chain((!key.is_empty()).then_some(key.as_str()));
    if let Some(idle) = keys.into_iter().find(|k| !used.contains(k)) {
        return Err(Failure::input(format!("none of these models has a parameter `{idle}`")));
    }
    Ok(all)
}

/// A parameter and its values.
fn swept(sweep: &str) -> Result<(String, Vec<Json>), Failure> {
    let (key, list) = sweep.split_once('=').ok_or_else(|| {
        Failure::usage(format!("--sweep {sweep}: expected KEY=V1,V2, such as alpha=0.1,0.4"))
    })?;
    let mut values: Vec<Json> = Vec::new();
    for text in list.split(',') {
        let one = albedo::parse_params(&[format!("{key}={text}")])?;
        for value in one.into_values() {
            if values.contains(&value) {
                return Err(Failure::usage(format!("--sweep {sweep}: {text} is given twice; leave one out")));
            }
            values.push(value);
        }
    }
    Ok((key.to_owned(), values))
}

/// What several models have in common.
fn heading(args: &Args, built: &[Built]) -> String {
    let mut names: Vec<&str> = built.iter().map(|b| b.info.title).collect();
    names.dedup();
    let what = match args.show {
        Show::Albedo => "Directional albedo",
        _ => "Lobes",
    };
    format!("{what}: {}", names.join("; "))
}
