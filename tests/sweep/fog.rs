//! Airlight: along the ray instead of the angles of the paper.

use crate::sweep::kinds::Truths;
use crate::sweep::quad::{Setting, mark, sharp, sorted, two_settings};
use crate::sweep::texel::{Pick, Texel};
use serde_json::{Map, json};
use std::f64::consts::{FRAC_PI_2, PI};

pub(crate) fn attempt(kind: &str, layout: &str, pick: &mut Pick) -> Texel {
    let tau = pick.log(1e-6, 300.0);
    if kind == "airlight" {
        return Texel::new(
            kind,
            layout,
            "",
            Map::new(),
            &[("tau", tau), ("xi", pick.between(0.0, FRAC_PI_2))],
        );
    }
    let mut params = Map::new();
    params.insert("n".to_owned(), json!(pick.one(&["1", "1", "20", "300"]).parse::<f64>().unwrap()));
    Texel::new(kind, layout, "", params, &[("tau", tau), ("mu_i", pick.between(0.0, 1.0))])
}

pub(crate) fn truths(t: &Texel) -> Truths {
    let tau = t.axis("tau");
    vec![if t.kind == "airlight" {
        // t = tan x
        let end = t.axis("xi").tan().min(1e17);
        let edges = sorted(mark(0.0), mark(end), [1.0, 1.0 / tau, 40.0 / tau].map(mark).to_vec());
        two_settings(|s, tolerance| {
            s.pieces(&edges, tolerance, &mut |at, _, _| (-tau * at.x).exp() / (1.0 + at.x * at.x))
        })
    } else {
        let (n, mu) = (t.resolved().number("n").unwrap(), t.axis("mu_i"));
        let theta = mu.acos();
        let kinks = [FRAC_PI_2 - theta, FRAC_PI_2 + theta, theta];
        let edges = sorted(sharp(0.0), sharp(PI), kinks.map(sharp).to_vec());
        two_settings(|s, tolerance| {
            s.pieces(&edges, tolerance, &mut |gamma, inner, _| {
                ray(tau, gamma.x, s, inner) * round(gamma.x, theta, n, s, inner)
            })
        })
    }]
}

/// `sin g / 2 int exp(-tau (s + d)) / d^2 ds` over the distance s from the eye, d that from the lamp: `s = cos g + sin g tan a`.
fn ray(tau: f64, gamma: f64, s: &Setting, tolerance: f64) -> f64 {
    let (sin, cos) = gamma.sin_cos();
    let edges = sorted(sharp(gamma - FRAC_PI_2), sharp(FRAC_PI_2), vec![mark(0.0)]);
    let at = |a: f64| 0.5 * (-tau * (cos + sin * (a.tan() + 1.0 / a.cos()))).exp();
    s.pieces(&edges, tolerance, &mut |a, _, _| at(a.x)).value
}

/// The power of the cosine to the axis over the azimuth.
fn round(gamma: f64, theta: f64, n: f64, s: &Setting, tolerance: f64) -> f64 {
    let (a, b) = (gamma.cos() * theta.cos(), gamma.sin() * theta.sin());
    let last = if a >= b { PI } else { (-a / b).clamp(-1.0, 1.0).acos() };
    if a <= -b {
        return 0.0;
    }
    let edges = sorted(mark(0.0), sharp(last), vec![mark(1.0 / n.sqrt())]);
    s.pieces(&edges, tolerance, &mut |phi, _, _| 2.0 * (a + b * phi.x.cos()).max(0.0).powf(n)).value
}
