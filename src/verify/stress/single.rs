//! Terms in 32 bits against their form of 64 bits, at the same inputs.

use super::{Stress, Worst};
use crate::terms::smith::Ndf;
use crate::terms::{
    beckmann::Beckmann, blinn_phong, charlie, fresnel, ggx::Ggx, gtr, phase, schlick, single,
};
use crate::verify::seeds::Seeds;
use glam::{DVec3, Vec3};

/// A term with a form of 32 bits.
#[derive(Debug)]
pub struct Term {
    /// Id.
    pub id: &'static str,
    /// Names and ranges of its numbers; a direction follows them where it takes one or two.
    inputs: &'static [(&'static str, f64, f64)],
    /// How many directions it takes.
    directions: usize,
    single: fn(&[f32], &[Vec3]) -> f32,
    double: fn(&[f64], &[DVec3]) -> f64,
}

const ALPHA: (&str, f64, f64) = ("alpha", 1e-7, 1.0);
const ALPHAS: &[(&str, f64, f64)] = &[("alpha_x", 1e-7, 1.0), ("alpha_y", 1e-7, 1.0)];
const COSINE: (&str, f64, f64) = ("cos", 1e-8, 1.0);

/// Every term of [`crate::terms::single`].
pub static TERMS: &[Term] = &[
    Term {
        id: "ggx-d:f32",
        inputs: ALPHAS,
        directions: 1,
        single: |x, w| single::ggx_d(x[0], x[1], w[0]),
        double: |x, w| Ggx::new(x[0], x[1]).d(w[0]),
    },
    Term {
        id: "ggx-visibility:f32",
        inputs: ALPHAS,
        directions: 2,
        single: |x, w| single::ggx_visibility(x[0], x[1], w[0], w[1]),
        double: |x, w| Ggx::new(x[0], x[1]).visibility(w[0], w[1]),
    },
    Term {
        id: "beckmann-d:f32",
        inputs: ALPHAS,
        directions: 1,
        single: |x, w| single::beckmann_d(x[0], x[1], w[0]),
        // beyond this exponent the form of 32 bits is 0, and says so
        double: |x, w| {
            let (sx, sy) = (w[0].x / x[0] / w[0].z, w[0].y / x[1] / w[0].z);
            if sx * sx + sy * sy >= 87.0 { 0.0 } else { Beckmann::new(x[0], x[1]).d(w[0]) }
        },
    },
    Term {
        id: "blinn-phong-d:f32",
        inputs: &[("exponent", 1e-3, 1e7)],
        directions: 1,
        single: |x, w| single::blinn_phong_d(x[0], w[0]),
        double: |x, w| blinn_phong::d(x[0], w[0]),
    },
    Term {
        id: "gtr-d:f32",
        inputs: &[ALPHA, ("gamma", 0.5, 3.0)],
        directions: 1,
        single: |x, w| single::gtr_d(x[0], x[1], w[0]),
        double: |x, w| gtr::d(x[0], x[1], w[0]),
    },
    Term {
        id: "charlie-d:f32",
        inputs: &[("roughness", 1e-3, 1.0)],
        directions: 1,
        single: |x, w| single::charlie_d(x[0], w[0]),
        double: |x, w| charlie::d(x[0], w[0]),
    },
    Term {
        id: "schlick:f32",
        inputs: &[("f0", 1e-7, 1.0), COSINE],
        directions: 0,
        single: |x, _| single::schlick(x[0], x[1]),
        double: |x, _| schlick::schlick(x[0], 1.0, x[1]),
    },
    Term {
        id: "fresnel-dielectric:f32",
        inputs: &[COSINE, ("eta", 1e-3, 1e3)],
        directions: 0,
        single: |x, _| single::dielectric(x[0], x[1]),
        double: |x, _| fresnel::dielectric(x[0], x[1]).unpolarised(),
    },
    Term {
        id: "fresnel-conductor:f32",
        inputs: &[COSINE, ("eta", 1e-3, 1e3), ("k", 1e-3, 1e6)],
        directions: 0,
        single: |x, _| single::conductor(x[0], x[1], x[2])[0],
        double: |x, _| fresnel::conductor(x[0], x[1], x[2]).unpolarised(),
    },
    Term {
        id: "conductor-absorptance:f32",
        inputs: &[COSINE, ("eta", 1e-3, 1e3), ("k", 1e-3, 1e6)],
        directions: 0,
        single: |x, _| single::conductor(x[0], x[1], x[2])[1],
        double: |x, _| fresnel::conductor_absorptance(x[0], x[1], x[2]).unpolarised(),
    },
    Term {
        id: "henyey-greenstein:f32",
        inputs: &[("g", -0.999999, 0.999999), ("one_minus_cos", 1e-8, 2.0)],
        directions: 0,
        single: |x, _| single::henyey_greenstein_at(x[0], x[1]),
        double: |x, _| phase::henyey_greenstein_at(x[0], x[1]),
    },
];

/// Points of each term.
const POINTS: usize = 4096;
/// Digits of f32.
const MOST: f64 = 7.22;
/// Below this a number of 32 bits is flushed on some processors.
const SMALLEST: f64 = 1.2e-38;
/// Least digits that a term must keep: half of them.
const LEAST: f64 = 0.5 * MOST;

impl Term {
    #[allow(clippy::cast_possible_truncation, reason = "what is looked at")]
    pub(super) fn stress(&self) -> Stress {
        let mut found = Stress::new("term", self.id);
        let mut seeds = Seeds::new(0x51e6);
        let mut worst = Worst { value: MOST, at: String::new() };
        for i in 0..POINTS {
            let x: Vec<f32> =
                self.inputs.iter().map(|(_, lo, hi)| number(&mut seeds, *lo, *hi, i) as f32).collect();
            let width = f64::from(x.first().copied().unwrap_or(1.0));
            let w: Vec<Vec3> = (0..self.directions).map(|_| direction(&mut seeds, width).as_vec3()).collect();
            let wide: Vec<f64> = x.iter().map(|x| f64::from(*x)).collect();
            let at = || {
                let numbers = self.inputs.iter().zip(&x).map(|((id, ..), v)| format!("{id} = {v:e}"));
                let directions = w.iter().map(|w| format!("direction ({:e}, {:e}, {:e})", w.x, w.y, w.z));
                numbers.chain(directions).collect::<Vec<_>>().join(", ")
            };
            let double = (self.double)(&wide, &w.iter().map(|w| w.as_dvec3()).collect::<Vec<_>>());
            // beyond the numbers of 32 bits there is nothing to keep
            if !(SMALLEST..f64::from(f32::MAX)).contains(&double.abs()) {
                found.refused += 1;
                continue;
            }
            found.points += 1;
            let single = f64::from((self.single)(&x, &w));
            if !single.is_finite() || single < 0.0 {
                found.blame(if single < 0.0 { "negative" } else { "not finite" }, format!("{single:e}"), at);
                continue;
            }
            let off = (single - double).abs() / double.abs();
            let kept = if off > 0.0 { (0.0 - libm::log10(off)).clamp(0.0, MOST) } else { MOST };
            if kept < LEAST {
                let message = format!("{single:e} against {double:e}: {kept:.1} of {MOST} digits");
                found.blame("digits lost", message, at);
            }
            if kept < worst.value {
                worst = Worst { value: kept, at: at() };
            }
        }
        found.single = Some(worst);
        found
    }
}

/// A number of a range: an end, near an end or near 1, uniform, or uniform in logarithms.
fn number(seeds: &mut Seeds, lo: f64, hi: f64, i: usize) -> f64 {
    let u = seeds.unit();
    let small = libm::pow(10.0, -7.0 * seeds.unit());
    let v = match (i + seeds.index(5)) % 5 {
        0 => lo + (hi - lo) * u,
        1 => 1.0 + if u < 0.5 { small } else { -small },
        2 if lo > 0.0 => lo * libm::pow(hi / lo, u),
        3 => hi - (hi - lo) * small,
        _ => {
            if u < 0.5 {
                lo
            } else {
                hi
            }
        }
    };
    v.clamp(lo, hi)
}

/// A direction in the hemisphere, often within a lobe of the given width, or near the horizon.
fn direction(seeds: &mut Seeds, width: f64) -> DVec3 {
    let (u, phi) = (seeds.unit(), std::f64::consts::TAU * seeds.unit());
    let sin = match seeds.index(3) {
        0 => (4.0 * width.abs() * u).min(1.0),
        1 => u,
        _ => return low(libm::pow(10.0, -8.0 * u), phi),
    };
    let (s, c) = libm::sincos(phi);
    DVec3::new(sin * c, sin * s, ((1.0 - sin) * (1.0 + sin)).sqrt())
}

fn low(mu: f64, phi: f64) -> DVec3 {
    let sin = ((1.0 - mu) * (1.0 + mu)).sqrt();
    let (s, c) = libm::sincos(phi);
    DVec3::new(sin * c, sin * s, mu)
}
