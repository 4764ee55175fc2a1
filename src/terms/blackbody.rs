//! Thermal emission: Planck's law, and the eye that sees it.

/// Planck's constant, J s (exact).
const H: f64 = 6.626_070_15e-34;
/// Speed of light, m/s (exact).
const C: f64 = 299_792_458.0;
/// Boltzmann's constant, J/K (exact).
const K: f64 = 1.380_649e-23;

/// Spectral radiance of a black body, `B = 2hc²/λ⁵/(exp(hc/(λkT)) − 1)`.
///
/// Source: [Planck1901](crate::cite::PLANCK_1901), with the exact SI constants of 2019. Units: W sr⁻¹ m⁻³ (per metre of
/// wavelength); 1e-9 of it per nm. Domain: `lambda_nm` in [1, 1e9], temperature in K, ≥ 0. Range: ≥ 0, finite; 0 where it
/// underflows. Accuracy: relative 1e-15 (1 + hc/(λkT)) (`tests/terms.rs`).
#[must_use]
pub fn planck(lambda_nm: f64, temperature: f64) -> f64 {
    let lambda = lambda_nm * 1e-9;
    let x = H * C / (lambda * K * temperature);
    let l2 = lambda * lambda;
    if x.is_finite() { 2.0 * H * C * C / (l2 * l2 * lambda * libm::expm1(x)) } else { 0.0 }
}

/// CIE 1931 colour matching functions (x, y, z) by Wyman, Sloan and Shirley's fit of Gaussians with two slopes.
///
/// Source: [Wyman2013](crate::cite::WYMAN_2013) Eq. 4. Units: 1. Domain: `lambda_nm` in [360, 830]. Range: about [−0.07, 1.8].
/// Kinks of the second derivative at 442, 501.1, 599.8 (x), 530.9, 568.8 (y), 437, 459 (z): split quadratures there.
#[must_use]
pub fn wyman_xyz(lambda_nm: f64) -> [f64; 3] {
    let lobe = |height: f64, center: f64, left: f64, right: f64| {
        let t = (lambda_nm - center) * if lambda_nm < center { left } else { right };
        height * libm::exp(-0.5 * t * t)
    };
    [
        lobe(0.362, 442.0, 0.0624, 0.0374) + lobe(1.056, 599.8, 0.0264, 0.0323)
            - lobe(0.065, 501.1, 0.0490, 0.0382),
        lobe(0.821, 568.8, 0.0213, 0.0247) + lobe(0.286, 530.9, 0.0613, 0.0322),
        lobe(1.217, 437.0, 0.0845, 0.0278) + lobe(0.681, 459.0, 0.0385, 0.0725),
    ]
}

/// Wavelengths, nm, where [`wyman_xyz`] changes slope, with the ends of its domain.
pub const WYMAN_BREAKS: [f64; 9] = [360.0, 437.0, 442.0, 459.0, 501.1, 530.9, 568.8, 599.8, 830.0];

/// XYZ to linear sRGB (white D65).
///
/// Source: IEC 61966-2-1 in the seven digits of [Lindbloom](crate::cite::LINDBLOOM). Range: any; blue is negative for black
/// bodies below about 1900 K.
#[must_use]
pub fn xyz_to_srgb(xyz: [f64; 3]) -> [f64; 3] {
    const ROWS: [[f64; 3]; 3] = [
        [3.2404542, -1.5371385, -0.4985314],
        [-0.9692660, 1.8760108, 0.0415560],
        [0.0556434, -0.2040259, 1.0572252],
    ];
    ROWS.map(|row| row[0] * xyz[0] + row[1] * xyz[1] + row[2] * xyz[2])
}
