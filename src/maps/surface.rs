//! The largest level of a pair of maps: a unit normal and a roughness at each texel.

use super::lobe::Facet;
use glam::{DVec3, Vec3};

/// A number at each texel, or one for all.
#[derive(Debug, Clone, PartialEq)]
pub enum Field<T> {
    /// One for all.
    Constant(T),
    /// Rows from the top.
    Map(Vec<T>),
}

impl<T: Copy> Field<T> {
    /// The value at a texel, a number of the map.
    #[must_use]
    pub fn at(&self, texel: usize) -> T {
        match self {
            Field::Constant(v) => *v,
            Field::Map(values) => values[texel],
        }
    }
}

/// The maps; see the module.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// Width and height in texels.
    pub size: [usize; 2],
    /// Unit normals in the tangent frame, z > 0.
    pub normals: Field<[f32; 3]>,
    /// Roughness r = √α, in [0, 1].
    pub roughness: Field<f32>,
    /// Of lobes of two widths: √ of the larger one, and its direction in rad from the tangent.
    pub stretch: Option<Vec<[f32; 2]>>,
    /// D between the lobes that the map told of and these, where it told of lobes of another kind.
    pub residual: Field<f32>,
}

impl Surface {
    /// The facet of a texel; α = r² has no rounding in f64.
    #[must_use]
    pub fn facet(&self, texel: usize, weight: f64) -> Facet {
        let r = f64::from(self.roughness.at(texel));
        let [x, y, z] = self.normals.at(texel).map(f64::from);
        let facet = Facet::round(DVec3::new(x, y, z).normalize(), r * r, weight);
        match self.stretch.as_ref().map(|s| s[texel].map(f64::from)) {
            Some([wide, angle]) if wide > r => Facet { alpha_max: wide * wide, angle, ..facet },
            _ => facet,
        }
    }
}

/// How a normal map is to be read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Convention {
    /// True if green grows down (DirectX); glTF has it grow up.
    pub green_down: bool,
    /// Blue is not in the map, or not to be trusted: z = √(1 − x² − y²).
    pub derive_z: bool,
    /// Factor of x and y, before the normal is made unit: `normalTexture.scale` of glTF.
    pub scale: f64,
    /// Texels without a direction above the surface are taken as flat, in place of being refused.
    pub mend: bool,
}

impl Default for Convention {
    fn default() -> Self {
        Convention { green_down: false, derive_z: false, scale: 1.0, mend: false }
    }
}

/// A texel that is no normal, or no roughness.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum TexelFault {
    /// Not a number, or infinite.
    #[error("a value is not finite")]
    NotFinite,
    /// (0, 0, 0), or too near to it.
    #[error("the normal has no length")]
    NoLength,
    /// Points along the surface or into it.
    #[error("the normal points along the surface or into it (z = {0})")]
    Below(
        /// z of the unit normal.
        f64,
    ),
    /// A colour or a factor outside [0, 1].
    #[error("value {0} outside [0, 1]")]
    Code(
        /// The value.
        f64,
    ),
    /// Outside [0, 1].
    #[error("roughness {0} outside [0, 1]")]
    Roughness(
        /// The roughness.
        f64,
    ),
}

impl Convention {
    /// The unit normal of the codes of a texel, each on [0, 1] for [−1, 1] (glTF 2.0, section 3.9.3).
    ///
    /// The normal is made unit whatever its length: a short normal is a way of storing it, no roughness.
    ///
    /// # Errors
    /// [`TexelFault`] if there is no direction above the surface in them.
    #[allow(clippy::cast_possible_truncation, reason = "rounded to f32 on purpose")]
    pub fn decode(&self, codes: [f32; 3]) -> Result<[f32; 3], TexelFault> {
        if codes.iter().take(if self.derive_z { 2 } else { 3 }).any(|c| !c.is_finite()) {
            return Err(TexelFault::NotFinite);
        }
        let [x, y, z] = codes.map(|c| 2.0 * f64::from(c) - 1.0);
        let y = if self.green_down { -y } else { y };
        let z = if self.derive_z { (1.0 - x * x - y * y).max(0.0).sqrt() } else { z };
        let raw = DVec3::new(x * self.scale, y * self.scale, z);
        let length = raw.length();
        let fault = if length < 1e-3 {
            TexelFault::NoLength
        } else if raw.z <= 1e-3 * length {
            TexelFault::Below(raw.z / length)
        } else {
            let n = raw / length;
            return Ok([n.x as f32, n.y as f32, n.z as f32]);
        };
        if self.mend { Ok(Vec3::Z.to_array()) } else { Err(fault) }
    }
}

/// Checks a roughness.
///
/// # Errors
/// [`TexelFault`] if it is not in [0, 1].
pub fn roughness(value: f32) -> Result<f32, TexelFault> {
    match value {
        v if !v.is_finite() => Err(TexelFault::NotFinite),
        v if !(0.0..=1.0).contains(&v) => Err(TexelFault::Roughness(f64::from(v))),
        v => Ok(v),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_normals_are_made_unit() {
        let flat = Convention::default().decode([0.5, 0.5, 0.99]).unwrap();
        assert!(flat[0].abs() < 1e-7 && flat[1].abs() < 1e-7 && (flat[2] - 1.0).abs() < 1e-7, "{flat:?}");
    }

    #[test]
    fn conventions_turn_green_and_derive_blue() {
        let down = Convention { green_down: true, derive_z: true, scale: 1.0, mend: false };
        let n = down.decode([0.8, 0.5, f32::NAN]).unwrap();
        assert!((n[0] - 0.6).abs() < 1e-6 && n[1].abs() < 1e-6 && (n[2] - 0.8).abs() < 1e-6, "{n:?}");
        assert!((down.decode([0.5, 0.8, 0.0]).unwrap()[1] + 0.6).abs() < 1e-6);
    }

    #[test]
    fn what_is_no_normal_is_refused() {
        let convention = Convention::default();
        assert_eq!(convention.decode([0.5, 0.5, 0.5]), Err(TexelFault::NoLength));
        assert_eq!(convention.decode([f32::NAN, 0.5, 1.0]), Err(TexelFault::NotFinite));
        assert!(matches!(convention.decode([0.0, 0.0, 0.0]), Err(TexelFault::Below(_))));
        let mend = Convention { mend: true, ..convention };
        assert_eq!(mend.decode([0.0, 0.0, 0.0]), Ok([0.0, 0.0, 1.0]));
    }
}
