//! Pyramids of pictures to files: KTX2 and DDS with all levels, EXR mip maps, a PNG for each level.
//!
//! Channels are numbers of a range that they tell, as in tables. KTX2 and DDS hold 1, 2 or 4 components a texel (few graphics
//! processors sample three of 8 or 16 bits); a component without channel is 0, alpha is 1. Nothing is ever marked sRGB.

use super::blocks::Kind;
use super::{ENCODERS, EncodeError, Encoder, Storage, texels};
use crate::cancel::Cancel;
use crate::grid::Channel;
use rayon::prelude::*;

/// One level, before it is rounded.
#[derive(Debug, Clone, PartialEq)]
pub struct MipLevel {
    /// Width and height in texels.
    pub size: [usize; 2],
    /// Values, `[texel][channel]`, rows from the top.
    pub values: Vec<f32>,
}

/// A pyramid and what its channels mean.
#[derive(Debug, Clone, Copy)]
pub struct Mips<'a> {
    /// What they hold.
    pub channels: &'a [Channel],
    /// All levels, the largest first.
    pub levels: &'a [MipLevel],
    /// How a number is stored.
    pub storage: Storage,
    /// The provenance as JSON text.
    pub provenance_json: &'a str,
    /// The bytes of each level, as [`blocks`] makes them, if the storage is made of blocks and they are known; empty otherwise.
    pub blocks: &'a [Vec<u8>],
    /// Hash that leads to the entry of the manifest, for containers without metadata: 64 hexadecimal digits.
    pub identity: &'a str,
    /// Set from outside to stop.
    pub cancel: &'a Cancel,
}

/// Containers of pyramids: those of [`ENCODERS`] that take them.
pub fn containers() -> impl Iterator<Item = &'static dyn Encoder> + Clone {
    ENCODERS.iter().copied().filter(|e| !e.mip_storages().is_empty())
}

/// Storages of pyramids in containers of textures.
pub(super) static TEXTURES: [Storage; 6] =
    [Storage::Unorm8, Storage::Unorm16, Storage::Half, Storage::Float, Storage::Bc4, Storage::Bc5];

/// Most channels of a pyramid in a storage.
#[must_use]
pub fn most_channels(storage: Storage) -> usize {
    match storage {
        Storage::Bc4 => 1,
        Storage::Bc5 => 2,
        _ => 4,
    }
}

/// Checks what does not depend on the values: that the container takes the storage, and the storage so many channels.
///
/// # Errors
/// [`EncodeError::Unknown`] and [`EncodeError::Channels`].
pub fn check(encoder: &dyn Encoder, storage: Storage, count: usize) -> Result<(), EncodeError> {
    if !encoder.mip_storages().contains(&storage) {
        return Err(EncodeError::Unknown { id: format!("{}:{}", encoder.id(), storage.id()) });
    }
    let limit = most_channels(storage);
    if count == 0 || count > limit {
        return Err(EncodeError::Channels { format: encoder.id(), storage: storage.id(), count, limit });
    }
    Ok(())
}

/// The files of a pyramid in a container: what stands between the name and the end (`.ktx2`, `.mip0.png`), and the bytes.
///
/// # Errors
/// As [`check`], or for a value that has no stored form.
pub fn encode(encoder: &dyn Encoder, mips: &Mips<'_>) -> Result<Vec<(String, Vec<u8>)>, EncodeError> {
    check(encoder, mips.storage, mips.channels.len())?;
    let files = encoder.encode_mips(mips)?;
    let ends = ends(encoder, mips.levels.len());
    Ok(ends.into_iter().zip(files).collect())
}

/// What stands behind the name in the names of the files of a pyramid of so many levels.
#[must_use]
pub fn ends(encoder: &dyn Encoder, levels: usize) -> Vec<String> {
    let extension = encoder.extension();
    if encoder.holds_all_levels() {
        return vec![format!(".{extension}")];
    }
    (0..levels).map(|k| format!(".mip{k}.{extension}")).collect()
}

/// The bytes of every level in a storage of blocks; none in another.
///
/// # Errors
/// [`EncodeError`] for a value that has no stored form.
pub fn blocks(mips: &Mips<'_>) -> Result<Vec<Vec<u8>>, EncodeError> {
    if mips.storage.is_block() { mips.packed(mips.components()) } else { Ok(Vec::new()) }
}

impl Mips<'_> {
    /// Components of a texel in KTX2 and DDS.
    pub(super) fn components(&self) -> usize {
        match (self.storage, self.channels.len()) {
            (Storage::Bc4 | Storage::Bc5, n) => texels::packed(self.storage).unwrap_or(n),
            (_, 3) => 4,
            (_, n) => n,
        }
    }

    /// The range of a channel.
    fn range(&self, c: usize) -> [f64; 2] {
        self.channels.get(c).map_or([0.0, 1.0], |channel| channel.range)
    }

    /// The bytes of every level.
    pub(super) fn packed(&self, components: usize) -> Result<Vec<Vec<u8>>, EncodeError> {
        if self.storage.is_block() && self.blocks.len() == self.levels.len() {
            return Ok(self.blocks.to_vec());
        }
        self.levels.iter().map(|level| self.pack(level, components)).collect()
    }

    fn pack(&self, level: &MipLevel, components: usize) -> Result<Vec<u8>, EncodeError> {
        let n = self.channels.len();
        let expected = level.size[0] * level.size[1];
        if level.values.len() != expected * n {
            return Err(EncodeError::Count { got: level.values.len(), texels: expected, channels: n });
        }
        if !self.storage.is_written() {
            return Err(EncodeError::Feature { what: self.storage.id(), feature: "blocks" });
        }
        let row = level.size[0] * n;
        let rows = level.values.par_chunks(row.max(1)).enumerate();
        if let Some(kind) = Kind::of(self.storage) {
            let codes: Result<Vec<Vec<f64>>, EncodeError> = rows
                .map(|(y, row)| {
                    let code = |(i, v): (usize, &f32)| {
                        let fault = |_| self.fault(level, y, i, *v);
                        self.storage.position(f64::from(*v), self.range(i % n)).map_err(fault)
                    };
                    row.iter().enumerate().map(code).collect()
                })
                .collect();
            return Ok(kind.compress(self.cancel, &codes?.concat(), n, [level.size[0], level.size[1], 1])?);
        }
        let one = if self.storage == Storage::Unorm8 { 255.0 } else { 65535.0 };
        let one = if self.storage.is_bounded() { one } else { 1.0 };
        let bytes: Result<Vec<Vec<u8>>, EncodeError> = rows
            .map(|(y, row)| {
                self.cancel.check()?;
                let mut bytes = Vec::with_capacity(row.len() * 4);
                let mut codes = vec![0.0; components];
                for (x, texel) in row.chunks_exact(n).enumerate() {
                    for (c, code) in codes.iter_mut().enumerate() {
                        *code = match texel.get(c) {
                            Some(v) => {
                                let fault = |_| self.fault(level, y, x * n + c, *v);
                                let v = self.storage.quantise(f64::from(*v), self.range(c)).map_err(fault)?;
                                self.storage.code(v, self.range(c)).unwrap_or(v)
                            }
                            None if c == 3 => one,
                            None => 0.0,
                        };
                    }
                    texels::put(self.storage, &codes, &mut bytes);
                }
                Ok(bytes)
            })
            .collect();
        Ok(bytes?.concat())
    }

    fn fault(&self, level: &MipLevel, y: usize, i: usize, value: f32) -> EncodeError {
        let n = self.channels.len();
        EncodeError::NotQuantised {
            texel: y * level.size[0] + i / n,
            channel: self.channels[i % n].id.clone(),
            value: f64::from(value),
            storage: self.storage.id(),
        }
    }
}

/// A level as a reader will see it, `[texel][channel]`. A level that is not there has no values.
///
/// # Errors
/// As [`encode`].
#[allow(clippy::cast_possible_truncation, reason = "stored numbers have at most 24 digits")]
pub fn stored(mips: &Mips<'_>, k: usize) -> Result<Vec<f32>, EncodeError> {
    let n = mips.channels.len();
    let Some(level) = mips.levels.get(k) else { return Ok(Vec::new()) };
    if mips.storage.is_block() {
        let made;
        let bytes = match mips.blocks.get(k) {
            Some(bytes) => bytes,
            None => {
                made = mips.pack(level, n)?;
                &made
            }
        };
        let values = mips.storage.expand(bytes, [level.size[0], level.size[1], 1], n, |c| mips.range(c));
        return Ok(values.into_iter().map(|v| v as f32).collect());
    }
    let value = |(i, v): (usize, &f32)| {
        let fault = |_| mips.fault(level, 0, i, *v);
        Ok(mips.storage.quantise(f64::from(*v), mips.range(i % n)).map_err(fault)? as f32)
    };
    level.values.iter().enumerate().map(value).collect()
}
