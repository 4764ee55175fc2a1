//! Every value is finite, and not negative where its channel has no negative range.

use super::{Case, Law, Outcome, Watch};
use crate::tables::place;

/// The law.
pub static LAW: Law = Law {
    id: "finite",
    statement: "every value is finite, and not negative unless its channel can be, within its error",
    margin: "smallest value plus its error estimate",
    code: 4001,
    formal: true,
    concerns: |_| true,
    check,
};

fn check(case: &Case<'_>) -> Outcome {
    let mut watch = Watch::default();
    let channels = case.table.channels.len();
    for (i, (&v, &e)) in case.table.values.iter().zip(&case.table.errors).enumerate() {
        let signed = case.table.channels[i % channels].range[0] < 0.0;
        let margin = match v.is_finite() {
            false => f64::NEG_INFINITY,
            true if signed => e,
            true => v + e,
        };
        watch.see(margin, || {
            format!("{}, {}", case.table.channels[i % channels].id, place(&case.table.grid, i / channels))
        });
    }
    watch.outcome("no texel")
}
