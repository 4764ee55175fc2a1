//! Parameters of a lobe as those of another kind, whichever both are.

use super::{By, Conversion, FROM, NUMBER, conversion, undefined, within};
use crate::cite;
use crate::functions::{FunctionError, FunctionInfo, NO_ANGLES, known, number};
use crate::models::{Param, Params};
use crate::terms::half_vectors;

/// What a lobe became in the numbers of another kind.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Told {
    /// The numbers, within their ranges; a single one is given twice.
    pub numbers: [f64; 2],
    /// D between the lobe and the one of these numbers.
    pub distance: f64,
}

/// D below which two lobes are one.
const SAME: f64 = 1e-9;

impl Conversion {
    /// The lobe of these numbers in those of another kind: of least D, or of equal peaks. None where that has one number and the lobe two
    /// widths.
    ///
    /// Disney's and OpenPBR's numbers widen a lobe along x only; D says what that costs along y.
    #[must_use]
    pub fn told_as(&self, numbers: [f64; 2], to: &Conversion, by: By) -> Option<Told> {
        let lobe = (self.lobe)(numbers);
        if to.numbers.len() == 1 && !lobe.is_isotropic() {
            return None;
        }
        let held = |widths: [f64; 2]| {
            let found = (to.told)(widths);
            let bounds = |i: usize| to.numbers.get(i).or(to.numbers.first()).map_or(NUMBER, |n| n.1);
            std::array::from_fn(|i| found[i].clamp(bounds(i)[0], bounds(i)[1]))
        };
        let distance = |widths: [f64; 2]| half_vectors::distance(&lobe, &(to.lobe)(held(widths)));
        let peaks = half_vectors::formula(&lobe);
        let widths = match by {
            By::Formula => peaks,
            By::Nearest if distance(peaks) < SAME => peaks,
            By::Nearest if to.model.is_none() => half_vectors::nearest(&lobe),
            By::Nearest => half_vectors::least(lobe.is_isotropic(), peaks, distance),
        };
        Some(Told { numbers: held(widths), distance: distance(widths) })
    }
}

/// Exponent of a Blinn-Phong lobe with the peak of GGX of the width α: the inverse of √(2/(n + 2)).
pub(super) fn exponent(alpha: f64) -> f64 {
    2.0 / (alpha * alpha) - 2.0
}

fn part(p: &Params) -> Result<f64, FunctionError> {
    let known = |id: &str| conversion(p.choice(id)?).ok_or_else(|| undefined(ID));
    let (from, to) = (known("from")?, known("to")?);
    let first = p.number("a")?;
    let numbers = [first, if from.numbers.len() > 1 { p.number("b")? } else { first }];
    if !within(from, numbers) {
        return Err(undefined(ID));
    }
    let by = if p.choice("rule")? == "formula" { By::Formula } else { By::Nearest };
    let why = "one number does not tell of two widths";
    let told = from.told_as(numbers, to, by).ok_or(FunctionError::Undefined { function: ID, why })?;
    Ok(match p.choice("part")? {
        "first" => told.numbers[0],
        "second" => told.numbers[1],
        _ => told.distance,
    })
}

const ID: &str = "to-lobe";

/// The function; see the module.
pub(super) const INFO: FunctionInfo = FunctionInfo {
    id: ID,
    title: "Parameters of a lobe as those of another kind",
    formula: "argmin D(lobe, lobe of the other kind), or equal peaks: n = 2 / m^2 - 2, m = alpha",
    sources: &[(cite::WALTER_2007, "Eq. 30 and 33")],
    params: &[
        Param::choice("from", "what the numbers are", FROM),
        Param::choice("to", "what is asked for", FROM),
        number("a", "the number; the first of two", NUMBER, 10.0),
        number("b", "the second number, where there are two", NUMBER, 10.0),
        Param::choice("rule", "by least D, or by equal peaks", &["nearest", "formula"]),
        Param::choice("part", "the first number; the second; D", &["first", "second", "distance"]),
    ],
    inputs: &[],
    unit: "1",
    range: [0.0, 1e7],
    notes: "D is half the integral of the difference of D cos over the hemisphere. Widths beyond what the other kind takes are held at \
            its ends, and D tells of that.",
    also: &[],
    known: &[
        known(
            &[("from", "\"beckmann\""), ("a", "0.5"), ("rule", "\"formula\"")],
            NO_ANGLES,
            6.0,
            1e-14,
            "closed form: 2 / 0.25 - 2",
        ),
        known(
            &[("to", "\"beckmann\""), ("a", "1000"), ("rule", "\"formula\""), ("part", "\"distance\"")],
            NO_ANGLES,
            0.0005,
            0.1,
            "sum over the hemisphere by another program",
        ),
        known(
            &[("from", "\"alpha\""), ("to", "\"beckmann\""), ("a", "0.3"), ("part", "\"distance\"")],
            NO_ANGLES,
            0.179_768,
            1e-5,
            "sum over the hemisphere by another program",
        ),
    ],
    eval: |p, _| part(p),
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_of_ranges_are_told() {
        for from in super::super::CONVERSIONS {
            for to in super::super::CONVERSIONS {
                for numbers in
                    [0, 1].map(|end| [0, 1].map(|i| from.numbers[i.min(from.numbers.len() - 1)].1[end]))
                {
                    let Some(told) = from.told_as(numbers, to, By::Formula) else { continue };
                    let fine = told.numbers.iter().all(|v| v.is_finite())
                        && (0.0..=1.0 + 1e-9).contains(&told.distance);
                    assert!(fine, "{} {numbers:?} to {}: {told:?}", from.id, to.id);
                }
            }
        }
    }
}
