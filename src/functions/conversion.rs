//! Parameters of other lobes as widths of GGX.
//!
//! A parametrisation is one entry of [`CONVERSIONS`]: maps and `brdfbake eval` go through the same entry.

pub mod between;
pub mod energy;

pub use between::Told;
pub use energy::Gap;

use super::{FunctionError, FunctionInfo, NO_ANGLES, known, number};
use crate::cite::{self, Cite};
use crate::models::{Param, Params};
use crate::terms::half_vectors::{self, Lobe};
use between::exponent;

/// A way to tell a lobe by one or two numbers.
#[derive(Debug)]
pub struct Conversion {
    /// Id: kebab-case.
    pub id: &'static str,
    /// What the numbers are.
    pub title: &'static str,
    /// Name and range of each number.
    pub numbers: &'static [(&'static str, [f64; 2])],
    /// Sources with equation numbers.
    pub sources: &'static [(Cite, &'static str)],
    /// The lobe of half vectors; a single number is given twice.
    pub lobe: fn([f64; 2]) -> Lobe,
    /// The numbers of a lobe that has the peak of GGX of these widths along x and y; they may lie beyond their ranges.
    pub told: fn([f64; 2]) -> [f64; 2],
    /// The model that is meant, with its parameters for a Fresnel factor of 1; none where the lobe is GGX.
    pub model: Option<fn([f64; 2]) -> ModelOf>,
}

/// Id of a model, and its parameters.
pub type ModelOf = (&'static str, Vec<(&'static str, f64)>);

const WIDTH: [f64; 2] = [1e-3, 1.0];
const POWER: [f64; 2] = [0.0, 1e7];
const UNIT: [f64; 2] = [0.0, 1.0];

/// Widest range of the numbers of any entry.
const NUMBER: [f64; 2] = [0.0, 1e7];

/// Narrowest width that a roughness of 0 stands for here.
const LEAST: f64 = 1e-6;

/// GGX of a roughness r and an anisotropy a, with the ratio of widths that `f` tells.
fn ggx_of(r: f64, widths: [f64; 2]) -> Lobe {
    Lobe::Ggx(widths.map(|w| (r * r * w).max(LEAST)))
}

/// Every parametrisation.
pub static CONVERSIONS: &[Conversion] = TABLE;

const TABLE: &[Conversion] = &[
    Conversion {
        id: "blinn-phong",
        title: "Blinn-Phong exponent n of (n.h)",
        numbers: &[("n", POWER)],
        sources: &[(cite::BLINN_1977, "cosine power"), (cite::WALTER_2007, "Eq. 30")],
        lobe: |[n, _]| Lobe::Power([n; 2]),
        told: |w| w.map(exponent),
        model: Some(|[n, _]| ("blinn-phong-microfacet", vec![("n", n), ("f0", 1.0)])),
    },
    Conversion {
        id: "phong",
        title: "Phong exponent n of (r.v), as a Blinn-Phong lobe of 4 n",
        numbers: &[("n", POWER)],
        sources: &[(cite::LAFORTUNE_WILLEMS_1994, "cosine power")],
        lobe: |[n, _]| Lobe::Power([4.0 * n; 2]),
        told: |w| w.map(|w| 0.25 * exponent(w)),
        model: Some(|[n, _]| ("phong", vec![("kd", 0.0), ("ks", 1.0), ("n", n)])),
    },
    Conversion {
        id: "beckmann",
        title: "Beckmann slope m, as Cook and Torrance have it",
        numbers: &[("m", WIDTH)],
        sources: &[(cite::COOK_TORRANCE_1982, "section 2")],
        lobe: |[m, _]| Lobe::Beckmann([m; 2]),
        told: |w| w,
        model: Some(|[m, _]| ("beckmann", vec![("alpha", m), ("f0", 1.0)])),
    },
    Conversion {
        id: "ward",
        title: "Ward's widths alpha_x, alpha_y",
        numbers: &[("alpha_x", WIDTH), ("alpha_y", WIDTH)],
        sources: &[(cite::WARD_1992, "the elliptical Gaussian lobe")],
        lobe: Lobe::Beckmann,
        told: |w| w,
        model: Some(|[x, y]| ("ward", vec![("rho_d", 0.0), ("rho_s", 1.0), ("alpha_x", x), ("alpha_y", y)])),
    },
    Conversion {
        id: "ashikhmin-shirley",
        title: "exponents n_u, n_v of Ashikhmin and Shirley",
        numbers: &[("n_u", POWER), ("n_v", POWER)],
        sources: &[(cite::ASHIKHMIN_SHIRLEY_2000, "Eq. 4")],
        lobe: Lobe::Power,
        told: |w| w.map(exponent),
        model: Some(|[u, v]| ("ashikhmin-shirley-specular", vec![("rs", 1.0), ("nu", u), ("nv", v)])),
    },
    Conversion {
        id: "alpha",
        title: "GGX width alpha",
        numbers: &[("alpha", WIDTH)],
        sources: &[(cite::WALTER_2007, "Eq. 33")],
        lobe: |[a, _]| Lobe::Ggx([a; 2]),
        told: |w| w,
        model: None,
    },
    Conversion {
        id: "roughness",
        title: "roughness r of glTF, Unreal and Disney: alpha = r^2",
        numbers: &[("r", UNIT)],
        sources: &[(cite::BURLEY_2012, "section 5.4")],
        lobe: |[r, _]| ggx_of(r, [1.0; 2]),
        told: |w| w.map(f64::sqrt),
        model: None,
    },
    Conversion {
        id: "smoothness",
        title: "smoothness s of Unity, glossiness of glTF: alpha = (1 - s)^2",
        numbers: &[("s", UNIT)],
        sources: &[(cite::BURLEY_2012, "section 5.4, with r = 1 - s")],
        lobe: |[s, _]| ggx_of(1.0 - s, [1.0; 2]),
        told: |w| w.map(|w| 1.0 - w.sqrt()),
        model: None,
    },
    Conversion {
        id: "disney",
        title: "roughness and anisotropic of Disney and Standard Surface: alpha = r^2/q, r^2 q, q = sqrt(1 - 0.9 a)",
        numbers: &[("r", UNIT), ("a", UNIT)],
        sources: &[(cite::BURLEY_2012, "App. B")],
        lobe: |[r, a]| {
            let q = (1.0 - 0.9 * a).sqrt();
            ggx_of(r, [1.0 / q, q])
        },
        told: |[x, y]| [(x * y).sqrt().sqrt(), (1.0 - y / x) / 0.9],
        model: None,
    },
    Conversion {
        id: "openpbr",
        title: "roughness and anisotropy of OpenPBR: alpha_t = r^2 sqrt(2/(1 + (1 - a)^2)), alpha_b = (1 - a) alpha_t",
        numbers: &[("r", UNIT), ("a", UNIT)],
        sources: &[(cite::OPENPBR, "section on microfacet model")],
        lobe: |[r, a]| {
            let t = (2.0 / (1.0 + (1.0 - a) * (1.0 - a))).sqrt();
            ggx_of(r, [t, (1.0 - a) * t])
        },
        told: |[x, y]| {
            let ratio = (y / x).min(1.0);
            [(x * (0.5 * (1.0 + ratio * ratio)).sqrt()).sqrt(), 1.0 - ratio]
        },
        model: None,
    },
];

/// Ids of [`CONVERSIONS`], as words of a parameter.
const FROM: &[&str] = &{
    let mut ids = [""; TABLE.len()];
    let mut i = 0;
    while i < ids.len() {
        ids[i] = TABLE[i].id;
        i += 1;
    }
    ids
};

/// How a lobe of another kind becomes GGX.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum By {
    /// By least D.
    Nearest,
    /// By equal peaks.
    Formula,
}

/// What a conversion came to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Converted {
    /// Widths along x and y.
    pub alphas: [f64; 2],
    /// D between the lobe and that GGX lobe.
    pub distance: f64,
}

/// Looks a parametrisation up by its id.
#[must_use]
pub fn conversion(id: &str) -> Option<&'static Conversion> {
    CONVERSIONS.iter().find(|c| c.id == id)
}

impl Conversion {
    /// The GGX lobe of these numbers, which are within their ranges; the second counts only where there are two.
    #[must_use]
    pub fn convert(&self, numbers: [f64; 2], by: By) -> Converted {
        let lobe = (self.lobe)(numbers);
        let alphas = match by {
            By::Nearest => half_vectors::nearest(&lobe),
            By::Formula => half_vectors::formula(&lobe),
        };
        Converted { alphas, distance: half_vectors::distance(&lobe, &Lobe::Ggx(alphas)) }
    }
}

/// Roughness and strength of `KHR_materials_anisotropy`, and true if x is the wider axis.
#[must_use]
pub fn gltf_anisotropy([x, y]: [f64; 2]) -> (f64, f64, bool) {
    let (wide, narrow) = (x.max(y).min(1.0), x.min(y).min(1.0));
    let room = 1.0 - narrow;
    let strength = if room > 0.0 { ((wide - narrow) / room).sqrt() } else { 0.0 };
    (narrow.sqrt(), strength, x >= y)
}

fn undefined(function: &'static str) -> FunctionError {
    FunctionError::Undefined { function, why: "a number is outside the range of this parametrisation" }
}

/// Are these the numbers of a lobe?
fn within(entry: &Conversion, numbers: [f64; 2]) -> bool {
    let within = |(v, (_, [lo, hi])): (&f64, &(&str, [f64; 2]))| (*lo..=*hi).contains(v);
    numbers.iter().zip(entry.numbers).all(within)
}

fn part(p: &Params) -> Result<f64, FunctionError> {
    let Some(entry) = conversion(p.choice("from")?) else { return Err(undefined("to-ggx")) };
    let first = p.number("a")?;
    let numbers = [first, if entry.numbers.len() > 1 { p.number("b")? } else { first }];
    if !within(entry, numbers) {
        return Err(undefined("to-ggx"));
    }
    let by = if p.choice("rule")? == "formula" { By::Formula } else { By::Nearest };
    let converted = entry.convert(numbers, by);
    let Converted { alphas, distance } = converted;
    let (roughness, strength, _) = gltf_anisotropy(alphas);
    Ok(match p.choice("part")? {
        "energy" => entry.gap(numbers, &converted)?.largest,
        "gained" => entry.gap(numbers, &converted)?.gained,
        "alpha_x" => alphas[0],
        "alpha_y" => alphas[1],
        "roughness" => roughness,
        "strength" => strength,
        _ => distance,
    })
}

/// The family.
pub static ALL: &[FunctionInfo] = &[TO_GGX, between::INFO];

const TO_GGX: FunctionInfo = FunctionInfo {
    id: "to-ggx",
    title: "Parameters of another lobe as widths of GGX",
    formula: "argmin D(lobe, GGX), or equal peaks: alpha = sqrt(2 / (n + 2)), alpha = m",
    sources: &[(cite::WALTER_2007, "Eq. 30 and 33")],
    params: &[
        Param::choice("from", "what the numbers are", FROM),
        number("a", "the number; the first of two", NUMBER, 10.0),
        number("b", "the second number, where there are two", NUMBER, 10.0),
        Param::choice("rule", "by least D, or by equal peaks", &["nearest", "formula"]),
        Param::choice(
            "part",
            "alpha_x; alpha_y; roughness and strength of KHR_materials_anisotropy; D; largest difference of E over mu in [0.05, 1]; what E gains",
            &["alpha_x", "alpha_y", "roughness", "strength", "distance", "energy", "gained"],
        ),
    ],
    inputs: &[],
    unit: "1",
    range: [0.0, 1e3],
    notes: "D is half the integral of the difference of D cos over the hemisphere. No GGX is nearer to Beckmann than 0.17977.",
    also: &[],
    known: &[
        known(&[("a", "6"), ("rule", "\"formula\"")], NO_ANGLES, 0.5, 1e-15, "closed form: sqrt(2 / 8)"),
        known(
            &[("from", "\"beckmann\""), ("a", "0.5"), ("rule", "\"formula\""), ("part", "\"distance\"")],
            NO_ANGLES,
            0.203_632_2,
            1e-6,
            "sum over the hemisphere by another program",
        ),
        known(
            &[
                ("from", "\"ward\""),
                ("a", "0.3"),
                ("b", "0.1"),
                ("rule", "\"formula\""),
                ("part", "\"strength\""),
            ],
            NO_ANGLES,
            0.471_404_520_791_031_7,
            1e-14,
            "closed form: sqrt(0.2 / 0.9)",
        ),
    ],
    eval: |p, _| part(p),
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_and_entries_are_the_same() {
        let ids: Vec<&str> = CONVERSIONS.iter().map(|c| c.id).collect();
        assert_eq!(ids, FROM);
    }
}
