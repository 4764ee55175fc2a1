//! Densities and samplers of facet normals: fixed numbers, norms by Gauss rules, moments by scrambled Sobol points.

use crate::terms::values::{assert_relative, rows};
use crate::tolerance::{
    DIGITS_LOST, DRAWN_SIGMA, FEW_ROUNDINGS, INTEGRAL_9, INTEGRAL_10, INTEGRAL_11, MANY_ROUNDINGS, near,
};
use brdfbake::integrate::gauss;
use brdfbake::integrate::sobol::{ReplicateMean, Sobol, replicate_mean};
use brdfbake::math::{frame, special};
use brdfbake::terms::beckmann::Beckmann;
use brdfbake::terms::ggx::Ggx;
use brdfbake::terms::smith::Ndf;
use glam::{DVec2, DVec3};

const FILE: &str = "points_sampling";

const ALPHAS: [(f64, f64); 6] =
    [(1.0, 1.0), (0.5, 0.125), (0.25, 1.0), (0.05, 0.05), (1e-3, 1e-3), (1e-7, 1e-7)];

fn both(alpha: (f64, f64)) -> [Box<dyn Ndf>; 2] {
    [Box::new(Ggx::new(alpha.0, alpha.1)), Box::new(Beckmann::new(alpha.0, alpha.1))]
}

#[test]
fn samples_at_fixed_numbers_match_reference_values() {
    for row in rows(FILE, "sample_ggx_D_tan2theta") {
        let m = Ggx::isotropic(row.num("alpha")).sample_d(DVec2::new(row.num("u"), 0.0));
        row.check(frame::tan2_theta(m), MANY_ROUNDINGS);
    }
    for row in rows(FILE, "sample_beckmann_D_tan2theta") {
        let m = Beckmann::isotropic(row.num("alpha")).sample_d(DVec2::new(row.num("u"), 0.0));
        row.check(frame::tan2_theta(m), MANY_ROUNDINGS);
    }
    for (model, axis) in
        [("vndf_cap_sample_mx", DVec3::X), ("vndf_cap_sample_my", DVec3::Y), ("vndf_cap_sample_mz", DVec3::Z)]
    {
        for row in rows("points_terms", model) {
            let ggx = Ggx::new(row.num("alpha_x"), row.num("alpha_y"));
            let m = ggx.sample_visible(row.wi(), DVec2::new(row.num("u1"), row.num("u2")));
            // Components near 0 are differences of numbers of size 1.
            let error = (m.dot(axis) - row.value).abs();
            assert!(
                error < FEW_ROUNDINGS + MANY_ROUNDINGS * row.value.abs(),
                "{}: {m}, error {error:e}",
                row.name
            );
        }
    }
}

/// `∫ h(m) dωm` over normals, in slopes (x, y) = widths · stretched slopes, x along the azimuth of the stretched `w`.
///
/// The half plane that faces `w` begins at x = −cot θ, so its edge is an end of the rule, not a kink inside it.
pub(crate) fn integrate_facing(alpha: (f64, f64), w: DVec3, h: impl Fn(DVec3) -> f64) -> f64 {
    let v = DVec3::new(alpha.0 * w.x, alpha.1 * w.y, w.z).normalize();
    let flat = frame::sin_theta(v);
    let (c, s) = if flat > 0.0 { (v.x / flat, v.y / flat) } else { (1.0, 0.0) };
    let rule = gauss::rule(100);
    // t in (0, 1) to (0, ∞), density 1/(1 − t)².
    let line = |t: f64| (t / (1.0 - t), 1.0 / ((1.0 - t) * (1.0 - t)));
    let cell = |x: f64, y: f64| {
        let n = DVec3::new(alpha.0 * (x * c - y * s), alpha.1 * (x * s + y * c), 1.0);
        let cos = 1.0 / n.length();
        h(n * cos) * alpha.0 * alpha.1 * cos * cos * cos
    };
    let over_y = |x: f64| {
        rule.integrate(0.0, 1.0, |t| {
            let (y, jacobian) = line(t);
            // The tail of GGX across is as wide as |x|.
            let scale = (1.0 + x * x).sqrt();
            (cell(x, scale * y) + cell(x, -scale * y)) * scale * jacobian
        })
    };
    let start = if flat > 0.0 { -v.z / flat } else { f64::NEG_INFINITY };
    let right = |from: f64| rule.integrate(0.0, 1.0, |t| line(t).1 * over_y(from + line(t).0));
    if start >= -1.0 {
        right(start)
    } else if start.is_finite() {
        // Panels away from the peak: [start, −1] in a logarithm of the distance.
        let length = libm::log(-start);
        rule.integrate(0.0, length, |t| libm::exp(t) * over_y(-libm::exp(t))) + right(-1.0)
    } else {
        rule.integrate(0.0, 1.0, |t| line(t).1 * over_y(-1.0 - line(t).0)) + right(-1.0)
    }
}

#[test]
fn distributions_are_normalised() {
    for alpha in ALPHAS {
        for ndf in both(alpha) {
            let norm = integrate_facing(alpha, DVec3::Z, |m| ndf.pdf_d(m));
            assert_relative(&format!("{ndf:?}: ∫ D cos"), norm, 1.0, INTEGRAL_11);
        }
    }
}

#[test]
fn projected_area_is_mu_times_1_plus_lambda() {
    for alpha in ALPHAS {
        for ndf in both(alpha) {
            for theta in [0.0, 0.3, 1.0, 1.4, 1.5625, std::f64::consts::FRAC_PI_2 - 1e-6] {
                for phi in [0.0, 0.9, 2.5] {
                    let w = frame::spherical(theta, phi);
                    let what = format!("{ndf:?}, theta = {theta}, phi = {phi}");
                    let area = integrate_facing(alpha, w, |m| ndf.d(m) * w.dot(m).max(0.0));
                    assert_relative(&format!("{what}: ∫ D w.m"), ndf.facing_area(w), area, INTEGRAL_10);
                    let visible = integrate_facing(alpha, w, |m| ndf.d_visible(w, m));
                    assert_relative(&format!("{what}: ∫ D_visible"), visible, 1.0, INTEGRAL_10);
                }
            }
        }
    }
}

pub(crate) fn moments(m: DVec3) -> [f64; 5] {
    [m.x, m.y, m.z, m.x * m.y, m.x * m.x]
}

pub(crate) fn assert_moments(what: &str, got: [ReplicateMean; 5], expected: impl Fn(usize) -> f64) {
    for (i, estimate) in got.into_iter().enumerate() {
        let (error, sigma) = ((estimate.mean - expected(i)).abs(), estimate.standard_error);
        assert!(sigma < DRAWN_SIGMA, "{what}, moment {i}: {estimate:?}");
        assert!(
            error < 5.0 * sigma + INTEGRAL_9,
            "{what}, moment {i}: {estimate:?}, expected {}",
            expected(i)
        );
    }
}

#[test]
fn samples_have_the_density_they_claim() {
    for alpha in [(1.0, 1.0), (0.5, 0.125), (0.25, 1.0), (0.05, 0.05)] {
        for ndf in both(alpha) {
            let got = replicate_mean(5, 16, 2048, |u| moments(ndf.sample_d(u)));
            assert_moments(&format!("{ndf:?}, D cos"), got, |i| {
                integrate_facing(alpha, DVec3::Z, |m| ndf.pdf_d(m) * moments(m)[i])
            });
            for theta in [0.0, 0.6, 1.3, 1.55] {
                let wo = frame::spherical(theta, 0.9);
                let got = replicate_mean(6, 16, 2048, |u| moments(ndf.sample_visible(wo, u)));
                assert_moments(&format!("{ndf:?}, visible from {theta}"), got, |i| {
                    integrate_facing(alpha, wo, |m| ndf.d_visible(wo, m) * moments(m)[i])
                });
            }
        }
        let ggx = Ggx::new(alpha.0, alpha.1);
        let wo = frame::spherical(1.3, 0.9);
        let got = replicate_mean(7, 16, 2048, |u| moments(ggx.sample_visible_2018(wo, u)));
        assert_moments(&format!("{ggx:?}, routine of 2018"), got, |i| {
            integrate_facing(alpha, wo, |m| ggx.d_visible(wo, m) * moments(m)[i])
        });
    }
}

#[test]
fn visible_normals_of_width_one_reflect_uniformly_onto_a_cap() {
    // The reflected direction is uniform on z > −mu: its mean height is (1 − mu)/2, of its square (1 + mu³)/(3 (1 + mu)).
    let ggx = Ggx::isotropic(1.0);
    for mu in [0.05, 0.3, 0.8, 1.0] {
        let wo = frame::from_mu(mu);
        let [height, square] = replicate_mean(8, 16, 4096, |u| {
            let wi = frame::reflect(wo, ggx.sample_visible(wo, u));
            [wi.z, wi.z * wi.z]
        });
        let expected = [0.5 * (1.0 - mu), (1.0 + mu * mu * mu) / (3.0 * (1.0 + mu))];
        for (got, expected) in [height, square].into_iter().zip(expected) {
            near!(
                got.mean,
                expected,
                5.0 * got.standard_error + DIGITS_LOST,
                "mu = {mu}: {got:?}, {expected}"
            );
        }
    }
}

#[test]
fn share_of_facets_that_face_a_direction() {
    // E[m.z/(w.m)] over visible normals is (∫_{w.m>0} D cos)/(mu (1 + Lambda)): half the plane of slopes and a bit,
    // (1 + mu/√(mu² + q))/2 for GGX and (1 + erf(mu/√q))/2 for Beckmann, q = (αx x)² + (αy y)².
    for alpha in [(1.0, 1.0), (0.5, 0.125)] {
        for theta in [0.6, 1.3] {
            let wo = frame::spherical(theta, 0.9);
            let q = alpha.0 * alpha.0 * wo.x * wo.x + alpha.1 * alpha.1 * wo.y * wo.y;
            let shares = [wo.z / (wo.z * wo.z + q).sqrt(), special::erf(wo.z / q.sqrt())];
            for (ndf, share) in both(alpha).into_iter().zip(shares) {
                let [mean] = replicate_mean(9, 16, 4096, |u| {
                    let m = ndf.sample_visible(wo, u);
                    [m.z / wo.dot(m)]
                });
                let expected = 0.5 * (1.0 + share) / ndf.facing_area(wo);
                let error = (mean.mean - expected).abs();
                assert!(error < 8.0 * mean.standard_error, "{ndf:?} {theta}: {mean:?}, expected {expected}");
            }
        }
    }
}

#[test]
fn samples_are_unit_and_face_the_viewer_at_every_end() {
    let ends = [0.0, 1e-300, 1e-9, 0.5, 1.0 - f64::EPSILON, 1.0];
    let mut numbers: Vec<DVec2> = ends.iter().flat_map(|x| ends.map(|y| DVec2::new(*x, y))).collect();
    numbers.extend(Sobol::new(11).points(200));
    for alpha in ALPHAS {
        let ggx = Ggx::new(alpha.0, alpha.1);
        for mu in [0.0, 1e-8, 1e-3, 0.5, 1.0] {
            for phi in [0.0, 2.0] {
                let flat = frame::from_mu(mu);
                let (sin, cos) = libm::sincos(phi);
                let wo = DVec3::new(flat.x * cos, flat.x * sin, mu);
                for &u in &numbers {
                    let mut normals = vec![ggx.sample_visible_2018(wo, u)];
                    for ndf in both(alpha) {
                        normals.extend([ndf.sample_d(u), ndf.sample_visible(wo, u)]);
                        let seen = wo.dot(ndf.sample_visible(wo, u));
                        // Next to u2 = 1 the normal is a difference of nearly opposite vectors.
                        let facing = seen > -1e-12 || u.y > 1.0 - 1e-12;
                        assert!(facing, "{ndf:?}, mu = {mu}, u = {u}: wo.m = {seen}");
                    }
                    for m in normals {
                        let unit = (m.length() - 1.0).abs() < 1e-14 && m.z >= 0.0;
                        assert!(unit, "alpha = {alpha:?}, mu = {mu}, u = {u}: {m}");
                    }
                }
            }
        }
    }
}
