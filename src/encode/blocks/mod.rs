//! Tables as blocks of 4 x 4 texels: the storages whose texels cannot be rounded one by one.
//!
//! Every slice is cut into blocks, row by row from the top left; blocks that reach beyond the edge repeat the last texel of
//! their row or column. What a reader sees is what the blocks decode to, and that is what the reports compare.

#[cfg_attr(not(feature = "blocks"), allow(dead_code, reason = "what writes blocks is left out"))]
mod bc6h;
#[cfg(feature = "blocks")]
mod bc6h_line;
#[cfg(feature = "blocks")]
mod bc6h_search;
#[cfg_attr(not(feature = "blocks"), allow(dead_code, reason = "what writes blocks is left out"))]
mod ramp;

use super::Storage;
use super::storage::QuantiseError;
use crate::cancel::{Cancel, Cancelled};
use bc6h::TEXELS;
pub(super) use ramp::{STEP, TOP};
use rayon::prelude::*;

/// Side of a block.
const SIDE: usize = 4;

impl Storage {
    /// Does this build write it? Blocks need the feature `blocks`, and are read without.
    #[must_use]
    pub const fn is_written(self) -> bool {
        cfg!(feature = "blocks") || !self.is_block()
    }

    /// # Errors
    /// [`QuantiseError::Feature`] if this build does not write it.
    pub(super) fn check_written(self) -> Result<(), QuantiseError> {
        if self.is_written() { Ok(()) } else { Err(QuantiseError::Feature { storage: self.id() }) }
    }
}

/// A storage made of blocks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Kind {
    /// One or two channels, each in 8 bytes. Values are codes in 0 ..= [`TOP`].
    Ramps(usize),
    /// Three channels in 16 bytes. Values are numbers.
    Bc6h {
        /// With negative numbers.
        signed: bool,
    },
}

impl Kind {
    pub(super) const fn of(storage: Storage) -> Option<Kind> {
        match storage {
            Storage::Bc4 => Some(Kind::Ramps(1)),
            Storage::Bc5 => Some(Kind::Ramps(2)),
            Storage::Bc6h => Some(Kind::Bc6h { signed: false }),
            Storage::Bc6hSigned => Some(Kind::Bc6h { signed: true }),
            _ => None,
        }
    }

    /// Channels of a texel.
    pub(super) const fn channels(self) -> usize {
        match self {
            Kind::Ramps(n) => n,
            Kind::Bc6h { .. } => 3,
        }
    }

    /// Bytes of a block.
    pub(super) const fn block_bytes(self) -> usize {
        match self {
            Kind::Ramps(n) => 8 * n,
            Kind::Bc6h { .. } => 16,
        }
    }

    /// Bytes of a picture; nothing if they cannot be counted.
    pub(super) fn bytes(self, [width, height, slices]: [usize; 3]) -> Option<usize> {
        let blocks = width.div_ceil(SIDE).checked_mul(height.div_ceil(SIDE))?.checked_mul(slices)?;
        blocks.checked_mul(self.block_bytes())
    }

    /// The blocks of a picture with `n` channels, `[texel][channel]`. Channels without value are 0.
    pub(super) fn compress(
        self,
        cancel: &Cancel,
        values: &[f64],
        n: usize,
        extent: [usize; 3],
    ) -> Result<Vec<u8>, Cancelled> {
        let [width, height, _] = extent;
        let blocks: Vec<usize> = (0..self.bytes(extent).unwrap_or(0) / self.block_bytes()).collect();
        let value =
            |texel: usize, c: usize| values.get(texel * n + c).copied().filter(|_| c < n).unwrap_or(0.0);
        let encoded: Result<Vec<Vec<u8>>, Cancelled> = blocks
            .par_iter()
            .map(|&block| {
                cancel.check()?;
                let mut texels = [[0.0; 3]; TEXELS];
                for (i, texel) in texels.iter_mut().enumerate() {
                    let [x, y, row] = place(block, i, [width, height]);
                    let at = row + y.min(height - 1) * width + x.min(width - 1);
                    for (c, v) in texel.iter_mut().enumerate() {
                        *v = value(at, c);
                    }
                }
                Ok(self.encode(&texels, n))
            })
            .collect();
        Ok(encoded?.concat())
    }

    /// Nothing asks for it without the feature: [`Storage::is_written`].
    #[cfg(not(feature = "blocks"))]
    fn encode(self, _: &[[f64; 3]; TEXELS], _: usize) -> Vec<u8> {
        vec![0; self.block_bytes()]
    }

    #[cfg(feature = "blocks")]
    fn encode(self, texels: &[[f64; 3]; TEXELS], n: usize) -> Vec<u8> {
        match self {
            Kind::Ramps(channels) => {
                (0..channels).flat_map(|c| ramp::encode(&texels.map(|t| t[c]))).collect()
            }
            Kind::Bc6h { signed } => bc6h_search::encode(texels, n, signed).to_vec(),
        }
    }

    fn decode(self, block: &[u8]) -> [[f64; 3]; TEXELS] {
        let mut texels = [[0.0; 3]; TEXELS];
        match self {
            Kind::Ramps(_) => {
                for (c, bytes) in block.chunks_exact(8).enumerate().take(3) {
                    let codes = bytes.try_into().map_or([0.0; TEXELS], ramp::decode);
                    for (texel, code) in texels.iter_mut().zip(codes) {
                        texel[c] = code;
                    }
                }
            }
            Kind::Bc6h { signed } => {
                if let Ok(bytes) = block.try_into() {
                    texels = bc6h::decode(bytes, signed);
                }
            }
        }
        texels
    }

    /// What the blocks of a picture decode to: a list for each channel.
    pub(super) fn expand(self, bytes: &[u8], extent: [usize; 3]) -> Vec<Vec<f64>> {
        let [width, height, slices] = extent;
        let mut planes = vec![vec![0.0; width * height * slices]; self.channels()];
        for (block, bytes) in bytes.chunks_exact(self.block_bytes()).enumerate() {
            for (i, texel) in self.decode(bytes).iter().enumerate() {
                let [x, y, row] = place(block, i, [width, height]);
                if x >= width || y >= height {
                    continue;
                }
                for (plane, v) in planes.iter_mut().zip(texel) {
                    if let Some(slot) = plane.get_mut(row + y * width + x) {
                        *slot = *v;
                    }
                }
            }
        }
        planes
    }

    /// A value as the only one of its block.
    pub(super) fn uniform_block(self, value: f64) -> f64 {
        self.decode(&self.encode(&[[value; 3]; TEXELS], 1))[0][0]
    }
}

/// Column and row of texel `i` of a block, and the first texel of its slice.
fn place(block: usize, i: usize, [width, height]: [usize; 2]) -> [usize; 3] {
    let across = width.div_ceil(SIDE).max(1);
    let a_slice = across * height.div_ceil(SIDE).max(1);
    let (slice, block) = (block / a_slice, block % a_slice);
    let (x, y) = (block % across * SIDE + i % SIDE, block / across * SIDE + i / SIDE);
    [x, y, slice * width * height]
}
