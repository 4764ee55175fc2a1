//! Other lobes as GGX: values by sums over the hemisphere that another program made.
#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "test")]

use crate::tolerance::{
    DIGITS_LOST, FEW_ROUNDINGS, INVERTED_9, LOBE_DIGITS, LOBE_DIGITS_NINE, LOBE_DIGITS_SIX, LOBE_ENERGY,
    LOBE_SUM,
};
use brdfbake::functions::conversion::{By, CONVERSIONS, conversion, gltf_anisotropy};
use brdfbake::terms::half_vectors::{Lobe, distance};

/// Exponent, D by equal peaks, least D, its width.
const POWERS: [(f64, f64, f64, f64); 4] = [
    (1.0, 0.0579, 0.0521, 0.7856),
    (10.0, 0.1627, 0.1445, 0.3664),
    (100.0, 0.1986, 0.1755, 0.1227),
    (1000.0, 0.2031, 0.1793, 0.0390),
];

#[test]
fn exponents_become_the_nearest_widths() {
    let entry = conversion("blinn-phong").unwrap();
    for (n, peak, least, alpha) in POWERS {
        let formula = entry.convert([n; 2], By::Formula);
        assert!((formula.alphas[0] - (2.0 / (n + 2.0)).sqrt()).abs() < FEW_ROUNDINGS);
        assert!((formula.distance - peak).abs() < LOBE_DIGITS, "{n}: {}", formula.distance);
        let nearest = entry.convert([n; 2], By::Nearest);
        assert!((nearest.distance - least).abs() < LOBE_DIGITS, "{n}: {}", nearest.distance);
        assert!((nearest.alphas[0] - alpha).abs() < LOBE_DIGITS, "{n}: {:?}", nearest.alphas);
    }
}

/// No GGX is nearer to Beckmann than 0.1798, at 0.8729 m; (0.05, 0.5) the same along both axes.
#[test]
fn beckmann_stays_a_fifth_away() {
    for m in [0.01, 0.3, 0.9] {
        let entry = conversion("beckmann").unwrap();
        let nearest = entry.convert([m; 2], By::Nearest);
        assert!((nearest.distance - 0.179_768).abs() < LOBE_DIGITS_SIX, "{nearest:?}");
        assert!((nearest.alphas[0] / m - 0.872_911).abs() < LOBE_DIGITS);
        assert!((entry.convert([m; 2], By::Formula).distance - 0.203_632).abs() < LOBE_DIGITS_SIX);
    }
    let ward = conversion("ward").unwrap().convert([0.05, 0.5], By::Nearest);
    assert!((ward.distance - 0.179_768).abs() < LOBE_DIGITS, "{ward:?}");
    let (roughness, strength, along_x) = gltf_anisotropy(ward.alphas);
    assert!(
        (roughness - 0.208_915).abs() < LOBE_DIGITS && (strength - 0.640_887).abs() < LOBE_DIGITS && !along_x
    );
}

#[test]
fn exponents_of_two_axes_become_anisotropy() {
    let entry = conversion("ashikhmin-shirley").unwrap();
    let (roughness, strength, along_x) = gltf_anisotropy(entry.convert([10.0, 1000.0], By::Formula).alphas);
    assert!((roughness - 0.211_368_648).abs() < LOBE_DIGITS_NINE, "{roughness}");
    assert!((strength - 0.616_907_121).abs() < LOBE_DIGITS_NINE && along_x, "{strength}");
    let nearest = entry.convert([10.0, 1000.0], By::Nearest);
    assert!(nearest.distance < entry.convert([10.0, 1000.0], By::Formula).distance);
    for pair in [[0.3, 0.1], [0.1, 0.3]] {
        let (roughness, strength, along_x) = gltf_anisotropy(pair);
        assert!(
            (roughness - 0.316_227_766).abs() < LOBE_DIGITS_NINE
                && (strength - 0.471_404_521).abs() < LOBE_DIGITS_NINE
        );
        assert_eq!(along_x, pair[0] > pair[1]);
    }
}

/// Blinn-Phong comes to Beckmann: D 0.043 at 10, 0.0053 at 100, 0.0005 at 1000.
#[test]
fn exponents_come_to_beckmann() {
    for (n, expected, within) in [(10.0, 0.043, 5e-4), (100.0, 0.0053, 5e-5), (1000.0, 0.0005, 5e-5)] {
        let m = (2.0f64 / (n + 2.0)).sqrt();
        let d = distance(&Lobe::Power([n; 2]), &Lobe::Beckmann([m; 2]));
        assert!((d - expected).abs() < within, "{n}: {d}");
    }
}

/// D of lobes with two widths by a sum over slopes, which shares nothing with the crossings.
#[test]
fn lobes_of_two_widths_are_compared_as_by_a_sum() {
    let (a, b) = ([0.4, 0.1], [0.3, 0.15]);
    let density = |[x, y]: [f64; 2], w: [f64; 2]| {
        let q = 1.0 + (x / w[0]).powi(2) + (y / w[1]).powi(2);
        1.0 / (std::f64::consts::PI * w[0] * w[1] * q * q)
    };
    let n = 1500;
    let mut sum = 0.0;
    for i in 0..n {
        for j in 0..n {
            let u = (f64::from(i) + 0.5) / f64::from(n);
            let phi = std::f64::consts::FRAC_PI_2 * (f64::from(j) + 0.5) / f64::from(n);
            // slopes r = 0.2 sqrt(u/(1 - u))
            let r2 = 0.04 * u / (1.0 - u);
            let slope = [r2.sqrt() * phi.cos(), r2.sqrt() * phi.sin()];
            let area = 0.02 / (1.0 - u).powi(2) * std::f64::consts::TAU;
            sum += 0.5 * (density(slope, a) - density(slope, b)).abs() * area;
        }
    }
    let expected = sum / f64::from(n * n);
    let d = distance(&Lobe::Ggx(a), &Lobe::Ggx(b));
    assert!((d - expected).abs() < LOBE_SUM, "{d}, by a sum {expected}");
}

#[test]
fn what_is_ggx_already_is_left() {
    for id in ["alpha", "roughness", "smoothness", "disney", "openpbr"] {
        let entry = CONVERSIONS.iter().find(|c| c.id == id).unwrap();
        for by in [By::Nearest, By::Formula] {
            assert!(entry.convert([0.4, 0.3], by).distance < DIGITS_LOST, "{id}");
        }
    }
    let both = conversion("roughness").unwrap().convert([0.3; 2], By::Nearest).alphas;
    assert!(both.iter().all(|a| (a - 0.09).abs() < FEW_ROUNDINGS));
}

/// The difference of E by sums of textbook formulas: Phong's lobe against GGX, and what is gained.
#[test]
fn the_difference_of_energy_is_that_of_sums() {
    use crate::sbrdf::ggx;
    use brdfbake::functions::conversion::energy::COSINES;
    use glam::DVec3;
    let n = 50.0;
    let entry = conversion("phong").unwrap();
    let (found, gap) = entry.certified([n; 2], By::Nearest).unwrap();
    let (mut largest, mut gained) = (0.0f64, 0.0f64);
    for mu in COSINES {
        let i = DVec3::new((1.0f64 - mu * mu).sqrt(), 0.0, mu);
        let mirror = DVec3::new(-i.x, 0.0, i.z);
        // even in both angles about the normal; half of it, which mirrors the other
        let steps = 700;
        let step = std::f64::consts::FRAC_PI_2 / f64::from(steps);
        let node = |k: u32| {
            let (theta, phi) =
                (step * (f64::from(k % steps) + 0.5), 2.0 * step * (f64::from(k / steps) + 0.5));
            let o = DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos());
            (o, 4.0 * step * step * theta.sin())
        };
        let nodes: Vec<(DVec3, f64)> = (0..steps * steps).map(node).collect();
        let phong = |o: DVec3| (n + 2.0) / std::f64::consts::TAU * mirror.dot(o).max(0.0).powf(n) * o.z;
        let sum = |f: &dyn Fn(DVec3) -> f64| nodes.iter().map(|(o, a)| a * f(*o)).sum::<f64>();
        let difference = sum(&|o| ggx(i, o, found.alphas[0], 1.0)) - sum(&phong);
        (largest, gained) = (largest.max(difference.abs()), gained.max(difference));
    }
    assert!((gap.largest - largest).abs() < LOBE_ENERGY, "{gap:?}, by sums {largest}");
    assert!((gap.gained - gained).abs() < LOBE_ENERGY && gained > 0.1, "{gap:?}, by sums {gained}");
    // what is GGX already loses nothing
    assert_eq!(
        conversion("roughness").unwrap().certified([0.4; 2], By::Nearest).unwrap().1.largest.to_bits(),
        0
    );
}

/// Any lobe in the numbers of any other kind: closed forms by equal peaks, least D by the ratio of widths, and back again.
#[test]
fn lobes_are_told_in_other_numbers() {
    let of = |id: &str| conversion(id).unwrap();
    let told =
        |from: &str, numbers: [f64; 2], to: &str, by: By| of(from).told_as(numbers, of(to), by).unwrap();
    let power = told("beckmann", [0.5; 2], "blinn-phong", By::Formula);
    assert!((power.numbers[0] - 6.0).abs() < FEW_ROUNDINGS * 10.0, "{power:?}");
    for (n, d) in [(10.0, 0.043), (100.0, 0.0053)] {
        let slope = told("blinn-phong", [n; 2], "beckmann", By::Formula);
        assert!((slope.numbers[0] - (2.0f64 / (n + 2.0)).sqrt()).abs() < FEW_ROUNDINGS);
        assert!((slope.distance - d).abs() < 0.01 * d + 3e-4, "{n}: {slope:?}");
        assert!(told("blinn-phong", [n; 2], "beckmann", By::Nearest).distance <= slope.distance);
    }
    // D depends on the ratio of widths alone, so the nearest one is the same both ways
    let slope = told("alpha", [0.3; 2], "beckmann", By::Nearest);
    assert!((slope.distance - 0.179_768).abs() < LOBE_DIGITS_SIX, "{slope:?}");
    assert!((slope.numbers[0] - 0.3 / 0.872_911).abs() < LOBE_DIGITS, "{slope:?}");
    let widths = told("ashikhmin-shirley", [10.0, 1000.0], "ward", By::Formula);
    let expected = [10.0f64, 1000.0].map(|n| (2.0 / (n + 2.0)).sqrt());
    assert!((0..2).all(|i| (widths.numbers[i] - expected[i]).abs() < FEW_ROUNDINGS), "{widths:?}");
    let [near, peaks] =
        [By::Nearest, By::Formula].map(|by| told("ward", [0.1, 0.3], "ashikhmin-shirley", by).distance);
    assert!(near <= peaks && near > 0.0, "{near} {peaks}");
    assert!(of("ward").told_as([0.1, 0.3], of("phong"), By::Formula).is_none());
    // what is one family in other numbers comes back, and what `to-ggx` tells is told here
    let openpbr = told("disney", [0.4, 0.3], "openpbr", By::Nearest);
    let back = told("openpbr", openpbr.numbers, "disney", By::Nearest);
    assert!(
        openpbr.distance < DIGITS_LOST
            && (0..2).all(|i| (back.numbers[i] - [0.4, 0.3][i]).abs() < INVERTED_9)
    );
    let phong = told("phong", [25.0; 2], "smoothness", By::Nearest);
    let ggx = of("phong").convert([25.0; 2], By::Nearest);
    assert!((phong.numbers[0] - (1.0 - ggx.alphas[0].sqrt())).abs() < FEW_ROUNDINGS, "{phong:?}");
}
