//! Masking G1 of a rough surface over the cosine and the width.

use super::normals::{ALPHA, EXPONENT, GAMMA, Swept, refuse_idle, width_of};
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Setting, Source, Spec, TableInfo, TexelError,
};
use crate::cite;
use crate::grid::{Axis, Quantity, Texel, Warp};
use crate::integrate::Estimate;
use crate::models::normals::{self, NORMALS, between};
use crate::models::{DefaultValue, Param, ParamError};
use crate::terms::schlick_masking::{self, K};
use crate::terms::{charlie, vcavity};
use std::f64::consts::PI;

/// Masking that is Smith's of no distribution here: Schlick's rational form by its three k, the fit that goes with Charlie, V-shaped grooves.
const OTHERS: [&str; 5] = ["schlick-ibl", "schlick-analytic", "schlick", "charlie-fit", "vcavity"];

/// Those that are Schlick's rational form.
pub(super) const SCHLICK: &[&str] = OTHERS.split_at(3).0;

/// Every distribution, then the others.
pub(super) const WORDS: [&str; normals::IDS.len() + OTHERS.len()] = {
    let mut words = [""; normals::IDS.len() + OTHERS.len()];
    let mut i = 0;
    while i < words.len() {
        words[i] = if i < normals::IDS.len() { normals::IDS[i] } else { OTHERS[i - normals::IDS.len()] };
        i += 1;
    }
    words
};

/// Whose masking.
pub(super) const DISTRIBUTION: Param = Param::choice(
    "distribution",
    "Smith's masking of a distribution (every function `d-...`), Schlick's rational form with k = alpha/2, (r + 1)^2/8 or \
     alpha sqrt(2/pi), the fit of Charlie's authors, or V-shaped grooves",
    &WORDS,
);

/// The sources of Smith's masking, then of the others.
pub(super) const SOURCES: [Source; NORMALS.len() + 4] = {
    let schlick = Source::new(cite::SCHLICK_1994, "the rational form of G1").when("distribution", SCHLICK);
    let mut all = [schlick; NORMALS.len() + 4];
    let mut i = 0;
    while i < NORMALS.len() {
        let n = &NORMALS[i];
        let (cite, place) = match n.masking {
            Some(of) => of,
            None => (cite::HEITZ_2014, "Eq. 14, 41 and 42 (Lambda as an area, by quadrature)"),
        };
        all[i] = Source::new(cite, place).when("distribution", std::slice::from_ref(&n.id));
        i += 1;
    }
    all[i] = Source::new(cite::KARIS_2013, "Eq. 4 (k)").when("distribution", OTHERS.split_at(2).0);
    all[i + 1] =
        Source::new(cite::ESTEVEZ_KULLA_2017, "Eq. 3 and its table").when("distribution", &["charlie-fit"]);
    all[i + 2] = Source::new(cite::TORRANCE_SPARROW_1967, "Eq. 16 to 18").when("distribution", &["vcavity"]);
    all
};

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "masking",
    title: "Masking G1",
    formula: "Smith: G1 = 1 / (1 + Lambda(mu)); Schlick: G1 = mu / (mu (1 - k) + k); V-cavities: G1 = min(1, 2 mu_m mu / (w . m))",
    sources: &SOURCES,
    coordinates: &["mu"],
    layouts: &[Layout {
        id: "g1",
        doc: "part of the facets facing a direction that is not hidden",
        channels: &[ChannelInfo { id: "g1", meaning: "G1(mu)", range: [0.0, 1.0], role: Role::Masking }],
    }],
    mix: Mix::Layouts,
    model: ModelUse::None,
    params: &[
        DISTRIBUTION,
        ALPHA,
        GAMMA,
        EXPONENT,
        Param::number(
            "mu_m",
            "mu_m",
            "of vcavity: cosine of the facet's normal",
            [0.0, 1.0],
            DefaultValue::Value(0.5),
        ),
        Param {
            unit: "rad",
            ..Param::number(
                "phi",
                "phi",
                "of vcavity: azimuth of the facet from the direction",
                [0.0, 2.0 * PI],
                DefaultValue::Value(0.0),
            )
        },
    ],
    laws: &["finite", "range", "monotone", "honest"],
    axes: default_axes,
    least_tolerance: |_| 0.0,
    blended: true,
    notes: "G1 falls to 0 at the horizon on the scale mu ~ alpha: couple the axis of mu to alpha, as the default axes do. \
        Axes: mu, alpha or roughness (n of blinn-phong), gamma of student-t and gtr; mu_m and phi of vcavity, which has no width. Smith's \
        masking of gtr, blinn-phong, charlie, velvet and sggx is the integral of D; charlie-fit is what goes with it in productions, and \
        vcavity goes with blinn-phong and velvet-2000.",
    bind,
};

fn default_axes(setting: &Setting<'_>) -> Vec<Axis> {
    axes(&["mu"], 64, 64, [0.01, 1.0], setting)
}

/// Cosines on axes that open the corner where they and the width go to 0 together, then the width.
pub(super) fn axes(
    cosines: &[&str],
    len: usize,
    widths: usize,
    domain: [f64; 2],
    setting: &Setting<'_>,
) -> Vec<Axis> {
    let warp = Warp::Coupled { to: "alpha".to_owned(), power: 2.0, scale: 1.0, exponent: 1.0 };
    let cosines = cosines.iter().filter_map(|id| Quantity::find(id));
    let mut axes: Vec<Axis> =
        cosines.map(|q| Axis::new(q, len, Texel::Endpoint).warped(warp.clone())).collect();
    if setting.chosen("distribution") == Some("vcavity") {
        return axes;
    }
    let (id, domain, warp) = match width_of(setting) {
        "n" => ("n", [1.0, 1000.0], Warp::Power(0.25)),
        _ => ("roughness", domain, Warp::Linear),
    };
    axes.extend(Quantity::find(id).map(|q| Axis::new(q, widths, Texel::Endpoint).over(domain).warped(warp)));
    axes
}

/// Masking over the axes of a table.
#[derive(Debug)]
pub(super) enum Masking {
    /// Smith's of a distribution.
    Smith(Swept),
    /// Schlick's, of alpha on an axis or fixed.
    Rational(K, Number),
    /// The fit that goes with Charlie.
    Charlie(Number),
    /// V-shaped grooves.
    Grooves,
}

/// A number on an axis or fixed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Number {
    axis: Option<usize>,
    fixed: f64,
}

impl Number {
    pub(super) fn of(spec: &Spec, id: &str) -> Result<Number, ParamError> {
        Ok(Number { axis: spec.axis(id), fixed: spec.params.number(id)? })
    }

    pub(super) fn at(self, at: &[f64]) -> f64 {
        self.axis.map_or(self.fixed, |i| at[i])
    }
}

impl Masking {
    /// The masking that a spec names; `grooves` are the numbers that only V-shaped grooves have.
    pub(super) fn new(spec: &Spec, grooves: &[&'static str]) -> Result<Masking, BindError> {
        let word = spec.params.choice("distribution")?;
        if word == "vcavity" {
            refuse_idle(spec, &["alpha", "gamma", "n"], grooves)?;
            return Ok(Masking::Grooves);
        }
        refuse_idle(spec, grooves, &["alpha"])?;
        if let Some(swept) = Swept::new(spec)? {
            return Ok(Masking::Smith(swept));
        }
        refuse_idle(spec, &["gamma", "n"], &["alpha"])?;
        let alpha = Number::of(spec, "alpha")?;
        Ok(match word {
            "schlick-ibl" => Masking::Rational(K::Ibl, alpha),
            "schlick-analytic" => Masking::Rational(K::Analytic, alpha),
            "schlick" => Masking::Rational(K::Schlick, alpha),
            _ => Masking::Charlie(alpha),
        })
    }
}

/// `mu Lambda` of the fit that goes with Charlie; its widths are those of the lobe.
pub(super) fn charlie_hidden(alpha: f64, mu: f64) -> Result<f64, ParamError> {
    let [min, max] = normals::find("charlie").map_or([0.0, 1.0], |n| n.widths);
    if !(min..=max).contains(&alpha) {
        return Err(ParamError::Range { model: "charlie-fit", key: "alpha", got: alpha, min, max });
    }
    Ok(mu * charlie::lambda(alpha, mu))
}

struct Table {
    mu: usize,
    masking: Masking,
    mu_m: Number,
    phi: Number,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    Ok(Box::new(Table {
        mu: spec.coordinate("mu")?,
        masking: Masking::new(spec, &["mu_m", "phi"])?,
        mu_m: Number::of(spec, "mu_m")?,
        phi: Number::of(spec, "phi")?,
    }))
}

impl Baker for Table {
    fn texel(&self, at: &[f64], tolerance: f64) -> Result<Estimate, TexelError> {
        let mu = at[self.mu];
        let (value, error, evaluations) = match &self.masking {
            Masking::Smith(swept) => {
                let hidden = swept.normals().hidden(swept.shape(at)?, mu, tolerance);
                let facing = mu + hidden.value[0];
                let g1 = mu / facing;
                (g1, g1 * (hidden.error[0] / facing), hidden.evaluations)
            }
            Masking::Rational(k, alpha) => {
                (schlick_masking::g1(schlick_masking::k(*k, alpha.at(at)), mu), 0.0, 1)
            }
            Masking::Charlie(alpha) => {
                charlie_hidden(alpha.at(at), mu)?;
                (1.0 / (1.0 + charlie::lambda(alpha.at(at), mu)), 0.0, 1)
            }
            Masking::Grooves => {
                let (mu_m, phi) = (self.mu_m.at(at), self.phi.at(at));
                let (w, m) = (normals::direction(mu), normals::direction(mu_m));
                (vcavity::g1(w, m, between(mu, mu_m, phi)), 0.0, 1)
            }
        };
        let mut e = super::finite(Estimate::exact_one(value), 1)?;
        e.error[0] += error;
        e.evaluations = evaluations;
        super::finite(e, 1)
    }

    fn rule(&self) -> String {
        self.masking.rule()
    }
}

impl Masking {
    /// The rule in words.
    pub(super) fn rule(&self) -> String {
        match self {
            Masking::Smith(swept) if !swept.normals().closed() => {
                "adaptive Gauss-Kronrod of the facets that are turned away".to_owned()
            }
            _ => "closed form".to_owned(),
        }
    }
}
