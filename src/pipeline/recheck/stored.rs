//! The table that a file says it is, with the numbers that it holds, and how far these may be off.

use crate::cancel::Cancel;
use crate::encode::read::{Image, Plane, Sample};
use crate::grid::provenance::AxisRecord;
use crate::grid::{Provenance, Table};
use crate::tables::driver::bake_again;
use crate::tables::place;
use crate::tables::spec::{Bound, Request, Spec};
use crate::verify::Watch;
use crate::verify::honest::Looked;
use rayon::prelude::*;

/// Estimates that a number may be off; as in the law `honest`.
const ESTIMATES: f64 = 3.0;

/// A file as a table.
#[derive(Debug)]
pub(super) struct Stored {
    pub(super) bound: Bound,
    /// The stored numbers; the errors are the largest estimate that the file states.
    pub(super) table: Table,
    /// What rounding, and fitting to a reader, may have moved each number by.
    pub(super) slack: Vec<f64>,
    pub(super) tolerance: f64,
    /// Are the texels fitted to their reader?
    pub(super) fitted: bool,
}

/// Numbers as they would be if a suspicion were true.
#[derive(Debug)]
pub(super) struct Numbers {
    pub(super) table: Table,
    pub(super) slack: Vec<f64>,
}

impl Stored {
    /// Binds what the file says, and takes its numbers.
    pub(super) fn new(image: &Image, p: &Provenance) -> Result<Stored, String> {
        let bound = Request::recorded(p)
            .bind()
            .map_err(|e| format!("what it says of itself cannot be baked: {e}"))?;
        let missing = |id: &str| format!("channel `{id}` is not in the picture");
        let planes: Vec<&Plane> = p
            .channels
            .iter()
            .map(|c| image.channel(&c.id).ok_or_else(|| missing(&c.id)))
            .collect::<Result<_, _>>()?;
        let len = bound.spec.grid.len();
        let n = planes.len();
        if let Some(plane) = planes.iter().find(|p| p.values.len() != len) {
            return Err(format!(
                "channel `{}` has {} texels, the axes tell of {len}",
                plane.name,
                plane.values.len()
            ));
        }
        let values: Vec<f64> = (0..len * n).map(|i| planes[i % n].values[i / n]).collect();
        let fitted = p.texels.as_ref().filter(|t| t.held != "exact");
        let moved = fitted.map_or(0.0, |t| t.largest_change);
        let most = p.encoding.as_ref().map_or(f64::INFINITY, |e| e.largest_error);
        let mut slack = vec![0.0; len * n];
        for (texel, slots) in slack.chunks_exact_mut(n).enumerate() {
            let largest = planes.iter().map(|p| p.values[texel].abs()).fold(0.0, f64::max);
            for (slot, plane) in slots.iter_mut().zip(&planes) {
                let half_step = half_step(plane, texel, largest);
                // the stated error is that of the integrals, or of what was fitted to them
                *slot = if fitted.is_some() { half_step.min(most) + moved } else { half_step.min(most) };
            }
        }
        let estimate = p.integration.largest_error.value;
        let table = Table {
            grid: bound.spec.grid.clone(),
            channels: bound.spec.channels(),
            values,
            errors: vec![estimate; len * n],
            evaluations: vec![0; len],
        };
        Ok(Stored { bound, table, slack, tolerance: p.integration.tolerance, fitted: fitted.is_some() })
    }

    /// What the file says that is not so whatever its numbers are. Texts of another version are not compared.
    pub(super) fn lies(&self, p: &Provenance) -> Vec<String> {
        let mut lies = Vec::new();
        if p.tool != super::super::manifest::tool() {
            return lies;
        }
        // the bound axes: a model may measure by a name that means something else elsewhere
        for (told, own) in p.axes.iter().zip(self.bound.spec.grid.axes()) {
            let own = AxisRecord::new(own);
            let id = told.axis.quantity.id;
            if own.coordinate != told.coordinate {
                lies.push(format!(
                    "axis {id}: it says coordinate = {}, its fields give {}",
                    told.coordinate, own.coordinate
                ));
            }
            if (&own.symbol, &own.unit, &own.base) != (&told.symbol, &told.unit, &told.base) {
                lies.push(format!("axis {id}: its symbol, unit or base are not those of the quantity"));
            }
        }
        for (told, own) in
            p.channels.iter().zip(self.bound.spec.channels()).filter(|(told, own)| *told != own)
        {
            lies.push(format!("channel {}: it says `{}`, this is `{}`", told.id, told.meaning, own.meaning));
        }
        if p.table.formula != self.bound.spec.kind.formula {
            lies.push(format!(
                "it says formula {}, that of {} is {}",
                p.table.formula, p.table.id, self.bound.spec.kind.formula
            ));
        }
        lies
    }

    /// The same table with its numbers in other places: `from` gives texel and channel that each is taken from.
    pub(super) fn moved(&self, from: impl Fn(usize, usize) -> (usize, usize)) -> Numbers {
        let n = self.table.channels.len();
        let moved = |all: &[f64]| -> Vec<f64> {
            let source = |i: usize| from(i / n, i % n);
            (0..all.len()).map(source).map(|(texel, channel)| all[texel * n + channel]).collect()
        };
        Numbers {
            table: Table { values: moved(&self.table.values), ..self.table.clone() },
            slack: moved(&self.slack),
        }
    }

    /// The same numbers under other labels; nothing where they do not fit.
    pub(super) fn labelled(&self, spec: &Spec) -> Option<Numbers> {
        let fits = spec.grid.len() == self.table.grid.len()
            && spec.layout.channels.len() == self.table.channels.len();
        fits.then(|| Numbers {
            table: Table { grid: spec.grid.clone(), channels: spec.channels(), ..self.table.clone() },
            slack: self.slack.clone(),
        })
    }

    /// Texels by the baker's own rule.
    pub(super) fn again(&self, texels: &[usize], cancel: &Cancel) -> Vec<Looked> {
        let n = self.table.channels.len();
        let one = |texel: &usize| {
            let mut watch = Watch::default();
            let at = || place(&self.table.grid, *texel);
            let made =
                cancel.check().ok().and_then(|()| bake_again(&self.bound, *texel, self.tolerance).ok());
            let judged = made.is_some();
            match made {
                None => watch.miss(|| format!("no value at {}", at())),
                Some(made) => (0..n).for_each(|c| {
                    let i = texel * n + c;
                    let off = (self.table.values[i] - made.value[c]).abs();
                    let allowed = ESTIMATES * self.table.errors[i] + made.error[c] + self.slack[i];
                    let id = &self.table.channels[c].id;
                    watch.see(allowed - off, || {
                        format!("{id} = {:e} against {:e}, {}", self.table.values[i], made.value[c], at())
                    });
                }),
            }
            Looked { watch, judged }
        };
        texels.par_iter().map(one).collect()
    }
}

/// Half the distance of neighbouring numbers; where they share an exponent, that of the largest of the texel.
fn half_step(plane: &Plane, texel: usize, largest: f64) -> f64 {
    match plane.sample {
        // of these only the stated error is known
        Sample::Rgbd | Sample::Bc4 | Sample::Bc5 | Sample::Bc6h | Sample::Bc6hSigned => f64::INFINITY,
        Sample::Rgb9e5 | Sample::Rgbe => 0.5 * plane.sample.ulp(largest, plane.range),
        sample => 0.5 * sample.ulp(plane.values[texel], plane.range),
    }
}
