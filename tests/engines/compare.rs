//! Baked against shipped files: read by the engine's own lookup at points between the texels, against fresh integrals.

use crate::common::shared;
use crate::engines::support::{Texture, bake, exact, npy, numbers, picture, plan};
use crate::tolerance::{CYCLES_PRINTED, DRAWN, near};
use brdfbake::grid::{Axis, Quantity, Texel};
use brdfbake::plan::Plan;
use brdfbake::recipe::engine;
use brdfbake::tables::spec::{Bound, Request};
use brdfbake::verify::reconstruction::Probe;
use rayon::prelude::*;
use std::path::Path;

/// Where a shader samples at (mu, roughness).
pub(crate) type Coordinates = fn(f64, f64) -> [f64; 2];

/// What is compared.
pub(crate) struct Case<'a> {
    pub(crate) name: &'a str,
    /// Kind and channels that give the truth.
    pub(crate) kind: &'a str,
    pub(crate) channels: &'a [&'a str],
    pub(crate) at: Coordinates,
    /// How many times that of the shipped table an error of the baked one may be. Where no table of this size can follow the
    /// integral from one texel to the next, or rows are out of place, noise may fall on the better side. It has no part in
    /// the mean over the whole domain.
    pub(crate) luck: f64,
}

pub(crate) fn halves(n: f64) -> impl Fn(f64) -> f64 {
    move |x| (x * (n - 1.0) + 0.5) / n
}

pub(crate) fn ltc(mu: f64, r: f64) -> [f64; 2] {
    let remap = halves(64.0);
    [remap(r), remap((1.0 - mu).sqrt())]
}

/// Cosines or roughnesses: evenly over the texture, on no texel of any table, six to a cell of 64: fewer would pass by the ridges
/// between the texels.
fn points() -> Vec<f64> {
    (0..401).map(|i| (f64::from(i) + 0.5) / 401.0).collect()
}

pub(crate) fn truth(kind: &str, channels: &[&str]) -> Bound {
    let axis = |id: &str| Axis::new(Quantity::find(id).unwrap(), 2, Texel::Endpoint).over([0.0, 1.0]);
    let request = Request {
        kind: kind.to_owned(),
        channels: Some(channels.iter().map(|c| (*c).to_owned()).collect()),
        axes: Some(vec![axis("mu"), axis("alpha")]),
        ..Request::default()
    };
    request.bind().unwrap()
}

/// Largest and mean error: over the whole domain, and where mu >= 0.05 and roughness >= 0.09.
#[derive(Debug, Clone, Copy, Default)]
struct Errors {
    whole: [f64; 2],
    practical: [f64; 2],
}

/// The errors of each texture, by channel.
fn errors(case: &Case<'_>, textures: &[&Texture]) -> Vec<Vec<Errors>> {
    let bound = truth(case.kind, case.channels);
    let n = case.channels.len();
    let mut all = vec![vec![Errors::default(); n]; textures.len()];
    let (mut count, mut practical) = (0.0, 0.0);
    let places: Vec<(f64, f64)> =
        points().iter().flat_map(|mu| points().into_iter().map(|r| (*mu, r))).collect();
    let group = |part: &[(f64, f64)]| {
        let at: Vec<[f64; 2]> = part.iter().map(|(mu, r)| [*mu, r * r]).collect();
        let at: Vec<&[f64]> = at.iter().map(<[f64; 2]>::as_slice).collect();
        bound.baker.texels(&at, 1e-6).into_iter().map(|e| e.unwrap().value).collect::<Vec<_>>()
    };
    let integrals: Vec<_> = places.par_chunks(bound.baker.group()).flat_map_iter(group).collect();
    for ((mu, r), exact) in places.into_iter().zip(integrals) {
        let inside = mu >= 0.05 && r >= 0.09;
        count += 1.0;
        practical += f64::from(u8::from(inside));
        for (texture, errors) in textures.iter().zip(&mut all) {
            let read = texture.sample((case.at)(mu, r));
            for (c, e) in errors.iter_mut().enumerate() {
                let off = (read[c] - exact[c]).abs();
                e.whole = [e.whole[0].max(off), e.whole[1] + off];
                if inside {
                    e.practical = [e.practical[0].max(off), e.practical[1] + off];
                }
            }
        }
    }
    for e in all.iter_mut().flatten() {
        e.whole[1] /= count;
        e.practical[1] /= practical;
    }
    all
}

/// Prints both and checks that the baked one is not worse: `slack` is the rounding of the storage, which may fall either
/// way.
pub(crate) fn not_worse(case: &Case<'_>, shipped: &Texture, baked: &Texture, bytes: u64, slack: f64) {
    let all = errors(case, &[shipped, baked]);
    for (c, channel) in case.channels.iter().enumerate() {
        let (s, b) = (all[0][c], all[1][c]);
        let show = |e: Errors| {
            let [[wl, wm], [pl, pm]] = [e.whole, e.practical];
            format!("{wl:.2e} {wm:.2e}, practical {pl:.2e} {pm:.2e}")
        };
        println!("{} {channel}: shipped {}; baked {}; {bytes} bytes", case.name, show(s), show(b));
        let context = format!("{} {channel}: the baked table is worse", case.name);
        assert!(b.whole[1] <= s.whole[1] + slack, "{context}: mean");
        assert!(b.whole[0] <= s.whole[0] * case.luck + slack, "{context}: largest");
        assert!(b.practical[1] <= s.practical[1] * case.luck + slack, "{context}: practical mean");
        assert!(b.practical[0] <= s.practical[0] * case.luck + slack, "{context}: practical largest");
    }
}

/// Texels of both, by channel: they differ by what the shipped one is known to be off by.
pub(crate) fn agree(name: &str, shipped: &Texture, baked: &Texture, bounds: &[[f64; 2]]) {
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

/// A texture read by `read` from the file that a plan with samples in its texels writes.
pub(crate) fn samples(plan: Plan, read: impl Fn(&Path) -> Texture) -> Texture {
    let out = tempfile::tempdir().unwrap();
    read(&bake(&exact(plan), out.path()).remove(0))
}

pub(crate) fn size(path: &Path) -> u64 {
    std::fs::metadata(path).unwrap().len()
}

/// How much worse a table may be whose rows are kept out of place on purpose, as those of the shipped one are: the error is that of
/// the place, and the noise of the shipped one may fall on the better side.
const OUT_OF_PLACE: f64 = 1.04;

/// Rounding of halves, of both tables.
pub(crate) const HALF: f64 = 2.0 / 2048.0;

#[test]
fn bevy() {
    let out = tempfile::tempdir().unwrap();
    let file = bake(&plan("bevy", |t| t == "bevy-dfg"), out.path()).remove(0);
    assert!(file.ends_with("dfg.ktx2"));
    let baked = picture(&file, 2);
    let Some(dir) = shared() else { return };
    let shipped = Texture::new(64, 64, 2, npy(&dir.join("oracles/engines/bevy/dfg_half.npy")));
    agree(
        "bevy",
        &shipped,
        &samples(plan("bevy", |_| true), |f| picture(f, 2)),
        &[[6.4e-3, HALF], [6e-4, HALF]],
    );
    let case = Case {
        name: "bevy",
        kind: "dfg",
        channels: &["dfg.scale", "dfg.bias"],
        at: |mu, r| [mu, r],
        luck: 1.0,
    };
    not_worse(&case, &shipped, &baked, size(&file), 0.0);
}

#[test]
fn three() {
    let out = tempfile::tempdir().unwrap();
    let file = bake(&plan("three", |t| t == "three-dfg"), out.path()).remove(0);
    let text = |file: &Path| std::fs::read_to_string(file).unwrap();
    assert!(file.ends_with("DFGLUTData.js") && text(&file).contains("export function getDFGLUT()"));
    let read = |file: &Path| Texture::new(16, 16, 2, numbers(&text(file)).remove(0));
    let baked = read(&file);
    let Some(dir) = shared() else { return };
    let shipped = Texture::new(16, 16, 2, npy(&dir.join("oracles/engines/three/dfg_rg16f.npy")));
    agree(
        "three",
        &shipped,
        &samples(plan("three", |t| t == "three-dfg"), read),
        &[[1.43e-2, HALF], [7e-4, HALF]],
    );
    let case = Case {
        name: "three",
        kind: "dfg",
        channels: &["dfg.scale", "dfg.bias"],
        at: |mu, r| [r, mu],
        luck: 1.0,
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
            luck: if id == "filament" { OUT_OF_PLACE } else { 1.0 },
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
    agree("babylon", &shipped, &baked, &[[4e-2, 0.0], [4e-2, 0.0], [2.5e-2, 5e-2]]);
    let case = Case {
        name: "babylon",
        kind: "dfg",
        channels: &["dfg.fc", "dfg.total", "dfg.cloth"],
        at: |mu, r| [mu, r],
        luck: OUT_OF_PLACE,
    };
    not_worse(&case, &shipped, &baked, size(&file), 0.0);
}

#[test]
fn cycles() {
    let Some(dir) = shared() else { return };
    let shipped = Texture::new(32, 32, 1, npy(&dir.join("oracles/engines/cycles/ggx_E.npy")));
    let out = tempfile::tempdir().unwrap();
    let file =
        bake(&plan("cycles", |t| ["cycles-ggx-E", "cycles-ggx-Eavg"].contains(&t)), out.path()).remove(0);
    let list = |file: &Path, i: usize| numbers(&std::fs::read_to_string(file).unwrap()).swap_remove(i);
    let baked = Texture::new(32, 32, 1, list(&file, 0));
    let both = || plan("cycles", |t| ["cycles-ggx-E", "cycles-ggx-Eavg"].contains(&t));
    let albedo = samples(both(), |f| Texture::new(32, 32, 1, list(f, 0)));
    agree("cycles", &shipped, &albedo, &[[2e-6, 0.0]]);
    let average = Texture::new(32, 1, 1, npy(&dir.join("oracles/engines/cycles/ggx_Eavg.npy")));
    let own = samples(both(), |f| Texture::new(32, 1, 1, list(f, 1)));
    agree("cycles average", &average, &own, &[[2e-6, 0.0]]);
    let case = Case {
        name: "cycles",
        kind: "albedo",
        channels: &["e"],
        at: |mu, r| [halves(32.0)(r), halves(32.0)(mu)],
        luck: 1.0,
    };
    // six decimals, which may round to the better side
    not_worse(&case, &shipped, &baked, size(&file), 5e-7);
}

/// The sheen at the texels of the shipped tables: the walks behind them end after 16 events, which is felt where fibres are thin
/// and the view grazes, and are few where little is reflected.
#[test]
fn sheen() {
    let Some(dir) = shared().map(|d| d.join("oracles/engines")) else { return };
    let shipped = Texture::new(32, 32, 3, npy(&dir.join("ltc_sheen/ltc_table_sheen_volume.npy")));
    let out = tempfile::tempdir().unwrap();
    let file = bake(&plan("ltc-sheen", |_| true), out.path()).remove(0);
    assert!(file.ends_with("ltc_table_sheen_volume.npy"));
    let baked = Texture::new(32, 32, 3, npy(&file));
    for (first, bounds) in [(0, [0.25, 0.024, 0.24]), (6, [0.032, 0.024, 0.004]), (12, [5e-3, 2e-3, 1.3e-3])]
    {
        let (mut largest, mut sum, mut count) = ([0.0f64; 3], [0.0; 3], 0.0);
        for y in 0..32 {
            // the authors leave a and b out where R < 3e-6
            for x in (first..32).filter(|x| shipped.texel(*x, y)[2] >= 3e-6) {
                for (c, (s, b)) in shipped.texel(x, y).iter().zip(baked.texel(x, y)).enumerate() {
                    largest[c] = largest[c].max((s - b).abs());
                    sum[c] += (s - b).abs();
                }
                count += 1.0;
            }
        }
        println!("sheen from r = {first} / 31: largest {largest:.4?}, mean {:.5?}", sum.map(|s| s / count));
        for (c, (off, bound)) in largest.iter().zip(bounds).enumerate() {
            assert!(*off <= bound, "component {c} from r = {first} / 31: {off}");
        }
    }
    let cycles = npy(&dir.join("cycles/sheen_ltc.npy"));
    let babylon = npy(&dir.join("babylon/environmentFuzzBRDFBase64Texture_png8.npy"));
    for (x, y, c) in [(20, 1, 0), (20, 1, 1), (12, 30, 2), (31, 0, 0)] {
        let value = shipped.texel(x, y)[c];
        near!(cycles[(c * 32 + x) * 32 + y], value, CYCLES_PRINTED, "Cycles holds A, B, R, the view fastest");
        let unit = [(value - 0.005) / 0.875, (value + 0.18) / 0.182, value / 0.75][c];
        near!(
            babylon[(y * 32 + x) * 3 + c] / 255.0,
            unit,
            2.5 / 255.0,
            "Babylon's rows are views, its codes up to 2.4 too high"
        );
    }
}

/// Texels of the sheen in the order and coding of each engine, against the shipped table at hand (rounded to five decimals).
#[test]
fn texels_of_sheen() {
    // (mu, r) in 31sts, A, B, R
    let shipped = [((12.0, 31.0), [0.85275, 0.0, 0.55034]), ((4.0, 20.0), [0.47706, -0.14135, 0.57114])];
    for (id, table, swapped) in [
        ("ltc-sheen", "ltc-sheen-volume", true),
        ("cycles", "cycles-sheen-ltc", false),
        ("babylon", "babylon-fuzz-brdf", true),
    ] {
        let plan = plan(id, |name| name == table);
        for ((mu, r), [a, b, reflectance]) in shipped {
            let at = if swapped { [r / 31.0, mu / 31.0] } else { [mu / 31.0, r / 31.0] };
            let e = plan.tables[0].bound.baker.texel(&at, 1e-3).unwrap();
            let wanted = match id {
                "babylon" => [(a - 0.005) / 0.875, (b + 0.18) / 0.182, reflectance / 0.75],
                _ => [a, b, reflectance],
            };
            for (c, (value, wanted)) in e.value.iter().zip(wanted).enumerate() {
                near!(*value, wanted, DRAWN, "{id}, channel {c}: {:?}", e.value);
            }
        }
    }
}

#[test]
fn area_lights() {
    let Some(dir) = shared() else { return };
    let from = |name: &str| npy(&dir.join("oracles/engines/selfshadow_ltc").join(name));
    let shipped = Texture::new(64, 64, 4, from("ltc_js_g_ltc_2.npy"));
    let out = tempfile::tempdir().unwrap();
    let file = bake(&plan("selfshadow-ltc", |t| t == "ltc-2"), out.path()).remove(0);
    let read =
        |file: &Path| Texture::new(64, 64, 4, numbers(&std::fs::read_to_string(file).unwrap()).concat());
    let baked = read(&file);
    let own = samples(plan("selfshadow-ltc", |t| t == "ltc-2"), read);
    agree("ltc magnitude", &shipped, &own, &[[6.6e-2, 0.0], [2.9e-2, 0.0], [0.0, 0.0], [3e-6, 0.0]]);
    let case = Case {
        name: "ltc magnitude",
        kind: "ltc-magnitude",
        channels: &["ltc.magnitude", "ltc.fresnel"],
        at: ltc,
        luck: 1.0,
    };
    not_worse(&case, &shipped, &baked, size(&file), 0.0);
}

/// The numbers of the registry are those that a report of this program would give of the shipped files.
#[test]
fn registry_knows_how_far_off_the_shipped_files_are() {
    let Some(dir) = shared().map(|d| d.join("oracles/engines")) else { return };
    let same = |a: f64, b: f64| (a - b).abs() <= 0.02 * b.abs();
    let mut wrong = Vec::new();
    for (id, table, file) in [
        ("bevy", "bevy-dfg", "bevy/dfg_half.npy"),
        ("three", "three-dfg", "three/dfg_rg16f.npy"),
        ("filament", "filament-dfg", "filament/dfg_rgb16f.npy"),
        ("babylon", "babylon-environment-brdf", "babylon/environmentBRDF_decoded_linear.npy"),
        ("selfshadow-ltc", "ltc-2", "selfshadow_ltc/ltc_js_g_ltc_2.npy"),
        ("bevy", "bevy-ltc-magnitude", "bevy/ltc_half.npy"),
        ("cycles", "cycles-ggx-E", "cycles/ggx_E.npy"),
        ("cycles", "cycles-ggx-Eavg", "cycles/ggx_Eavg.npy"),
    ] {
        let plan = plan(id, |name| name == table);
        let planned = &plan.tables[0];
        let probe = Probe::new(&planned.bound, planned.tolerance, 1 << 16);
        let mut values = npy(&dir.join(file));
        // the second layer of two
        values
            .drain(..values.len() - planned.bound.spec.grid.len() * planned.bound.spec.layout.channels.len());
        let read = probe.measure_without_offset(&values).unwrap_or_else(|| probe.measure(&values));
        let practical = read.practical.unwrap_or(read.whole.clone());
        let [whole, practical] = [read.whole, practical].map(|s| [s.largest.value, s.mean]);
        let show = |[largest, mean]: [f64; 2]| format!("[{largest:.3e}, {mean:.3e}]");
        println!("{id} {table}: whole {}, practical {}", show(whole), show(practical));
        let entry = engine(id).unwrap().files.iter().find(|f| f.table == table).unwrap();
        let told = entry.shipped.map_or([[0.0; 2]; 2], |s| [s.whole, s.practical]);
        let pairs = told.into_iter().flatten().zip([whole, practical].into_iter().flatten());
        if !pairs.into_iter().all(|(told, measured)| same(told, measured)) {
            wrong.push(format!("{id} {table}: {told:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Texels of shipped tables that are always at hand, against the baked files.
#[test]
fn texels_of_shipped_tables() {
    let text = include_str!("../values/engines.csv");
    let rows: Vec<Vec<&str>> = text.lines().skip(1).map(|line| line.split(',').collect()).collect();
    for (id, table, width, channels) in [
        ("bevy", "bevy-dfg", 64, 2),
        ("three", "three-dfg", 16, 2),
        ("filament", "filament-dfg", 64, 3),
        ("cycles", "cycles-ggx-E", 32, 1),
    ] {
        let out = tempfile::tempdir().unwrap();
        let file = bake(&exact(plan(id, |name| name == table)), out.path()).remove(0);
        let baked = match std::fs::read_to_string(&file) {
            Ok(text) => Texture::new(width, width, channels, numbers(&text).concat()),
            Err(_) => picture(&file, channels),
        };
        let mut compared = 0;
        for row in rows.iter().filter(|row| row[0] == id && row[1] == table) {
            let index = |i: usize| row[i].parse::<usize>().unwrap();
            let [shipped, bound] = [5, 6].map(|i| row[i].parse::<f64>().unwrap());
            let off = (baked.texel(index(2), index(3))[index(4)] - shipped).abs();
            assert!(off <= bound, "{row:?}: off by {off:e}");
            compared += 1;
        }
        assert!(compared >= 4, "{id}: nothing to compare");
    }
}
