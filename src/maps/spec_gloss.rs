//! Specular-glossiness, as `KHR_materials_pbrSpecularGlossiness` has it, to metallic-roughness.
//!
//! Two ways, each with its own loss:
//!
//! | way | F0, F90, roughness | diffuse | needs |
//! |---|---|---|---|
//! | exact | exact | weighed by 1 − max F(v.h) and not by 1 − max F0: [`diffuse_ratio`] | `KHR_materials_specular`, `KHR_materials_ior` with ior 0 |
//! | [`solve`] | F0 off by [`Solved::f0_error`], up to about 0.077 | as the conversion has it | nothing but the core of glTF |
//!
//! All colours are linear.

use crate::integrate::gauss;
use std::f64::consts::PI;

/// F0 of a dielectric in metallic-roughness: ior 1.5.
pub const DIELECTRIC: f64 = 0.04;

/// Divisors are at least this.
const EPSILON: f64 = 1e-6;

/// A texel of metallic-roughness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solved {
    /// Base colour, [0, 1].
    pub base: [f64; 3],
    /// Metallic, [0, 1].
    pub metallic: f64,
}

impl Solved {
    /// F0 of metallic-roughness: `0.04 (1 − m) + base m`.
    /// Source: [glTF2](crate::cite::GLTF_2) Appendix B.2.
    #[must_use]
    pub fn f0(&self) -> [f64; 3] {
        self.base.map(|b| DIELECTRIC * (1.0 - self.metallic) + b * self.metallic)
    }

    /// Largest difference of F0 to a specular colour, over the channels.
    #[must_use]
    pub fn f0_error(&self, specular: [f64; 3]) -> f64 {
        self.f0().iter().zip(specular).map(|(f0, s)| (f0 - s).abs()).fold(0.0, f64::max)
    }
}

/// Base colour and metallic of a diffuse and a specular colour.
///
/// With s = max(specular), q(c) = sqrt(0.299 r² + 0.587 g² + 0.114 b²) and d = 0.04, metallic is the root in [0, 1] of
/// `d m² + (q(diffuse) (1 − s)/(1 − d) + q(specular) − 2 d) m + d − q(specular) = 0`, and 0 where q(specular) < d. Base colour mixes,
/// by m², what the diffuse colour asks for, `diffuse (1 − s)/((1 − d) (1 − m))`, with what the specular colour asks for,
/// `(specular − d (1 − m))/m`, and is clamped.
/// Source: [KHR_materials_pbrSpecularGlossiness](crate::cite::KHR_SPECULAR_GLOSSINESS), `convertToMetallicRoughness`; divisors are at least 1e-6.
/// Domain: [0, 1] (values outside are clamped). Range: [0, 1].
#[must_use]
pub fn solve(diffuse: [f64; 3], specular: [f64; 3]) -> Solved {
    let (diffuse, specular) = (diffuse.map(unit), specular.map(unit));
    let rest = 1.0 - specular.iter().copied().fold(0.0, f64::max);
    let metallic = metallic(brightness(diffuse), brightness(specular), rest);
    let mix = metallic * metallic;
    let channel = |c: usize| {
        let from_diffuse = diffuse[c] * rest / (1.0 - DIELECTRIC) / (1.0 - metallic).max(EPSILON);
        let from_specular = (specular[c] - DIELECTRIC * (1.0 - metallic)) / metallic.max(EPSILON);
        unit(from_diffuse + (from_specular - from_diffuse) * mix)
    };
    Solved { base: [0, 1, 2].map(channel), metallic }
}

fn unit(x: f64) -> f64 {
    // NaN becomes 0, which it cannot be: colours are finite
    x.clamp(0.0, 1.0)
}

fn brightness([r, g, b]: [f64; 3]) -> f64 {
    (0.299 * r * r + 0.587 * g * g + 0.114 * b * b).sqrt()
}

fn metallic(diffuse: f64, specular: f64, rest: f64) -> f64 {
    if specular < DIELECTRIC {
        return 0.0;
    }
    let b = diffuse * rest / (1.0 - DIELECTRIC) + specular - 2.0 * DIELECTRIC;
    let c = DIELECTRIC - specular;
    // c ≤ 0, so that the root is real
    unit(((b * b - 4.0 * DIELECTRIC * c).max(0.0).sqrt() - b) / (2.0 * DIELECTRIC))
}

/// By how much the diffuse part of an exact conversion is less than that of specular-glossiness, seen at mu_o under even light:
/// `1 − <(1 − v.h)⁵>`, the mean weighted by mu_i over the hemisphere of light.
///
/// glTF weighs the diffuse part by 1 − max F(v.h), specular-glossiness by 1 − max F0; with F90 = 1 their ratio is this for every F0.
/// Source: [glTF2](crate::cite::GLTF_2) Appendix B.3.4 and B.3.5, integrated.
/// Domain: mu_o in [0, 1]. Range: (0.97, 1]. Accuracy: 1e-6.
#[must_use]
pub fn diffuse_ratio(mu_o: f64) -> f64 {
    const AZIMUTHS: u32 = 256;
    let (mu_o, rule) = (unit(mu_o), gauss::rule(128));
    let sin_o = (1.0 - mu_o * mu_o).max(0.0).sqrt();
    let lost = rule.integrate(0.0, 1.0, |mu_i| {
        let across = sin_o * (1.0 - mu_i * mu_i).max(0.0).sqrt();
        let ring = |k: u32| {
            let phi = PI * (f64::from(k) + 0.5) / f64::from(AZIMUTHS);
            let between = mu_o * mu_i + across * libm::cos(phi);
            let mu_h = (0.5 * (1.0 + between)).max(0.0).sqrt();
            libm::pow((1.0 - mu_h).max(0.0), 5.0)
        };
        2.0 * mu_i * (0..AZIMUTHS).map(ring).sum::<f64>() / f64::from(AZIMUTHS)
    });
    1.0 - lost
}
