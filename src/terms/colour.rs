//! Light and eye of colorimetry: the CIE 1931 standard observer, the illuminant D65, linear sRGB.
//!
//! The numbers of the observer are those of the CIE, in `cie_xyz_1931_2deg.csv` beside this file (CC BY-SA 4.0, as the file says). Fits such as
//! [`wyman_xyz`](super::blackbody::wyman_xyz) are off by as much as 2e-3 in the colour of gold, more than a half-float texel may be.

use std::sync::OnceLock;

/// First and last wavelength of the observer, nm; its rows are 1 nm apart.
pub const VISIBLE_NM: [f64; 2] = [360.0, 830.0];

/// The rows `x, y, z` of the file, from 360 nm in steps of 1 nm.
fn rows() -> &'static [[f64; 3]] {
    static ROWS: OnceLock<Vec<[f64; 3]>> = OnceLock::new();
    ROWS.get_or_init(|| {
        let number = |cell: Option<&str>| cell.and_then(|c| c.parse().ok()).unwrap_or(f64::NAN);
        let lines = include_str!("cie_xyz_1931_2deg.csv").lines().filter(|l| !l.starts_with('#'));
        let row = |line: &str| {
            let mut cells = line.split(',').skip(1);
            [0; 3].map(|_| number(cells.next()))
        };
        lines.map(row).collect()
    })
}

/// Colour-matching functions (x, y, z) of the CIE 1931 standard observer, linear between the rows, 0 outside.
///
/// Source: [CIE11664-1](crate::cite::CIE_11664_1) Table 1, 1 nm. Units: 1. Domain: nm. Range: [0, 1.78]. It has a kink at each nm.
#[must_use]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "in [0, 470]")]
pub fn cie_xyz(lambda_nm: f64) -> [f64; 3] {
    let [first, last] = VISIBLE_NM;
    if !(first..=last).contains(&lambda_nm) {
        return [0.0; 3];
    }
    let x = lambda_nm - first;
    let i = (x as usize).min(469);
    let t = x - i as f64;
    let rows = rows();
    [0, 1, 2].map(|c| rows[i][c] + t * (rows[i + 1][c] - rows[i][c]))
}

/// Relative power of D65, 100 at 560 nm; linear between steps of 10 nm from 360 to 830 nm, 0 outside.
///
/// Source: [CIE11664-2](crate::cite::CIE_11664_2) Table B.1, every second row: those between are the means of their neighbours.
#[must_use]
pub fn d65(lambda_nm: f64) -> f64 {
    let x = (lambda_nm - 360.0) / 10.0;
    let steps = D65.iter().zip(&D65[1..]).enumerate();
    for (i, (a, b)) in steps {
        let t = x - i as f64;
        if (0.0..=1.0).contains(&t) {
            return a + t * (b - a);
        }
    }
    0.0
}

const D65: [f64; 48] = [
    46.6383, 52.0891, 49.9755, 54.6482, 82.7549, 91.486, 93.4318, 86.6823, 104.865, 117.008, 117.812,
    114.861, 115.923, 108.811, 109.354, 107.802, 104.79, 107.689, 104.405, 104.046, 100.0, 96.3342, 95.788,
    88.6856, 90.0062, 89.5991, 87.6987, 83.2886, 83.6992, 80.0268, 80.2146, 82.2778, 78.2842, 69.7213,
    71.6091, 74.349, 61.604, 69.8856, 75.087, 63.5927, 46.4182, 66.8054, 63.3828, 64.304, 59.4519, 51.959,
    57.4406, 60.3125,
];
