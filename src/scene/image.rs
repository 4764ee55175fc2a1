//! The images of a scene: where they lie, and what was found in them. They are decoded by whoever plans.

use super::factor::{Channel, Sampled};
use super::geometry::Reading;
use crate::picture::Levels;
use std::collections::BTreeMap;

/// Where the bytes of an image lie.
#[derive(Debug)]
pub enum Source {
    /// In a file: names below the scene's folder, the first of them `..` as often as it leads out of it.
    File {
        /// The names.
        names: Vec<String>,
        /// Which bytes of it: first, and how many; all of them if none.
        part: Option<[u64; 2]>,
    },
    /// In the scene's own file.
    Embedded(Vec<u8>),
    /// Nowhere that is read, and why.
    Missing(String),
}

/// An image that a number of a used material is multiplied by.
#[derive(Debug)]
pub struct Image {
    /// Position in the file.
    pub index: usize,
    /// JSON path, for messages.
    pub at: String,
    /// Where its bytes are.
    pub source: Source,
}

/// What was found in the images of a scene.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Look {
    found: BTreeMap<usize, Result<[Levels; 4], String>>,
    covered: BTreeMap<(usize, Reading), Result<[Levels; 4], String>>,
}

impl Look {
    /// Nothing was looked at: every texture counts as [0, 1].
    #[must_use]
    pub fn none() -> Look {
        Look::default()
    }

    /// Notes the levels of R, G, B and A of an image, or why they are not known.
    pub fn add(&mut self, image: usize, found: Result<[Levels; 4], String>) {
        self.found.insert(image, found);
    }

    /// Notes the levels of an image over the texels that a material reads, or why these are not known.
    pub fn cover(&mut self, image: usize, reading: Reading, found: Result<[Levels; 4], String>) {
        self.covered.insert((image, reading), found);
    }

    /// The levels of the texels that are read, if it was asked and is known which these are.
    pub(super) fn covered(&self, sampled: Sampled) -> Option<&[Levels; 4]> {
        self.covered.get(&(sampled.image?, sampled.reading?))?.as_ref().ok()
    }

    /// Why it is not known which texels of an image that was read are covered, if that was asked.
    #[must_use]
    pub fn uncovered(&self, sampled: Sampled) -> Option<&str> {
        self.covered.get(&(sampled.image?, sampled.reading?))?.as_ref().err().map(String::as_str)
    }

    /// The levels of a channel, if its image was read: of the texels that are covered where that is known, else of all.
    #[must_use]
    pub fn levels(&self, sampled: Sampled) -> Option<Levels> {
        let whole = || self.found.get(&sampled.image?)?.as_ref().ok();
        let all = self.covered(sampled).or_else(whole)?;
        let place = match sampled.channel {
            Channel::R => 0,
            Channel::G => 1,
            Channel::B => 2,
            Channel::A => 3,
        };
        Some(all[place])
    }

    /// Why the image of a texture is not known, if it was to be looked at and could not be read.
    #[must_use]
    pub fn unknown(&self, sampled: Sampled) -> Option<&str> {
        match sampled.image {
            None => Some("the texture names no image that is known"),
            Some(image) => self.found.get(&image)?.as_ref().err().map(String::as_str),
        }
    }
}
