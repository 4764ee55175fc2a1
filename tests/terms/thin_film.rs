//! Thin films: against Airy's formula in plain complex arithmetic, its limits, the series, and the eye's transform.

use crate::terms::values::assert_relative;
use crate::tolerance::{
    DIGIT_LOST, DIGITS_LOST, DOUBLE_DOUBLE, FEW_ROUNDINGS, FRINGES_LEFT, MANY_ROUNDINGS, SERIES_CUT, near,
};
use brdfbake::integrate::gauss;
use brdfbake::math::complex::Complex;
use brdfbake::terms::fresnel;
use brdfbake::terms::thin_film::{self, Channel, Film};
use std::f64::consts::PI;

const FILMS: &[Film] = &[
    Film { n2: 1.33, n3: 1.5, k3: 0.0, d_nm: 250.0 },
    Film { n2: 1.5, n3: 1.0, k3: 0.0, d_nm: 420.0 },
    Film { n2: 2.4, n3: 2.9, k3: 3.1, d_nm: 90.0 },
    Film { n2: 1.38, n3: 0.2, k3: 3.4, d_nm: 700.0 },
    Film { n2: 0.7, n3: 1.5, k3: 0.0, d_nm: 150.0 },
];

/// `|r12 + r23 e|²/|1 + r12 r23 e|²` from textbook amplitudes.
fn airy(film: &Film, cos: f64, lambda: f64) -> [f64; 2] {
    let one = Complex::real(1.0);
    let n = [one, Complex::real(film.n2), Complex::new(film.n3, film.k3)];
    let sin2 = 1.0 - cos * cos;
    let q = n.map(|n| (n * n - Complex::real(sin2)).sqrt_upper());
    let s = |a: usize, b: usize| (q[a] - q[b]).over(q[a] + q[b]);
    let p = |a: usize, b: usize| {
        let (x, y) = (n[b] * n[b] * q[a], n[a] * n[a] * q[b]);
        (x - y).over(x + y)
    };
    let wave = q[1].scale(4.0 * PI * film.d_nm / lambda).expm1_i() + one;
    let sum = |a: Complex, b: Complex| ((a + b * wave).over(one + a * b * wave)).norm2();
    [sum(s(0, 1), s(1, 2)), sum(p(0, 1), p(1, 2))]
}

#[test]
fn equals_airys_formula() {
    for film in FILMS {
        for i in 1..=40 {
            let cos = f64::from(i) / 40.0;
            for lambda in [380.0, 550.0, 700.0] {
                let (got, expected) = (thin_film::airy(film, cos, lambda), airy(film, cos, lambda));
                for (g, e) in [(got.s, expected[0]), (got.p, expected[1])] {
                    near!(g, e, DIGIT_LOST, "{film:?} {cos} {lambda}: {g} {e}");
                    assert!((0.0..=1.0).contains(&g), "{film:?} {cos} {lambda}: {g}");
                }
            }
        }
    }
}

#[test]
fn without_thickness_or_contrast_it_is_the_bare_substrate() {
    for i in 0..=64 {
        let cos = f64::from(i) / 64.0;
        let bare = fresnel::conductor(cos, 2.9, 3.1);
        for film in
            [Film { n2: 1.7, n3: 2.9, k3: 3.1, d_nm: 0.0 }, Film { n2: 1.0, n3: 2.9, k3: 3.1, d_nm: 333.0 }]
        {
            let got = thin_film::airy(&film, cos, 500.0);
            assert_relative(&format!("s {film:?} {cos}"), got.s, bare.s, MANY_ROUNDINGS);
            assert_relative(&format!("p {film:?} {cos}"), got.p, bare.p, DIGIT_LOST);
        }
        let glass = fresnel::dielectric(cos, 1.5);
        let got = thin_film::airy(&Film { n2: 1.5, n3: 1.5, k3: 0.0, d_nm: 800.0 }, cos, 500.0);
        assert_relative(&format!("same {cos}"), got.s, glass.s, DIGIT_LOST);
        near!(got.p, glass.p, FEW_ROUNDINGS, "{cos}");
    }
}

#[test]
fn a_quarter_wave_of_the_geometric_mean_reflects_nothing() {
    let n2 = 1.5_f64.sqrt();
    let film = Film { n2, n3: 1.5, k3: 0.0, d_nm: 550.0 / (4.0 * n2) };
    assert!(thin_film::airy(&film, 1.0, 550.0).unpolarised() < DOUBLE_DOUBLE);
}

#[test]
fn the_series_converges_to_airys_formula() {
    for film in &FILMS[..4] {
        for cos in [0.05, 0.3, 0.7, 1.0] {
            let wave = |opd: f64, phase: f64| libm::cos(2.0 * PI * opd / 550.0 + phase);
            let got = thin_film::series(film, cos, 4000, &wave);
            let expected = thin_film::airy(film, cos, 550.0);
            assert_relative(&format!("s {film:?} {cos}"), got.s, expected.s, SERIES_CUT);
            assert_relative(&format!("p {film:?} {cos}"), got.p, expected.p, SERIES_CUT);
        }
    }
}

#[test]
fn colours_are_those_of_the_spectrum() {
    // The transform of Gaussians in wave number: integrate cos(2π OPD ν + s) against them directly.
    for (channel, lobes) in [
        (Channel::Y, &[(4.4201e-13, 1.7953e6, 9.3046e9)][..]),
        (Channel::Z, &[(5.2481e-13, 2.2084e6, 6.6121e9)]),
        (Channel::X, &[(5.4856e-13, 1.6810e6, 4.3278e9), (9.7470e-14, 2.2399e6, 4.5282e9)]),
    ] {
        for (opd, shift) in [(0.0, 0.0), (300.0, 1.0), (900.0, -2.0)] {
            let p = 2.0 * PI * opd * 1e-9;
            let mut expected = 0.0;
            for &(value, position, width) in lobes {
                // exp(−w p²) is the transform of a Gaussian of standard deviation √(2w)
                let deviation = (2.0_f64 * width).sqrt();
                let norm = value * (2.0 * PI * width).sqrt() / (deviation * (2.0 * PI).sqrt());
                expected +=
                    gauss::rule(128).integrate(position - 9.0 * deviation, position + 9.0 * deviation, |k| {
                        let x = (k - position) / deviation;
                        norm * libm::exp(-0.5 * x * x) * libm::cos(k * p + shift)
                    });
            }
            let got = thin_film::sensitivity(channel, opd, shift);
            near!(got, expected / 1.0685e-7, DIGITS_LOST, "{channel:?} {opd} {shift}: {got}");
        }
    }
    // A thick film is grey: the fringes average out, and what is left is the sum without interference.
    let film = Film { n2: 1.5, n3: 1.0, k3: 0.0, d_nm: 50_000.0 };
    let r = 0.04;
    let expected = r + (1.0 - r) * (1.0 - r) * r / (1.0 - r * r);
    for channel in thin_film::rgb(&film, 1.0, 3) {
        assert_relative("thick", channel, expected, FRINGES_LEFT);
    }
}
