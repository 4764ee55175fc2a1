//! Transforms of the colour-matching functions over the wavenumber, by another adaptive rule.

use super::{Asked, Truth, quad};
use crate::tables::Role;
use crate::terms::colour::cie_xyz;
use std::f64::consts::TAU;

/// Accuracy that is asked of an integral of nm.
const TARGET: f64 = 1e-10;

/// Roundings of a sum of the observer.
const ROUNDING: f64 = 1e-12;

/// Roles of this file: `int cmf(1 / nu) exp(-2 pi i D nu) dnu / nu^2`.
pub(super) fn truth(role: Role, asked: &Asked<'_>) -> Option<Truth> {
    let Role::Sensitivity { component, imaginary } = role else { return None };
    let spec = asked.spec;
    let (opd, scale) = (asked.at[spec.axis("opd")?], spec.params.number("scale").ok()?);
    let breaks: Vec<f64> = (360..=830).rev().map(|nm| 1.0 / f64::from(nm)).collect();
    let (value, error) = quad::integral(&breaks, TARGET, &mut |nu| {
        let (sin, cos) = libm::sincos(TAU * opd * nu);
        // rounding of the reciprocal must not leave the rows
        let eye = cie_xyz((1.0 / nu).clamp(360.0, 830.0))[component];
        eye * if imaginary { -sin } else { cos } / (nu * nu)
    });
    Some(Truth { value: scale * value, error: scale * (error + ROUNDING) })
}
