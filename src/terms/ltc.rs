//! Linearly transformed cosines: a clamped cosine bent by a matrix, which integrates over polygons in closed form.

use crate::math::special;
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_1_PI, PI};

/// The lobe of `M = [[m11, 0, m13], [0, m22, 0], [m31, 0, 1]]`, the form that an isotropic material needs.
///
/// The view direction lies in the xz plane. Only ratios of the matrix matter; here its last entry is 1.
/// Domain: m22 > 0, m11 − m13 m31 > 0 (no mirror image). `m31` = 0 in the tables that engines ship.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ltc {
    /// Stretch along x.
    pub m11: f64,
    /// Stretch along y.
    pub m22: f64,
    /// Shear of x by z.
    pub m13: f64,
    /// Shear of z by x.
    pub m31: f64,
}

impl Ltc {
    /// The clamped cosine itself.
    pub const COSINE: Ltc = Ltc { m11: 1.0, m22: 1.0, m13: 0.0, m31: 0.0 };

    /// m11 − m13 m31: the determinant over m22.
    fn minor(&self) -> f64 {
        self.m11 - self.m13 * self.m31
    }

    /// `(m11 − m13 m31) M⁻¹ w`.
    fn unbend(&self, w: DVec3) -> DVec3 {
        let y = w.y * (self.minor() / self.m22);
        DVec3::new(w.x - self.m13 * w.z, y, self.m11 * w.z - self.m31 * w.x)
    }

    /// Density over directions, `D = max(0, z(v/|v|))/π · |det M⁻¹|/|v|³`, v = M⁻¹ w.
    ///
    /// Source: [Heitz2016](crate::cite::HEITZ_2016) Eqs. 1 and 3. Units: sr⁻¹. Domain: `w` unit. Range: ≥ 0, finite.
    /// Law: ∫ D dω = 1 over the sphere. Guard: a matrix outside its domain gives 0. Accuracy: relative 1e-13
    /// (`tests/terms.rs`).
    #[must_use]
    pub fn density(&self, w: DVec3) -> f64 {
        let (minor, v) = (self.minor(), self.unbend(w));
        let square = v.length_squared();
        if v.z > 0.0 && minor > 0.0 && self.m22 > 0.0 && square > 0.0 {
            let ratio = minor / square;
            FRAC_1_PI * v.z * ratio * ratio / self.m22
        } else {
            0.0
        }
    }

    /// A direction with [`Ltc::density`]: `w = normalize(M z)`, z cosine-distributed, from two uniform numbers.
    ///
    /// Source: [Heitz2016](crate::cite::HEITZ_2016) §3.2.
    #[must_use]
    pub fn sample(&self, u: DVec2) -> DVec3 {
        let (cos, sin) = special::circle(u.y);
        let r = u.x.sqrt();
        let z = DVec3::new(r * cos, r * sin, (1.0 - u.x).max(0.0).sqrt());
        super::smith::normal_or_z(DVec3::new(
            self.m11 * z.x + self.m13 * z.z,
            self.m22 * z.y,
            self.m31 * z.x + z.z,
        ))
    }

    /// Integral of the lobe over a polygon seen from the origin, its vertices counter-clockwise: the form factor.
    ///
    /// Vertices are taken through M⁻¹ and clipped at z = 0; then `I = Σ θ_ij n_ij·z/(2π)` over the edges, θ the angle between
    /// neighbours and n the normal of their plane; θ by atan2, as acos loses half the digits for short edges.
    /// Source: [Heitz2016](crate::cite::HEITZ_2016) for M, after Lambert; [ltc_quad.fs of the authors](crate::cite::HEITZ_2016) sums the same edges. Range: [0, 1]; its negative if
    /// the polygon is clockwise. Accuracy: 1e-14 absolute (`tests/terms.rs`).
    #[must_use]
    pub fn form_factor(&self, polygon: &[DVec3]) -> f64 {
        let unbent: Vec<DVec3> = polygon.iter().map(|&v| self.unbend(v)).collect();
        let clipped = clip(&unbent);
        let next = clipped.iter().cycle().skip(1);
        clipped.iter().zip(next).map(|(&a, &b)| edge(a, b)).sum::<f64>() / (2.0 * PI)
    }
}

/// The angle between two directions times the height of the normal of their plane.
fn edge(a: DVec3, b: DVec3) -> f64 {
    let normal = a.cross(b);
    let length = normal.length();
    if length > 0.0 { libm::atan2(length, a.dot(b)) * (normal.z / length) } else { 0.0 }
}

/// The part of a polygon above z = 0.
fn clip(polygon: &[DVec3]) -> Vec<DVec3> {
    let mut out = Vec::with_capacity(polygon.len() + 1);
    for (i, &a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        if a.z >= 0.0 {
            out.push(a);
        }
        if (a.z < 0.0) != (b.z < 0.0) {
            let t = a.z / (a.z - b.z);
            let cut = a + t * (b - a);
            out.push(DVec3::new(cut.x, cut.y, 0.0));
        }
    }
    out
}

/// The inverse matrix `M⁻¹ = [[m11, 0, m13], [0, m22, 0], [m31, 0, m33]]`, the form that a shader multiplies with.
///
/// The view direction lies in the xz plane, at positive x. Only ratios matter. It holds lobes that [`Ltc`] does not:
/// those whose axis points below the horizon. Domain: m22 > 0 and m11 m33 − m13 m31 > 0 (no mirror image).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inverse {
    /// Row x, column x.
    pub m11: f64,
    /// Row x, column z.
    pub m13: f64,
    /// Row y, column y.
    pub m22: f64,
    /// Row z, column x.
    pub m31: f64,
    /// Row z, column z.
    pub m33: f64,
}

impl Inverse {
    /// The clamped cosine itself.
    pub const COSINE: Inverse = Inverse { m11: 1.0, m13: 0.0, m22: 1.0, m31: 0.0, m33: 1.0 };

    /// m11 m33 − m13 m31: the determinant over m22.
    #[must_use]
    pub fn minor(&self) -> f64 {
        self.m11 * self.m33 - self.m13 * self.m31
    }

    /// `M⁻¹ w`.
    #[must_use]
    pub fn apply(&self, w: DVec3) -> DVec3 {
        DVec3::new(self.m11 * w.x + self.m13 * w.z, self.m22 * w.y, self.m31 * w.x + self.m33 * w.z)
    }

    /// `M v`, times [`Inverse::minor`].
    #[must_use]
    pub fn undo(&self, v: DVec3) -> DVec3 {
        let y = v.y * (self.minor() / self.m22);
        DVec3::new(self.m33 * v.x - self.m13 * v.z, y, self.m11 * v.z - self.m31 * v.x)
    }

    /// Density over directions; see [`Ltc::density`].
    ///
    /// Source: [Heitz2016](crate::cite::HEITZ_2016) Eqs. 1 and 3. Units: sr⁻¹. Domain: `w` unit. Range: ≥ 0, finite.
    /// Guard: a matrix outside its domain gives 0. Accuracy: that of [`Ltc::density`] (`tests/ltc.rs`).
    #[must_use]
    pub fn density(&self, w: DVec3) -> f64 {
        let (det, v) = (self.minor() * self.m22, self.apply(w));
        let square = v.length_squared();
        if v.z > 0.0 && det > 0.0 && self.m22 > 0.0 { FRAC_1_PI * det * v.z / (square * square) } else { 0.0 }
    }

    /// The same lobe with another scale: every entry times `factor`.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Inverse {
        Inverse {
            m11: self.m11 * factor,
            m13: self.m13 * factor,
            m22: self.m22 * factor,
            m31: self.m31 * factor,
            m33: self.m33 * factor,
        }
    }
}
