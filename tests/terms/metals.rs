//! Indices of metals: Lazanyi's factor, Gulbrandsen's mapping.

use crate::values::assert_relative;
use brdfbake::integrate::gauss;
use brdfbake::terms::{fresnel, gulbrandsen, lazanyi};

#[test]
fn lazanyi_meets_the_exact_value_at_both_ends() {
    for (n, k) in [(0.2, 3.4), (1.4, 7.6), (2.9, 3.1), (1.5, 0.0)] {
        assert_relative(
            "normal",
            lazanyi::lazanyi(n, k, 0.7, 5.0, 1.0),
            fresnel::conductor(1.0, n, k).unpolarised(),
            1e-14,
        );
        assert_relative("grazing", lazanyi::lazanyi(n, k, 0.7, 5.0, 0.0), 1.0, 1e-15);
        for q in [0.5, 3.0, 6.0] {
            // c = x² makes c (1 − c)^q with fractional q smooth enough at 0; at 1 grade by y⁴
            let average = gauss::rule(64).integrate(0.0, 1.0, |y| {
                let (y2, rest) = (y * y, 1.0 - y * y * y * y);
                2.0 * lazanyi::lazanyi(n, k, 0.7, q, rest) * rest * 4.0 * y2 * y
            });
            assert_relative(&format!("average q = {q}"), lazanyi::average(n, k, 0.7, q), average, 1e-11);
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
            assert_relative(&format!("F0, r {r} g {g}"), lazanyi::f0(n, k), r, 1e-12);
            let (r2, g2) = gulbrandsen::tint(n, k);
            assert_relative(&format!("r {r} g {g}"), r2, r, 1e-12);
            assert!((g2 - g).abs() <= 1e-11 * g.max(1e-3), "r {r} g {g}: {g2}");
        }
        let (n, k) = gulbrandsen::index(r, 1.0);
        assert_relative("g = 1 is on the unit circle", n * n + k * k, 1.0, 1e-14);
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
    assert_relative("n", got_n, n, 1e-14);
    assert_relative("k", got_k, k2.sqrt(), 1e-13);
}
