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
    /// A strength without a direction.
    #[error("the direction of the anisotropy has no length")]
    NoDirection,
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

/// Shorter normals have no direction: the middle codes of 8 bits, 127 and 128, which stand for 0, make them up to 0.0068 long.
const SHORTEST: f64 = 1e-2;

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
        let fault = if length < SHORTEST {
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

/// √ of the larger width of a facet of this roughness, and its direction in (−π/2, π/2] from the tangent, of the codes of
/// `KHR_materials_anisotropy`: direction on [0, 1] for [−1, 1], and strength; `strength` is a factor of it, `rotation` a turn in rad.
///
/// α_t = α_b + (1 − α_b) s². Guard: where the strength is 0, the direction is not read.
///
/// # Errors
/// [`TexelFault`] for codes that are no direction or no strength.
#[allow(clippy::cast_possible_truncation, reason = "rounded to f32 on purpose")]
pub fn stretch(
    roughness: f32,
    codes: [f32; 3],
    strength: f64,
    rotation: f64,
) -> Result<[f32; 2], TexelFault> {
    if codes.iter().any(|c| !c.is_finite()) {
        return Err(TexelFault::NotFinite);
    }
    let [x, y, s] = codes.map(f64::from);
    if !(0.0..=1.0).contains(&s) {
        return Err(TexelFault::Code(s));
    }
    let s = s * strength;
    if s <= 0.0 {
        return Ok([roughness, 0.0]);
    }
    let (x, y) = (2.0 * x - 1.0, 2.0 * y - 1.0);
    if x * x + y * y < 1e-6 {
        return Err(TexelFault::NoDirection);
    }
    let alpha = f64::from(roughness) * f64::from(roughness);
    let wide = alpha + (1.0 - alpha) * s * s;
    let turns = (libm::atan2(y, x) + rotation) / std::f64::consts::PI;
    // an axis has no sense: half a turn is none
    let turns = turns - libm::ceil(turns - 0.5);
    Ok([(wide.sqrt() as f32).max(roughness), (turns * std::f64::consts::PI) as f32])
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
    fn strengths_and_directions_are_those_of_the_extension() {
        // roughness 0.3, strength 0.6: alpha_t = 0.09 + 0.91 * 0.36
        let [wide, angle] = stretch(0.3, [1.0, 0.5, 1.0], 0.6, 0.0).unwrap();
        assert!((wide * wide - 0.4176).abs() < 1e-6 && angle.abs() < 1e-6, "{wide} {angle}");
        let pi = std::f32::consts::PI;
        let turned = |codes, rotation| stretch(0.3, codes, 1.0, rotation).unwrap()[1];
        assert!((turned([0.5, 1.0, 1.0], 0.0) - 0.5 * pi).abs() < 1e-6);
        assert!((turned([0.5, 1.0, 1.0], 0.25 * std::f64::consts::PI) + 0.25 * pi).abs() < 1e-6);
        assert!((turned([0.0, 0.5, 1.0], 0.0)).abs() < 1e-6);
        assert_eq!(stretch(0.3, [0.5, 0.5, 0.0], 1.0, 1.0), Ok([0.3, 0.0]));
        assert_eq!(stretch(0.3, [0.5, 0.5, 1.0], 1.0, 1.0), Err(TexelFault::NoDirection));
    }

    #[test]
    fn what_is_no_normal_is_refused() {
        let convention = Convention::default();
        let middle = [127.0, 128.0, 128.0].map(|code: f32| code / 255.0);
        for none in [[0.5; 3], middle, [128.0 / 255.0; 3]] {
            assert_eq!(convention.decode(none), Err(TexelFault::NoLength));
        }
        assert_eq!(convention.decode([f32::NAN, 0.5, 1.0]), Err(TexelFault::NotFinite));
        assert!(matches!(convention.decode([0.0, 0.0, 0.0]), Err(TexelFault::Below(_))));
        let mend = Convention { mend: true, ..convention };
        assert_eq!(mend.decode([0.0, 0.0, 0.0]), Ok([0.0, 0.0, 1.0]));
    }
}
