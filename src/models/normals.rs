//! Distributions of facet normals by name: what tables of D, of masking and of visibility choose from.
//!
//! One entry of [`NORMALS`] for each function `d-ID` of `list functions` (`tests/registry.rs`); the words that tables take are the ids.
//! Each has one number that sets its width (`alpha`, or the exponent `n` of a cosine), and some a second one, `gamma`.

use super::ParamError;
use crate::cite::{self, Cite};
use crate::integrate::{Estimate, MAX_CHANNELS, View, line};
use crate::terms::beckmann::Beckmann;
use crate::terms::ggx::Ggx;
use crate::terms::smith::Ndf as _;
use crate::terms::student_t::StudentT;
use crate::terms::{blinn_phong, charlie, gtr, sggx, velvet};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// An isotropic distribution of normals.
#[derive(Debug)]
pub struct Normals {
    /// Word of tables; the function is `d-ID`.
    pub id: &'static str,
    /// The number that sets its width: `alpha` or `n`.
    pub width: &'static str,
    /// Widths that it takes.
    pub widths: [f64; 2],
    /// Exponents `gamma` that it takes, if it has one.
    pub gamma: Option<[f64; 2]>,
    /// Where D comes from.
    pub source: (Cite, &'static str),
    /// Where its closed masking comes from; none if that is an integral.
    pub masking: Option<(Cite, &'static str)>,
    d: fn(Shape, DVec3) -> f64,
    /// One over the value at the normal, of cloth at the horizon.
    factor: fn(Shape) -> f64,
    hidden: Option<fn(Shape, DVec3) -> f64>,
    /// `int D cos` over the hemisphere.
    area: fn(Shape) -> f64,
}

/// The numbers of a distribution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shape {
    /// `alpha`, or the exponent of a cosine.
    pub width: f64,
    /// Exponent of the tail.
    pub gamma: f64,
}

const NONE: Normals = Normals {
    id: "",
    width: "alpha",
    widths: [0.0, 2.0],
    gamma: None,
    source: (cite::HEITZ_2014, ""),
    masking: None,
    d: |_, _| 0.0,
    factor: |_| 1.0,
    hidden: None,
    area: |_| 1.0,
};

/// Of slopes: the peak 1 / (pi alpha^2) is at the normal.
const fn slopes(id: &'static str, source: Cite, place: &'static str) -> Normals {
    Normals { id, source: (source, place), factor: |s| PI * s.width * s.width, ..NONE }
}

/// Every distribution, in the order of the words.
pub const NORMALS: &[Normals] = &[
    Normals {
        d: |s, m| Ggx::isotropic(s.width).d(m),
        masking: Some((cite::HEITZ_2014, "Eq. 42 (Smith), Eq. 72 (Lambda of GGX)")),
        hidden: Some(|s, w| Ggx::isotropic(s.width).mu_lambda(w)),
        ..slopes("ggx", cite::WALTER_2007, "Eq. 33 (GGX)")
    },
    Normals {
        d: |s, m| Beckmann::isotropic(s.width).d(m),
        masking: Some((cite::HEITZ_2014, "Eq. 42 (Smith), section 5.2 (Lambda of Beckmann)")),
        hidden: Some(|s, w| Beckmann::isotropic(s.width).mu_lambda(w)),
        ..slopes("beckmann", cite::WALTER_2007, "Eq. 25 (Beckmann)")
    },
    Normals {
        // cos^4 of a smaller cosine is 0 in f64
        d: |s, m| StudentT::isotropic(s.width, s.gamma).d(DVec3::new(m.x, m.y, m.z.max(1e-60))),
        gamma: Some([1.500_001, 1e8]),
        masking: Some((cite::RIBARDIERE_2017, "Eq. 13 to 15 (Lambda)")),
        hidden: Some(|s, w| StudentT::isotropic(s.width, s.gamma).mu_lambda(w)),
        ..slopes("student-t", cite::RIBARDIERE_2017, "Eq. 18, by appleseed")
    },
    Normals {
        id: "gtr",
        gamma: Some([0.0, 10.0]),
        source: (cite::BURLEY_2012, "App. B Eq. 1 to 3"),
        d: |s, m| gtr::d(s.width, s.gamma, m),
        factor: |s| 1.0 / gtr::d(s.width, s.gamma, DVec3::Z),
        ..NONE
    },
    Normals {
        id: "blinn-phong",
        width: "n",
        widths: [0.0, 1e7],
        source: (cite::WALTER_2007, "Eq. 30 (Blinn-Phong)"),
        d: |s, m| blinn_phong::d(s.width, m),
        factor: |s| TAU / (s.width + 2.0),
        ..NONE
    },
    Normals {
        id: "charlie",
        widths: [1e-3, 1.0],
        source: (cite::ESTEVEZ_KULLA_2017, "Eq. 2 (D; alpha is the r of the paper)"),
        d: |s, m| charlie::d(s.width, m),
        factor: |s| TAU / (2.0 + 1.0 / s.width),
        ..NONE
    },
    Normals {
        id: "velvet-2000",
        widths: [1e-4, 2.0],
        source: (cite::ASHIKHMIN_2000, "section 5.1 (alpha is the sigma of the paper)"),
        d: |s, m| velvet::d_2000(s.width, m),
        factor: |s| PI * s.width * s.width,
        ..NONE
    },
    Normals {
        id: "velvet-2007",
        widths: [1e-4, 1.0],
        source: (cite::ASHIKHMIN_PREMOZE_2007, "section 4, with the norm of NeubeltPettineo2013"),
        d: |s, m| velvet::d_2007(s.width, m),
        factor: |s| 0.2 * PI * (1.0 + 4.0 * s.width * s.width),
        ..NONE
    },
    Normals {
        id: "sggx",
        widths: [1e-4, 1.0],
        source: (cite::HEITZ_2015, "Eq. 11 (alpha is sigma of S = diag(1, 1, sigma^2))"),
        d: |s, m| sggx::d(s.width, m),
        factor: |s| PI * s.width,
        area: |s| s.width,
        ..NONE
    },
];

/// The ids of [`NORMALS`].
pub const IDS: [&str; NORMALS.len()] = {
    let mut ids = [""; NORMALS.len()];
    let mut i = 0;
    while i < ids.len() {
        ids[i] = NORMALS[i].id;
        i += 1;
    }
    ids
};

/// Finds a distribution by its id.
#[must_use]
pub fn find(id: &str) -> Option<&'static Normals> {
    NORMALS.iter().find(|n| n.id == id)
}

/// A direction of a cosine, in the plane of the tangent.
#[must_use]
pub fn direction(mu: f64) -> DVec3 {
    View::from(mu).direction()
}

impl Normals {
    /// Refuses numbers that the distribution does not take.
    ///
    /// # Errors
    /// [`ParamError::Range`].
    pub fn check(&self, shape: Shape) -> Result<(), ParamError> {
        let gamma = self.gamma.map(|range| ("gamma", shape.gamma, range));
        for (key, got, [min, max]) in [(self.width, shape.width, self.widths)].into_iter().chain(gamma) {
            if !(min..=max).contains(&got) {
                return Err(ParamError::Range { model: self.id, key, got, min, max });
            }
        }
        Ok(())
    }

    /// D at a cosine, 1/sr; at 0 the limit.
    #[must_use]
    pub fn d(&self, shape: Shape, mu_m: f64) -> f64 {
        // the terms give 0 at the horizon itself, where a facet has no area to show; a table holds the limit
        (self.d)(shape, direction(mu_m.max(f64::MIN_POSITIVE)))
    }

    /// Has its masking a closed form?
    #[must_use]
    pub fn closed(&self) -> bool {
        self.hidden.is_some()
    }

    /// What D is multiplied by to be relative to its value at the normal, of the cloths and SGGX to that at the horizon.
    #[must_use]
    pub fn factor(&self, shape: Shape) -> f64 {
        (self.factor)(shape)
    }

    /// `int D cos` over the hemisphere: 1; sigma of SGGX, a density over the whole sphere.
    #[must_use]
    pub fn area(&self, shape: Shape) -> f64 {
        (self.area)(shape)
    }

    /// Angle from the normal, or from the horizon, within which D changes.
    #[must_use]
    pub fn scale(&self, shape: Shape) -> f64 {
        let alpha = if self.width == "n" { blinn_phong::equivalent_alpha(shape.width) } else { shape.width };
        // a high power falls on a finer scale
        alpha / shape.gamma.clamp(1.0, 10.0)
    }

    /// `mu Lambda(mu) = int D(m) max(0, -w . m) dm / int D cos`, the area of the facets that are turned away, and its error.
    ///
    /// Closed where the distribution has a closed form, and then without an error. Else the azimuth of m is done in closed form and the rest by adaptive
    /// quadrature: with `cos theta_m = s cos x`, `s = sin theta`,
    ///
    /// ```text
    /// mu Lambda = 2 s^2 int_0^(pi/2) D(s cos x) (sin x - mu cos x atan(tan x / mu)) sin x dx
    /// ```
    /// Source: [Heitz2014](crate::cite::HEITZ_2014) Eq. 14 and 41. `tolerance` is absolute, of G1.
    #[must_use]
    pub fn hidden(&self, shape: Shape, mu: f64, tolerance: f64) -> Estimate {
        if let Some(closed) = self.hidden {
            return Estimate {
                error: [0.0; MAX_CHANNELS],
                ..Estimate::exact_one(closed(shape, direction(mu)))
            };
        }
        let sin2 = ((1.0 - mu) * (1.0 + mu)).max(0.0);
        let (sin_w, scale) = (sin2.sqrt(), self.scale(shape));
        let mut breaks = vec![0.0, FRAC_PI_2];
        for start in [scale, mu] {
            let mut x = (0.25 * start).max(1e-12);
            while x < FRAC_PI_2 {
                breaks.extend([x, FRAC_PI_2 - x]);
                x *= 4.0;
            }
        }
        breaks.sort_by(f64::total_cmp);
        let factor = 2.0 * sin2 / self.area(shape);
        // of mu / (mu + M): an error of M counts 1 / (mu + M) times at most
        let asked = tolerance.min(1e-9) * (mu + 0.1 * scale.min(1.0));
        let mut e = line::integrate(&breaks, 1, asked, &mut |x, out| {
            let (sin, cos) = libm::sincos(x);
            out[0] = factor * (self.d)(shape, direction(sin_w * cos)) * turned_away(mu, sin, cos) * sin;
        });
        e.value[0] = e.value[0].max(0.0);
        e
    }
}

/// `sin x - mu cos x atan(tan x / mu) = mu cos x (t - atan t)`, t = tan x / mu, without cancellation for small t.
#[must_use]
pub fn turned_away(mu: f64, sin: f64, cos: f64) -> f64 {
    if sin < 0.25 * mu * cos {
        let t = sin / (mu * cos);
        let t2 = t * t;
        // t^3/3 - t^5/5 + ..., 14 terms are enough below 1/4
        let series = (0..14).rev().fold(0.0, |sum: f64, k| 1.0 / f64::from(2 * k + 3) - t2 * sum);
        mu * cos * t * t2 * series
    } else {
        sin - mu * cos * libm::atan2(sin, mu * cos)
    }
}

/// Smith's masking, and masking and shadowing, of two cosines whose hidden areas `M = mu Lambda` are known.
#[derive(Debug, Clone, Copy)]
pub struct Pair {
    /// Cosines.
    pub mu: [f64; 2],
    /// Hidden areas and their errors.
    pub hidden: [[f64; 2]; 2],
}

impl Pair {
    /// `above / (mu_o mu_i (1 + Lambda_o + Lambda_i))`, or over `mu_o mu_i (1 + Lambda_o)(1 + Lambda_i)`, and its error; 0 / 0 is 0.
    #[must_use]
    pub fn over(&self, correlated: bool, above: f64) -> [f64; 2] {
        let ([o, i], [[m_o, e_o], [m_i, e_i]]) = (self.mu, self.hidden);
        let (below, error) = if correlated {
            (o * i + (o * m_i + i * m_o), o * e_i + i * e_o)
        } else {
            ((o + m_o) * (i + m_i), (o + m_o) * e_i + (i + m_i) * e_o)
        };
        if below > 0.0 { [above / below, (above / below) * (error / below)] } else { [0.0; 2] }
    }
}

/// The cosine between a direction and a facet normal of these cosines, `phi` between their azimuths.
#[must_use]
pub fn between(mu: f64, mu_m: f64, phi: f64) -> f64 {
    direction(mu).dot(View { mu: mu_m, phi }.direction())
}
