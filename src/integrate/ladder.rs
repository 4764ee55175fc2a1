//! The ladder of a chart: its levels, and where to begin for a tolerance. When to stop is said in [`stop`](super::stop).

use super::chart::Chart;
use super::nodes::Nodes;
use super::stop::{Estimate, Sums, climb_sure};
use super::view::View;

/// Levels of the ladder. Successive ratios of about 1.4 double the cost.
pub const LEVELS: [f64; 10] = [2.0, 2.8, 4.0, 5.6, 8.0, 11.0, 15.0, 20.0, 27.0, 37.0];

/// First level for a tolerance: two levels below the one that is expected to meet it at the median texel.
#[must_use]
pub fn first_level(tolerance: f64) -> usize {
    match tolerance {
        t if t >= 1e-5 => 0,
        t if t >= 1e-7 => 1,
        t if t >= 1e-10 => 2,
        _ => 3,
    }
}

/// Integrates `channels` channels over the hemisphere. `add` adds the contribution of a batch to the sums.
///
/// The result may miss the tolerance: its error then says so, and the caller decides.
pub fn integrate(
    chart: &Chart,
    view: View,
    channels: usize,
    tolerance: f64,
    add: &mut dyn FnMut(&Nodes, &mut Sums),
) -> Estimate {
    climb_sure(chart.trust(), first_level(tolerance)..LEVELS.len(), channels, tolerance, |j, level| {
        chart.visit(view, LEVELS[j], &mut |nodes| {
            level.count(nodes.len);
            add(nodes, level.panel(nodes.panel));
        });
    })
}
