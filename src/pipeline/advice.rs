//! What would mend a table that reads far worse than it is integrated and rounded.

use crate::grid::Axis;
use crate::grid::provenance::{Encoding, Reconstruction};
use crate::plan::PlannedTable;

/// Times the tolerance, or the rounding if that is more, beyond which a reader's error is far above.
const FAR: f64 = 32.0;

/// What to change, the most helpful first; nothing where the reader's error is not far above the tolerance.
pub(super) fn advice(planned: &PlannedTable, encoding: &Encoding, read: &Reconstruction) -> Vec<String> {
    let floor = planned.tolerance.max(encoding.largest_error);
    let times = read.whole.largest.value / floor;
    if times.is_nan() || times <= FAR {
        return Vec::new();
    }
    let spec = &planned.bound.spec;
    let own = spec.kind.default_axes(spec.setting());
    let mut all = Vec::new();
    if !same_maps(&own, spec.grid.axes()) && swept_by(&own, spec.grid.axes()) {
        let axes: Vec<String> = own
            .iter()
            .map(|a| {
                format!(
                    "{} at {} over [{}, {}]",
                    a.quantity.id,
                    a.coordinate_formula(),
                    a.domain[0],
                    a.domain[1]
                )
            })
            .collect();
        all.push(format!(
            "the axes that read best, those of a recipe without [[table.axis]]: {}",
            axes.join(", ")
        ));
    }
    if planned.asked.size.is_none() {
        all.push("`size = \"auto\"` in place of lengths, or with `warps = \"search\"`, finds the texels that it takes".to_owned());
    }
    all
}

/// Do both sets have the same values in the same spread, whatever their lengths?
fn same_maps(a: &[Axis], b: &[Axis]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| Axis { len: b.len, ..a.clone() } == *b)
}

/// Do both sets sweep the same quantities?
fn swept_by(a: &[Axis], b: &[Axis]) -> bool {
    let bases = |axes: &[Axis]| {
        let mut ids: Vec<&str> = axes.iter().map(|a| a.quantity.base_id()).collect();
        ids.sort_unstable();
        ids
    };
    bases(a) == bases(b)
}
