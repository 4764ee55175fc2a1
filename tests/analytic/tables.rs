//! Channels of any table, each by itself, against values that this program did not make.

use crate::common::{axis, request};
use crate::tolerance::{INTEGRAL_5_TWICE, near};
use brdfbake::grid::{Texel, Warp};
use brdfbake::report::analytic::{FitError, FittedFormula, Form, Lang, table};
use brdfbake::tables::spec::Request;

fn of(kind: &str, layout: &str, form: Form, degree: usize) -> FittedFormula {
    let request = Request { kind: kind.into(), layout: Some(layout.into()), ..Request::default() };
    table(&request.bind().unwrap(), form, degree).unwrap()
}

#[test]
fn an_albedo_agrees_with_the_closed_form() {
    let coupled = Warp::Coupled { to: "alpha".into(), power: 2.0, scale: 1.0, exponent: 1.0 };
    let axes = vec![axis("mu", 8, Texel::Endpoint).warped(coupled), axis("roughness", 8, Texel::Endpoint)];
    let bound = request("albedo", "e", "{}", axes);
    let fit = table(&bound, Form::Rational, 3).unwrap();
    eprintln!("{} operations, {:?}", fit.operations(), fit.whole);
    assert!(fit.largest(false) < 0.06 && fit.largest(true) < 0.02, "{:?}", fit.practical);
    for i in 1..=100 {
        let mu = f64::from(i) / 100.0;
        let e = 1.0 - mu * libm::log((1.0 + mu) / mu);
        let got = f64::from(fit.evaluate(&[mu as f32, 1.0])[0]);
        near!(got, e, 1.02 * fit.largest(mu >= 0.05), "{mu}: {got}, {e}");
    }
}

#[test]
fn schlick_is_a_polynomial_of_degree_five() {
    let linear = vec![axis("mu", 8, Texel::Endpoint), axis("f0", 8, Texel::Endpoint)];
    let bound = request("fresnel-schlick", "clamped", "{}", linear);
    let [four, six] = [4, 6].map(|d| table(&bound, Form::Polynomial, d).unwrap());
    // f0 + (1 - f0) (1 - mu)^5 has total degree 6
    assert!(six.whole.largest < INTEGRAL_5_TWICE, "{:?}", six.whole);
    assert!(four.whole.largest > 1e-3, "{:?}", four.whole);
    let got = f64::from(six.evaluate(&[0.25, 0.5])[0]);
    near!(got, (0.5 + 0.5 * 0.75f64.powi(5)), INTEGRAL_5_TWICE, "{got}");
}

#[test]
fn a_mean_over_one_axis_agrees_with_the_closed_form() {
    for form in [Form::Polynomial, Form::Rational] {
        let fit = of("average-albedo", "e-avg", form, 4);
        // E_avg(1) = 4/3 (1 - ln 2), a mirror has 1
        let last = fit.arguments().len();
        assert_eq!(last, 1);
        let got = f64::from(fit.evaluate(&[1.0])[0]);
        let want = 4.0 / 3.0 * (1.0 - std::f64::consts::LN_2);
        near!(got, want, fit.whole.largest + 1e-6, "{got}, {want}, {:?}", fit.whole);
        assert!(fit.whole.largest < 0.01, "{form:?}: {:?}", fit.whole);
    }
}

/// The matrices of transformed cosines are judged by how far their lobes are from the model, not by their entries.
#[test]
fn matrices_are_judged_by_their_lobes() {
    let mu = axis("mu", 8, Texel::Endpoint).over([0.2, 1.0]);
    let bound = request("ltc-matrix", "over-m22", r#"{"alpha": 0.3}"#, vec![mu]);
    let [coarse, fine] = [1, 4].map(|degree| table(&bound, Form::Polynomial, degree).unwrap());
    let lobes = |fit: &FittedFormula| fit.lobes.unwrap()[0].errors;
    for fit in [&coarse, &fine] {
        let [l3, l1] = lobes(fit);
        assert!(l3.nearest > 0.0 && l1.nearest > 0.0 && l1.fitted < 2.0, "{l3:?} {l1:?}");
        // no lobe is nearer than the nearest
        assert!(l3.added >= 0.0 && l3.fitted >= l3.nearest - 1e-4, "{l3:?}");
        assert!((fit.largest(false) - l3.added).abs() <= 0.0, "{l3:?}");
        assert!(fit.code(Lang::Glsl).contains("// Lobes, whole domain: L3 "), "{}", fit.code(Lang::Glsl));
    }
    assert!(lobes(&fine)[0].added < 0.2 * lobes(&coarse)[0].added, "{:?} {:?}", lobes(&fine), lobes(&coarse));
    let none = of("average-albedo", "e-avg", Form::Polynomial, 2);
    assert!(none.lobes.is_none());
}

#[test]
fn what_cannot_be_fitted_is_refused() {
    let three = vec![
        axis("mu", 4, Texel::Endpoint),
        axis("alpha", 4, Texel::Endpoint).over([0.1, 1.0]),
        axis("f0", 4, Texel::Endpoint),
    ];
    let bound = request("albedo", "e", "{}", three);
    let error = table(&bound, Form::Rational, 2).unwrap_err();
    assert!(matches!(error, FitError::Table { .. }), "{error}");
    let bound = request("albedo", "e", "{}", vec![axis("mu", 4, Texel::Endpoint)]);
    assert!(matches!(table(&bound, Form::Rational, 9), Err(FitError::Table { .. })));
}

#[test]
fn the_code_does_not_depend_on_the_number_of_threads() {
    let code = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| of("fresnel-dielectric", "polarised", Form::Rational, 2).code(Lang::Glsl))
    };
    assert_eq!(code(1), code(3));
}
