//! GGX and Beckmann with Smith masking: reference values, identities, finiteness over the whole domain.

use crate::terms::values::{Row, assert_relative, cosines, rows};
use crate::tolerance::{DIGIT_LOST, DIGIT_LOST_TWICE, FEW_ROUNDINGS, MANY_ROUNDINGS, TEN_ROUNDINGS, near};
use brdfbake::math::frame;
use brdfbake::terms::beckmann::Beckmann;
use brdfbake::terms::ggx::Ggx;
use brdfbake::terms::schlick;
use brdfbake::terms::smith::Ndf;
use glam::{DVec2, DVec3};

const ALPHAS: [(f64, f64); 8] = [
    (1.0, 1.0),
    (0.5, 0.125),
    (0.25, 1.0),
    (0.05, 0.05),
    (1e-3, 1e-3),
    (1e-5, 0.5),
    (1e-7, 1e-7),
    (2.0, 1.5),
];

fn ggx(row: &Row) -> Ggx {
    Ggx::new(row.num("alpha_x"), row.num("alpha_y"))
}

fn beckmann(row: &Row) -> Beckmann {
    Beckmann::new(row.num("alpha_x"), row.num("alpha_y"))
}

fn both(alpha: (f64, f64)) -> [Box<dyn Ndf>; 2] {
    [Box::new(Ggx::new(alpha.0, alpha.1)), Box::new(Beckmann::new(alpha.0, alpha.1))]
}

/// Directions over the upper hemisphere, from grazing (1e-8) to the normal.
fn directions() -> Vec<DVec3> {
    let azimuths = [0.0, 0.7, std::f64::consts::FRAC_PI_2, 2.5, 4.0];
    let at = |mu: f64, phi: f64| {
        let flat = frame::from_mu(mu);
        let (sin, cos) = libm::sincos(phi);
        DVec3::new(flat.x * cos, flat.x * sin, mu)
    };
    cosines().into_iter().flat_map(|mu| azimuths.map(|phi| at(mu, phi))).collect()
}

#[test]
fn distributions_match_reference_values() {
    for row in rows("points_terms", "D_ggx") {
        row.check(ggx(&row).d(row.wi()), DIGIT_LOST);
    }
    for row in rows("points_terms", "D_beckmann") {
        // Three rows are below 1e-308 and must be 0 (their values parse as 0).
        row.check(beckmann(&row).d(row.wi()), DIGIT_LOST);
    }
}

#[test]
fn masking_matches_reference_values() {
    for row in rows("points_terms", "Lambda_ggx") {
        row.check(ggx(&row).lambda(row.wi()), DIGIT_LOST);
    }
    for row in rows("points_terms", "Lambda_beckmann") {
        // Down to 1.38e-145, where exp(−333) turns an ulp of its argument into 7e-14.
        row.check(beckmann(&row).lambda(row.wi()), DIGIT_LOST_TWICE);
    }
}

/// `Λ(a) = (exp(−a²)/(a√π) − erfc(a))/2` at width 1, tan θ = 1/a; mpmath, 60 digits.
const LAMBDA: &[(f64, f64)] = &[
    (1.0e-8, 28209478.67738781658),
    (0.001, 281.5950738686228957),
    (0.0625, 4.031136123362755981),
    (0.25, 0.69817732446023271),
    (0.5, 0.1996412283742456659),
    (1.0, 0.02512727083000611051),
    (1.5, 0.002874288108260258789),
    (2.0, 0.0002445056787378738132),
    (3.0, 5.591724962696004711e-7),
    (3.75, 1.898517797221937807e-9),
    (4.0, 2.277677197765894916e-10),
    (4.5, 2.32008325111617733e-12),
    (6.0, 1.455534739558135634e-19),
    (8.0, 4.318515368348727166e-32),
    (10.0, 5.170265957331844021e-48),
    (14.0, 3.854499729668118842e-90),
    (18.25, 5.205049327173652137e-150),
    (24.0, 7.144670626851651684e-256),
];

#[test]
fn beckmann_masking_has_all_digits_at_every_angle() {
    for &(a, expected) in LAMBDA {
        let w = DVec3::new(1.0, 0.0, a).normalize();
        let got = Beckmann::isotropic(1.0).lambda(w);
        assert_relative(&format!("a = {a}"), got, expected, TEN_ROUNDINGS + FEW_ROUNDINGS * a * a);
    }
}

#[test]
fn visible_normals_match_reference_values() {
    for row in rows("points_terms", "vndf_ggx") {
        row.check(ggx(&row).d_visible(row.wi(), row.wo()), DIGIT_LOST);
    }
}

/// The assembled BRDF F D V of a row, from the terms alone.
fn assembled(row: &Row, ndf: &dyn Ndf, separable: bool) -> f64 {
    let (wo, wi) = (row.wo(), row.wi());
    let half = frame::half_vector(wo, wi).unwrap();
    let f = schlick::schlick(row.num("F0"), 1.0, half.cos_d);
    let v = if separable { ndf.visibility_separable(wo, wi) } else { ndf.visibility(wo, wi) };
    f * ndf.d(half.wh) * v
}

#[test]
fn assembled_brdfs_match_reference_values() {
    // Near the mirror direction the half vector is a small difference of directions: an ulp of them is 1/alpha ulp
    // of the value, so the bound grows with 1/alpha.
    let bound = |row: &Row| 2e-13 + 1e-15 / row.num("alpha_x").min(row.num("alpha_y"));
    for (model, separable) in [("ggx_smith_correlated", false), ("ggx_smith_separable", true)] {
        for row in rows("points_microfacet", model) {
            row.check(assembled(&row, &ggx(&row), separable), bound(&row));
        }
    }
    for (model, separable) in [("beckmann_smith_correlated", false), ("beckmann_smith_separable", true)] {
        for row in rows("points_microfacet", model) {
            row.check(assembled(&row, &beckmann(&row), separable), bound(&row));
        }
    }
}

#[test]
fn everything_is_finite_from_grazing_to_normal_for_every_width() {
    let directions = directions();
    for alpha in ALPHAS {
        for ndf in both(alpha) {
            for &w in &directions {
                let what = format!("{ndf:?} at {w}");
                let (d, lambda, g1) = (ndf.d(w), ndf.lambda(w), ndf.g1(w));
                assert!(d >= 0.0 && d.is_finite(), "{what}: D = {d}");
                assert!(lambda >= 0.0 && lambda.is_finite(), "{what}: Lambda = {lambda}");
                assert!((0.0..=1.0).contains(&g1), "{what}: G1 = {g1}");
                near!(g1 * (1.0 + lambda), 1.0, FEW_ROUNDINGS, "{what}: G1 (1 + Lambda) = 1");
            }
            for &wo in directions.iter().step_by(7) {
                for &wi in directions.iter().step_by(3) {
                    check_pair(&*ndf, wo, wi);
                }
            }
        }
    }
}

/// Finite, in range, symmetric, and the quotient-free forms equal to the textbook ones.
fn check_pair(ndf: &dyn Ndf, wo: DVec3, wi: DVec3) {
    let what = format!("{ndf:?} wo {wo} wi {wi}");
    let (g2, apart) = (ndf.g2(wo, wi), ndf.g2_separable(wo, wi));
    assert!(
        (0.0..=1.0).contains(&g2) && apart <= g2 * (1.0 + FEW_ROUNDINGS),
        "{what}: G2 = {g2}, separable {apart}"
    );
    assert_relative(&what, g2, 1.0 / (1.0 + ndf.lambda(wo) + ndf.lambda(wi)), MANY_ROUNDINGS);
    let (v, v_apart) = (ndf.visibility(wo, wi), ndf.visibility_separable(wo, wi));
    assert!(v.is_finite() && v_apart.is_finite(), "{what}: V = {v}, separable {v_apart}");
    assert_relative(&what, v, g2 / (4.0 * wo.z * wi.z), MANY_ROUNDINGS);
    assert_relative(&what, v_apart, apart / (4.0 * wo.z * wi.z), MANY_ROUNDINGS);
    assert_eq!((v, v_apart, g2), (ndf.visibility(wi, wo), ndf.visibility_separable(wi, wo), ndf.g2(wi, wo)));
    let visible = ndf.d_visible(wo, wi);
    assert!(visible.is_finite() && visible >= 0.0, "{what}: D_visible = {visible}");
}

#[test]
fn horizon_and_back_side() {
    let (below, horizon) = (DVec3::new(0.6, 0.0, -0.8), DVec3::new(0.6, 0.8, 0.0));
    for alpha in ALPHAS {
        for ndf in both(alpha) {
            assert_eq!(ndf.d(below), 0.0);
            assert_eq!(ndf.d(horizon), 0.0);
            assert_eq!(ndf.g1(horizon), 0.0);
            assert_eq!((ndf.g2(horizon, horizon), ndf.visibility(horizon, horizon)), (0.0, 0.0));
            assert_eq!(ndf.lambda(DVec3::Z), 0.0);
            assert_eq!(ndf.lambda(horizon), f64::INFINITY, "the true limit");
            assert!(ndf.visibility(horizon, DVec3::Z).is_finite() && ndf.visibility(horizon, DVec3::Z) > 0.0);
            assert!(ndf.d_visible(horizon, frame::spherical(0.3, 0.9)).is_finite());
            // A facet seen from behind is masked; below the surface the same statistics hold from below.
            let tilted = frame::spherical(1.2, 0.0);
            assert_eq!(ndf.g1_facet(frame::spherical(1.3, 3.0), tilted), 0.0);
            assert_eq!(ndf.g1_facet(DVec3::Z, tilted), 1.0);
            assert_eq!(ndf.g1(below), ndf.g1(-below));
        }
    }
}

#[test]
fn widths_outside_the_domain_are_floored() {
    for alpha in [0.0, -1.0, f64::NAN, 1e-300] {
        for ndf in both((alpha, alpha)) {
            assert!(ndf.d(DVec3::Z).is_finite() && ndf.lambda(frame::from_mu(0.1)).is_finite(), "{ndf:?}");
        }
    }
    assert_eq!(Ggx::isotropic(0.5), Ggx::new(0.5, 0.5));
    assert_eq!((Ggx::new(0.5, 0.25).alpha_x(), Ggx::new(0.5, 0.25).alpha_y()), (0.5, 0.25));
    assert_eq!((Beckmann::new(0.5, 0.25).alpha_x(), Beckmann::new(0.5, 0.25).alpha_y()), (0.5, 0.25));
    assert_eq!(Beckmann::isotropic(0.5), Beckmann::new(0.5, 0.5));
}

#[test]
fn slopes_and_normals_have_the_same_density() {
    for alpha in ALPHAS {
        for ndf in both(alpha) {
            for wm in directions().into_iter().filter(|wm| wm.z > 1e-3) {
                let slope = DVec2::new(wm.x / wm.z, wm.y / wm.z);
                let (p22, d) = (ndf.p22(slope), ndf.d(wm));
                // exp turns an ulp of its argument into that many of the value.
                let bound =
                    1e-14 + 1e-15 * slope.length_squared() / (alpha.0 * alpha.0).min(alpha.1 * alpha.1);
                if bound < 1e-9 && d > 1e-290 {
                    assert_relative(&format!("{ndf:?} {wm}"), p22, d * wm.z * wm.z * wm.z * wm.z, bound);
                }
            }
        }
    }
}

#[test]
fn width_one_ggx_is_the_law_of_lommel_and_seeliger() {
    // F D V = 1/(2π (mu_i + mu_o)) for alpha = 1, correlated.
    let ndf = Ggx::isotropic(1.0);
    for wo in directions().into_iter().step_by(5) {
        for wi in directions().into_iter().step_by(4) {
            let half = frame::half_vector(wo, wi).unwrap();
            let expected = 0.5 / (std::f64::consts::PI * (wo.z + wi.z));
            assert_relative(
                &format!("{wo} {wi}"),
                ndf.d(half.wh) * ndf.visibility(wo, wi),
                expected,
                MANY_ROUNDINGS,
            );
        }
    }
}
