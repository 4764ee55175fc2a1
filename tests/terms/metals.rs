//! Indices of metals: Lazanyi's factor, Gulbrandsen's mapping.

use crate::terms::values::assert_relative;
use crate::tolerance::{
    CIE_AREAS, COLOUR, COLOUR_WHITE, DIGIT_LOST, DIGITS_LOST, FEW_ROUNDINGS, INTEGRAL_11, INVERSE_AT_A_POLE,
    MANY_ROUNDINGS, near,
};
use brdfbake::integrate::gauss;
use brdfbake::terms::metals::{self, METALS};
use brdfbake::terms::{blackbody, colour, fresnel, gulbrandsen, lazanyi};

#[test]
fn lazanyi_meets_the_exact_value_at_both_ends() {
    for (n, k) in [(0.2, 3.4), (1.4, 7.6), (2.9, 3.1), (1.5, 0.0)] {
        assert_relative(
            "normal",
            lazanyi::lazanyi(n, k, 0.7, 5.0, 1.0),
            fresnel::conductor(1.0, n, k).unpolarised(),
            MANY_ROUNDINGS,
        );
        assert_relative("grazing", lazanyi::lazanyi(n, k, 0.7, 5.0, 0.0), 1.0, FEW_ROUNDINGS);
        for q in [0.5, 3.0, 6.0] {
            // c = x² makes c (1 − c)^q with fractional q smooth enough at 0; at 1 grade by y⁴
            let average = gauss::rule(64).integrate(0.0, 1.0, |y| {
                let (y2, rest) = (y * y, 1.0 - y * y * y * y);
                2.0 * lazanyi::lazanyi(n, k, 0.7, q, rest) * rest * 4.0 * y2 * y
            });
            assert_relative(
                &format!("average q = {q}"),
                lazanyi::average(n, k, 0.7, q),
                average,
                INTEGRAL_11,
            );
        }
    }
    assert_relative("0/0", lazanyi::f0(0.0, 0.0), 1.0, 0.0);
}

#[test]
fn gulbrandsen_there_and_back() {
    for r in [1e-6, 0.02, 0.3, 0.7, 0.95, 0.99] {
        for g in [0.0, 1e-6, 0.1, 0.5, 0.9, 1.0] {
            let (n, k) = gulbrandsen::index(r, g);
            // the reflectance is the one asked for
            assert_relative(&format!("F0, r {r} g {g}"), lazanyi::f0(n, k), r, DIGITS_LOST);
            let (r2, g2) = gulbrandsen::tint(n, k);
            assert_relative(&format!("r {r} g {g}"), r2, r, DIGITS_LOST);
            near!(g2, g, INVERSE_AT_A_POLE * g.max(1e-3), "r {r} g {g}: {g2}");
        }
        let (n, k) = gulbrandsen::index(r, 1.0);
        assert_relative("g = 1 is on the unit circle", n * n + k * k, 1.0, MANY_ROUNDINGS);
    }
    assert_eq!(gulbrandsen::index(0.0, 0.3), (1.0, 0.0));
    assert_eq!(gulbrandsen::tint(1.0, 0.0), (0.0, 0.0));
}

#[test]
fn the_product_form_is_the_printed_one() {
    let (r, g): (f64, f64) = (0.7, 0.3);
    let (low, high) = ((1.0 - r) / (1.0 + r), (1.0 + r.sqrt()) / (1.0 - r.sqrt()));
    let n = g * low + (1.0 - g) * high;
    let k2 = (r * (n + 1.0) * (n + 1.0) - (n - 1.0) * (n - 1.0)) / (1.0 - r);
    let (got_n, got_k) = gulbrandsen::index(r, g);
    assert_relative("n", got_n, n, MANY_ROUNDINGS);
    assert_relative("k", got_k, k2.sqrt(), DIGIT_LOST);
}

#[test]
fn rows_are_in_order_and_cover_the_visible() {
    for metal in METALS {
        assert!(metal.rows.windows(2).all(|w| w[0][0] < w[1][0]), "{}", metal.name);
        assert!(metal.rows[0][0] < 370.0 && metal.rows.last().unwrap()[0] > 800.0, "{}", metal.name);
        assert!(metal.rows.iter().all(|r| r[1] > 0.0 && r[2] > 0.0), "{}", metal.name);
        for row in metal.rows {
            assert_eq!(metal.index(row[0]), (row[1], row[2]), "{}", metal.name);
        }
        for lambda in [300.0, 455.5, 1000.0] {
            assert!((0.3..1.0).contains(&metal.f0(lambda)), "{} {lambda}", metal.name);
        }
        assert!(metal.rgb_index().iter().all(|(n, k)| *n > 0.0 && *k > 1.0), "{}", metal.name);
    }
}

#[test]
fn colours_are_near_those_in_use() {
    // Base colours that a widely used engine documents for its metals; it does not say which measurements they are from.
    let published = [
        ("fe", [0.560, 0.570, 0.580]),
        ("ag", [0.972, 0.960, 0.915]),
        ("al", [0.913, 0.921, 0.925]),
        ("au", [1.000, 0.766, 0.336]),
        ("cu", [0.955, 0.637, 0.538]),
        ("ni", [0.660, 0.609, 0.526]),
        ("ti", [0.542, 0.497, 0.449]),
    ];
    for (id, expected) in published {
        let got = metals::find(id).unwrap().f0_srgb();
        for (g, e) in got.iter().zip(expected) {
            near!(*g, e, COLOUR, "{id}: {got:?}, published {expected:?}");
        }
    }
    // D65 seen by the standard observer is white in sRGB, whose matrix has seven digits
    let mut xyz = [0.0; 3];
    for i in 0..=470 {
        let lambda = 360.0 + f64::from(i);
        for (sum, eye) in xyz.iter_mut().zip(colour::cie_xyz(lambda)) {
            *sum += colour::d65(lambda) * eye;
        }
    }
    let white = blackbody::xyz_to_srgb(xyz);
    assert!(
        (white[0] / white[1] - 1.0).abs() < COLOUR_WHITE && (white[2] / white[1] - 1.0).abs() < COLOUR_WHITE,
        "{white:?}"
    );
    assert_eq!((colour::d65(359.0), colour::d65(560.0), colour::d65(831.0)), (0.0, 100.0, 0.0));
    assert_eq!((colour::cie_xyz(555.0)[1], colour::cie_xyz(831.0)[1]), (1.0, 0.0));
    // the three functions have equal areas, as the CIE made them: to the digits of its rows
    let area = (360..=830).fold([0.0; 3], |sum, l| {
        let xyz = colour::cie_xyz(f64::from(l));
        [0, 1, 2].map(|c| sum[c] + xyz[c])
    });
    assert!(area.iter().all(|a| (a / area[1] - 1.0).abs() < CIE_AREAS), "{area:?}");
}
