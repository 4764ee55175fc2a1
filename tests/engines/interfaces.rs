//! Rough interfaces: the arrays of Cycles and the headers of OSL.

use crate::common::shared;
use crate::compare::agree;
use crate::support::{Texture, bake, npy, numbers, plan};
use brdfbake::verify::reconstruction::Probe;
use glam::DVec3;

/// The arrays of an engine's tables that pass, in order.
fn arrays(id: &str, wanted: impl Fn(&str) -> bool) -> Vec<Vec<f64>> {
    let out = tempfile::tempdir().unwrap();
    let mut files = bake(&plan(id, wanted), out.path());
    files.dedup();
    files.iter().flat_map(|f| numbers(&std::fs::read_to_string(f).unwrap())).collect()
}

/// Largest and mean error of values between the texels of a table, read linearly along every axis.
fn off(id: &str, table: &str, values: &[f64]) -> [[f64; 2]; 2] {
    let plan = plan(id, |t| t == table);
    let probe = Probe::new(&plan.tables[0].bound, plan.tables[0].tolerance, 1 << 16);
    let read = probe.measure(values);
    let practical = read.practical.clone().unwrap_or(read.whole.clone());
    [read.whole, practical].map(|s| [s.largest.value, s.mean])
}

#[test]
fn cycles_glass() {
    let Some(dir) = shared() else { return };
    for (table, file, width, bound) in [
        // the largest difference is of z = 1, the others within the noise of 2^23 samples
        ("cycles-ggx-glass-E", "ggx_glass_E", 16, 7e-4),
        ("cycles-ggx-glass-Eavg", "ggx_glass_Eavg", 16, 1e-4),
    ] {
        let values = npy(&dir.join(format!("oracles/engines/cycles/{file}.npy")));
        let height = values.len() / width;
        let baked = arrays("cycles", |t| t == table).remove(0);
        let shipped = Texture::new(width, height, 1, values);
        agree(table, &shipped, &Texture::new(width, height, 1, baked.clone()), &[[bound, 0.0]]);
        let [s, b] = [&shipped.values, &baked].map(|v| off("cycles", table, v));
        println!("{table}: shipped {s:.2e?}; baked {b:.2e?}");
        assert!(b[0][1] <= s[0][1] + 1e-6, "{table}: the mean is worse");
    }
}

/// Sums over shipped arrays, as programs that copy `shader.tables` check them.
#[test]
fn cycles_arrays_sum_to_what_is_known_of_the_shipped() {
    for (table, sum, noise) in [
        ("cycles-ggx-glass-E", 3758.664856, 1e-4),
        ("cycles-ggx-glass-Eavg", 235.910746, 1e-4),
        ("cycles-ggx-gen-schlick-ior-s", 184.247126, 1e-3),
        ("cycles-ggx-gen-schlick-s", 764.768581, 1e-3),
    ] {
        let values = arrays("cycles", |t| t == table).remove(0);
        let count = values.len() as f64;
        let got: f64 = values.iter().sum();
        println!("{table}: {got}, shipped {sum}: {:.1e} a texel", (got - sum).abs() / count);
        assert!((got - sum).abs() <= noise * count, "{table}: {got}, shipped {sum}");
    }
}

/// Seen from inside, the shipped table counts refracted rays on the wrong side: what is right is not more.
#[test]
fn cycles_glass_from_inside_is_no_brighter() {
    let averages = arrays("cycles", |t| t == "cycles-ggx-glass-inv-Eavg").remove(0);
    let sum: f64 = averages.iter().sum();
    println!("cycles-ggx-glass-inv-Eavg: {sum}, shipped 216.090299");
    assert!(sum <= 216.090299 + 1e-2, "{sum}");
    let outside = arrays("cycles", |t| t == "cycles-ggx-glass-Eavg").remove(0);
    assert!(averages.iter().zip(&outside).all(|(a, b)| *a <= b + 1e-4), "more is lost from inside");
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
    let x = r * phi.cos();
    let s = 0.5 * (1.0 + view.z);
    let y = (1.0 - s) * (1.0 - x * x).sqrt() + s * r * phi.sin();
    let z = (1.0 - x * x - y * y).max(0.0).sqrt();
    let n = x * t1 + y * t2 + z * view;
    DVec3::new(alpha * n.x, alpha * n.y, n.z.max(0.0)).normalize()
}

#[test]
fn osl_headers_hold_what_genluts_samples() {
    let out = tempfile::tempdir().unwrap();
    let files = bake(&plan("osl", |_| true), out.path());
    let inside = |t: f64| 1.0 / (1.001 + 3.999 * t * t);
    for (file, header, name, count) in [
        (&files[0], "microfacet_tools_luts.h", "MiniMicrofacetGGX", 256),
        (&files[1], "bsdf_dielectric_front_luts.h", "DielectricFront", 8192),
        (&files[2], "bsdf_dielectric_back_luts.h", "DielectricBack", 8192),
    ] {
        assert!(file.ends_with(header));
        let text = std::fs::read_to_string(file).unwrap();
        assert!(text.starts_with("#pragma once\n\nBSDL_ENTER_NAMESPACE\n"), "{text:.80}");
        assert!(text.contains(&format!("BSDL_INLINE_METHOD {name}::Energy& {name}::get_energy()\n{{")));
        assert!(text.ends_with("} // namespace spi\n\nBSDL_LEAVE_NAMESPACE\n"));
        let values = numbers(&text).remove(0);
        assert_eq!(values.len(), count, "{header}");
        let mut worst: f64 = 0.0;
        for (c, r, f) in
            [(0, 8, 20), (1, 3, 5), (4, 15, 31), (8, 10, 12), (15, 15, 9), (12, 5, 16), (2, 12, 24)]
        {
            let [c_, r_, t] = [f64::from(c) / 15.0, f64::from(r) / 15.0, f64::from(f) / 31.0];
            let (index, expected) = match name {
                "MiniMicrofacetGGX" => (r * 16 + c, genluts(c_ * c_, r_, None)),
                "DielectricFront" => ((f * 16 + r) * 16 + c, genluts(c_, r_, Some(1.0 / inside(t)))),
                _ => ((f * 16 + r) * 16 + c, genluts(c_, r_, Some(inside(t)))),
            };
            let got = values[usize::try_from(index).unwrap()];
            worst = worst.max((got - expected).abs());
            // the grid of this test, which is finer than that of genluts
            assert!((got - expected).abs() < 2e-3, "{header} ({c}, {r}, {f}): {got}, sampled {expected}");
        }
        println!("{header}: off by at most {worst:.1e} from sampling");
    }
}
