//! A model tabulated in half and difference angles, on the grid of the MERL database: 90 x 90 x 180 texels.
//!
//! `wh` stands at angle theta_h to the normal (at azimuth 0: the model is isotropic), `wi` at angle theta_d to wh, turned
//! about it by phi_d from the plane of the normal. Indices of the published reader: `floor(90 sqrt(theta_h/(pi/2)))`,
//! `floor(90 theta_d/(pi/2))`, `floor(180 phi_d/pi)`; a texel stands for its cell, so it is baked at the middle. phi_d ends at pi
//! since f(wo, wi) = f(wi, wo): models without reciprocity have no such table.
//!
//! About a quarter of the texels have wi or wo below the horizon. They hold 0, as the model gives it.

use super::role::{Band, Lobe};
use super::sweep::Sweep;
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Source, Spec, TableInfo, TexelError,
};
use crate::cite;
use crate::grid::{Axis, Quantity, Texel, Warp};
use crate::integrate::{Estimate, MAX_CHANNELS};
use crate::models::{DefaultValue, Param};
use glam::DVec3;

/// Texels along theta_h and theta_d.
pub const THETA: usize = 90;
/// Texels along phi_d.
pub const PHI: usize = 180;

const fn channel(id: &'static str, meaning: &'static str, band: Band) -> ChannelInfo {
    ChannelInfo { id, meaning, range: [0.0, 3.4e38], role: Role::Value(Lobe::Model, band) }
}

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "merl",
    title: "Tabulated BRDF on the grid of MERL",
    formula: "f(theta_h, theta_d, phi_d), wi = R_y(theta_h) (sin theta_d cos phi_d, sin theta_d sin phi_d, cos theta_d), wo its mirror image at wh",
    sources: &[
        Source::new(cite::MATUSIK_2003, "section 3 and the published reader of the database"),
        Source::new(cite::RUSINKIEWICZ_1998, "section 3, half and difference angles"),
    ],
    coordinates: &["phi_d", "theta_d", "theta_h"],
    layouts: &[Layout {
        id: "rgb",
        doc: "f in 1/sr, without the cosine, times the factor of the channel",
        channels: &[
            channel("merl.r", "red f, 1/sr", Band::Red),
            channel("merl.g", "green f, 1/sr", Band::Green),
            channel("merl.b", "blue f, 1/sr", Band::Blue),
        ],
    }],
    mix: Mix::Layouts,
    model: ModelUse::Any("ggx"),
    params: &[
        Param::number("red", "c_r", "factor of the red channel", [0.0, 1.0], DefaultValue::Value(1.0)),
        Param::number("green", "c_g", "factor of the green channel", [0.0, 1.0], DefaultValue::Value(1.0)),
        Param::number("blue", "c_b", "factor of the blue channel", [0.0, 1.0], DefaultValue::Value(1.0)),
    ],
    laws: &["finite", "range", "reciprocity", "honest"],
    axes: |_| default_axes(),
    least_tolerance: |_| 0.0,
    blended: false,
    notes: "Isotropic and reciprocal models only. The container `merl:float` takes exactly the default axes. A mirror-like lobe is narrower than the first \
        cells of theta_h (0.011 degrees wide) only below alpha 1e-4.",
    bind,
};

/// The axes of the database, phi_d first as it runs fastest.
#[must_use]
pub fn default_axes() -> Vec<Axis> {
    let axis = |id: &str, len| Quantity::find(id).map(|q| Axis::new(q, len, Texel::Center));
    let theta_h = axis("theta_h", THETA).map(|a| a.warped(Warp::Power(0.5)));
    [axis("phi_d", PHI), axis("theta_d", THETA), theta_h].into_iter().flatten().collect()
}

struct Tabulated {
    sweep: Sweep,
    phi_d: usize,
    theta_d: usize,
    theta_h: usize,
    factor: [f64; 3],
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    if let Some((info, params)) = &spec.model {
        let refuse = |why| BindError::Model { kind: spec.kind.id, model: info.id.to_owned(), why };
        let model = (info.build)(params)?;
        if !info.laws.reciprocal {
            return Err(refuse("is not reciprocal: f(wo, wi) and f(wi, wo) would share a texel"));
        }
        if model.turns() {
            return Err(refuse(
                "is anisotropic with these parameters: the table has no azimuth of the surface",
            ));
        }
        if model.mirror(1.0).is_some() {
            return Err(refuse("is a mirror: a delta has no value"));
        }
    }
    Ok(Box::new(Tabulated {
        sweep: Sweep::new(spec, false)?,
        phi_d: spec.coordinate("phi_d")?,
        theta_d: spec.coordinate("theta_d")?,
        theta_h: spec.coordinate("theta_h")?,
        factor: spec.params.numbers(["red", "green", "blue"])?,
    }))
}

/// `wo` and `wi` of half and difference angles, the half vector at azimuth 0.
///
/// Both are exact mirror images: with h along wh and d = (a, b, 0) across, wi = cos h + sin d, wo = cos h − sin d.
#[must_use]
pub fn directions(theta_h: f64, theta_d: f64, phi_d: f64) -> (DVec3, DVec3) {
    let (sin_h, cos_h) = libm::sincos(theta_h);
    let (sin_d, cos_d) = libm::sincos(theta_d);
    let (sin_p, cos_p) = libm::sincos(phi_d);
    let along = cos_d * DVec3::new(sin_h, 0.0, cos_h);
    let across = sin_d * DVec3::new(cos_p * cos_h, sin_p, -cos_p * sin_h);
    (along - across, along + across)
}

impl Baker for Tabulated {
    fn texel(&self, at: &[f64], _tolerance: f64) -> Result<Estimate, TexelError> {
        let model = self.sweep.model(at)?;
        let (wo, wi) = directions(at[self.theta_h], at[self.theta_d], at[self.phi_d]);
        let f = model.eval(wo, wi);
        let mut value = [0.0; MAX_CHANNELS];
        for (v, factor) in value.iter_mut().zip(self.factor) {
            *v = factor * f;
        }
        super::closed_form(value, 3)
    }

    fn rule(&self) -> String {
        "the model's value at the middle of the cell".to_owned()
    }
}
