//! Form factor of a sphere that the horizon may cut: what a table of area lights holds beside the lobes.

use std::f64::consts::{FRAC_PI_2, PI};

/// Cosine-weighted solid angle of a spherical cap over `pi sin²(sigma)`, with the part below the horizon cut off.
///
/// With `z = cos(omega)`, omega the angle of the cap's centre to the normal, sigma its half angle and `g = asin(cos sigma/sin omega)`:
/// ```text
/// above the horizon:  z
/// cut, omega < pi/2:  z + (G − H)/(pi sin² sigma)
/// cut, omega > pi/2:      (G + H)/(pi sin² sigma)
/// G = −2 sin omega cos sigma cos g + pi/2 − g + sin g cos g
/// H = z (cos g √(sin² sigma − cos² g) + sin² sigma asin(cos g/sin sigma))
/// ```
/// Source: [Snyder1996](crate::cite::SNYDER_1996), the irradiance of a spherical light (equation numbers not checked); written so
/// by the fitter of [Heitz2016](crate::cite::HEITZ_2016). Domain: z in [−1, 1], `sin2` = sin² sigma in [0, 1]. Range: [0, 1].
/// Guard: sin2 → 0 gives max(0, z); roots of what rounding made negative are 0. Accuracy: 1e-12 absolute for sin2 ≥ 1e-3
/// (`tests/ltc.rs`).
#[must_use]
pub fn form_factor(z: f64, sin2: f64) -> f64 {
    let (z, sin2) = (z.clamp(-1.0, 1.0), sin2.clamp(0.0, 1.0));
    let (sin_s, cos_s) = (sin2.sqrt(), (1.0 - sin2).max(0.0).sqrt());
    if sin_s < LEAST_SINE || z.abs() >= sin_s {
        // not cut: all above, or all below
        return z.max(0.0);
    }
    let sin_w = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
    let sin_g = (cos_s / sin_w).min(1.0);
    // cos² g = (sin² omega − cos² sigma)/sin² omega = (sin² sigma − z²)/sin² omega, and
    // sin² sigma − cos² g = z² cos² sigma/sin² omega
    let cos_g = (sin2 - z * z).max(0.0).sqrt() / sin_w;
    let g = libm::atan2(sin_g, cos_g);
    let big_g = -2.0 * sin_w * cos_s * cos_g + FRAC_PI_2 - g + sin_g * cos_g;
    let root = z.abs() * cos_s / sin_w;
    let big_h = z * (cos_g * root + sin2 * libm::atan2(cos_g, root));
    let cut = if z >= 0.0 { z + (big_g - big_h) / (PI * sin2) } else { (big_g + big_h) / (PI * sin2) };
    cut.clamp(0.0, 1.0)
}

/// A smaller sphere is a point.
const LEAST_SINE: f64 = 1e-7;
