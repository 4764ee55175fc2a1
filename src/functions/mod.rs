//! Functions: the terms of the papers under ids of their own, for `brdfbake eval`, `list functions` and `describe`.
//!
//! A function turns parameters, and directions if it uses any, into one number. Models are not functions: they have a
//! sampler, a density and laws. To add a function: write a [`FunctionInfo`] into the file of its family; that is all.

pub mod conversion;
pub mod energy;
pub mod evaluate;
pub mod filtering;
pub mod fresnel;
pub mod fresnel_average;
pub mod geometry;
pub mod ltc;
pub mod masking;
pub mod media;
pub mod metals;
pub mod ndf;
pub mod phase;
pub mod profile;
pub mod sampling;
pub mod thin_film;

use crate::cite::Cite;
use crate::math::figures::{exact, significant};
use crate::math::frame;
use crate::models::{self, Alias, DefaultValue, Implied, Known, KnownValue, Param, ParamError, Params};
pub use evaluate::{EvalError, Subject};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Every family of functions, in the order of `list functions`.
pub static FAMILIES: &[&[FunctionInfo]] = &[
    geometry::ALL,
    fresnel::ALL,
    fresnel_average::ALL,
    thin_film::ALL,
    metals::ALL,
    ndf::ALL,
    masking::ALL,
    sampling::ALL,
    energy::ALL,
    ltc::ALL,
    profile::ALL,
    media::ALL,
    phase::ALL,
    filtering::ALL,
    conversion::ALL,
];

/// Everything that is known of a function.
#[derive(Debug)]
pub struct FunctionInfo {
    /// Id: kebab-case.
    pub id: &'static str,
    /// Title.
    pub title: &'static str,
    /// Formula.
    pub formula: &'static str,
    /// Sources with equation numbers.
    pub sources: &'static [(Cite, &'static str)],
    /// Parameters.
    pub params: &'static [Param],
    /// What it reads from the angle columns; the others may be blank.
    pub inputs: &'static [Input],
    /// Unit of the value.
    pub unit: &'static str,
    /// Values that it can take.
    pub range: [f64; 2],
    /// What to know before using it.
    pub notes: &'static str,
    /// Other names, with the parameters that they imply.
    pub also: &'static [Alias],
    /// Values known from elsewhere; `params` are JSON, angles as in [`KnownValue::Value`].
    pub known: &'static [Known],
    /// The function. Every input that `inputs` names is there.
    pub eval: fn(&Params, &At) -> Result<f64, FunctionError>,
}

/// What a function reads from the angle columns, with its meaning there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Input {
    /// The angle in `wi_theta`, up to pi.
    WiTheta(&'static str),
    /// The angle in `wi_theta`, on the side of the normal: up to pi/2.
    Incidence(&'static str),
    /// The direction in `wi_theta`, `wi_phi`.
    Wi(&'static str),
    /// The direction in `wo_theta`, `wo_phi`.
    Wo(&'static str),
}

impl Input {
    /// The columns, and what they hold.
    #[must_use]
    pub fn columns(&self) -> (&'static [&'static str], &'static str) {
        match self {
            Input::WiTheta(meaning) | Input::Incidence(meaning) => (&["wi_theta"], meaning),
            Input::Wi(meaning) => (&["wi_theta", "wi_phi"], meaning),
            Input::Wo(meaning) => (&["wo_theta", "wo_phi"], meaning),
        }
    }
}

/// Angles in rad as given; `None` is a blank.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Angles {
    /// Polar angle of wi.
    pub wi_theta: Option<f64>,
    /// Azimuth of wi.
    pub wi_phi: Option<f64>,
    /// Polar angle of wo.
    pub wo_theta: Option<f64>,
    /// Azimuth of wo.
    pub wo_phi: Option<f64>,
}

impl Angles {
    /// All four, in the order of [`KnownValue::Value`].
    #[must_use]
    pub fn all([wi_theta, wi_phi, wo_theta, wo_phi]: [f64; 4]) -> Angles {
        let [wi_theta, wi_phi, wo_theta, wo_phi] = [wi_theta, wi_phi, wo_theta, wo_phi].map(Some);
        Angles { wi_theta, wi_phi, wo_theta, wo_phi }
    }

    /// The angle in a column.
    fn get(&self, column: &str) -> Option<f64> {
        match column {
            "wi_theta" => self.wi_theta,
            "wi_phi" => self.wi_phi,
            "wo_theta" => self.wo_theta,
            _ => self.wo_phi,
        }
    }
}

/// How far beyond pi or 2 pi an angle may be: what rounding to four decimals adds.
const ROUNDING: f64 = 2e-5;

/// An angle that is not finite or exceeds a full turn, as one in degrees would.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "{column} = {} outside [{}, {}]: angles are in radians",
    exact(.got),
    significant(.least, 5),
    significant(.most, 5)
)]
pub struct AngleError {
    /// The column.
    pub column: &'static str,
    /// The angle given.
    pub got: f64,
    /// Least that it can be.
    pub least: f64,
    /// Most that it can be.
    pub most: f64,
}

impl Angles {
    /// Checks that those that are given are angles in radians: polar ones in [0, pi], azimuths within a turn either way.
    ///
    /// # Errors
    /// [`AngleError`] for the first that is not.
    pub fn check(&self) -> Result<(), AngleError> {
        let theta = [("wi_theta", self.wi_theta), ("wo_theta", self.wo_theta)];
        let phi = [("wi_phi", self.wi_phi), ("wo_phi", self.wo_phi)];
        let theta = theta.map(|(column, angle)| (column, angle, 0.0, PI + ROUNDING));
        let phi = phi.map(|(column, angle)| (column, angle, -TAU - ROUNDING, TAU + ROUNDING));
        for (column, angle, least, most) in theta.into_iter().chain(phi) {
            if let Some(got) = angle.filter(|a| !(least..=most).contains(a)) {
                return Err(AngleError { column, got, least, most });
            }
        }
        Ok(())
    }
}

/// Angles and directions that a function has asked for; NaN where it has not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct At {
    /// The angle in `wi_theta`, rad.
    pub wi_theta: f64,
    /// The direction of the `wi` columns.
    pub wi: DVec3,
    /// The direction of the `wo` columns.
    pub wo: DVec3,
}

/// Why a function has no value.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FunctionError {
    /// An angle that it needs is blank.
    #[error("{function}: {column} is blank; it holds {meaning}")]
    Blank {
        /// Id of the function.
        function: &'static str,
        /// The column.
        column: &'static str,
        /// What the column means to the function.
        meaning: &'static str,
    },
    /// An angle outside its range.
    #[error(transparent)]
    Angle(#[from] AngleError),
    /// A parameter that the function does not declare: a fault of its file.
    #[error(transparent)]
    Param(#[from] ParamError),
    /// There is no value for these parameters and angles.
    #[error("{function}: {why}")]
    Undefined {
        /// Id of the function.
        function: &'static str,
        /// Why not.
        why: &'static str,
    },
    /// The value is infinite, or a fault.
    #[error("{function}: the value is {}, which no file can hold", exact(.value))]
    NotFinite {
        /// Id of the function.
        function: &'static str,
        /// The value.
        value: f64,
    },
}

impl FunctionInfo {
    /// The value at the given angles.
    ///
    /// # Errors
    /// [`FunctionError`] if an angle is missing, or if there is no finite value.
    pub fn value(&self, params: &Params, angles: &Angles) -> Result<f64, FunctionError> {
        angles.check()?;
        for input in self.inputs {
            let (columns, meaning) = input.columns();
            if matches!(input, Input::Incidence(_)) && angles.wi_theta.is_some_and(|a| a > FRAC_PI_2) {
                let why = "wi_theta is outside [0, pi/2], the angles of incidence";
                return Err(FunctionError::Undefined { function: self.id, why });
            }
            if let Some(column) = columns.iter().find(|c| angles.get(c).is_none()) {
                return Err(FunctionError::Blank { function: self.id, column, meaning });
            }
        }
        let direction = |theta: Option<f64>, phi: Option<f64>| {
            theta.zip(phi).map_or(DVec3::NAN, |(theta, phi)| frame::spherical(theta, phi))
        };
        let at = At {
            wi_theta: angles.wi_theta.unwrap_or(f64::NAN),
            wi: direction(angles.wi_theta, angles.wi_phi),
            wo: direction(angles.wo_theta, angles.wo_phi),
        };
        let value = (self.eval)(params, &at)?;
        if value.is_finite() { Ok(value) } else { Err(FunctionError::NotFinite { function: self.id, value }) }
    }

    /// The sources as text.
    #[must_use]
    pub fn source_lines(&self) -> Vec<String> {
        models::source_lines(self.sources)
    }
}

/// Every function, in the order of `list functions`.
pub fn all() -> impl Iterator<Item = &'static FunctionInfo> + Clone {
    FAMILIES.iter().flat_map(|family| family.iter())
}

/// Finds a function by id or by another name. The second part are the parameters that the name implies.
#[must_use]
pub fn find(name: &str) -> Option<(&'static FunctionInfo, Implied)> {
    all().find_map(|info| {
        if info.id == name {
            return Some((info, &[][..]));
        }
        info.also.iter().find(|a| a.name == name).map(|a| (info, a.set))
    })
}

/// A number parameter whose symbol is its id.
const fn number(id: &'static str, doc: &'static str, range: [f64; 2], default: f64) -> Param {
    Param::number(id, id, doc, range, DefaultValue::Value(default))
}

/// The same with a unit.
const fn measured(
    id: &'static str,
    unit: &'static str,
    doc: &'static str,
    range: [f64; 2],
    default: f64,
) -> Param {
    let mut param = number(id, doc, range, default);
    param.unit = unit;
    param
}

/// A known value: parameters as JSON, angles, value, relative accuracy, source.
const fn known(
    params: &'static [(&'static str, &'static str)],
    angles: [f64; 4],
    value: f64,
    relative: f64,
    source: &'static str,
) -> Known {
    Known { what: KnownValue::Value(angles), params, value, relative, source }
}

/// Another name without implied parameters.
const fn alias(name: &'static str) -> Alias {
    Alias { name, set: &[] }
}

/// Another name that implies parameters.
const fn alias_with(name: &'static str, set: Implied) -> Alias {
    Alias { name, set }
}

/// Source of most known values.
const REFERENCE: &str = "formula in 50-digit arithmetic (mpmath)";

/// Angles of a known value that uses none.
const NO_ANGLES: [f64; 4] = [0.0; 4];

/// Angles of a known value at `wi_theta`.
const fn theta(wi_theta: f64) -> [f64; 4] {
    [wi_theta, 0.0, 0.0, 0.0]
}

/// Directions of the components of a vector.
const COMPONENTS: &[&str] = &["x", "y", "z"];

/// The component that the parameter `component` names.
fn component(params: &Params, v: DVec3) -> Result<f64, ParamError> {
    Ok(match params.choice("component")? {
        "x" => v.x,
        "y" => v.y,
        _ => v.z,
    })
}
