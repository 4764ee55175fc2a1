//! SBRDF maps of Lafortune: integrals and fits, by sums that share nothing with theirs.
#![allow(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "test"
)]

use crate::tolerance::{
    FEW_ROUNDINGS, LOBE_DIGITS_NINE, LOBE_FIT, LOBE_HORIZON, LOBE_MINIMUM, LOBE_SUM, MANY_ROUNDINGS,
};
use brdfbake::cancel::Cancel;
use brdfbake::maps::sbrdf::curve::{Curve, Placed, mixture};
use brdfbake::maps::sbrdf::fit::{Problem, Shape, start};
use brdfbake::maps::sbrdf::integral::{integral, root};
use brdfbake::maps::sbrdf::nodes::Directions;
use brdfbake::maps::sbrdf::{CosineLobe, Normalise, exponent, exponent_code, ladder};
use glam::DVec3;
use std::f64::consts::{FRAC_1_PI, PI};

/// Directions of the hemisphere with their solid angles, denser near the pole `about`.
pub(crate) fn hemisphere(about: DVec3, rings: u32, sectors: u32) -> Vec<(DVec3, f64)> {
    let t = about.any_orthonormal_vector();
    let b = about.cross(t);
    let mut out = Vec::new();
    for i in 0..rings {
        let u = (f64::from(i) + 0.5) / f64::from(rings);
        let theta = PI * u * u;
        let area = 2.0 * PI * u / f64::from(rings) * theta.sin() * 2.0 * PI / f64::from(sectors);
        for j in 0..sectors {
            let phi = 2.0 * PI * (f64::from(j) + 0.5) / f64::from(sectors);
            let w = (t * phi.cos() + b * phi.sin()) * theta.sin() + about * theta.cos();
            if w.z > 0.0 {
                out.push((w, area));
            }
        }
    }
    out
}

#[test]
fn the_integral_of_a_lobe_is_that_of_closed_forms_and_sums() {
    for u in [1.0, 0.9, 0.4, 0.01, 0.0, -0.01, -0.4, -0.9, -0.999] {
        // the sector between two hemispheres; cosines of two axes over it (n = 1)
        let angle = f64::acos(u);
        let forms = [
            (integral(0.0, u, false), 2.0 * PI),
            (integral(0.0, u, true), PI),
            (integral(1.0, u, false), 0.5 * PI * (1.0 + u)),
            (integral(1.0, u, true), 2.0 / 3.0 * (angle.sin() + (PI - angle) * u)),
        ];
        for (k, (value, expected)) in forms.into_iter().enumerate().skip(2) {
            assert!((value - expected).abs() <= LOBE_DIGITS_NINE * expected, "{k} {u}: {value} {expected}");
        }
        // n = 0 is the hemisphere of the axis, of which the sector above the horizon is left
        let (sector, cosine) = (2.0 * (PI - angle), 0.5 * PI * (1.0 + u));
        assert!((forms[0].0 - sector).abs() <= LOBE_DIGITS_NINE * PI, "{u}");
        assert!((forms[1].0 - cosine).abs() <= LOBE_DIGITS_NINE * PI, "{u}");
    }
    for n in [3.5, 40.0] {
        for u in [0.8, 0.1, -0.2, -0.7] {
            let axis = DVec3::new((1.0f64 - u * u).sqrt(), 0.0, u);
            let sum: f64 =
                hemisphere(axis, 600, 600).iter().map(|(w, a)| a * w.dot(axis).max(0.0).powf(n) * w.z).sum();
            let value = integral(n, u, true);
            assert!((value - sum).abs() < LOBE_SUM, "{n} {u}: {value}, by a sum {sum}");
            let rooted = root(n, u, true).powf(n + 1.0) * 2.0 * PI / (n + 2.0);
            assert!((rooted - value).abs() <= LOBE_DIGITS_NINE * value, "{n} {u}: {rooted} {value}");
        }
    }
    // the limit below the horizon
    assert!(
        (root(1e5, -0.6, true) - 0.8).abs() < LOBE_HORIZON && root(1e5, -1.0, true).abs() < FEW_ROUNDINGS
    );
}

/// Shape and n of two lobes over a diffuse floor come back from their values.
#[test]
fn lobes_that_are_known_are_found() {
    for normalise in [Normalise::Incident, Normalise::Largest] {
        let truth = [
            (CosineLobe { c: [-1.0, -1.0, 0.9], n: 60.0 }, 0.3),
            (CosineLobe { c: [-0.7, -0.7, 1.0], n: 6.0 }, 0.2),
        ];
        let value = |i: DVec3, o: DVec3| {
            let lobe = |(lobe, albedo): &(CosineLobe, f64)| {
                let turned = DVec3::from_array(lobe.c) * i;
                let n = if normalise == Normalise::Incident { lobe.norm(i) } else { lobe.largest() };
                albedo * turned.dot(o).max(0.0).powf(lobe.n) / n
            };
            (0.1 * FRAC_1_PI + truth.iter().map(lobe).sum::<f64>()) * o.z
        };
        let directions = Directions::new(0.2);
        let target = directions.sample(value).into_iter().map(Some).collect();
        let problem = Problem::new(directions, &[target], &[1.0], normalise);
        let fit = problem.finish(&problem.descend(&start(0.15, 2), 200));
        assert!(fit.all() < LOBE_FIT, "{normalise:?}: residual {}", fit.all());
        assert!((fit.albedos[0][0] - 0.1).abs() < LOBE_FIT, "{normalise:?}: {fit:?}");
        let mut found: Vec<(Shape, f64)> =
            fit.shapes.iter().copied().zip(fit.albedos[0][1..].iter().copied()).collect();
        found.sort_by(|a, b| b.0.log.total_cmp(&a.0.log));
        for ((shape, albedo), (lobe, expected)) in found.iter().zip(&truth) {
            let got = shape.lobe();
            assert!((got.n / lobe.n - 1.0).abs() < 0.02, "{normalise:?}: {got:?} {lobe:?}");
            assert!((albedo - expected).abs() < LOBE_FIT, "{normalise:?}: {albedo} {expected}");
            assert!((got.c[0] / got.c[2] - lobe.c[0] / lobe.c[2]).abs() < 0.02, "{got:?} {lobe:?}");
            assert!((got.c.iter().fold(0.0f64, |m, c| m.max(c.abs())) - 1.0).abs() < FEW_ROUNDINGS);
        }
    }
}

/// A lobe whose C has three different elements is found again from lights at several azimuths.
#[test]
fn lobes_of_two_axes_are_found_again() {
    let lobe = CosineLobe { c: [-1.0, -0.8, 0.9], n: 30.0 };
    let value = |i: DVec3, o: DVec3| {
        let turned = DVec3::from_array(lobe.c) * i;
        (0.1 * FRAC_1_PI + 0.6 * turned.dot(o).max(0.0).powf(lobe.n) / lobe.norm(i)) * o.z
    };
    let directions = Directions::stretched([0.3, 0.15]);
    let target = directions.sample(value).into_iter().map(Some).collect();
    let problem = Problem::new(directions, &[target], &[1.0], Normalise::Incident);
    let fit = problem.finish(&problem.descend(&start(0.2, 1), 200));
    assert!(fit.all() < LOBE_FIT, "residual {}", fit.all());
    let got = fit.shapes[0].lobe();
    assert!((got.n / lobe.n - 1.0).abs() < 0.02, "{got:?}");
    assert!(got.c.iter().zip(lobe.c).all(|(a, b)| (a - b).abs() < 0.01), "{got:?}");
    let again = Shape::of(&got);
    let [a, b] = [again.lobe().c, got.c];
    assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < MANY_ROUNDINGS), "{a:?} {b:?}");
}

/// Lobes over their integral reflect their albedo; over the largest one at most that, and both ways alike.
#[test]
fn albedos_are_what_lobes_reflect() {
    let cancel = Cancel::new();
    for normalise in [Normalise::Incident, Normalise::Largest] {
        let curve = Curve::new([0.4, 0.4], mixture(0.6, 0.0), 2, normalise, &cancel).unwrap();
        let texel = curve.texel(0.4, [0.6; 3], [0.0; 3]);
        assert!(texel.lobes[0].albedo[1] >= texel.lobes[1].albedo[1]);
        for placed in &texel.lobes {
            let (lobe, albedo) = (placed.lobe, placed.albedo[1]);
            for mu in [1.0, 0.7, 0.3, 0.1] {
                let i = DVec3::new((1.0f64 - mu * mu).sqrt(), 0.0, mu);
                let a = DVec3::from_array(lobe.c) * i;
                let sum: f64 = hemisphere(a.normalize(), 400, 200)
                    .iter()
                    .map(|(o, area)| area * a.dot(*o).max(0.0).powf(lobe.n) * o.z)
                    .sum();
                if normalise == Normalise::Incident {
                    assert!((sum / lobe.norm(i) - 1.0).abs() < LOBE_HORIZON, "{lobe:?} {mu}");
                } else {
                    let reflected = albedo * placed.constant * sum;
                    assert!(reflected <= albedo * 1.001, "{lobe:?} {mu}: {reflected} of {albedo}");
                }
            }
        }
    }
}

/// GGX with Schlick's Fresnel by the textbook, times the cosine.
pub(crate) fn ggx(i: DVec3, o: DVec3, alpha: f64, f0: f64) -> f64 {
    let h = (i + o).normalize();
    let (a2, c2) = (alpha * alpha, h.z * h.z);
    let d = a2 / (PI * (c2 * (a2 - 1.0) + 1.0).powi(2));
    let root = |a: f64, b: f64| a * (a2 + (1.0 - a2) * b * b).sqrt();
    let visible = 0.5 / (root(i.z, o.z) + root(o.z, i.z));
    d * visible * (f0 + (1.0 - f0) * (1.0 - i.dot(h)).powi(5)) * o.z
}

/// The residual that is told against a sum over other directions, and fewer lobes are no nearer.
#[test]
fn residuals_are_those_of_a_sum() {
    let (roughness, f0) = (0.45, 0.5);
    let alpha: f64 = roughness * roughness;
    let mut last = 1.0;
    for lobes in 1..=3 {
        let curve =
            Curve::new([roughness; 2], mixture(f0, 0.0), lobes, Normalise::Largest, &Cancel::new()).unwrap();
        let texel = curve.texel(roughness, [f0; 3], [0.0; 3]);
        let (mut left, mut size) = (0.0, 0.0);
        let cosines = (0..8).map(|k| (((f64::from(k)) + 0.5) / 8.0).sqrt()).map(|mu| (mu, 1.0));
        for (mu, share) in cosines.chain([(0.05, 0.25)]) {
            let i = DVec3::new((1.0f64 - mu * mu).sqrt(), 0.0, mu);
            let nodes = hemisphere(DVec3::new(-i.x, 0.0, i.z), 300, 120);
            let energy: f64 = nodes.iter().map(|(o, a)| a * ggx(i, *o, alpha, f0)).sum();
            for (o, area) in &nodes {
                let truth = ggx(i, *o, alpha, f0);
                let lobe = |p: &Placed| {
                    let turned = DVec3::from_array(p.lobe.c) * i;
                    p.albedo[1] * p.constant * turned.dot(*o).max(0.0).powf(p.lobe.n)
                };
                let made = (texel.diffuse[1] / PI + texel.lobes.iter().map(lobe).sum::<f64>()) * o.z;
                let scale = truth + energy * o.z / PI;
                left += share * area * (made - truth).powi(2) / scale;
                size += share * area * truth * truth / scale;
            }
        }
        let expected = (left / size).sqrt();
        assert!(
            (texel.residual / expected - 1.0).abs() < 0.05,
            "{lobes}: told {}, is {expected}",
            texel.residual
        );
        assert!(texel.residual <= last + LOBE_FIT, "{lobes} lobes: {} after {last}", texel.residual);
        last = texel.residual;
    }
}

#[test]
fn the_ladder_is_exact_at_its_powers_and_falls() {
    for (k, power) in ladder::powers().into_iter().enumerate() {
        let rung = ladder::level(power);
        assert!((rung.level - k as f64).abs() < LOBE_MINIMUM && rung.distance < LOBE_MINIMUM, "{rung:?}");
    }
    let table = ladder::table();
    assert!(table.windows(2).all(|w| w[0].exponent < w[1].exponent && w[0].level > w[1].level));
    // half way between the powers 100000 and 25000, by a sum over the cosine
    let rung = ladder::level(5e4);
    let w = rung.level.fract();
    let steps = 400_000;
    let mut sum = 0.0;
    for i in 0..steps {
        // cosines from 1 - 4e-4 on hold all of it
        let x = 1.0 - 4e-4 * (f64::from(i) + 0.5) / f64::from(steps);
        let density = |n: f64| (n + 1.0) * x.powf(n);
        sum += 0.5 * (density(5e4) - (1.0 - w) * density(1e5) - w * density(2.5e4)).abs();
    }
    let expected = sum * 4e-4 / f64::from(steps);
    assert!((rung.distance - expected).abs() < LOBE_HORIZON, "{rung:?}: {expected}");
    for n in [1.0, 30.0, 1e5] {
        assert!((exponent(exponent_code(n)) / n - 1.0).abs() < MANY_ROUNDINGS);
    }
}
