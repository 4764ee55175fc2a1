//! The colour of a black body over its temperature: fire, lava, lamps.

use super::default_axes::axis;
use super::role::{Band, Glow};
use super::spectrum::{self, Spectrum};
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Setting, Source, Spec, TableInfo, TexelError,
};
use crate::cite;
use crate::grid::{Axis, Warp};
use crate::integrate::{Estimate, MAX_CHANNELS};
use crate::models::{DefaultValue, Param};
use crate::terms::blackbody::planck;

const fn colour(id: &'static str, meaning: &'static str, glow: Glow, band: Band) -> ChannelInfo {
    let range = match glow {
        Glow::Hue => [0.0, 8.0],
        Glow::Unclamped => [-2.0, 8.0],
        Glow::Light => [0.0, 3.4e38],
    };
    ChannelInfo { id, meaning, range, role: Role::BlackBody(glow, band) }
}

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "blackbody",
    title: "Black-body colour ramp",
    formula: "int B(lambda, T) (x, y, z) dlambda to linear sRGB, divided by its Y; B = 2 h c^2 / lambda^5 / (exp(h c / (lambda k T)) - 1)",
    sources: &[
        Source::new(cite::PLANCK_1901, "with the exact SI constants of 2019"),
        Source::new(cite::WYMAN_2013, "Eq. 4").when("eye", &["wyman-2013"]),
        Source::new(cite::CIE_11664_1, "Table 1").when("eye", &["cie-1931"]),
        Source::new(cite::LINDBLOOM, "XYZ to sRGB (D65)"),
    ],
    coordinates: &["temperature"],
    layouts: &[
        Layout {
            id: "hue",
            doc: "linear sRGB of luminance 1, negative blue (below 1900 K) cut to 0",
            channels: &[
                colour("blackbody.r", "red at Y = 1", Glow::Hue, Band::Red),
                colour("blackbody.g", "green at Y = 1", Glow::Hue, Band::Green),
                colour("blackbody.b", "blue at Y = 1, at least 0", Glow::Hue, Band::Blue),
            ],
        },
        Layout {
            id: "hue-unclamped",
            doc: "the same as the matrix gives it",
            channels: &[
                colour("blackbody.r", "red at Y = 1", Glow::Unclamped, Band::Red),
                colour("blackbody.g", "green at Y = 1", Glow::Unclamped, Band::Green),
                colour("blackbody.b", "blue at Y = 1", Glow::Unclamped, Band::Blue),
            ],
        },
        Layout {
            id: "light",
            doc: "hue times the luminance, relative to that at the reference temperature",
            channels: &[
                colour("blackbody.r", "red times Y(T) / Y(reference)", Glow::Light, Band::Red),
                colour("blackbody.g", "green times Y(T) / Y(reference)", Glow::Light, Band::Green),
                colour("blackbody.b", "blue times Y(T) / Y(reference)", Glow::Light, Band::Blue),
            ],
        },
    ],
    mix: Mix::Layouts,
    model: ModelUse::None,
    params: &[
        Param {
            unit: "K",
            ..Param::number(
                "reference",
                "T_0",
                "of layout light: temperature of luminance 1",
                [500.0, 1e6],
                DefaultValue::Value(2000.0),
            )
        },
        Param::choice(
            "eye",
            "colour-matching functions: the fit of Wyman and others, or the standard observer itself",
            &["wyman-2013", "cie-1931"],
        ),
    ],
    laws: &["range", "honest"],
    axes: default_axes,
    least_tolerance: |_| 0.0,
    blended: true,
    notes: "The fit is off in the far red: in red by 0.55 at 800 K, 0.29 at 1000 K, 0.046 at 2000 K, 0.0032 at 6500 K; eye = \"cie-1931\" is not. Fire is 1000 to 2000 K, a lamp 2856, daylight about 6500. Below 800 K the fit of the eye in the far red decides the hue.",
    bind,
};

fn default_axes(setting: &Setting<'_>) -> Vec<Axis> {
    let (last, power) = match setting.layout.id {
        // grows as T^4 and faster: at 12000 K its blue is beyond the largest half
        "light" => (10000.0, 1.5),
        "hue-unclamped" => (12000.0, 0.25),
        // blue leaves 0 with a kink
        _ => (12000.0, 0.4),
    };
    axis("temperature", 256, [1000.0, last], Warp::Power(power)).into_iter().collect()
}

struct Table {
    temperature: usize,
    glow: Glow,
    /// Luminance at the reference temperature.
    reference: f64,
    spectrum: &'static Spectrum,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    let glows = spec.each(|role| match role {
        Role::BlackBody(glow, _) => Some(glow),
        _ => None,
    })?;
    let spectrum =
        if spec.params.choice("eye")? == "cie-1931" { spectrum::plain() } else { spectrum::fitted() };
    Ok(Box::new(Table {
        temperature: spec.coordinate("temperature")?,
        glow: glows.first().copied().unwrap_or(Glow::Hue),
        reference: luminance(spectrum, spec.params.number("reference")?),
        spectrum,
    }))
}

/// `int B y dlambda`, W/(sr m²) with lambda in nm as everywhere here.
fn luminance(spectrum: &Spectrum, temperature: f64) -> f64 {
    spectrum.luminance(&mut |lambda| planck(lambda, temperature))
}

impl Baker for Table {
    fn texel(&self, at: &[f64], tolerance: f64) -> Result<Estimate, TexelError> {
        let temperature = at[self.temperature];
        let y = luminance(self.spectrum, temperature);
        let factor = if self.glow == Glow::Light { y / self.reference } else { 1.0 };
        let mut e =
            self.spectrum.colour(tolerance / factor.max(1.0), &mut |lambda| planck(lambda, temperature) / y);
        let mut value = [0.0; MAX_CHANNELS];
        for (c, out) in value.iter_mut().enumerate().take(3) {
            let v = e.value[c] * factor;
            *out = if self.glow == Glow::Unclamped || v.is_nan() { v } else { v.max(0.0) };
            e.error[c] = e.error[c] * factor + 1e-13 * v.abs();
        }
        e.value = value;
        super::finite(e, 3)
    }

    fn rule(&self) -> String {
        spectrum::RULE.to_owned()
    }
}
