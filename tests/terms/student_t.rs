//! Student's t distribution: reference values over all exponents, its limits GGX and Beckmann, norms, samplers.

use crate::terms::sampling::{assert_moments, integrate_facing, moments};
use crate::terms::values::{Row, assert_relative, cosines, rows};
use crate::tolerance::{
    DIGIT_LOST, DIGIT_LOST_TWICE, DIGITS_LOST, FEW_ROUNDINGS, INTEGRAL_9, INTEGRAL_10, LIMIT_FAR,
    MANY_ROUNDINGS, near,
};
use brdfbake::integrate::sobol::replicate_mean;
use brdfbake::math::frame;
use brdfbake::terms::beckmann::Beckmann;
use brdfbake::terms::ggx::Ggx;
use brdfbake::terms::schlick;
use brdfbake::terms::smith::Ndf;
use brdfbake::terms::student_t::StudentT;
use glam::{DVec2, DVec3};

fn of(row: &Row) -> StudentT {
    StudentT::new(row.num("alpha_x"), row.num("alpha_y"), row.num("gamma"))
}

#[test]
fn student_t_matches_reference_values() {
    for row in rows("points_terms", "D_std") {
        row.check(of(&row).d(row.wi()), DIGIT_LOST);
    }
    for row in rows("points_terms", "Lambda_std") {
        row.check(of(&row).lambda(row.wi()), DIGIT_LOST_TWICE);
    }
    for row in rows("points_sampling", "sample_std_tan2theta") {
        let std = StudentT::isotropic(row.num("alpha"), row.num("gamma"));
        row.check(frame::tan2_theta(std.sample_d(DVec2::new(row.num("u"), 0.0))), DIGIT_LOST);
    }
    for row in rows("points_microfacet", "std_smith_correlated") {
        let (wo, wi) = (row.wo(), row.wi());
        let half = frame::half_vector(wo, wi).unwrap();
        let f = schlick::schlick(row.num("F0"), 1.0, half.cos_d);
        row.check(f * of(&row).d(half.wh) * of(&row).visibility(wo, wi), DIGITS_LOST);
    }
}

/// γ, a = 1/tan θ, Λ at width 1: mpmath, the published difference with 400 digits.
const LAMBDA: &[(f64, f64, f64)] = &[
    (1.5078125, 0.0625, 234.2947194199611633),
    (1.5078125, 0.5, 28.95258977109239861),
    (1.5078125, 1.25, 11.44842482755912159),
    (1.5078125, 1.5, 9.515355100923981656),
    (1.5078125, 1.75, 8.137546799037196446),
    (1.5078125, 3.0, 4.708363909776557119),
    (1.5078125, 8.0, 1.739001231161041953),
    (1.5078125, 20.0, 0.6857244948132234278),
    (1.75, 0.0625, 11.07997096077404843),
    (1.75, 0.5, 1.058773667489310691),
    (1.75, 1.25, 0.3068811381796989753),
    (1.75, 1.5, 0.2363586703804945988),
    (1.75, 1.75, 0.189059314114932418),
    (1.75, 3.0, 0.08555475003424274028),
    (1.75, 8.0, 0.01979333384438690696),
    (1.75, 20.0, 0.005012620802726217267),
    (2.0, 0.0625, 7.515609770940698682),
    (2.0, 0.5, 0.6180339887498948482),
    (2.0, 1.25, 0.1403124237432848686),
    (2.0, 1.5, 0.1009252125773315489),
    (2.0, 1.75, 0.07587555344989640374),
    (2.0, 3.0, 0.02704627669472988867),
    (2.0, 8.0, 0.003891109268659353273),
    (2.0, 20.0, 0.0006246098625196431924),
    (3.0, 0.0625, 5.173413596095270971),
    (3.0, 0.5, 0.3333333333333333333),
    (3.0, 1.25, 0.04305826639666796068),
    (3.0, 1.5, 0.02549385424538810929),
    (3.0, 1.75, 0.01587301587301587302),
    (3.0, 3.0, 0.002518907629606037745),
    (3.0, 8.0, 0.00005918210353922673285),
    (3.0, 20.0, 1.55472395099264019e-6),
    (10.0, 0.0625, 4.230510694352976449),
    (10.0, 0.5, 0.2224643970885352889),
    (10.0, 1.25, 0.01341646830706280352),
    (10.0, 1.5, 0.005450107676838862101),
    (10.0, 1.75, 0.002212437282653119921),
    (10.0, 3.0, 0.00002641751688081265774),
    (10.0, 8.0, 4.28366684410749951e-11),
    (10.0, 20.0, 6.799909804197750972e-18),
    (100.0, 0.0625, 4.048300910925801095),
    (100.0, 0.5, 0.2015944408901960195),
    (100.0, 1.25, 0.009125121224790676917),
    (100.0, 1.5, 0.003065951915866664662),
    (100.0, 1.75, 0.0009648497544984358361),
    (100.0, 3.0, 9.416813422657630172e-7),
    (100.0, 8.0, 2.080009014380989007e-25),
    (100.0, 20.0, 5.700966478958094485e-74),
    (10000.0, 0.0625, 4.031305185146869603),
    (10000.0, 0.5, 0.199660454783043207),
    (10000.0, 1.25, 0.008757911197346085442),
    (10000.0, 1.5, 0.00287614696537946453),
    (10000.0, 1.75, 0.0008759810562585235917),
    (10000.0, 3.0, 5.622255687978666397e-7),
    (10000.0, 8.0, 5.346661569559079113e-32),
    (10000.0, 20.0, 8.652851718894548224e-176),
    (100000000.0, 0.0625, 4.031136140266362213),
    (100000000.0, 0.5, 0.1996412302965825877),
    (100000000.0, 1.25, 0.008754288979860249758),
    (100000000.0, 1.5, 0.002874288294088841413),
    (100000000.0, 1.75, 0.0008751208284648215247),
    (100000000.0, 3.0, 5.591728008857206419e-7),
    (100000000.0, 8.0, 4.318607975393513374e-32),
    (100000000.0, 20.0, 3.36674969206184573e-179),
];

#[test]
fn masking_has_all_digits_for_every_exponent_and_angle() {
    for &(gamma, a, expected) in LAMBDA {
        let w = DVec3::new(1.0, 0.0, a).normalize();
        let got = StudentT::isotropic(1.0, gamma).lambda(w);
        // Λ falls like exp(−a²) or a^(2 − 2γ): an ulp of the direction is worth that many ulp of Λ.
        let bound = 5e-14 + 2e-15 * (a * a).min(gamma);
        assert_relative(&format!("gamma = {gamma}, a = {a}"), got, expected, bound);
    }
}

#[test]
fn gamma_2_is_ggx_and_a_large_gamma_is_beckmann() {
    for alpha in [(1.0, 1.0), (0.5, 0.125), (1e-3, 1e-3), (1e-7, 1e-7)] {
        let (std, ggx) = (StudentT::new(alpha.0, alpha.1, 2.0), Ggx::new(alpha.0, alpha.1));
        let (wide, beckmann) = (StudentT::new(alpha.0, alpha.1, 1e8), Beckmann::new(alpha.0, alpha.1));
        for mu in cosines() {
            let flat = frame::from_mu(mu);
            let w = DVec3::new(flat.x * 0.6, flat.x * 0.8, mu);
            assert_relative(&format!("D {alpha:?} {mu}"), std.d(w), ggx.d(w), DIGIT_LOST);
            assert_relative(&format!("Lambda {alpha:?} {mu}"), std.lambda(w), ggx.lambda(w), DIGIT_LOST);
            // (1 + X/γ)^−γ = exp(−X + X²/2γ …).
            if beckmann.d(w) > 1e-12 / (alpha.0 * alpha.1) {
                assert_relative(&format!("D {alpha:?} {mu}"), wide.d(w), beckmann.d(w), LIMIT_FAR);
                assert_relative(
                    &format!("Lambda {alpha:?} {mu}"),
                    wide.lambda(w) + 1.0,
                    beckmann.lambda(w) + 1.0,
                    1e-7,
                );
            }
        }
    }
}

#[test]
fn norms_and_projected_areas() {
    // Up to γ = 2.5 the tail is an algebraic end of the rule and converges slowly; the values above cover it.
    for gamma in [3.0, 8.0, 100.0] {
        for alpha in [(1.0, 1.0), (0.5, 0.125), (1e-3, 1e-3)] {
            let std = StudentT::new(alpha.0, alpha.1, gamma);
            let what = format!("{std:?}");
            assert_relative(&what, integrate_facing(alpha, DVec3::Z, |m| std.pdf_d(m)), 1.0, INTEGRAL_10);
            for theta in [0.3, 1.0, 1.5] {
                let w = frame::spherical(theta, 0.9);
                assert_relative(&what, integrate_facing(alpha, w, |m| std.d_visible(w, m)), 1.0, INTEGRAL_9);
            }
        }
    }
}

#[test]
fn samples_have_the_density_they_claim() {
    for (gamma, alpha) in [(3.0, (1.0, 1.0)), (8.0, (0.5, 0.125)), (1e5, (0.25, 1.0))] {
        let std = StudentT::new(alpha.0, alpha.1, gamma);
        let got = replicate_mean(21, 16, 512, |u| moments(std.sample_d(u)));
        assert_moments(&format!("{std:?}, D cos"), got, |i| {
            integrate_facing(alpha, DVec3::Z, |m| std.pdf_d(m) * moments(m)[i])
        });
        for theta in [0.0, 1.3] {
            let wo = frame::spherical(theta, 0.9);
            let got = replicate_mean(22, 16, 512, |u| moments(std.sample_visible(wo, u)));
            assert_moments(&format!("{std:?}, visible from {theta}"), got, |i| {
                integrate_facing(alpha, wo, |m| std.d_visible(wo, m) * moments(m)[i])
            });
        }
    }
}

#[test]
fn gamma_2_samples_visible_normals_like_ggx() {
    let (std, ggx) = (StudentT::new(0.5, 0.25, 2.0), Ggx::new(0.5, 0.25));
    for theta in [0.0, 0.8, 1.5] {
        let wo = frame::spherical(theta, 0.9);
        let theirs = replicate_mean(23, 16, 1024, |u| moments(ggx.sample_visible(wo, u)));
        let ours = replicate_mean(24, 16, 1024, |u| moments(std.sample_visible(wo, u)));
        for (a, b) in theirs.into_iter().zip(ours) {
            let bound = 5.0 * libm::hypot(a.standard_error, b.standard_error) + 1e-9;
            near!(a.mean, b.mean, bound, "theta = {theta}: GGX {a:?}, STD {b:?}");
        }
    }
}

#[test]
fn finite_over_the_whole_domain() {
    for gamma in [0.0, 1.5, 1.51, 2.0, 40.0, 1e8, f64::INFINITY, f64::NAN] {
        for alpha in [0.0, 1e-7, 0.05, 1.0, 2.0] {
            let std = StudentT::isotropic(alpha, gamma);
            for mu in cosines() {
                let w = frame::from_mu(mu);
                let values = [std.d(w), std.lambda(w), std.g1(w), std.visibility(w, w), std.facing_area(w)];
                assert!(values.iter().all(|x| x.is_finite() && *x >= 0.0), "{std:?}, mu = {mu}: {values:?}");
            }
            for x in [0.0, 0.5, 1.0] {
                for y in [0.0, 0.5, 1.0] {
                    for wo in [DVec3::Z, DVec3::X, frame::from_mu(0.3)] {
                        for m in [std.sample_d(DVec2::new(x, y)), std.sample_visible(wo, DVec2::new(x, y))] {
                            assert!(
                                (m.length() - 1.0).abs() < MANY_ROUNDINGS && m.z >= 0.0,
                                "{std:?} {wo} {x} {y}: {m}"
                            );
                        }
                    }
                }
            }
        }
    }
    near!(StudentT::isotropic(0.5, 3.0).gamma(), 3.0, FEW_ROUNDINGS);
    assert_eq!(StudentT::isotropic(0.5, 3.0).d(DVec3::X), 0.0);
    assert_eq!(StudentT::isotropic(0.5, 3.0).lambda(DVec3::Z), 0.0);
}
