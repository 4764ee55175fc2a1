//! Inversion of monotone functions.

/// The root of an increasing function in [lo, hi]: Newton's method, bisecting whenever it leaves the bracket.
///
/// `f` gives value and derivative. Ends when a step no longer moves x, or after 100 steps; a function of one sign
/// gives the end of the bracket where it is nearest to 0.
#[must_use]
pub fn solve(mut lo: f64, mut hi: f64, f: impl Fn(f64) -> (f64, f64)) -> f64 {
    let mut x = 0.5 * (lo + hi);
    for _ in 0..100 {
        let (value, slope) = f(x);
        if value > 0.0 {
            hi = x;
        } else {
            lo = x;
        }
        let newton = x - value / slope;
        let next = if newton > lo && newton < hi { newton } else { 0.5 * (lo + hi) };
        if (next - x).abs() <= f64::EPSILON * x.abs() {
            return next;
        }
        x = next;
    }
    x
}
