//! Oren-Nayar, the full model: masking with all its terms, and one interreflection between facing facets.
//!
//! Parameters as in [`oren_nayar`](super::oren_nayar); `rho` enters twice, since light that met two facets has lost
//! twice. The fit dips below 0 where both directions graze from opposite sides; the value is clamped at 0 there.
//!
//! Recipe: `model = "oren-nayar-full"`, `params = { rho = 0.8, sigma = 0.35 }`.

use super::lobes::{Diffuse, Reflector};
use super::oren_nayar::{RHO, SIGMA};
use super::{Alias, Brdf, Known, KnownValue, Laws, ModelInfo, ParamError, Params};
use crate::cite;
use crate::integrate::{Chart, Estimate, line};
use crate::math::frame;
use glam::DVec3;
use std::f64::consts::{FRAC_1_PI, FRAC_PI_2, PI};

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "oren-nayar-full",
    title: "Oren-Nayar, full",
    formula: "f = max(0, rho / pi (C1 + c C2 tan(b) + (1 - |c|) C3 tan((a + b) / 2)) \
        + 0.17 rho^2 / pi s2 / (s2 + 0.13) (1 - c (2 b / pi)^2)), c = cos(phi_i - phi_o), s2 = sigma^2, \
        a = max(theta_i, theta_o), b = min(theta_i, theta_o), C1 = 1 - 0.5 s2 / (s2 + 0.33), \
        C2 = 0.45 s2 / (s2 + 0.09) (sin(a) - (2 b / pi)^3 if c < 0), C3 = 0.125 s2 / (s2 + 0.09) (4 a b / pi^2)^2",
    sources: &[
        (cite::OREN_NAYAR_1994, "the functional approximation of the full model"),
        (cite::MITSUBA, "`roughdiffuse.cpp`, without its fast form: the same form"),
    ],
    params: &[RHO, SIGMA],
    laws: Laws { reciprocal: true, passive: false, isotropic: true },
    notes: "Not passive: E reaches 1.050 (rho = 1, sigma near 0.3, grazing). The formula is negative for sigma > 0.68 at low rho \
        (-0.16 rho / pi at sigma = 1, both directions grazing, opposite azimuths) and is clamped at 0. \
        Kinks at mu_i = mu_o and at azimuth pi/2, and where the clamp begins.",
    also: &[Alias { name: "oren_nayar_full", set: &[] }],
    known: &[
        Known {
            what: KnownValue::Value([0.25, 0.5, 1.0, 2.75]),
            params: &[("rho", "1"), ("sigma", "0.25")],
            value: 0.302_974_780_364_264_56,
            relative: 1e-13,
            source: "formula in 50-digit arithmetic",
        },
        Known {
            what: KnownValue::Albedo(1.0),
            params: &[("rho", "1"), ("sigma", "0.25")],
            value: 0.975_576_970_799_900_7,
            relative: 1e-12,
            source: "closed form: E(1) = rho C1 + 0.17 rho^2 s2 / (s2 + 0.13)",
        },
    ],
    splits: false,
    build,
};

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    let (rho, sigma) = (params.number("rho")?, params.number("sigma")?);
    let s2 = sigma * sigma;
    let steep = s2 / (s2 + 0.09);
    Ok(Box::new(Diffuse(OrenNayarFull {
        rho,
        c1: 1.0 - 0.5 * s2 / (s2 + 0.33),
        c2: 0.45 * steep,
        c3: 0.125 * steep,
        twice: 0.17 * rho * s2 / (s2 + 0.13),
    })))
}

/// Elevations of the view below which nothing is seen of its layer.
const LEAST: f64 = 1e-18;

/// Ratio of the ends of panels: a panel keeps as far from the pole as the half of its length.
const STEP: f64 = 16.0;

/// The coefficients without their angles; `twice` is the interreflection over rho.
#[derive(Debug)]
struct OrenNayarFull {
    rho: f64,
    c1: f64,
    c2: f64,
    c3: f64,
    twice: f64,
}

/// A polar angle by its complement, sine and cosine, each to its own digits: the angle itself has none left of a grazing cosine.
#[derive(Debug, Clone, Copy)]
struct Height {
    elevation: f64,
    sin: f64,
    cos: f64,
}

impl Height {
    fn of(w: DVec3) -> Height {
        let sin = frame::sin_theta(w);
        Height { elevation: libm::atan2(w.z, sin), sin, cos: w.z }
    }

    fn above(elevation: f64) -> Height {
        let (cos, sin) = libm::sincos(elevation);
        Height { elevation, sin, cos }
    }
}

/// What the formula asks of two polar angles, a the larger one.
struct Pair {
    sin_a: f64,
    tan_b: f64,
    /// `tan((a + b) / 2)`.
    tan_mean: f64,
    /// `2 b / pi`.
    turn: f64,
    /// `sin a - (2 b / pi)^3`, without cancellation where both graze.
    far: f64,
    /// `4 a b / pi^2`.
    area: f64,
}

impl Pair {
    fn new(o: Height, i: Height) -> Pair {
        let (a, b) = if o.cos < i.cos { (o, i) } else { (i, o) };
        let rest = |h: Height| 2.0 * FRAC_1_PI * h.elevation;
        let (q, turn) = (rest(b), 1.0 - rest(b));
        Pair {
            sin_a: a.sin,
            tan_b: b.sin / b.cos,
            tan_mean: (a.sin + b.sin) / (a.cos + b.cos),
            turn,
            far: q * (3.0 - 3.0 * q + q * q) - a.cos * a.cos / (1.0 + a.sin),
            area: (1.0 - rest(a)) * turn,
        }
    }
}

impl OrenNayarFull {
    /// The smallest value over rho / pi: both directions grazing from opposite sides, where `sin a - (2b/pi)^3` over
    /// the height is 6/pi.
    fn least(&self) -> f64 {
        self.c1 - self.c2 * 6.0 * FRAC_1_PI + 2.0 * self.twice
    }

    /// What the formula is over rho / pi as a function of c alone, `k0 + k1 c`, for c >= 0 and for c < 0.
    fn row(&self, o: Height, i: Height) -> (f64, [f64; 2]) {
        let Pair { sin_a, tan_b, tan_mean, turn, far, area } = Pair::new(o, i);
        let (tan, between) = (self.c2 * tan_b, self.c3 * area * area * tan_mean);
        let twice = self.twice * turn * turn;
        let near = tan * sin_a - between - twice;
        let far = tan * far + between - twice;
        (self.c1 + between + self.twice, [near, far])
    }

    /// `2 int_0^pi max(0, k0 + k1 c) dphi`, between the azimuths at which either half changes its sign.
    fn circle(&self, o: Height, i: Height) -> f64 {
        let (k0, slopes) = self.row(o, i);
        let mut sum = 0.0;
        for (k1, [from, to]) in slopes.into_iter().zip([[0.0, FRAC_PI_2], [FRAC_PI_2, PI]]) {
            let root = -k0 / k1;
            let turn = if root.abs() < 1.0 { libm::acos(root).clamp(from, to) } else { to };
            for [lo, hi] in [[from, turn], [turn, to]] {
                let value = k0 * (hi - lo) + k1 * (libm::sin(hi) - libm::sin(lo));
                sum += value.max(0.0);
            }
        }
        2.0 * sum
    }

    /// The formula before the clamp.
    fn unclamped(&self, wo: DVec3, wi: DVec3) -> f64 {
        let (o, i) = (Height::of(wo), Height::of(wi));
        let Pair { sin_a, tan_b, tan_mean, turn, far, area } = Pair::new(o, i);
        let sines = o.sin * i.sin;
        // at the normal the azimuth is undefined, and every term that has it is 0
        let c = if sines > 0.0 { ((wo.x * wi.x + wo.y * wi.y) / sines).clamp(-1.0, 1.0) } else { 0.0 };
        let single = self.c1
            + c * self.c2 * (if c < 0.0 { far } else { sin_a }) * tan_b
            + (1.0 - c.abs()) * self.c3 * area * area * tan_mean;
        self.rho * FRAC_1_PI * (single + self.twice * (1.0 - c * turn * turn))
    }
}

impl Reflector for OrenNayarFull {
    fn f(&self, wo: DVec3, wi: DVec3) -> f64 {
        self.unclamped(wo, wi).max(0.0)
    }

    /// The azimuth is closed, also where the clamp acts; the height of wi is left.
    fn reduced(&self, mu_o: f64, tolerance: f64) -> Option<Estimate> {
        let o = Height::of(frame::from_mu(mu_o));
        let scale = self.rho * FRAC_1_PI;
        // by the elevation, whose small values keep their digits; the mean tangent has its pole at minus that of the view
        let mut breaks = vec![0.0];
        let mut end = o.elevation;
        while end > LEAST && end < FRAC_PI_2 {
            breaks.push(end);
            end *= STEP;
        }
        breaks.push(FRAC_PI_2);
        let e = line::integrate(&breaks, 1, tolerance, &mut |elevation, out| {
            let i = Height::above(elevation);
            out[0] = scale * i.sin * i.cos * self.circle(o, i);
        });
        Some(e)
    }

    /// None where the clamp acts: its edge runs across every panel.
    fn chart(&self) -> Option<Chart> {
        (self.least() > 0.0).then_some(Chart::Folded)
    }
}
