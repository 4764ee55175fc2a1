//! Phase functions: reference values, norms and mean cosines by Gauss rules, samplers.

use crate::terms::values::{assert_relative, rows};
use crate::tolerance::{
    DIGIT_LOST, DRAWN, FEW_ROUNDINGS, INTEGRAL_9, INTEGRAL_10, INTEGRAL_11, INTEGRAL_12, INTEGRAL_13,
    INVERTED_9, MANY_ROUNDINGS, near,
};
use brdfbake::integrate::gauss;
use brdfbake::terms::phase;
use std::f64::consts::PI;

const FILE: &str = "points_volume";

#[test]
fn phase_functions_match_reference_values() {
    for row in rows(FILE, "phase_isotropic") {
        row.check(phase::isotropic(), FEW_ROUNDINGS);
    }
    for row in rows(FILE, "phase_rayleigh") {
        row.check(phase::rayleigh(libm::cos(row.wi_theta())), FEW_ROUNDINGS);
    }
    for row in rows(FILE, "phase_hg") {
        let half = libm::sin(0.5 * row.wi_theta());
        row.check(phase::henyey_greenstein_at(row.num("g"), 2.0 * half * half), MANY_ROUNDINGS);
        row.check(phase::henyey_greenstein(row.num("g"), libm::cos(row.wi_theta())), DIGIT_LOST);
    }
    for row in rows(FILE, "phase_draine") {
        row.check(phase::draine(row.num("g"), row.num("alpha"), libm::cos(row.wi_theta())), DIGIT_LOST);
    }
    for row in rows(FILE, "phase_mie_hg_draine_fit_5to50um") {
        row.check(phase::fog(row.num("d_um"), libm::cos(row.wi_theta())), DIGIT_LOST);
    }
}

#[test]
fn samples_match_reference_values() {
    for row in rows(FILE, "hg_sample_cos") {
        row.check(phase::sample_henyey_greenstein(row.num("g"), row.num("xi")), MANY_ROUNDINGS);
    }
    for row in rows("points_sampling", "sample_rayleigh_cos") {
        row.check(phase::sample_rayleigh(row.num("u")), MANY_ROUNDINGS);
    }
}

/// `2π ∫ h d cos` from the forward peak, 1 − cos = 2 (eᵗ − 1)-graded.
fn sphere(width: f64, h: impl Fn(f64) -> f64) -> f64 {
    let length = libm::log1p(2.0 / width);
    2.0 * PI
        * gauss::rule(128).integrate(0.0, length, |t| {
            let from_peak = width * libm::expm1(t);
            (from_peak + width) * h(from_peak)
        })
}

#[test]
fn norms_and_mean_cosines() {
    for g in [0.0, 0.01, 0.5, 0.9, 0.999, 0.999_999] {
        let width: f64 = (1.0_f64 - g) * (1.0 - g) + 1e-12;
        let hg = |x| phase::henyey_greenstein_at(g, x);
        assert_relative(&format!("HG g = {g}"), sphere(width, hg), 1.0, INTEGRAL_12);
        // 1 − mean cosine, which keeps its digits for g → 1.
        assert_relative(&format!("HG mean, g = {g}"), sphere(width, |x| x * hg(x)), 1.0 - g, INTEGRAL_10);
        for alpha in [0.0, 0.5, 1.0, 32.0] {
            let p = |x: f64| phase::draine(g, alpha, 1.0 - x);
            if g < 0.99 {
                assert_relative(&format!("Draine {g} {alpha}"), sphere(width, p), 1.0, INTEGRAL_11);
                let mean = sphere(width, |x| (1.0 - x) * p(x));
                near!(mean, phase::draine_mean_cosine(g, alpha), INTEGRAL_11, "Draine {g} {alpha}: {mean}");
            }
        }
    }
    assert_relative("Rayleigh", sphere(1.0, |x| phase::rayleigh(1.0 - x)), 1.0, INTEGRAL_13);
    for d in [5.0, 12.0, 50.0] {
        assert_relative(&format!("fog {d}"), sphere(1e-5, |x| phase::fog(d, 1.0 - x)), 1.0, INTEGRAL_9);
    }
    assert_eq!(phase::fog(1.0, 0.5), phase::fog(5.0, 0.5), "outside the fit the nearest diameter counts");
}

/// g, α, mean cosine; by quadrature, 16 digits verified by a second route.
const MEAN: [(f64, f64, f64); 5] = [
    (0.875, 1.0, 9.0466101694915254e-01),
    (0.5, 0.5, 5.4e-01),
    (-0.25, 4.0, -3.5e-01),
    (0.9375, 32.0, 9.6934931506849315e-01),
    (0.0625, 1.0, 7.4926900584795322e-02),
];

#[test]
fn known_mean_cosines_special_cases_and_mirror_symmetry() {
    for (g, alpha, mean) in MEAN {
        assert_relative(&format!("{g} {alpha}"), phase::draine_mean_cosine(g, alpha), mean, FEW_ROUNDINGS);
    }
    for i in 0..=64 {
        let cos = f64::from(i) / 32.0 - 1.0;
        assert_relative("Rayleigh", phase::draine(0.0, 1.0, cos), phase::rayleigh(cos), FEW_ROUNDINGS);
        assert_eq!(phase::draine(0.6, 0.0, cos), phase::henyey_greenstein(0.6, cos));
        assert_relative("g = 0", phase::henyey_greenstein(0.0, cos), phase::isotropic(), FEW_ROUNDINGS);
        let mirrored = phase::henyey_greenstein(-0.6, -cos);
        assert_relative("mirror", mirrored, phase::henyey_greenstein(0.6, cos), MANY_ROUNDINGS);
    }
}

#[test]
fn samples_invert_the_integral_and_stay_in_range() {
    for g in [-0.8, -0.3, 0.0, 1e-9, 0.4, 0.85] {
        for u in [0.0, 1e-12, 0.2, 0.5, 0.9, 1.0] {
            let cos = phase::sample_henyey_greenstein(g, u);
            assert!((-1.0..=1.0).contains(&cos), "g = {g}, u = {u}: {cos}");
            // The share of deflections with a smaller cosine.
            let below = 2.0 * PI * gauss::rule(200).integrate(-1.0, cos, |c| phase::henyey_greenstein(g, c));
            near!(below, u, INVERTED_9, "g = {g}: u = {u} gives cos {cos}, below it {below}");
        }
    }
    for g in [-1.0, 1.0, 2.0] {
        for u in [0.0, 0.5, 1.0] {
            assert!(phase::henyey_greenstein(g, 2.0 * u - 1.0).is_finite(), "g = {g}");
            assert!(
                (-1.0..=1.0).contains(&phase::sample_henyey_greenstein(g.clamp(-1.0, 1.0), u)),
                "g = {g}"
            );
        }
    }
    for u in [0.0, 0.1, 0.5, 0.77, 1.0] {
        let cos = phase::sample_rayleigh(u);
        let below = 2.0 * PI * gauss::rule(8).integrate(-1.0, cos, phase::rayleigh);
        near!(below, u, MANY_ROUNDINGS, "u = {u} gives cos {cos}, below it {below}");
    }
}

#[test]
fn draine_and_fog_samples_have_their_integral() {
    for g in [-0.9, -0.2, 0.0, 1e-9, 0.05, 0.29, 0.31, 0.5, 0.9, 0.99] {
        for alpha in [0.0, 0.5, 1.0, 50.0] {
            for u in [0.0, 0.01, 0.3, 0.5, 0.8, 0.999] {
                let cos = phase::sample_draine(g, alpha, u);
                // ∫₋₁^cos, graded at the peak
                let p = |c: f64| 2.0 * PI * phase::draine(g, alpha, c);
                let width: f64 = (1.0 - g.abs()) * (1.0 - g.abs()) + 1e-12;
                let peak = g.signum();
                let graded = |from: f64, to: f64| {
                    let (a, b) = ((from - peak).abs(), (to - peak).abs());
                    let (ta, tb) = (libm::log1p(a / width), libm::log1p(b / width));
                    (gauss::rule(128).integrate(ta.min(tb), ta.max(tb), |t| {
                        width * libm::exp(t) * p(peak - peak * width * libm::expm1(t))
                    })) * (to - from).signum()
                };
                let got = graded(-1.0, cos);
                near!(got, u, INTEGRAL_11, "g {g} alpha {alpha} u {u}: cos {cos}, integral {got}");
            }
            let same = phase::sample_draine(g, 0.0, 0.37) - phase::sample_henyey_greenstein(g, 0.37);
            assert!(same.abs() < DIGIT_LOST, "alpha = 0 is Henyey-Greenstein");
        }
    }
    // the mixture: mean cosine over a fine grid of both numbers
    let mean = sphere(1e-4, |x| (1.0 - x) * phase::fog(10.0, 1.0 - x));
    let n = 512;
    let mut sum = 0.0;
    for i in 0..n {
        for j in 0..n {
            let u =
                glam::DVec2::new((f64::from(i) + 0.5) / f64::from(n), (f64::from(j) + 0.5) / f64::from(n));
            sum += phase::sample_fog(10.0, u);
        }
    }
    let got = sum / f64::from(n) / f64::from(n);
    near!(got, mean, DRAWN, "{got} {mean}");
}
