//! The eye in Fourier space: transforms of the colour-matching functions over the optical path difference, for thin films.

use super::default_axes::axis;
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Setting, Source, Spec, TableInfo, TexelError,
};
use crate::cite;
use crate::grid::{Axis, Warp};
use crate::integrate::{Estimate, MAX_CHANNELS, line};
use crate::models::{DefaultValue, Param};
use crate::terms::colour::{VISIBLE_NM, cie_xyz};
use std::f64::consts::TAU;

const fn part(id: &'static str, meaning: &'static str, component: usize, imaginary: bool) -> ChannelInfo {
    ChannelInfo { id, meaning, range: [-3.4e38, 3.4e38], role: Role::Sensitivity { component, imaginary } }
}

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "film-sensitivity",
    title: "Fourier transform of the colour-matching functions",
    formula: "S(D) = scale int (x, y, z)(lambda) exp(-2 pi i D / lambda) dlambda, lambda in nm",
    sources: &[
        Source::new(cite::BELCOUR_BARLA_2017, "section 4 (spectral integration in Fourier space)"),
        Source::new(cite::CIE_11664_1, "Table 1, CIE 1931 observer"),
    ],
    coordinates: &["opd"],
    layouts: &[Layout {
        id: "transform",
        doc: "real parts of X, Y, Z, then their imaginary parts; divided by S(0) of a channel it is what the series of a film weighs its orders with",
        channels: &[
            part("film.x.re", "Re S_x", 0, false),
            part("film.y.re", "Re S_y", 1, false),
            part("film.z.re", "Re S_z", 2, false),
            part("film.x.im", "Im S_x", 0, true),
            part("film.y.im", "Im S_y", 1, true),
            part("film.z.im", "Im S_z", 2, true),
        ],
    }],
    mix: Mix::Free(&[]),
    model: ModelUse::None,
    params: &[Param::number(
        "scale",
        "scale",
        "factor of the integrals, which are nm (106.86 of x at D = 0 for a factor of 1)",
        [1e-9, 1e9],
        DefaultValue::Value(1.0),
    )],
    laws: &["finite", "honest"],
    axes: default_axes,
    least_tolerance: |_| 0.0,
    blended: true,
    notes: "The optical path difference of a film of index n2 and thickness d is 2 n2 d cos theta_2. It turns once every 550 nm or so of D, so that a \
        line between texels cuts the circle: magnitude and phase, which readers may make of the texels, are far smoother. A discrete transform of a \
        few hundred samples, as renderers ship, wraps round: it adds what lies as far beyond its end.",
    bind,
};

fn default_axes(_: &Setting<'_>) -> Vec<Axis> {
    axis("opd", 512, [0.0, 10_000.0], Warp::Linear).into_iter().collect()
}

struct Table {
    opd: usize,
    scale: f64,
    parts: Vec<(usize, bool)>,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    Ok(Box::new(Table {
        opd: spec.coordinate("opd")?,
        scale: spec.params.number("scale")?,
        parts: spec.each(|role| match role {
            Role::Sensitivity { component, imaginary } => Some((component, imaginary)),
            _ => None,
        })?,
    }))
}

impl Baker for Table {
    fn texel(&self, at: &[f64], tolerance: f64) -> Result<Estimate, TexelError> {
        let turns = TAU * at[self.opd];
        // the observer is straight between whole nm
        let breaks: Vec<f64> = (0..=470u32).map(|i| VISIBLE_NM[0] + f64::from(i)).collect();
        let channels = self.parts.len().min(MAX_CHANNELS);
        let e = line::integrate(&breaks, channels, tolerance, &mut |lambda, out| {
            let (sin, cos) = libm::sincos(turns / lambda);
            let eye = cie_xyz(lambda);
            for (o, (component, imaginary)) in out.iter_mut().zip(&self.parts) {
                *o = self.scale * eye[*component] * if *imaginary { -sin } else { cos };
            }
        });
        super::finite(e, channels)
    }

    fn rule(&self) -> String {
        "adaptive Gauss-Kronrod between the whole nm of the observer".to_owned()
    }
}
