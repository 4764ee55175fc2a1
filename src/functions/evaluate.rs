//! A model or a function by name, bound to its parameters: what a row of `brdfbake eval` asks for.

use super::{AngleError, Angles, FunctionError, FunctionInfo};
use crate::math::{frame, nearest};
use crate::models::{self, Brdf, Implied, ModelInfo, ParamError, Params};
use serde_json::{Map, Value as Json};

/// Something with a value.
#[derive(Debug)]
pub enum Subject {
    /// A reflectance model; its value is f.
    Model(&'static ModelInfo, Box<dyn Brdf>),
    /// A function.
    Function(&'static FunctionInfo, Params),
}

/// Why there is no value.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EvalError {
    /// Nothing has this name.
    #[error("no model or function `{name}`{}; `list models` and `list functions` name them all", hint(.nearest))]
    Unknown {
        /// The name given.
        name: String,
        /// Names that are near.
        nearest: Vec<&'static str>,
    },
    /// A parameter is wrong.
    #[error(transparent)]
    Param(#[from] ParamError),
    /// A model needs all four angles.
    #[error("{model}: {column} is blank; a model needs both directions")]
    Blank {
        /// Model id.
        model: &'static str,
        /// The column.
        column: &'static str,
    },
    /// An angle outside its range.
    #[error(transparent)]
    Angle(#[from] AngleError),
    /// A delta has no value.
    #[error(
        "{model} with these parameters is a mirror: its reflection is a delta in direction, which has no value; \
         `albedo` gives its reflectance"
    )]
    Delta {
        /// Model id.
        model: &'static str,
    },
    /// The function has none.
    #[error(transparent)]
    Function(#[from] FunctionError),
}

fn hint(nearest: &[&str]) -> String {
    if nearest.is_empty() { String::new() } else { format!("; did you mean `{}`?", nearest.join("`, `")) }
}

impl Subject {
    /// Finds a model or function by id or by another name, and binds it to parameters.
    ///
    /// Text after the first space of the name is a remark.
    ///
    /// # Errors
    /// [`EvalError::Unknown`] with the nearest names, [`EvalError::Param`].
    pub fn new(name: &str, given: &Map<String, Json>) -> Result<Subject, EvalError> {
        let name = name.split_whitespace().next().unwrap_or_default();
        if let Some((info, implied)) = models::find(name) {
            let params = resolve(info.id, info.params, implied, given)?;
            return Ok(Subject::Model(info, (info.build)(&params)?));
        }
        if let Some((info, implied)) = super::find(name) {
            return Ok(Subject::Function(info, resolve(info.id, info.params, implied, given)?));
        }
        Err(EvalError::Unknown { name: name.to_owned(), nearest: nearest::few(name, names(), 3) })
    }

    /// Id of the model or function.
    #[must_use]
    pub fn id(&self) -> &'static str {
        match self {
            Subject::Model(info, _) => info.id,
            Subject::Function(info, _) => info.id,
        }
    }

    /// The value at the given angles.
    ///
    /// # Errors
    /// [`EvalError::Blank`], [`EvalError::Delta`], [`EvalError::Function`].
    pub fn value(&self, angles: &Angles) -> Result<f64, EvalError> {
        let (info, model) = match self {
            Subject::Function(info, params) => return Ok(info.value(params, angles)?),
            Subject::Model(info, model) => (info, model),
        };
        angles.check()?;
        if model.mirror(1.0).is_some() {
            return Err(EvalError::Delta { model: info.id });
        }
        let need = |column, angle: Option<f64>| angle.ok_or(EvalError::Blank { model: info.id, column });
        let wi = frame::spherical(need("wi_theta", angles.wi_theta)?, need("wi_phi", angles.wi_phi)?);
        let wo = frame::spherical(need("wo_theta", angles.wo_theta)?, need("wo_phi", angles.wo_phi)?);
        Ok(model.eval(wo, wi))
    }
}

fn resolve(
    id: &'static str,
    declared: &'static [models::Param],
    implied: Implied,
    given: &Map<String, Json>,
) -> Result<Params, ParamError> {
    Params::resolve_over(id, declared, &models::implied_values(implied), given)
}

/// Every id and other name of models and functions.
fn names() -> impl Iterator<Item = &'static str> {
    let models =
        models::MODELS.iter().flat_map(|m| std::iter::once(m.id).chain(m.also.iter().map(|a| a.name)));
    models.chain(super::all().flat_map(|f| std::iter::once(f.id).chain(f.also.iter().map(|a| a.name))))
}
