//! Baked against shipped files: read by the engine's own lookup at points between the texels, against fresh integrals.

use crate::common::shared;
use crate::support::{Texture, bake, npy, numbers, picture, plan};
use brdfbake::grid::{Axis, Quantity, Texel};
use brdfbake::tables::spec::{Bound, Request};
use std::path::Path;

/// Where a shader samples at (mu, roughness).
type Coordinates = fn(f64, f64) -> [f64; 2];

/// What is compared.
struct Case<'a> {
    name: &'a str,
    /// Kind and channels that give the truth.
    kind: &'a str,
    channels: &'a [&'a str],
    at: Coordinates,
    /// Least mu and roughness of the points.
    from: f64,
}

fn halves(n: f64) -> impl Fn(f64) -> f64 {
    move |x| (x * (n - 1.0) + 0.5) / n
}

fn ltc(mu: f64, r: f64) -> [f64; 2] {
    let remap = halves(64.0);
    [remap(r), remap((1.0 - mu).sqrt())]
}

/// Cosines or roughnesses: the corner regions, and everything between, on no texel of any table.
fn points(from: f64) -> Vec<f64> {
    let inner = (0..24).map(|i| (f64::from(i) + 0.37) / 24.0);
    [0.003, 0.009].into_iter().chain(inner).chain([0.997]).filter(|&x| x >= from).collect()
}

fn truth(kind: &str, channels: &[&str]) -> Bound {
    let axis = |id: &str| Axis::new(Quantity::find(id).unwrap(), 2, Texel::Endpoint).over([0.0, 1.0]);
    let request = Request {
        kind: kind.to_owned(),
        channels: Some(channels.iter().map(|c| (*c).to_owned()).collect()),
        axes: Some(vec![axis("mu"), axis("alpha")]),
        ..Request::default()
    };
    request.bind().unwrap()
}

/// Largest and mean error of a texture, by channel.
fn errors(case: &Case<'_>, textures: &[&Texture]) -> Vec<Vec<[f64; 2]>> {
    let bound = truth(case.kind, case.channels);
    let n = case.channels.len();
    let mut all = vec![vec![[0.0f64; 2]; n]; textures.len()];
    let (points, mut count) = (points(case.from), 0.0);
    for &mu in &points {
        for &r in &points {
            let exact = bound.baker.texel(&[mu, r * r], 1e-6).unwrap().value;
            count += 1.0;
            for (texture, errors) in textures.iter().zip(&mut all) {
                let read = texture.sample((case.at)(mu, r));
                for c in 0..n {
                    let off = (read[c] - exact[c]).abs();
                    errors[c] = [errors[c][0].max(off), errors[c][1] + off];
                }
            }
        }
    }
    for error in all.iter_mut().flatten() {
        error[1] /= count;
    }
    all
}

/// Prints both and checks that the baked one is not worse, by more than the rounding of the storage.
fn not_worse(case: &Case<'_>, shipped: &Texture, baked: &Texture, bytes: u64, slack: f64) {
    let all = errors(case, &[shipped, baked]);
    for (c, channel) in case.channels.iter().enumerate() {
        let ([sl, sm], [bl, bm]) = (all[0][c], all[1][c]);
        println!(
            "{} {channel}: shipped {sl:.2e} largest, {sm:.2e} mean; baked {bl:.2e}, {bm:.2e}; {bytes} bytes",
            case.name
        );
        assert!(bm <= sm + slack && bl <= sl + slack, "{} {channel}: the baked table is worse", case.name);
    }
}

/// Texels of both, by channel: they differ by what the shipped one is known to be off by.
fn agree(name: &str, shipped: &Texture, baked: &Texture, bounds: &[[f64; 2]]) {
    assert_eq!((shipped.width, shipped.height), (baked.width, baked.height), "{name}");
    for (c, [absolute, relative]) in bounds.iter().enumerate() {
        let (mut largest, mut place) = (0.0, (0, 0));
        for y in 0..shipped.height {
            for x in 0..shipped.width {
                let (s, b) = (shipped.texel(x, y)[c], baked.texel(x, y)[c]);
                let off = (s - b).abs();
                assert!(
                    off <= absolute + relative * s.abs(),
                    "{name} ({x}, {y}), component {c}: shipped {s}, baked {b}"
                );
                if off > largest {
                    (largest, place) = (off, (x, y));
                }
            }
        }
        println!("{name}, component {c}: texels differ by at most {largest:.2e}, at {place:?}");
    }
}

fn size(path: &Path) -> u64 {
    std::fs::metadata(path).unwrap().len()
}

/// Rounding of halves, of both tables.
const HALF: f64 = 2.0 / 2048.0;

#[test]
fn bevy() {
    let out = tempfile::tempdir().unwrap();
    let file = bake(&plan("bevy", |_| true), out.path()).remove(0);
    assert!(file.ends_with("dfg.ktx2"));
    let baked = picture(&file, 2);
    let Some(dir) = shared() else { return };
    let shipped = Texture::new(64, 64, 2, npy(&dir.join("oracles/engines/bevy/dfg_half.npy")));
    agree("bevy", &shipped, &baked, &[[6.4e-3, HALF], [6e-4, HALF]]);
    let case = Case {
        name: "bevy",
        kind: "dfg",
        channels: &["dfg.scale", "dfg.bias"],
        at: |mu, r| [mu, r],
        from: 0.0,
    };
    not_worse(&case, &shipped, &baked, size(&file), 0.0);
}

#[test]
fn three() {
    let out = tempfile::tempdir().unwrap();
    let file = bake(&plan("three", |t| t == "three-dfg"), out.path()).remove(0);
    let text = std::fs::read_to_string(&file).unwrap();
    assert!(file.ends_with("DFGLUTData.js") && text.contains("export function getDFGLUT()"));
    let baked = Texture::new(16, 16, 2, numbers(&text).remove(0));
    let Some(dir) = shared() else { return };
    let shipped = Texture::new(16, 16, 2, npy(&dir.join("oracles/engines/three/dfg_rg16f.npy")));
    agree("three", &shipped, &baked, &[[1.43e-2, HALF], [7e-4, HALF]]);
    let case = Case {
        name: "three",
        kind: "dfg",
        channels: &["dfg.scale", "dfg.bias"],
        at: |mu, r| [r, mu],
        from: 0.0,
    };
    not_worse(&case, &shipped, &baked, size(&file), 0.0);
}

#[test]
fn filament() {
    let Some(dir) = shared() else { return };
    let shipped = Texture::new(64, 64, 3, npy(&dir.join("oracles/engines/filament/dfg_rgb16f.npy")));
    for id in ["filament", "filament-centre"] {
        let out = tempfile::tempdir().unwrap();
        let file = bake(&plan(id, |_| true), out.path()).remove(0);
        let lists = numbers(&std::fs::read_to_string(&file).unwrap());
        let baked = Texture::new(64, 64, 3, lists.concat());
        if id == "filament" {
            agree(id, &shipped, &baked, &[[4.2e-3, HALF], [1.27e-2, HALF], [4.1e-2, HALF]]);
        }
        let case = Case {
            name: id,
            kind: "dfg",
            channels: &["dfg.fc", "dfg.total", "dfg.cloth"],
            at: |mu, r| [mu, r],
            from: 0.0,
        };
        not_worse(&case, &shipped, &baked, size(&file), 0.0);
    }
}

#[test]
fn babylon() {
    let Some(dir) = shared() else { return };
    let decoded = dir.join("oracles/engines/babylon/environmentBRDF_decoded_linear.npy");
    let shipped = Texture::new(256, 256, 3, npy(&decoded));
    let out = tempfile::tempdir().unwrap();
    let file = bake(&plan("babylon", |t| t == "babylon-environment-brdf"), out.path()).remove(0);
    let baked = picture(&file, 3);
    agree("babylon", &shipped, &baked, &[[2.5e-2, 0.0], [2.5e-2, 0.0], [2.5e-2, 5e-2]]);
    let case = Case {
        name: "babylon",
        kind: "dfg",
        channels: &["dfg.fc", "dfg.total", "dfg.cloth"],
        at: |mu, r| [mu, r],
        from: 0.0,
    };
    not_worse(&case, &shipped, &baked, size(&file), 0.0);
}

#[test]
fn cycles() {
    let Some(dir) = shared() else { return };
    let shipped = Texture::new(32, 32, 1, npy(&dir.join("oracles/engines/cycles/ggx_E.npy")));
    let out = tempfile::tempdir().unwrap();
    let file = bake(&plan("cycles", |_| true), out.path()).remove(0);
    let mut lists = numbers(&std::fs::read_to_string(&file).unwrap());
    let baked = Texture::new(32, 32, 1, lists.remove(0));
    agree("cycles", &shipped, &baked, &[[2e-6, 0.0]]);
    let average = Texture::new(32, 1, 1, npy(&dir.join("oracles/engines/cycles/ggx_Eavg.npy")));
    agree("cycles average", &average, &Texture::new(32, 1, 1, lists.remove(0)), &[[2e-6, 0.0]]);
    let case = Case {
        name: "cycles",
        kind: "albedo",
        channels: &["e"],
        at: |mu, r| [halves(32.0)(r), halves(32.0)(mu)],
        from: 0.0,
    };
    // six decimals, which may round to the better side
    not_worse(&case, &shipped, &baked, size(&file), 5e-7);
}

#[test]
fn area_lights() {
    let Some(dir) = shared() else { return };
    let from = |name: &str| npy(&dir.join("oracles/engines/selfshadow_ltc").join(name));
    let shipped = Texture::new(64, 64, 4, from("ltc_js_g_ltc_2.npy"));
    let out = tempfile::tempdir().unwrap();
    let file = bake(&plan("selfshadow-ltc", |t| t == "ltc-2"), out.path()).remove(0);
    let lists = numbers(&std::fs::read_to_string(&file).unwrap());
    let baked = Texture::new(64, 64, 4, lists.concat());
    agree("ltc magnitude", &shipped, &baked, &[[6.6e-2, 0.0], [2.9e-2, 0.0], [0.0, 0.0], [3e-6, 0.0]]);
    let case = Case {
        name: "ltc magnitude",
        kind: "ltc-magnitude",
        channels: &["ltc.magnitude", "ltc.fresnel"],
        at: ltc,
        from: 0.0,
    };
    not_worse(&case, &shipped, &baked, size(&file), 0.0);
}
