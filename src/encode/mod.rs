//! Tables to files and back: storages (bits of a number), containers (one file each), readers, comparison.
//!
//! A table is first rounded by [`quantise_table`]; an [`Encoder`] then only moves the rounded numbers into bytes, in
//! memory, and refuses a number that it would have to change. Storages of 4 x 4 texels cannot round one by one: their
//! bytes are made with the rounded numbers, and the encoder refuses bytes that do not decode to them. [`atomic::write_all`] puts finished files on disk.
//!
//! # Picture layout
//! Axis 0 runs along x, axis 1 along y with index 0 in the top row. A third and fourth axis stack their slices below
//! each other: texel `(i, j, k)` is at `x = i, y = j + k len1`. A table with one axis is one row.
//!
//! # Channels
//! EXR channels carry the ids of the table (`dfg.scale`), or with option `positional` or `y` the names that loaders of colours know; EXR
//! sorts them by name, so readers look them up by name. PNG has no names: see [`png`] for the layouts.
//! # Example
//! ```
//! use brdfbake::cancel::Cancel;
//! use brdfbake::encode::{EncodeInput, Label, Storage, encoder, quantise_table, read};
//! use brdfbake::grid::{Axis, Channel, Grid, Quantity, Table, Texel};
//!
//! let mu = Quantity::find("mu").ok_or("no such quantity")?;
//! let table = Table {
//!     grid: Grid::new(vec![Axis::new(mu, 2, Texel::Center)])?,
//!     channels: vec![Channel { id: "albedo".into(), meaning: "E(mu)".into(), range: [0.0, 1.0], role: String::new() }],
//!     values: vec![0.1, 0.7],
//!     errors: vec![0.0; 2],
//!     evaluations: vec![1; 2],
//! };
//! let rounded = quantise_table(&table, Storage::Half)?;
//! let bytes = encoder("exr").ok_or("no such container")?.encode(&EncodeInput {
//!     grid: &table.grid,
//!     channels: &table.channels,
//!     values: &rounded.values,
//!     blocks: &rounded.blocks,
//!     errors: &[],
//!     storage: Storage::Half,
//!     options: &[],
//!     label: Label::default(),
//!     cancel: &Cancel::new(),
//! })?;
//! assert_eq!(read::read_bytes(&bytes)?.channels[0].values, rounded.values);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # A new container
//! One file, one `mod` line, one line in [`ENCODERS`].

mod apart;
pub mod atomic;
pub mod beside;
mod blocks;
pub(crate) mod code;
mod coding;
pub(crate) mod csv;
pub(crate) mod dds;
mod dds_masks;
mod dds_read;
mod dfd;
pub mod diff;
pub mod diff_files;
pub(crate) mod diff_json;
mod error;
pub(crate) mod exr;
mod exr_chunks;
mod exr_names;
mod exr_read;
pub(crate) mod hdr;
pub(crate) mod ktx2;
mod ktx2_read;
pub(crate) mod layout;
pub(crate) mod merl;
pub(crate) mod mips;
pub(crate) mod npy;
mod open;
pub mod option;
pub(crate) mod pfm;
pub(crate) mod png;
mod png_read;
mod quantise;
pub(crate) mod raw;
pub mod read;
mod stoppable;
pub(crate) mod storage;
mod texels;
pub(crate) mod text;

pub use apart::raw_rgbd;
pub use diff::{ChannelDiff, ImageDiff, Tolerance, Worst};
pub use diff_json::{JsonDiff, first_difference};
pub use error::EncodeError;
pub use layout::Layout;
pub use merl::Merl;
pub use mips::{MipLevel, Mips};
pub use option::{FILE_OPTIONS, FileOption, Shape};
pub use quantise::{Quantised, RangeFault, Unstored, quantise_table, quantise_table_until};
pub use read::{Image, ReadError};
pub use storage::{QuantiseError, STORAGES, Storage};

use crate::cancel::Cancel;
use crate::grid::{Channel, Grid};
use std::fmt::Debug;

/// A file format that holds a table.
pub trait Encoder: Debug + Send + Sync {
    /// Id in recipes: `exr`.
    fn id(&self) -> &'static str;
    /// File name extension, without the dot.
    fn extension(&self) -> &'static str;
    /// Media type of its files.
    fn media_type(&self) -> &'static str {
        "application/octet-stream"
    }
    /// What it can store.
    fn storages(&self) -> &'static [Storage];
    /// Options that it takes.
    fn options(&self) -> &'static [FileOption] {
        &[]
    }
    /// Most channels that it holds.
    fn most_channels(&self) -> usize;
    /// Components of a pixel that holds a table of this shape; those beyond its channels are filled.
    fn components(&self, shape: &Shape<'_>) -> usize {
        shape.channels
    }
    /// Names of the components in the file where they are not the ids of the channels; empty otherwise. Names beyond the channels and
    /// [`Shape::fill`] repeat the last channel.
    fn names(&self, shape: &Shape<'_>) -> &'static [&'static str] {
        let _ = shape;
        &[]
    }
    /// What its readers call the components of a pixel, of which there are `count`, where the file has no names for channels.
    fn colours(&self, count: usize) -> &'static [&'static str] {
        let _ = count;
        &[]
    }
    /// Checks the lengths of the axes.
    ///
    /// # Errors
    /// [`EncodeError::Size`] or another one that does not depend on the values.
    fn check_size(&self, shape: &Shape<'_>) -> Result<(), EncodeError> {
        let [width, height, slices] = shape.extent();
        let (height, limit) = (height * slices, 1 << 24);
        if width > limit || height > limit {
            return Err(EncodeError::Size { format: self.id(), width, height, limit });
        }
        Ok(())
    }
    /// Most bytes of a file with a table of this shape, without its metadata.
    fn most_bytes(&self, shape: &Shape<'_>) -> usize {
        texels::bytes(shape.storage, self.components(shape), shape.extent()).unwrap_or(usize::MAX)
    }
    /// Most memory that [`Encoder::encode`] takes, its result included and its input not: a bake is refused before it begins
    /// where that does not fit. It is checked by measuring (`tests/memory.rs`).
    fn most_memory(&self, shape: &Shape<'_>) -> usize {
        self.most_bytes(shape).saturating_mul(3)
    }
    /// True if the file has a place for the provenance.
    fn holds_metadata(&self) -> bool {
        true
    }
    /// True if the file is nothing but numbers: text may stand round them, and tables behind each other.
    fn is_bare(&self) -> bool {
        false
    }
    /// True if several tables can be in one file.
    fn joins(&self) -> bool {
        self.is_bare()
    }
    /// One file of several tables, in their order.
    ///
    /// # Errors
    /// [`EncodeError`] if they do not go together, or as [`Encoder::encode`] for one of them. Without [`Encoder::joins`] the result
    /// is no file of this kind.
    fn encode_together(&self, tables: &[EncodeInput<'_>]) -> Result<Vec<u8>, EncodeError> {
        let mut file = Vec::new();
        for table in tables {
            file.extend(self.encode(table)?);
        }
        Ok(file)
    }
    /// How its files begin; empty if they cannot be told apart or are not read.
    fn magic(&self) -> &'static [&'static [u8]] {
        &[]
    }
    /// Reads a file that begins with [`Encoder::magic`]. Stopped, the result is of no use ([`read::read_bytes_until`]
    /// looks at the token).
    ///
    /// # Errors
    /// [`ReadError`] for a file that is damaged or of a kind that is not supported.
    fn read(&self, bytes: &[u8], cancel: &Cancel) -> Result<Image, ReadError> {
        let _ = cancel;
        Err(ReadError::Unknown(bytes.iter().copied().take(8).collect()))
    }
    /// Reads a level of a file of all levels; 0 is the largest.
    ///
    /// # Errors
    /// As [`Encoder::read`], and for a level that is not in the file.
    fn read_level(&self, bytes: &[u8], level: usize, cancel: &Cancel) -> Result<Image, ReadError> {
        match level {
            0 => self.read(bytes, cancel),
            _ => Err(read::no_level(self.id(), level, 1)),
        }
    }
    /// Storages of pyramids (maps with levels) that it takes; none if it holds no pyramids.
    fn mip_storages(&self) -> &'static [Storage] {
        &[]
    }
    /// True if all levels of a pyramid are in one file.
    fn holds_all_levels(&self) -> bool {
        true
    }
    /// The files of a pyramid: one, or one a level without [`Encoder::holds_all_levels`]. [`mips::encode`] checks it before.
    ///
    /// # Errors
    /// [`EncodeError`] for a value that has no stored form, or a container without pyramids.
    fn encode_mips(&self, mips: &Mips<'_>) -> Result<Vec<Vec<u8>>, EncodeError> {
        Err(EncodeError::Unknown { id: format!("{}:{}", self.id(), mips.storage.id()) })
    }
    /// Makes the bytes of the file. The same input gives the same bytes.
    ///
    /// # Errors
    /// [`EncodeError`] says what the format cannot hold, or that it was stopped.
    fn encode(&self, input: &EncodeInput<'_>) -> Result<Vec<u8>, EncodeError>;
}

/// Every container.
pub static ENCODERS: &[&dyn Encoder] = &[
    &exr::Exr,
    &ktx2::Ktx2,
    &dds::Dds,
    &png::Png,
    &hdr::Hdr,
    &npy::Npy,
    &pfm::Pfm,
    &raw::Raw,
    &text::Text,
    &csv::Csv,
    &Merl,
    &code::Code(code::C),
    &code::Code(code::Cpp),
    &code::Code(code::Rust),
    &code::Code(code::Glsl),
    &code::Code(code::Wgsl),
    &code::Code(code::Hlsl),
    &code::Code(code::Js),
    &code::Code(code::Python),
];

/// Colours of a pixel of one to four components.
const COLOURS: &[&str] = &["red", "green", "blue", "alpha"];

/// Looks a container up by its id.
#[must_use]
pub fn encoder(id: &str) -> Option<&'static dyn Encoder> {
    ENCODERS.iter().copied().find(|e| e.id() == id)
}

/// Ids of the containers that are read.
#[must_use]
pub fn readable() -> Vec<&'static str> {
    ENCODERS.iter().filter(|e| !e.magic().is_empty()).map(|e| e.id()).collect()
}

/// Bytes of a texel of so many components.
#[must_use]
pub const fn texel_size(storage: Storage, components: usize) -> usize {
    texels::size(storage, components)
}

/// What a file says of its table, in containers that have a place for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Label<'a> {
    /// Name of the table: that of a part, of an array, of a function.
    pub name: &'a str,
    /// Its identity in hex: what is left of the provenance where there is room for a hash alone.
    pub identity: &'a str,
    /// The provenance as JSON text.
    pub provenance_json: &'a str,
}

/// A table that nothing is known of.
impl Default for Label<'_> {
    fn default() -> Self {
        Label { name: "", identity: "", provenance_json: "{}" }
    }
}

/// What goes into a file.
#[derive(Debug, Clone, Copy)]
pub struct EncodeInput<'a> {
    /// Where the texels are.
    pub grid: &'a Grid,
    /// What they hold.
    pub channels: &'a [Channel],
    /// Values as rounded by [`quantise_table`], `[texel][channel]`.
    pub values: &'a [f64],
    /// The bytes of these values, as made by [`quantise_table`], if the storage is made of blocks; empty otherwise.
    pub blocks: &'a [u8],
    /// Estimated integration errors, `[texel][channel]`; empty if they are not known. Only CSV holds them.
    pub errors: &'a [f64],
    /// How they are stored.
    pub storage: Storage,
    /// Options of the output.
    pub options: &'a [FileOption],
    /// What the file says of its table.
    pub label: Label<'a>,
    /// Set from outside to stop.
    pub cancel: &'a Cancel,
}

impl EncodeInput<'_> {
    /// Width and height of the picture, slices stacked; see the module.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        let [x, y, z] = self.grid.extent();
        [x, y * z]
    }

    /// What the container has to hold, apart from the values.
    #[must_use]
    pub fn shape(&self) -> Shape<'_> {
        Shape { grid: self.grid, channels: self.channels.len(), storage: self.storage, options: self.options }
    }

    /// Checks everything that does not depend on how the container lays out its bytes.
    fn check(&self, encoder: &dyn Encoder) -> Result<(), EncodeError> {
        self.shape().check(encoder)?;
        let n = self.channels.len();
        for (i, channel) in self.channels.iter().enumerate() {
            let id = &channel.id;
            let twice = self.channels[..i].iter().any(|c| c.id == *id);
            let fault = match () {
                () if id.is_empty() => "is empty",
                () if id.len() > 255 => "is longer than 255 bytes",
                () if id.contains('\0') => "contains a zero byte",
                () if twice => "is there twice",
                () => continue,
            };
            return Err(EncodeError::Name { id: id.clone(), fault });
        }
        let texels = self.grid.len();
        if self.values.len() != texels * n {
            return Err(EncodeError::Count { got: self.values.len(), texels, channels: n });
        }
        self.check_values()
    }

    /// Every value must be its own rounded form, bit for bit, or what the blocks decode to.
    fn check_values(&self) -> Result<(), EncodeError> {
        let n = self.channels.len();
        self.check_blocks()?;
        if self.storage.is_block() {
            return Ok(());
        }
        let mut rounded = vec![0.0; n];
        for (t, texel) in self.values.chunks_exact(n).enumerate() {
            self.cancel.check()?;
            rounded.copy_from_slice(texel);
            let fault = match self.storage.quantise_texel(&mut rounded, |c| self.channels[c].range) {
                Ok(()) => rounded.iter().zip(texel).position(|(a, b)| a.to_bits() != b.to_bits()),
                Err((c, _)) => Some(c.min(n - 1)),
            };
            if let Some(c) = fault {
                return Err(self.not_quantised(t, c));
            }
        }
        Ok(())
    }

    /// Blocks must decode to the values; in channels that the table does not have, to 0.
    fn check_blocks(&self) -> Result<(), EncodeError> {
        let (n, extent) = (self.channels.len(), self.grid.extent());
        let kind = blocks::Kind::of(self.storage);
        let (got, expected) = (self.blocks.len(), kind.map_or(Some(0), |k| k.bytes(extent)));
        if Some(got) != expected {
            let storage = self.storage.id();
            return Err(EncodeError::Blocks { storage, got, expected: expected.unwrap_or(usize::MAX) });
        }
        let Some(kind) = kind else { return Ok(()) };
        let all = kind.channels().max(n);
        let range = |c: usize| self.channels.get(c).map_or([0.0, 1.0], |channel| channel.range);
        let got = self.storage.expand(self.blocks, extent, all, range);
        let value = |i: usize| if i % all < n { self.values[i / all * n + i % all] } else { 0.0 };
        let wrong = got.iter().enumerate().position(|(i, v)| v.to_bits() != value(i).to_bits());
        wrong.map_or(Ok(()), |i| Err(self.not_quantised(i / all, (i % all).min(n - 1))))
    }

    fn not_quantised(&self, texel: usize, c: usize) -> EncodeError {
        EncodeError::NotQuantised {
            texel,
            channel: self.channels[c].id.clone(),
            value: self.values[texel * self.channels.len() + c],
            storage: self.storage.id(),
        }
    }
}
