//! Why a table cannot be put into a container.

use crate::cancel::Cancelled;
use crate::math::figures::exact;

/// Why a table cannot be put into a container.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EncodeError {
    /// No such container or storage.
    #[error("no container and storage `{id}`")]
    Unknown {
        /// What was asked for.
        id: String,
    },
    /// The container does not have this storage.
    #[error("{format} cannot store {storage}; it can store {allowed}")]
    Storage {
        /// Container id.
        format: &'static str,
        /// Storage id.
        storage: &'static str,
        /// What it can store.
        allowed: String,
    },
    /// What this build does not write.
    #[error("{what} needs the feature `{feature}` of the crate, which this build does not have")]
    Feature {
        /// Storage or option id.
        what: &'static str,
        /// The feature of the crate.
        feature: &'static str,
    },
    /// The container does not take this option.
    #[error("{format} does not take option `{option}`; it takes {allowed}")]
    Option {
        /// Container id.
        format: &'static str,
        /// The option.
        option: &'static str,
        /// The options that it takes.
        allowed: String,
    },
    /// Two options, or an option and a storage, that exclude each other.
    #[error("`{a}` and `{b}` exclude each other")]
    Conflict {
        /// One.
        a: &'static str,
        /// The other.
        b: &'static str,
    },
    /// No channels, or more than the container holds.
    #[error("{format}:{storage} cannot hold {count} channels; it holds 1 to {limit}")]
    Channels {
        /// Container id.
        format: &'static str,
        /// Storage id.
        storage: &'static str,
        /// Number of channels.
        count: usize,
        /// Most that it holds.
        limit: usize,
    },
    /// A channel id that cannot be a channel name, or that is there twice.
    #[error("channel id `{id}`: {fault}")]
    Name {
        /// The id.
        id: String,
        /// What is wrong.
        fault: &'static str,
    },
    /// The number of values is not that of the texels and channels.
    #[error("{got} values for {texels} texels of {channels} channels")]
    Count {
        /// Number of values.
        got: usize,
        /// Number of texels.
        texels: usize,
        /// Number of channels.
        channels: usize,
    },
    /// Blocks that are missing, or there without need.
    #[error(
        "{got} bytes of blocks for {storage}, which needs {expected}: hand over those that came with the values"
    )]
    Blocks {
        /// Storage id.
        storage: &'static str,
        /// Bytes given.
        got: usize,
        /// Bytes that the texels take; 0 if the storage has no blocks.
        expected: usize,
    },
    /// Axes that the container has no words for.
    #[error("{format} cannot hold these axes; {fault}")]
    Axes {
        /// Container id.
        format: &'static str,
        /// What it takes.
        fault: &'static str,
    },
    /// More rows or columns than the container can count.
    #[error("{format} cannot hold {width} x {height} pixels; each side is at most {limit}")]
    Size {
        /// Container id.
        format: &'static str,
        /// Width in pixels.
        width: usize,
        /// Height in pixels, slices stacked.
        height: usize,
        /// Largest side.
        limit: usize,
    },
    /// More numbers than a constant of the language can have.
    #[error(
        "{format} cannot hold {count} numbers in one constant, but at most {limit}; write the table as a texture"
    )]
    Numbers {
        /// Container id.
        format: &'static str,
        /// Number of texels times channels.
        count: usize,
        /// Most that it can have.
        limit: usize,
    },
    /// A value that is not one of the storage: it was not rounded beforehand.
    #[error(
        "texel {texel}, channel {channel}: {} is not a {storage} number; round the table first",
        exact(.value)
    )]
    NotQuantised {
        /// Texel number.
        texel: usize,
        /// Channel id.
        channel: String,
        /// The value.
        value: f64,
        /// Storage id.
        storage: &'static str,
    },
    /// Stopped from outside.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The library that writes the container failed.
    #[error("{format}: {source}")]
    Library {
        /// Container id.
        format: &'static str,
        /// Its own message.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
}
