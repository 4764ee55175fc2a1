//! Options of an output: words behind the storage, `ktx2:half+rgba+zstd`.

use super::{EncodeError, Encoder};
use crate::encode::Storage;
use crate::grid::Grid;

/// How a container is to hold a table, where it has a choice.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum FileOption {
    /// `rgba`: four components a pixel, whatever the table has.
    Rgba,
    /// `rgb`: three components a pixel, for three channels, where four are usual.
    Rgb,
    /// `fill-zero`: components without channel are 0.
    FillZero,
    /// `fill-one`: components without channel are 1.
    FillOne,
    /// `layers`: slices along a third axis are the layers of an array, not of a volume.
    Layers,
    /// `parts`: slices along a third axis are parts of the file, not stacked below each other.
    Parts,
    /// `planar`: all texels of one channel, then those of the next, not the channels of each texel together.
    Planar,
    /// `vec`: the channels of each texel as a constructor of its language, `vec3(0.1, 0.2, 0.3)`.
    Vectors,
    /// `tiled`: tiles of 64 x 64 pixels instead of scan lines.
    Tiled,
    /// `positional`: channels are called R, G, B (and A) by position, as loaders of colours want them.
    Positional,
    /// `y`: the one channel is called Y, as loaders of grey pictures want it.
    Luminance,
    /// `untagged`: nothing is said of the colour space.
    Untagged,
    /// `zstd`: supercompressed with Zstandard.
    Zstd,
}

/// Every option.
pub static FILE_OPTIONS: &[FileOption] = &[
    FileOption::Rgba,
    FileOption::Rgb,
    FileOption::FillZero,
    FileOption::FillOne,
    FileOption::Layers,
    FileOption::Parts,
    FileOption::Planar,
    FileOption::Vectors,
    FileOption::Tiled,
    FileOption::Positional,
    FileOption::Luminance,
    FileOption::Untagged,
    FileOption::Zstd,
];

impl FileOption {
    /// The word in a recipe.
    #[must_use]
    pub const fn id(self) -> &'static str {
        match self {
            FileOption::Rgba => "rgba",
            FileOption::Rgb => "rgb",
            FileOption::FillZero => "fill-zero",
            FileOption::FillOne => "fill-one",
            FileOption::Layers => "layers",
            FileOption::Parts => "parts",
            FileOption::Planar => "planar",
            FileOption::Vectors => "vec",
            FileOption::Tiled => "tiled",
            FileOption::Positional => "positional",
            FileOption::Luminance => "y",
            FileOption::Untagged => "untagged",
            FileOption::Zstd => "zstd",
        }
    }

    /// One line of meaning.
    #[must_use]
    pub const fn meaning(self) -> &'static str {
        match self {
            FileOption::Rgba => "four components a pixel; those without channel are 0, the fourth is 1",
            FileOption::Rgb => {
                "three components a pixel, for three channels: few graphics processors and no web engine read them"
            }
            FileOption::FillZero => "components without channel are 0",
            FileOption::FillOne => "components without channel are 1",
            FileOption::Layers => "a third axis makes the layers of an array, not a volume",
            FileOption::Parts => "a third axis makes parts of the file, not slices below each other",
            FileOption::Planar => "one channel after another, not interleaved",
            FileOption::Vectors => "each texel as vec3(0.1, 0.2, 0.3), a constructor of shader languages",
            FileOption::Tiled => "tiles of 64 x 64 pixels",
            FileOption::Positional => {
                "channels named R, G, B (A) by position; of two the third is 0, one is written three times"
            }
            FileOption::Luminance => "the one channel named Y",
            FileOption::Untagged => "no gamma chunk, by which browsers would convert the numbers",
            FileOption::Zstd => "supercompressed with Zstandard, level 19",
        }
    }

    /// Looks an option up by its word.
    #[must_use]
    pub fn find(id: &str) -> Option<FileOption> {
        FILE_OPTIONS.iter().copied().find(|o| o.id() == id)
    }
}

/// What a file has to hold, apart from the values: enough to tell before a bake whether it can.
#[derive(Debug, Clone, Copy)]
pub struct Shape<'a> {
    /// Where the texels are.
    pub grid: &'a Grid,
    /// Channels of the table.
    pub channels: usize,
    /// How a number is stored.
    pub storage: Storage,
    /// Options of the output.
    pub options: &'a [FileOption],
}

impl Shape<'_> {
    /// Is the option given?
    #[must_use]
    pub fn has(&self, option: FileOption) -> bool {
        self.options.contains(&option)
    }

    /// Width, height, and number of slices.
    #[must_use]
    pub fn extent(&self) -> [usize; 3] {
        self.grid.extent()
    }

    /// True if the slices make a volume that a GPU can filter across: a third axis and no fourth, and no option against.
    #[must_use]
    pub fn is_volume(&self) -> bool {
        self.grid.axes().len() == 3 && !self.has(FileOption::Layers)
    }

    /// Layers of an array; none if the table is a single picture or a volume.
    #[must_use]
    pub fn layers(&self) -> Option<usize> {
        (self.grid.axes().len() > 2 && !self.is_volume()).then(|| self.extent()[2])
    }

    /// Values of the components of a pixel that hold no channel: 0, and 1 for the fourth (what a GPU reads from a
    /// texture that has no such component), unless an option says otherwise.
    #[must_use]
    pub fn fill(&self, components: usize) -> Vec<f64> {
        let missing = self.channels..components;
        missing
            .map(|c| match c {
                _ if self.has(FileOption::FillOne) => 1.0,
                3 if !self.has(FileOption::FillZero) => 1.0,
                _ => 0.0,
            })
            .collect()
    }

    /// Checks that the container can hold a table of this shape.
    ///
    /// # Errors
    /// [`EncodeError`] says what it cannot hold.
    pub fn check(&self, encoder: &dyn Encoder) -> Result<(), EncodeError> {
        let format = encoder.id();
        let storage = self.storage.id();
        if !encoder.storages().contains(&self.storage) {
            let allowed = encoder.storages().iter().map(|s| s.id()).collect::<Vec<_>>().join(", ");
            return Err(EncodeError::Storage { format, storage, allowed });
        }
        if let Some(option) = self.options.iter().find(|o| !encoder.options().contains(o)) {
            return Err(EncodeError::Option {
                format,
                option: option.id(),
                allowed: words(encoder.options()),
            });
        }
        if self.has(FileOption::FillZero) && self.has(FileOption::FillOne) {
            return Err(EncodeError::Conflict { a: "fill-zero", b: "fill-one" });
        }
        if self.has(FileOption::Rgb) && self.has(FileOption::Rgba) {
            return Err(EncodeError::Conflict { a: "rgb", b: "rgba" });
        }
        if self.has(FileOption::Rgb) && self.channels != 3 {
            return Err(EncodeError::Axes { format, fault: "option rgb is for tables of three channels" });
        }
        if self.has(FileOption::Planar) && self.has(FileOption::Vectors) {
            return Err(EncodeError::Conflict { a: "planar", b: "vec" });
        }
        if self.has(FileOption::Vectors) && !(2..=4).contains(&self.channels) {
            return Err(EncodeError::Axes {
                format,
                fault: "option vec is for tables of two to four channels",
            });
        }
        if self.has(FileOption::Positional) && self.has(FileOption::Luminance) {
            return Err(EncodeError::Conflict { a: "positional", b: "y" });
        }
        let coupled = matches!(self.storage, Storage::Rgb9e5 | Storage::Rgbe | Storage::Rgbd)
            || self.storage.is_block();
        if coupled && [FileOption::FillOne, FileOption::Rgba, FileOption::Rgb].iter().any(|o| self.has(*o)) {
            let a = match () {
                () if self.has(FileOption::Rgba) => "rgba",
                () if self.has(FileOption::Rgb) => "rgb",
                () => "fill-one",
            };
            return Err(EncodeError::Conflict { a, b: storage });
        }
        let named = match () {
            () if self.has(FileOption::Luminance) => 1,
            () if self.has(FileOption::Positional) => 4,
            () => usize::MAX,
        };
        let limit =
            encoder.most_channels().min(named).min(self.storage.most_channels().unwrap_or(usize::MAX));
        if self.channels == 0 || self.channels > limit {
            return Err(EncodeError::Channels { format, storage, count: self.channels, limit });
        }
        encoder.check_size(self)
    }
}

/// The words of options, for messages.
#[must_use]
pub fn words(options: &[FileOption]) -> String {
    let words: Vec<&str> = options.iter().map(|o| o.id()).collect();
    if words.is_empty() { "none".to_owned() } else { words.join(", ") }
}
