//! `brdfbake fit`: a table as a formula, with its errors: the split sum of a model, or the channels of any table.

use super::{Exit, Failure, albedo, bake, output};
use crate::cancel::Cancel;
use crate::math::figures::exact;
use crate::report::analytic::{self, DEGREES, FitError, FittedFormula, Form, Lang};
use crate::tables::Bound;
use crate::tables::spec::Request;

/// Shown behind the help.
const EXAMPLES: &str =
    "Examples:\n  brdfbake fit -t fresnel-dielectric --form polynomial --degree 2 --lang wgsl";

/// Arguments of `fit`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// A model; without a table, one whose Fresnel factor splits off. Default: the table's, or ggx.
    model: Option<String>,
    /// A parameter, as key=value; may be given several times.
    #[arg(short, long = "param", value_name = "KEY=VALUE")]
    params: Vec<String>,
    /// A table of this recipe or preset, on its axes.
    #[arg(short, long, value_name = "RECIPE", conflicts_with_all = ["model", "params", "layout"])]
    recipe: Option<String>,
    /// Which table: a name in the recipe; without one, a kind of `list tables` on its default axes.
    #[arg(short, long)]
    table: Option<String>,
    /// Channels of the kind; its first layout if not given.
    #[arg(long, requires = "table", conflicts_with = "recipe")]
    layout: Option<String>,
    /// Each channel by itself, as P or as P / Q, in the coordinates of the axes; split sums have a form of their own.
    #[arg(long, value_enum)]
    form: Option<Form>,
    /// Degree, 1 to 5; of polynomials, 1 to 8. Default: 3
    #[arg(short, long, conflicts_with = "error")]
    degree: Option<usize>,
    /// Instead of a degree: the largest error; the least degree that reaches it is taken.
    #[arg(short, long)]
    error: Option<f64>,
    /// Where the error is asked for: practical is mu >= 0.05, roughness >= 0.09.
    #[arg(long, value_enum, default_value = "practical", requires = "error", conflicts_with = "degree")]
    domain: Domain,
    /// Language of the code.
    #[arg(long, value_enum, default_value = "glsl")]
    lang: Lang,
}

/// Where an error is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Domain {
    Practical,
    Whole,
}

/// Runs it: exit code 4 if no degree reaches the error.
///
/// # Errors
/// [`Failure`] for a bad model, recipe, table, parameter, degree or error, or if there is no fit.
pub fn run(args: &Args, cancel: &Cancel) -> Result<Exit, Failure> {
    let bound = bound(args)?;
    let split = args.form.is_none() && analytic::splits(&bound);
    let form = args.form.unwrap_or(Form::Rational);
    let [least, most] = if split { DEGREES } else { form.degrees() };
    let degrees = match (args.degree, args.error) {
        (Some(n), _) if !(least..=most).contains(&n) => {
            return Err(Failure::usage(format!("--degree {n} outside {least} to {most}")));
        }
        (_, Some(e)) if !(e > 0.0 && e.is_finite()) => {
            return Err(Failure::usage(format!("--error {} must be a positive number", exact(e))));
        }
        (n, None) => n.unwrap_or(3)..=n.unwrap_or(3),
        (_, Some(_)) => least..=most,
    };
    let results = if split { 3 } else { bound.spec.layout.channels.len() };
    if results > args.lang.most_results() {
        let (lang, most) = (format!("{:?}", args.lang).to_lowercase(), args.lang.most_results());
        let message = format!(
            "a function of {lang} returns {most} numbers, this table has {results}; use --lang c, rust or python"
        );
        return Err(Failure::input(message));
    }
    let one = |degree| {
        if split {
            analytic::split_sum_until(cancel, &bound, degree)
        } else {
            analytic::table_until(cancel, &bound, form, degree)
        }
    };
    let fit = best(degrees, args, one)?;
    output::data(&fit.code(args.lang))?;
    Ok(Exit::Done)
}

/// The one degree, or the least that reaches the error.
fn best(
    degrees: std::ops::RangeInclusive<usize>,
    args: &Args,
    one: impl Fn(usize) -> Result<FittedFormula, FitError>,
) -> Result<FittedFormula, Failure> {
    let practical = args.domain == Domain::Practical;
    let most = *degrees.end();
    let mut reached: Option<f64> = None;
    for degree in degrees {
        match (one(degree), args.error) {
            (Ok(fit), None) => return Ok(fit),
            (Ok(fit), Some(error)) if fit.largest(practical) <= error => return Ok(fit),
            (Ok(fit), Some(_)) => {
                reached = Some(reached.map_or(fit.largest(practical), |r| r.min(fit.largest(practical))));
            }
            // another degree may do
            (Err(FitError::Pole { .. }), Some(_)) => {}
            (Err(e), _) => return Err(e.into()),
        }
    }
    let reached =
        reached.map_or_else(|| "none fits at all".to_owned(), |r| format!("the best reached {r:.2e}"));
    let (error, domain) = (args.error.unwrap_or_default(), format!("{:?}", args.domain).to_lowercase());
    let message = format!("no degree up to {most} is within {error:e} over the {domain} domain; {reached}");
    Err(Failure::new(Exit::Failed, message))
}

/// The table that is to be fitted.
fn bound(args: &Args) -> Result<Bound, Failure> {
    let Some(recipe) = &args.recipe else {
        let split = args.table.is_none();
        let request = Request {
            kind: args.table.clone().unwrap_or_else(|| "dfg".to_owned()),
            layout: if split { Some("factored".to_owned()) } else { args.layout.clone() },
            model: args.model.clone(),
            params: albedo::parse_params(&args.params)?,
            ..Request::default()
        };
        return request.bind().map_err(Failure::input);
    };
    let mut tables = bake::plan(recipe)?.tables;
    let names: Vec<String> = tables.iter().map(|t| t.name().to_owned()).collect();
    let place = match &args.table {
        None if names.len() == 1 => Some(0),
        None => None,
        Some(name) => names.iter().position(|n| n == name),
    };
    match (place, &args.table) {
        (Some(i), _) => Ok(tables.swap_remove(i).bound),
        (None, Some(name)) => {
            Err(Failure::input(format!("{recipe}: no table `{name}`; there is {}", names.join(", "))))
        }
        (None, None) => {
            Err(Failure::usage(format!("{recipe} has {}; name one with --table", names.join(", "))))
        }
    }
}
