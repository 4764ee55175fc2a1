//! Files of engines, baked and shipped, and the lookup that a shader does: written here anew, not taken from the library.

use brdfbake::cancel::Cancel;
use brdfbake::encode::read;
use brdfbake::grid::fit::Texels;
use brdfbake::pipeline::{self, Settings, Silent};
use brdfbake::plan::Plan;
use brdfbake::recipe;
use half::f16;
use std::path::{Path, PathBuf};

/// A table as a texture: rows from the top, channels interleaved.
#[derive(Debug, Clone)]
pub(crate) struct Texture {
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) channels: usize,
    pub(crate) values: Vec<f64>,
}

impl Texture {
    pub(crate) fn new(width: usize, height: usize, channels: usize, values: Vec<f64>) -> Texture {
        assert_eq!(values.len(), width * height * channels);
        Texture { width, height, channels, values }
    }

    pub(crate) fn texel(&self, x: usize, y: usize) -> &[f64] {
        let i = (y * self.width + x) * self.channels;
        &self.values[i..i + self.channels]
    }

    /// What a GPU returns at (u, v): linear filter, clamp to edge, texel centres at (i + 1/2) / n.
    pub(crate) fn sample(&self, [u, v]: [f64; 2]) -> Vec<f64> {
        let axis = |t: f64, n: usize| {
            let x = (t * n as f64 - 0.5).clamp(0.0, (n - 1) as f64);
            let low = x.floor();
            let i = low as usize;
            (i, (i + 1).min(n - 1), x - low)
        };
        let ((x0, x1, s), (y0, y1, t)) = (axis(u, self.width), axis(v, self.height));
        (0..self.channels)
            .map(|c| {
                let row = |y: usize| self.texel(x0, y)[c] * (1.0 - s) + self.texel(x1, y)[c] * s;
                row(y0) * (1.0 - t) + row(y1) * t
            })
            .collect()
    }
}

/// The tables of an engine whose names pass, without the report between the texels.
pub(crate) fn plan(id: &str, wanted: impl Fn(&str) -> bool) -> Plan {
    let mut plan = recipe::engine(id).unwrap().plan().unwrap_or_else(|e| panic!("{e}"));
    plan.tables.retain(|t| wanted(t.name()));
    plan
}

/// The same with a sample in every texel, whatever the engine's recipe says: to be compared with another program's samples.
pub(crate) fn exact(mut plan: Plan) -> Plan {
    plan.tables.iter_mut().for_each(|t| t.asked.texels = Texels::default());
    plan
}

/// Bakes a plan into a folder and returns the paths of its files, one a table.
pub(crate) fn bake(plan: &Plan, out: &Path) -> Vec<PathBuf> {
    let settings = Settings { jobs: Some(2), ..Settings::new(out) };
    let outcome = pipeline::run(plan, &settings, &Cancel::new(), &Silent).unwrap();
    outcome.manifest.tables.iter().map(|t| out.join(&t.files[0].file)).collect()
}

/// The picture in a file, with this many of its components.
pub(crate) fn picture(path: &Path, channels: usize) -> Texture {
    let image = read::read_file(path).unwrap();
    let texels = image.width * image.height;
    let at = |i: usize| (0..channels).map(move |c| (c, i));
    let values = (0..texels).flat_map(at).map(|(c, i)| image.channels[c].values[i]).collect();
    Texture::new(image.width, image.height, channels, values)
}

/// The numbers between brackets that a text holds: the bits of halves, or decimals.
pub(crate) fn numbers(text: &str) -> Vec<Vec<f64>> {
    let number = |word: &str| match word.strip_prefix("0x") {
        Some(bits) => Some(f16::from_bits(u16::from_str_radix(bits, 16).ok()?).to_f64()),
        None => word.parse().ok(),
    };
    let mut lists = vec![Vec::new()];
    for line in text.lines() {
        let words: Vec<&str> = line.trim().trim_end_matches(',').split(',').map(str::trim).collect();
        match words.iter().map(|w| number(w)).collect::<Option<Vec<f64>>>() {
            Some(line) => lists.last_mut().unwrap().extend(line),
            None if lists.last().is_some_and(|l| !l.is_empty()) => lists.push(Vec::new()),
            None => {}
        }
    }
    lists.retain(|l| !l.is_empty());
    lists
}

/// Values of a little-endian `.npy` of f2, f4, f8, u1 or u2.
pub(crate) fn npy(path: &Path) -> Vec<f64> {
    let bytes = std::fs::read(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let header = usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let text = std::str::from_utf8(&bytes[10..10 + header]).unwrap();
    let data = &bytes[10 + header..];
    match text {
        t if t.contains("<f2") => {
            data.chunks_exact(2).map(|c| f16::from_le_bytes([c[0], c[1]]).to_f64()).collect()
        }
        t if t.contains("<f4") => {
            data.chunks_exact(4).map(|c| f64::from(f32::from_le_bytes(c.try_into().unwrap()))).collect()
        }
        t if t.contains("<f8") => {
            data.chunks_exact(8).map(|c| f64::from_le_bytes(c.try_into().unwrap())).collect()
        }
        t if t.contains("<u2") => {
            data.chunks_exact(2).map(|c| f64::from(u16::from_le_bytes([c[0], c[1]]))).collect()
        }
        t if t.contains("|u1") => data.iter().map(|b| f64::from(*b)).collect(),
        t => panic!("{t}"),
    }
}
