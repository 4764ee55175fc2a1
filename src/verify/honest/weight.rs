//! Fresnel weights, by other formulas than the bakers'.

use super::fresnel;
use crate::tables::integral::Functional;

/// The weight of a functional at `v = wo.wh`.
pub(super) fn weight(g: Functional, v: f64) -> f64 {
    // opposite directions in the horizon have v = 0, rounding may leave a little more than 1
    let v = v.clamp(0.0, 1.0);
    // multiplied out; the bakers take powers of the difference
    let fifth = 1.0 - v * (5.0 - v * (10.0 - v * (10.0 - v * (5.0 - v))));
    match g {
        Functional::One => 1.0,
        Functional::Schlick => fifth,
        Functional::SchlickComplement => 1.0 - fifth,
        Functional::F82 => v * fifth * (1.0 - v) * 7.0 * libm::pow(7.0 / 6.0, 6.0),
        Functional::Power(e) if v < 1.0 => libm::exp(e * libm::log1p(-v)),
        Functional::Power(e) => f64::from(u8::from(e <= 0.0)),
        Functional::Dielectric(eta) => {
            let f0 = libm::pow((eta - 1.0) / (eta + 1.0), 2.0);
            // it may dip below F0 near Brewster's angle, and counts as 0 there
            ((fresnel::dielectric(v, eta).mean().value - f0) / (1.0 - f0)).max(0.0)
        }
    }
}
