//! The axes of a table over the ranges that a scene needs: those of its kind, trimmed, with the density that they have there.

use super::{Asked, Note};
use crate::grid::axis::count;
use crate::grid::quantity::Quantity;
use crate::grid::{Axis, Texel};
use crate::plan::request::TableRequest;
use crate::scene::{Need, Range};
use crate::tables::default_axes::uncouple;
use crate::tables::spec::Request;
use serde_json::json;

/// A table that is being asked for.
#[derive(Debug, Clone)]
pub(super) struct Draft {
    request: TableRequest,
    over: Vec<(&'static str, Range)>,
    even: Vec<(&'static str, usize)>,
    /// Axes of the kind that are left away.
    without: Vec<&'static str>,
    /// Most texels of an axis.
    longest: Vec<(&'static str, usize)>,
    notes: Vec<Note>,
}

impl Draft {
    /// A table of a kind, with a name.
    pub(super) fn new(name: &str, kind: &str) -> Draft {
        let request = Request { kind: kind.to_owned(), ..Request::default() };
        Draft {
            request: TableRequest::new(name, request),
            over: Vec::new(),
            even: Vec::new(),
            without: Vec::new(),
            longest: Vec::new(),
            notes: Vec::new(),
        }
    }

    pub(super) fn layout(mut self, id: &str) -> Draft {
        self.request.request.layout = Some(id.to_owned());
        self
    }

    pub(super) fn channels(mut self, ids: &[&str]) -> Draft {
        self.request.request.channels = Some(ids.iter().map(|id| (*id).to_owned()).collect());
        self
    }

    pub(super) fn model(mut self, id: &str) -> Draft {
        self.request.request.model = Some(id.to_owned());
        self
    }

    pub(super) fn tolerance(mut self, tolerance: f64) -> Draft {
        self.request.tolerance = Some(tolerance);
        self
    }

    pub(super) fn param(mut self, id: &str, value: impl Into<serde_json::Value>) -> Draft {
        self.request.request.params.insert(id.to_owned(), value.into());
        self
    }

    /// Over the range of a need, if it has one of this quantity.
    pub(super) fn over(mut self, need: &Need, id: &'static str) -> Draft {
        if let Some(range) = need.ranges.get(id) {
            self.over.push((id, range.clone()));
        }
        self
    }

    /// Over a range.
    pub(super) fn along(mut self, id: &'static str, range: Range) -> Draft {
        self.over.push((id, range));
        self
    }

    /// An axis that the kind does not have by itself, with so many texels, evenly spread.
    pub(super) fn even(mut self, id: &'static str, texels: usize) -> Draft {
        self.even.push((id, texels));
        self
    }

    /// Without an axis of the kind, by its base quantity: others take its place.
    pub(super) fn without(mut self, base: &'static str) -> Draft {
        self.without.push(base);
        self
    }

    /// With no more than so many texels along an axis: tables of many axes are large, and their integrals take long.
    pub(super) fn longest(mut self, id: &'static str, texels: usize) -> Draft {
        self.longest.push((id, texels));
        self
    }

    /// A range is cut to what the model is good for: its lookups clamp, the plan says so, and the picture is another one.
    pub(super) fn within(self, id: &'static str, allowed: [f64; 2], why: &'static str) -> Draft {
        self.cut(id, allowed, why, true)
    }

    /// A range is cut where nobody sees it: its lookups clamp, and the plan says so.
    pub(super) fn near(self, id: &'static str, allowed: [f64; 2], why: &'static str) -> Draft {
        self.cut(id, allowed, why, false)
    }

    fn cut(mut self, id: &'static str, allowed: [f64; 2], why: &'static str, seen: bool) -> Draft {
        for (quantity, range) in &mut self.over {
            if *quantity != id || (range.lo >= allowed[0] && range.hi <= allowed[1]) {
                continue;
            }
            let asked = [range.lo, range.hi];
            let covered = asked.map(|v| v.clamp(allowed[0], allowed[1]));
            *range =
                Range { lo: covered[0], hi: covered[1], values: range.value().map(|_| vec![covered[0]]) };
            self.notes.push(Note { quantity: id, asked, covered, why, seen });
        }
        self
    }

    /// The request: a default that no range touches stays as it is.
    pub(super) fn finish(mut self, family: &'static str) -> Asked {
        if let Ok(bound) = self.request.request.bind() {
            let mut axes = bound.spec.grid.axes().to_vec();
            axes.retain(|a| !self.without.contains(&a.quantity.base_id()));
            let mut fixed = Vec::new();
            for (id, range) in &self.over {
                let Some(quantity) = Quantity::find(id) else { continue };
                let base = quantity.base_id();
                let place = axes.iter().position(|a| a.quantity.base_id() == base);
                match (place, range.value()) {
                    (_, Some(value)) => {
                        axes.retain(|a| a.quantity.base_id() != base);
                        fixed.push((base, quantity.to_base(value)));
                    }
                    (Some(place), None) => axes[place] = trimmed(&axes[place], quantity, range),
                    (None, None) => {
                        let len = self.even.iter().find(|(e, _)| e == id).map_or(2, |(_, n)| *n);
                        axes.push(Axis::new(quantity, len, Texel::Endpoint).over([range.lo, range.hi]));
                    }
                }
            }
            for (id, len) in &self.even {
                let missing =
                    !axes.iter().any(|a| a.quantity.id == *id) && !fixed.iter().any(|(f, _)| f == id);
                if let Some(quantity) = Quantity::find(id).filter(|_| missing) {
                    axes.push(Axis::new(quantity, *len, Texel::Endpoint));
                }
            }
            for axis in &mut axes {
                let most = self.longest.iter().find(|(id, _)| *id == axis.quantity.id);
                axis.len = most.map_or(axis.len, |(_, most)| axis.len.min(*most));
            }
            uncouple(&mut axes);
            self.request.request.axes = Some(axes);
            for (id, value) in fixed {
                self.request.request.params.insert(id.to_owned(), json!(value));
            }
        }
        Asked { request: self.request, family, notes: self.notes }
    }
}

/// An axis of a kind over a part of its domain, with no fewer texels a step than it has there.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 1 to the length of an axis")]
fn trimmed(axis: &Axis, quantity: &'static Quantity, range: &Range) -> Axis {
    let base = [range.lo, range.hi].map(|v| quantity.to_base(v));
    let domain = axis.quantity.interval_from_base(base);
    let [from, to] = domain.map(|v| axis.coordinate_of(v.clamp(axis.domain[0], axis.domain[1]), 0.0));
    let steps = (to - from).abs() * count(axis.len - 1);
    // a step more than the share of the domain, so that no step is longer than it was
    let len = (steps.ceil().max(1.0) as usize + 1).clamp(2, axis.len);
    let mut out = axis.clone();
    out.len = if (domain[1] - domain[0]) >= (axis.domain[1] - axis.domain[0]) { axis.len } else { len };
    out.domain = domain;
    out.clamp = None;
    out
}
