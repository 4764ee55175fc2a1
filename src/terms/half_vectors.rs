//! Lobes as densities of half vectors, and how far two of them are apart.
//!
//! Every lobe is the density D(h) (n·h) of half vectors about the normal, of mass 1. In t = tan²θ an isotropic one has a density
//! and a distribution in closed form, so that D, half the integral of the absolute difference of two, is a sum over the points where the
//! densities cross: no quadrature. An anisotropic one is a bundle of such slices over the azimuth.

use super::blinn_phong::equivalent_alpha;
use crate::math::simplex;
use std::f64::consts::FRAC_PI_2;

/// A lobe, isotropic or along the axes x and y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Lobe {
    /// GGX of widths α_x, α_y.
    Ggx([f64; 2]),
    /// Beckmann of widths m_x, m_y: also Ward's lobe, and the distribution of Cook and Torrance.
    Beckmann([f64; 2]),
    /// Blinn-Phong of exponents n_x, n_y; different ones as Ashikhmin and Shirley have them, of mass 1.
    Power([f64; 2]),
}

/// One azimuth of a lobe: mass per rad in units of that of an even lobe, and the shape along t.
#[derive(Debug, Clone, Copy)]
struct Slice {
    share: f64,
    shape: Shape,
}

#[derive(Debug, Clone, Copy)]
enum Shape {
    /// α².
    Ggx(f64),
    /// m².
    Beckmann(f64),
    /// n.
    Power(f64),
}

impl Shape {
    /// Logarithm of the density in t.
    fn log_density(self, t: f64) -> f64 {
        match self {
            Shape::Ggx(a2) => libm::log(a2) - 2.0 * libm::log(a2 + t),
            Shape::Beckmann(m2) => -libm::log(m2) - t / m2,
            Shape::Power(n) => libm::log(0.5 * (n + 2.0)) - 0.5 * (n + 4.0) * libm::log1p(t),
        }
    }

    /// Mass below t.
    fn below(self, t: f64) -> f64 {
        match self {
            Shape::Ggx(a2) => t / (a2 + t),
            Shape::Beckmann(m2) => -libm::expm1(-t / m2),
            Shape::Power(n) => -libm::expm1(-0.5 * (n + 2.0) * libm::log1p(t)),
        }
    }

    /// About where half of the mass is.
    fn scale(self) -> f64 {
        match self {
            Shape::Ggx(a2) => a2,
            Shape::Beckmann(m2) => m2,
            Shape::Power(n) => 2.0 / (n + 2.0),
        }
    }
}

impl Lobe {
    /// True if both widths are equal.
    #[must_use]
    pub fn is_isotropic(&self) -> bool {
        let (Lobe::Ggx(w) | Lobe::Beckmann(w) | Lobe::Power(w)) = self;
        w[0].to_bits() == w[1].to_bits()
    }

    /// The slice at cos²φ = `c`; `even` is the mean of the powers' shares.
    fn slice(&self, c: f64, even: f64) -> Slice {
        let s = 1.0 - c;
        match self {
            Lobe::Ggx([x, y]) => {
                let a2 = 1.0 / (c / (x * x) + s / (y * y));
                Slice { share: a2 / (x * y), shape: Shape::Ggx(a2) }
            }
            Lobe::Beckmann([x, y]) => {
                let m2 = 1.0 / (c / (x * x) + s / (y * y));
                Slice { share: m2 / (x * y), shape: Shape::Beckmann(m2) }
            }
            Lobe::Power([x, y]) => {
                let n = x * c + y * s;
                Slice { share: 1.0 / (n + 2.0) / even, shape: Shape::Power(n) }
            }
        }
    }

    /// Mean over the azimuth of what a slice of powers holds: 1/√((n_x + 2)(n_y + 2)).
    fn even(&self) -> f64 {
        match self {
            Lobe::Power([x, y]) => 1.0 / ((x + 2.0) * (y + 2.0)).sqrt(),
            _ => 1.0,
        }
    }
}

/// Azimuths of a quarter turn that anisotropic lobes are compared at.
const AZIMUTHS: usize = 96;

/// Steps of ln t in the search for crossings; 24 decades about the widths.
const STEPS: usize = 160;

/// D: half the integral of the absolute difference of two lobes. Range: [0, 1].
///
/// Accuracy: 1e-9 for isotropic lobes; 1e-5 for widths with a ratio of up to 20 (`tests/conversions.rs`). Guard: two crossings nearer than a
/// third of t are not told apart.
#[must_use]
pub fn distance(a: &Lobe, b: &Lobe) -> f64 {
    let (ea, eb) = (a.even(), b.even());
    if a.is_isotropic() && b.is_isotropic() {
        return slice_difference(&a.slice(0.5, ea), &b.slice(0.5, eb));
    }
    let mut sum = 0.0;
    // equal masses of the wider axis ratio lie between the nodes: tan of the azimuth is stretched by the ratio of widths
    let stretch = stretch(a).max(1e-9);
    for i in 0..AZIMUTHS {
        let u = (i as f64 + 0.5) / AZIMUTHS as f64;
        let tangent = libm::tan(FRAC_PI_2 * u);
        let scaled = tangent * stretch;
        let c = 1.0 / (1.0 + scaled * scaled);
        let weight = stretch * (1.0 + tangent * tangent) * c;
        sum += weight * slice_difference(&a.slice(c, ea), &b.slice(c, eb));
    }
    sum / AZIMUTHS as f64
}

/// Ratio of the widths across and along x.
fn stretch(lobe: &Lobe) -> f64 {
    match lobe {
        Lobe::Ggx([x, y]) | Lobe::Beckmann([x, y]) => y / x,
        Lobe::Power([x, y]) => ((x + 2.0) / (y + 2.0)).sqrt(),
    }
}

/// Half the integral of the absolute difference of two slices.
fn slice_difference(a: &Slice, b: &Slice) -> f64 {
    let shares = libm::log(a.share / b.share);
    let excess = |t: f64| shares + a.shape.log_density(t) - b.shape.log_density(t);
    let lowest = a.shape.scale().min(b.shape.scale()) * 1e-8;
    let highest = a.shape.scale().max(b.shape.scale()) * 1e8;
    let ratio = libm::log(highest / lowest) / STEPS as f64;
    let place = |i: usize| lowest * libm::exp(ratio * i as f64);
    let gap = |t: f64| a.share * a.shape.below(t) - b.share * b.shape.below(t);
    let (mut sum, mut from) = (0.0, 0.0);
    let mut last = excess(lowest);
    for i in 1..=STEPS {
        let here = excess(place(i));
        if (here > 0.0) != (last > 0.0) {
            let crossing = bisect(&excess, place(i - 1), place(i));
            let g = gap(crossing);
            sum += (g - from).abs();
            from = g;
        }
        last = here;
    }
    0.5 * (sum + (a.share - b.share - from).abs())
}

/// Where `f` changes its sign between `lo` and `hi`.
fn bisect(f: &impl Fn(f64) -> f64, mut lo: f64, mut hi: f64) -> f64 {
    let sign = f(lo) > 0.0;
    for _ in 0..60 {
        let middle = 0.5 * (lo + hi);
        if (f(middle) > 0.0) == sign {
            lo = middle;
        } else {
            hi = middle;
        }
    }
    0.5 * (lo + hi)
}

/// Width of the nearest GGX to a Beckmann lobe of width 1; both are shapes of slopes, so that it holds at every scale, along every axis.
///
/// The densities cross where t = 0.205293540 and 2.828274919, and D is least where the product of both is α⁴; a test finds it anew.
pub const NEAREST_TO_BECKMANN: f64 = 0.872_919_562_483_5;

/// The widths of GGX by the formula of equal peaks.
#[must_use]
pub fn formula(lobe: &Lobe) -> [f64; 2] {
    match lobe {
        Lobe::Ggx(w) | Lobe::Beckmann(w) => *w,
        Lobe::Power(n) => n.map(equivalent_alpha),
    }
}

/// The widths of the GGX lobe that is nearest, by least D.
#[must_use]
pub fn nearest(lobe: &Lobe) -> [f64; 2] {
    match lobe {
        Lobe::Ggx(w) => *w,
        Lobe::Beckmann(m) => m.map(|m| NEAREST_TO_BECKMANN * m),
        Lobe::Power(n) => {
            let start = n.map(|n| 0.89 * equivalent_alpha(n));
            least(lobe.is_isotropic(), start, |w| distance(lobe, &Lobe::Ggx(w)))
        }
    }
}

/// The widths near a start for which D is least; of an isotropic lobe both are one.
#[must_use]
pub fn least(isotropic: bool, start: [f64; 2], distance: impl Fn([f64; 2]) -> f64) -> [f64; 2] {
    let start = start.map(libm::log);
    if isotropic {
        let width = golden(start[0] - 0.4, start[0] + 0.4, |x| distance([libm::exp(x); 2]));
        return [libm::exp(width); 2];
    }
    let found = simplex::minimise(&start, 0.1, 2, 60, &mut |p| distance([libm::exp(p[0]), libm::exp(p[1])]));
    [libm::exp(found[0]), libm::exp(found[1])]
}

/// The least of a function with one minimum, by the golden section.
fn golden(mut lo: f64, mut hi: f64, f: impl Fn(f64) -> f64) -> f64 {
    let part = 0.5 * (5f64.sqrt() - 1.0);
    let (mut a, mut b) = (hi - part * (hi - lo), lo + part * (hi - lo));
    let (mut fa, mut fb) = (f(a), f(b));
    for _ in 0..40 {
        if fa < fb {
            (hi, b, fb) = (b, a, fa);
            a = hi - part * (hi - lo);
            fa = f(a);
        } else {
            (lo, a, fa) = (a, b, fb);
            b = lo + part * (hi - lo);
            fb = f(b);
        }
    }
    0.5 * (lo + hi)
}

/// Mean share over a quarter turn, for tests.
#[cfg(test)]
fn mean_share(lobe: &Lobe) -> f64 {
    let n = 20_000;
    let at = |i: usize| {
        let (_, cos) = libm::sincos((i as f64 + 0.5) / n as f64 * FRAC_PI_2);
        lobe.slice(cos * cos, lobe.even()).share
    };
    (0..n).map(at).sum::<f64>() / n as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slices_hold_a_mass_of_one() {
        for lobe in [Lobe::Ggx([0.1, 0.4]), Lobe::Beckmann([0.5, 0.05]), Lobe::Power([10.0, 1000.0])] {
            assert!((mean_share(&lobe) - 1.0).abs() < 1e-9, "{lobe:?}");
        }
    }

    #[test]
    fn the_nearest_to_beckmann_is_where_it_is_said() {
        let d = |k: f64| distance(&Lobe::Beckmann([0.3; 2]), &Lobe::Ggx([0.3 * k; 2]));
        let found = golden(0.8, 0.95, d);
        assert!((found - NEAREST_TO_BECKMANN).abs() < 1e-6, "{found}");
    }
}
