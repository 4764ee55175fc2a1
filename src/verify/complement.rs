//! What is missing is what the albedos leave: 1 - E, from the model by another route than the table's.

use super::{Law, cross_check};
use crate::tables::Role;

/// The law.
pub static LAW: Law = Law {
    id: "complement",
    statement: "the missing energy is one minus the sampled albedo",
    margin: "6 standard errors, plus 2 / N for tails that N draws miss, plus the error estimate, minus the difference; smallest of 12 texels",
    code: 2005,
    formal: false,
    concerns: |spec| spec.roles().iter().any(|role| matches!(role, Role::Complement(..))),
    check: |case| cross_check::check(case, 0x3a11),
};
