//! Rough interfaces: the arrays of Cycles and the headers of OSL.

use crate::common::shared;
use crate::engines::support::{bake, npy, numbers, plan};
use crate::tolerance::{CYCLES_FLOAT_TABLE, CYCLES_SUM, DRAWN, DRAWN_FEW, near};
use brdfbake::verify::reconstruction::Probe;
use glam::DVec3;
use rayon::prelude::*;

/// Values of some texels of a table, integrated to its tolerance: a whole bake of three axes is dear.
fn texels(id: &str, table: &str, chosen: impl Iterator<Item = usize>) -> Vec<(usize, f64)> {
    let plan = plan(id, |t| t == table);
    let planned = &plan.tables[0];
    let grid = &planned.bound.spec.grid;
    let value = |i: usize| {
        let texel = planned.bound.baker.texel(grid.texel(i).values(), planned.tolerance);
        let e = texel.unwrap_or_else(|e| panic!("{table} {i}: {e:?}"));
        assert!(e.error[0] <= planned.tolerance, "{table} {i}: misses its tolerance, {:e}", e.error[0]);
        (i, e.value[0])
    };
    chosen.filter(|i| *i < grid.len()).collect::<Vec<_>>().into_par_iter().map(value).collect()
}

/// Largest difference to an array that is shipped.
fn differ(table: &str, shipped: &[f64], step: usize) -> f64 {
    let mut largest: f64 = 0.0;
    for (i, value) in texels("cycles", table, (0..shipped.len()).step_by(step)) {
        largest = largest.max((value - shipped[i]).abs());
    }
    println!("{table}: every texel in {step} differs by at most {largest:.1e}");
    largest
}

#[test]
fn cycles_glass() {
    let Some(dir) = shared() else { return };
    let shipped = |name: &str| npy(&dir.join(format!("oracles/engines/cycles/{name}.npy")));
    assert!(differ("cycles-ggx-glass-E", &shipped("ggx_glass_E"), 13) < CYCLES_FLOAT_TABLE);
    assert!(differ("cycles-ggx-glass-Eavg", &shipped("ggx_glass_Eavg"), 31) < CYCLES_FLOAT_TABLE);
}

#[test]
#[ignore = "long: bakes two tables of glass whole, and compares them between their texels"]
fn cycles_glass_whole() {
    let Some(dir) = shared() else { return };
    let shipped = npy(&dir.join("oracles/engines/cycles/ggx_glass_E.npy"));
    assert!(differ("cycles-ggx-glass-E", &shipped, 1) < CYCLES_FLOAT_TABLE);
    let averages = npy(&dir.join("oracles/engines/cycles/ggx_glass_Eavg.npy"));
    assert!(differ("cycles-ggx-glass-Eavg", &averages, 1) < CYCLES_FLOAT_TABLE);
    let plan = plan("cycles", |t| t == "cycles-ggx-glass-E");
    let probe = Probe::new(&plan.tables[0].bound, 1e-5, 1 << 16);
    let baked: Vec<f64> =
        texels("cycles", "cycles-ggx-glass-E", 0..shipped.len()).into_iter().map(|(_, v)| v).collect();
    let [s, b] = [&shipped, &baked].map(|values| probe.measure(values));
    println!("cycles-ggx-glass-E: shipped {:?} {:?}", s.whole, s.practical);
    println!("cycles-ggx-glass-E: baked {:?} {:?}", b.whole, b.practical);
    assert!(b.whole.mean <= s.whole.mean + 1e-6, "the mean is worse");
}

/// Sums over shipped arrays, as programs that copy `shader.tables` check them.
#[test]
fn cycles_schlick_arrays_sum_to_what_is_known_of_the_shipped() {
    for (table, sum) in
        [("cycles-ggx-gen-schlick-ior-s", 184.247126), ("cycles-ggx-gen-schlick-s", 764.768581)]
    {
        let values = texels("cycles", table, 0..4096);
        let got: f64 = values.iter().map(|(_, v)| v).sum();
        println!("{table}: {got}, shipped {sum}: {:.1e} a texel", (got - sum).abs() / 4096.0);
        near!(got, sum, CYCLES_SUM * 4096.0, "{table}: {got}, shipped {sum}");
    }
}

/// Seen from inside, the shipped table counts refracted rays that end on the wrong side; sampling that drops them agrees.
#[test]
fn cycles_glass_from_inside() {
    let chosen = [(1, 0, 3), (8, 15, 5), (15, 0, 3), (12, 6, 9), (5, 10, 12), (15, 9, 4)];
    let index = |(r, m, z): (usize, usize, usize)| (z * 16 + m) * 16 + r;
    let got = texels("cycles", "cycles-ggx-glass-inv-E", chosen.into_iter().map(index));
    for ((r, m, z), (_, value)) in chosen.into_iter().zip(got) {
        let [r, m, z] = [r, m, z].map(|i| i as f64 / 15.0);
        let expected = 1.0 - genluts(m.max(1e-4), r, Some((1.0 - z * z) / (1.0 + z * z)));
        near!(value, expected, DRAWN_FEW, "({r}, {m}, {z}): {value}, sampled {expected}");
    }
}

/// 1 - E as genluts has it: visible normals on a grid of points, G2 / G1 of those that leave on the right side.
fn genluts(mu: f64, roughness: f64, eta: Option<f64>) -> f64 {
    let alpha = (roughness * roughness).max(1e-5);
    let mu = mu.max(1e-6);
    let wo = DVec3::new((1.0 - mu * mu).sqrt(), 0.0, mu);
    let length = |w: DVec3| (alpha * alpha * (w.x * w.x + w.y * w.y) + w.z * w.z).sqrt();
    let ratio = |z: f64, w: DVec3| z * (wo.z + length(wo)) / (wo.z * length(w) + z * length(wo));
    let n = 400;
    let mut sum = 0.0;
    for i in 0..n * n {
        let mid = |i: i32| (f64::from(i) + 0.5) / f64::from(n);
        let m = normal(wo, alpha, mid(i % n), mid(i / n));
        let c = wo.dot(m);
        if c <= 0.0 {
            continue;
        }
        let wi = 2.0 * c * m - wo;
        let reflected = if wi.z > 0.0 { ratio(wi.z, wi) } else { 0.0 };
        let Some(eta) = eta else {
            sum += reflected;
            continue;
        };
        let sin2 = (1.0 - c * c) / (eta * eta);
        let cos = (1.0 - sin2).max(0.0).sqrt();
        let f = if sin2 >= 1.0 {
            1.0
        } else {
            let [s, p] = [(c - eta * cos) / (c + eta * cos), (cos - eta * c) / (cos + eta * c)];
            0.5 * (s * s + p * p)
        };
        let wt = (c / eta - cos) * m - wo / eta;
        let transmitted = if wt.z < 0.0 && f < 1.0 { ratio(-wt.z, wt) } else { 0.0 };
        sum += f * reflected + (1.0 - f) * transmitted;
    }
    1.0 - sum / f64::from(n * n)
}

/// A visible normal (Heitz's routine of 2018).
fn normal(wo: DVec3, alpha: f64, u: f64, v: f64) -> DVec3 {
    let view = DVec3::new(alpha * wo.x, alpha * wo.y, wo.z).normalize();
    let t1 = if view.z < 0.9999 { DVec3::Z.cross(view).normalize() } else { DVec3::X };
    let t2 = view.cross(t1);
    let (r, phi) = (u.sqrt(), std::f64::consts::TAU * v);
    let x = r * libm::cos(phi);
    let s = 0.5 * (1.0 + view.z);
    let y = (1.0 - s) * (1.0 - x * x).sqrt() + s * r * libm::sin(phi);
    let z = (1.0 - x * x - y * y).max(0.0).sqrt();
    let n = x * t1 + y * t2 + z * view;
    DVec3::new(alpha * n.x, alpha * n.y, n.z.max(0.0)).normalize()
}

#[test]
fn osl_headers_hold_what_genluts_samples() {
    let out = tempfile::tempdir().unwrap();
    let file = bake(&plan("osl", |t| t == "osl-mini-microfacet-ggx"), out.path()).remove(0);
    let text = std::fs::read_to_string(file).unwrap();
    assert!(text.starts_with("#pragma once\n\nBSDL_ENTER_NAMESPACE\n"), "{text:.80}");
    assert!(text.ends_with("} // namespace spi\n\nBSDL_LEAVE_NAMESPACE\n"));
    let values = numbers(&text).remove(0);
    assert_eq!(values.len(), 256);
    for (c, r) in [(0, 8), (1, 3), (4, 15), (8, 10), (15, 15), (12, 5), (2, 12)] {
        let [mu, roughness] = [c, r].map(|i| f64::from(i) / 15.0);
        let expected = genluts(mu * mu, roughness, None);
        let got = values[usize::try_from(r * 16 + c).unwrap()];
        near!(got, expected, DRAWN, "({c}, {r}): {got}, sampled {expected}");
    }
}

#[test]
fn osl_interfaces_hold_what_genluts_samples() {
    let plan = plan("osl", |_| true);
    for (planned, name) in plan.tables.iter().zip(["MiniMicrofacetGGX", "DielectricFront"]) {
        let before = planned.asked.before.as_deref().unwrap();
        assert!(before.contains(&format!("{name}::Energy& {name}::get_energy()\n{{")), "{before}");
    }
    let chosen = [(0, 8, 20), (1, 3, 5), (4, 15, 31), (8, 10, 12), (15, 15, 9), (12, 5, 16)];
    let table = "osl-dielectric-front";
    let index = |(c, r, f): (usize, usize, usize)| (f * 16 + r) * 16 + c;
    let got = texels("osl", table, chosen.into_iter().map(index));
    for ((c, r, f), (_, value)) in chosen.into_iter().zip(got) {
        let [mu, roughness, t] = [c as f64 / 15.0, r as f64 / 15.0, f as f64 / 31.0];
        let expected = genluts(mu, roughness, Some(1.001 + 3.999 * t * t));
        near!(value, expected, DRAWN_FEW, "{table} ({c}, {r}, {f}): {value}, sampled {expected}");
    }
}
