//! Bare numbers: little-endian, channels interleaved, axis 0 fastest, no header. `manifest.json` tells the rest.

use super::{EncodeError, EncodeInput, Encoder, Shape, Storage, texels};

/// The container. See the module.
#[derive(Debug, Clone, Copy)]
pub struct Raw;

impl Encoder for Raw {
    fn id(&self) -> &'static str {
        "raw"
    }

    fn extension(&self) -> &'static str {
        "bin"
    }

    fn is_bare(&self) -> bool {
        true
    }

    fn storages(&self) -> &'static [Storage] {
        super::storage::STORAGES
    }

    fn most_channels(&self) -> usize {
        1024
    }

    fn components(&self, shape: &Shape<'_>) -> usize {
        texels::packed(shape.storage).unwrap_or(shape.channels)
    }

    fn holds_metadata(&self) -> bool {
        false
    }

    fn encode(&self, input: &EncodeInput<'_>) -> Result<Vec<u8>, EncodeError> {
        input.check(self)?;
        texels::pack(input, self.components(&input.shape()))
    }
}
