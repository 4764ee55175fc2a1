//! Every row of the reference files.

use crate::empirical::support::{albedo, model, quadrature, records};
use crate::tolerance::{DIGITS_LOST, INTEGRAL_11, near};
use brdfbake::integrate::View;
use brdfbake::math::frame;

/// Relative accuracy of a row: that of the formula, unless the lobe magnifies the rounding of the angles.
///
/// A lobe of width w turns an error of 1e-16 in a direction into 1e-16 / w times the distance in widths.
fn bound(params: &serde_json::Value) -> f64 {
    let narrow = params["n"].as_f64().is_some_and(|n| n >= 1000.0)
        || ["alpha_x", "alpha_y"].iter().any(|k| params[*k].as_f64().is_some_and(|a| a < 0.02));
    if narrow { 1e-11 } else { 1e-12 }
}

#[test]
fn points() {
    let mut count = 0;
    for row in records("points_empirical.csv") {
        let params: serde_json::Value = serde_json::from_str(&row["params_json"]).unwrap();
        let f = model(&row["model"], &row["params_json"]);
        let angle = |k: &str| row[k].parse::<f64>().unwrap();
        let wi = frame::spherical(angle("wi_theta"), angle("wi_phi"));
        let wo = frame::spherical(angle("wo_theta"), angle("wo_phi"));
        let (got, expected) = (f.eval(wo, wi), angle("value"));
        let error = (got - expected).abs();
        assert!(
            error <= bound(&params) * expected.abs(),
            "{} {params}: got {got:e}, expected {expected:e}, relative {:e}",
            row["model"],
            error / expected.abs()
        );
        count += 1;
    }
    assert_eq!(count, 196);
}

#[test]
fn albedos() {
    for row in records("albedo_empirical.csv") {
        let f = model(&row["model"], &row["params_json"]);
        let number = |k: &str| row[k].parse::<f64>().unwrap();
        let view = View { mu: libm::cos(number("wo_theta")), phi: number("wo_phi") };
        // the reference holds the digits that two routes agree in
        let known = number("value") * libm::pow(10.0, -number("digits").min(14.0));
        let what = format!("{} {} theta {}", row["model"], row["params_json"], row["wo_theta"]);
        let e = quadrature(&*f, view, 1e-11);
        let off = (e.value[0] - number("value")).abs();
        assert!(e.error[0] <= INTEGRAL_11, "{what}: estimate {:e}", e.error[0]);
        assert!(off <= e.error[0] + known, "{what}: off by {off:e}, estimate {:e}", e.error[0]);
        // and by the closed form, if the model has one
        let off = (albedo(&*f, view, 1e-11) - number("value")).abs();
        assert!(off <= INTEGRAL_11 + known, "{what}: off by {off:e} as tables get it");
    }
}

#[test]
fn ashikhmin_shirley_draws_its_half_vectors_as_published() {
    let mut count = 0;
    for row in records("points_sampling.csv") {
        if !row["model"].starts_with("sample_ashikhmin_shirley_h") {
            continue;
        }
        let p: serde_json::Value = serde_json::from_str(&row["params_json"]).unwrap();
        let f = model("ashikhmin-shirley-specular", &format!(r#"{{"nu": {}, "nv": {}}}"#, p["nu"], p["nv"]));
        // a quarter of the second number is the first quadrant; heights that the row does not give are small here
        let u = glam::DVec2::new(p["u2"].as_f64().unwrap_or(1e-6), 0.25 * p["u1"].as_f64().unwrap());
        let Some(s) = f.sample(glam::DVec3::Z, u) else { continue };
        let wh = (s.wi + glam::DVec3::Z).normalize();
        let got = if row["model"].contains("phi") { frame::phi(wh) } else { wh.z };
        let expected: f64 = row["value"].parse().unwrap();
        near!(got, expected, DIGITS_LOST, "{} {p}: {got} and {expected}", row["model"]);
        count += 1;
    }
    // one of the heights reflects below the horizon
    assert_eq!(count, 13);
}
