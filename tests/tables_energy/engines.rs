//! Whole tables of engines, from the folder that `BRDFBAKE_SHARED` names; the largest differences are printed.

use crate::common::shared;
use crate::tables_energy::support::table;
use half::f16;
use std::path::Path;

/// Values of a little-endian `.npy` of f2, f4, f8 or u1.
fn npy(path: &Path) -> Vec<f64> {
    let bytes = std::fs::read(path).unwrap();
    let header = usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let text = std::str::from_utf8(&bytes[10..10 + header]).unwrap();
    let data = &bytes[10 + header..];
    let size = |n: usize| data.chunks_exact(n);
    match text {
        t if t.contains("<f2") => size(2).map(|c| f16::from_le_bytes([c[0], c[1]]).to_f64()).collect(),
        t if t.contains("<f4") => {
            size(4).map(|c| f64::from(f32::from_le_bytes(c.try_into().unwrap()))).collect()
        }
        t if t.contains("<f8") => size(8).map(|c| f64::from_le_bytes(c.try_into().unwrap())).collect(),
        t if t.contains("|u1") => data.iter().map(|b| f64::from(*b)).collect(),
        t => panic!("{t}"),
    }
}

/// What is compared: a table, and its points with the values of each channel.
struct Case<'a> {
    name: &'a str,
    kind: &'a str,
    model: &'a str,
    params: &'a str,
    channels: &'a [&'a str],
    axes: &'a [&'a str],
    tolerance: f64,
    /// Largest difference allowed, absolute and relative to the value, by channel.
    bounds: &'a [[f64; 2]],
}

fn compare(case: &Case<'_>, texels: impl Iterator<Item = (Vec<f64>, Vec<f64>)>) {
    let bound = table(case.kind, case.model, case.params, case.channels, case.axes);
    let n = case.channels.len();
    let (mut largest, mut place, mut count, mut square) =
        (vec![0.0f64; n], vec![Vec::new(); n], 0u32, vec![0.0; n]);
    let mut excess = 0.0f64;
    for (at, expected) in texels {
        let e =
            bound.baker.texel(&at, case.tolerance).unwrap_or_else(|e| panic!("{} {at:?}: {e}", case.name));
        for c in 0..n {
            let off = (e.value[c] - expected[c]).abs();
            square[c] += off * off;
            if off > largest[c] {
                (largest[c], place[c]) = (off, at.clone());
            }
            let [absolute, relative] = case.bounds[c];
            excess = excess.max(off - absolute - relative * expected[c].abs() - e.error[c]);
        }
        count += 1;
    }
    for c in 0..n {
        println!(
            "{} {}: {count} texels, largest difference {:.2e}, rms {:.1e}, at {:?}",
            case.name,
            case.channels[c],
            largest[c],
            (square[c] / f64::from(count)).sqrt(),
            place[c]
        );
    }
    assert!(excess <= 0.0, "{}: {excess:e} beyond the bound", case.name);
}

fn corner(i: usize, n: usize) -> f64 {
    (i as f64 / (n - 1) as f64).clamp(1e-4, 1.0)
}

fn center(i: usize, n: usize) -> f64 {
    (i as f64 + 0.5) / n as f64
}

const HALF: f64 = 1.01 / 2048.0;

#[test]
fn filament_and_babylon() {
    let Some(dir) = shared().map(|s| s.join("oracles/engines")) else { return };
    let channels = ["dfg.fc", "dfg.total", "dfg.cloth"];
    let case = |name, tolerance, bounds| Case {
        name,
        kind: "dfg",
        model: "ggx",
        params: "{}",
        channels: &channels,
        axes: &["mu", "alpha"],
        tolerance,
        bounds,
    };
    let points = |n: usize, values: Vec<f64>| {
        (0..n * n).map(move |i| {
            let r = (((i / n) as f64 + 1.5) / n as f64).min(1.0);
            (vec![center(i % n, n), r * r], values[3 * i..3 * i + 3].to_vec())
        })
    };
    let exact = npy(&dir.join("filament/dfg_exact_same_layout.npy"));
    compare(&case("Filament, exact", 1e-9, &[[4e-7, 0.0], [2.3e-6, 0.0], [1e-8, 1e-8]]), points(64, exact));
    let shipped = npy(&dir.join("filament/dfg_rgb16f.npy"));
    let bounds = [[4.2e-3, HALF], [1.27e-2, HALF], [4.1e-2, HALF]];
    compare(&case("Filament 1.53.4", 2.4e-4, &bounds), points(64, shipped));
    let babylon = npy(&dir.join("babylon/environmentBRDF_decoded_linear.npy"));
    let some = points(256, babylon).enumerate().filter(|(i, _)| i % 7 == 0).map(|(_, p)| p);
    compare(&case("Babylon.js 9.34", 2.4e-4, &[[1.9e-2, 0.0], [1.9e-2, 0.0], [1.9e-2, 3e-2]]), some);
}

#[test]
fn bevy_and_three() {
    let Some(dir) = shared().map(|s| s.join("oracles/engines")) else { return };
    for (name, n, transposed, shipped) in
        [("bevy", 64, false, [6.4e-3, 6e-4]), ("three", 16, true, [1.43e-2, 7e-4])]
    {
        let file = if transposed { "dfg_rg16f.npy" } else { "dfg_half.npy" };
        for (file, bounds, tolerance) in [
            ("dfg_exact_same_layout.npy", [[2.3e-6, 0.0], [4e-7, 0.0]], 1e-9),
            (file, [[shipped[0], HALF], [shipped[1], HALF]], 1e-5),
        ] {
            let values = npy(&dir.join(name).join(file));
            let points = (0..n * n).map(|i| {
                let (x, y) = (center(i % n, n), center(i / n, n));
                let (mu, r) = if transposed { (y, x) } else { (x, y) };
                (vec![mu, r * r], values[2 * i..2 * i + 2].to_vec())
            });
            let case = Case {
                name: &format!("{name} {file}"),
                kind: "dfg",
                model: "ggx",
                params: "{}",
                channels: &["dfg.scale", "dfg.bias"],
                axes: &["mu", "alpha"],
                tolerance,
                bounds: &bounds,
            };
            compare(&case, points);
        }
    }
}

#[test]
fn cycles() {
    let Some(dir) = shared().map(|s| s.join("oracles/engines/cycles")) else { return };
    let square = |x: f64| x * x;
    let ggx = |name, kind, channels, axes, tolerance, bounds| Case {
        name,
        kind,
        model: "ggx",
        params: "{}",
        channels,
        axes,
        tolerance,
        bounds,
    };
    let e = npy(&dir.join("ggx_E.npy"));
    let points = (0..1024).map(|i| (vec![corner(i / 32, 32), square(corner(i % 32, 32))], vec![e[i]]));
    compare(&ggx("Cycles ggx_E", "albedo", &["e"], &["mu", "alpha"], 1e-7, &[[1e-6, 0.0]]), points);
    let avg = npy(&dir.join("ggx_Eavg.npy"));
    let points = (0..32).map(|i| (vec![square(corner(i, 32))], vec![avg[i]]));
    compare(&ggx("Cycles ggx_Eavg", "average-albedo", &["e-avg"], &["alpha"], 1e-7, &[[1e-6, 0.0]]), points);
    let glass = |name, kind, channels, axes, bounds| Case {
        params: r#"{"masking": "sum"}"#,
        model: "ggx-glass",
        ..ggx(name, kind, channels, axes, 5e-5, bounds)
    };
    let eta = |i: usize| {
        let z = square(corner(i, 16).min(0.99));
        (1.0 + z) / (1.0 - z)
    };
    // z = 0 is no interface (1 there), roughness 0 a mirror: alpha = 1e-8 is below what the rule resolves
    let alpha = |i: usize| if i == 0 { 0.0 } else { square(corner(i, 16)) };
    let e = npy(&dir.join("ggx_glass_E.npy"));
    let points =
        (256..4096).map(|i| (vec![corner(i / 16 % 16, 16), alpha(i % 16), eta(i / 256)], vec![e[i]]));
    compare(&glass("Cycles ggx_glass_E", "albedo", &["e"], &["mu", "alpha", "eta"], &[[2e-4, 0.0]]), points);
    let avg = npy(&dir.join("ggx_glass_Eavg.npy"));
    let points = (16..256).map(|i| (vec![alpha(i % 16), eta(i / 16)], vec![avg[i]]));
    compare(
        &glass("Cycles ggx_glass_Eavg", "average-albedo", &["e-avg"], &["alpha", "eta"], &[[2e-5, 0.0]]),
        points,
    );
}

#[test]
fn sheen_and_diffuse() {
    let Some(dir) = shared().map(|s| s.join("oracles/engines")) else { return };
    let (mu, r, e) = (
        npy(&dir.join("eon_fon_albedo_quadrature__mu.npy")),
        npy(&dir.join("eon_fon_albedo_quadrature__r.npy")),
        npy(&dir.join("eon_fon_albedo_quadrature__E_FON.npy")),
    );
    let points = (0..mu.len() * r.len()).map(|i| (vec![mu[i / r.len()], r[i % r.len()]], vec![e[i]]));
    let case = Case {
        name: "EON, E of FON by quadrature",
        kind: "albedo",
        model: "fujii",
        params: r#"{"rho": 1}"#,
        channels: &["e"],
        axes: &["mu", "r"],
        tolerance: 1e-8,
        bounds: &[[3.5e-6, 0.0]],
    };
    compare(&case, points);
    // the fitted curves of MaterialX are the model here; the table that they fit is off by up to 0.17 at small mu and alpha
    let volume = npy(&dir.join("ltc_sheen/ltc_table_sheen_volume.npy"));
    let points = (0..1024)
        .map(|i| (vec![(i / 32) as f64 / 31.0, ((i % 32) as f64 / 31.0).max(0.01)], vec![volume[3 * i + 2]]));
    let points = points.map(|(at, v)| (vec![at[0].max(0.01), at[1]], v));
    let sheen = |name, model, axes, bounds| Case {
        name,
        kind: "albedo",
        model,
        params: "{}",
        channels: &["e"],
        axes,
        tolerance: 1e-5,
        bounds,
    };
    compare(&sheen("LTC sheen R, volume", "ltc-sheen", &["mu", "r"], &[[0.18, 0.0]]), points);
}
