//! Smith GGX at four views at a time: the half-vector chart and the model in one kernel with one division and one square root a node.
//!
//! The nodes, panels and levels are those of [`half_vector`](crate::integrate::half_vector), so that the values differ from those of the chart by rounding alone where
//! four views share their scales. What follows is [`Walter2007](crate::cite::WALTER_2007) Eq. 20 and 33 in half-angle tangents with
//! everything that cancels left out. Below the middle of a row, with `t = tan(theta_m / 2)`:
//!
//! ```text
//! p = 1 + t^2, m = 1 - t^2, v = (2 a t + mu m) / p, mu_i = big / p^2, big = 2 v p m - mu p^2
//! q = a2 m^2 + 4 t^2 = p^2 (a2 cos^2 + sin^2)
//! S = p^2 sqrt(mu_i^2 + a2 (1 - mu_i^2)), X = mu S + big s_o  (correlated), (big + S)(mu + s_o) / 2  (separable)
//! D V mu_i dwi = a2/pi * 4 v p t big p / (q^2 X) dt dphi
//! ```
//! and above it the same in `u = tan((t_max - theta_m) / 2)`.

use super::Masking;
use crate::integrate::four::{self, Channel, PANELS, Panels};
use crate::integrate::graded::Shared;
use crate::integrate::half_vector::{Scales, Side};
use crate::integrate::ladder::{LEVELS, first_level};
use crate::integrate::{Chart, Estimate, FacetLobe, MAX_CHANNELS};
use crate::math::lanes::{Kernel, LANES, Lanes, wide};
use crate::models::Functional;

/// Views and widths below these are left to the chart, which is careful there.
const LEAST_MU: f64 = 1e-9;
const LEAST_ALPHA: f64 = 1e-7;

/// What the kernel must know of a model: Smith GGX of one width under Schlick's factor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Facets {
    /// Width.
    pub alpha: f64,
    /// How the masking of the two directions is combined.
    pub masking: Masking,
    /// Reflectance at normal incidence.
    pub f0: f64,
    /// Reflectance at grazing incidence.
    pub f90: f64,
}

impl Facets {
    /// The weights of a functional on `int f mu_i dwi` of the white model and the same times (1 - v)^5, if they suffice.
    fn weights(&self, g: Functional) -> Option<[f64; 2]> {
        let white = (self.f0 - self.f90).abs() == 0.0;
        Some(match g {
            Functional::One => [self.f0, self.f90 - self.f0],
            Functional::Schlick if white => [0.0, self.f0],
            Functional::SchlickComplement if white => [self.f0, -self.f0],
            _ => return None,
        })
    }

    fn serves(&self, mu: f64) -> bool {
        self.alpha >= LEAST_ALPHA && mu >= LEAST_MU
    }
}

/// Integrates functionals of four models at four views; `None` if the kernel does not serve one of them.
#[must_use]
pub fn integrate(
    models: [Facets; LANES],
    mu: [f64; LANES],
    functionals: &[Functional],
    tolerance: f64,
) -> Option<[Estimate; LANES]> {
    let one_kind = models.iter().all(|m| m.masking == models[0].masking);
    if !one_kind || !models.iter().zip(mu).all(|(m, mu)| m.serves(mu)) {
        return None;
    }
    let mut channels = [[Lanes::all(0.0); 2]; MAX_CHANNELS];
    for (channel, g) in channels.iter_mut().zip(functionals) {
        for (lane, model) in models.iter().enumerate() {
            let [one, schlick] = model.weights(*g)?;
            (channel[0].0[lane], channel[1].0[lane]) = (one, schlick);
        }
    }
    let channels: &[Channel] = &channels[..functionals.len()];
    let scales = |m: &Facets, mu| Scales::new(mu, [m.alpha, f64::INFINITY, 3.0 * m.alpha], f64::INFINITY);
    let scales = models[1..]
        .iter()
        .zip(&mu[1..])
        .fold(scales(&models[0], mu[0]), |all, (m, mu)| all.and(scales(m, *mu)));
    let trust = Chart::facets(FacetLobe::smith([models[0].alpha; 2], f64::INFINITY)).trust();
    let views = Views::new(Lanes(mu), Lanes(models.map(|m| m.alpha)), models[0].masking);
    Some(four::climb(trust, first_level(tolerance)..LEVELS.len(), channels, tolerance, |j| {
        let sides = scales.sides(LEVELS[j]);
        let count =
            |s: &Side| s.azimuth.rule.node.len() * (s.peak.rule.node.len() + s.horizon.rule.node.len());
        let evaluations = sides.iter().map(count).sum::<usize>();
        let panels = wide(Level { views, sides });
        (panels, u32::try_from(evaluations).unwrap_or(u32::MAX))
    }))
}

/// Four views of four models.
#[derive(Debug, Clone, Copy)]
struct Views {
    mu: Lanes,
    sine: Lanes,
    /// alpha squared.
    a2: Lanes,
    /// `sqrt(mu^2 + a2 (1 - mu^2))`.
    root: Lanes,
    correlated: bool,
}

impl Views {
    fn new(mu: Lanes, alpha: Lanes, masking: Masking) -> Views {
        let sine2 = (1.0 - mu) * (1.0 + mu);
        let a2 = alpha * alpha;
        let root = (mu * mu + sine2 * a2).sqrt();
        Views {
            mu,
            sine: sine2.map(|x| x.max(0.0)).sqrt(),
            a2,
            root,
            correlated: masking == Masking::Correlated,
        }
    }

    /// `X` of the module's formula, from S and the height of wi on the same scale.
    #[inline(always)]
    fn masked(&self, s: Lanes, height: Lanes) -> Lanes {
        if self.correlated {
            self.mu * s + height * self.root
        } else {
            0.5 * (height + s) * (self.mu + self.root)
        }
    }
}

/// The sums of one level.
struct Level {
    views: Views,
    sides: [Side; 2],
}

impl Kernel for Level {
    type Output = Panels;

    #[inline(always)]
    fn run(self) -> Panels {
        let mut panels = [[Lanes::all(0.0); 2]; PANELS];
        for (i, side) in self.sides.iter().enumerate() {
            let (mut near, mut far) = ([Lanes::all(0.0); 2], [Lanes::all(0.0); 2]);
            let azimuth = side.azimuth;
            for (&sine, &weight) in azimuth.quarter_sine.iter().zip(&azimuth.rule.weight) {
                let row = Row::new(&self.views, if side.front { sine } else { -sine });
                // 8 of dwi, pi/2 of the panel, 2 for the mirror half of the azimuth, a2/pi of D
                let width = row.quarter * self.views.a2 * (8.0 * weight);
                peak(&self.views, &row, side.peak, width, &mut near);
                horizon(&self.views, &row, side.horizon, width, &mut far);
            }
            (panels[2 * i], panels[2 * i + 1]) = (near, far);
        }
        panels
    }
}

/// Geometry of one azimuth; see [`half_vector`](crate::integrate::half_vector).
struct Row {
    along: Lanes,
    r: Lanes,
    half: Lanes,
    rest: Lanes,
    quarter: Lanes,
}

impl Row {
    /// The sign of the azimuth's cosine is the same in all lanes.
    #[inline(always)]
    fn new(views: &Views, cos_phi: f64) -> Row {
        let (along, mu) = (views.sine * cos_phi, views.mu);
        let r = (along * along + mu * mu).sqrt();
        let sum = r + along.map(f64::abs);
        let near = mu / (2.0 * r * sum).sqrt();
        let far = (sum / (2.0 * r)).sqrt();
        let (sin, cos) = if cos_phi >= 0.0 { (far, near) } else { (near, far) };
        let below = 1.0 / (1.0 + cos);
        let half = sin * below;
        let rest = cos * (1.0 + sin + cos) * below / (1.0 + sin);
        Row { along, r, half, rest, quarter: half / (1.0 + (1.0 + half * half).sqrt()) }
    }
}

/// Adds a node: its contribution, and that times (1 - v)^5.
#[inline(always)]
fn add(sums: &mut [Lanes; 2], f: Lanes, v: Lanes) {
    let m = 1.0 - v;
    let m2 = m * m;
    sums[0] = sums[0] + f;
    sums[1] = sums[1] + f * (m2 * m2 * m);
}

#[inline(always)]
fn peak(views: &Views, row: &Row, rule: &Shared, width: Lanes, sums: &mut [Lanes; 2]) {
    let (mu, a2, end) = (views.mu, views.a2, row.quarter);
    let mut local = *sums;
    for (&node, &weight) in rule.rule.node.iter().zip(&rule.rule.weight) {
        let t = end * node;
        let (tt, p, m) = (t + t, 1.0 + t * t, (1.0 - t) * (1.0 + t));
        let vp = row.along * tt + mu * m;
        let p2 = p * p;
        let big = 2.0 * vp * m - mu * p2;
        let big2 = big * big;
        let s = (big2 + (p2 * p2 - big2) * a2).sqrt();
        let q = (m * m) * a2 + tt * tt;
        let q2x = q * q * views.masked(s, big);
        let inverse = 1.0 / (q2x * p);
        let f = (vp * tt * 0.5) * (big * p2) * inverse * (width * weight);
        add(&mut local, f, vp * (inverse * q2x));
    }
    *sums = local;
}

#[inline(always)]
fn horizon(views: &Views, row: &Row, rule: &Shared, width: Lanes, sums: &mut [Lanes; 2]) {
    let (mu, a2, length, half) = (views.mu, views.a2, row.quarter, row.half);
    let h = 1.0 + half * half;
    let (h2, half_h, r4, slope) = (h * h, h * 0.5, 4.0 * row.r, 1.0 + half);
    let width = width * (h2 * h2 * 0.5);
    let mut local = *sums;
    for (&node, &weight) in rule.rule.node.iter().zip(&rule.rule.weight) {
        let u = length * node;
        let p = 1.0 + u * u;
        let p2 = p * p;
        // tan(theta_m / 2) = a / b
        let (a, b) = (half - u, 1.0 + half * u);
        let less = (row.rest + u * slope) * (b + a);
        let ab = a * b;
        let height = r4 * u * ((1.0 - u) * (1.0 + u));
        let height2 = height * height;
        let s = (height2 + (p2 * p2 - height2) * a2).sqrt();
        let q = (less * less) * a2 + 4.0 * (ab * ab);
        let q2x = q * q * views.masked(s, height);
        let inverse = 1.0 / (less * q2x * p);
        let g = height + mu * p2;
        let f = (g * p) * (p * ab) * (height * inverse) * (width * weight);
        add(&mut local, f, half_h * g * (inverse * q2x));
    }
    *sums = local;
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The widest registers that the machine has give the bits of those that every machine has.
    #[test]
    fn bits_do_not_depend_on_the_machine() {
        for (masking, alpha, mu) in [
            (Masking::Correlated, 0.3, 0.8),
            (Masking::Separable, 1e-3, 0.02),
            (Masking::Correlated, 1e-6, 1e-6),
        ] {
            let mu = [mu, 0.9 * mu, 0.7 * mu, 0.5 * mu];
            let alpha = [alpha, alpha, 0.9 * alpha, alpha];
            let views = Views::new(Lanes(mu), Lanes(alpha), masking);
            for level in LEVELS {
                let scales = mu
                    .iter()
                    .zip(alpha)
                    .map(|(mu, a)| Scales::new(*mu, [a, f64::INFINITY, 3.0 * a], f64::INFINITY));
                let sides = scales.reduce(Scales::and).unwrap().sides(level);
                let (plain, best) = (Level { views, sides }.run(), wide(Level { views, sides }));
                let bits = |p: Panels| p.map(|p| p.map(|sum| sum.0.map(f64::to_bits)));
                assert_eq!(bits(plain), bits(best), "level {level}, {alpha:?}, {mu:?}");
            }
        }
    }
}
