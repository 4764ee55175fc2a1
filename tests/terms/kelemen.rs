//! The skin specular of GPU Gems 3: texels, their inverse, and the visibility of Kelemen and Szirmay-Kalos.

use crate::terms::values::{assert_relative, cosines, rows};
use crate::tolerance::{DIGIT_LOST, DIGITS_LOST, FEW_ROUNDINGS, MANY_ROUNDINGS};
use brdfbake::math::frame;
use brdfbake::terms::beckmann::Beckmann;
use brdfbake::terms::kelemen;
use brdfbake::terms::schlick;
use brdfbake::terms::smith::Ndf;
use glam::DVec3;

#[test]
fn texels_match_reference_values() {
    for row in rows("points_skin", "gpugems3_beckmann_texel") {
        row.check(kelemen::encode(row.num("ndoth"), row.num("m")), MANY_ROUNDINGS);
    }
}

#[test]
fn decoding_gives_pi_times_beckmann() {
    for m in [0.05, 0.25, 0.5, 1.0] {
        for u in cosines().into_iter().filter(|u| *u > 0.1) {
            let d = Beckmann::isotropic(m).d(frame::from_mu(u));
            let got = kelemen::decode(kelemen::encode(u, m));
            let exponent = (1.0 - u * u) / (u * u * m * m);
            if exponent < 600.0 {
                assert_relative(
                    &format!("u = {u}, m = {m}"),
                    got,
                    d * std::f64::consts::PI,
                    DIGIT_LOST + FEW_ROUNDINGS * exponent,
                );
            }
        }
    }
}

#[test]
fn texels_are_finite_at_all_ends() {
    for u in [0.0, 1e-300, 1e-8, 0.5, 1.0 - f64::EPSILON, 1.0, 1.0 + f64::EPSILON] {
        for m in [0.0, 1e-300, 1e-8, 1e-3, 1.0] {
            let texel = kelemen::encode(u, m);
            assert!(texel.is_finite() && texel >= 0.0, "u = {u}, m = {m}: {texel}");
            assert!(kelemen::decode(texel.min(1.0)) <= 1024.0);
        }
    }
    assert_eq!(
        (kelemen::encode(0.0, 0.5), kelemen::encode(0.5, 0.0), kelemen::encode(0.0, 0.0)),
        (0.0, 0.0, 0.0)
    );
    assert_relative("clipping starts at m = 1/32", kelemen::encode(1.0, 1.0 / 32.0), 1.0, FEW_ROUNDINGS);
    assert_eq!(kelemen::decode(1.0), 1024.0);
}

#[test]
fn assembled_kelemen_matches_reference_values() {
    for row in rows("points_microfacet", "kelemen_specular_normalised") {
        let (wo, wi) = (row.wo(), row.wi());
        let half = frame::half_vector(wo, wi).unwrap();
        let f = schlick::schlick(row.num("F0"), 1.0, half.cos_d);
        let d = Beckmann::isotropic(row.num("m")).d(half.wh);
        row.check(f * d * kelemen::visibility(wo, wi), DIGIT_LOST);
    }
    for row in rows("points_microfacet", "gpugems3_ks_skin_result") {
        // Shading value: ndotl · rho_s · PH · F/|L + V|², L = wi.
        let (wo, wi) = (row.wo(), row.wi());
        let half = frame::half_vector(wo, wi).unwrap();
        let ph = kelemen::decode(kelemen::encode(half.wh.z, row.num("m")));
        let f = schlick::schlick(row.num("F0"), 1.0, half.cos_d);
        row.check(wi.z * row.num("rho_s") * ph * f * kelemen::visibility(wo, wi), DIGITS_LOST);
    }
}

#[test]
fn visibility_is_a_quarter_over_the_squared_cosine_of_incidence() {
    for mu in cosines() {
        let (wo, wi) = (frame::from_mu(mu), frame::spherical(0.7, 2.0));
        let half = frame::half_vector(wo, wi).unwrap();
        assert_relative("V", kelemen::visibility(wo, wi), 0.25 / (half.cos_d * half.cos_d), MANY_ROUNDINGS);
        assert_eq!(kelemen::visibility(wo, wi), kelemen::visibility(wi, wo));
    }
    assert_eq!(kelemen::visibility(DVec3::X, -DVec3::X), 0.0);
    assert_eq!(kelemen::visibility(DVec3::Z, DVec3::Z), 0.25);
}
