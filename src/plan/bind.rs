//! Binding a request, with all its faults and not only the first: each fault is reported at its key, the request is
//! repaired there, and bound again.

use super::fault::Fault;
use super::faults::Faults;
use super::place::Path;
use super::request::Draft;
use crate::grid::{Axis, AxisError, GridError, Warp};
use crate::math::figures::exact as number;
use crate::models::{self, ModelInfo, Param, ParamError};
use crate::tables::spec::Request;
use crate::tables::{self, BindError, Bound, ModelUse, Selection, Setting, TableInfo};
use serde_json::Map;

/// More repairs than a table of four axes can need; a limit that stops any loop.
const REPAIRS: usize = 256;

struct Binder<'a> {
    asked: &'a Request,
    path: &'a Path,
    /// The request as it is repaired.
    request: Request,
    /// For each axis of that, its number as it was asked for.
    numbers: Vec<usize>,
    /// Canonical parameter id and the key that was given.
    keys: Vec<(String, String)>,
}

/// Binds a table. None if it has a fault.
pub(super) fn bind(draft: &Draft, path: &Path, faults: &mut Faults) -> Option<Bound> {
    let before = faults.len();
    let asked = &draft.request.request;
    let kind = if draft.holes.kind { None } else { tables::find(&asked.kind) };
    let readable = !draft.holes.axes;
    if kind.is_none() || !readable {
        check_axes_alone(asked, path, faults);
    }
    if draft.holes.kind {
        return None;
    }
    let mut binder = Binder::new(asked, path, kind, faults);
    if !readable {
        // the kind's own axes stand in, so that layout, model and parameters are checked
        binder.request.axes = None;
    }
    let bound = binder.run(readable, faults)?;
    check_swept(&bound, path, faults);
    check_split(&bound, path, &binder.keys, faults);
    (readable && faults.len() == before).then_some(bound)
}

impl<'a> Binder<'a> {
    fn new(
        asked: &'a Request,
        path: &'a Path,
        kind: Option<&'static TableInfo>,
        faults: &mut Faults,
    ) -> Binder<'a> {
        let mut request = Request { params: Map::new(), axes: None, ..asked.clone() };
        let declared: Vec<&Param> = kind.map(|k| declared(k, asked)).unwrap_or_default();
        let mut keys: Vec<(String, String)> = Vec::new();
        for (key, value) in &asked.params {
            let id = declared.iter().find(|p| p.is_called(key));
            let id = id.map_or_else(|| key.clone(), |p| p.id.to_owned());
            if let Some((_, other)) = keys.iter().find(|(k, _)| *k == id) {
                let why = format!("`{other}` and `{key}` are the same");
                let fault = Fault::Twice { what: "parameter", got: id.clone(), why };
                faults.key(path.key("params").key(key), fault);
            }
            request.params.insert(id.clone(), value.clone());
            keys.push((id, key.clone()));
        }
        let numbers = (0..asked.axes.as_ref().map_or(0, Vec::len)).collect();
        request.axes = asked.axes.as_ref().map(|axes| axes.iter().cloned().map(canonical).collect());
        Binder { asked, path, request, numbers, keys }
    }

    /// Binds, reporting and repairing faults on the way. `axes`: are they those that were asked for?
    fn run(&mut self, axes: bool, faults: &mut Faults) -> Option<Bound> {
        for _ in 0..REPAIRS {
            let error = match self.request.bind() {
                Ok(bound) => return Some(bound),
                Err(error) => error,
            };
            let about_axes = matches!(
                error,
                BindError::Grid(_)
                    | BindError::MissingAxis { .. }
                    | BindError::IdleAxis { .. }
                    | BindError::OneParam { .. }
                    | BindError::Both { .. }
            );
            if about_axes && !axes {
                return None;
            }
            self.report(&error, faults);
            if !self.repair(&error) {
                if axes && matches!(error, BindError::Unknown { what: "model", .. } | BindError::Model { .. })
                {
                    // the axes are not looked at before there is a model
                    check_axes_alone(self.asked, self.path, faults);
                }
                return None;
            }
        }
        None
    }

    fn report(&self, error: &BindError, faults: &mut Faults) {
        let at = |key: &str| self.path.key(key);
        let fault = Fault::Bind(error.clone());
        match error {
            BindError::Unknown { what: "table", .. } => faults.value(at("kind"), fault),
            BindError::Unknown { what: "channel", got, .. } => faults.value(self.channel_path(got, 0), fault),
            BindError::Unknown { what, .. } => faults.value(at(what), fault),
            BindError::ChannelTwice { got } => faults.value(self.channel_path(got, 1), fault),
            BindError::ChannelCount { .. } => faults.value(at("channels"), fault),
            BindError::LayoutAndChannels { .. } | BindError::NoMix { .. } => {
                faults.key(at("channels"), fault)
            }
            BindError::Foreign { .. } => faults.value(at("layout"), fault),
            BindError::Model { .. } => faults.value(at("model"), fault),
            BindError::Param(e) => match e.key().map(|k| self.param(k)) {
                Some(path) if matches!(e, ParamError::Unknown { .. }) => faults.key(path, fault),
                Some(path) => faults.value(path, fault),
                None => faults.value(at("params"), fault),
            },
            BindError::Grid(e) => faults.value(self.grid_path(e), fault),
            BindError::MissingAxis { .. } => faults.value(at("axis"), fault),
            BindError::IdleAxis { axis, .. } | BindError::OneParam { axes: [_, axis], .. } => {
                faults.value(self.axis_path(axis, "id"), fault);
            }
            BindError::Both { key, .. } => faults.key(self.param(key), fault),
        }
    }

    /// Path of a parameter under the key that was given for it.
    fn param(&self, id: &str) -> Path {
        let key = self.keys.iter().find(|(k, _)| k == id).map_or(id, |(_, key)| key);
        self.path.key("params").key(key)
    }

    /// Path of the first, second, ... entry of a channel.
    fn channel_path(&self, id: &str, occurrence: usize) -> Path {
        let listed = self.asked.channels.iter().flatten().enumerate();
        let path = self.path.key("channels");
        match listed.filter(|(_, c)| *c == id).nth(occurrence) {
            Some((i, _)) => path.index(i),
            None => path,
        }
    }

    fn grid_path(&self, error: &GridError) -> Path {
        match error {
            GridError::Axis(e) => self.axis_path(axis_id(e), axis_key(e)),
            GridError::Twice(base) => {
                let mut same = self.axes().iter().enumerate().filter(|(_, a)| a.quantity.base_id() == *base);
                self.axis_number_path(same.nth(1).map(|(i, _)| i), "id")
            }
            GridError::Coupling { id, .. } | GridError::Chain(id) => self.axis_path(id, "warp"),
            GridError::Count(_) => self.path.key("axis"),
            GridError::Size(_) => {
                let longest = self.axes().iter().enumerate().max_by_key(|(_, a)| a.len).map(|(i, _)| i);
                self.axis_number_path(longest, "length")
            }
        }
    }

    fn axes(&self) -> &[Axis] {
        self.request.axes.as_deref().unwrap_or_default()
    }

    fn find(&self, id: &str) -> Option<usize> {
        self.axes().iter().position(|a| a.quantity.id == id)
    }

    fn axis_path(&self, id: &str, key: &str) -> Path {
        self.axis_number_path(self.find(id), key)
    }

    fn axis_number_path(&self, i: Option<usize>, key: &str) -> Path {
        let path = self.path.key("axis");
        match i.and_then(|i| self.numbers.get(i)) {
            Some(n) => path.index(*n).key(key),
            None => path,
        }
    }

    /// Takes the fault out of the request. False if nothing is left to check.
    fn repair(&mut self, error: &BindError) -> bool {
        match error {
            BindError::Unknown { what: "layout", .. } => self.request.layout.take().is_some(),
            BindError::Unknown { what: "channel", got, .. } => {
                self.repair_channels(|all| all.retain(|c| c != got))
            }
            BindError::ChannelTwice { got } => self.repair_channels(|all| {
                let first = all.iter().position(|c| c == got);
                let mut i = 0;
                all.retain(|c| {
                    i += 1;
                    c != got || Some(i - 1) == first
                });
            }),
            BindError::ChannelCount { max, .. } => self.repair_channels(|all| all.truncate(*max)),
            BindError::LayoutAndChannels { .. } | BindError::NoMix { .. } => {
                self.request.channels.take().is_some()
            }
            BindError::Param(e) => e.key().is_some_and(|key| self.request.params.remove(key).is_some()),
            BindError::Both { key, .. } => self.request.params.remove(key).is_some(),
            BindError::IdleAxis { axis, .. } | BindError::OneParam { axes: [_, axis], .. } => {
                self.find(axis).is_some_and(|i| self.remove_axis(i))
            }
            BindError::MissingAxis { needed, .. } => self.add_axis(needed),
            BindError::Grid(e) => self.repair_grid(e),
            BindError::Unknown { .. } | BindError::Model { .. } | BindError::Foreign { .. } => false,
        }
    }

    /// Changes the list of channels; the default layout stands in for an empty one.
    fn repair_channels(&mut self, change: impl FnOnce(&mut Vec<String>)) -> bool {
        let Some(mut all) = self.request.channels.take() else { return false };
        change(&mut all);
        self.request.channels = Some(all).filter(|all| !all.is_empty());
        true
    }

    fn repair_grid(&mut self, error: &GridError) -> bool {
        match error {
            GridError::Axis(e) => {
                let i = self.find(axis_id(e));
                let axis = i.and_then(|i| self.request.axes.as_mut()?.get_mut(i));
                axis.is_some_and(|axis| repair_axis(axis, e))
            }
            GridError::Twice(base) => {
                let i = self.axes().iter().rposition(|a| a.quantity.base_id() == *base);
                i.is_some_and(|i| self.remove_axis(i))
            }
            GridError::Coupling { id, .. } | GridError::Chain(id) => {
                let i = self.find(id);
                let axis = i.and_then(|i| self.request.axes.as_mut()?.get_mut(i));
                axis.is_some_and(|axis| {
                    axis.warp = Warp::Linear;
                    true
                })
            }
            GridError::Count(_) | GridError::Size(_) => false,
        }
    }

    fn remove_axis(&mut self, i: usize) -> bool {
        let Some(axes) = self.request.axes.as_mut().filter(|axes| i < axes.len()) else { return false };
        axes.remove(i);
        self.numbers.remove(i);
        true
    }

    /// The kind's own axis for a coordinate stands in.
    fn add_axis(&mut self, base: &str) -> bool {
        let own = tables::find(&self.request.kind).and_then(|kind| {
            let layout = Selection::from(kind.layouts.first()?);
            let axes = kind.default_axes(Setting {
                layout: &layout,
                model: None,
                given: Some(&self.request.params),
            });
            axes.into_iter().find(|a| a.quantity.base_id() == base)
        });
        match (self.request.axes.as_mut(), own) {
            (Some(axes), Some(mut axis)) => {
                axis.warp = Warp::Linear;
                axes.push(axis);
                self.numbers.push(usize::MAX);
                true
            }
            _ => false,
        }
    }
}

/// Parameters of the kind and of the model that the request names or the kind takes by itself.
fn declared(kind: &'static TableInfo, asked: &Request) -> Vec<&'static Param> {
    let model: Option<&'static ModelInfo> = match kind.model {
        ModelUse::None => None,
        ModelUse::Any(own) | ModelUse::Split(own) => {
            models::find(asked.model.as_deref().unwrap_or(own)).map(|(info, _)| info)
        }
    };
    kind.params.iter().chain(model.iter().flat_map(|m| m.params)).collect()
}

fn axis_id(error: &AxisError) -> &'static str {
    match error {
        AxisError::Domain { id, .. }
        | AxisError::Length { id, .. }
        | AxisError::Warp { id, .. }
        | AxisError::Clamp { id, .. }
        | AxisError::Offset { id, .. } => id,
    }
}

fn axis_key(error: &AxisError) -> &'static str {
    match error {
        AxisError::Domain { .. } => "domain",
        AxisError::Length { .. } => "length",
        AxisError::Warp { .. } => "warp",
        AxisError::Clamp { .. } => "clamp",
        AxisError::Offset { .. } => "offset",
    }
}

/// Puts a good value in the place of the one at fault.
fn repair_axis(axis: &mut Axis, error: &AxisError) -> bool {
    match error {
        AxisError::Domain { .. } => axis.domain = axis.quantity.domain,
        AxisError::Length { .. } => axis.len = 2,
        AxisError::Warp { .. } => axis.warp = Warp::Linear,
        AxisError::Clamp { .. } => axis.clamp = None,
        AxisError::Offset { .. } => axis.offset = 0.0,
    }
    true
}

/// Checks each axis that could be read, where the table as a whole cannot be bound.
fn check_axes_alone(asked: &Request, path: &Path, faults: &mut Faults) {
    for (i, axis) in asked.axes.iter().flatten().enumerate() {
        let mut axis = axis.clone();
        while let Err(error) = axis.check() {
            let path = path.key("axis").index(i).key(axis_key(&error));
            repair_axis(&mut axis, &error);
            faults.value(path, Fault::Bind(BindError::Grid(GridError::Axis(error))));
        }
    }
}

/// The axis in its one canonical form: equal maps are equal values.
fn canonical(mut axis: Axis) -> Axis {
    let is = |a: f64, b: f64| (a - b).abs() == 0.0;
    if let Warp::Power(p) | Warp::OneMinusPower(p) = axis.warp
        && is(p, 1.0)
    {
        axis.warp = Warp::Linear;
    }
    if axis.clamp.is_some_and(|[a, b]| is(a, axis.domain[0]) && is(b, axis.domain[1])) {
        axis.clamp = None;
    }
    // -0 and 0 are the same place
    axis.offset += 0.0;
    axis.domain = axis.domain.map(|v| v + 0.0);
    axis.clamp = axis.clamp.map(|c| c.map(|v| v + 0.0));
    axis
}

/// Part of a value by which a map and its inverse may miss.
const ROUNDING: f64 = 1e-12;

/// An axis that sweeps a parameter must stay in the range of the parameter. All is said in the quantity of the axis.
fn check_swept(bound: &Bound, path: &Path, faults: &mut Faults) {
    let spec = &bound.spec;
    let model = spec.model.as_ref().map(|(info, _)| (info.id, info.params));
    for (i, axis) in spec.grid.axes().iter().enumerate() {
        let quantity = axis.quantity;
        for (owner, params) in model.into_iter().chain([(spec.kind.id, spec.kind.params)]) {
            let Some(param) = params.iter().find(|p| p.is_measured_by(quantity.base_id())) else { continue };
            let Some([min, max]) = param.range() else { continue };
            let got = axis.clamp.unwrap_or(axis.domain);
            let ends = got.map(|v| quantity.to_base(v));
            let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
            if low < min - ROUNDING * min.abs() || high > max + ROUNDING * max.abs() {
                let [lo, hi] = quantity.domain;
                let [least, most] = quantity.interval_from_base([min, max]);
                let map = quantity.base_formula().map(|formula| {
                    format!("{formula}, its {} from {} to {}", param.id, number(min), number(max))
                });
                let allowed = [least.max(lo), most.min(hi)];
                let fault = Fault::SweptRange { axis: quantity.id, got, owner, allowed, map };
                let key = if axis.clamp.is_some() { "clamp" } else { "domain" };
                faults.value(path.key("axis").index(i).key(key), fault);
            }
        }
    }
}

/// A table that splits the Fresnel factor off sets it to 1: another value would be ignored in silence.
fn check_split(bound: &Bound, path: &Path, keys: &[(String, String)], faults: &mut Faults) {
    let kind = bound.spec.kind;
    let (ModelUse::Split(_), Some((_, params))) = (kind.model, &bound.spec.model) else { return };
    for (id, key) in keys {
        let Some(id) = ["f0", "f90"].into_iter().find(|f| f == id) else { continue };
        let Ok(got) = params.number(id) else { continue };
        if (got - 1.0).abs() > 0.0 {
            let path = path.key("params").key(key);
            faults.value(path, Fault::SplitFresnel { kind: kind.id, key: id, got });
        }
    }
}
