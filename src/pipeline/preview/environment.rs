//! The light that previews are shaded by: a sky in closed form, and a rectangle that shines.
//!
//! The sky is a polynomial of degree 2 in the direction, so that every integral with a lobe about an axis is exact: bands of degree l are
//! scaled by `k_l = int P_l(cos) w dw / int w dw` (Funk and Hecke), and nothing is lost to a picture or its levels.

use glam::{DMat3, DVec3};

/// Radiance of a sky: `L(w) = c + l . w + w . Q w` in each colour, Q without trace.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sky {
    /// The constant of red, green, blue.
    pub constant: [f64; 3],
    /// Its slope.
    pub linear: [DVec3; 3],
    /// The part of degree 2.
    pub square: [DMat3; 3],
}

/// What is left of a band after a convolution, relative to the constant: degree 1 and 2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bands(pub [f64; 2]);

impl Bands {
    /// Nothing is taken: a mirror.
    pub const MIRROR: Bands = Bands([1.0, 1.0]);
    /// The cosine: irradiance over pi.
    pub const COSINE: Bands = Bands([2.0 / 3.0, 0.25]);

    /// Between two of them.
    #[must_use]
    pub fn mix(self, other: Bands, t: f64) -> Bands {
        let at = |i: usize| self.0[i] + t * (other.0[i] - self.0[i]);
        Bands([at(0), at(1)])
    }
}

impl Sky {
    /// Radiance 1 from everywhere.
    pub const WHITE: Sky = Sky { constant: [1.0; 3], linear: [DVec3::ZERO; 3], square: [DMat3::ZERO; 3] };

    /// Blue from above, warm from the right; positive everywhere, at most 1.
    #[must_use]
    pub fn built_in() -> Sky {
        let (up, sun) = (DVec3::Y, DVec3::new(0.6, 0.48, 0.64));
        let constant = [0.42, 0.45, 0.51];
        let of = |colour: [f64; 3], direction: DVec3| colour.map(|c| direction * c);
        let [from_above, from_sun] = [of([0.1, 0.13, 0.2], up), of([0.16, 0.12, 0.05], sun)];
        let linear = [0, 1, 2].map(|i| from_above[i] + from_sun[i]);
        let outer = DMat3::from_cols(sun * sun.x, sun * sun.y, sun * sun.z);
        let square = [0.24, 0.18, 0.1].map(|c| (outer - DMat3::IDENTITY * (1.0 / 3.0)) * c);
        Sky { constant, linear, square }
    }

    /// The mean radiance about a direction, with what a lobe leaves of each band.
    #[must_use]
    pub fn about(&self, w: DVec3, Bands([one, two]): Bands) -> [f64; 3] {
        [0, 1, 2].map(|i| self.constant[i] + one * self.linear[i].dot(w) + two * w.dot(self.square[i] * w))
    }
}

/// A rectangle of radiance 1 in each colour, one-sided.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Panel {
    /// Its middle.
    pub centre: DVec3,
    /// Half its width and half its height; their cross product points away from where it shines to.
    pub half: [DVec3; 2],
    /// Radiance.
    pub radiance: [f64; 3],
}

impl Panel {
    /// Up to the left, towards the sphere of radius 1 round the origin.
    #[must_use]
    pub fn built_in() -> Panel {
        let centre = DVec3::new(-2.0, 1.6, 2.4);
        let back = centre.normalize();
        let right = DVec3::Y.cross(back).normalize();
        let up = back.cross(right);
        Panel { centre, half: [right * 1.2, up * 0.8], radiance: [1.5, 1.4, 1.2] }
    }

    /// Its corners, in turn.
    #[must_use]
    pub fn corners(&self) -> [DVec3; 4] {
        let [w, h] = self.half;
        [self.centre + w - h, self.centre - w - h, self.centre - w + h, self.centre + w + h]
    }

    /// Does a ray meet its shining side?
    #[must_use]
    pub fn is_met(&self, from: DVec3, along: DVec3) -> bool {
        let [w, h] = self.half;
        let back = w.cross(h);
        let slope = along.dot(back);
        if slope <= 0.0 {
            return false;
        }
        let t = (self.centre - from).dot(back) / slope;
        let at = from + along * t - self.centre;
        t > 0.0 && at.dot(w).abs() <= w.length_squared() && at.dot(h).abs() <= h.length_squared()
    }
}

#[cfg(test)]
mod tests {
    use super::{Bands, Sky};
    use glam::DVec3;
    use std::f64::consts::{PI, TAU};

    #[test]
    fn bands_are_those_of_the_cosine() {
        let sky = Sky::built_in();
        let normal = DVec3::new(0.3, -0.5, 0.7).normalize();
        let n = 400;
        let (mut sum, mut least) = (0.0, f64::INFINITY);
        for i in 0..n {
            let z = 1.0 - 2.0 * (f64::from(i) + 0.5) / f64::from(n);
            for j in 0..2 * n {
                let phi = TAU * (f64::from(j) + 0.5) / f64::from(2 * n);
                let s = (1.0 - z * z).sqrt();
                let w = DVec3::new(s * libm::cos(phi), s * libm::sin(phi), z);
                let l = sky.about(w, Bands::MIRROR)[1];
                least = least.min(l);
                sum += l * w.dot(normal).max(0.0) * (4.0 * PI / (2.0 * f64::from(n * n))) / PI;
            }
        }
        let told = sky.about(normal, Bands::COSINE)[1];
        assert!((sum - told).abs() < 1e-5 && least > 0.0, "{sum} {told} {least}");
    }
}
