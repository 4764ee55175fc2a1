//! Pictures, volumes and arrays as KTX2 and DDS, with options, and what they must hold.

use crate::sample;
use brdfbake::encode::{EncodeInput, FileOption, Label, Quantised, Shape, Storage, encoder, quantise_table};
use brdfbake::grid::{Axis, Channel, Grid, Quantity, Table, Texel};
use std::path::Path;

/// Lengths of the axes, the option, and a word for the name.
const SHAPES: &[(&[usize], Option<FileOption>, &str)] = &[
    (&[7], None, "line"),
    (&[7, 5], None, "picture"),
    (&[7, 5, 3], None, "volume"),
    (&[7, 5, 3], Some(FileOption::Layers), "layers"),
    (&[7, 5, 3, 2], None, "array"),
];

fn table(lengths: &[usize], channels: usize) -> Table {
    let axes = lengths.iter().zip(["mu", "alpha", "f0", "rho"]);
    let axes = axes.map(|(n, id)| Axis::new(Quantity::find(id).unwrap(), *n, Texel::Center));
    let grid = Grid::new(axes.collect()).unwrap();
    let n = grid.len() * channels;
    Table {
        channels: (0..channels)
            .map(|c| Channel {
                id: format!("v{c}"),
                meaning: "∫ f µ dω".into(),
                range: [0.0, 1.0],
                role: String::new(),
            })
            .collect(),
        values: (0..n).map(|i| (i as f64 * 0.618_033_988_749_895 + 0.1).fract()).collect(),
        errors: vec![1e-9; n],
        evaluations: vec![64; grid.len()],
        grid,
    }
}

/// One file of each shape, storage and option, named after them.
pub(crate) fn write(folder: &Path) {
    for container in ["ktx2", "dds"] {
        let encoder = encoder(container).unwrap();
        for (lengths, layers, word) in SHAPES {
            for storage in [Storage::Half, Storage::Float, Storage::Unorm8, Storage::Unorm16, Storage::Rgb9e5]
            {
                for more in
                    [&[][..], &[FileOption::Rgba], &[FileOption::Zstd], &[FileOption::Rgba, FileOption::Zstd]]
                {
                    let options: Vec<FileOption> = layers.iter().chain(more).copied().collect();
                    // packed words have their components
                    let packed = storage == Storage::Rgb9e5 && options.contains(&FileOption::Rgba);
                    if !packed && options.iter().all(|o| encoder.options().contains(o)) {
                        write_one(folder, container, (lengths, word), storage, &options);
                    }
                }
            }
        }
    }
}

fn write_one(
    folder: &Path,
    container: &str,
    (lengths, word): (&[usize], &str),
    storage: Storage,
    options: &[FileOption],
) {
    let encoder = encoder(container).unwrap();
    // three components of DDS become four
    let channels = if storage == Storage::Rgb9e5 { 3 } else { 2 + lengths.len() % 2 };
    let t = table(lengths, channels);
    let Quantised { values, blocks, .. } = quantise_table(&t, storage).unwrap();
    let provenance = sample::provenance(&t, storage);
    let json = serde_json::to_string(&provenance).unwrap();
    let (grid, channels, errors) = (&t.grid, &t.channels, &t.errors);
    let input = EncodeInput {
        grid,
        channels,
        values: &values,
        blocks: &blocks,
        errors,
        storage,
        options,
        label: Label { name: &provenance.name, identity: &provenance.recipe.hash, provenance_json: &json },
        cancel: &brdfbake::cancel::Cancel::new(),
    };
    let bytes = encoder.encode(&input).unwrap();
    let shape = Shape { grid, channels: channels.len(), storage, options };
    let [width, height, slices] = shape.extent();
    let components = encoder.components(&shape);
    let planes: serde_json::Map<_, _> = (0..channels.len())
        .map(|c| {
            let bits = |v: &f64| format!("{:016x}", v.to_bits());
            let column: Vec<String> = values.iter().skip(c).step_by(channels.len()).map(bits).collect();
            (channels[c].id.clone(), column.into())
        })
        .collect();
    let words: Vec<&str> = [storage.id(), word].into_iter().chain(options.iter().map(|o| o.id())).collect();
    let name = format!("{}.{container}", words.join("-"));
    let expected = serde_json::json!({"width": width, "height": height, "storage": storage.id(), "channels": planes,
        "depth": if shape.is_volume() { slices } else { 0 }, "layers": shape.layers().unwrap_or(0),
        "components": components, "fill": shape.fill(components), "brdfbake": json});
    std::fs::write(folder.join(&name), bytes).unwrap();
    std::fs::write(folder.join(format!("{name}.expected.json")), expected.to_string()).unwrap();
}
