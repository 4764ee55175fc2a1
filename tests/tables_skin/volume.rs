//! Phase functions, their samples, media and black bodies, against high-precision values.

use super::helpers::{close, rows, table, texel};
use crate::common::{bake, request};
use crate::tolerance::{
    ANGLE_AT_THE_END, DIGIT_LOST_TWICE, FEW_ROUNDINGS, INTEGRAL_9, MANY_ROUNDINGS, SPECTRUM_SUM,
};
use brdfbake::grid::{Axis, Quantity, Texel};
use brdfbake::integrate::line;
use brdfbake::verify;
use std::f64::consts::PI;

const ANGLE: (&str, f64, f64) = ("deflection", 0.0, PI);

#[test]
fn airlight_agrees_with_high_precision_values() {
    let ray = table("airlight", "ray", "{}", &[("tau", 0.0, 200.0), ("xi", 0.0, PI / 2.0)]);
    // mpmath of 30 digits: int exp(-tau t) / (1 + t^2) dt; for xi = pi/2 Ci(tau) sin(tau) + (pi/2 - Si(tau)) cos(tau)
    for (tau, xi, value) in [
        (0.0, 1.25, 1.25),
        (0.01, PI / 2.0, 1.520_439_219_298_237_252_9),
        (0.5, PI / 2.0, 0.860_526_765_726_158_562_28),
        (3.0, PI / 2.0, 0.291_957_710_692_078_772_74),
        (100.0, PI / 2.0, 0.009_998_002_392_839_961_824_9),
        (0.5, 0.75, 0.614_180_216_930_582_762_29),
        (10.0, 0.3, 0.094_315_846_886_141_603_159),
        (2.0, 1.5, 0.399_020_988_594_182_524_98),
    ] {
        let e = texel(&ray, &[tau, xi], 1e-12);
        close(&format!("F({tau}, {xi})"), e.value[0], value, MANY_ROUNDINGS);
    }
    // mpmath, along the ray by s = cos + sin tan(a), and over the azimuth; of a thin medium pi (pi / 2 + 1) in closed form
    for (n, tau, mu, value) in [
        (1.0, 0.0, 1.0, PI * (PI / 2.0 + 1.0)),
        (1.0, 0.5, 1.0, 3.478_781_843_21),
        (1.0, 0.5, 0.25, 1.528_424_545_97),
        (1.0, 3.0, 0.75, 0.123_651_937_796),
        (1.0, 1.0, 0.0, 0.466_512_393_178),
        (20.0, 0.5, 0.25, 0.089_471_847_171_6),
    ] {
        let params = format!(r#"{{"n": {n}}}"#);
        let table = table("airlight-surface", "surface", &params, &[("tau", 0.0, 200.0), ("mu_i", 0.0, 1.0)]);
        let e = texel(&table, &[tau, mu], 1e-9);
        assert!(e.error[0] <= INTEGRAL_9, "{e:?}");
        close(&format!("G_{n}({tau}, {mu})"), e.value[0], value, INTEGRAL_9);
    }
}

#[test]
fn phase_functions_agree_with_high_precision_values() {
    for (name, id, names) in [
        ("phase_isotropic", "isotropic", &[][..]),
        ("phase_hg", "henyey-greenstein", &[("g", "g")]),
        ("phase_draine", "draine", &[("g", "g"), ("alpha", "draine_alpha")]),
        ("phase_rayleigh", "rayleigh", &[]),
        ("phase_mie_hg_draine_fit_5to50um", "fog", &[("d_um", "diameter")]),
    ] {
        for row in rows("points_volume", name) {
            if row.params.get("g").is_some_and(|g| g.as_f64().unwrap().abs() > 0.999) {
                continue;
            }
            let given: Vec<String> =
                names.iter().map(|n| format!(r#", "{}": {}"#, n.1, row.params[n.0])).collect();
            let params = format!(r#"{{"phase": "{id}"{}}}"#, given.concat());
            let bound = table("phase-function", "density", &params, &[ANGLE]);
            close(
                &row.name,
                texel(&bound, &[row.angle], 1e-9).value[0],
                row.value,
                DIGIT_LOST_TWICE * row.value,
            );
        }
    }
}

/// The numbers of a phase function are axes: the same as fixed; those that it does not have are refused.
#[test]
fn numbers_of_phase_functions_are_axes() {
    let numbers = [
        ("fog", "diameter", 12.0, [5.0, 50.0]),
        ("draine", "draine_alpha", 2.0, [0.0, 10.0]),
        ("draine", "g", 0.4, [-0.9, 0.9]),
    ];
    for (kind, layout, coordinate, x) in
        [("phase-function", "relative", "deflection", 0.3), ("phase-sampling", "cosine", "u", 0.7)]
    {
        for (phase, number, value, [lo, hi]) in numbers {
            let along = (coordinate, 0.0, 1.0);
            let swept = format!(r#"{{"phase": "{phase}"}}"#);
            let swept = table(kind, layout, &swept, &[along, (number, lo, hi)]);
            let fixed = format!(r#"{{"phase": "{phase}", "{number}": {value}}}"#);
            let fixed = table(kind, layout, &fixed, &[along]);
            let [a, b] = [texel(&swept, &[x, value], 1e-9), texel(&fixed, &[x], 1e-9)].map(|e| e.value[0]);
            close(&format!("{kind} {phase} {number}"), a, b, 0.0);
        }
        let request = brdfbake::tables::spec::Request {
            kind: kind.to_owned(),
            params: serde_json::from_str(r#"{"phase": "fog"}"#).unwrap(),
            axes: Some([coordinate, "g"].map(|id| crate::common::axis(id, 4, Texel::Endpoint)).to_vec()),
            ..Default::default()
        };
        let why = request.bind().unwrap_err().to_string();
        assert!(why.contains("nothing in it depends on axis g") && why.contains("diameter"), "{why}");
    }
    let fog = table("phase-function", "density", r#"{"phase": "fog"}"#, &[ANGLE, ("diameter", 5.0, 50.0)]);
    let baked = bake(&fog, 1e-9).unwrap();
    let (_, findings) = verify::check(&fog, baked, 1e-9, &[]).unwrap();
    assert!(findings.is_empty(), "{findings:?}");
}

#[test]
fn samples_of_phase_functions_agree_with_high_precision_values() {
    for row in rows("points_volume", "hg_sample_cos") {
        let bound = table("phase-sampling", "cosine", "{}", &[("u", 0.0, 1.0), ("g", -1.0, 1.0)]);
        close(
            &row.name,
            texel(&bound, &[row.num("xi"), row.num("g")], 1e-9).value[0],
            row.value,
            MANY_ROUNDINGS,
        );
    }
}

/// The inverse against the forward density, integrated by another rule.
#[test]
fn the_part_of_the_light_behind_a_sample_is_its_number() {
    for phase in [
        r#"{"phase": "henyey-greenstein", "g": -0.9}"#,
        r#"{"phase": "rayleigh"}"#,
        r#"{"phase": "draine", "g": 0.6, "draine_alpha": 7}"#,
        r#"{"phase": "fog", "diameter": 5}"#,
        r#"{"phase": "fog", "diameter": 10}"#,
        r#"{"phase": "fog", "diameter": 50}"#,
        r#"{"phase": "isotropic"}"#,
    ] {
        let density = table("phase-function", "density", phase, &[ANGLE]);
        let sampling = table("phase-sampling", "angle", phase, &[("u", 0.0, 1.0)]);
        for u in [0.001, 0.2, 0.5, 0.7, 0.9, 0.99] {
            let theta = texel(&sampling, &[u], 1e-9).value[0];
            let mut breaks = vec![theta];
            breaks.extend([1e-3, 1e-2, 0.1, 0.5, 1.0, 2.0, 3.0].into_iter().filter(|b| *b > theta));
            breaks.push(PI);
            let behind = line::integrate(&breaks, 1, 1e-12, &mut |t, out| {
                out[0] = 2.0 * PI * libm::sin(t) * texel(&density, &[t], 1e-9).value[0];
            });
            close(phase, behind.value[0], u, INTEGRAL_9);
        }
        close(phase, texel(&sampling, &[0.0], 1e-9).value[0], PI, ANGLE_AT_THE_END);
        close(phase, texel(&sampling, &[1.0], 1e-9).value[0], 0.0, ANGLE_AT_THE_END);
    }
}

#[test]
fn media_agree_with_high_precision_values() {
    for (name, layout) in [("beer_lambert_T", "transmitted"), ("beer_lambert_1_minus_T", "lost")] {
        for row in rows("points_volume", name) {
            let params = format!(r#"{{"sigma_g": {}}}"#, row.params["sigma_t"]);
            let bound = table("beer-lambert", layout, &params, &[("path", 0.0, 100.0)]);
            close(
                &row.name,
                texel(&bound, &[row.num("d")], 1e-9).value[1],
                row.value,
                MANY_ROUNDINGS * row.value,
            );
        }
    }
}

#[test]
fn black_bodies_agree_with_high_precision_values() {
    let axes = [("temperature", 500.0, 1e6)];
    for row in rows("integrals", "blackbody_linear_srgb") {
        for tolerance in [1e-3, 1e-6, 1e-9, 1e-11] {
            let bound = table("blackbody", "hue-unclamped", "{}", &axes);
            let (e, c) = (texel(&bound, &[row.num("T_K")], tolerance), row.channel());
            close(&format!("{} {tolerance:e}", row.name), e.value[c], row.value, tolerance);
            close(
                &format!("{} {tolerance:e} estimate", row.name),
                e.value[c],
                row.value,
                e.error[c] + FEW_ROUNDINGS,
            );
        }
    }
    // at the reference temperature the light is the hue; twice 5000 K has the luminance that Planck's law gives it
    let light = table("blackbody", "light", r#"{"reference": 5000}"#, &axes);
    let hue = table("blackbody", "hue", "{}", &axes);
    let (a, b) = (texel(&light, &[5000.0], 1e-9), texel(&hue, &[5000.0], 1e-9));
    for c in 0..3 {
        close("reference", a.value[c], b.value[c], INTEGRAL_9);
    }
    let ends = |t: f64| {
        line::integrate(&[360.0, 530.9, 568.8, 830.0], 1, 1e3, &mut |l, out| {
            out[0] = brdfbake::terms::blackbody::planck(l, t) * brdfbake::terms::blackbody::wyman_xyz(l)[1];
        })
        .value[0]
    };
    let y = |v: &[f64]| 0.2126729 * v[0] + 0.7151522 * v[1] + 0.0721750 * v[2];
    let twice = texel(&light, &[10_000.0], 1e-9);
    close("twice as hot", y(&twice.value), ends(10_000.0) / ends(5000.0), SPECTRUM_SUM);
}

#[test]
fn laws_hold() {
    let axis = |id: &str, lo: f64, hi: f64| {
        Axis::new(Quantity::find(id).unwrap(), 17, Texel::Endpoint).over([lo, hi])
    };
    for (kind, layout, params, axes) in [
        (
            "phase-function",
            "density",
            r#"{"phase": "draine"}"#,
            vec![axis("deflection", 0.0, PI), axis("g", -0.9, 0.9)],
        ),
        ("phase-function", "relative", r#"{"phase": "fog"}"#, vec![axis("deflection", 0.0, PI)]),
        ("phase-sampling", "cosine", r#"{"phase": "fog"}"#, vec![axis("u", 0.0, 1.0)]),
        ("phase-sampling", "angle", "{}", vec![axis("u", 0.0, 1.0), axis("g", -0.9, 0.9)]),
        ("beer-lambert", "transmitted", "{}", vec![axis("path", 0.0, 10.0)]),
        ("beer-lambert", "lost", "{}", vec![axis("path", 0.0, 10.0)]),
        ("blackbody", "hue", "{}", vec![axis("temperature", 800.0, 20_000.0)]),
        ("blackbody", "light", "{}", vec![axis("temperature", 800.0, 4000.0)]),
    ] {
        let bound = request(kind, layout, params, axes);
        let table = bake(&bound, 1e-5).unwrap();
        let checked = verify::check(&bound, table, 1e-5, &[]);
        assert!(checked.is_ok(), "{kind} {layout}: {:?}", checked.unwrap_err());
    }
}
