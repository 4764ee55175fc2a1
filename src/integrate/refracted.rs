//! The chart of the light that an interface lets through: facet normals in polar coordinates round the normal, with the critical
//! cone, the horizon of the other side and the end of the facets that wo sees as coordinate lines.
//!
//! On the facets of one azimuth refraction is that of a plane. With `a` the part of wo along the azimuth, `R = hypot(a, mu)` and
//! `q = sqrt(R² + eta² - 1)` the lengths of wo and of `eta wt` in that plane, `tan(delta) = a / mu`, `u = t - delta` the angle of
//! the facet from wo, and `x` that of wt from the facet turned over,
//!
//! ```text
//! R sin u = q sin x,   c = wo . wm = R cos u,   g = eta cos_t = q cos x,   c² - g² = 1 - eta²
//! mu_t = (mu - (c - g) cos t) / eta = (q / eta) cos(x - t),   dt / dx = g / c
//! ```
//! From the denser side (eta < 1) x is the coordinate: the critical cone, where c and T have a square root in t, is `x = pi/2` and T is
//! smooth there. Facets that are seen under less than the critical angle begin at the normal, `sin x = -a / q`, if mu is above the critical cosine
//! `k = sqrt(1 - eta²)`; else where wt leaves the horizon, at
//!
//! ```text
//! tan(t_0) = (a - q) / mu = (k² - mu²) / (mu (a + q)),   x_0 = t_0 - pi/2
//! ```
//! and only where `a > sqrt(k² - mu²)`. There the azimuth is `s sin(phi) = eta cos(chi)`, `q = eta sin(chi)`, `dphi = q dchi / a`, in which the
//! fan of azimuths has no square root at its ends either. Rows that would pass the horizon of wm before the critical cone are those with
//! `a > k`: `a = k` ends a panel of the azimuth, and what lies inside of it has a root of the distance.
//! From the other side (eta > 1) t is the coordinate, up to the horizon of wm or to `c = 0`.
//!
//! Two widths map the azimuth as the [elliptical chart](super::ellipse) does; the fan ends panels at the wide axis.
//! Rows are graded at the peak of D, at the layer of masking at the horizon of wt, and, where the index is extreme, at the end.
//!
//! Measured on GGX, 600 draws each with widths in [1e-3, 1] and eta in [1.02, 2.5] and its inverse, error at 50 / 99 / 100 % of the draws and
//! evaluations: level 4 and level 8: from above 3e-7, 3e-6, 1e-5 (156) and 6e-14, 5e-11, 3e-9 (630); from below, within the critical angle 2e-7, 2e-5, 3e-5 (143)
//! and 4e-13, 3e-9, 8e-9 (570), beyond it 8e-7, 5e-5, 7e-5 (92) and 2e-11, 3e-8, 5e-8 (370). Two widths take four times the evaluations. Beckmann, whose
//! tail is a Gaussian, takes two levels more. The beta form of masking has a broken power of mu_t at the horizon of wt, and converges
//! algebraically beyond the critical angle: 2e-9 at level 15.

use super::ellipse::{GRAZING, square, turned};
use super::graded::{Graded, Order, share_scales, shared};
use super::stop::Trust;
use super::view::View;
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI};

const AZIMUTH: Order = Order(1.0, 0.25);
const ROOT: Order = Order(1.0, 0.0);

/// Widest and narrowest scale that the gradings are built for.
const ALPHA_RANGE: [f64; 2] = [1e-8, 4.0];

/// Ratios of the widths above this need no panel end at an axis.
const ROUND: f64 = 0.8;

/// Panel ends of the azimuth nearer than this are one.
const CLOSE: f64 = 1e-6;

/// An interface as its chart knows it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interface {
    /// Widths of the peak of D along the tangents.
    pub alpha: [f64; 2],
    /// D vanishes beyond `tan(t) = reach * width`, whatever the azimuth; infinite for a power-law tail.
    pub reach: f64,
    /// Index below over that above.
    pub eta: f64,
}

impl Interface {
    /// How far the differences of levels are to be trusted: one width, two, a lobe that ends; from the rarer side and from the denser.
    #[must_use]
    pub fn trust(&self) -> Trust {
        let [x, y] = self.alpha;
        let (gain, memory): (&[f64], &[f64]) =
            match (self.reach.is_finite(), (x - y).abs() <= 0.0, self.eta > 1.0) {
                (true, _, true) => (&[1.0, 1.0, 0.45, 2.5, 1.9, 0.75, 0.65], &[0.3]),
                (true, _, false) => (&[0.5, 0.5, 0.35, 1.4, 1.0, 0.7, 0.65], &[0.3]),
                (_, true, true) => (&[1.8, 1.8, 1.5, 1.0, 0.19, 0.36, 0.75], &[0.06, 0.06, 0.1]),
                (_, true, false) => (&[0.65, 0.65, 0.38, 0.7, 0.75, 1.0, 0.65], &[0.1]),
                (_, _, true) => (&[1.15, 1.15, 1.5, 2.0, 0.65, 0.55], &[0.1]),
                (_, _, false) => (&[0.85, 0.85, 0.4, 0.4, 0.8, 0.9, 0.6, 0.25], &[0.1]),
            };
        Trust { gain, memory }
    }
}

/// A facet that refracts the view to the other side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Facet {
    /// Which panel it belongs to, below [`MAX_PANELS`](super::MAX_PANELS).
    pub panel: usize,
    /// Its normal.
    pub wm: DVec3,
    /// The refracted direction, below the surface.
    pub wt: DVec3,
    /// `wo . wm`.
    pub cos: f64,
    /// `-wt . wm`.
    pub cos_t: f64,
    /// Weight in solid angle of `wm`, sr.
    pub weight: f64,
}

/// A panel of the azimuth: where it begins, its signed length, and the scale of its grading; none for a root of the distance.
#[derive(Debug, Clone, Copy)]
struct Panel {
    from: f64,
    length: f64,
    scale: Option<f64>,
}

/// An end of panels: its place, its scale, and on which side there is a root of the distance (0: on none).
#[derive(Debug, Clone, Copy)]
struct End {
    at: f64,
    scale: f64,
    root: f64,
}

/// One azimuth of facet normals.
#[derive(Debug, Clone, Copy)]
pub(super) struct Row {
    pub(super) cos_phi: f64,
    pub(super) sin_phi: f64,
    /// The part of wo along it.
    pub(super) a: f64,
    /// Length of eta wt in its plane.
    pub(super) q: f64,
    /// Width of the peak of D along it.
    pub(super) width: f64,
    /// Weight in phi.
    pub(super) weight: f64,
    pub(super) panel: usize,
}

pub(super) struct Refraction<'a> {
    pub(super) view: View,
    pub(super) lobe: Interface,
    pub(super) level: f64,
    pub(super) wo: DVec3,
    s: f64,
    azimuth_o: [f64; 2],
    /// `(eta - 1)(eta + 1)`, and the root of its magnitude.
    pub(super) contrast: f64,
    pub(super) critical: f64,
    /// `mu² + eta² - 1`: below 0 the normal is beyond the critical angle.
    pub(super) inside: f64,
    /// psi across wo, and the width there, as in the elliptical chart.
    psi_1: f64,
    width_1: f64,
    pub(super) visit: &'a mut dyn FnMut(&Facet),
}

/// Calls `visit` with facets that refract a view; all that do, once with their mirror images.
pub fn visit(view: View, lobe: &Interface, level: f64, visit: &mut dyn FnMut(&Facet)) {
    let alpha = lobe.alpha.map(|a| a.clamp(ALPHA_RANGE[0], ALPHA_RANGE[1]));
    let round = (alpha[0] - alpha[1]).abs() <= 0.0;
    let view = if round { view.in_plane() } else { view };
    let mut chart = Refraction::new(view, Interface { alpha, ..*lobe }, level, visit);
    let mirrored = (chart.azimuth_o[0] * chart.azimuth_o[1]).abs() < 1e-15;
    let fan = chart.inside < 0.0;
    let panels = match (round, fan) {
        (true, _) => chart.round_panels(fan),
        (false, true) => chart.fan_panels(),
        (false, false) => chart.turn_panels(),
    };
    let kept = if fan { 0.0..FRAC_PI_2 } else { FRAC_PI_2..3.0 * FRAC_PI_2 };
    let weight = if mirrored { 2.0 } else { 1.0 };
    for (i, panel) in panels.into_iter().enumerate() {
        let middle = panel.from + 0.5 * panel.length;
        // half of the panels are the mirror images of the others; at mu = 0 the far half of the azimuth sees nothing
        if (mirrored && !kept.contains(&middle)) || (!fan && middle > PI && view.mu < GRAZING) {
            continue;
        }
        chart.panel(panel, fan, weight, i);
    }
}

impl Refraction<'_> {
    fn new(view: View, lobe: Interface, level: f64, visit: &mut dyn FnMut(&Facet)) -> Refraction<'_> {
        let (eta, mu, s) = (lobe.eta, view.mu, view.sine());
        let contrast = (eta - 1.0) * (eta + 1.0);
        let [cos, sin] = view.azimuth();
        let alpha = lobe.alpha;
        // mu² - k² or eta² - s²: each is the one without cancellation on its side
        let inside = if eta < 1.0 && s < mu { (eta - s) * (eta + s) } else { mu * mu + contrast };
        Refraction {
            view,
            lobe,
            level,
            wo: view.direction(),
            s,
            azimuth_o: [cos, sin],
            contrast,
            critical: contrast.abs().sqrt(),
            inside,
            psi_1: libm::atan2(-cos * alpha[0], sin * alpha[1]),
            width_1: 1.0 / (square(sin / alpha[0]) + square(cos / alpha[1])).sqrt(),
            visit,
        }
    }

    /// Scale of the azimuth: where wm is across wo, in psi, or at the ends of the fan, in chi.
    fn scale(&self, fan: bool) -> f64 {
        let (mu, eta) = (self.view.mu, self.lobe.eta);
        let wide = self.lobe.alpha[0].max(self.lobe.alpha[1]);
        // half the slope at which the row nearest to the normal ends, over the width
        let far = |inside: f64| (inside.sqrt() / (2.0 * mu.max(1e-9) * wide)).max(1.0);
        let scale = if fan {
            (-self.inside).sqrt() * far(-self.inside) / eta
        } else {
            let stretch = square(self.width_1) / (self.lobe.alpha[0] * self.lobe.alpha[1]);
            let near = if eta > 1.0 { 2.0 * mu } else { self.inside.sqrt() * far(self.inside) };
            near * stretch / self.s.max(1e-9)
        };
        scale.clamp(1e-9, 1e3)
    }

    /// The largest and the smallest chi, or psi - psi_1, between which rows meet the horizon of wm first; none if no row does.
    fn inner(&self, fan: bool) -> Option<[f64; 2]> {
        // a finite reach ends before the horizon
        if self.lobe.eta >= 1.0 || self.s <= self.critical || self.lobe.reach.is_finite() {
            return None;
        }
        if fan {
            let chi = libm::asin((self.view.mu / self.lobe.eta).min(1.0));
            return Some([chi, PI - chi]);
        }
        let half = libm::acos(self.critical / self.s);
        Some([half, -half].map(|from_view| self.turn_of(from_view)))
    }

    /// psi - psi_1 in (0, 2 pi) of an azimuth given from that of the view.
    fn turn_of(&self, from_view: f64) -> f64 {
        let [ax, ay] = self.lobe.alpha;
        let phi_o = libm::atan2(self.azimuth_o[1], self.azimuth_o[0]);
        let (sin, cos) = libm::sincos(phi_o + from_view);
        (libm::atan2(sin / ay, cos / ax) - self.psi_1).rem_euclid(2.0 * PI)
    }

    /// Panels of the half of the azimuth that counts for both, for equal widths.
    fn round_panels(&self, fan: bool) -> Vec<Panel> {
        let (from, to) = if fan { (0.0, FRAC_PI_2) } else { (PI, FRAC_PI_2) };
        let scale = Some(self.scale(fan));
        let mut panels = Vec::new();
        let mut add = |from: f64, to: f64, scale| {
            if (to - from).abs() > 1e-9 {
                panels.push(Panel { from, length: to - from, scale });
            }
        };
        match self.inner(fan) {
            Some([first, second]) => {
                let middle = if fan { first } else { first.max(second) };
                add(from, middle, scale);
                add(middle, to, None);
            }
            None => add(from, to, scale),
        }
        if !fan {
            add(PI, 3.0 * FRAC_PI_2, scale);
        }
        panels
    }

    /// Panels of psi - psi_1 in (0, 2 pi).
    fn turn_panels(&self) -> Vec<Panel> {
        let across = self.scale(false);
        let mut ends: Vec<End> = [0.0, PI, 2.0 * PI].map(|at| End { at, scale: across, root: 0.0 }).into();
        let [ax, ay] = self.lobe.alpha;
        let ratio = ax.min(ay) / ax.max(ay);
        if ratio < ROUND {
            let narrow = ((if ax < ay { 0.0 } else { FRAC_PI_2 }) - self.psi_1).rem_euclid(PI);
            let within = -CLOSE..2.0 * PI + CLOSE;
            for at in [-PI, 0.0, PI, 2.0 * PI].map(|turn| narrow + turn) {
                if within.contains(&at) {
                    meet(&mut ends, End { at, scale: ratio, root: 0.0 });
                }
            }
        }
        if let Some([first, second]) = self.inner(false) {
            meet(&mut ends, End { at: first.min(second), scale: 1e3, root: 1.0 });
            meet(&mut ends, End { at: first.max(second), scale: 1e3, root: -1.0 });
        }
        halves(ends)
    }

    /// Panels of chi in (0, pi).
    fn fan_panels(&self) -> Vec<Panel> {
        let scale = self.scale(true);
        let mut ends: Vec<End> = [0.0, PI].map(|at| End { at, scale, root: 0.0 }).into();
        let ([ax, ay], [cos, sin], eta) = (self.lobe.alpha, self.azimuth_o, self.lobe.eta);
        let ratio = ax.min(ay) / ax.max(ay);
        if ratio < ROUND {
            // in phi it is the wide axis near which D changes fast
            let (x, y) = if ax > ay { (1.0, 0.0) } else { (0.0, 1.0) };
            for sign in [1.0, -1.0] {
                let (along, across) = (sign * (x * cos + y * sin), sign * (y * cos - x * sin));
                let cos_chi = self.s * across / eta;
                if along > 0.0 && cos_chi.abs() < 1.0 {
                    let at = libm::acos(cos_chi);
                    let scale = (ratio * self.s * along / (eta * libm::sin(at)).max(1e-9)).min(1e3);
                    meet(&mut ends, End { at, scale, root: 0.0 });
                }
            }
        }
        if let Some([first, second]) = self.inner(true) {
            meet(&mut ends, End { at: first, scale: 1e3, root: 1.0 });
            meet(&mut ends, End { at: second, scale: 1e3, root: -1.0 });
        }
        halves(ends)
    }

    fn panel(&mut self, panel: Panel, fan: bool, weight: f64, index: usize) {
        let length = panel.length.abs();
        let root;
        let azimuth = match panel.scale {
            Some(scale) => &shared(scale / length, AZIMUTH, self.level).rule,
            None => {
                root = Graded::root_at([0.0, 1.0], 1e3, ROOT, self.level);
                &root
            }
        };
        for (x, w) in azimuth.node.iter().zip(&azimuth.weight) {
            let row = if fan {
                self.fan_row(panel.from + panel.length * x)
            } else {
                self.turn_row(panel.from, panel.length * x)
            };
            let row = Row { weight: row.weight * weight * length * w, panel: index, ..row };
            if self.lobe.eta > 1.0 { self.above(&row) } else { self.below(&row) }
        }
    }

    fn fan_row(&self, chi: f64) -> Row {
        let (sin, cos) = libm::sincos(chi);
        let (q, across) = (self.lobe.eta * sin, self.lobe.eta * cos);
        let a = (q * q - self.inside).sqrt();
        let [cos_o, sin_o] = self.azimuth_o;
        let (x, y) = (a / self.s, across / self.s);
        let (cos_phi, sin_phi) = (x * cos_o - y * sin_o, x * sin_o + y * cos_o);
        let width = 1.0 / libm::hypot(cos_phi / self.lobe.alpha[0], sin_phi / self.lobe.alpha[1]);
        Row { cos_phi, sin_phi, a, q, width, weight: q / a, panel: 0 }
    }

    fn turn_row(&self, from: f64, step: f64) -> Row {
        let [ax, ay] = self.lobe.alpha;
        let (sin, cos) = libm::sincos(self.psi_1 + from + step);
        let (x, y) = (ax * cos, ay * sin);
        let width = (x * x + y * y).sqrt();
        let a = self.s * ax * ay * turned(from, step) / (self.width_1 * width);
        let q = (self.inside + a * a).sqrt();
        let weight = ax * ay / (width * width);
        Row { cos_phi: x / width, sin_phi: y / width, a, q, width, weight, panel: 0 }
    }
}

/// Adds an end, or lowers the scale of the one that it meets.
fn meet(ends: &mut Vec<End>, end: End) {
    match ends.iter_mut().find(|e| (e.at - end.at).abs() < CLOSE) {
        Some(e) => {
            e.scale = e.scale.min(end.scale);
            e.root += end.root;
        }
        None => ends.push(end),
    }
}

/// Both halves of what lies between neighbouring ends, each graded towards its own.
fn halves(mut ends: Vec<End>) -> Vec<Panel> {
    ends.sort_by(|a, b| a.at.total_cmp(&b.at));
    let mut scales: Vec<(f64, f64)> = ends.iter().map(|e| (e.at, e.scale)).collect();
    share_scales(&mut scales);
    let panel = |i: usize, half: f64| {
        let scale = (ends[i].root * half <= 0.0).then_some(scales[i].1);
        Panel { from: ends[i].at, length: half, scale }
    };
    let of_pair = |i: usize| {
        let half = 0.5 * (ends[i + 1].at - ends[i].at);
        [panel(i, half), panel(i + 1, -half)]
    };
    (0..ends.len().saturating_sub(1)).flat_map(of_pair).collect()
}
