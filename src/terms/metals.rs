//! Measured indices of eight metals in the visible, and their colour.
//!
//! Rows are those of the papers, as the refractiveindex.info database transcribes them (public domain, CC0):
//! [Polyanskiy2024](crate::cite::POLYANSKIY_2024). Between rows n and k are interpolated linearly in wavelength, which is
//! no better than the spacing of the rows (20 to 40 nm). Evaporated films at room temperature; real surfaces are darker.

use super::blackbody::xyz_to_srgb;
use super::colour::{cie_xyz, d65};
use super::lazanyi;
use crate::cite::{self, Cite};

/// A metal with its measured index.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Metal {
    /// Symbol of the element, in small letters.
    pub id: &'static str,
    /// Name.
    pub name: &'static str,
    /// Where the rows come from.
    pub source: Cite,
    /// Wavelength in nm, n, k; increasing, from below 370 nm to above 800 nm.
    pub rows: &'static [[f64; 3]],
}

/// Wavelengths, nm, at which [`Metal::rgb_index`] reads n and k: red, green, blue.
pub const RGB_NM: [f64; 3] = [650.0, 550.0, 450.0];

/// Every metal.
pub static METALS: &[Metal] = &[
    Metal { id: "ag", name: "silver", source: cite::JOHNSON_CHRISTY_1972, rows: AG },
    Metal { id: "al", name: "aluminium", source: cite::RAKIC_1995, rows: AL },
    Metal { id: "au", name: "gold", source: cite::JOHNSON_CHRISTY_1972, rows: AU },
    Metal { id: "cu", name: "copper", source: cite::JOHNSON_CHRISTY_1972, rows: CU },
    Metal { id: "fe", name: "iron", source: cite::JOHNSON_CHRISTY_1974, rows: FE },
    Metal { id: "ni", name: "nickel", source: cite::JOHNSON_CHRISTY_1974, rows: NI },
    Metal { id: "ti", name: "titanium", source: cite::JOHNSON_CHRISTY_1974, rows: TI },
    Metal { id: "w", name: "tungsten", source: cite::RAKIC_1998, rows: W },
];

/// Finds a metal by its symbol.
#[must_use]
pub fn find(id: &str) -> Option<&'static Metal> {
    METALS.iter().find(|m| m.id == id)
}

/// (n, k) at a wavelength, linear between rows of wavelength, n, k in rising order; the end rows continue beyond them.
///
/// NaN without rows.
#[must_use]
pub fn index(rows: &[impl AsRef<[f64]>], lambda_nm: f64) -> (f64, f64) {
    let row = |i: usize| rows[i].as_ref();
    match rows.iter().position(|r| r.as_ref()[0] >= lambda_nm) {
        Some(0) => (row(0)[1], row(0)[2]),
        Some(i) => {
            let (a, b) = (row(i - 1), row(i));
            let t = (lambda_nm - a[0]) / (b[0] - a[0]);
            (a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2]))
        }
        None => rows.last().map_or((f64::NAN, f64::NAN), |r| (r.as_ref()[1], r.as_ref()[2])),
    }
}

impl Metal {
    /// (n, k) at a wavelength, linear between the rows; the end rows continue beyond them.
    #[must_use]
    pub fn index(&self, lambda_nm: f64) -> (f64, f64) {
        index(self.rows, lambda_nm)
    }

    /// Reflectance at normal incidence in vacuum.
    #[must_use]
    pub fn f0(&self, lambda_nm: f64) -> f64 {
        let (n, k) = self.index(lambda_nm);
        lazanyi::f0(n, k)
    }

    /// (n, k) at [`RGB_NM`]: what renderers with three channels ask for.
    #[must_use]
    pub fn rgb_index(&self) -> [(f64, f64); 3] {
        RGB_NM.map(|lambda| self.index(lambda))
    }

    /// Reflectance at normal incidence as linear sRGB under D65, a perfect mirror being (1, 1, 1).
    ///
    /// `RGB = M ∫ F0 S (x, y, z) dλ` over that of the mirror, channel by channel; S is D65 in steps of 10 nm, the eye is
    /// [`cie_xyz`], 360 to 830 nm by the trapezium rule in steps of 1 nm.
    /// Source: [CIE11664-2](crate::cite::CIE_11664_2) Table B.1 (S), [CIE11664-1](crate::cite::CIE_11664_1) Table 1.
    /// Range: about [0, 1.1]; not clamped, since gold and copper leave the gamut of sRGB a little.
    /// Accuracy: that of the rows, which are 20 to 40 nm apart.
    #[must_use]
    pub fn f0_srgb(&self) -> [f64; 3] {
        let colour = |f: &dyn Fn(f64) -> f64| {
            let mut xyz = [0.0; 3];
            for i in 0..=470_u32 {
                let lambda = 360.0 + f64::from(i);
                let end = if i == 0 || i == 470 { 0.5 } else { 1.0 };
                let light = end * f(lambda) * d65(lambda);
                for (sum, eye) in xyz.iter_mut().zip(cie_xyz(lambda)) {
                    *sum += light * eye;
                }
            }
            xyz_to_srgb(xyz)
        };
        let (metal, white) = (colour(&|lambda| self.f0(lambda)), colour(&|_| 1.0));
        [metal[0] / white[0], metal[1] / white[1], metal[2] / white[2]]
    }
}

const AG: &[[f64; 3]] = &[
    [354.2, 0.10, 1.419],
    [367.9, 0.07, 1.657],
    [381.5, 0.05, 1.864],
    [397.4, 0.05, 2.070],
    [413.3, 0.05, 2.275],
    [430.5, 0.04, 2.462],
    [450.9, 0.04, 2.657],
    [471.4, 0.05, 2.869],
    [495.9, 0.05, 3.093],
    [520.9, 0.05, 3.324],
    [548.6, 0.06, 3.586],
    [582.1, 0.05, 3.858],
    [616.8, 0.06, 4.152],
    [659.5, 0.05, 4.483],
    [704.5, 0.04, 4.838],
    [756.0, 0.03, 5.242],
    [821.1, 0.04, 5.727],
    [892.0, 0.04, 6.312],
];

const AL: &[[f64; 3]] = &[
    [326.28, 0.31474, 3.9165],
    [364.66, 0.39877, 4.3957],
    [413.28, 0.52135, 5.0008],
    [442.80, 0.60790, 5.3676],
    [476.87, 0.72780, 5.7781],
    [516.60, 0.87340, 6.2418],
    [563.57, 1.0728, 6.7839],
    [619.93, 1.3660, 7.4052],
    [652.25, 1.5724, 7.7354],
    [688.81, 1.8301, 8.0601],
    [729.32, 2.1606, 8.3565],
    [774.91, 2.6154, 8.4914],
    [794.78, 2.7675, 8.3866],
    [815.69, 2.7668, 8.2573],
    [837.74, 2.6945, 8.1878],
];

const AU: &[[f64; 3]] = &[
    [354.2, 1.50, 1.866],
    [367.9, 1.48, 1.895],
    [381.5, 1.46, 1.933],
    [397.4, 1.47, 1.952],
    [413.3, 1.46, 1.958],
    [430.5, 1.45, 1.948],
    [450.9, 1.38, 1.914],
    [471.4, 1.31, 1.849],
    [495.9, 1.04, 1.833],
    [520.9, 0.62, 2.081],
    [548.6, 0.43, 2.455],
    [582.1, 0.29, 2.863],
    [616.8, 0.21, 3.272],
    [659.5, 0.14, 3.697],
    [704.5, 0.13, 4.103],
    [756.0, 0.14, 4.542],
    [821.1, 0.16, 5.083],
    [892.0, 0.17, 5.663],
];

const CU: &[[f64; 3]] = &[
    [354.2, 1.37, 1.916],
    [367.9, 1.36, 1.975],
    [381.5, 1.33, 2.045],
    [397.4, 1.32, 2.116],
    [413.3, 1.28, 2.207],
    [430.5, 1.25, 2.305],
    [450.9, 1.24, 2.397],
    [471.4, 1.25, 2.483],
    [495.9, 1.22, 2.564],
    [520.9, 1.18, 2.608],
    [548.6, 1.02, 2.577],
    [582.1, 0.70, 2.704],
    [616.8, 0.30, 3.205],
    [659.5, 0.22, 3.747],
    [704.5, 0.21, 4.205],
    [756.0, 0.24, 4.665],
    [821.1, 0.26, 5.180],
    [892.0, 0.30, 5.768],
];

const FE: &[[f64; 3]] = &[
    [354.0, 1.93, 2.35],
    [368.0, 2.02, 2.43],
    [381.0, 2.12, 2.50],
    [397.0, 2.24, 2.58],
    [413.0, 2.35, 2.65],
    [431.0, 2.48, 2.71],
    [451.0, 2.59, 2.77],
    [471.0, 2.67, 2.82],
    [496.0, 2.74, 2.88],
    [521.0, 2.86, 2.91],
    [549.0, 2.95, 2.93],
    [582.0, 2.94, 2.99],
    [617.0, 2.88, 3.05],
    [659.0, 2.92, 3.10],
    [704.0, 2.86, 3.19],
    [756.0, 2.87, 3.28],
    [821.0, 2.94, 3.39],
    [892.0, 2.96, 3.56],
];

const NI: &[[f64; 3]] = &[
    [354.0, 1.74, 2.32],
    [368.0, 1.70, 2.40],
    [381.0, 1.72, 2.48],
    [397.0, 1.72, 2.57],
    [413.0, 1.70, 2.69],
    [431.0, 1.71, 2.82],
    [451.0, 1.73, 2.95],
    [471.0, 1.78, 3.09],
    [496.0, 1.82, 3.25],
    [521.0, 1.85, 3.42],
    [549.0, 1.92, 3.61],
    [582.0, 1.96, 3.80],
    [617.0, 1.99, 4.02],
    [659.0, 1.99, 4.26],
    [704.0, 2.06, 4.50],
    [756.0, 2.13, 4.73],
    [821.0, 2.26, 4.97],
    [892.0, 2.40, 5.23],
];

const TI: &[[f64; 3]] = &[
    [354.0, 1.82, 2.87],
    [368.0, 1.90, 2.90],
    [381.0, 1.99, 2.93],
    [397.0, 2.08, 2.95],
    [413.0, 2.14, 2.98],
    [431.0, 2.21, 3.01],
    [451.0, 2.27, 3.04],
    [471.0, 2.32, 3.10],
    [496.0, 2.36, 3.19],
    [521.0, 2.44, 3.30],
    [549.0, 2.54, 3.43],
    [582.0, 2.60, 3.58],
    [617.0, 2.67, 3.72],
    [659.0, 2.76, 3.84],
    [704.0, 2.86, 3.96],
    [756.0, 3.00, 4.01],
    [821.0, 3.21, 4.01],
    [892.0, 3.29, 3.96],
];

/// The Brendel-Bormann fit of the paper to measurements, every second or third row of its tabulation.
const W: &[[f64; 3]] = &[
    [353.24, 3.1641, 2.5239],
    [367.41, 3.1911, 2.5221],
    [382.14, 3.2153, 2.5259],
    [397.46, 3.2378, 2.5357],
    [413.40, 3.2600, 2.5517],
    [429.98, 3.2831, 2.5735],
    [447.22, 3.3086, 2.6004],
    [465.15, 3.3377, 2.6311],
    [483.81, 3.3713, 2.6639],
    [503.21, 3.4092, 2.6966],
    [523.39, 3.4510, 2.7269],
    [544.37, 3.4949, 2.7528],
    [566.20, 3.5388, 2.7730],
    [588.91, 3.5799, 2.7867],
    [612.52, 3.6154, 2.7940],
    [637.09, 3.6423, 2.7960],
    [662.63, 3.6580, 2.7944],
    [689.20, 3.6605, 2.7915],
    [716.84, 3.6481, 2.7900],
    [745.59, 3.6195, 2.7932],
    [775.49, 3.5741, 2.8047],
    [806.58, 3.5120, 2.8285],
    [838.93, 3.4338, 2.8690],
];
