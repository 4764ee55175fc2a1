//! Zeltner, Burley and Chiang's sheen: the multiple scattering of a layer of fibres, fitted by a transformed cosine.
//!
//! `roughness` 0.1 is a rim at the silhouette, 0.5 velvet, 1 dusty. The fits are rational functions that MaterialX ships
//! in place of the authors' table.

use super::ltc::Ltc;

/// The lobe and its reflectance for one view cosine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sheen {
    /// M⁻¹ = [[a, 0, b], [0, a, 0], [0, 0, 1]]: scale.
    pub a: f64,
    /// M⁻¹: shear.
    pub b: f64,
    /// Directional albedo R. The fit dips to −2.1e-5 at roughness near 0.1; not clamped here.
    pub reflectance: f64,
}

impl Sheen {
    /// The fitted lobe.
    ///
    /// With x = `mu_o`, y = roughness:
    /// ```text
    /// a = (2.58126 x + .813703 y) y/(1 + .310327 x² + 2.60994 x y)
    /// b = √(1 − x) (y − 1) y³/(.0000254053 + 1.71228 x − 1.71506 x y + 1.34174 y²)
    /// s = y (.0206607 + 1.58491 y)/(.0379424 + y (1.32227 + y))
    /// m = y (−.193854 + y (−1.14885 + y (1.7932 − .95943 y²)))/(.046391 + y)
    /// o = y (.000654023 + (−.0207818 + .119681 y) y)/(1.26264 + y (−1.92021 + y))
    /// R = exp(−((x − m)/s)²/2)/(s √(2π)) + o
    /// ```
    /// Source: [Zeltner2022](crate::cite::ZELTNER_2022) for the model; the fits are those of MaterialX (`mx_zeltner_sheen`).
    /// Domain: `mu_o` in [0, 1], roughness in [0.01, 1], both clamped. Accuracy: as a fit, relative 1e-12 (`tests/functions.rs`).
    #[must_use]
    pub fn new(mu_o: f64, roughness: f64) -> Self {
        let (x, y) = (mu_o.clamp(0.0, 1.0), roughness.clamp(0.01, 1.0));
        let a = (2.58126 * x + 0.813703 * y) * y / (1.0 + 0.310327 * x * x + 2.60994 * x * y);
        let b = (1.0 - x).sqrt() * (y - 1.0) * y * y * y
            / (0.0000254053 + 1.71228 * x - 1.71506 * x * y + 1.34174 * y * y);
        Self { a, b, reflectance: reflectance(x, y) }
    }

    /// The lobe as a transformed cosine: M is the inverse, scaled.
    #[must_use]
    pub fn lobe(&self) -> Ltc {
        Ltc { m11: 1.0 / self.a, m22: 1.0 / self.a, m13: -self.b / self.a, m31: 0.0 }
    }
}

/// R of [`Sheen::new`].
fn reflectance(x: f64, y: f64) -> f64 {
    let s = y * (0.0206607 + 1.58491 * y) / (0.0379424 + y * (1.32227 + y));
    let m = y * (-0.193854 + y * (-1.14885 + y * (1.7932 - 0.95943 * y * y))) / (0.046391 + y);
    let o = y * (0.000654023 + (-0.0207818 + 0.119681 * y) * y) / (1.26264 + y * (-1.92021 + y));
    let t = (x - m) / s;
    libm::exp(-0.5 * t * t) / (s * (2.0 * std::f64::consts::PI).sqrt()) + o
}
