//! `brdfbake albedo MODEL --param k=v --mu 0.1,0.5 --tolerance 1e-8`: E, and T of models that transmit.

use super::{Exit, Failure, output};
use crate::cancel::Cancel;
use crate::integrate::View;
use crate::math::figures::exact;
use crate::models::{self, Params};
use crate::tables::integral::{Functional, integrate, integrate_in_chart};
use serde_json::{Map, Value as Json};

/// Shown behind the help.
const EXAMPLES: &str = concat!(
    "Examples:",
    "\n  brdfbake albedo ggx --param alpha=0.25 --mu 0.1,0.5",
    "\n  brdfbake albedo ward --param alpha_x=0.1 --param alpha_y=0.4 --phi 0.5",
);

/// Arguments of `albedo`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Model id, or another of its names.
    model: String,
    /// A parameter, as key=value; may be given several times.
    #[arg(short, long = "param", value_name = "KEY=VALUE")]
    params: Vec<String>,
    /// View cosines, separated by commas.
    #[arg(long, value_name = "MU", value_delimiter = ',', default_value = "0.05,0.1,0.25,0.5,0.75,1")]
    mu: Vec<f64>,
    /// View azimuth from the tangent, in radians; it matters to anisotropic models only.
    #[arg(long, value_name = "PHI", default_value_t = 0.0)]
    phi: f64,
    /// Absolute tolerance of E.
    #[arg(short, long, default_value_t = 1e-8)]
    tolerance: f64,
    /// Use the model's chart even if it has a one-dimensional reduction.
    #[arg(long)]
    chart: bool,
    /// Print one JSON object a line.
    #[arg(long)]
    json: bool,
}

/// Runs it: exit code 4 if an estimate stays above the tolerance.
///
/// # Errors
/// [`Failure`] for an unknown model, a bad parameter, or a model without an albedo.
pub fn run(args: &Args, cancel: &Cancel) -> Result<Exit, Failure> {
    if !(args.tolerance > 0.0 && args.tolerance.is_finite()) {
        return Err(Failure::usage(format!(
            "--tolerance {} must be a positive number",
            exact(args.tolerance)
        )));
    }
    if !args.phi.is_finite() {
        return Err(Failure::usage(format!("--phi {} must be a number of radians", exact(args.phi))));
    }
    let given = parse_params(&args.params)?;
    let (info, model) = build(&args.model, &given)?;
    if args.phi.abs() > 0.0 && !model.turns() {
        return Err(Failure::usage(format!(
            "--phi {}: {} is the same at every azimuth",
            exact(args.phi),
            info.id
        )));
    }
    let mut text = String::new();
    let mut missed = false;
    if !args.json {
        let through = if model.transmission().is_some() { "\tT\terror of T" } else { "" };
        text.push_str(&format!("mu\tE\terror\tevaluations{through}\n"));
    }
    for &mu in &args.mu {
        cancel.check()?;
        if !(0.0..=1.0).contains(&mu) {
            return Err(Failure::input(format!(
                "mu = {} outside [0, 1]: it is the cosine of the view angle",
                exact(mu)
            )));
        }
        let view = View { mu, phi: args.phi };
        let rule = if args.chart { integrate_in_chart } else { integrate };
        let e = rule(&*model, view, &[Functional::One], args.tolerance).map_err(|e| {
            let why = e.of(["E"].into_iter());
            Failure::new(Exit::of_texel(&e), format!("{}: mu = {}: {why}", info.id, exact(mu)))
        })?;
        let through = model.transmission().map(|t| t.albedo(view, args.tolerance));
        let through = through.map(|t| (t.value[0], t.error[0]));
        missed |= e.error[0] > args.tolerance || through.is_some_and(|t| t.1 > args.tolerance);
        if args.json {
            let mut line = serde_json::json!({
                "model": info.id, "mu": mu, "e": e.value[0], "error": e.error[0], "evaluations": e.evaluations,
            });
            if let Some((t, error)) = through {
                line["t"] = t.into();
                line["t_error"] = error.into();
            }
            text.push_str(&format!("{line}\n"));
        } else {
            let through =
                through.map_or_else(String::new, |(t, error)| format!("\t{}\t{error:.1e}", exact(t)));
            text.push_str(&format!(
                "{}\t{}\t{:.1e}\t{}{through}\n",
                exact(mu),
                exact(e.value[0]),
                e.error[0],
                e.evaluations
            ));
        }
    }
    output::data(&text)?;
    if missed {
        return Err(Failure::new(
            Exit::Failed,
            format!("an estimated error is above the tolerance {:e}; ask for a larger one", args.tolerance),
        ));
    }
    Ok(Exit::Done)
}

/// `key=value` pairs as JSON: numbers and lists where they parse as such, else words.
pub(super) fn parse_params(params: &[String]) -> Result<Map<String, Json>, Failure> {
    let mut map = Map::new();
    for param in params {
        let (key, value) = param.split_once('=').ok_or_else(|| {
            Failure::usage(format!("--param {param}: expected KEY=VALUE, such as alpha=0.25"))
        })?;
        let list = || serde_json::from_str(value).ok().filter(Json::is_array);
        let word = || list().unwrap_or_else(|| Json::from(value));
        // JSON has no name for what is not finite: it stays a word, which no number takes
        let number = value.parse::<f64>().ok().filter(|v| v.is_finite());
        if map.insert(key.to_owned(), number.map_or_else(word, Json::from)).is_some() {
            return Err(Failure::input(format!("--param {param}: `{key}` is given twice; leave one out")));
        }
    }
    Ok(map)
}

/// Builds a model by name.
pub(super) fn build(
    name: &str,
    given: &Map<String, Json>,
) -> Result<(&'static models::ModelInfo, Box<dyn models::Brdf>), Failure> {
    let (info, implied) = models::find(name).ok_or_else(|| unknown_model(name))?;
    let implied = models::implied_values(implied);
    let params = Params::resolve_over(info.id, info.params, &implied, given).map_err(Failure::input)?;
    Ok((info, (info.build)(&params).map_err(Failure::input)?))
}

/// The message for a model that does not exist.
pub(super) fn unknown_model(name: &str) -> Failure {
    let ids = models::MODELS.iter().map(|m| m.id);
    Failure::input(format!("no model `{name}`{}", crate::math::nearest::offer(name, ids)))
}
