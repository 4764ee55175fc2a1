//! A microfacet distribution projects to the area of the surface: the integral of D cos over the hemisphere is 1.

use super::{Case, Law, Outcome, Watch, total};
use crate::integrate::{Sums, line};
use crate::math::figures::exact;
use crate::tables::normals::Swept;
use crate::tables::{Role, Spec};
use std::f64::consts::{FRAC_PI_2, PI};

/// The law.
pub static LAW: Law = Law {
    id: "normalised",
    statement: "the integral of D cos over the hemisphere is 1 (sigma of SGGX, a density over the whole sphere)",
    margin: "the error of the sum, plus the estimates and what roundings of the cosines change (about 2e-16 / alpha^2), plus 1e-13, \
        minus the deviation; over the widths of the table",
    code: 2003,
    formal: false,
    concerns: |spec| subject(spec).is_some(),
    check,
};

/// Additions and the last rounding.
const ROUNDING: f64 = 1e-13;

/// Accuracy that is asked of the sum.
const TOLERANCE: f64 = 1e-12;

/// The channel that holds a distribution, and the axis of the cosine.
fn subject(spec: &Spec) -> Option<(usize, Role, usize)> {
    let cosine = spec.axis("mu_m")?;
    let of = |(c, channel): (usize, &crate::tables::ChannelInfo)| match channel.role {
        role @ (Role::Distribution { .. } | Role::DistributionRoot) => Some((c, role, cosine)),
        _ => None,
    };
    spec.layout.channels.iter().enumerate().find_map(of)
}

/// What a row of the cosine is to be: the scale on which it changes, the factor of its values, what it adds up to.
struct Row {
    scale: f64,
    factor: f64,
    area: f64,
}

/// The distribution of a table.
enum Subject {
    Normals(Swept),
    /// Kelemen's texels of Beckmann's, with the axis of m.
    Kelemen(usize),
}

impl Subject {
    fn of(spec: &Spec, role: Role) -> Option<Subject> {
        match role {
            Role::DistributionRoot => spec.axis("m").map(Subject::Kelemen),
            _ => Swept::new(spec).ok().flatten().map(Subject::Normals),
        }
    }

    /// The axes of its numbers.
    fn axes(&self) -> Vec<usize> {
        match self {
            Subject::Normals(swept) => swept.axes().iter().map(|(i, _)| *i).collect(),
            Subject::Kelemen(m) => vec![*m],
        }
    }

    fn told(&self, at: &[f64]) -> String {
        match self {
            Subject::Normals(swept) => {
                let one = |(i, id): &(usize, &str)| format!("{id} = {:e}", at[*i]);
                swept.axes().iter().map(one).collect::<Vec<_>>().join(", ")
            }
            Subject::Kelemen(m) => format!("m = {:e}", at[*m]),
        }
    }

    fn row(&self, at: &[f64], relative: bool) -> Option<Row> {
        match self {
            Subject::Normals(swept) => {
                let (shape, normals) = (swept.shape(at).ok()?, swept.normals());
                let factor = if relative { normals.factor(shape) } else { 1.0 };
                Some(Row { scale: normals.scale(shape), factor, area: normals.area(shape) })
            }
            Subject::Kelemen(m) => Some(Row { scale: at[*m], factor: 1.0, area: 1.0 }),
        }
    }
}

fn check(case: &Case<'_>) -> Outcome {
    let spec = case.spec();
    let found = subject(spec).and_then(|(c, role, cosine)| Some((c, role, cosine, Subject::of(spec, role)?)));
    let Some((c, role, cosine, normals)) = found else {
        return Outcome::NotChecked("no distribution over a cosine".to_owned());
    };
    let relative = matches!(role, Role::Distribution { relative: true });
    // lines through the first texel along each number
    let corner: Vec<f64> = case.table.grid.texel(0).values().to_vec();
    let place = |axis: usize, value: f64| {
        let mut at = corner.clone();
        at[axis] = value;
        at
    };
    let lines =
        normals.axes().into_iter().flat_map(|i| total::rows(case, i).into_iter().map(move |v| (i, v)));
    let mut rows: Vec<Vec<f64>> = lines.map(|(i, v)| place(i, v)).collect();
    if rows.is_empty() {
        rows.push(corner.clone());
    }
    let mut watch = Watch::default();
    for mut at in rows.into_iter().take_while(|_| case.goes_on()) {
        let Some(row) = normals.row(&at, relative) else { continue };
        let told = normals.told(&at);
        // D, and what it is for the neighbours of the cosine: a fresh value and its error
        let mut density = |mu: f64| {
            at[cosine] = mu;
            let e = case.bound.baker.texel(&at, case.tolerance).ok()?;
            Some(decode(role, row.factor, e.value[c], e.error[c]))
        };
        // peaks at the normal, cloth at the horizon
        let mut breaks = vec![0.0, FRAC_PI_2];
        let mut next = 0.25 * row.scale;
        while next < FRAC_PI_2 {
            breaks.extend([next, FRAC_PI_2 - next]);
            next *= 4.0;
        }
        breaks.sort_by(f64::total_cmp);
        let sum = line::integrate(&breaks, 2, TOLERANCE, &mut |theta, out: &mut Sums| {
            let (sin, cos) = libm::sincos(theta);
            let measure = 2.0 * PI * sin * cos;
            let near = [cos - f64::EPSILON, cos, cos + f64::EPSILON].map(|mu| density(mu.clamp(0.0, 1.0)));
            let [Some(below), Some(here), Some(above)] = near else {
                out[..2].fill(f64::NAN);
                return;
            };
            out[0] = measure * here.0;
            out[1] = measure * (here.1 + 0.5 * (above.0 - below.0).abs());
        });
        let resolved = sum.error[0] + sum.value[1] + sum.error[1] + ROUNDING;
        watch.see(resolved - (sum.value[0] - row.area).abs(), || {
            format!("integral = {:.12} against {}, {told}", sum.value[0], exact(row.area))
        });
    }
    watch.outcome("no row")
}

/// D and its error from what a channel holds.
fn decode(role: Role, factor: f64, value: f64, error: f64) -> (f64, f64) {
    match role {
        Role::DistributionRoot => {
            let d = libm::pow(2.0 * value, 10.0) / PI;
            (d, 10.0 * d * (error / value.max(f64::MIN_POSITIVE) + f64::EPSILON))
        }
        _ => (value / factor, error / factor),
    }
}
