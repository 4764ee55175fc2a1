//! A tabulated isotropic BRDF in half and difference angles, as the MERL database has it.

use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI};

/// Texels along theta_h, theta_d and phi_d.
const SIZE: [usize; 3] = [90, 90, 180];

/// Values of a plane.
const PLANE: usize = SIZE[0] * SIZE[1] * SIZE[2];

/// Least and largest width that is told.
const WIDTHS: [f64; 2] = [0.005, 0.8];

/// A tabulated BRDF.
#[derive(Debug, Clone, PartialEq)]
pub struct Tabulated {
    /// `[colour][theta_h][theta_d][phi_d]`, f in 1/sr; negative where it was not measured.
    planes: [Vec<f64>; 3],
}

/// Why numbers are no tabulated BRDF.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum TableFault {
    /// Too many or too few values.
    #[error("a plane has {0} values, the database has 90 x 90 x 180")]
    Size(
        /// How many.
        usize,
    ),
    /// A value that is no number.
    #[error("colour {colour}, texel {texel:?} (theta_h, theta_d, phi_d) is {value}")]
    NotFinite {
        /// 0 to 2.
        colour: usize,
        /// Indices.
        texel: [usize; 3],
        /// The value.
        value: f64,
    },
    /// Nothing is known of it.
    #[error("no texel has a value: all are negative, as those that were not measured")]
    Empty,
}

impl Tabulated {
    /// A table of red, green and blue.
    ///
    /// # Errors
    /// [`TableFault`] with the first texel that is no number.
    pub fn new(planes: [Vec<f64>; 3]) -> Result<Tabulated, TableFault> {
        for (colour, plane) in planes.iter().enumerate() {
            if plane.len() != PLANE {
                return Err(TableFault::Size(plane.len()));
            }
            if let Some((at, value)) = plane.iter().enumerate().find(|(_, v)| !v.is_finite()) {
                let texel = [at / SIZE[2] / SIZE[1], at / SIZE[2] % SIZE[1], at % SIZE[2]];
                return Err(TableFault::NotFinite { colour, texel, value: *value });
            }
        }
        if planes.iter().all(|p| p.iter().all(|v| *v < 0.0)) {
            return Err(TableFault::Empty);
        }
        Ok(Tabulated { planes })
    }

    /// f of red, green and blue, of the cell that the published reader takes; none where it was not measured.
    #[must_use]
    pub fn value(&self, wi: DVec3, wo: DVec3) -> [Option<f64>; 3] {
        let wh = (wi + wo).normalize();
        let theta_h = libm::acos(wh.z.clamp(-1.0, 1.0));
        let phi_h = libm::atan2(wh.y, wh.x);
        let (s, c) = libm::sincos(-phi_h);
        let turned = DVec3::new(c * wi.x - s * wi.y, s * wi.x + c * wi.y, wi.z);
        let (s, c) = libm::sincos(-theta_h);
        let d = DVec3::new(c * turned.x + s * turned.z, turned.y, c * turned.z - s * turned.x);
        let theta_d = libm::acos(d.z.clamp(-1.0, 1.0));
        let phi_d = libm::atan2(d.y, d.x);
        let phi_d = if phi_d < 0.0 { phi_d + PI } else { phi_d };
        self.cell([
            index((theta_h / FRAC_PI_2).sqrt(), SIZE[0]),
            index(theta_d / FRAC_PI_2, SIZE[1]),
            index(phi_d / PI, SIZE[2]),
        ])
    }

    fn cell(&self, [h, d, p]: [usize; 3]) -> [Option<f64>; 3] {
        let at = (h * SIZE[1] + d) * SIZE[2] + p;
        [0, 1, 2].map(|c| Some(self.planes[c][at]).filter(|v| *v >= 0.0))
    }

    /// The width of the GGX lobe that falls to half of its peak where this one does, in retro-reflection.
    #[must_use]
    pub fn width(&self) -> f64 {
        let at = |h: usize| self.cell([h, 0, 0]).into_iter().flatten().sum::<f64>();
        let half = (0..SIZE[0]).find(|h| at(*h) < 0.5 * at(0)).unwrap_or(SIZE[0]) as f64;
        let theta = FRAC_PI_2 * (half / SIZE[0] as f64) * (half / SIZE[0] as f64);
        // D of GGX is at half where tan theta = alpha sqrt(sqrt 2 - 1)
        (libm::tan(theta.min(1.0)) / (2f64.sqrt() - 1.0).sqrt()).clamp(WIDTHS[0], WIDTHS[1])
    }
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "held within the table")]
fn index(part: f64, count: usize) -> usize {
    ((part * count as f64).max(0.0) as usize).min(count - 1)
}
