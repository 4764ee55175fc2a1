//! KTX2: 2D, volume or array; 1 to 4 components; half, float, unorm, packed words, blocks; Zstandard if asked for.
//!
//! | storage | Vulkan format |
//! |---|---|
//! | `half` | R16, R16G16, R16G16B16, R16G16B16A16 SFLOAT |
//! | `float` | R32 ... R32G32B32A32 SFLOAT |
//! | `unorm8`, `unorm16` | R8 ... R8G8B8A8, R16 ... R16G16B16A16 UNORM |
//! | `rgbd` | R8G8B8A8 UNORM; alpha is the divisor |
//! | `rgb10a2` | A2B10G10R10 UNORM PACK32 |
//! | `r11g11b10` | B10G11R11 UFLOAT PACK32 |
//! | `rgb9e5` | E5B9G9R9 UFLOAT PACK32 |
//! | `bc4`, `bc5` | BC4, BC5 UNORM BLOCK |
//! | `bc6h`, `bc6h-signed` | BC6H UFLOAT, SFLOAT BLOCK |
//!
//! A table with three axes is a volume, with option `layers` an array; one with four is always an array, since nothing
//! filters across the fourth. Few GPUs and no web engine sample three components: such a table gets a fourth, which is 1 (see the
//! fill options), unless option `rgb` asks for three. `rgba` makes four of any number.
//!
//! A table has one level; a pyramid ([`super::mips`]) has all of its own, the smallest first in the file, as the format demands. The keys are `KTXorientation` (`rd`, `rdi` for a volume: down and away), `KTXwriter`,
//! `KTXwriterScParams` if it is supercompressed, and `brdfbake`, the provenance as JSON text. Values end with a NUL, as
//! those of the format's own keys do. The descriptor is that of [`super`]'s `dfd`.
//!
//! Tables that name the same file become the layers of an array, and `brdfbake` a list.
//!
//! Source: KTX File Format Specification 2.0.4, sections 2 and 3. Zstandard is level 19; the bytes then depend on the
//! version of its library, the values do not.

use super::ktx2_read;
use super::mips::Mips;
use super::{EncodeError, EncodeInput, Encoder, FileOption, Image, ReadError, Shape, Storage, dfd, texels};
use crate::cancel::Cancel;
use crate::grid::provenance::ATTRIBUTE;
use std::borrow::Cow;

/// The container. See the module.
#[derive(Debug, Clone, Copy)]
pub struct Ktx2;

pub(super) const MAGIC: &[u8] = b"\xabKTX 20\xbb\r\n\x1a\n";

/// Length of the header and the index, without the level index.
const HEAD: usize = 80;

/// Supercompression scheme Zstandard.
pub(super) const SCHEME_ZSTD: u32 = 2;

#[cfg(feature = "zstd")]
const LEVEL: i32 = 19;

/// Bytes that are compressed between two looks at the token: a tenth of a second.
#[cfg(feature = "zstd")]
const PIECE: usize = 1 << 16;

impl Encoder for Ktx2 {
    fn id(&self) -> &'static str {
        "ktx2"
    }

    fn extension(&self) -> &'static str {
        "ktx2"
    }

    fn media_type(&self) -> &'static str {
        "image/ktx2"
    }

    fn storages(&self) -> &'static [Storage] {
        texels::ON_GPUS
    }

    fn options(&self) -> &'static [FileOption] {
        use FileOption::{FillOne, FillZero, Layers, Rgb, Rgba};
        #[cfg(feature = "zstd")]
        return &[Rgba, Rgb, FillZero, FillOne, Layers, FileOption::Zstd];
        #[cfg(not(feature = "zstd"))]
        return &[Rgba, Rgb, FillZero, FillOne, Layers];
    }

    fn most_channels(&self) -> usize {
        4
    }

    fn components(&self, shape: &Shape<'_>) -> usize {
        let wanted = match shape.channels {
            _ if shape.has(FileOption::Rgba) => 4,
            3 if !shape.has(FileOption::Rgb) => 4,
            n => n,
        };
        texels::packed(shape.storage).unwrap_or(wanted)
    }

    fn colours(&self, _count: usize) -> &'static [&'static str] {
        super::COLOURS
    }

    fn magic(&self) -> &'static [&'static [u8]] {
        &[MAGIC]
    }

    fn read(&self, bytes: &[u8], cancel: &Cancel) -> Result<Image, ReadError> {
        ktx2_read::read(bytes, 0, cancel)
    }

    fn read_level(&self, bytes: &[u8], level: usize, cancel: &Cancel) -> Result<Image, ReadError> {
        ktx2_read::read(bytes, level, cancel)
    }

    fn joins(&self) -> bool {
        true
    }

    /// One array, table after table; the key `brdfbake` is then a list of their provenances.
    fn encode_together(&self, tables: &[EncodeInput<'_>]) -> Result<Vec<u8>, EncodeError> {
        let all: Vec<Parts<'_>> = tables.iter().map(Parts::new).collect::<Result<_, _>>()?;
        let fault = "tables in one file become layers of an array: all of one size, storage and options, without a third axis";
        let alike = |p: &Parts<'_>| all.first().is_some_and(|first| p.is_like(first)) && p.is_flat();
        let Some(first) = all.first().filter(|_| all.iter().all(alike)) else {
            return Err(EncodeError::Axes { format: self.id(), fault });
        };
        let texts: Vec<&str> = all.iter().map(|p| p.provenance.as_ref()).collect();
        let together = Parts {
            layers: all.len(),
            provenance: format!("[{}]", texts.join(",")).into(),
            levels: vec![all.iter().flat_map(|p| p.levels.concat()).collect()],
            ..*first
        };
        together.write()
    }

    fn mip_storages(&self) -> &'static [Storage] {
        &super::mips::TEXTURES
    }

    fn encode_mips(&self, mips: &Mips<'_>) -> Result<Vec<Vec<u8>>, EncodeError> {
        self::mips(mips, mips.packed(mips.components())?).map(|bytes| vec![bytes])
    }

    fn encode(&self, input: &EncodeInput<'_>) -> Result<Vec<u8>, EncodeError> {
        Parts::new(input)?.write()
    }
}

/// What a file holds.
struct Parts<'a> {
    storage: Storage,
    /// Components as written.
    components: usize,
    size: [usize; 2],
    /// Slices of a volume, layers of an array; 0 for none.
    depth: usize,
    layers: usize,
    zstd: bool,
    provenance: Cow<'a, str>,
    /// The bytes of each level, the largest first.
    levels: Vec<Vec<u8>>,
    cancel: &'a Cancel,
}

impl<'a> Parts<'a> {
    fn new(input: &EncodeInput<'a>) -> Result<Parts<'a>, EncodeError> {
        input.check(&Ktx2)?;
        let shape = input.shape();
        let components = Ktx2.components(&shape);
        let pixels = texels::pack(input, components)?;
        // RGBD is four bytes a pixel, whatever its components
        let written = if input.storage == Storage::Rgbd { 4 } else { components };
        let [width, height, slices] = shape.extent();
        Ok(Parts {
            storage: input.storage,
            components: written,
            size: [width, height],
            depth: if shape.is_volume() { slices } else { 0 },
            layers: shape.layers().unwrap_or(0),
            zstd: shape.has(FileOption::Zstd),
            provenance: input.label.provenance_json.into(),
            levels: vec![pixels],
            cancel: input.cancel,
        })
    }

    fn is_like(&self, other: &Parts<'_>) -> bool {
        let kind = |p: &Parts<'_>| (p.storage, p.components, p.size, p.zstd);
        kind(self) == kind(other)
    }

    /// A picture with no slices.
    fn is_flat(&self) -> bool {
        self.depth == 0 && self.layers == 0
    }

    fn write(&self) -> Result<Vec<u8>, EncodeError> {
        let descriptor = dfd::descriptor(self.storage, self.components);
        let keys = self.keys();
        let head = HEAD + 24 * self.levels.len();
        let [width, height] = self.size;
        let too_large = || EncodeError::Size { format: "ktx2", width, height, limit: 1 << 26 };
        let word = |n: usize| u32::try_from(n).map_err(|_| too_large());
        let mut out = MAGIC.to_vec();
        let format = vk_format(self.storage, self.components);
        let [depth, layers, levels] = [word(self.depth)?, word(self.layers)?, word(self.levels.len())?];
        for n in [format, type_size(self.storage), word(width)?, word(height)?, depth, layers] {
            out.extend(n.to_le_bytes());
        }
        // one face
        for n in [1, levels, if self.zstd { SCHEME_ZSTD } else { 0 }] {
            out.extend(n.to_le_bytes());
        }
        for n in [head, descriptor.len(), head + descriptor.len(), keys.len()] {
            out.extend(word(n)?.to_le_bytes());
        }
        out.extend([0; 16]);
        let (index, data) = self.data(head + descriptor.len() + keys.len())?;
        for n in index.into_iter().flatten() {
            out.extend((n as u64).to_le_bytes());
        }
        out.extend(descriptor);
        out.extend(keys);
        out.extend(data);
        Ok(out)
    }

    /// The level index (offset, length, length unpacked; the largest level first), and what follows the `start` bytes of the head: the
    /// levels, the smallest first.
    fn data(&self, start: usize) -> Result<(Vec<[usize; 3]>, Vec<u8>), EncodeError> {
        // data that is not supercompressed begins at a multiple of its texel and of 4
        let texel = texels::size(self.storage, self.components);
        let align = if self.zstd { 1 } else { lcm(texel, 4) };
        let (mut index, mut out) = (Vec::new(), Vec::new());
        for pixels in self.levels.iter().rev() {
            let at = (start + out.len()).next_multiple_of(align);
            out.resize(at - start, 0);
            let packed = if self.zstd { compress(pixels, self.cancel)? } else { pixels.clone() };
            index.push([at, packed.len(), pixels.len()]);
            out.extend(packed);
        }
        index.reverse();
        Ok((index, out))
    }

    /// Key/value data, sorted by key, every entry padded to 4 bytes.
    fn keys(&self) -> Vec<u8> {
        let writer = format!("brdfbake {}", env!("CARGO_PKG_VERSION"));
        let mut entries = vec![
            ("KTXorientation", if self.depth > 0 { "rdi" } else { "rd" }),
            ("KTXwriter", writer.as_str()),
        ];
        if self.zstd {
            entries.push(("KTXwriterScParams", "--zstd 19"));
        }
        entries.push((ATTRIBUTE, self.provenance.as_ref()));
        let mut out = Vec::new();
        for (key, value) in entries {
            let length = u32::try_from(key.len() + value.len() + 2).unwrap_or(0);
            out.extend(length.to_le_bytes());
            out.extend([key.as_bytes(), &[0], value.as_bytes(), &[0]].concat());
            out.resize(out.len().next_multiple_of(4), 0);
        }
        out
    }
}

/// A pyramid of packed levels.
fn mips(mips: &Mips<'_>, levels: Vec<Vec<u8>>) -> Result<Vec<u8>, EncodeError> {
    let parts = Parts {
        storage: mips.storage,
        components: mips.components(),
        size: mips.levels.first().map_or([1, 1], |l| l.size),
        depth: 0,
        layers: 0,
        zstd: false,
        provenance: mips.provenance_json.into(),
        levels,
        cancel: mips.cancel,
    };
    parts.write()
}

/// `VkFormat` of a storage.
fn vk_format(storage: Storage, components: usize) -> u32 {
    let of = |formats: [u32; 4]| formats.get(components.wrapping_sub(1)).copied().unwrap_or(0);
    match storage {
        Storage::Half => of([76, 83, 90, 97]),
        Storage::Float => of([100, 103, 106, 109]),
        Storage::Unorm8 | Storage::Rgbd => of([9, 16, 23, 37]),
        Storage::Unorm16 => of([70, 77, 84, 91]),
        Storage::Rgb10a2 => 64,
        Storage::R11g11b10 => 122,
        Storage::Rgb9e5 => 123,
        Storage::Bc4 => 139,
        Storage::Bc5 => 141,
        Storage::Bc6h => 143,
        Storage::Bc6hSigned => 144,
        Storage::Double | Storage::Rgbe => 0,
    }
}

/// Storage and components of a `VkFormat`.
pub(super) fn storage(format: u32) -> Option<(Storage, usize)> {
    let all = Ktx2.storages().iter().filter(|s| **s != Storage::Rgbd);
    all.flat_map(|&s| (1..=4).map(move |n| (s, texels::packed(s).unwrap_or(n))))
        .find(|&(s, n)| vk_format(s, n) == format)
}

/// Size in bytes of the words that depend on byte order; 1 for block-compressed formats, as the specification has it.
const fn type_size(storage: Storage) -> u32 {
    match storage {
        _ if storage.is_block() => 1,
        Storage::Half | Storage::Unorm16 => 2,
        Storage::Unorm8 | Storage::Rgbd | Storage::Rgbe => 1,
        _ => 4,
    }
}

const fn lcm(a: usize, b: usize) -> usize {
    let (mut x, mut y) = (a, b);
    while y > 0 {
        (x, y) = (y, x % y);
    }
    a / x * b
}

#[cfg(feature = "zstd")]
fn compress(bytes: &[u8], cancel: &Cancel) -> Result<Vec<u8>, EncodeError> {
    use std::io::Write;
    let library = |e: std::io::Error| EncodeError::Library { format: "ktx2", source: Box::new(e) };
    let mut encoder = zstd::stream::write::Encoder::new(Vec::new(), LEVEL).map_err(library)?;
    encoder.set_pledged_src_size(Some(bytes.len() as u64)).map_err(library)?;
    for piece in bytes.chunks(PIECE) {
        cancel.check()?;
        encoder.write_all(piece).map_err(library)?;
    }
    encoder.finish().map_err(library)
}

/// Not offered without the library: see [`Ktx2::options`].
#[cfg(not(feature = "zstd"))]
fn compress(_: &[u8], _: &Cancel) -> Result<Vec<u8>, EncodeError> {
    Err(EncodeError::Feature { what: "zstd", feature: "zstd" })
}
