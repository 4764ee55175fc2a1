//! Kinds of tables on the ends of their axes, and the maps of their axes in 32 bits.

use super::{Stress, Worst};
use crate::cancel::{Cancel, Cancelled};
use crate::grid::{Axis, Texel};
use crate::tables::driver::{self, BakeError, OnMiss, Options};
use crate::tables::spec::Request;
use crate::tables::{ModelUse, TableInfo, TexelError};
use crate::verify::{self, Case, Outcome};

/// Texels of an axis: both ends and the middle.
const LEN: usize = 3;
/// Tolerance of the texels.
const TOLERANCE: f64 = 1e-5;
/// Values of each axis whose place is found in 32 bits.
const PLACES: usize = 257;

pub(super) fn stress(kind: &'static TableInfo, cancel: &Cancel) -> Result<Stress, Cancelled> {
    let mut found = Stress::new("table", kind.id);
    for layout in kind.layouts {
        cancel.check()?;
        let request = Request {
            kind: kind.id.to_owned(),
            layout: Some(layout.id.to_owned()),
            // light that crosses a surface wants a model that lets it
            model: crosses(kind, layout).then(|| "ggx-glass".to_owned()),
            ..Request::default()
        };
        let at = || format!("layout {}", layout.id);
        let bound = match request.bind() {
            Ok(bound) => bound,
            Err(e) => {
                found.blame("not bound", e.to_string(), at);
                continue;
            }
        };
        for axis in bound.spec.grid.axes() {
            single(axis, &mut found);
        }
        let ends = |a: &Axis| Axis { len: LEN, texel: Texel::Endpoint, ..a.clone() };
        let axes = bound.spec.grid.axes().iter().map(ends).collect();
        if let Ok(bound) = (Request { axes: Some(axes), ..request }).bind() {
            bake(&bound, layout.id, cancel, &mut found)?;
        }
    }
    Ok(found)
}

fn crosses(kind: &TableInfo, layout: &crate::tables::Layout) -> bool {
    matches!(kind.model, ModelUse::Any("ggx"))
        && layout.channels.iter().any(|c| c.id.starts_with('t') || c.id.ends_with(".inside"))
}

fn bake(
    bound: &crate::tables::Bound,
    layout: &str,
    cancel: &Cancel,
    found: &mut Stress,
) -> Result<(), Cancelled> {
    let options = Options { tolerance: TOLERANCE, on_miss: OnMiss::Report, cancel, progress: &|_| {} };
    let table = match driver::bake(bound, options) {
        Ok(table) => table,
        Err(BakeError::Cancelled(stopped)) => return Err(stopped),
        Err(BakeError::Texel { error: TexelError::NoWidth | TexelError::NoRule { .. }, .. }) => {
            found.refused += 1;
            return Ok(());
        }
        Err(e) => {
            found.blame("no value", e.to_string(), || format!("layout {layout}"));
            return Ok(());
        }
    };
    found.points += table.grid.len() as u64;
    let most = table.evaluations.iter().enumerate().max_by_key(|(_, n)| **n);
    if let Some((texel, n)) = most {
        found.evaluated(*n, || format!("layout {layout}, {}", crate::tables::place(&table.grid, texel)));
    }
    let case = Case { bound, table: &table, tolerance: TOLERANCE, cancel };
    for law in verify::declared(&bound.spec) {
        if let Outcome::Broken(seen) = (law.check)(&case) {
            cancel.check()?;
            let message = format!("{}: margin {:.1e}", law.id, seen.margin);
            found.blame("law broken", message, || format!("layout {layout}, {}", seen.at));
        }
    }
    Ok(())
}

/// How far off a shader finds a place that it computes in 32 bits, in texels.
fn single(axis: &Axis, found: &mut Stress) {
    if axis.warp.couples_to().is_some() {
        return;
    }
    let [lo, hi] = axis.domain;
    for i in 0..PLACES {
        let x = i as f64 / (PLACES - 1) as f64;
        // as a shader has the value: rounded to 32 bits
        #[allow(clippy::cast_possible_truncation, reason = "what is looked at")]
        let value = axis.value_at(x, 0.0).clamp(lo, hi) as f32;
        let exact = axis.index(f64::from(value), 0.0);
        let got = axis.index_at(axis.coordinate_of(value, 0.0_f32));
        let off = (f64::from(got) - exact).abs();
        let place = || format!("{} = {value:e}", axis.quantity.id);
        found.points += 1;
        if !got.is_finite() {
            found.blame("not finite", format!("texel {got} in 32 bits"), place);
        } else if found.single.as_ref().is_none_or(|w| off > w.value) {
            found.single = Some(Worst { value: off, at: place() });
        }
    }
}
