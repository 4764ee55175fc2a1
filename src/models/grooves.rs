//! The albedo of V-shaped grooves, whose masking has kinks that no product rule sees.
//!
//! With `wo` fixed, a facet normal at the angle delta from `wo` and the azimuth psi from the macronormal gives
//!
//! ```text
//! E(mu) = int F(c) D(wm) min(1 / mu, 2 z / c, 2 z mu_i / (c mu)) c dwm,  c = cos delta, z = wm.z, mu_i = 2 c z - mu
//! ```
//! On a line of constant delta every kink, and the horizon of `wi`, is a value of z: `c / 2 mu` and `(mu + sqrt(mu² + 4c²)) / 4c`
//! where masking and shadowing begin, `mu / c` where they change places, `mu / 2c` the horizon. The azimuth is split there. The
//! deltas at which such a height comes within reach are those of the plane of incidence and closed: `theta`, `|2 theta - pi/2|`,
//! `|2 theta - pi/2| / 3`, `(2 theta + pi/2) / 3`, `(pi/2 ± theta) / 2`, and `acos(sqrt(2) mu)` where the heights meet; there the inner integral has a square root, which the
//! sine of a panel's coordinate removes. So plain Gauss-Legendre converges geometrically everywhere.

use super::Functional;
use super::microfacet::Fresnel;
use crate::integrate::facet::Row;
use crate::integrate::stop::{Level, Trust, climb_sure};
use crate::integrate::{Estimate, gauss};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI};

/// Numbers of nodes of a panel, in both coordinates.
const ORDERS: [usize; 8] = [4, 6, 9, 13, 18, 24, 32, 48];

/// Growth of the panels in c.
const GROWTH: f64 = 12.0;

/// Trust in them.
const TRUST: Trust = Trust { gain: &[2.4, 2.4, 1.9, 1.6, 1.4], memory: &[0.1, 0.1, 0.02, 0.01, 0.003] };

/// The same for facets on edge, whose masking is met at many heights.
const TRUST_UPRIGHT: Trust =
    Trust { gain: &[2.4, 2.4, 0.12, 0.1, 0.3], memory: &[0.1, 0.1, 0.02, 0.01, 0.003] };

/// Grooves with their facets.
pub(super) struct Grooves<'a> {
    /// Distribution of normals, 1/sr.
    pub d: &'a dyn Fn(DVec3) -> f64,
    /// Heights `wm.z` at which D changes, for facets on edge: the azimuth is split there too.
    pub heights: &'a [f64],
    /// Largest angle of a facet normal from the macronormal that matters.
    pub reach: f64,
    /// Fresnel factor.
    pub fresnel: Fresnel,
}

impl Grooves<'_> {
    /// Integrals over the functionals at a view cosine, to an absolute tolerance.
    pub(super) fn integrate(&self, mu: f64, functionals: &[Functional], tolerance: f64) -> Estimate {
        let first = usize::from(tolerance < 1e-5) + usize::from(tolerance < 1e-8);
        let trust = if self.heights.is_empty() { TRUST } else { TRUST_UPRIGHT };
        climb_sure(trust, first..ORDERS.len(), functionals.len(), tolerance, |j, level| {
            self.sum(mu, functionals, ORDERS[j], level);
        })
    }

    fn sum(&self, mu: f64, functionals: &[Functional], order: usize, level: &mut Level) {
        let s = ((1.0 - mu) * (1.0 + mu)).max(0.0).sqrt();
        let theta = libm::atan2(s, mu);
        let rule = gauss::rule(order);
        for (panel, pair) in breaks(theta, self.reach, self.heights).windows(2).enumerate() {
            let half = 0.5 * (pair[1] - pair[0]);
            for (x, w) in rule.nodes.iter().zip(&rule.weights) {
                // t = sin^2(pi x / 2): square roots at both ends become smooth
                let (sin_x, cos_x) = libm::sincos(FRAC_PI_2 * x);
                let u = pair[0] + 2.0 * half * (sin_x * sin_x);
                let weight = 2.0 * half * PI * sin_x * cos_x * w;
                let (sin_u, cos_u) = libm::sincos(u);
                let (c, sin) = (mu * cos_u - s * sin_u, s * cos_u + mu * sin_u);
                if c > 0.0 && sin > 0.0 {
                    let (inner, count) = self.azimuths(&Row { c, sin, mu, s }, -sin_u, rule);
                    level.count(count);
                    let value = weight * sin * c * self.fresnel.at(c) * inner;
                    for (sum, g) in level.panel(panel).iter_mut().zip(functionals) {
                        *sum += value * g.at(c);
                    }
                }
            }
        }
    }

    /// `int D min(...) dpsi` over both signs of psi; `tilt` is `sin(theta - delta)`.
    fn azimuths(&self, row: &Row, tilt: f64, rule: &gauss::Rule) -> (f64, usize) {
        let Row { mu, c, .. } = *row;
        let least = libm::cos(self.reach).max(0.0).max(0.5 * mu / c);
        let kinks = [0.5 * c / mu, (mu + (mu * mu + 4.0 * c * c).sqrt()) / (4.0 * c), mu / c, least];
        let heights = kinks.iter().chain(self.heights);
        let mut ends: Vec<f64> = heights.map(|z| row.azimuth_of_height(z.max(least))).collect();
        ends.sort_by(f64::total_cmp);
        let (mut from, mut sum, mut count) = (0.0, 0.0, 0);
        for to in ends {
            for (x, w) in rule.nodes.iter().zip(&rule.weights) {
                if to - from <= 0.0 {
                    break;
                }
                let wm = row.normal(tilt, from + (to - from) * x);
                let mu_i = 2.0 * c * wm.z - mu;
                let open = mu.recip().min(2.0 * wm.z / c).min(2.0 * wm.z * mu_i / (c * mu));
                count += 1;
                sum += w * (to - from) * (self.d)(wm) * open.max(0.0);
            }
            from = from.max(to);
        }
        (2.0 * sum, count)
    }
}

/// `-ln` of the part of its peak at which D ends: below the rounding of any sum, also of views that see only steep facets.
pub(super) const DECAY: f64 = 46.0;

/// The angle at which Beckmann's `exp(-tan²/alpha²)` has fallen that far.
pub(super) fn gaussian_reach(alpha: f64) -> f64 {
    libm::atan(alpha * DECAY.sqrt())
}

/// Ends of the panels in `delta - theta`, in order.
fn breaks(theta: f64, reach: f64, heights: &[f64]) -> Vec<f64> {
    let corner = (2.0 * theta - FRAC_PI_2).abs();
    let last = 0.5 * (FRAC_PI_2 + theta);
    let (lo, hi) = ((-theta).max(-reach), (last - theta).min(reach));
    let deltas = [corner, corner / 3.0, (2.0 * theta + FRAC_PI_2) / 3.0, 0.5 * (FRAC_PI_2 - theta)];
    let mut all: Vec<f64> = deltas.map(|d| d - theta).into();
    // where all three heights meet
    all.push(libm::acos((std::f64::consts::SQRT_2 * libm::cos(theta)).min(1.0)) - theta);
    // at grazing views masking changes with c / mu: facets that wo barely sees, on panels that grow with c
    let mu = libm::cos(theta);
    let mut c = 2.0 * mu;
    while c > 0.0 && c < 0.3 {
        if c > 1e-14 {
            all.push(libm::acos(c) - theta);
        }
        // little is seen of the steepest facets
        c *= if c < 1e-9 { GROWTH * GROWTH } else { GROWTH };
    }
    // where the horizon of wi passes a height, and where a circle round wo touches it
    all.extend(heights.iter().map(|z| libm::acos((0.5 * mu / z).min(1.0)) - theta));
    all.extend(heights.iter().map(|z| libm::acos(*z)).flat_map(|t| [t - 2.0 * theta, -t, t]));
    all.extend([0.0, lo, hi]);
    all.retain(|u| (lo..=hi).contains(u));
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}
