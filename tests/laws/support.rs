//! Tables of every kind, layout and free channel, small.

use brdfbake::cancel::Cancel;
use brdfbake::grid::{Axis, Table};
use brdfbake::tables::driver::{self, OnMiss, Options};
use brdfbake::tables::spec::{Bound, Request};
use brdfbake::tables::{Mix, ModelUse, TABLES, TableInfo};

/// A layout, or one of the channels that stand alone.
#[derive(Debug, Clone)]
pub(crate) struct Pair {
    pub(crate) kind: &'static TableInfo,
    pub(crate) layout: Option<&'static str>,
    pub(crate) channel: Option<&'static str>,
}

impl Pair {
    pub(crate) fn name(&self) -> String {
        format!("{} {}", self.kind.id, self.layout.or(self.channel).unwrap_or_default())
    }

    /// Bound on the default axes, each no longer than `longest`.
    pub(crate) fn bind(&self, longest: usize) -> Bound {
        self.bind_to(|a| Axis { len: a.len.min(longest), ..a })
    }

    /// Bound on what `change` makes of the default axes.
    pub(crate) fn bind_to(&self, change: impl Fn(Axis) -> Axis) -> Bound {
        // a light that crosses wants a model that lets it
        let channels =
            self.kind.layouts.iter().filter(|l| Some(l.id) == self.layout).flat_map(|l| l.channels);
        let ids: Vec<&str> = channels.map(|c| c.id).chain(self.channel).collect();
        let crosses = |id: &&str| id.starts_with('t') || id.ends_with(".inside");
        let glass = matches!(self.kind.model, ModelUse::Any("ggx")) && ids.iter().any(crosses);
        let request = Request {
            kind: self.kind.id.to_owned(),
            layout: self.layout.map(str::to_owned),
            channels: self.channel.map(|c| vec![c.to_owned()]),
            model: glass.then(|| "ggx-glass".to_owned()),
            ..Request::default()
        };
        let bind = |request: &Request| request.bind().unwrap_or_else(|e| panic!("{}: {e}", self.name()));
        let axes = bind(&request).spec.grid.axes().iter().cloned().map(change).collect();
        bind(&Request { axes: Some(axes), ..request })
    }
}

/// Every layout, and every channel of a kind whose channels stand together freely.
pub(crate) fn pairs() -> Vec<Pair> {
    let mut all = Vec::new();
    for kind in TABLES.iter().copied() {
        all.extend(kind.layouts.iter().map(|l| Pair { kind, layout: Some(l.id), channel: None }));
        if matches!(kind.mix, Mix::Free(_)) {
            let alone = kind.pool().into_iter().map(|c| Pair { kind, layout: None, channel: Some(c.id) });
            all.extend(alone.filter(|p| {
                kind.layouts.iter().all(|l| l.channels.len() > 1 || l.channels[0].id != p.channel.unwrap())
            }));
        }
    }
    all
}

pub(crate) fn bake(bound: &Bound, tolerance: f64) -> Table {
    let cancel = Cancel::new();
    let options = Options { tolerance, on_miss: OnMiss::Report, cancel: &cancel, progress: &|_| {} };
    driver::bake(bound, options).unwrap()
}
