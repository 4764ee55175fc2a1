//! The form factor of a sphere that the horizon cuts, by a sum over its cap.

use super::{Asked, Truth, quad};
use crate::tables::Role;
use std::f64::consts::PI;

/// Accuracy that is asked of the sum.
const TARGET: f64 = 1e-11;

/// Roles of this file: the texture's own coordinates are cosine and squared sine.
pub(super) fn truth(role: Role, asked: &Asked<'_>) -> Option<Truth> {
    if role != Role::SphereForm {
        return None;
    }
    let grid = &asked.spec.grid;
    let index = grid.unravel(asked.texel);
    let coordinate = |i: usize| grid.axes().get(i).map_or(0.0, |a| a.coordinate(index[i] as f64));
    Some(form(2.0 * coordinate(0) - 1.0, coordinate(1)))
}

/// `int max(0, cos) dw / (pi sin^2 s)` over a cap of half angle s whose centre has the cosine `z`.
fn form(z: f64, sin2: f64) -> Truth {
    if sin2 <= 1e-12 {
        return Truth { value: z.max(0.0), error: 1e-6 * sin2.sqrt().min(1.0) + 1e-15 };
    }
    let (across, half) = (((1.0 - z) * (1.0 + z)).max(0.0).sqrt(), libm::asin(sin2.sqrt().min(1.0)));
    // circles round the centre: where they meet the horizon the light is cut
    let meet = libm::asin(z.abs().min(1.0));
    let mut breaks = vec![0.0, half];
    if meet < half {
        breaks.insert(1, meet);
    }
    let (value, error) = quad::integral(&breaks, TARGET * sin2, &mut |t| {
        let (sin, cos) = libm::sincos(t);
        let (a, b) = (z * cos, across * sin);
        let end = if a >= b {
            PI
        } else if a <= -b {
            return 0.0;
        } else {
            libm::acos(-a / b)
        };
        // int_0^end (a + b cos) is known
        2.0 * sin * (a * end + b * libm::sin(end))
    });
    Truth { value: value / (PI * sin2), error: error / (PI * sin2) + 1e-13 }
}
