//! Tables of one to four axes and their files.

use crate::sample;
use brdfbake::encode::{EncodeError, FileOption, Label, Shape, Storage, encoder, quantise_table};
use brdfbake::grid::{Axis, Channel, Grid, Quantity, Table, Texel};

/// A table with axes of these lengths and `channels` channels in (0, 1).
pub(crate) fn table(lengths: &[usize], channels: usize) -> Table {
    let ids = ["mu", "alpha", "f0", "rho"];
    let axes =
        lengths.iter().zip(ids).map(|(n, id)| Axis::new(Quantity::find(id).unwrap(), *n, Texel::Center));
    let grid = Grid::new(axes.collect()).unwrap();
    let n = grid.len() * channels;
    let x = |i: usize| (i as f64 * 0.618_033_988_749_895 + 0.1).fract();
    Table {
        channels: (0..channels)
            .map(|c| Channel {
                id: format!("v{c}"),
                meaning: "a number".into(),
                range: [0.0, 1.0],
                role: String::new(),
            })
            .collect(),
        values: (0..n).map(x).collect(),
        errors: (0..n).map(|i| 1e-9 * i as f64).collect(),
        evaluations: vec![64; grid.len()],
        grid,
    }
}

/// A file, and the values that it must hold.
pub(crate) fn written(
    table: &Table,
    container: &str,
    storage: Storage,
    options: &[FileOption],
) -> Result<(Vec<u8>, Vec<f64>), EncodeError> {
    let rounded = quantise_table(table, storage).unwrap();
    let mut provenance = sample::provenance(table, storage);
    let encoder = encoder(container).unwrap();
    let shape = Shape { grid: &table.grid, channels: table.channels.len(), storage, options };
    if let Some(encoding) = &mut provenance.encoding {
        encoding.fill = shape.fill(encoder.components(&shape));
        encoding.names = encoder.names(&shape).iter().map(|n| (*n).to_owned()).collect();
    }
    let json = serde_json::to_string(&provenance).unwrap();
    let label = Label { name: &provenance.name, identity: &provenance.recipe.hash, provenance_json: &json };
    let input = sample::input(table, &rounded, storage, options, label);
    let bytes = encoder.encode(&input)?;
    Ok((bytes, rounded.values))
}
