//! Blinn-Phong, GTR and the V-cavity: reference values, norms, samplers, finiteness.

use crate::terms::values::{Row, assert_relative, cosines, rows};
use crate::tolerance::{
    DIGIT_LOST, DIGIT_LOST_TWICE, FEW_ROUNDINGS, INTEGRAL_10, INTEGRAL_11, INTEGRAL_12, INTEGRAL_13,
    MANY_ROUNDINGS, near,
};
use brdfbake::integrate::gauss;
use brdfbake::integrate::sobol::{Sobol, replicate_mean};
use brdfbake::math::frame;
use brdfbake::terms::beckmann::Beckmann;
use brdfbake::terms::ggx::Ggx;
use brdfbake::terms::smith::Ndf;
use brdfbake::terms::{blinn_phong, gtr, schlick, vcavity};
use glam::{DVec2, DVec3};

const TERMS: &str = "points_terms";
const SAMPLING: &str = "points_sampling";

/// `∫ h dω` over the hemisphere for an isotropic h with a peak of this width, θ = width · sinh.
pub(crate) fn hemisphere(width: f64, h: impl Fn(DVec3) -> f64) -> f64 {
    let length = libm::asinh(std::f64::consts::FRAC_PI_2 / width);
    let rule = gauss::rule(128);
    rule.integrate(0.0, length, |t| {
        let theta = (width * libm::sinh(t)).min(std::f64::consts::FRAC_PI_2);
        let w = frame::spherical(theta, 0.5);
        2.0 * std::f64::consts::PI * frame::sin_theta(w) * width * libm::cosh(t) * h(w)
    })
}

/// The mean of `cos θ` and `sin²θ` of a sampler against its density.
pub(crate) fn assert_sampler(
    what: &str,
    width: f64,
    d: impl Fn(DVec3) -> f64,
    sample: impl Fn(DVec2) -> DVec3,
) {
    let got = replicate_mean(12, 16, 2048, |u| {
        let m = sample(u);
        [m.z, m.x * m.x, m.x]
    });
    let height = hemisphere(width, |m| d(m) * m.z * m.z);
    let square = hemisphere(width, |m| d(m) * m.z * frame::sin2_theta(m)) / 2.0;
    for (estimate, expected) in got.into_iter().zip([height, square, 0.0]) {
        let error = (estimate.mean - expected).abs();
        // A long tail hides from 30000 points, and from their spread: 2 % of its second moment are allowed for it.
        let bound = 5.0 * estimate.standard_error + 0.02 * square + 1e-9;
        assert!(error < bound, "{what}: {estimate:?}, expected {expected}");
    }
    for x in [0.0, 1e-300, 0.5, 1.0 - f64::EPSILON, 1.0] {
        for y in [0.0, 0.3, 1.0] {
            let m = sample(DVec2::new(x, y));
            assert!(
                (m.length() - 1.0).abs() < MANY_ROUNDINGS && m.z >= 0.0,
                "{what}: u = ({x}, {y}) gives {m}"
            );
        }
    }
}

#[test]
fn blinn_phong_matches_reference_values() {
    for row in rows(TERMS, "D_blinn_phong") {
        row.check(blinn_phong::d(row.num("n"), row.wi()), DIGIT_LOST_TWICE);
    }
    for row in rows(SAMPLING, "sample_blinn_D_costheta") {
        row.check(blinn_phong::sample_d(row.num("n"), DVec2::new(row.num("u"), 0.0)).z, FEW_ROUNDINGS);
    }
}

#[test]
fn blinn_phong_is_normalised_and_sampled() {
    for n in [0.0, 1.0, 2.5, 30.0, 1e3, 1e5, 1e7] {
        let width = blinn_phong::equivalent_alpha(n);
        let what = format!("n = {n}");
        assert_relative(&what, hemisphere(width, |m| blinn_phong::d(n, m) * m.z), 1.0, INTEGRAL_11);
        assert_sampler(&what, width, |m| blinn_phong::d(n, m), |u| blinn_phong::sample_d(n, u));
        for mu in cosines() {
            let d = blinn_phong::d(n, frame::from_mu(mu));
            assert!(d.is_finite() && d >= 0.0, "{what}, mu = {mu}: {d}");
        }
        // The peaks of D agree at the equivalent width.
        assert_relative(
            &what,
            Beckmann::isotropic(width).d(DVec3::Z),
            blinn_phong::d(n, DVec3::Z),
            MANY_ROUNDINGS,
        );
    }
    assert_eq!(blinn_phong::d(5.0, DVec3::X), 0.0);
}

#[test]
fn gtr_matches_reference_values() {
    for row in rows(TERMS, "D_gtr") {
        row.check(gtr::d(row.num("alpha"), row.num("gamma"), row.wi()), INTEGRAL_13);
    }
    let square = |row: &Row, gamma| {
        let m = gtr::sample_d(row.num("alpha"), gamma, DVec2::new(row.num("u"), 0.0));
        m.z * m.z
    };
    for row in rows(SAMPLING, "sample_gtr_cos2theta") {
        row.check(square(&row, row.num("gamma")), MANY_ROUNDINGS);
    }
    for row in rows(SAMPLING, "sample_gtr1_cos2theta") {
        row.check(square(&row, 1.0), MANY_ROUNDINGS);
    }
}

#[test]
fn gtr_is_normalised_sampled_and_regular_at_its_removable_singularities() {
    for alpha in [1e-4, 0.01, 0.3, 0.9990234375, 1.0, 1.5] {
        for gamma in [0.25, 1.0, 1.0009765625, 1.5, 2.0, 3.0, 10.0] {
            let what = format!("alpha = {alpha}, gamma = {gamma}");
            let d = |m| gtr::d(alpha, gamma, m);
            assert_relative(&what, hemisphere(alpha, |m| d(m) * m.z), 1.0, INTEGRAL_10);
            // Narrower, the mean hangs on a few samples of the tail in 30000.
            if alpha >= 0.01 {
                assert_sampler(&what, alpha, d, |u| gtr::sample_d(alpha, gamma, u));
            }
            for mu in cosines() {
                let value = d(frame::from_mu(mu));
                assert!(value.is_finite() && value > 0.0, "{what}, mu = {mu}: {value}");
            }
        }
        // gamma = 2 is GGX.
        for mu in cosines() {
            let w = frame::from_mu(mu);
            assert_relative("GGX", gtr::d(alpha, 2.0, w), Ggx::isotropic(alpha).d(w), DIGIT_LOST);
        }
    }
    for alpha in [0.0, 1e-300] {
        for gamma in [0.5, 1.0, 2.0, 10.0] {
            assert!(gtr::d(alpha, gamma, DVec3::Z).is_finite(), "alpha = {alpha}, gamma = {gamma}");
        }
    }
    assert_eq!(gtr::d(0.5, 2.0, DVec3::X), 0.0);
}

#[test]
fn v_cavities_match_reference_values() {
    let shade = |row: &Row, d: &dyn Fn(DVec3) -> f64| {
        let (wo, wi) = (row.wo(), row.wi());
        let half = frame::half_vector(wo, wi).unwrap();
        let f = schlick::schlick(row.num("F0"), 1.0, half.cos_d);
        f * d(half.wh) * vcavity::g2(wo, wi, half.wh, half.cos_d) / (4.0 * wo.z * wi.z)
    };
    for row in rows("points_microfacet", "torrance_sparrow_beckmann_vcavity") {
        row.check(shade(&row, &|m| Beckmann::isotropic(row.num("m")).d(m)), INTEGRAL_12);
    }
    for row in rows("points_microfacet", "torrance_sparrow_blinn_vcavity") {
        row.check(shade(&row, &|m| blinn_phong::d(row.num("n"), m)), INTEGRAL_12);
    }
    // The form of 1982, with D without 1/π and 1/π instead of 1/4, is four times the modern one.
    for row in rows("points_microfacet", "cook_torrance_1982_seed_form") {
        row.check(4.0 * shade(&row, &|m| Beckmann::isotropic(row.num("m")).d(m)), INTEGRAL_12);
    }
}

#[test]
fn v_cavities_show_each_direction_its_projected_area() {
    // ∫ G1 D max(0, w.m) dωm = n.w, by visible normals of GGX: E[G1_v · (mu/(G1_smith))/mu] = 1.
    let ggx = Ggx::isotropic(0.5);
    for mu in [0.1, 0.5, 0.95] {
        let wo = frame::from_mu(mu);
        let [mean] = replicate_mean(13, 16, 4096, |u| {
            let m = ggx.sample_visible(wo, u);
            [vcavity::g1(wo, m, wo.dot(m)) * ggx.facing_area(wo) / mu]
        });
        near!(mean.mean, 1.0, 5.0 * mean.standard_error, "mu = {mu}: {mean:?}");
    }
    for u in Sobol::new(3).points(500) {
        let (wo, wi) = (frame::spherical(1.57 * u.x, 0.3), frame::spherical(1.57 * u.y, 6.0 * u.x));
        let half = frame::half_vector(wo, wi).unwrap();
        let g = vcavity::g2(wo, wi, half.wh, half.cos_d);
        assert!((0.0..=1.0).contains(&g));
        assert_eq!(g, vcavity::g2(wi, wo, half.wh, half.cos_d));
    }
    assert_eq!(vcavity::g1(DVec3::X, DVec3::Z, 0.0), 0.0);
}
