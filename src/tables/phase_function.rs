//! Phase functions over the angle of deflection.

use super::default_axes::axis;
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Setting, Source, Spec, TableInfo, TexelError,
};
use crate::cite;
use crate::grid::{Axis, Warp};
use crate::integrate::{Estimate, MAX_CHANNELS};
use crate::models::{DefaultValue, Param, ParamError, Params};
use crate::terms::phase;

/// Parameters: which phase function, and its numbers.
pub(super) const PARAMS: &[Param] = &[
    Param::choice(
        "phase",
        "Henyey and Greenstein, Rayleigh, Draine, the fit of fog and cloud, or isotropic",
        &["henyey-greenstein", "rayleigh", "draine", "fog", "isotropic"],
    ),
    Param::number(
        "g",
        "g",
        "of henyey-greenstein and draine: asymmetry",
        [-0.999, 0.999],
        DefaultValue::Value(0.75),
    ),
    Param::number(
        "draine_alpha",
        "alpha",
        "of draine: weight of cos^2",
        [0.0, 100.0],
        DefaultValue::Value(1.0),
    ),
    Param {
        unit: "um",
        ..Param::number(
            "diameter",
            "d",
            "of fog: diameter of the droplets",
            [5.0, 50.0],
            DefaultValue::Value(10.0),
        )
    },
];

/// Sources of the phase functions.
pub(super) const SOURCES: &[Source] = &[
    Source::new(cite::HENYEY_GREENSTEIN_1941, "Eq. 2").when("phase", &["henyey-greenstein", "fog"]),
    Source::new(cite::BORN_WOLF_1999, "section 14.5 (Rayleigh)").when("phase", &["rayleigh"]),
    Source::new(cite::DRAINE_2003, "the phase function of two parameters").when("phase", &["draine", "fog"]),
    Source::new(cite::JENDERSIE_DEON_2023, "Eq. 7 to 10 (fog)").when("phase", &["fog"]),
    Source::new(cite::CHANDRASEKHAR_1960, "isotropic scattering").when("phase", &["isotropic"]),
];

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "phase-function",
    title: "Phase function",
    formula: "p(theta), 2 pi int p sin theta dtheta = 1",
    sources: SOURCES,
    coordinates: &["deflection"],
    layouts: &[
        Layout {
            id: "density",
            doc: "scattered radiance per incident radiance, per steradian",
            channels: &[ChannelInfo {
                id: "phase",
                meaning: "p(theta), 1/sr",
                range: [0.0, 3.4e38],
                role: Role::Phase { relative: false },
            }],
        },
        Layout {
            id: "relative",
            doc: "p / p_max, p_max the largest value over all angles (stated by `rule` in the file)",
            channels: &[ChannelInfo {
                id: "phase.relative",
                meaning: "p(theta) / p_max",
                range: [0.0, 1.0],
                role: Role::Phase { relative: true },
            }],
        },
    ],
    mix: Mix::Layouts,
    model: ModelUse::None,
    params: PARAMS,
    laws: &["finite", "range", "total", "honest"],
    axes: default_axes,
    least_tolerance: |_| 0.0,
    blended: true,
    notes: "theta is the angle between the directions of travel: 0 is forward. Some renderers pass the cosine of two directions that both point away, \
        which has the other sign. Axes: deflection, and the numbers of the phase function: g, draine_alpha; diameter of fog.",
    bind,
};

fn default_axes(_: &Setting<'_>) -> Vec<Axis> {
    // forward peaks are narrow
    axis("deflection", 256, [0.0, std::f64::consts::PI], Warp::Power(0.25)).into_iter().collect()
}

/// A phase function with its parameters.
#[derive(Debug, Clone)]
pub struct Phase {
    id: &'static str,
    g: f64,
    alpha: f64,
    diameter: f64,
}

impl Phase {
    /// From the parameters of a table kind.
    ///
    /// # Errors
    /// [`ParamError`] for a kind that does not declare them.
    pub fn new(params: &Params) -> Result<Phase, ParamError> {
        Ok(Phase {
            id: params.choice("phase")?,
            g: params.number("g")?,
            alpha: params.number("draine_alpha")?,
            diameter: params.number("diameter")?,
        })
    }

    /// The density at an angle, 1/sr; `1 - cos` is formed without a difference.
    #[must_use]
    pub fn at(&self, theta: f64) -> f64 {
        let half = libm::sin(0.5 * theta);
        let (below, cos) = (2.0 * half * half, libm::cos(theta));
        let hg = |g| phase::henyey_greenstein_at(g, below);
        match self.id {
            "rayleigh" => phase::rayleigh(cos),
            "draine" => phase::draine_at(self.g, self.alpha, below),
            "fog" => phase::fog_at(self.diameter, below),
            "isotropic" => phase::isotropic(),
            _ => hg(self.g),
        }
    }

    /// The largest value: at one of the ends for all of them.
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.at(0.0).max(self.at(std::f64::consts::PI))
    }

    /// The angle at which the part u of the light lies beyond: `2 pi int_theta^pi p sin = u`, so u = 1 is forward.
    #[must_use]
    pub fn sample(&self, u: f64) -> f64 {
        let cos = match self.id {
            "rayleigh" => phase::sample_rayleigh(u),
            "draine" => phase::sample_draine(self.g, self.alpha, u),
            "fog" => phase::fog_quantile(self.diameter, u),
            "isotropic" => 2.0 * u - 1.0,
            _ => phase::sample_henyey_greenstein(self.g, u),
        };
        cos.clamp(-1.0, 1.0)
    }
}

/// A phase function whose numbers follow the axes of a grid.
#[derive(Debug, Clone)]
pub struct Swept {
    params: Params,
    /// Number of the axis, and what it sweeps.
    axes: Vec<(usize, &'static str)>,
}

impl Swept {
    /// From a spec.
    ///
    /// # Errors
    /// [`BindError::IdleAxis`] for an axis of a number that the phase function does not have.
    pub fn new(spec: &Spec) -> Result<Swept, BindError> {
        let id = spec.params.choice("phase")?;
        let own: &[&str] = match id {
            "henyey-greenstein" => &["g"],
            "draine" => &["g", "draine_alpha"],
            "fog" => &["diameter"],
            _ => &[],
        };
        let mut axes = Vec::new();
        for number in PARAMS.iter().map(|p| p.id).filter(|id| spec.axis(id).is_some()) {
            if !own.contains(&number) {
                let coordinates = spec.kind.coordinates.iter().chain(own).copied().collect::<Vec<_>>();
                let allowed = coordinates.join(", ");
                return Err(BindError::IdleAxis { kind: spec.kind.id, axis: number, allowed });
            }
            axes.extend(spec.axis(number).map(|i| (i, number)));
        }
        Ok(Swept { params: spec.params.clone(), axes })
    }

    /// The axes that sweep its numbers.
    #[must_use]
    pub fn axes(&self) -> &[(usize, &'static str)] {
        &self.axes
    }

    /// The phase function at a point.
    ///
    /// # Errors
    /// As [`Phase::new`].
    pub fn at(&self, at: &[f64]) -> Result<Phase, ParamError> {
        let mut params = self.params.clone();
        for (axis, id) in &self.axes {
            params.set(id, at[*axis]);
        }
        Phase::new(&params)
    }
}

struct Table {
    deflection: usize,
    swept: Swept,
    relative: bool,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    Ok(Box::new(Table {
        deflection: spec.coordinate("deflection")?,
        swept: Swept::new(spec)?,
        relative: spec.roles().contains(&Role::Phase { relative: true }),
    }))
}

impl Baker for Table {
    fn texel(&self, at: &[f64], _tolerance: f64) -> Result<Estimate, TexelError> {
        let phase = self.swept.at(at)?;
        let mut value = [0.0; MAX_CHANNELS];
        value[0] = phase.at(at[self.deflection]) / if self.relative { phase.largest() } else { 1.0 };
        super::closed_form(value, 1)
    }

    fn rule(&self) -> String {
        if self.relative
            && self.swept.axes.is_empty()
            && let Ok(phase) = self.swept.at(&[])
        {
            return format!("closed form, divided by {:e} 1/sr", phase.largest());
        }
        "closed form".to_owned()
    }
}
