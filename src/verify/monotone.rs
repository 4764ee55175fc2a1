//! A cumulative distribution, its inverse and a transmittance rise, or fall, from texel to texel.

use super::{Case, Law, Outcome, Watch};
use crate::tables::{Spec, place};

/// The law.
pub static LAW: Law = Law {
    id: "monotone",
    statement: "values rise (cumulative distributions, their inverses, masking) or fall (transmittances) along their axis",
    margin: "smallest step in the right direction plus both error estimates",
    code: 4003,
    formal: false,
    concerns: |spec| promises(spec).next().is_some(),
    check,
};

/// Channels that rise (1) or fall (-1), each with the number of its axis.
fn promises(spec: &Spec) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
    spec.layout.channels.iter().enumerate().filter_map(|(c, channel)| {
        let (along, sign) = channel.role.trend()?;
        Some((c, spec.axis(along)?, sign))
    })
}

fn check(case: &Case<'_>) -> Outcome {
    let grid = &case.table.grid;
    let mut watch = Watch::default();
    for (c, axis, sign) in promises(case.spec()) {
        let stride: usize = grid.axes()[..axis].iter().map(|a| a.len).product();
        let texels = (0..grid.len()).take_while(|_| case.goes_on());
        for texel in texels.filter(|t| grid.unravel(*t)[axis] > 0) {
            let before = texel - stride;
            let forward = grid.texel(texel).values()[axis] - grid.texel(before).values()[axis];
            let ((v, e), (last, last_error)) = (case.at(texel, c), case.at(before, c));
            let step = (v - last) * sign * if forward < 0.0 { -1.0 } else { 1.0 };
            watch.see(step + e + last_error, || {
                format!("{}, {}", case.table.channels[c].id, place(grid, texel))
            });
        }
    }
    watch.outcome("its axis has one texel")
}
