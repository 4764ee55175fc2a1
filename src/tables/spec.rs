//! A table with everything resolved: kind, layout, model, parameters, axes.

use super::sweepable::check_axes;
use super::{Baker, ModelUse, Selection, Setting, TableInfo, default_axes};
use crate::grid::{Axis, Channel, Grid, GridError};
use crate::models::{self, ModelInfo, ParamError, Params};
use serde_json::{Map, Value as Json};

/// A resolved table: what [`TableInfo::bind`] takes and what metadata is written from.
#[derive(Debug, Clone)]
pub struct Spec {
    /// The kind.
    pub kind: &'static TableInfo,
    /// The channels, by layout or one by one.
    pub layout: Selection,
    /// The model and its parameters, for kinds that have one.
    pub model: Option<(&'static ModelInfo, Params)>,
    /// The kind's own parameters.
    pub params: Params,
    /// The axes.
    pub grid: Grid,
}

/// A [`Spec`] with its baker.
pub struct Bound {
    /// What is baked.
    pub spec: Spec,
    /// Computes its texels.
    pub baker: Box<dyn Baker>,
}

impl std::fmt::Debug for Bound {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Bound").field("spec", &self.spec).finish_non_exhaustive()
    }
}

/// What a recipe or a caller asks for, before it is resolved.
#[derive(Debug, Clone, Default)]
pub struct Request {
    /// Table kind id.
    pub kind: String,
    /// Layout id; the default layout if none, unless there are `channels`.
    pub layout: Option<String>,
    /// Any channels of the kind's pool, in file order, instead of a layout.
    pub channels: Option<Vec<String>>,
    /// Model id; the kind's default if none.
    pub model: Option<String>,
    /// Parameters of model and kind.
    pub params: Map<String, Json>,
    /// Axes; the kind's defaults if none.
    pub axes: Option<Vec<Axis>>,
}

/// What can be wrong with a request.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BindError {
    /// No such table kind, layout, channel or model.
    #[error("no {what} `{got}`; {}", .suggestion.as_deref().map_or_else(|| format!("there is {allowed}"), |s| format!("did you mean `{s}`?")))]
    Unknown {
        /// `table`, `layout`, `channel` or `model`.
        what: &'static str,
        /// What was asked for.
        got: String,
        /// What there is.
        allowed: String,
        /// The nearest.
        suggestion: Option<String>,
    },
    /// A channel that is named twice.
    #[error("channel `{got}` is given twice")]
    ChannelTwice {
        /// The channel.
        got: String,
    },
    /// No channels, or too many.
    #[error("table {kind}: {got} channels; a table has 1 to {max}")]
    ChannelCount {
        /// Table kind.
        kind: &'static str,
        /// How many there are.
        got: usize,
        /// How many there may be.
        max: usize,
    },
    /// Channels of different layouts in a kind whose layouts are different integrals.
    #[error("table {kind}: its channels stand together only as one of its layouts")]
    NoMix {
        /// Table kind.
        kind: &'static str,
    },
    /// Two answers to one question.
    #[error("table {kind}: `layout` and `channels` are both given")]
    LayoutAndChannels {
        /// Table kind.
        kind: &'static str,
    },
    /// A channel that the kind does not compute: a fault of the registry.
    #[error("table {kind}: channel `{channel}` is of another kind")]
    Foreign {
        /// Table kind.
        kind: &'static str,
        /// The channel.
        channel: &'static str,
    },
    /// A model given to a kind that has none, or of the wrong sort.
    #[error("table {kind}: model `{model}` {why}")]
    Model {
        /// Table kind.
        kind: &'static str,
        /// Model id.
        model: String,
        /// Why not.
        why: &'static str,
    },
    /// A bad parameter.
    #[error(transparent)]
    Param(#[from] ParamError),
    /// A bad axis.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// A coordinate that must be swept is on no axis.
    #[error("table {kind}: needs an axis for {needed}; it has {got}")]
    MissingAxis {
        /// Table kind.
        kind: &'static str,
        /// The coordinate.
        needed: &'static str,
        /// The axes given.
        got: String,
    },
    /// An axis that nothing in the table depends on.
    #[error("table {kind}: nothing in it depends on axis {axis}; it can sweep {allowed}")]
    IdleAxis {
        /// Table kind.
        kind: &'static str,
        /// The axis.
        axis: &'static str,
        /// What can be swept.
        allowed: String,
    },
    /// Two axes that sweep one parameter by two of its names.
    #[error("table {kind}: axes {} and {} both sweep `{param}`", .axes[0], .axes[1])]
    OneParam {
        /// Table kind.
        kind: &'static str,
        /// The axes.
        axes: [&'static str; 2],
        /// The parameter.
        param: &'static str,
    },
    /// A parameter that is both fixed and swept.
    #[error("table {kind}: `{key}` is both a fixed parameter and an axis")]
    Both {
        /// Table kind.
        kind: &'static str,
        /// The parameter.
        key: String,
    },
}

impl Request {
    /// Resolves and binds.
    ///
    /// # Errors
    /// [`BindError`] names what is wrong and what is allowed.
    pub fn bind(&self) -> Result<Bound, BindError> {
        let spec = self.resolve()?;
        let baker = (spec.kind.bind)(&spec)?;
        Ok(Bound { spec, baker })
    }

    fn resolve(&self) -> Result<Spec, BindError> {
        let kind = super::find(&self.kind)
            .ok_or_else(|| unknown("table", &self.kind, super::TABLES.iter().map(|t| t.id)))?;
        let layout = Selection::resolve(kind, self.layout.as_deref(), self.channels.as_deref())?;
        let (model, model_params, table_params) = self.split_params(kind)?;
        let info = model.map(|(info, _)| info);
        let setting = Setting { layout: &layout, model: info, given: Some(&self.params) };
        let axes = self.axes.clone().unwrap_or_else(|| kind.default_axes(setting));
        if let Some(info) = info.filter(|_| self.axes.is_none() && axes.is_empty()) {
            let why =
                "has no number that an axis measures, so it is one value here: `brdfbake albedo` prints it";
            return Err(BindError::Model { kind: kind.id, model: info.id.to_owned(), why });
        }
        // a name means on an axis what it means in the parameters
        let axes = axes.into_iter().map(|a| info.map_or(a.clone(), |info| default_axes::of_model(a, info)));
        let grid = Grid::new(axes.collect())?;
        let params = Params::resolve_over(kind.id, kind.params, &Map::new(), &table_params)?;
        let model = match model {
            Some((info, implied)) => {
                let implied = models::implied_values(implied);
                Some((info, Params::resolve_over(info.id, info.params, &implied, &model_params)?))
            }
            None => None,
        };
        check_axes(kind, &grid, model.as_ref(), &self.params)?;
        Ok(Spec { kind, layout, model, params, grid })
    }

    /// The model, and the given parameters parted between model and table kind.
    #[allow(clippy::type_complexity, reason = "a private triple, named by its only caller")]
    fn split_params(
        &self,
        kind: &'static TableInfo,
    ) -> Result<
        (Option<(&'static ModelInfo, models::Implied)>, Map<String, Json>, Map<String, Json>),
        BindError,
    > {
        let id = match (kind.model, &self.model) {
            (ModelUse::None, None) => return Ok((None, Map::new(), self.params.clone())),
            (ModelUse::None, Some(model)) => {
                return Err(BindError::Model {
                    kind: kind.id,
                    model: model.clone(),
                    why: "given, but this table has none",
                });
            }
            (ModelUse::Any(default) | ModelUse::Split(default), given) => given.as_deref().unwrap_or(default),
        };
        let (info, implied) =
            models::find(id).ok_or_else(|| unknown("model", id, models::MODELS.iter().map(|m| m.id)))?;
        if matches!(kind.model, ModelUse::Split(_)) && !info.splits {
            let why = "has a Fresnel factor that cannot be split off; use one with parameters f0 and f90, such as `ggx`";
            return Err(BindError::Model { kind: kind.id, model: id.to_owned(), why });
        }
        let own = |key: &str| kind.params.iter().any(|p| p.id == key);
        let (table, model): (Map<_, _>, Map<_, _>) =
            self.params.clone().into_iter().partition(|(k, _)| own(k));
        Ok((Some((info, implied)), model, table))
    }
}

impl Spec {
    /// What default axes and tolerances are chosen for.
    #[must_use]
    pub fn setting(&self) -> Setting<'_> {
        Setting { layout: &self.layout, model: self.model.as_ref().map(|(info, _)| *info), given: None }
    }

    /// Ids of the parameters that an axis sets: those it sweeps, and those that follow a swept one.
    #[must_use]
    pub fn swept(&self) -> Vec<&'static str> {
        let mut ids: Vec<&'static str> = self.grid.axes().iter().map(|a| a.quantity.base_id()).collect();
        if let Some((info, params)) = &self.model {
            // an axis may go by another spelling of the parameter
            for id in &mut ids {
                *id = info.measured(id).map_or(*id, |p| p.id);
            }
            for leader in ids.clone() {
                let same =
                    |a: &str, b: &str| Some((params.number(a).ok()? - params.number(b).ok()?).abs() == 0.0);
                let follows = |id: &&str| same(id, leader) == Some(true);
                ids.extend(info.followers(leader).filter(follows));
            }
            if ids.contains(&"anisotropy") {
                ids.push("alpha_x");
            }
        }
        ids
    }

    /// Number of the axis that sweeps a quantity, itself or through a derived one.
    #[must_use]
    pub fn axis(&self, base_id: &str) -> Option<usize> {
        self.grid.axes().iter().position(|a| a.quantity.base_id() == base_id)
    }

    /// A number of the kind at a point: that of the axis which sweeps it, else the one that is fixed.
    ///
    /// # Errors
    /// [`ParamError::Undeclared`] for one that the kind does not have.
    pub fn number(&self, id: &str, at: &[f64]) -> Result<f64, ParamError> {
        self.axis(id).map_or_else(|| self.params.number(id), |i| Ok(at[i]))
    }

    /// Number of the axis of a coordinate that the kind must have.
    ///
    /// # Errors
    /// [`BindError::MissingAxis`].
    pub fn coordinate(&self, base_id: &'static str) -> Result<usize, BindError> {
        let got = || axis_ids(&self.grid);
        self.axis(base_id).ok_or_else(|| BindError::MissingAxis {
            kind: self.kind.id,
            needed: base_id,
            got: got(),
        })
    }

    /// Roles of the channels, in file order.
    #[must_use]
    pub fn roles(&self) -> Vec<super::Role> {
        self.layout.channels.iter().map(|c| c.role).collect()
    }

    /// What a baker makes of the role of each channel, in file order.
    ///
    /// # Errors
    /// [`BindError::Foreign`] for a channel of which it makes nothing: a fault of the registry.
    pub fn each<T>(&self, make: impl Fn(super::Role) -> Option<T>) -> Result<Vec<T>, BindError> {
        let one = |c: &super::ChannelInfo| {
            make(c.role).ok_or(BindError::Foreign { kind: self.kind.id, channel: c.id })
        };
        self.layout.channels.iter().map(one).collect()
    }

    /// Channels of the layout.
    #[must_use]
    pub fn channels(&self) -> Vec<Channel> {
        self.layout.channels.iter().map(super::ChannelInfo::channel).collect()
    }
}

pub(super) fn axis_ids(grid: &Grid) -> String {
    grid.axes().iter().map(|a| a.quantity.id).collect::<Vec<_>>().join(", ")
}

pub(super) fn unknown<'a>(
    what: &'static str,
    got: &str,
    ids: impl Iterator<Item = &'a str> + Clone,
) -> BindError {
    BindError::Unknown {
        what,
        got: got.to_owned(),
        allowed: ids.clone().collect::<Vec<_>>().join(", "),
        suggestion: crate::math::nearest::nearest(got, ids).map(str::to_owned),
    }
}
