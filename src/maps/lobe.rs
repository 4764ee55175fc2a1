//! Facets, lobes and the frames that they stand in.
//!
//! All directions are in the tangent frame of the mesh: +x tangent, +y bitangent, +z its normal.

use glam::{DMat2, DVec2, DVec3};
use std::f64::consts::{FRAC_1_PI, PI};

/// Narrowest lobe that is told apart from a mirror: facets of a smaller α count as this wide in the comparison of lobes.
pub const LEAST_ALPHA: f64 = 1e-3;

/// One texel of a footprint: a GGX lobe about its own normal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Facet {
    /// Unit normal.
    pub normal: DVec3,
    /// Width α, in (0, 1]; of two the smaller one.
    pub alpha: f64,
    /// Share of the footprint; the shares of a footprint sum to 1.
    pub weight: f64,
    /// The larger width; of one the same.
    pub alpha_max: f64,
    /// Direction of the larger width in [`frame`], rad; 0 of one.
    pub angle: f64,
}

impl Facet {
    /// A facet of these slopes: n = normalise(−x, −y, 1).
    #[must_use]
    pub fn from_slope(slope: DVec2, alpha: f64, weight: f64) -> Facet {
        Facet::round(DVec3::new(-slope.x, -slope.y, 1.0).normalize(), alpha, weight)
    }

    /// A facet of one width.
    #[must_use]
    pub const fn round(normal: DVec3, alpha: f64, weight: f64) -> Facet {
        Facet { normal, alpha, weight, alpha_max: alpha, angle: 0.0 }
    }

    /// A facet of this lobe.
    #[must_use]
    pub const fn of(lobe: &Lobe, weight: f64) -> Facet {
        let Lobe { normal, alpha_max, alpha_min, angle } = *lobe;
        Facet { normal, alpha: alpha_min, weight, alpha_max, angle }
    }

    /// Its lobe.
    #[must_use]
    pub const fn lobe(&self) -> Lobe {
        Lobe { normal: self.normal, alpha_max: self.alpha_max, alpha_min: self.alpha, angle: self.angle }
    }

    /// True of one width.
    #[must_use]
    pub fn is_round(&self) -> bool {
        self.alpha_max <= self.alpha
    }

    /// Widths of at least `least`.
    #[must_use]
    pub fn wide(&self, least: f64) -> Facet {
        Facet { alpha: self.alpha.max(least), alpha_max: self.alpha_max.max(least), ..*self }
    }

    /// The squared widths as a matrix, in the frame of the facet.
    #[must_use]
    pub fn square(&self) -> DMat2 {
        let (small, large) = (self.alpha * self.alpha, self.alpha_max * self.alpha_max);
        if self.is_round() {
            return DMat2::IDENTITY * small;
        }
        let (sin, cos) = libm::sincos(self.angle);
        let along = DVec2::new(cos, sin);
        DMat2::from_cols(along * along.x, along * along.y) * (large - small) + DMat2::IDENTITY * small
    }

    /// `D(h) (n·h)`, D of GGX. Unit sr⁻¹; 0 behind the facet.
    ///
    /// sin² comes from |h − n|², which keeps its digits for narrow lobes. Source: [Walter2007](crate::cite::WALTER_2007) Eq. 33.
    #[must_use]
    pub fn density(&self, h: DVec3) -> f64 {
        if !self.is_round() {
            return self.lobe().density(h);
        }
        let d = (h - self.normal).length_squared();
        let cos = 1.0 - 0.5 * d;
        if cos <= 0.0 {
            return 0.0;
        }
        let a2 = self.alpha * self.alpha;
        let q = d * (1.0 - 0.25 * d) / a2 + cos * cos;
        cos * FRAC_1_PI / (a2 * q * q)
    }

    /// The part of the lobe that lies above the mesh.
    #[must_use]
    pub fn mass(&self) -> f64 {
        if self.is_round() { mass(self.normal, self.alpha * self.alpha) } else { self.lobe().mass() }
    }
}

/// The part of a GGX lobe about `normal` that lies above the mesh; `square` is α² along the tilt.
///
/// Slopes of GGX along a line have the distribution (1 + x/√(α² + x²))/2; the horizon is the slope cot θ.
fn mass(normal: DVec3, square: f64) -> f64 {
    let sin2 = normal.x * normal.x + normal.y * normal.y;
    let root = (square * sin2 + normal.z * normal.z).sqrt();
    if root > 0.0 { 0.5 * (1.0 + normal.z / root) } else { 1.0 }
}

/// The frame of a lobe: the tangent of the mesh, made perpendicular to `normal`, its bitangent, and `normal`, as shaders do it.
///
/// Guard: a normal along the tangent takes the bitangent of the mesh in its place.
#[must_use]
pub fn frame(normal: DVec3) -> [DVec3; 3] {
    about(normal, if normal.x.abs() < 0.999_999 { DVec3::X } else { DVec3::Y })
}

/// The frame about `normal` whose first axis is `tangent`, made perpendicular to it.
pub(super) fn about(normal: DVec3, tangent: DVec3) -> [DVec3; 3] {
    let tangent = (tangent - normal * normal.dot(tangent)).normalize();
    [tangent, normal.cross(tangent), normal]
}

/// A GGX lobe about a normal: isotropic, or with an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lobe {
    /// Unit normal.
    pub normal: DVec3,
    /// The larger width.
    pub alpha_max: f64,
    /// The smaller width.
    pub alpha_min: f64,
    /// Direction of `alpha_max` in [`frame`], in rad from the tangent, in (−π/2, π/2]; 0 if both are equal.
    pub angle: f64,
}

impl Lobe {
    /// An isotropic lobe.
    #[must_use]
    pub const fn isotropic(normal: DVec3, alpha: f64) -> Lobe {
        Lobe { normal, alpha_max: alpha, alpha_min: alpha, angle: 0.0 }
    }

    /// The lobe whose squared widths are the matrix `square` in [`frame`] of `normal`.
    #[must_use]
    pub fn from_square(normal: DVec3, square: DMat2) -> Lobe {
        let (large, small, angle) = axes(square);
        Lobe { normal, alpha_max: large.max(0.0).sqrt(), alpha_min: small.max(0.0).sqrt(), angle }
    }

    /// Both widths held within bounds; the upper one counts where they cross.
    #[must_use]
    pub fn within(mut self, least: f64, most: f64) -> Lobe {
        self.alpha_max = self.alpha_max.max(least).min(most);
        self.alpha_min = self.alpha_min.max(least).min(most);
        if self.alpha_max - self.alpha_min <= 0.0 {
            self.angle = 0.0;
        }
        self
    }

    /// First axis along `alpha_max`, second, and the normal.
    #[must_use]
    pub fn axes(&self) -> [DVec3; 3] {
        let [t, b, n] = frame(self.normal);
        let (sin, cos) = libm::sincos(self.angle);
        [t * cos + b * sin, b * cos - t * sin, n]
    }

    /// `D(h) (n·h)`, D of anisotropic GGX. Unit sr⁻¹; 0 behind the normal.
    ///
    /// Source: [Burley2012](crate::cite::BURLEY_2012) App. B Eq. 13.
    #[must_use]
    pub fn density(&self, h: DVec3) -> f64 {
        let [t, b, n] = self.axes();
        let cos = n.dot(h);
        if cos <= 0.0 {
            return 0.0;
        }
        let (x, y) = (t.dot(h) / self.alpha_max, b.dot(h) / self.alpha_min);
        let q = x * x + y * y + cos * cos;
        cos * FRAC_1_PI / (self.alpha_max * self.alpha_min * q * q)
    }

    /// The part of the lobe that lies above the mesh.
    #[must_use]
    pub fn mass(&self) -> f64 {
        let [t, b, n] = self.axes();
        let (x, y) = (t.z, b.z);
        let sin2 = x * x + y * y;
        if sin2 <= 0.0 {
            return 1.0;
        }
        let (a, c) = (self.alpha_max * self.alpha_max, self.alpha_min * self.alpha_min);
        mass(n, (a * x * x + c * y * y) / sin2)
    }
}

/// Eigenvalues of a symmetric matrix, the larger first, and the direction of the larger in (−π/2, π/2].
pub(super) fn axes(m: DMat2) -> (f64, f64, f64) {
    let (a, b, c) = (m.x_axis.x, m.x_axis.y, m.y_axis.y);
    let mean = 0.5 * (a + c);
    let half = (0.25 * (a - c) * (a - c) + b * b).sqrt();
    let angle = if half > 1e-12 * mean.abs() { 0.5 * libm::atan2(2.0 * b, a - c) } else { 0.0 };
    let angle = if angle <= -0.5 * PI { angle + PI } else { angle };
    (mean + half, mean - half, angle)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Masses against a sum over the hemisphere.
    #[test]
    fn the_mass_above_the_mesh_is_that_of_a_sum() {
        let n = DVec3::new(0.5, -0.3, 0.4).normalize();
        for lobe in [
            Lobe::isotropic(n, 0.4),
            Lobe { normal: n, alpha_max: 0.7, alpha_min: 0.2, angle: 0.6 },
            Lobe { normal: n, alpha_max: 0.5, alpha_min: 0.1, angle: -1.2 },
        ] {
            let (rings, sectors) = (600, 600);
            let mut sum = 0.0;
            for i in 0..rings {
                let u = (f64::from(i) + 0.5) / f64::from(rings);
                let theta = 0.5 * PI * u;
                for j in 0..sectors {
                    let phi = 2.0 * PI * (f64::from(j) + 0.5) / f64::from(sectors);
                    sum += lobe.density(crate::math::frame::spherical(theta, phi)) * libm::sin(theta);
                }
            }
            let sum = sum * 0.5 * PI / f64::from(rings) * 2.0 * PI / f64::from(sectors);
            assert!((sum - lobe.mass()).abs() < 2e-5, "{lobe:?}: {sum} {}", lobe.mass());
        }
    }

    #[test]
    fn a_lobe_of_equal_widths_is_that_of_a_facet() {
        let facet = Facet::from_slope(DVec2::new(0.3, -0.2), 0.15, 1.0);
        let lobe = Lobe::isotropic(facet.normal, 0.15);
        for h in [DVec3::Z, facet.normal, DVec3::new(0.6, 0.0, 0.8), DVec3::new(-0.8, 0.6, 0.0)] {
            let (a, b) = (facet.density(h), lobe.density(h));
            assert!((a - b).abs() <= 1e-12 * (1.0 + a), "{a} {b}");
        }
        assert!((facet.mass() - lobe.mass()).abs() < 1e-15);
    }
}
