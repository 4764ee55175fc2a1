//! Every table of every engine, one texel by its place in the file. The places are what the engines' own sources say; the
//! values come from integrals that share nothing with this program (`values/engine_texels.py`), and from the fitter of the area
//! lights' authors (`values/ltc.csv`). The texels are far from any symmetry: with axes swapped, rows or a root turned round, a shift
//! or a channel of another place, they have other values.

use crate::engines::support::{npy, numbers, picture, plan};
use crate::tolerance::near;
use brdfbake::encode::{self, EncodeInput, FileOption, Label, quantise_table};
use brdfbake::grid::Table;
use brdfbake::plan::PlannedTable;
use brdfbake::recipe::ENGINES;
use half::f16;
use std::collections::BTreeSet;

struct Row<'a> {
    engine: &'a str,
    table: &'a str,
    place: [usize; 3],
    component: usize,
    value: f64,
    bound: f64,
}

fn rows() -> Vec<Row<'static>> {
    let text = include_str!("../values/engine_texels.csv");
    let row = |line: &'static str| {
        let cells: Vec<&str> = line.split(',').collect();
        let index = |i: usize| cells[i].parse::<usize>().unwrap();
        let number = |i: usize| cells[i].parse::<f64>().unwrap();
        Row {
            engine: cells[0],
            table: cells[1],
            place: [2, 3, 4].map(index),
            component: index(5),
            value: number(6),
            bound: number(7),
        }
    };
    text.lines().skip(2).map(row).collect()
}

fn table(engine: &str, name: &str) -> PlannedTable {
    plan(engine, |table| table == name).tables.remove(0)
}

/// The number of a texel: along x, then y, then z.
fn number(planned: &PlannedTable, [x, y, z]: [usize; 3]) -> usize {
    let [width, height, _] = planned.bound.spec.grid.extent();
    x + width * (y + height * z)
}

/// What a texel holds before it is rounded.
fn texel(planned: &PlannedTable, place: [usize; 3]) -> Vec<f64> {
    let bound = &planned.bound;
    let point = bound.spec.grid.texel(number(planned, place));
    let e = bound.baker.texel(point.values(), planned.tolerance).unwrap();
    e.value[..bound.spec.layout.channels.len()].to_vec()
}

/// Tables of the area lights' matrices, which are fits.
fn matrices() -> Vec<(&'static str, &'static str)> {
    let tables = ENGINES.iter().flat_map(|e| e.files.iter().map(move |f| (e.id, f.table)));
    tables.filter(|(engine, name)| table(engine, name).bound.spec.kind.id == "ltc-matrix").collect()
}

#[test]
fn texels_are_where_the_engines_read_them() {
    let mut wrong = Vec::new();
    let rows = rows();
    let tables: BTreeSet<(&str, &str)> = rows.iter().map(|r| (r.engine, r.table)).collect();
    for (engine, name) in tables {
        let planned = table(engine, name);
        let of_table: Vec<&Row> = rows.iter().filter(|r| (r.engine, r.table) == (engine, name)).collect();
        let got = texel(&planned, of_table[0].place);
        let components: Vec<usize> = of_table.iter().map(|r| r.component).collect();
        assert_eq!(components, (0..got.len()).collect::<Vec<_>>(), "{engine} {name}: channels");
        for row in of_table {
            let off = (got[row.component] - row.value).abs();
            if off > row.bound + planned.tolerance {
                wrong.push(format!(
                    "{engine} {name} at {:?}, component {}: {} is not {}",
                    row.place, row.component, got[row.component], row.value
                ));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_table_of_every_engine_has_a_texel() {
    let tested: BTreeSet<(&str, &str)> =
        rows().iter().map(|r| (r.engine, r.table)).chain(matrices()).collect();
    let all: BTreeSet<(&str, &str)> =
        ENGINES.iter().flat_map(|e| e.files.iter().map(move |f| (e.id, f.table))).collect();
    assert_eq!(tested, all);
}

/// The density of a transformed cosine: `max(v.z, 0) det / (pi |v|^4)`, `v = M^-1 w`, with m11, m31, m13, m33 over m22 of `M^-1`.
fn density([m11, m31, m13, m33]: [f64; 4], w: [f64; 3]) -> f64 {
    let v = [m11 * w[0] + m13 * w[2], w[1], m31 * w[0] + m33 * w[2]];
    let square: f64 = v.iter().map(|x| x * x).sum();
    v[2].max(0.0) * (m11 * m33 - m13 * m31) / (std::f64::consts::PI * square * square)
}

/// Half of `int |p - q|` over the upper hemisphere: 0 for the same lobe, 1 for lobes apart.
fn variation(p: [f64; 4], q: [f64; 4]) -> f64 {
    let n = 300;
    let at = |i: i32, top: f64| (f64::from(i) + 0.5) / f64::from(n) * top;
    let mut sum = 0.0;
    for i in 0..n {
        // squares of equal steps: narrow lobes graze
        let z = at(i, 1.0) * at(i, 1.0);
        for j in 0..n {
            let phi = at(j, 1.0) * at(j, 1.0) * std::f64::consts::PI;
            let r = (1.0 - z * z).sqrt();
            let w = [r * libm::cos(phi), r * libm::sin(phi), z];
            let area = 2.0 * at(i, 1.0) * 2.0 * at(j, 1.0) * 2.0 * std::f64::consts::PI / f64::from(n * n);
            sum += area * (density(p, w) - density(q, w)).abs();
        }
    }
    0.5 * sum
}

/// x is roughness, y is `sqrt(1 - mu)`, both on the ends; m11, m31, m13, m33 over m22 of the inverse. Matrices that fit as well as
/// each other differ; their lobes hardly do, on surfaces that are not seen at grazing. Of Ogre-Next x is alpha, which at 28 of 63 is the square of roughness 42 of 63.
#[test]
fn matrices_of_area_lights_are_where_shaders_read_them() {
    let text = include_str!("../values/ltc.csv");
    let four = |list: &[f64]| -> [f64; 4] { list[..4].try_into().unwrap() };
    let row = |t: usize, a: usize| -> [f64; 4] {
        let found = text.lines().find(|line| line.starts_with(&format!("{t},{a},"))).unwrap();
        four(&found.split(',').skip(6).take(4).map(|cell| cell.parse().unwrap()).collect::<Vec<f64>>())
    };
    let all = matrices();
    assert!(all.len() >= 6, "{all:?}");
    let by_roughness = table("selfshadow-ltc", "ltc-1");
    for (engine, name) in all {
        let planned = table(engine, name);
        if engine == "ogre-next" {
            let off =
                variation(four(&texel(&planned, [28, 18, 0])), four(&texel(&by_roughness, [42, 18, 0])));
            assert!(off < 1e-2, "{engine}: {off}");
            continue;
        }
        for (t, a) in [(18, 45), (50, 10)] {
            let got = four(&texel(&planned, [a, t, 0]));
            let off = variation(got, row(t, a));
            assert!(off < 0.05, "{engine} ({a}, {t}): {got:?} is {off} off {:?}", row(t, a));
            // the test can tell: m13 and m31 in each other's place are another lobe
            let [m11, m31, m13, m33] = got;
            assert!(variation([m11, m13, m31, m33], row(t, a)) > 0.2, "{engine} ({a}, {t})");
        }
    }
}

/// Numbers that differ from channel to channel in one texel, and none elsewhere: where do files hold them?
#[test]
fn files_hold_a_texel_in_its_place() {
    for engine in ENGINES {
        for planned in plan(engine.id, |_| true).tables {
            let spec = &planned.bound.spec;
            let [width, height, slices] = spec.grid.extent();
            let place = [width / 3, height / 5, slices / 7];
            let (at, n, channels) = (number(&planned, place), spec.layout.channels.len(), spec.channels());
            let storage = planned.outputs[0].storage;
            let span = |c: usize| {
                let [lo, hi] = channels[c].range;
                if storage.is_bounded() { [lo, hi - lo] } else { [0.0, 1.0] }
            };
            let wanted = |c: usize| span(c)[0] + span(c)[1] * (c + 1) as f64 / 8.0;
            let mut values: Vec<f64> =
                (0..spec.grid.len()).flat_map(|_| (0..n).map(|c| span(c)[0])).collect();
            (0..n).for_each(|c| values[at * n + c] = wanted(c));
            let errors = vec![0.0; values.len()];
            let evaluations = vec![1; spec.grid.len()];
            let grid = spec.grid.clone();
            let made = Table { grid, channels: channels.clone(), values, errors, evaluations };
            let stored = quantise_table(&made, storage).unwrap();
            let input = EncodeInput {
                grid: &made.grid,
                channels: &channels,
                values: &stored.values,
                blocks: &stored.blocks,
                errors: &[],
                storage,
                options: &planned.outputs[0].options,
                label: Label::default(),
                cancel: &brdfbake::cancel::Cancel::new(),
            };
            let bytes = planned.outputs[0].encoder.encode(&input).unwrap();
            let found = read(&planned, &bytes, [width, height, slices], n);
            for c in 0..n {
                let got = span(c)[0] + span(c)[1] * found(at, c);
                // half a step of 8 bits over a range, with the 2.2 of RGBD
                let slack = 6e-3 * span(c)[1];
                near!(got, wanted(c), slack, "{} {}, channel {c}: {got}", engine.id, planned.name());
                let next = found((at + 1) % spec.grid.len(), c);
                assert!(next.abs() < 1e-6, "{} {}, channel {c}: {next} beside it", engine.id, planned.name());
            }
        }
    }
}

/// The number of a texel and channel in the file of a table, over the range that the storage spreads: by the layout of
/// the format, written here anew where it has no library of its own.
fn read(
    planned: &PlannedTable,
    bytes: &[u8],
    extent: [usize; 3],
    n: usize,
) -> Box<dyn Fn(usize, usize) -> f64> {
    let output = &planned.outputs[0];
    let [width, height, slices] = extent;
    let dir = tempfile::tempdir().unwrap();
    let write = |extension: &str| {
        let path = dir.path().join(format!("file.{extension}"));
        std::fs::write(&path, bytes).unwrap();
        path
    };
    let bytes = bytes.to_vec();
    let rgba = output.options.contains(&FileOption::Rgba);
    match (output.encoder.id(), output.storage.id()) {
        ("dds", "half") => {
            let components = if rgba || n == 3 { 4 } else { n };
            Box::new(move |t, c| {
                let i = 148 + 2 * (t * components + c);
                f16::from_le_bytes([bytes[i], bytes[i + 1]]).to_f64()
            })
        }
        ("dds", "unorm16") => Box::new(move |t, c| {
            let i = 148 + 2 * (t * n + c);
            f64::from(u16::from_le_bytes([bytes[i], bytes[i + 1]])) / 65535.0
        }),
        ("dds", "rgb10a2") => Box::new(move |t, c| {
            let word = u32::from_le_bytes(bytes[148 + 4 * t..152 + 4 * t].try_into().unwrap());
            f64::from(word >> (10 * c) & 1023) / 1023.0
        }),
        ("raw", "float") => Box::new(move |t, c| {
            let i = 4 * (t * n + c);
            f64::from(f32::from_le_bytes(bytes[i..i + 4].try_into().unwrap()))
        }),
        ("text", storage) => {
            let planar = output.options.contains(&FileOption::Planar);
            // a vector a texel: `vec3(0.25, 0.5, 1.0)`
            let text = String::from_utf8(bytes).unwrap().replace(&format!("vec{n}("), "").replace(')', "");
            let top = if storage == "unorm16" { 65535.0 } else { 1.0 };
            let list = numbers(&text).concat();
            let texels = width * height * slices;
            Box::new(move |t, c| list[if planar { c * texels + t } else { t * n + c }] / top)
        }
        ("npy", _) => {
            let list = npy(&write("npy"));
            Box::new(move |t, c| list[t * n + c])
        }
        ("png", storage) => {
            let image = image::load_from_memory(&bytes).unwrap().to_rgba8();
            let rgbd = storage == "rgbd";
            Box::new(move |t, c| {
                let pixel = image.get_pixel((t % width) as u32, (t / width) as u32).0.map(f64::from);
                if rgbd { libm::pow(pixel[c] / 255.0, 2.2) / (pixel[3] / 255.0) } else { pixel[c] / 255.0 }
            })
        }
        ("ktx2", _) => {
            let texture = picture(&write("ktx2"), n);
            Box::new(move |t, c| texture.texel(t % width, t / width)[c])
        }
        ("exr", _) => {
            // by name: the format sorts its channels
            let image = encode::read::read_file(&write("exr")).unwrap();
            let positional = output.options.contains(&FileOption::Positional);
            let plane = |(c, id): (usize, &str)| {
                // without metadata nothing says what R and G are
                let id = if positional { ["R", "G", "B", "A"][c] } else { id };
                image.channel(id).unwrap().values.clone()
            };
            let planes: Vec<Vec<f64>> = planned.bound.spec.layout.ids().enumerate().map(plane).collect();
            Box::new(move |t, c| planes[c][t])
        }
        other => panic!("{other:?}: say where this format holds a texel"),
    }
}
