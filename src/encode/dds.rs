//! DDS with the DX10 header: 2D, volume or array; half, float, unorm, packed words, blocks.
//!
//! | storage | DXGI format (one, two, four components) |
//! |---|---|
//! | `half` | R16, R16G16, R16G16B16A16 FLOAT |
//! | `float` | R32, R32G32, R32G32B32 (three), R32G32B32A32 FLOAT |
//! | `unorm8`, `unorm16` | R8 ... R8G8B8A8, R16 ... R16G16B16A16 UNORM |
//! | `rgbd` | R8G8B8A8 UNORM; alpha is the divisor |
//! | `rgb10a2` | R10G10B10A2 UNORM |
//! | `r11g11b10` | R11G11B10 FLOAT |
//! | `rgb9e5` | R9G9B9E5 SHAREDEXP |
//! | `bc4`, `bc5` | BC4, BC5 UNORM (one, two channels) |
//! | `bc6h`, `bc6h-signed` | BC6H UF16, SF16 (up to three) |
//!
//! DXGI has no three components of 8 or 16 bits: such a table gets a fourth, which is 1 (see the fill options). A table
//! with three axes is a volume, with option `layers` an array; one with four is always an array.
//!
//! The format has no place for metadata. The first reserved words of the header, which all loaders skip, hold
//! `brdfbake` and the 32 bytes of the recipe's hash, which leads to the entry of `manifest.json`.
//!
//! Source: Microsoft, "DDS_HEADER structure" and "DDS_HEADER_DXT10 structure" of the DDS programming guide.

use super::mips::Mips;
use super::{EncodeError, EncodeInput, Encoder, FileOption, Image, ReadError, Shape, Storage, texels};
use crate::cancel::Cancel;
use crate::grid::provenance::ATTRIBUTE;

/// The container. See the module.
#[derive(Debug, Clone, Copy)]
pub struct Dds;

pub(super) const MAGIC: &[u8] = b"DDS ";
/// Magic, header, DX10 header.
pub(super) const HEAD: usize = 4 + 124 + 20;

/// `DDSD_CAPS | DDSD_HEIGHT | DDSD_WIDTH | DDSD_PIXELFORMAT`.
const FLAGS: u32 = 0x1 | 0x2 | 0x4 | 0x1000;
/// `DDSD_PITCH`: bytes of a row. `DDSD_LINEARSIZE`: bytes of a slice, of formats made of blocks.
const FLAG_PITCH: u32 = 0x8;
const FLAG_SIZE: u32 = 0x8_0000;
/// `DDSD_MIPMAPCOUNT`.
const FLAG_LEVELS: u32 = 0x2_0000;
const FLAG_DEPTH: u32 = 0x80_0000;
/// `DDPF_FOURCC`.
const FOURCC: u32 = 0x4;
/// `DDSCAPS_TEXTURE`, `DDSCAPS_COMPLEX`.
const TEXTURE: u32 = 0x1000;
const COMPLEX: u32 = 0x8;
/// `DDSCAPS_MIPMAP`.
const LEVELS: u32 = 0x40_0000;
/// `DDSCAPS2_VOLUME`.
const CAPS2_VOLUME: u32 = 0x20_0000;
/// `D3D10_RESOURCE_DIMENSION_TEXTURE2D`, `_TEXTURE3D`.
pub(super) const TEXTURE2D: u32 = 3;
pub(super) const TEXTURE3D: u32 = 4;

impl Encoder for Dds {
    fn id(&self) -> &'static str {
        "dds"
    }

    fn extension(&self) -> &'static str {
        "dds"
    }

    fn media_type(&self) -> &'static str {
        "image/vnd-ms.dds"
    }

    fn storages(&self) -> &'static [Storage] {
        texels::ON_GPUS
    }

    fn options(&self) -> &'static [FileOption] {
        &[FileOption::Rgba, FileOption::FillZero, FileOption::FillOne, FileOption::Layers]
    }

    fn most_channels(&self) -> usize {
        4
    }

    fn components(&self, shape: &Shape<'_>) -> usize {
        let wanted = match shape.channels {
            _ if shape.has(FileOption::Rgba) => 4,
            3 if shape.storage != Storage::Float => 4,
            n => n,
        };
        texels::packed(shape.storage).unwrap_or(wanted)
    }

    fn holds_metadata(&self) -> bool {
        false
    }

    fn colours(&self, _count: usize) -> &'static [&'static str] {
        super::COLOURS
    }

    fn magic(&self) -> &'static [&'static [u8]] {
        &[MAGIC]
    }

    fn read(&self, bytes: &[u8], cancel: &Cancel) -> Result<Image, ReadError> {
        super::dds_read::read(bytes, 0, cancel)
    }

    fn read_level(&self, bytes: &[u8], level: usize, cancel: &Cancel) -> Result<Image, ReadError> {
        super::dds_read::read(bytes, level, cancel)
    }

    fn mip_storages(&self) -> &'static [Storage] {
        &super::mips::TEXTURES
    }

    fn encode_mips(&self, mips: &Mips<'_>) -> Result<Vec<Vec<u8>>, EncodeError> {
        self::mips(mips, &mips.packed(mips.components())?).map(|bytes| vec![bytes])
    }

    fn encode(&self, input: &EncodeInput<'_>) -> Result<Vec<u8>, EncodeError> {
        input.check(self)?;
        let shape = input.shape();
        let components = self.components(&shape);
        let pixels = texels::pack(input, components)?;
        let [width, height, slices] = shape.extent();
        let head = Head {
            storage: input.storage,
            components,
            size: [width, height],
            depth: shape.is_volume().then_some(slices),
            layers: shape.layers().unwrap_or(1),
            levels: 1,
            identity: input.label.identity,
        };
        Ok([head.write()?, pixels].concat())
    }
}

/// A pyramid of packed levels, the largest first, as the format has it.
fn mips(mips: &Mips<'_>, levels: &[Vec<u8>]) -> Result<Vec<u8>, EncodeError> {
    let head = Head {
        storage: mips.storage,
        components: mips.components(),
        size: mips.levels.first().map_or([1, 1], |l| l.size),
        depth: None,
        layers: 1,
        levels: levels.len(),
        identity: mips.identity,
    };
    Ok([head.write()?, levels.concat()].concat())
}

/// What the headers tell.
struct Head<'a> {
    storage: Storage,
    components: usize,
    size: [usize; 2],
    /// Slices of a volume.
    depth: Option<usize>,
    layers: usize,
    levels: usize,
    identity: &'a str,
}

impl Head<'_> {
    fn write(&self) -> Result<Vec<u8>, EncodeError> {
        let [width, height] = self.size;
        let size = EncodeError::Size { format: "dds", width, height, limit: 1 << 26 };
        let (volume, depth) = (self.depth.is_some(), self.depth.unwrap_or(1));
        let block = self.storage.is_block();
        let line = [width, if block { height } else { 1 }, 1];
        let pitch = texels::bytes(self.storage, self.components, line).unwrap_or(usize::MAX);
        let words = [pitch, width, height, depth, self.layers, self.levels].map(u32::try_from);
        let [Ok(pitch), Ok(width), Ok(height), Ok(depth), Ok(layers), Ok(levels)] = words else {
            return Err(size);
        };
        let several = depth > 1 || layers > 1 || levels > 1;
        let mut out = MAGIC.to_vec();
        let mut flags = FLAGS | if volume { FLAG_DEPTH } else { 0 };
        flags |= if block { FLAG_SIZE } else { FLAG_PITCH };
        flags |= if levels > 1 { FLAG_LEVELS } else { 0 };
        for n in [124, flags, height, width, pitch, depth, levels] {
            out.extend(n.to_le_bytes());
        }
        out.extend(reserved(self.identity));
        for n in [32, FOURCC, u32::from_le_bytes(*b"DX10"), 0, 0, 0, 0, 0] {
            out.extend(n.to_le_bytes());
        }
        let caps = TEXTURE | if several { COMPLEX } else { 0 } | if levels > 1 { LEVELS } else { 0 };
        for n in [caps, if volume { CAPS2_VOLUME } else { 0 }, 0, 0, 0] {
            out.extend(n.to_le_bytes());
        }
        let written = if self.storage == Storage::Rgbd { 4 } else { self.components };
        let dimension = if volume { TEXTURE3D } else { TEXTURE2D };
        for n in [dxgi(self.storage, written), dimension, 0, layers, 0] {
            out.extend(n.to_le_bytes());
        }
        Ok(out)
    }
}

/// Eleven reserved words: name of the program, identity of the table, a zero.
fn reserved(identity: &str) -> [u8; 44] {
    let mut words = [0; 44];
    words[..8].copy_from_slice(ATTRIBUTE.as_bytes());
    for (slot, pair) in words[8..40].iter_mut().zip(identity.as_bytes().chunks_exact(2)) {
        let digits = std::str::from_utf8(pair).unwrap_or_default();
        *slot = u8::from_str_radix(digits, 16).unwrap_or(0);
    }
    words
}

/// `DXGI_FORMAT` of a storage.
fn dxgi(storage: Storage, components: usize) -> u32 {
    let of = |formats: [u32; 4]| formats.get(components.wrapping_sub(1)).copied().unwrap_or(0);
    match storage {
        Storage::Half => of([54, 34, 0, 10]),
        Storage::Float => of([41, 16, 6, 2]),
        Storage::Unorm8 | Storage::Rgbd => of([61, 49, 0, 28]),
        Storage::Unorm16 => of([56, 35, 0, 11]),
        Storage::Rgb10a2 => 24,
        Storage::R11g11b10 => 26,
        Storage::Rgb9e5 => 67,
        Storage::Bc4 => 80,
        Storage::Bc5 => 83,
        Storage::Bc6h => 95,
        Storage::Bc6hSigned => 96,
        Storage::Double | Storage::Rgbe => 0,
    }
}

/// Storage and components of a `DXGI_FORMAT`.
pub(super) fn storage(format: u32) -> Option<(Storage, usize)> {
    let all = Dds.storages().iter().filter(|s| **s != Storage::Rgbd);
    all.flat_map(|&s| (1..=4).map(move |n| (s, texels::packed(s).unwrap_or(n))))
        .find(|&(s, n)| format > 0 && dxgi(s, n) == format)
}
