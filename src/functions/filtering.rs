//! Filtering of normal maps.

use super::{FunctionInfo, NO_ANGLES, REFERENCE, alias, known, number};
use crate::cite;
use crate::terms::normal_filtering::{self, Lean};

/// The family.
pub static ALL: &[FunctionInfo] = &[
    FunctionInfo {
        id: "toksvig",
        title: "Toksvig's exponent of an averaged normal",
        formula: "s |N| / (|N| + s (1 - |N|))",
        sources: &[(cite::TOKSVIG_2005, "the shortened exponent")],
        params: &[
            number("length", "length of the mean normal", [0.0, 1.0], 0.9).also(&["Na"]),
            number("s", "Blinn-Phong exponent", [0.0, 1e9], 64.0),
        ],
        inputs: &[],
        unit: "1",
        range: [0.0, f64::MAX],
        notes: "Multiply the lobe by (1 + s') / (1 + s).",
        also: &[alias("toksvig_power")],
        known: &[known(&[("length", "0.25"), ("s", "8")], NO_ANGLES, 0.32, 1e-15, "closed form: 2 / 6.25")],
        eval: |p, _| Ok(normal_filtering::toksvig(p.number("s")?, p.number("length")?)),
    },
    FunctionInfo {
        id: "tokuyoshi-kaplanyan",
        title: "Width widened by the variance of normals in a pixel",
        formula: "sqrt(min(1, alpha^2 + min(2 sigma2 d2, kappa)))",
        sources: &[
            (cite::TOKUYOSHI_KAPLANYAN_2019, "the isotropic filter"),
            (cite::FILAMENT_SHADERS, "`normalFiltering`: the same form"),
        ],
        params: &[
            number("alpha", "width; alpha = roughness^2", [0.0, 1.0], 0.25),
            number("d2", "|dn/dx|^2 + |dn/dy|^2 in screen space", [0.0, 1e9], 0.0)
                .also(&["dndx2_plus_dndy2"]),
            number("sigma2", "variance of the pixel filter", [0.0, 1e3], 0.25),
            number("kappa", "largest widening of alpha^2", [0.0, 1.0], 0.18),
        ],
        inputs: &[],
        unit: "1",
        range: [0.0, 1.0],
        notes: "For isotropic lobes.",
        also: &[alias("tokuyoshi_kaplanyan_alpha")],
        known: &[known(
            &[("alpha", "0.125"), ("d2", "0.03125")],
            NO_ANGLES,
            0.125 * std::f64::consts::SQRT_2,
            1e-14,
            "closed form: alpha^2 doubles",
        )],
        eval: |p, _| {
            let (d2, sigma2) = (p.number("d2")?, p.number("sigma2")?);
            Ok(normal_filtering::tokuyoshi_kaplanyan(p.number("alpha")?, d2, sigma2, p.number("kappa")?))
        },
    },
    FunctionInfo {
        id: "lean-density",
        title: "Density of slopes of a LEAN map",
        formula: "exp(-(h - B)^T S^-1 (h - B) / 2) / (2 pi sqrt|S|), S = M - B B^T + 1 / s",
        sources: &[(cite::OLANO_BAKER_2010, "the Gaussian of slopes and its covariance")],
        params: &[
            number("bx", "mean slope along x", [-100.0, 100.0], 0.0).also(&["Bx"]),
            number("by", "mean slope along y", [-100.0, 100.0], 0.0).also(&["By"]),
            number("mxx", "second moment xx", [0.0, 1e4], 0.0).also(&["Mxx"]),
            number("mxy", "second moment xy", [-1e4, 1e4], 0.0).also(&["Mxy"]),
            number("myy", "second moment yy", [0.0, 1e4], 0.0).also(&["Myy"]),
            number("s", "exponent of the base roughness", [1e-3, 1e9], 64.0),
            number("hx", "slope of the half vector along x", [-1e6, 1e6], 0.0).also(&["hx_over_hz"]),
            number("hy", "slope of the half vector along y", [-1e6, 1e6], 0.0).also(&["hy_over_hz"]),
        ],
        inputs: &[],
        unit: "1",
        range: [0.0, f64::MAX],
        notes: "D of Beckmann is this over cos^4, with alpha^2 = 2 / s.",
        also: &[alias("lean_slope_density")],
        known: &[
            known(
                &[("s", "32")],
                NO_ANGLES,
                16.0 * std::f64::consts::FRAC_1_PI,
                1e-14,
                "closed form: s / (2 pi)",
            ),
            known(
                &[("mxx", "0.25"), ("myy", "0.125"), ("s", "32"), ("hx", "0.25"), ("hy", "-0.25")],
                NO_ANGLES,
                0.556_224_371_869_938_3,
                1e-13,
                REFERENCE,
            ),
        ],
        eval: |p, _| {
            let lean = Lean {
                mean: [p.number("bx")?, p.number("by")?],
                moments: [p.number("mxx")?, p.number("mxy")?, p.number("myy")?],
                power: p.number("s")?,
            };
            Ok(lean.slope_density([p.number("hx")?, p.number("hy")?]))
        },
    },
];
