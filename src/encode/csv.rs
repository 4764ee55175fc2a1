//! CSV: a header, then one line a texel: the values of its axes, its channels, and their estimated integration errors.
//!
//! Axes are in their own quantities and named by them (`mu`, `roughness`), channels by their ids, errors `error of ...`.
//! Every number is the shortest that reads back to the same f64. There is no metadata: a comment would be a row to most
//! readers.

use super::text::MOST_DIGITS;
use super::{EncodeError, EncodeInput, Encoder, Shape, Storage};
use crate::grid::table::named;

/// The container. See the module.
#[derive(Debug, Clone, Copy)]
pub struct Csv;

impl Encoder for Csv {
    fn id(&self) -> &'static str {
        "csv"
    }

    fn extension(&self) -> &'static str {
        "csv"
    }

    fn media_type(&self) -> &'static str {
        "text/csv"
    }

    fn storages(&self) -> &'static [Storage] {
        &[Storage::Double, Storage::Float, Storage::Half]
    }

    fn most_channels(&self) -> usize {
        1024
    }

    fn holds_metadata(&self) -> bool {
        false
    }

    /// Axes, channels and errors of a texel.
    fn most_bytes(&self, shape: &Shape<'_>) -> usize {
        let numbers = shape.grid.axes().len() + 2 * shape.channels;
        // the head is a line of names
        (shape.grid.len() + 16).saturating_mul(numbers * (MOST_DIGITS[1] + 1))
    }

    /// The text and nothing else.
    fn most_memory(&self, shape: &Shape<'_>) -> usize {
        self.most_bytes(shape)
    }

    fn encode(&self, input: &EncodeInput<'_>) -> Result<Vec<u8>, EncodeError> {
        input.check(self)?;
        let failed = |e: ::csv::Error| EncodeError::Library { format: "csv", source: Box::new(e) };
        let n = input.channels.len();
        let known = input.errors.len() == input.values.len();
        let mut writer = ::csv::Writer::from_writer(Vec::with_capacity(self.most_bytes(&input.shape())));
        let axes = input.grid.axes().iter().map(|a| a.quantity.id.to_owned());
        let channels = input.channels.iter().map(|c| c.id.clone());
        let errors = input.channels.iter().filter(|_| known).map(|c| format!("error of {}", c.id));
        writer.write_record(axes.chain(channels).chain(errors)).map_err(failed)?;
        for (t, texel) in input.values.chunks_exact(n).enumerate() {
            input.cancel.check()?;
            let at = named(input.grid, &input.grid.texel(t));
            let errors = if known { &input.errors[t * n..(t + 1) * n] } else { &[] };
            let numbers = at.iter().map(|(_, v)| v).chain(texel).chain(errors);
            writer.write_record(numbers.map(|v| number(*v))).map_err(failed)?;
        }
        writer
            .into_inner()
            .map_err(|e| EncodeError::Library { format: "csv", source: Box::new(e.into_error()) })
    }
}

/// The shortest text that reads back to the same number, with an exponent where that is shorter.
fn number(v: f64) -> String {
    format!("{v:?}")
}
