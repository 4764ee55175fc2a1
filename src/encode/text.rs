//! Bare numbers as text: channels interleaved (`+planar`: one after another), axis 0 fastest, commas between, none behind
//! the last one.
//!
//! `half` is written as the bits of each number, `0x3c00`, as arrays of 16-bit integers want it; `float` and `double` in
//! the fewest digits that read back to the same bits, `0.25`. Lines hold eight numbers.
//!
//! Recipes put text round them: `before = "static const float table[] = {\n"`, `after = "};\n"`. What they make of it is a
//! source file of an engine; `manifest.json` tells the rest.

use super::{EncodeError, EncodeInput, Encoder, FileOption, Storage};
use half::f16;

/// The container. See the module.
#[derive(Debug, Clone, Copy)]
pub struct Text;

/// Numbers in a line.
const IN_A_LINE: usize = 8;

impl Encoder for Text {
    fn id(&self) -> &'static str {
        "text"
    }

    fn extension(&self) -> &'static str {
        "txt"
    }

    fn is_bare(&self) -> bool {
        true
    }

    fn storages(&self) -> &'static [Storage] {
        &[Storage::Half, Storage::Float, Storage::Double]
    }

    fn options(&self) -> &'static [FileOption] {
        &[FileOption::Planar]
    }

    fn most_channels(&self) -> usize {
        64
    }

    fn holds_metadata(&self) -> bool {
        false
    }

    fn encode(&self, input: &EncodeInput<'_>) -> Result<Vec<u8>, EncodeError> {
        input.check(self)?;
        let line = |line: &[f64]| {
            input.cancel.check()?;
            Ok(line.iter().map(|v| number(*v, input.storage)).collect::<Vec<String>>().join(", "))
        };
        let count = input.channels.len();
        let lines: Result<Vec<String>, EncodeError> = if input.options.contains(&FileOption::Planar) {
            let plane = |c: usize| input.values.iter().skip(c).step_by(count.max(1)).copied();
            let planes: Vec<f64> = (0..count).flat_map(plane).collect();
            planes.chunks(IN_A_LINE).map(line).collect()
        } else {
            input.values.chunks(IN_A_LINE).map(line).collect()
        };
        Ok(lines?.join(",\n").into_bytes())
    }
}

/// A number of the storage.
#[allow(clippy::cast_possible_truncation, reason = "the value is a number of the storage: checked")]
fn number(v: f64, storage: Storage) -> String {
    match storage {
        Storage::Half => format!("0x{:04x}", f16::from_f64(v).to_bits()),
        Storage::Float => format!("{:?}", v as f32),
        _ => format!("{v:?}"),
    }
}
