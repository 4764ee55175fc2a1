//! Reflectance of metals over the angle, in colour.

use super::default_axes::axis;
use super::fresnel_dielectric::part;
use super::metal::{ETA, Index, NK};
use super::role::{Band, Polarisation};
use super::spectrum::{self, Spectrum};
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Setting, Source, Spec, TableInfo, TexelError,
};
use crate::cite;
use crate::grid::{Axis, Warp};
use crate::integrate::{Estimate, MAX_CHANNELS};
use crate::models::{DefaultValue, Param, Params};
use crate::terms::fresnel::{self, Polarised};
use crate::terms::{metals, schlick};

const fn channel(id: &'static str, meaning: &'static str, p: Polarisation, band: Band) -> ChannelInfo {
    ChannelInfo { id, meaning, range: [0.0, 1.0], role: Role::Metal(p, band) }
}

const fn colour(id: &'static str, meaning: &'static str, band: Band) -> ChannelInfo {
    ChannelInfo { id, meaning, range: [-0.25, 1.25], role: Role::MetalColour(band) }
}

const fn tint(id: &'static str, meaning: &'static str, band: Band) -> ChannelInfo {
    ChannelInfo { id, meaning, range: [0.0, 1.0], role: Role::MetalTint(band) }
}

/// By the curve of artists.
fn is_tint(role: Role) -> bool {
    matches!(role, Role::MetalTint(_))
}

/// Seen in daylight.
fn is_colour(role: Role) -> bool {
    matches!(role, Role::MetalColour(_))
}

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "fresnel-conductor",
    title: "Conductor Fresnel reflectance",
    formula: "F = (R_s + R_p) / 2, R_s = |N^2 - 1|^2 / |mu + q|^4, R_p = |N^2 - 1|^2 |N^2 mu^2 - sin^2|^2 / |N^2 mu + q|^4, q^2 = N^2 - 1 + mu^2, N = (n + ik) / eta",
    sources: &[
        Source::new(cite::BORN_WOLF_1999, "section 14.2"),
        Source::new(cite::POLYANSKIY_2024, "rows of n and k of Johnson and Christy, Rakic")
            .when("metal", &["au", "ag", "al", "cu", "fe", "ni", "ti", "w"]),
        Source::new(cite::KUTZ_2021, "section 2.3 (layout f82-tint)").of(is_tint),
        Source::new(cite::CIE_11664_1, "Table 1, CIE 1931 observer (layout srgb)").of(is_colour),
        Source::new(cite::CIE_11664_2, "Table B.1, D65 (layout srgb)").of(is_colour),
    ],
    coordinates: &["mu"],
    layouts: &[
        Layout {
            id: "rgb",
            doc: "F at 650, 550 and 450 nm",
            channels: &[
                channel("fresnel.r", "F at 650 nm", Polarisation::None, Band::Red),
                channel("fresnel.g", "F at 550 nm", Polarisation::None, Band::Green),
                channel("fresnel.b", "F at 450 nm", Polarisation::None, Band::Blue),
            ],
        },
        Layout {
            id: "srgb",
            doc: "linear sRGB of the reflected daylight (D65), a perfect mirror being 1; not clamped: gold and copper leave the gamut a little",
            channels: &[
                colour("fresnel.r", "red of int F D65 (x, y, z) dlambda", Band::Red),
                colour("fresnel.g", "green of it", Band::Green),
                colour("fresnel.b", "blue of it", Band::Blue),
            ],
        },
        Layout {
            id: "f82-tint",
            doc: "the F82-tint curve that has the metal's F at mu = 1 and mu = 1/7, at 650, 550 and 450 nm; clamped to [0, 1]",
            channels: &[
                tint("fresnel.r", "F82 tint of F at 650 nm", Band::Red),
                tint("fresnel.g", "F82 tint of F at 550 nm", Band::Green),
                tint("fresnel.b", "F82 tint of F at 450 nm", Band::Blue),
            ],
        },
        Layout {
            id: "polarised",
            doc: "s and p at 650, 550 and 450 nm",
            channels: &[
                channel("fresnel.s.r", "R_s at 650 nm", Polarisation::S, Band::Red),
                channel("fresnel.s.g", "R_s at 550 nm", Polarisation::S, Band::Green),
                channel("fresnel.s.b", "R_s at 450 nm", Polarisation::S, Band::Blue),
                channel("fresnel.p.r", "R_p at 650 nm", Polarisation::P, Band::Red),
                channel("fresnel.p.g", "R_p at 550 nm", Polarisation::P, Band::Green),
                channel("fresnel.p.b", "R_p at 450 nm", Polarisation::P, Band::Blue),
            ],
        },
    ],
    mix: Mix::Layouts,
    model: ModelUse::None,
    params: &[
        Param::choice(
            "metal",
            "measured metal; or `index`: n and k as given; or `rows`: those of `nk`",
            &["au", "ag", "al", "cu", "fe", "ni", "ti", "w", "index", "rows"],
        ),
        Param::number("n", "n", "of metal index: real part", [0.0, 1e3], DefaultValue::Value(0.2)).coloured(),
        Param::number(
            "k",
            "k",
            "of metal index: extinction coefficient",
            [0.0, 1e3],
            DefaultValue::Value(3.4),
        )
        .coloured(),
        ETA,
        NK,
    ],
    laws: &["range", "honest"],
    axes: default_axes,
    least_tolerance: |_| 0.0,
    blended: true,
    notes: "n and k of a metal are linear between its rows (of those measured here 20 to 40 nm apart), and constant beyond them. \
        Lists of three for n and k are those of red, green and blue. rgb reads 650, 550 and 450 nm; srgb weighs by D65 and the CIE 1931 observer. \
        f82-tint is the curve F0 + (1 - F0)(1 - mu)^5 - b mu (1 - mu)^6 through the metal's own F at mu = 1 and 1/7: what a shader with F0 and tint shows. \
        Axes: mu, eta, and with metal = index also n and k.",
    bind,
};

fn default_axes(setting: &Setting<'_>) -> Vec<Axis> {
    let warp = if setting.layout.id == "polarised" { Warp::Power(0.4) } else { Warp::OneMinusPower(2.0) };
    axis("mu", 128, [0.0, 1.0], warp).into_iter().collect()
}

struct Table {
    mu: usize,
    /// Axes of n, k and eta, if swept.
    axes: [Option<usize>; 3],
    params: Params,
    /// Of the medium above.
    eta: f64,
    /// Which polarisation and wavelength each channel is; in daylight red, green and blue in order.
    channels: Vec<(Polarisation, Band)>,
    tint: bool,
    /// Of layout srgb, split at the rows of the metal.
    spectrum: Option<Spectrum>,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    let index = Index::of(&spec.params, ["n", "k"])?;
    let daylight = spec.roles().iter().any(|role| is_colour(*role));
    if daylight {
        index.spectral(spec.kind.id)?;
    } else {
        let [red, _, blue] = metals::RGB_NM;
        index.covers(spec.kind.id, [blue, red])?;
    }
    let channels = spec.each(|role| match role {
        Role::Metal(p, band) => Some((p, band)),
        Role::MetalColour(band) | Role::MetalTint(band) => Some((Polarisation::None, band)),
        _ => None,
    })?;
    Ok(Box::new(Table {
        mu: spec.coordinate("mu")?,
        axes: [spec.axis("n"), spec.axis("k"), spec.axis("eta")],
        params: spec.params.clone(),
        eta: spec.params.number("eta")?,
        channels,
        tint: spec.roles().into_iter().any(is_tint),
        spectrum: daylight.then(|| spectrum::daylight_with(index.kinks())),
    }))
}

impl Table {
    fn reflectance(&self, index: &Index<'_>, at: &[f64], mu: f64, band: usize, lambda_nm: f64) -> Polarised {
        let swept = |i: usize, fixed: f64| self.axes[i].map_or(fixed, |axis| at[axis]);
        let (n, k) = index.at(band, lambda_nm);
        let (n, k) = match index {
            Index::Given { .. } => (swept(0, n), swept(1, k)),
            _ => (n, k),
        };
        let eta = swept(2, self.eta);
        fresnel::conductor(mu, n / eta, k / eta)
    }
}

impl Baker for Table {
    fn texel(&self, at: &[f64], tolerance: f64) -> Result<Estimate, TexelError> {
        let (index, mu) = (Index::of(&self.params, ["n", "k"])?, at[self.mu]);
        if let Some(spectrum) = &self.spectrum {
            let f = &mut |lambda| self.reflectance(&index, at, mu, 0, lambda).unpolarised();
            return super::finite(spectrum.colour(tolerance, f), 3);
        }
        let mut value = [0.0; MAX_CHANNELS];
        for (v, (p, band)) in value.iter_mut().zip(&self.channels) {
            let f = |mu: f64| self.reflectance(&index, at, mu, band.index(), metals::RGB_NM[band.index()]);
            *v = if self.tint {
                let [f0, f82] = [1.0, schlick::MU_82].map(|mu| f(mu).unpolarised());
                schlick::f82_tint(f0, schlick::tint_of(f0, f82), mu)
            } else {
                part(f(mu), *p)
            };
        }
        super::closed_form(value, 6)
    }

    fn rule(&self) -> String {
        if self.spectrum.is_some() { spectrum::DAYLIGHT_RULE } else { "closed form" }.to_owned()
    }
}
