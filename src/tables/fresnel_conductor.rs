//! Reflectance of metals over the angle, in colour.

use super::spectrum::{self, Spectrum};
use super::default_axes::axis;
use super::{Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Setting, Spec, TableInfo, TexelError};
use crate::cite;
use crate::grid::{Axis, Warp};
use crate::integrate::{Estimate, MAX_CHANNELS};
use crate::models::{Param, Preset};
use crate::terms::fresnel::{self, Polarised};
use crate::terms::metals::{self, Metal};

const fn channel(id: &'static str, meaning: &'static str) -> ChannelInfo {
    ChannelInfo { id, meaning, range: [0.0, 1.0] }
}

const fn colour(id: &'static str, meaning: &'static str) -> ChannelInfo {
    ChannelInfo { id, meaning, range: [-0.25, 1.25] }
}

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "fresnel-conductor",
    title: "Conductor Fresnel reflectance",
    formula: "F = (R_s + R_p) / 2, R_s = |N^2 - 1|^2 / |mu + q|^4, R_p = |N^2 - 1|^2 |N^2 mu^2 - sin^2|^2 / |N^2 mu + q|^4, q^2 = N^2 - 1 + mu^2, N = n + ik",
    sources: &[
        (cite::BORN_WOLF_1999, "section 14.2"),
        (cite::POLYANSKIY_2024, "rows of n and k of Johnson and Christy, Rakic"),
        (cite::WYMAN_2013, "Eq. 4 (layout srgb)"),
        (cite::CIE_11664_2, "Table B.1, D65 (layout srgb)"),
    ],
    coordinates: &["mu"],
    layouts: &[
        Layout {
            id: "rgb",
            doc: "F at 650, 550 and 450 nm",
            channels: &[
                channel("fresnel.r", "F at 650 nm"),
                channel("fresnel.g", "F at 550 nm"),
                channel("fresnel.b", "F at 450 nm"),
            ],
        },
        Layout {
            id: "srgb",
            doc: "linear sRGB of the reflected daylight (D65), a perfect mirror being 1; not clamped: gold and copper leave the gamut a little",
            channels: &[
                colour("fresnel.r", "red of int F D65 (x, y, z) dlambda"),
                colour("fresnel.g", "green of it"),
                colour("fresnel.b", "blue of it"),
            ],
        },
        Layout {
            id: "polarised",
            doc: "s and p at 650, 550 and 450 nm",
            channels: &[
                channel("fresnel.s.r", "R_s at 650 nm"),
                channel("fresnel.s.g", "R_s at 550 nm"),
                channel("fresnel.s.b", "R_s at 450 nm"),
                channel("fresnel.p.r", "R_p at 650 nm"),
                channel("fresnel.p.g", "R_p at 550 nm"),
                channel("fresnel.p.b", "R_p at 450 nm"),
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
    laws: &["range"],
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
    layout: &'static str,
    /// Of layout srgb, split at the rows of the metal.
    spectrum: Option<Spectrum>,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    let metal = metals::find(spec.params.choice("metal"));
    let rows = metal.into_iter().flat_map(|m| m.rows).map(|row| row[0]);
    Ok(Box::new(Table {
        mu: spec.coordinate("mu")?,
        axes: [spec.axis("n"), spec.axis("k")],
        index: [spec.params.number("n"), spec.params.number("k")],
        metal,
        layout: spec.layout.id,
        spectrum: (spec.layout.id == "srgb").then(|| spectrum::daylight_with(rows)),
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
        for (c, lambda) in metals::RGB_NM.into_iter().enumerate() {
            let f = self.reflectance(at, lambda);
            if self.layout == "polarised" {
                (value[c], value[3 + c]) = (f.s, f.p);
            } else {
                value[c] = f.unpolarised();
            }
        }
        super::closed_form(value, 6)
    }

    fn rule(&self) -> String {
        if self.spectrum.is_some() { spectrum::RULE } else { "closed form" }.to_owned()
    }
}
