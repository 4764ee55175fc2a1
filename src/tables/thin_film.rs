//! Iridescence: the colour of a surface under a thin film, over angle and thickness of the film.

use super::default_axes::axis;
use super::metal::{ETA, Index, NK};
use super::role::Band;
use super::spectrum::{self, Spectrum};
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Setting, Source, Spec, TableInfo, TexelError,
};
use crate::cite;
use crate::grid::{Axis, Warp};
use crate::integrate::{Estimate, MAX_CHANNELS};
use crate::models::{DefaultValue, Param, Params};
use crate::terms::metals;
use crate::terms::thin_film::{self, Film};

const fn colour(id: &'static str, meaning: &'static str, role: Role) -> ChannelInfo {
    ChannelInfo { id, meaning, range: [-0.5, 1.5], role }
}

/// Integrated over the spectrum.
fn is_daylight(role: Role) -> bool {
    matches!(role, Role::FilmColour(_))
}

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "thin-film",
    title: "Thin-film iridescence",
    formula: "int R(lambda) D65 (x, y, z) dlambda to linear sRGB, R = |r12 + r23 e^(i delta)|^2 / |1 + r12 r23 e^(i delta)|^2, delta = 4 pi n2 d cos theta_2 / lambda",
    sources: &[
        Source::new(cite::BELCOUR_BARLA_2017, "section 3 (Airy)").of(is_daylight),
        Source::new(cite::BELCOUR_BARLA_2017, "Eq. 10, by Cycles (series)")
            .of(|role| matches!(role, Role::FilmSeries(_))),
        Source::new(cite::BORN_WOLF_1999, "section 7.6.1"),
        Source::new(cite::CIE_11664_1, "Table 1, CIE 1931 observer").of(is_daylight),
        Source::new(cite::CIE_11664_2, "Table B.1, D65").of(is_daylight),
    ],
    coordinates: &["mu", "film"],
    layouts: &[
        Layout {
            id: "srgb",
            doc: "linear sRGB of reflected daylight (D65), a perfect mirror being 1; integrated over the spectrum",
            channels: &[
                colour("film.r", "red of int R D65 (x, y, z) dlambda", Role::FilmColour(Band::Red)),
                colour("film.g", "green of it", Role::FilmColour(Band::Green)),
                colour("film.b", "blue of it", Role::FilmColour(Band::Blue)),
            ],
        },
        Layout {
            id: "series",
            doc: "linear RGB of equal-energy white by the published series of a few orders, as renderers evaluate it",
            channels: &[
                colour("film.r", "red of the series", Role::FilmSeries(Band::Red)),
                colour("film.g", "green of the series", Role::FilmSeries(Band::Green)),
                colour("film.b", "blue of the series", Role::FilmSeries(Band::Blue)),
            ],
        },
    ],
    mix: Mix::Layouts,
    model: ModelUse::None,
    params: &[
        Param::choice(
            "metal",
            "below the film: `index`, n3 and k3 as given; a measured metal; or `rows`, those of `nk`",
            &["index", "au", "ag", "al", "cu", "fe", "ni", "ti", "w", "rows"],
        ),
        Param::number("n2", "n_2", "index of the film", [1.0, 10.0], DefaultValue::Value(1.33)),
        Param::number("n3", "n_3", "index below the film, real part", [0.0, 1e5], DefaultValue::Value(1.5))
            .coloured(),
        Param::number(
            "k3",
            "k_3",
            "extinction coefficient below the film",
            [0.0, 100.0],
            DefaultValue::Value(0.0),
        )
        .coloured(),
        Param::number(
            "orders",
            "m",
            "of layout series: orders summed",
            [1.0, 100.0],
            DefaultValue::Value(2.0),
        ),
        ETA,
        NK,
    ],
    laws: &["range", "honest"],
    axes: default_axes,
    least_tolerance: |_| 0.0,
    blended: true,
    notes: "Vacuum above unless eta says otherwise, thickness in nm. Over a metal: metal = \"al\"; layout series reads its index at 650, 550 and 450 nm, a film for \
        each colour, as it does lists of three for n3 and k3. Colours may leave [0, 1] a little: renderers clamp. Defaults: water on glass; soap n2 1.33 n3 1; \
        oil on water n2 1.5 n3 1.33; anodised titanium n2 2.5 n3 2.5 k3 3.4. Fringes of films above 2 um are finer than most grids.",
    bind,
};

fn default_axes(_: &Setting<'_>) -> Vec<Axis> {
    let axes = [axis("mu", 64, [0.0, 1.0], Warp::Power(0.5)), axis("film", 256, [0.0, 1200.0], Warp::Linear)];
    axes.into_iter().flatten().collect()
}

struct Table {
    mu: usize,
    film: usize,
    /// Axes of the indices, where they are swept: n2, n3, eta.
    axes: [Option<usize>; 3],
    n2: f64,
    eta: f64,
    params: Params,
    /// Of the series; none integrates the spectrum.
    orders: Option<u32>,
    /// Split at the rows of a metal.
    own: Option<Spectrum>,
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "in [1, 100]")]
fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    let [n2, orders, eta] = spec.params.numbers(["n2", "orders", "eta"])?;
    let index = Index::of(&spec.params, ["n3", "k3"])?;
    if let Index::Given { n, k } = index
        && n.iter().zip(k).any(|(n, k)| n + k <= 0.0)
        && spec.axis("n3").is_none()
    {
        let why = "n3 and k3 are both 0: nothing can be".to_owned();
        return Err(crate::models::ParamError::Together { model: spec.kind.id, why }.into());
    }
    let series = spec.roles().iter().any(|role| matches!(role, Role::FilmSeries(_)));
    if series {
        let [red, _, blue] = metals::RGB_NM;
        index.covers(spec.kind.id, [blue, red])?;
    } else {
        index.spectral(spec.kind.id)?;
    }
    let kinks = index.kinks();
    Ok(Box::new(Table {
        mu: spec.coordinate("mu")?,
        film: spec.coordinate("film")?,
        axes: [spec.axis("n2"), spec.axis("n3"), spec.axis("eta")],
        n2,
        eta,
        params: spec.params.clone(),
        orders: series.then(|| orders.round() as u32),
        own: (!series && !kinks.is_empty()).then(|| spectrum::daylight_with(kinks)),
    }))
}

impl Table {
    /// The film at a wavelength, or of a colour, in the indices relative to what lies above: it is thicker by that index.
    fn film(&self, index: &Index<'_>, at: &[f64], colour: usize, lambda_nm: f64) -> Film {
        let swept = |i: usize, fixed: f64| self.axes[i].map_or(fixed, |axis| at[axis]);
        let (n, k) = index.at(colour, lambda_nm);
        let n = if matches!(index, Index::Given { .. }) { swept(1, n) } else { n };
        let eta = swept(2, self.eta);
        Film { n2: swept(0, self.n2) / eta, n3: n / eta, k3: k / eta, d_nm: at[self.film] * eta }
    }
}

impl Baker for Table {
    fn texel(&self, at: &[f64], tolerance: f64) -> Result<Estimate, TexelError> {
        let (index, mu) = (Index::of(&self.params, ["n3", "k3"])?, at[self.mu]);
        if let Some(orders) = self.orders {
            let mut value = [0.0; MAX_CHANNELS];
            for (colour, v) in value.iter_mut().enumerate().take(3) {
                let film = self.film(&index, at, colour, metals::RGB_NM[colour]);
                *v = thin_film::rgb(&film, mu, orders)[colour];
            }
            return super::closed_form(value, 3);
        }
        let airy = &mut |lambda| thin_film::airy(&self.film(&index, at, 0, lambda), mu, lambda).unpolarised();
        let spectrum = self.own.as_ref().unwrap_or_else(|| spectrum::daylight());
        super::finite(spectrum.colour(tolerance, airy), 3)
    }

    fn rule(&self) -> String {
        if self.orders.is_some() { "closed form" } else { spectrum::DAYLIGHT_RULE }.to_owned()
    }
}
