//! Tables against values that this program did not make, and the promises about axes, estimates and laws.
#![allow(clippy::unwrap_used, clippy::float_cmp, reason = "test")]

use crate::common::{axis, bake, request};
use crate::tolerance::{
    AXIS_STEEP, AXIS_STEP, DIGITS_LOST, HAMMERSLEY, INTEGRAL_9, INTEGRAL_10, INTEGRAL_11, near,
};
use brdfbake::grid::{Axis, Direction, Grid, Quantity, Texel, Warp, lookup};
use brdfbake::models::{self, Params};
use brdfbake::tables::average_albedo::average;
use brdfbake::verify::baseline::{hammersley_f32, hammersley_f64};
use brdfbake::verify::reconstruction::Probe;
use brdfbake::verify::{self, Verified};
use proptest::prelude::*;

/// Rows of `values/dfg.csv`: mu, roughness, scale, bias.
fn reference() -> Vec<[f64; 4]> {
    let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/values/dfg.csv")).unwrap();
    let rows = text.lines().filter(|l| !l.starts_with('#')).skip(1);
    rows.map(|l| l.split(',').map(|v| v.parse().unwrap()).collect::<Vec<f64>>().try_into().unwrap()).collect()
}

#[test]
fn every_reference_texel_is_within_its_tolerance_and_its_estimate() {
    let axes = || vec![axis("mu", 128, Texel::Center), axis("roughness", 128, Texel::Center)];
    for layout in ["scale-bias", "multiscatter"] {
        let bound = request("dfg", layout, "{}", axes());
        for tolerance in [1e-2, 2.4e-4, 1e-6, 1e-9] {
            let (mut dishonest, mut worst) = (0, 0.0f64);
            for [mu, roughness, scale, bias] in reference() {
                let e = bound.baker.texel(&[mu, roughness * roughness], tolerance).unwrap();
                let expected = if layout == "scale-bias" { [scale, bias] } else { [bias, scale + bias] };
                let mut honest = true;
                for (c, r) in expected.iter().enumerate() {
                    let error = (e.value[c] - r).abs();
                    assert!(error <= tolerance, "{layout} {mu} {roughness}: {error:e} > {tolerance:e}");
                    assert!(e.error[c] <= tolerance, "{layout} {mu} {roughness}: estimate {:e}", e.error[c]);
                    worst = worst.max(error / (e.error[c] + 1e-13));
                    honest &= error <= e.error[c] + 1e-13;
                }
                dishonest += usize::from(!honest);
            }
            assert!(
                dishonest <= 2,
                "{layout} {tolerance:e}: {dishonest} of 256 errors above their estimates"
            );
            assert!(worst <= 10.0, "{layout} {tolerance:e}: an error is {worst} times its estimate");
        }
    }
}

fn model(id: &str, params: &str) -> Box<dyn models::Brdf> {
    let (info, _) = models::find(id).unwrap();
    let map: serde_json::Map<String, serde_json::Value> = serde_json::from_str(params).unwrap();
    let params = Params::resolve(info.id, info.params, map.iter().map(|(k, v)| (k.as_str(), v))).unwrap();
    (info.build)(&params).unwrap()
}

#[test]
fn average_albedo_at_alpha_one_is_the_closed_form() {
    let ln2 = std::f64::consts::LN_2;
    for (masking, expected) in
        [("correlated", 4.0 / 3.0 * (1.0 - ln2)), ("separable", 4.0 * (1.0 - ln2) * (1.0 - ln2))]
    {
        let m = model("ggx", &format!(r#"{{"alpha": 1, "masking": "{masking}"}}"#));
        let e = average(&*m, Some(1.0), 1e-10).unwrap();
        near!(e.value[0], expected, INTEGRAL_10, "{masking}: {} expected {expected}", e.value[0]);
        near!(e.value[0], expected, e.error[0]);
    }
}

#[test]
fn average_albedo_agrees_with_published_anchors() {
    // E_avg of white GGX, height-correlated, 12 decimals from two quadratures in extended precision
    for (alpha, expected) in
        [(0.01, 0.999490545680), (0.1, 0.972045756816), (0.5, 0.700240469125), (0.75, 0.536302859034)]
    {
        let m = model("ggx", &format!(r#"{{"alpha": {alpha}}}"#));
        let e = average(&*m, Some(alpha), 1e-9).unwrap();
        near!(e.value[0], expected, INTEGRAL_9, "alpha {alpha}: {}", e.value[0]);
    }
}

#[test]
fn estimators_of_other_bakers_scatter_round_the_table() {
    for [mu, roughness, scale, bias] in reference().into_iter().filter(|r| r[0] > 0.3 && r[1] > 0.2) {
        let alpha = roughness * roughness;
        let d = hammersley_f64(mu, alpha, 4096);
        assert!(
            (d[0] - scale).abs() < HAMMERSLEY && (d[1] - bias).abs() < HAMMERSLEY,
            "{mu} {roughness}: {d:?}"
        );
        #[allow(clippy::cast_possible_truncation, reason = "the estimator is an f32 one")]
        let f = hammersley_f32(mu as f32, alpha as f32, 4096);
        near!(f64::from(f[0]), scale, HAMMERSLEY, "{mu} {roughness}: {f:?}");
    }
}

#[test]
fn separable_and_correlated_masking_are_not_confused() {
    let e = |masking: &str| {
        let m = model("ggx", &format!(r#"{{"alpha": 1, "masking": "{masking}"}}"#));
        brdfbake::tables::integral::integrate(
            &*m,
            0.25,
            &[brdfbake::tables::integral::Functional::One],
            1e-12,
        )
        .unwrap()
        .value[0]
    };
    let ln2 = std::f64::consts::LN_2;
    // Lommel-Seeliger, and 2 (1 - ln 2) / (1 + mu)
    near!(e("correlated"), (1.0 - 0.25 * libm::log(5.0)), INTEGRAL_11);
    near!(e("separable"), 2.0 * (1.0 - ln2) / 1.25, INTEGRAL_11);
}

fn bake_verified(kind: &str, layout: &str, params: &str, axes: Vec<Axis>) -> Verified {
    let bound = request(kind, layout, params, axes);
    let table = bake(&bound, 1e-5).unwrap();
    verify::check(&bound, table, 1e-5, &[]).unwrap().0
}

#[test]
fn the_reader_returns_texels_and_the_reconstruction_error_is_what_it_says() {
    let bound = request(
        "albedo",
        "e",
        "{}",
        vec![axis("mu", 16, Texel::Center), axis("roughness", 8, Texel::Endpoint)],
    );
    let table = bake(&bound, 1e-9).unwrap();
    for texel in 0..table.grid.len() {
        let mut out = [0.0];
        table.read(&table.grid.texel(texel), &mut out);
        near!(out[0], table.values[texel], DIGITS_LOST, "texel {texel}");
    }
    // by hand at one point between texels: a dense scan can not find a larger error than the report by much
    let report = Probe::new(&bound, 1e-9, 1 << 14).measure(&table.values);
    let mut largest = 0.0f64;
    for i in 0..64 {
        for j in 0..64 {
            let point =
                table.grid.at_coordinates(&[(f64::from(i) + 0.5) / 64.0, (f64::from(j) + 0.5) / 64.0]);
            let fresh = bound.baker.texel(point.values(), 1e-9).unwrap().value[0];
            let mut read = [0.0];
            lookup::read(&table.grid, &table.values, &point, &mut read);
            largest = largest.max((read[0] - fresh).abs());
        }
    }
    assert!(
        report.whole.largest.value >= 0.9 * largest,
        "{} reported, {largest} found",
        report.whole.largest.value
    );
}

#[test]
fn laws_of_the_d_table_the_fresnel_table_and_both_split_sums_hold() {
    let v = bake_verified(
        "ndf",
        "relative",
        r#"{"distribution": "beckmann"}"#,
        vec![axis("mu_m", 32, Texel::Endpoint), axis("alpha", 9, Texel::Endpoint).over([0.05, 1.0])],
    );
    assert!(v.laws().iter().any(|l| l.law == "normalised" && l.held()));
    let v = bake_verified(
        "fresnel-dielectric",
        "both-sides",
        "{}",
        vec![axis("mu", 33, Texel::Endpoint), axis("eta", 9, Texel::Endpoint).over([1.1, 2.5])],
    );
    assert!(v.laws().iter().any(|l| l.law == "fresnel-reversible" && l.held()));
    let axes = || vec![axis("mu", 12, Texel::Center), axis("roughness", 12, Texel::Center)];
    for layout in ["scale-bias", "multiscatter"] {
        for model in [r#"{"masking": "separable"}"#, "{}"] {
            let v = bake_verified("dfg", layout, model, axes());
            assert!(v.laws().iter().all(|l| l.held()), "{layout} {model}: {:?}", v.laws());
        }
    }
}

#[test]
fn an_albedo_above_one_is_integrated_again() {
    // at mu = 0.0234, alpha = 6e-5 two levels of the chart agree by chance at 1.000135
    let tolerance = 1.0 / 4096.0;
    let centred = |id| axis(id, 64, Texel::Center);
    let sqrt = axis("mu", 333, Texel::Endpoint).warped(Warp::Power(0.5));
    for (layout, axes) in [
        ("multiscatter", vec![centred("mu"), centred("roughness")]),
        ("scale-bias", vec![sqrt, axis("roughness", 200, Texel::Endpoint)]),
    ] {
        let bound = request("dfg", layout, "{}", axes);
        let table = bake(&bound, tolerance).unwrap();
        verify::check(&bound, table, tolerance, &[]).unwrap();
    }
}

#[test]
fn a_wrong_value_breaks_a_law() {
    let bound = request(
        "dfg",
        "scale-bias",
        "{}",
        vec![axis("mu", 8, Texel::Center), axis("roughness", 8, Texel::Center)],
    );
    let good = bake(&bound, 1e-6).unwrap();
    let broken_laws = |change: &dyn Fn(&mut Vec<f64>)| {
        let mut table = good.clone();
        change(&mut table.values);
        let findings = verify::check(&bound, table, 1e-6, &[]).unwrap_err();
        findings.into_iter().map(|f| f.law).collect::<Vec<_>>()
    };
    // each fault is seen by the law that is there for it
    assert!(broken_laws(&|v| v[10] = f64::NAN).contains(&"finite".to_owned()));
    assert!(broken_laws(&|v| v[10] = -0.1).contains(&"finite".to_owned()));
    assert!(broken_laws(&|v| v[10] += 0.5).contains(&"energy".to_owned()));
    assert!(broken_laws(&|v| v.iter_mut().for_each(|x| *x *= 1.0001)).contains(&"split".to_owned()));
    // scale and bias swapped: their sum is right, only the independent integrator can tell
    assert!(broken_laws(&|v| v.chunks_mut(2).for_each(|c| c.swap(0, 1))).contains(&"cross-check".to_owned()));
}

#[test]
fn a_tolerance_that_cannot_be_reached_is_an_error_with_its_place() {
    let bound =
        request("albedo", "e", "{}", vec![axis("mu", 2, Texel::Endpoint), axis("alpha", 2, Texel::Endpoint)]);
    let error = bake(&bound, 1e-17).unwrap_err().to_string();
    assert!(error.contains("miss the tolerance") && error.contains("mu ="), "{error}");
}

fn any_warp() -> impl Strategy<Value = Warp> {
    prop_oneof![
        Just(Warp::Linear),
        (0.2f64..4.0).prop_map(Warp::Power),
        (0.2f64..4.0).prop_map(Warp::OneMinusPower),
        (1.0f64..4.0, 0.5f64..16.0, 0.25f64..1.0).prop_map(|(power, scale, exponent)| Warp::Coupled {
            to: "alpha".to_owned(),
            power,
            scale,
            exponent
        }),
    ]
}

proptest! {
    /// index -> value -> index, for every warp, convention, direction and offset.
    #[test]
    fn axes_round_trip(
        warp in any_warp(),
        center in any::<bool>(),
        descending in any::<bool>(),
        offset in -1.0f64..1.0,
        len in 2usize..64,
        at in 0.05f64..0.95,
        alpha in 0.01f64..1.0,
    ) {
        let texel = if center { Texel::Center } else { Texel::Endpoint };
        let mut axis = Axis::new(Quantity::find("mu").unwrap(), len, texel).warped(warp);
        axis.offset = offset;
        if descending {
            axis.direction = Direction::Descending;
        }
        let n = brdfbake::grid::axis::count(len);
        let index = if center { at * n - 0.5 - offset } else { at * (n - 1.0) - offset };
        let value = axis.value_at(axis.coordinate(index), alpha);
        // near an end a strong warp leaves no digits of the value to come back from
        prop_assume!((1e-6..=1.0 - 1e-6).contains(&value));
        prop_assert!((axis.index(value, alpha) - index).abs() < AXIS_STEP * n, "{axis:?} {index} {value}");
    }

    /// A grid finds its own texels, couplings and derived quantities included.
    #[test]
    fn grids_round_trip(warp in any_warp(), texel in 0usize..143) {
        let mu = axis("mu", 12, Texel::Center).warped(warp);
        let grid = Grid::new(vec![mu, axis("roughness", 12, Texel::Center).over([0.1, 1.0])]).unwrap();
        let point = grid.texel(texel);
        let [x, y, ..] = grid.index(&point);
        let [i, j, ..] = grid.unravel(texel);
        prop_assert!((x - i as f64).abs() < AXIS_STEEP && (y - j as f64).abs() < INTEGRAL_9, "{x} {i} {y} {j}");
    }
}
