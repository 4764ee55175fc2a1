//! Schlick's Fresnel factor and its generalisations over the angle.

use super::default_axes::axis;
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Setting, Source, Spec, TableInfo, TexelError,
};
use crate::cite;
use crate::grid::{Axis, Warp};
use crate::integrate::{Estimate, MAX_CHANNELS};
use crate::models::{DefaultValue, Param, Params};
use crate::terms::{fresnel, lazanyi, schlick};

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "fresnel-schlick",
    title: "Schlick's Fresnel factor and its variants",
    formula: "schlick: F0 + (F90 - F0)(1 - mu)^5; generalised: exponent p; f82-tint: - b mu (1 - mu)^6; lazanyi: F0(n, k), - a mu (1 - mu)^q; \
        dielectric: (1 - mu_t)^5 and F = 1 beyond the critical angle for eta < 1",
    sources: &[
        Source::new(cite::SCHLICK_1994, "the approximation of F"),
        Source::new(cite::HOFFMAN_2019, "the generalised exponent").when("variant", &["generalised"]),
        Source::new(cite::KUTZ_2021, "F82 tint").when("variant", &["f82-tint"]),
        Source::new(cite::LAZANYI_2005, "the formula with its compensating term")
            .when("variant", &["lazanyi"]),
    ],
    coordinates: &["mu"],
    layouts: &[
        Layout {
            id: "clamped",
            doc: "the factor, kept in [0, 1] as renderers keep it",
            channels: &[ChannelInfo {
                id: "fresnel.f",
                meaning: "F, clamped to [0, 1]",
                range: [0.0, 1.0],
                role: Role::FresnelForm { clamped: true },
            }],
        },
        Layout {
            id: "unclamped",
            doc: "the factor as its formula gives it: f82-tint and lazanyi may be negative",
            channels: &[ChannelInfo {
                id: "fresnel.f",
                meaning: "F",
                range: [-2.0, 1.0],
                role: Role::FresnelForm { clamped: false },
            }],
        },
    ],
    mix: Mix::Layouts,
    model: ModelUse::None,
    params: &[
        Param::choice(
            "variant",
            "which form",
            &["schlick", "generalised", "f82-tint", "lazanyi", "dielectric"],
        ),
        Param::number("f0", "F0", "reflectance at normal incidence", [0.0, 1.0], DefaultValue::Value(0.04)),
        Param::number("f90", "F90", "reflectance at grazing", [0.0, 1.0], DefaultValue::Value(1.0)),
        Param::number(
            "exponent",
            "p",
            "of generalised: the exponent",
            [0.01, 100.0],
            DefaultValue::Value(5.0),
        ),
        Param::number("tint", "t", "of f82-tint: factor at cosine 1/7", [0.0, 1.0], DefaultValue::Value(1.0)),
        Param::number("n", "n", "of lazanyi: real part of the index", [0.0, 1e3], DefaultValue::Value(1.3)),
        Param::number("k", "k", "of lazanyi: extinction coefficient", [0.0, 1e3], DefaultValue::Value(7.6)),
        Param::number("a", "a", "of lazanyi: depth of the dip", [0.0, 10.0], DefaultValue::Value(1.5)),
        Param::number("q", "q", "of lazanyi: exponent of the dip", [0.01, 100.0], DefaultValue::Value(6.0)),
        Param::number("eta", "eta", "of dielectric: relative index", [1e-3, 1e3], DefaultValue::Value(1.5)),
    ],
    laws: &["range", "honest"],
    axes: default_axes,
    least_tolerance: |_| 0.0,
    blended: true,
    notes: "Not exact Fresnel: the plain form is off by up to 0.060 at eta 1.33, 0.036 at 1.5, 0.082 at 2.5. Axes: mu, and any number of its own (f0, n, k, eta).",
    bind,
};

fn default_axes(_: &Setting<'_>) -> Vec<Axis> {
    let mu = axis("mu", 128, [0.0, 1.0], Warp::OneMinusPower(2.0));
    [mu, axis("f0", 32, [0.0, 1.0], Warp::Linear)].into_iter().flatten().collect()
}

struct Table {
    mu: usize,
    swept: Vec<(usize, &'static str)>,
    params: Params,
    clamped: bool,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    let mu = spec.coordinate("mu")?;
    let swept = spec.grid.axes().iter().enumerate().map(|(i, a)| (i, a.quantity.base_id()));
    Ok(Box::new(Table {
        mu,
        swept: swept.filter(|(i, _)| *i != mu).collect(),
        params: spec.params.clone(),
        clamped: spec.roles().contains(&Role::FresnelForm { clamped: true }),
    }))
}

impl Baker for Table {
    fn texel(&self, at: &[f64], _tolerance: f64) -> Result<Estimate, TexelError> {
        let number = |id: &'static str| {
            self.swept.iter().find(|s| s.1 == id).map_or_else(|| self.params.number(id), |s| Ok(at[s.0]))
        };
        let mu = at[self.mu];
        let f = match self.params.choice("variant")? {
            "generalised" => {
                schlick::schlick_generalised(number("f0")?, number("f90")?, number("exponent")?, mu)
            }
            "f82-tint" => schlick::f82_tint_unclamped(number("f0")?, number("tint")?, mu),
            "lazanyi" => lazanyi::lazanyi(number("n")?, number("k")?, number("a")?, number("q")?, mu),
            "dielectric" => dielectric(mu, number("eta")?),
            _ => schlick::schlick(number("f0")?, number("f90")?, mu),
        };
        let mut value = [0.0; MAX_CHANNELS];
        value[0] = if self.clamped && !f.is_nan() { f.clamp(0.0, 1.0) } else { f };
        super::closed_form(value, 1)
    }

    fn rule(&self) -> String {
        "closed form".to_owned()
    }
}

/// Schlick's form of a dielectric: from the denser side the refracted cosine, and total reflection beyond its end.
fn dielectric(mu: f64, eta: f64) -> f64 {
    let f0 = lazanyi::f0(eta, 0.0);
    if eta >= 1.0 {
        return schlick::schlick(f0, 1.0, mu);
    }
    fresnel::cos_refracted(mu, eta).map_or(1.0, |cos_t| schlick::schlick(f0, 1.0, cos_t))
}
