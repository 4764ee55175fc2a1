//! Files for other programs to read: see `tests/foreign/read_back.py`.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stderr, reason = "tests")]

mod shapes;

use crate::sample::{file, grid, hard, provenance, table};
use brdfbake::encode::read::read_file;
use brdfbake::encode::{ENCODERS, EncodeInput, FileOption, Label, Shape, Storage, encoder, quantise_table};

/// Writes one file of each kind, with what it must hold, for `tests/foreign/read_back.py`.
#[test]
#[ignore = "writes files for a foreign reader: BRDFBAKE_FOREIGN=<folder>"]
fn write_for_foreign_readers() {
    let folder = std::env::var_os("BRDFBAKE_FOREIGN").unwrap_or(env!("CARGO_TARGET_TMPDIR").into());
    let folder = std::path::PathBuf::from(folder);
    std::fs::create_dir_all(&folder).unwrap();
    let names = ["dfg.scale", "dfg.bias", "a", "z.cloth"];
    assert_eq!(grid().len(), 35);
    // the binary of the MERL database holds one shape of table: see `read_merl.py`
    for encoder in ENCODERS.iter().filter(|e| !e.magic().is_empty() && e.id() != "merl") {
        for &storage in encoder.storages() {
            let most = encoder.most_channels().min(storage.most_channels().unwrap_or(4)).min(4);
            for n in 1..=most {
                let t = table(&names[..n], hard(storage));
                let p = provenance(&t, storage);
                let values = quantise_table(&t, storage).unwrap().values;
                let name = format!("{}-{n}.{}", storage.id(), encoder.extension());
                std::fs::write(folder.join(&name), file(*encoder, &t, storage, &p)).unwrap();
                let planes: serde_json::Map<_, _> = (0..n)
                    .map(|c| {
                        // As bits: Python reads them exactly, a negative zero included.
                        let bits = |v: &f64| format!("{:016x}", v.to_bits());
                        let column: Vec<String> = values.iter().skip(c).step_by(n).map(bits).collect();
                        (names[c].to_owned(), column.into())
                    })
                    .collect();
                let shape = Shape { grid: &t.grid, channels: n, storage, options: &[] };
                let components = encoder.components(&shape);
                let expected = serde_json::json!({"width": 7, "height": 5, "storage": storage.id(), "channels": planes,
                    "components": components, "fill": shape.fill(components),
                    "brdfbake": serde_json::to_string(&p).unwrap()});
                std::fs::write(folder.join(format!("{name}.expected.json")), expected.to_string()).unwrap();
            }
        }
    }
    shapes::write(&folder);
    write_set(&folder);
    write_positional(&folder);
}

/// OpenEXR under the names that loaders of colours know, and what each name must hold.
fn write_positional(folder: &std::path::Path) {
    let exr = encoder("exr").unwrap();
    for (n, option) in (1..=4).map(|n| (n, FileOption::Positional)).chain([(1, FileOption::Luminance)]) {
        for storage in [Storage::Half, Storage::Float] {
            let t = table(&["dfg.scale", "dfg.bias", "a", "z.cloth"][..n], hard(storage));
            let rounded = quantise_table(&t, storage).unwrap();
            let options = [option];
            let shape = Shape { grid: &t.grid, channels: n, storage, options: &options };
            let names = exr.names(&shape);
            let mut p = provenance(&t, storage);
            if let Some(encoding) = &mut p.encoding {
                encoding.fill = shape.fill(exr.components(&shape));
                encoding.names = names.iter().map(|n| (*n).to_owned()).collect();
            }
            let text = serde_json::to_string(&p).unwrap();
            let label = Label { name: &p.name, provenance_json: &text, ..Label::default() };
            let bytes = exr.encode(&crate::sample::input(&t, &rounded, storage, &options, label)).unwrap();
            let value = |i: usize, c: usize| match (n, c) {
                (1, _) => rounded.values[i],
                (2, 2) => 0.0,
                _ => rounded.values[i * n + c],
            };
            let column = |c: usize| -> Vec<String> {
                (0..t.grid.len()).map(|i| format!("{:016x}", value(i, c).to_bits())).collect()
            };
            let planes: serde_json::Map<_, _> =
                names.iter().enumerate().map(|(c, name)| ((*name).to_owned(), column(c).into())).collect();
            let expected = serde_json::json!({"width": 7, "height": 5, "storage": storage.id(), "channels": planes, "brdfbake": text});
            let name = format!("{}-{n}.{}.exr", storage.id(), option.id());
            std::fs::write(folder.join(&name), bytes).unwrap();
            std::fs::write(folder.join(format!("{name}.expected.json")), expected.to_string()).unwrap();
        }
    }
}

/// Two tables as parts of one OpenEXR file, and what each part must hold.
fn write_set(folder: &std::path::Path) {
    let exr = encoder("exr").unwrap();
    let mut parts = serde_json::Map::new();
    let mut tables = Vec::new();
    for (name, channels, storage) in
        [("split-sum", &["dfg.scale", "dfg.bias"][..], Storage::Half), ("albedo", &["e"], Storage::Float)]
    {
        let t = table(channels, hard(storage));
        let mut p = provenance(&t, storage);
        p.name = name.to_owned();
        let values = quantise_table(&t, storage).unwrap().values;
        let plane = |(c, id): (usize, &&str)| {
            let bits = |v: &f64| format!("{:016x}", v.to_bits());
            let column: Vec<String> = values.iter().skip(c).step_by(channels.len()).map(bits).collect();
            ((*id).to_owned(), column.into())
        };
        let planes: serde_json::Map<String, serde_json::Value> =
            channels.iter().enumerate().map(plane).collect();
        let text = serde_json::to_string(&p).unwrap();
        parts.insert(name.to_owned(), serde_json::json!({ "channels": planes, "brdfbake": text }));
        tables.push((name, t, storage, values, text));
    }
    let cancel = brdfbake::cancel::Cancel::new();
    let inputs: Vec<EncodeInput<'_>> = tables
        .iter()
        .map(|(name, t, storage, values, text)| EncodeInput {
            grid: &t.grid,
            channels: &t.channels,
            values,
            blocks: &[],
            errors: &[],
            storage: *storage,
            options: &[],
            label: Label { name, provenance_json: text, ..Label::default() },
            cancel: &cancel,
        })
        .collect();
    std::fs::write(folder.join("set.exr"), exr.encode_together(&inputs).unwrap()).unwrap();
    let text = serde_json::Value::from(parts).to_string();
    std::fs::write(folder.join("set.exr.parts.json"), text).unwrap();
}

/// Reads the files of `tests/foreign/write_out.py`.
#[test]
#[ignore = "reads files of foreign programs: BRDFBAKE_FOREIGN_IN=<folder>"]
fn files_of_foreign_programs_are_read() {
    let Some(folder) = std::env::var_os("BRDFBAKE_FOREIGN_IN") else {
        eprintln!("skipped: BRDFBAKE_FOREIGN_IN is not set");
        return;
    };
    let mut files = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let Some(picture) = path.to_str().and_then(|p| p.strip_suffix(".expected.json")) else { continue };
        let expected: serde_json::Value = serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap();
        let image = read_file(picture.as_ref()).unwrap_or_else(|e| panic!("{picture}: {e}"));
        let size = [&expected["width"], &expected["height"]].map(|n| n.as_u64());
        assert_eq!([image.width, image.height].map(|n| Some(n as u64)), size, "{picture}");
        let channels = expected["channels"].as_object().unwrap();
        assert_eq!(image.channels.len(), channels.len(), "{picture}");
        for (name, column) in channels {
            let plane = image.channel(name).unwrap_or_else(|| panic!("{picture}: no channel {name}"));
            for (i, (got, bits)) in plane.values.iter().zip(column.as_array().unwrap()).enumerate() {
                let want = f64::from_bits(u64::from_str_radix(bits.as_str().unwrap(), 16).unwrap());
                assert!((got - want).abs() == 0.0, "{picture}: {name}[{i}] = {got}, expected {want}");
            }
        }
        files += 1;
    }
    assert!(files > 0, "no file to read");
}
