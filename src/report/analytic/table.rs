//! Any table of one or two axes: each channel by itself, in the axis coordinates in [0, 1] (warped, as a reader computes them).

use super::formula::{Formula, name, ratio};
use super::lobes;
use super::{BETWEEN, FitError, FittedFormula, LINES, PRACTICAL_WEIGHT, STEPS, Sample, TOLERANCE, reached};
use crate::cancel::Cancel;
use crate::encode::code::coordinates;
use crate::grid::expression::Expression;
use crate::grid::layout::Point as Place;
use crate::grid::scalar::Scalar;
use crate::grid::table::{named, place as words};
use crate::math::rational::{self, Fitted, Point, Terms};
use crate::tables::{Bound, ChannelInfo};
use crate::verify::reconstruction::{has_practical, in_practical_domain};
use rayon::prelude::*;

/// What each channel is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum Form {
    /// P, all terms of a total degree.
    Polynomial,
    /// P / Q, all terms of a total degree each.
    Rational,
}

impl Form {
    /// Least and largest degree.
    #[must_use]
    pub fn degrees(self) -> [usize; 2] {
        match self {
            Form::Polynomial => [1, 8],
            Form::Rational => [1, 5],
        }
    }

    fn word(self) -> &'static str {
        match self {
            Form::Polynomial => "Polynomial",
            Form::Rational => "Rational",
        }
    }
}

/// Values of all channels at axis coordinates.
struct Node {
    x: [f64; 2],
    place: Place,
    value: Vec<f64>,
    practical: bool,
}

/// Every channel of a table of one or two axes, in its axis coordinates: a function of the axes' quantities.
///
/// # Errors
/// [`FitError`] for more axes, a degree outside [`Form::degrees`], or a texel without a value.
pub fn table(bound: &Bound, form: Form, degree: usize) -> Result<FittedFormula, FitError> {
    table_until(&Cancel::new(), bound, form, degree)
}

/// [`table`], until it is stopped.
///
/// # Errors
/// [`FitError`], [`FitError::Cancelled`] among them.
pub fn table_until(
    cancel: &Cancel,
    bound: &Bound,
    form: Form,
    degree: usize,
) -> Result<FittedFormula, FitError> {
    let spec = &bound.spec;
    let axes = spec.grid.axes();
    let [least, most] = form.degrees();
    if axes.len() > 2 {
        let got = format!("{} with {} axes", spec.kind.id, axes.len());
        return Err(FitError::Table { got, why: "a fit takes one or two axes" });
    }
    if !(least..=most).contains(&degree) {
        let why = "polynomials have degrees 1 to 8, rational functions 1 to 5";
        return Err(FitError::Table { got: format!("degree {degree}"), why });
    }
    let nodes = nodes(cancel, bound, [0.0; 2])?;
    let channels: Vec<&ChannelInfo> = spec.layout.channels.iter().collect();
    let terms = Terms::of_degree(degree, axes.len(), form == Form::Rational);
    let fitted: Option<Vec<Fitted>> =
        (0..channels.len()).into_par_iter().map(|c| channel(cancel, &nodes, c, &terms)).collect();
    cancel.check()?;
    let pole = || FitError::Pole { degree };
    let range = |(c, info): (usize, &&ChannelInfo)| reached(info.range, nodes.iter().map(|n| n.value[c]));
    let ranges: Vec<[f64; 2]> = channels.iter().enumerate().map(range).collect();
    let formula = formula(bound, &terms, &fitted.ok_or_else(pole)?, &ranges)?;
    let model = spec.model.as_ref().map_or_else(String::new, |(info, _)| format!(" of {}", info.id));
    let domain = |a: &crate::grid::Axis| format!("{} in [{}, {}]", a.quantity.id, a.domain[0], a.domain[1]);
    let titles = [
        format!("{}{model}, {}", spec.kind.title, axes.iter().map(domain).collect::<Vec<_>>().join(", ")),
        format!("{}, degree {degree}", form.word()),
    ];
    let results = channels.iter().map(|c| c.id.to_owned()).collect();
    let mut all = nodes;
    for offset in BETWEEN.into_iter().take(if axes.len() > 1 { 3 } else { 1 }) {
        all.extend(self::nodes(cancel, bound, offset)?);
    }
    let arguments =
        |n: &Node| axes.iter().zip(n.place.values()).map(|(a, v)| a.quantity.from_base(*v)).collect();
    let sample = |n: &Node| Sample { arguments: arguments(n), want: n.value.clone(), practical: n.practical };
    let samples: Vec<Sample> = all.iter().map(sample).collect();
    let mut fit = FittedFormula::measured(formula, titles, (results, ranges), &samples).ok_or_else(pole)?;
    let place = |n: Node| lobes::Place {
        at: n.place.values().to_vec(),
        arguments: arguments(&n),
        want: n.value,
        practical: n.practical,
    };
    let places: Vec<lobes::Place> = all.into_iter().map(place).collect();
    fit.lobes = lobes::measure(cancel, bound, &fit, &places)?;
    Ok(fit)
}

/// Values on a grid of coordinates, shifted by a part of their distance.
fn nodes(cancel: &Cancel, bound: &Bound, offset: [f64; 2]) -> Result<Vec<Node>, FitError> {
    let grid = &bound.spec.grid;
    let channels = bound.spec.layout.channels.len();
    let two = grid.axes().len() > 1;
    let last = if two { LINES - 1 } else { 8 * (LINES - 1) };
    let lines = offset.map(|shift| last + usize::from(shift <= 0.0));
    let cuts = has_practical(grid);
    let one = |n: usize| {
        cancel.check()?;
        let coordinate = |i: usize, shift: f64| (i as f64 + shift) / last as f64;
        let x = [coordinate(n % lines[0], offset[0]), coordinate(n / lines[0], offset[1])];
        let place = grid.at_coordinates(&x);
        let texel = bound.baker.texel(place.values(), TOLERANCE);
        let fault = |error| FitError::Texel {
            at: words(&named(grid, &place)),
            channels: bound.spec.layout.ids().map(str::to_owned).collect(),
            error,
        };
        let value = texel.map_err(fault)?.value;
        let practical = cuts && in_practical_domain(grid, &place);
        Ok(Node { x: if two { x } else { [x[0], 0.0] }, place, value: value[..channels].to_vec(), practical })
    };
    let count = if two { lines[0] * lines[1] } else { lines[0] };
    (0..count).into_par_iter().map(one).collect()
}

fn channel(cancel: &Cancel, nodes: &[Node], c: usize, terms: &Terms) -> Option<Fitted> {
    let point = |n: &Node| Point {
        at: n.x,
        base: 0.0,
        factor: 1.0,
        want: n.value[c],
        weight: if n.practical { PRACTICAL_WEIGHT } else { 1.0 },
        slack: 0.0,
    };
    let points: Vec<Point> = nodes.iter().map(point).collect();
    rational::fit(&points, terms, 1, STEPS, cancel)
}

fn formula(
    bound: &Bound,
    terms: &Terms,
    fitted: &[Fitted],
    ranges: &[[f64; 2]],
) -> Result<Formula, FitError> {
    let spec = &bound.spec;
    let axes = spec.grid.axes();
    let mut steps: Vec<(String, Expression)> = Vec::new();
    for (i, x) in coordinates(axes, false).into_iter().enumerate() {
        steps.push((format!("x{i}"), x));
    }
    let mut denominators = Vec::new();
    let mut results = Vec::new();
    for (c, (fitted, range)) in fitted.iter().zip(ranges).enumerate() {
        let ratio = ratio(terms, fitted, "x0", "x1");
        let mut result = ratio.above;
        if !terms.below.is_empty() {
            steps.push((format!("q{c}"), ratio.below));
            denominators.push((format!("q{c}"), ratio.unit));
            result = result.over(name(&format!("q{c}")));
        }
        let [lo, hi] = *range;
        results.push(match (lo.is_finite(), hi.is_finite()) {
            (true, true) => result.at_least(lo).at_most(hi),
            (true, false) => result.at_least(lo),
            (false, true) => result.min(Expression::Number(hi)),
            (false, false) => result,
        });
    }
    Ok(Formula {
        name: format!("{}_fit", spec.kind.id.replace('-', "_")),
        arguments: axes.iter().map(|a| a.quantity.id).collect(),
        steps,
        results,
        denominators,
    })
}
