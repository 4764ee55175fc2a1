//! Diffusion profiles of three channels, as every table of subsurface scattering takes them: a parameter `profile` and
//! what belongs to it. Lengths in mm.
//!
//! A profile R(r) is the part of a thin beam that leaves per area at distance r. Here it is divided by its total
//! `2 pi int R r dr`: the albedo of skin comes from a texture. [`Profile::total`] holds what was divided by.

use super::{BindError, Source, Spec};
use crate::cite;
use crate::models::{Column, DefaultValue, Param, ParamError, Params};
use crate::terms::burley_diffusion::{self, ShapeFit};
use crate::terms::dipole::{Dipole, internal_reflectance};
use crate::terms::skin;
use std::f64::consts::PI;

/// One number for red, green and blue.
pub type Rgb = [f64; 3];

const COLOURS: [&str; 3] = ["r", "g", "b"];

const fn column(id: &'static str, min: f64, max: f64) -> Column {
    Column { id, min, max }
}

const fn measured(
    id: &'static str,
    unit: &'static str,
    doc: &'static str,
    range: [f64; 2],
    preset: f64,
) -> Param {
    Param { unit, ..Param::number(id, id, doc, range, DefaultValue::Value(preset)) }
}

const ALBEDO: [f64; 2] = [1e-4, 1.0];
const LENGTH: [f64; 2] = [1e-4, 1e4];
const ABSORPTION: [f64; 2] = [0.0, 1e6];
const SCATTERING: [f64; 2] = [1e-6, 1e6];

/// Parameters of a table kind that has a profile.
pub const PARAMS: &[Param] = &[
    Param::choice(
        "profile",
        "which one: the six Gaussians of skin, Gaussians of the caller, normalised diffusion, or the dipole",
        &["skin", "gaussians", "burley", "dipole"],
    ),
    Param::rows(
        "gaussians",
        "of profile gaussians: variance in mm^2 and weights of red, green and blue",
        &[
            column("variance", 1e-8, 1e8),
            column("red", 0.0, 1e6),
            column("green", 0.0, 1e6),
            column("blue", 0.0, 1e6),
        ],
        &[&[1.0, 1.0, 1.0, 1.0]],
    ),
    Param::choice(
        "fit",
        "of profile burley: how the scale follows from the albedo",
        &["dmfp", "searchlight", "diffuse"],
    ),
    measured("albedo_r", "1", "of profile burley: albedo, red", ALBEDO, 0.44),
    measured("albedo_g", "1", "of profile burley: albedo, green", ALBEDO, 0.22),
    measured("albedo_b", "1", "of profile burley: albedo, blue", ALBEDO, 0.13),
    measured("length_r", "mm", "of profile burley: mean free path, red", LENGTH, 3.67),
    measured("length_g", "mm", "of profile burley: mean free path, green", LENGTH, 1.37),
    measured("length_b", "mm", "of profile burley: mean free path, blue", LENGTH, 0.68),
    measured("sigma_a_r", "1/mm", "of profile dipole: absorption, red", ABSORPTION, 0.032),
    measured("sigma_a_g", "1/mm", "of profile dipole: absorption, green", ABSORPTION, 0.17),
    measured("sigma_a_b", "1/mm", "of profile dipole: absorption, blue", ABSORPTION, 0.48),
    measured("sigma_s_r", "1/mm", "of profile dipole: reduced scattering, red", SCATTERING, 0.74),
    measured("sigma_s_g", "1/mm", "of profile dipole: reduced scattering, green", SCATTERING, 0.88),
    measured("sigma_s_b", "1/mm", "of profile dipole: reduced scattering, blue", SCATTERING, 1.01),
    measured("eta", "1", "of profile dipole: relative index of the medium", [1.0, 3.0], 1.3),
];

/// [`PARAMS`] after a parameter of the kind's own.
#[must_use]
pub const fn with(own: Param) -> [Param; 1 + PARAMS.len()] {
    let mut all = [own; 1 + PARAMS.len()];
    let mut i = 0;
    while i < PARAMS.len() {
        all[1 + i] = PARAMS[i];
        i += 1;
    }
    all
}

/// Sources of the profiles.
pub const SOURCES: [Source; 4] = [
    Source::new(cite::DEON_LUEBKE_2007, "Fig. 14-13 (profile skin)").when("profile", &["skin"]),
    Source::new(cite::DEON_LUEBKE_2007, "section 14.4.3 (sums of Gaussians)").when("profile", &["gaussians"]),
    Source::new(cite::CHRISTENSEN_BURLEY_2015, "Eq. 3, 5, 6, 8 and 11 (profile burley)")
        .when("profile", &["burley"]),
    Source::new(cite::JENSEN_2002, "Eq. 2 and 3 (profile dipole)").when("profile", &["dipole"]),
];

/// [`SOURCES`] after those of the kind's own; `M` is `N` + 4.
#[must_use]
pub const fn with_sources<const N: usize, const M: usize>(own: [Source; N]) -> [Source; M] {
    let mut all = [SOURCES[0]; M];
    let mut i = 0;
    while i < M {
        all[i] = if i < N { own[i] } else { SOURCES[i - N] };
        i += 1;
    }
    all
}

/// What the notes of a kind say of the profiles.
pub const NOTES: &str = "Profiles, lengths in mm: skin (six Gaussians, white), gaussians (rows of variance and three weights), burley (albedo and \
    length a channel), dipole (coefficients a channel). The defaults of the last two are skin1 of Jensen and others 2001; 3.67, 1.37 and 0.68 mm \
    are its diffuse mean free paths.";

/// A profile of each channel, divided by its total.
#[derive(Debug, Clone, PartialEq)]
pub enum Profile {
    /// `sum w exp(-r^2/(2v))/(2 pi v)`: variance and the weights of the channels, which sum to 1.
    Gaussians {
        /// Variance in mm², and weights.
        lobes: Vec<(f64, Rgb)>,
        /// Sum of the weights as given.
        total: Rgb,
    },
    /// [`burley_diffusion::profile`]: `l/s` in mm, and the albedo.
    Burley {
        /// `l/s`.
        scale: Rgb,
        /// Albedo.
        total: Rgb,
    },
    /// [`Dipole`].
    Dipole([Dipole; 3]),
}

impl Profile {
    /// The profile of a spec.
    ///
    /// # Errors
    /// [`BindError::Param`] for Gaussians of which some channel has no weight.
    pub fn new(spec: &Spec) -> Result<Profile, BindError> {
        let p = &spec.params;
        let rgb = |stem: &str| -> Result<Rgb, ParamError> {
            let [r, g, b] = COLOURS.map(|c| p.number(&format!("{stem}_{c}")));
            Ok([r?, g?, b?])
        };
        match p.choice("profile")? {
            "burley" => {
                let (total, length) = (rgb("albedo")?, rgb("length")?);
                let fit = fit(p)?;
                let scale = [0, 1, 2].map(|c| length[c] / burley_diffusion::scale(fit, total[c]));
                Ok(Profile::Burley { scale, total })
            }
            "dipole" => {
                let (sigma_a, sigma_s, eta) = (rgb("sigma_a")?, rgb("sigma_s")?, p.number("eta")?);
                Ok(Profile::Dipole([0, 1, 2].map(|c| Dipole {
                    sigma_a: sigma_a[c],
                    sigma_s: sigma_s[c],
                    eta,
                })))
            }
            "gaussians" => Ok(gaussians(spec.kind.id, p.rows("gaussians")?)?),
            _ => {
                let weights = |i: usize| skin::WEIGHTS.map(|w| w[i]);
                let lobes = skin::VARIANCES.iter().enumerate().map(|(i, &v)| (v, weights(i))).collect();
                Ok(Profile::Gaussians { lobes, total: [1.0; 3] })
            }
        }
    }

    /// `2 pi int R r dr` before the division.
    #[must_use]
    pub fn total(&self) -> Rgb {
        match self {
            Profile::Gaussians { total, .. } | Profile::Burley { total, .. } => *total,
            Profile::Dipole(dipoles) => dipoles.map(|d| d.total()),
        }
    }

    /// R(r), 1/mm². Guard: normalised diffusion at r = 0, where it is infinite, has the value at 1e-300 of its length.
    #[must_use]
    pub fn at(&self, r: f64) -> Rgb {
        match self {
            Profile::Gaussians { lobes, .. } => sum(lobes, |v| libm::exp(-0.5 * r * r / v) / (2.0 * PI * v)),
            Profile::Burley { scale, .. } => {
                scale.map(|l| burley_at(r.max(1e-300 * l), l) / r.max(1e-300 * l))
            }
            Profile::Dipole(dipoles) => dipoles.map(|d| d.reflectance(r) / d.total()),
        }
    }

    /// `2 pi r R(r)`, 1/mm: the density of the distance r; finite at 0.
    #[must_use]
    pub fn ring(&self, r: f64) -> Rgb {
        match self {
            Profile::Burley { scale, .. } => scale.map(|l| 2.0 * PI * burley_at(r, l)),
            _ => self.at(r).map(|v| 2.0 * PI * r * v),
        }
    }

    /// Part of the light that leaves inside radius r.
    ///
    /// For the dipole `alpha'/2 sum exp(-sigma z) - z exp(-sigma d)/d`, without the difference:
    /// `exp(-sigma z)(r^2/(d (d + z)) + (z/d)(1 - exp(-sigma r^2/(d + z))))`.
    #[must_use]
    pub fn inside(&self, r: f64) -> Rgb {
        match self {
            Profile::Gaussians { lobes, .. } => sum(lobes, |v| -libm::expm1(-0.5 * r * r / v)),
            Profile::Burley { scale, .. } => scale.map(|l| burley_diffusion::cdf(r / l)),
            Profile::Dipole(dipoles) => dipoles.map(|dipole| {
                let (sigma, sources) = sources(&dipole);
                let term = |z: f64| {
                    let d = libm::hypot(r, z);
                    let apart = r * r / (d + z);
                    libm::exp(-sigma * z) * (apart / d - z / d * libm::expm1(-sigma * apart))
                };
                half_part(&dipole) * (term(sources[0]) + term(sources[1])) / dipole.total()
            }),
        }
    }

    /// Part of the light that leaves beyond radius r: `1 - inside`, with its own digits.
    #[must_use]
    pub fn outside(&self, r: f64) -> Rgb {
        match self {
            Profile::Gaussians { lobes, .. } => sum(lobes, |v| libm::exp(-0.5 * r * r / v)),
            Profile::Burley { scale, .. } => {
                scale.map(|l| 0.25 * (libm::exp(-r / l) + 3.0 * libm::exp(-r / (3.0 * l))))
            }
            Profile::Dipole(dipoles) => dipoles.map(|dipole| {
                let (sigma, sources) = sources(&dipole);
                let term = |z: f64| {
                    let d = libm::hypot(r, z);
                    z / d * libm::exp(-sigma * d)
                };
                half_part(&dipole) * (term(sources[0]) + term(sources[1])) / dipole.total()
            }),
        }
    }

    /// Radii between which the profile changes its shape, smallest first, by factors of 4 at most: breaks for quadrature.
    #[must_use]
    pub fn scales(&self) -> Vec<f64> {
        let [least, most] = self.extent();
        let mut radii = vec![least];
        let mut r = least;
        while r < most {
            r *= 4.0;
            radii.push(r);
        }
        radii
    }

    /// A length below which every channel is flat (or falls as 1/r), and one beyond which less than 1e-17 leaves.
    fn extent(&self) -> [f64; 2] {
        let bounds = |lengths: &mut dyn Iterator<Item = [f64; 2]>| {
            lengths.fold([f64::INFINITY, 0.0], |b, l| [b[0].min(l[0]), f64::max(b[1], l[1])])
        };
        match self {
            Profile::Gaussians { lobes, .. } => {
                bounds(&mut lobes.iter().map(|(v, _)| [v.sqrt(), 9.0 * v.sqrt()]))
            }
            Profile::Burley { scale, .. } => bounds(&mut scale.iter().map(|&l| [l, 120.0 * l])),
            Profile::Dipole(dipoles) => bounds(&mut dipoles.iter().map(|d| {
                let (sigma, z) = sources(d);
                [z[0], (z[1] + 40.0 / sigma.max(1e-300)).min(1e17 * z[1])]
            })),
        }
    }

    /// Does R grow without bound towards r = 0?
    #[must_use]
    pub fn is_singular(&self) -> bool {
        matches!(self, Profile::Burley { .. })
    }
}

/// `r R(r)` of normalised diffusion with albedo 1 and `l/s` = `length`.
fn burley_at(r: f64, length: f64) -> f64 {
    let x = r / length;
    (libm::exp(-x) + libm::exp(-x / 3.0)) / (8.0 * PI * length)
}

fn sum(lobes: &[(f64, Rgb)], f: impl Fn(f64) -> f64) -> Rgb {
    let mut out = [0.0; 3];
    for (variance, weights) in lobes {
        let value = f(*variance);
        for (o, w) in out.iter_mut().zip(weights) {
            *o += w * value;
        }
    }
    out
}

/// `alpha'/2`.
fn half_part(dipole: &Dipole) -> f64 {
    0.5 * dipole.sigma_s / (dipole.sigma_a + dipole.sigma_s)
}

/// Effective extinction, and the depths of the source and its image, as [`Dipole::reflectance`] has them.
fn sources(dipole: &Dipole) -> (f64, [f64; 2]) {
    let sigma_t = dipole.sigma_a + dipole.sigma_s;
    let f = internal_reflectance(dipole.eta);
    let image = 1.0 + 4.0 / 3.0 * (1.0 + f) / (1.0 - f);
    ((3.0 * dipole.sigma_a * sigma_t).sqrt(), [1.0 / sigma_t, image / sigma_t])
}

fn fit(p: &Params) -> Result<ShapeFit, ParamError> {
    Ok(match p.choice("fit")? {
        "searchlight" => ShapeFit::Searchlight,
        "diffuse" => ShapeFit::Diffuse,
        _ => ShapeFit::DiffuseMeanFreePath,
    })
}

fn gaussians(kind: &'static str, rows: &[Vec<f64>]) -> Result<Profile, ParamError> {
    let mut total = [0.0; 3];
    for row in rows {
        for (t, w) in total.iter_mut().zip(&row[1..]) {
            *t += w;
        }
    }
    if !total.iter().all(|t| *t > 0.0) {
        let why = "every channel of `gaussians` needs a weight above 0".to_owned();
        return Err(ParamError::Together { model: kind, why });
    }
    let weights = |row: &[f64]| [0, 1, 2].map(|c| row[1 + c] / total[c]);
    Ok(Profile::Gaussians { lobes: rows.iter().map(|row| (row[0], weights(row))).collect(), total })
}
