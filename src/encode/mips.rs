//! Pyramids of pictures to files: KTX2 and DDS with all levels, EXR mip maps, a PNG for each level.
//!
//! Channels are numbers of a range that they tell, as in tables. KTX2 and DDS hold 1, 2 or 4 components a texel (few graphics
//! processors sample three of 8 or 16 bits); a component without channel is 0, alpha is 1. Nothing is ever marked sRGB.

use super::blocks::Kind;
use super::{EncodeError, Storage, dds, exr, ktx2, png, texels};
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
    /// Hash that leads to the entry of the manifest, for containers without metadata: 64 hexadecimal digits.
    pub identity: &'a str,
    /// Set from outside to stop.
    pub cancel: &'a Cancel,
}

/// Containers of pyramids.
pub const CONTAINERS: [&str; 4] = ["ktx2", "dds", "exr", "png"];

/// Storages of pyramids that a container takes.
#[must_use]
pub fn storages(container: &str) -> &'static [Storage] {
    match container {
        "ktx2" | "dds" => {
            &[Storage::Unorm8, Storage::Unorm16, Storage::Half, Storage::Float, Storage::Bc4, Storage::Bc5]
        }
        "exr" => &[Storage::Half, Storage::Float],
        "png" => &[Storage::Unorm8, Storage::Unorm16],
        _ => &[],
    }
}

/// The files of a pyramid in a container: what stands between the name and the end (`.ktx2`, `.mip0.png`), and the bytes.
///
/// # Errors
/// [`EncodeError`] for a container or storage that does not go with it, or a value that has no stored form.
pub fn encode(container: &str, mips: &Mips<'_>) -> Result<Vec<(String, Vec<u8>)>, EncodeError> {
    let id = || EncodeError::Unknown { id: format!("{container}:{}", mips.storage.id()) };
    if !storages(container).contains(&mips.storage) {
        return Err(id());
    }
    let limit = match mips.storage {
        Storage::Bc4 => 1,
        Storage::Bc5 => 2,
        _ => 4,
    };
    let (count, format) =
        (mips.channels.len(), CONTAINERS.into_iter().find(|c| *c == container).unwrap_or("ktx2"));
    if count == 0 || count > limit {
        return Err(EncodeError::Channels { format, storage: mips.storage.id(), count, limit });
    }
    let whole = |bytes| vec![(format!(".{container}"), bytes)];
    match container {
        "ktx2" => ktx2::mips(mips, mips.packed(mips.components())?).map(whole),
        "dds" => dds::mips(mips, &mips.packed(mips.components())?).map(whole),
        "exr" => exr::mips(mips).map(whole),
        _ => {
            let components = if count == 2 { 3 } else { count };
            let levels = mips.packed(components)?.into_iter().zip(mips.levels).enumerate();
            let file = |(k, (bytes, level)): (usize, (Vec<u8>, &MipLevel))| {
                Ok((format!(".mip{k}.png"), png::level(mips, level.size, components, bytes)?))
            };
            levels.map(file).collect()
        }
    }
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
    fn packed(&self, components: usize) -> Result<Vec<Vec<u8>>, EncodeError> {
        self.levels.iter().map(|level| self.pack(level, components)).collect()
    }

    fn pack(&self, level: &MipLevel, components: usize) -> Result<Vec<u8>, EncodeError> {
        let n = self.channels.len();
        let expected = level.size[0] * level.size[1];
        if level.values.len() != expected * n {
            return Err(EncodeError::Count { got: level.values.len(), texels: expected, channels: n });
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

/// A level as a reader will see it, `[texel][channel]`.
///
/// # Errors
/// As [`encode`].
#[allow(clippy::cast_possible_truncation, reason = "stored numbers have at most 24 digits")]
pub fn stored(mips: &Mips<'_>, level: &MipLevel) -> Result<Vec<f32>, EncodeError> {
    let n = mips.channels.len();
    if mips.storage.is_block() {
        let bytes = mips.pack(level, n)?;
        let values = mips.storage.expand(&bytes, [level.size[0], level.size[1], 1], n, |c| mips.range(c));
        return Ok(values.into_iter().map(|v| v as f32).collect());
    }
    let value = |(i, v): (usize, &f32)| {
        let fault = |_| mips.fault(level, 0, i, *v);
        Ok(mips.storage.quantise(f64::from(*v), mips.range(i % n)).map_err(fault)? as f32)
    };
    level.values.iter().enumerate().map(value).collect()
}
