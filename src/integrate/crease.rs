//! Lines along which a factor of `v = wo . wm` has an infinite slope, or nearly so: the critical angle of total reflection.
//!
//! A Fresnel factor declares them, half-vector charts end their panels there. On a row of facet normals at one azimuth,
//! with `a` the part of wo along it, `v(t) = R cos(t - delta)`, `R = hypot(a, mu)`, `tan(delta) = a / mu`, so that the line
//! `v = at` is met at `t = delta +- acos(at / R)`; in tangents of half angles
//!
//! ```text
//! h = a / (R + mu),  g = sqrt((R - at) / (R + at)),  tan(t/2) = (h +- g) / (1 -+ h g),
//! h^2 - g^2 = 2 R (at - mu) / ((R + mu)(R + at))
//! ```
//! and the last line gives the small one of `h +- g` without cancellation.

use super::graded::{Graded, Order, shared};

/// A value of `wo . wm` at which an integrand has a square root of the distance, or one blurred over a width.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crease {
    /// Where, in (0, 1].
    pub at: f64,
    /// The distance of the branch point from the real line: 0 for a true square root.
    pub width: f64,
}

/// Order of the short panels that end at a crease, in the root of the distance.
const ROOT: Order = Order(1.1, 0.25);

/// Order of what lies between.
const PEAK: Order = Order(1.0, 0.35);

/// Two panel ends nearer than this are one.
const CLOSE: f64 = 1e-14;

impl Crease {
    /// Half tangents of the polar angles at which a row meets the line, in increasing order; NaN where it does not.
    ///
    /// `a` and `r` as in the module, `mu` the cosine of the view.
    pub(super) fn roots(&self, a: f64, r: f64, mu: f64) -> [f64; 2] {
        if r < self.at {
            // where it comes nearest, if that is near enough to be felt
            let nearest = (self.at - r) < 0.05 * self.at && a > 0.0;
            return [if nearest { a / (r + mu) } else { f64::NAN }, f64::NAN];
        }
        let h = a / (r + mu);
        let g = ((r - self.at) / (r + self.at)).sqrt();
        let difference = 2.0 * r * (self.at - mu) / ((r + mu) * (r + self.at));
        let (plus, minus) = if h >= 0.0 {
            let plus = h + g;
            (plus, if plus > 0.0 { difference / plus } else { 0.0 })
        } else {
            let minus = h - g;
            (difference / minus, minus)
        };
        let over = |above: f64, below: f64| if below > 0.0 { above / below } else { f64::NAN };
        [over(minus, 1.0 + h * g), over(plus, 1.0 - h * g)]
    }

    /// How far from the line, in half tangents, the square root is blurred on a row.
    pub(super) fn blur(&self, r: f64) -> f64 {
        // dv/dt at the line, or the root of the width where the row only touches it
        let apart = ((r - self.at) * (r + self.at)).abs();
        let slope = apart.sqrt().max((self.width * r).sqrt());
        let near = if r < self.at { (2.0 * (self.at - r) / self.at).sqrt() } else { 0.0 };
        if slope > 0.0 { (0.5 * self.width / slope).max(0.5 * near) } else { 0.0 }
    }

    /// Differences of azimuth from wo at which the integral over a row changes its form: where the row begins to meet the
    /// line, and where it meets it on the horizon of wi. NaN where there is none.
    pub(super) fn azimuths(&self, mu: f64, s: f64) -> [f64; 2] {
        let angle = |cos: f64| {
            if cos.abs() < 1.0 { libm::atan2(((1.0 - cos) * (1.0 + cos)).sqrt(), cos) } else { f64::NAN }
        };
        if s <= 0.0 {
            return [f64::NAN; 2];
        }
        let begins = if self.at >= 1.0 {
            0.0
        } else if mu < self.at {
            angle(((self.at - mu) * (self.at + mu)).sqrt() / s)
        } else {
            f64::NAN
        };
        // on the horizon v = mu / (2 cos t_max) and cos(2 t_max) = -a / R
        let half = 0.5 * mu / self.at;
        let q = 2.0 * half * half - 1.0;
        let horizon =
            if q.abs() < 1.0 { angle(-q * mu / ((1.0 - q) * (1.0 + q)).sqrt() / s) } else { f64::NAN };
        [begins, horizon]
    }
}

/// A panel in one variable on (0, length), graded towards 0 on a scale, and cut where the integrand is not smooth.
///
/// `cuts` are positions; `blur` the scale of the root at each, infinite for a mere kink. Calls `visit` with rules in units of
/// `length`, and says whether a rule belongs to a root (their errors are told apart).
pub(super) fn pieces(
    length: f64,
    eps: f64,
    cuts: &[(f64, f64)],
    level: f64,
    order: Order,
    visit: &mut dyn FnMut(&Graded),
) {
    let mut inner: Vec<(f64, f64)> =
        cuts.iter().copied().filter(|c| c.0 > CLOSE * length && c.0 < length * (1.0 - CLOSE)).collect();
    inner.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut from = (0.0, f64::INFINITY);
    for to in inner.into_iter().chain([(length, f64::INFINITY)]) {
        piece(length, eps, [from, to], level, order, visit);
        from = to;
    }
}

/// One piece between two cuts: a short root at either end that has one, and the graded rest.
fn piece(
    length: f64,
    eps: f64,
    [(lo, lo_blur), (hi, hi_blur)]: [(f64, f64); 2],
    level: f64,
    order: Order,
    visit: &mut dyn FnMut(&Graded),
) {
    let whole = hi - lo;
    if whole <= 0.0 {
        return;
    }
    // a root reaches as far as the integrand is otherwise smooth
    let share = if lo_blur.is_finite() && hi_blur.is_finite() { 0.5 } else { 1.0 };
    let first = if lo_blur.is_finite() { (share * whole).min(lo.max(eps)) } else { 0.0 };
    let last = if hi_blur.is_finite() { (share * whole).min(0.5 * hi.max(eps)) } else { 0.0 };
    let (a, b) = (lo + first, hi - last);
    let unit = |x: f64| x / length;
    if first > 0.0 {
        visit(&Graded::root_at([unit(lo), unit(a)], root_scale(lo_blur, first), ROOT, level));
    }
    if a <= 0.0 && b >= length {
        visit(&shared(eps / length, order, level).rule);
    } else if b - a > 1e-12 * whole {
        visit(&Graded::between(eps / length, order, level, [unit(a), unit(b)]));
    }
    if last > 0.0 {
        visit(&Graded::root_at([unit(hi), unit(b)], root_scale(hi_blur, last), ROOT, level));
    }
}

/// Scale of the grading in the root of the distance.
fn root_scale(blur: f64, length: f64) -> f64 {
    if blur > 0.0 { (blur / length).sqrt().clamp(1e-8, 1e3) } else { 1e3 }
}

/// The order of panels towards the normal.
pub(super) const fn peak_order() -> Order {
    PEAK
}
