//! Transformed cosines, SGGX and the factors of multiple scattering: norms and identities.

use crate::terms::values::assert_relative;
use crate::tolerance::{
    DIGIT_LOST, FEW_ROUNDINGS, KINK_IN_A_SUM, MANY_ROUNDINGS, PLANE_CUT, SOBOL_16K, near,
};
use brdfbake::integrate::gauss;
use brdfbake::integrate::sobol::Sobol;
use brdfbake::math::frame;
use brdfbake::terms::ltc::Ltc;
use brdfbake::terms::ltc_sheen::Sheen;
use brdfbake::terms::{multiple_scattering as ms, sggx};
use glam::DVec3;
use std::f64::consts::PI;

const LOBES: &[Ltc] = &[
    Ltc::COSINE,
    Ltc { m11: 0.5, m22: 0.25, m13: 0.125, m31: 0.0 },
    Ltc { m11: 0.75, m22: 0.5, m13: -0.5, m31: 0.25 },
];

/// `∫ f dω` over the sphere, polar round +z.
fn sphere(f: impl Fn(DVec3) -> f64) -> f64 {
    let (polar, azimuth) = (gauss::rule(128), 256);
    let ring = |z: f64| {
        let r = ((1.0 - z) * (1.0 + z)).sqrt();
        (0..azimuth)
            .map(|i| {
                let (s, c) = libm::sincos(2.0 * PI * (f64::from(i) + 0.5) / f64::from(azimuth));
                f(DVec3::new(r * c, r * s, z))
            })
            .sum::<f64>()
            * 2.0
            * PI
            / f64::from(azimuth)
    };
    polar.integrate(-1.0, 0.0, ring) + polar.integrate(0.0, 1.0, ring)
}

#[test]
fn lobes_integrate_to_one() {
    for lobe in LOBES {
        // the lobe with m31 ends in a plane that is not z = 0: the rule converges slowly there
        let bound = if lobe.m31 == 0.0 { 1e-10 } else { 1e-3 };
        assert_relative(&format!("{lobe:?}"), sphere(|w| lobe.density(w)), 1.0, bound);
    }
    let mirrored = Ltc { m11: -1.0, ..Ltc::COSINE };
    assert_relative("mirrored", mirrored.density(DVec3::Z), 0.0, 0.0);
}

#[test]
fn form_factors_match_reference_values() {
    let path = format!("{}/tests/values/integrals.csv", env!("CARGO_MANIFEST_DIR"));
    let mut count = 0;
    for record in csv::Reader::from_path(path).unwrap().records() {
        let r = record.unwrap();
        if !r[0].starts_with("ltc_polygon_form_factor") {
            continue;
        }
        let p: serde_json::Value = serde_json::from_str(&r[1]).unwrap();
        let number = |key: &str| p[key].as_f64().unwrap();
        let lobe = Ltc { m11: number("m11"), m22: number("m22"), m13: number("m13"), m31: number("m31") };
        let vertices: Vec<DVec3> = p["poly"]
            .as_array()
            .unwrap()
            .iter()
            .map(|v| DVec3::new(v[0].as_f64().unwrap(), v[1].as_f64().unwrap(), v[2].as_f64().unwrap()))
            .collect();
        assert_relative(&r[1], lobe.form_factor(&vertices).abs(), r[2].parse().unwrap(), MANY_ROUNDINGS);
        count += 1;
    }
    assert_eq!(count, 7);
}

#[test]
fn a_polygon_round_the_horizon_is_clipped_to_a_whole() {
    // a big square below the horizon on one side: what is above is what counts
    let square = [[-1e9, -1e9], [1e9, -1e9], [1e9, 1e9], [-1e9, 1e9]].map(|[x, y]| DVec3::new(x, y, 1.0));
    assert_relative("plane", Ltc::COSINE.form_factor(&square), 1.0, PLANE_CUT);
    let half = [[0.0, -1e9], [1e9, -1e9], [1e9, 1e9], [0.0, 1e9]].map(|[x, y]| DVec3::new(x, y, 1.0));
    assert_relative("half", Ltc::COSINE.form_factor(&half), 0.5, PLANE_CUT);
    // tilted so that a part is below: a triangle from z = 1 to z = -1
    let tilted = [DVec3::new(0.0, -1.0, 1.0), DVec3::new(0.0, 1.0, 1.0), DVec3::new(0.0, 0.0, -1.0)];
    assert!(Ltc::COSINE.form_factor(&tilted).abs() < FEW_ROUNDINGS, "edge on");
}

#[test]
fn samples_have_the_density() {
    // E[g] for g = z and g = x, against quadrature
    for lobe in &LOBES[..2] {
        for g in [|w: DVec3| w.z, |w: DVec3| w.x * w.x] {
            let expected = sphere(|w| lobe.density(w) * g(w));
            let n = 1 << 14;
            let mean = Sobol::new(7).points(n).map(|u| g(lobe.sample(u))).sum::<f64>() / f64::from(n);
            near!(mean, expected, SOBOL_16K, "{lobe:?}: {mean} {expected}");
        }
    }
}

#[test]
fn the_sheen_lobe_is_its_matrix() {
    let sheen = Sheen::new(0.6, 0.4);
    let w = frame::spherical(0.8, 1.1);
    let v = DVec3::new(sheen.a * w.x + sheen.b * w.z, sheen.a * w.y, w.z);
    let square = v.length_squared();
    let expected = v.z / PI * (sheen.a / square) * (sheen.a / square);
    assert_relative("density", sheen.lobe().density(w), expected, DIGIT_LOST);
}

#[test]
fn sggx_projects_to_its_area() {
    for sigma in [0.3, 0.7, 1.0] {
        for theta in [0.0, 0.6, 1.5] {
            let w = frame::spherical(theta, 0.3);
            // ∫ D max(0, w·m) = ∫ D |w·m|/2, as D is even; the kink is at a great circle
            let area = 0.5 * sphere(|m| sggx::d(sigma, m) * w.dot(m).abs());
            assert_relative(&format!("{sigma} {theta}"), area, sggx::projected_area(sigma, w), KINK_IN_A_SUM);
        }
    }
}

#[test]
fn nothing_is_lost_from_white() {
    for e in [0.3, 0.7, 1.0] {
        assert_relative("slides", ms::colour_slides(1.0, e), 1.0, FEW_ROUNDINGS);
        assert_relative("series", ms::colour_series(1.0, e), 1.0, FEW_ROUNDINGS);
        assert_relative("Turquin", ms::turquin(1.0, e) * e, 1.0, FEW_ROUNDINGS);
    }
    let white = ms::fdez_aguera(1.0, 0.5, 0.1);
    assert_relative("Fdez-Aguera", white.single + white.multiple, 1.0, FEW_ROUNDINGS);
    assert_relative("guard", ms::colour_slides(1.0, 0.0), 1.0, 0.0);
}
