//! Every value lies in the range that its channel declares (what a fixed-point format can store).

use super::{Case, Law, Outcome, Watch};
use crate::tables::place;

/// The law.
pub static LAW: Law = Law {
    id: "range",
    statement: "every value lies in the declared range of its channel, within its error",
    margin: "distance to the nearer end of the range plus the error estimate",
    code: 4002,
    formal: true,
    concerns: |_| true,
    check,
};

fn check(case: &Case<'_>) -> Outcome {
    let mut watch = Watch::default();
    let channels = case.table.channels.len();
    for (i, (&v, &e)) in case.table.values.iter().zip(&case.table.errors).enumerate() {
        let channel = &case.table.channels[i % channels];
        let margin = (v - channel.range[0]).min(channel.range[1] - v) + e;
        watch.see(margin, || format!("{}, {}", channel.id, place(&case.table.grid, i / channels)));
    }
    watch.outcome("no texel")
}
