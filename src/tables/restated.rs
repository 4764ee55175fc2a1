//! Requests told back: from a table that is resolved, and from what a file says of itself.

use super::spec::{Request, Spec};
use crate::grid::Provenance;

impl Spec {
    /// The request that it is the resolved form of. Parameters are those of the model, then of the kind, without those that an axis sweeps.
    #[must_use]
    pub fn request(&self) -> Request {
        let ids = || self.layout.ids().map(str::to_owned).collect();
        let swept = self.swept();
        let model = self.model.iter().map(|(_, params)| params);
        Request {
            kind: self.kind.id.to_owned(),
            layout: (!self.layout.is_custom()).then(|| self.layout.id.to_owned()),
            channels: self.layout.is_custom().then(ids),
            model: self.model.as_ref().map(|(info, _)| info.id.to_owned()),
            params: model.chain([&self.params]).flat_map(|params| params.to_json(&swept)).collect(),
            axes: Some(self.grid.axes().to_vec()),
        }
    }
}

impl Request {
    /// What a file of a table says that it was asked for, by its channels.
    #[must_use]
    pub fn recorded(p: &Provenance) -> Request {
        let mut params = p.table.params.clone();
        params.extend(p.model.iter().flat_map(|m| m.params.clone()));
        Request {
            kind: p.table.id.clone(),
            layout: None,
            channels: Some(p.channels.iter().map(|c| c.id.clone()).collect()),
            model: p.model.as_ref().map(|m| m.id.clone()),
            params,
            axes: Some(p.axes.iter().map(|r| r.axis.clone()).collect()),
        }
    }
}
