//! `brdfbake fit ggx --degree 2 --lang wgsl`: the split sum of a model as a formula, with its errors.

use super::{Exit, Failure, albedo, output};
use crate::report::analytic::{self, DEGREES, Fit, Lang, Variables};
use crate::tables::spec::Request;

/// Arguments of `fit`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// A model whose Fresnel factor splits off.
    #[arg(default_value = "ggx")]
    model: String,
    /// A parameter, as key=value; may be given several times.
    #[arg(short, long = "param", value_name = "KEY=VALUE")]
    params: Vec<String>,
    /// Degree of the polynomials in each variable, 1 to 5.
    #[arg(short, long, conflicts_with = "error")]
    degree: Option<usize>,
    /// Instead of a degree: the largest error in the practical domain; the least degree that reaches it is taken.
    #[arg(short, long)]
    error: Option<f64>,
    /// The variable beside alpha.
    #[arg(long, value_enum, default_value = "coupled")]
    variables: Variables,
    /// Language of the code.
    #[arg(short, long, value_enum, default_value = "glsl")]
    lang: Lang,
}

/// Runs it: exit code 4 if no degree reaches the error.
///
/// # Errors
/// [`Failure`] for a bad model, parameter, degree or error, or if there is no fit.
pub fn run(args: &Args) -> Result<Exit, Failure> {
    let [least, most] = DEGREES;
    let degrees = match (args.degree, args.error) {
        (Some(n), _) if !(least..=most).contains(&n) => {
            return Err(Failure::usage(format!("--degree {n} outside {least} to {most}")));
        }
        (_, Some(e)) if !(e > 0.0 && e.is_finite()) => {
            return Err(Failure::usage(format!("--error {e} must be a positive number")));
        }
        (n, None) => n.unwrap_or(2)..=n.unwrap_or(2),
        (_, Some(_)) => least..=most,
    };
    let request = Request {
        kind: "dfg".to_owned(),
        layout: Some("factored".to_owned()),
        model: Some(args.model.clone()),
        params: albedo::parse_params(&args.params)?,
        ..Request::default()
    };
    let bound = request.bind().map_err(Failure::input)?;
    let mut best: Option<Fit> = None;
    for degree in degrees {
        let fit = match analytic::fit(&bound, degree, args.variables) {
            Ok(fit) => fit,
            // another degree may do
            Err(analytic::FitError::Pole { .. }) if args.error.is_some() => continue,
            Err(e) => return Err(Failure::new(Exit::Failed, e)),
        };
        if best.as_ref().is_none_or(|b| fit.practical.largest < b.practical.largest) {
            best = Some(fit);
        }
        if best.as_ref().zip(args.error).is_some_and(|(b, e)| b.practical.largest <= e) {
            break;
        }
    }
    let fit = best.ok_or_else(|| Failure::new(Exit::Failed, "no degree has a positive denominator"))?;
    if let Some(asked) = args.error.filter(|e| fit.practical.largest > *e) {
        let reached = fit.practical.largest;
        let message = format!(
            "no degree up to {most} is within {asked:e} in the practical domain; the best reached {reached:e}"
        );
        return Err(Failure::new(Exit::Failed, message));
    }
    output::data(&fit.code(args.lang));
    Ok(Exit::Done)
}
