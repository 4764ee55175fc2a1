//! Published formulas of the split sum of GGX, as shaders have them, for the chart of bytes and operations.
//!
//! They were fitted to splits of their own: other maskings, and sums over the samples that stay above the horizon. What they are off by
//! here is what a renderer is off by that puts them in place of the table.
//!
//! Source: [Karis2014](crate::cite::KARIS_2014), `EnvBRDFApprox`; [Narkowicz2014](crate::cite::NARKOWICZ_2014), `EnvDFGLazarov` and
//! `EnvDFGPolynomial`, as public shaders have them.

/// A formula of scale and bias.
pub(super) struct Published {
    /// What the chart calls it.
    pub(super) name: &'static str,
    /// Multiplications, additions, divisions, roots and exponentials; minima, maxima and clamps are not counted.
    pub(super) operations: usize,
    /// Scale and bias of a view cosine and a perceptual roughness.
    pub(super) at: fn(f64, f64) -> [f64; 2],
}

/// All of them.
pub(super) static PUBLISHED: &[Published] = &[
    Published { name: "Karis 2014", operations: 17, at: karis },
    Published { name: "Lazarov 2013 by Narkowicz", operations: 15, at: lazarov },
    Published { name: "Narkowicz 2014", operations: 33, at: narkowicz },
];

fn karis(mu: f64, r: f64) -> [f64; 2] {
    let [x, y, z, w] = [1.0 - r, 0.0425 - 0.0275 * r, 1.04 - 0.572 * r, 0.022 * r - 0.04];
    let a = (x * x).min(libm::exp2(-9.28 * mu)) * x + y;
    [z - 1.04 * a, w + 1.04 * a]
}

/// Gloss of a roughness: of the maps that shaders with these formulas have, the one that they are nearest with.
fn gloss(r: f64) -> f64 {
    1.0 - r.sqrt()
}

fn lazarov(mu: f64, r: f64) -> [f64; 2] {
    let g = gloss(r);
    let at = |slope: f64, start: f64| slope * g + start;
    let lobe = at(0.5745, 0.5753) * at(1.548, -0.2511).min(libm::exp2(-7.672 * mu));
    let bias = (lobe + at(-0.02397, -0.02066)).clamp(0.0, 1.0);
    [at(1.301, 0.4755).clamp(0.0, 1.0) - bias, bias]
}

fn narkowicz(y: f64, r: f64) -> [f64; 2] {
    let x = gloss(r);
    let smooth = -0.1688 * x + 1.895 * x * x;
    let rough = 0.9903 - 4.853 * y + 8.404 * y * y - 5.069 * y * y * y;
    let bias = smooth.min(rough).clamp(0.0, 1.0);
    let sum =
        0.6045 + 1.699 * x - 0.5228 * y - 3.603 * x * x + 1.404 * x * y + 0.1939 * y * y + 2.661 * x * x * x;
    [sum.clamp(0.0, 1.0) - bias, bias]
}

#[cfg(test)]
mod tests {
    use super::PUBLISHED;

    /// All are the split sum of GGX, roughly: smooth surfaces are mirrors at normal view, and both parts are in range.
    #[test]
    fn they_are_split_sums() {
        for p in PUBLISHED {
            let [scale, bias] = (p.at)(1.0, 0.0);
            assert!((scale - 1.0).abs() < 0.05 && bias.abs() < 0.05, "{}: {scale}, {bias}", p.name);
            assert!((p.at)(0.0, 0.0)[1] > 0.8, "{}", p.name);
        }
    }
}
