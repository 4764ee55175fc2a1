//! A small table and its provenance, for the tests of files and reports.
#![allow(
    dead_code,
    clippy::unwrap_used,
    reason = "each test file uses a part of it; a test may fail by panicking"
)]

use brdfbake::cancel::Cancel;
use brdfbake::encode::{EncodeInput, Encoder, FileOption, Label, Quantised, Storage, quantise_table};
use brdfbake::grid::provenance::{
    AxisRecord, Encoding, Integration, LawRecord, LawResult, RecipeId, Subject,
};
use brdfbake::grid::{Axis, Channel, Grid, Provenance, Quantity, Table, Texel, Warp};
use exr::prelude::Compression;

/// Seven texels of sqrt(mu) at their centres, five of roughness.
pub(crate) fn grid() -> Grid {
    let mu = Quantity::find("mu").unwrap();
    let roughness = Quantity::find("roughness").unwrap();
    let rough = Axis::new(roughness, 5, Texel::Center);
    Grid::new(vec![Axis::new(mu, 7, Texel::Center).warped(Warp::Power(0.5)), rough]).unwrap()
}

pub(crate) fn channel(id: &str) -> Channel {
    Channel {
        id: id.to_owned(), meaning: format!("{id} = ∫ f µ dω"), range: [0.0, 1.0], role: String::new()
    }
}

/// A table with `value(i, x)` in value number `i`; x goes through (0, 1) without pattern.
pub(crate) fn table(channels: &[&str], value: impl Fn(usize, f64) -> f64) -> Table {
    let grid = grid();
    let n = grid.len() * channels.len();
    let x = |i: usize| (i as f64 * 0.618_033_988_749_895 + 0.1).fract();
    Table {
        channels: channels.iter().map(|id| channel(id)).collect(),
        values: (0..n).map(|i| value(i, x(i))).collect(),
        errors: vec![1e-9; n],
        evaluations: vec![64; grid.len()],
        grid,
    }
}

pub(crate) fn provenance(table: &Table, storage: Storage) -> Provenance {
    let subject = |id: &str, title: &str| Subject {
        id: id.to_owned(),
        title: title.to_owned(),
        formula: "E(µo) = ∫ f µi dωi".to_owned(),
        params: [("eta".to_owned(), 1.5.into())].into_iter().collect(),
        sources: vec!["Walter2007 Eq. 20".to_owned(), "Karis2013".to_owned()],
    };
    Provenance {
        schema: 1,
        tool: "brdfbake 0.1.0".to_owned(),
        recipe: RecipeId { name: "test".to_owned(), hash: "0123".to_owned() },
        name: "dfg".to_owned(),
        table: subject("dfg", "Split-sum table"),
        model: Some(subject("ggx-conductor", "GGX conductor")),
        axes: table.grid.axes().iter().map(AxisRecord::new).collect(),
        channels: table.channels.clone(),
        integration: Integration {
            rule: "Gauss-Legendre".to_owned(),
            tolerance: 1e-6,
            largest_error: table.largest_error(),
            evaluations: table.total_evaluations(),
            missed: 0,
        },
        encoding: Some(Encoding {
            storage: storage.id().to_owned(),
            largest_error: quantise_table(table, storage).map_or(0.0, |q| q.largest_error.value),
            fill: Vec::new(),
            names: Vec::new(),
        }),
        residuals: Vec::new(),
        reconstruction: None,
        texels: None,
        size: None,
        laws: vec![LawRecord {
            law: "energy".to_owned(),
            result: LawResult::Held,
            why: None,
            margin: Some(0.25),
            at: "mu = 0.5, roughness = 0.1".to_owned(),
            checked: 48,
            unchecked: 0,
        }],
        tolerance_met: Some(true),
        verified: true,
        waived: Vec::new(),
    }
}

/// What a container gets of a rounded table; nothing stops it.
pub(crate) fn input<'a>(
    table: &'a Table,
    rounded: &'a Quantised,
    storage: Storage,
    options: &'a [FileOption],
    label: Label<'a>,
) -> EncodeInput<'a> {
    static NEVER: Cancel = Cancel::new();
    EncodeInput {
        grid: &table.grid,
        channels: &table.channels,
        values: &rounded.values,
        blocks: &rounded.blocks,
        errors: &table.errors,
        storage,
        options,
        label,
        cancel: &NEVER,
    }
}

/// The bytes of a table in a container.
pub(crate) fn file(encoder: &dyn Encoder, table: &Table, storage: Storage, p: &Provenance) -> Vec<u8> {
    let rounded = quantise_table(table, storage).unwrap();
    let json = serde_json::to_string(p).unwrap();
    let label = Label { name: &p.name, identity: &p.recipe.hash, provenance_json: &json };
    encoder.encode(&input(table, &rounded, storage, &[], label)).unwrap()
}

/// Every compression of OpenEXR.
pub(crate) const COMPRESSIONS: [Compression; 10] = [
    Compression::Uncompressed,
    Compression::RLE,
    Compression::ZIP1,
    Compression::ZIP16,
    Compression::PIZ,
    Compression::PXR24,
    Compression::B44,
    Compression::B44A,
    Compression::DWAA(None),
    Compression::DWAB(None),
];

/// Values that are hard to carry: ties, subnormals, the largest, negative numbers, a negative zero.
pub(crate) fn hard(storage: Storage) -> fn(usize, f64) -> f64 {
    match storage {
        Storage::Half => {
            |i, x| [6e-8, 5.96e-8, 65504.0, 1.0 + 1.0 / 2048.0, -0.0, 6.1e-5, -x].get(i).copied().unwrap_or(x)
        }
        Storage::Float => {
            |i, x| [1e-45, 3.4e38, 1.0 + f64::EPSILON, -0.0, 1.18e-38, 0.1, -x].get(i).copied().unwrap_or(x)
        }
        Storage::Double => |i, x| [5e-324, 1.7e308, -0.0, 0.1 + 1e-17, -x].get(i).copied().unwrap_or(x),
        Storage::Rgb9e5 | Storage::R11g11b10 => {
            |i, x| [0.0, 64000.0, 1e-6, 511.7 / 512.0, 3e-5, 1.0].get(i).copied().unwrap_or(x)
        }
        Storage::Rgbe => |i, x| [0.0, 1e30, 1e-38, 255.7 / 256.0, 1.0].get(i).copied().unwrap_or(x),
        Storage::Rgbd => |i, x| [0.0, 255.0, 1e-7, 9.13, 1.0].get(i).copied().unwrap_or(x),
        Storage::Bc6h => |i, x| [0.0, 65504.0, 1e-6, 5.96e-8].get(i).copied().unwrap_or(x),
        Storage::Bc6hSigned => |i, x| [0.0, -65504.0, 65504.0, -5.96e-8, -x].get(i).copied().unwrap_or(x),
        Storage::Unorm8 | Storage::Unorm16 | Storage::Rgb10a2 | Storage::Bc4 | Storage::Bc5 => {
            |i, x| [0.0, 1.0, 0.5 / 65535.0, 1.5 / 65535.0].get(i).copied().unwrap_or(x)
        }
    }
}
