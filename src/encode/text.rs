//! Bare numbers as text: channels interleaved (`+planar`: one after another), axis 0 fastest, commas between, none behind
//! the last one. With `+vec` each texel is a constructor of shader languages, `vec3(0.25, 0.5, 1.0)`.
//!
//! `half` is written as the bits of each number, `0x3c00`, as arrays of 16-bit integers want it; `float` and `double` in
//! the fewest digits that read back to the same bits, `0.25`; `unorm16` as its codes, `16384`. Lines hold eight numbers.
//!
//! Recipes put text round them: `before = "static const float table[] = {\n"`, `after = "};\n"`. What they make of it is a
//! source file of an engine; `manifest.json` tells the rest.

use super::{EncodeError, EncodeInput, Encoder, FileOption, Shape, Storage};
use half::f16;
use std::fmt::Write;

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

    fn media_type(&self) -> &'static str {
        "text/plain"
    }

    fn storages(&self) -> &'static [Storage] {
        &[Storage::Half, Storage::Float, Storage::Double, Storage::Unorm16]
    }

    fn options(&self) -> &'static [FileOption] {
        &[FileOption::Planar, FileOption::Vectors]
    }

    fn most_channels(&self) -> usize {
        64
    }

    fn holds_metadata(&self) -> bool {
        false
    }

    fn encode(&self, input: &EncodeInput<'_>) -> Result<Vec<u8>, EncodeError> {
        input.check(self)?;
        let count = input.channels.len().max(1);
        let texels = input.values.len() / count;
        let planar = input.options.contains(&FileOption::Planar);
        let vectors = input.options.contains(&FileOption::Vectors);
        // the place in the table of number i
        let place = |i: usize| if planar { i % texels * count + i / texels } else { i };
        let mut text = String::with_capacity(self.most_bytes(&input.shape()));
        // a vector is never broken
        let line = if vectors { count } else { IN_A_LINE };
        for i in 0..input.values.len() {
            match i % line {
                0 => {
                    input.cancel.check()?;
                    text.push_str(if i == 0 { "" } else { ",\n" });
                }
                _ => text.push_str(", "),
            }
            if vectors && i % count == 0 {
                text.push_str(&format!("vec{count}("));
            }
            let at = place(i);
            write(&mut text, input.values[at], input.storage, input.channels[at % count].range);
            if vectors && i % count == count - 1 {
                text.push(')');
            }
        }
        text.shrink_to_fit();
        Ok(text.into_bytes())
    }

    /// `0x3c00`; digits, sign, point and exponent; two characters between numbers.
    fn most_bytes(&self, shape: &Shape<'_>) -> usize {
        let digits = match shape.storage {
            Storage::Half => 6,
            Storage::Unorm16 => 5,
            Storage::Float => MOST_DIGITS[0],
            _ => MOST_DIGITS[1],
        };
        let vector = if shape.has(FileOption::Vectors) { "vec4()".len() } else { 0 };
        shape.grid.len().saturating_mul(vector + shape.channels.saturating_mul(digits + 2))
    }

    /// The text and nothing else; twice that where memory cannot be given back in place.
    fn most_memory(&self, shape: &Shape<'_>) -> usize {
        self.most_bytes(shape).saturating_mul(2)
    }
}

/// Longest numbers of 32 and 64 bits as they are printed: `-1.17549435e-38`, `-2.2250738585072014e-308`.
pub(super) const MOST_DIGITS: [usize; 2] = [16, 24];

/// A number of the storage; of a code its range.
#[allow(clippy::cast_possible_truncation, reason = "the value is a number of the storage: checked")]
fn write(text: &mut String, v: f64, storage: Storage, [lo, hi]: [f64; 2]) {
    // writing to a string does not fail
    let _ = match storage {
        Storage::Half => write!(text, "0x{:04x}", f16::from_f64(v).to_bits()),
        Storage::Float => write!(text, "{:?}", v as f32),
        Storage::Unorm16 => write!(text, "{:.0}", (v - lo) / (hi - lo) * f64::from(u16::MAX)),
        _ => write!(text, "{v:?}"),
    };
}
