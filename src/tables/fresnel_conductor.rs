//! Reflectance of metals over the angle, in colour.

use super::default_axes::axis;
use super::fresnel_dielectric::part;
use super::role::{Band, Polarisation};
use super::spectrum::{self, Spectrum};
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Setting, Source, Spec, TableInfo, TexelError,
};
use crate::cite;
use crate::grid::{Axis, Warp};
use crate::integrate::{Estimate, MAX_CHANNELS};
use crate::models::{Param, Preset};
use crate::terms::fresnel::{self, Polarised};
use crate::terms::metals::{self, Metal};

const fn channel(id: &'static str, meaning: &'static str, p: Polarisation, band: Band) -> ChannelInfo {
    ChannelInfo { id, meaning, range: [0.0, 1.0], role: Role::Metal(p, band) }
}

const fn colour(id: &'static str, meaning: &'static str, band: Band) -> ChannelInfo {
    ChannelInfo { id, meaning, range: [-0.25, 1.25], role: Role::MetalColour(band) }
}

/// Seen in daylight.
fn is_colour(role: Role) -> bool {
    matches!(role, Role::MetalColour(_))
}

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "fresnel-conductor",
    title: "Conductor Fresnel reflectance",
    formula: "F = (R_s + R_p) / 2, R_s = |N^2 - 1|^2 / |mu + q|^4, R_p = |N^2 - 1|^2 |N^2 mu^2 - sin^2|^2 / |N^2 mu + q|^4, q^2 = N^2 - 1 + mu^2, N = n + ik",
    sources: &[
        Source::new(cite::BORN_WOLF_1999, "section 14.2"),
        Source::new(cite::POLYANSKIY_2024, "rows of n and k of Johnson and Christy, Rakic")
            .when("metal", &["au", "ag", "al", "cu", "fe", "ni", "ti", "w"]),
        Source::new(cite::WYMAN_2013, "Eq. 4 (layout srgb)").of(is_colour),
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
            "measured metal, or `index`: n and k as given, for all wavelengths",
            &["au", "ag", "al", "cu", "fe", "ni", "ti", "w", "index"],
        ),
        Param::number("n", "n", "of metal index: real part", [0.0, 1e3], Preset::Value(0.2)),
        Param::number("k", "k", "of metal index: extinction coefficient", [0.0, 1e3], Preset::Value(3.4)),
    ],
    laws: &["range", "honest"],
    axes: default_axes,
    least_tolerance: |_| 0.0,
    blended: true,
    notes: "n and k of a metal are linear between its measured rows, 20 to 40 nm apart. Axes: mu, and with metal = index also n and k.",
    bind,
};

fn default_axes(setting: &Setting<'_>) -> Vec<Axis> {
    let warp = if setting.layout.id == "polarised" { Warp::Power(0.4) } else { Warp::OneMinusPower(2.0) };
    axis("mu", 128, [0.0, 1.0], warp).into_iter().collect()
}

struct Table {
    mu: usize,
    /// Axes of n and k, if swept.
    axes: [Option<usize>; 2],
    index: [f64; 2],
    metal: Option<&'static Metal>,
    /// Which polarisation and wavelength each channel is; in daylight red, green and blue in order.
    channels: Vec<(Polarisation, Band)>,
    /// Of layout srgb, split at the rows of the metal.
    spectrum: Option<Spectrum>,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    let metal = metals::find(spec.params.choice("metal")?);
    let daylight = spec.roles().iter().any(|role| is_colour(*role));
    let channels = spec.each(|role| match role {
        Role::Metal(p, band) => Some((p, band)),
        Role::MetalColour(band) => Some((Polarisation::None, band)),
        _ => None,
    })?;
    let rows = metal.into_iter().flat_map(|m| m.rows).map(|row| row[0]);
    Ok(Box::new(Table {
        mu: spec.coordinate("mu")?,
        axes: [spec.axis("n"), spec.axis("k")],
        index: [spec.params.number("n")?, spec.params.number("k")?],
        metal,
        channels,
        spectrum: daylight.then(|| spectrum::daylight_with(rows)),
    }))
}

impl Table {
    fn reflectance(&self, at: &[f64], lambda_nm: f64) -> Polarised {
        let [n, k] = [0, 1].map(|i| self.axes[i].map_or(self.index[i], |axis| at[axis]));
        let (n, k) = self.metal.map_or((n, k), |metal| metal.index(lambda_nm));
        fresnel::conductor(at[self.mu], n, k)
    }
}

impl Baker for Table {
    fn texel(&self, at: &[f64], tolerance: f64) -> Result<Estimate, TexelError> {
        if let Some(spectrum) = &self.spectrum {
            let f = &mut |lambda| self.reflectance(at, lambda).unpolarised();
            return super::finite(spectrum.colour(tolerance, f), 3);
        }
        let mut value = [0.0; MAX_CHANNELS];
        for (v, (p, band)) in value.iter_mut().zip(&self.channels) {
            *v = part(self.reflectance(at, metals::RGB_NM[band.index()]), *p);
        }
        super::closed_form(value, 6)
    }

    fn rule(&self) -> String {
        if self.spectrum.is_some() { spectrum::RULE } else { "closed form" }.to_owned()
    }
}
