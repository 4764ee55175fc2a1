//! A number of a material: what the file says, what multiplies it, and the values that it can take.

use super::geometry::Reading;
use super::image::Look;
use super::json::Allowed;
use crate::math::figures::significant;
use std::fmt;

/// What lets a number take more than one value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Spread {
    /// Nothing: it is the same everywhere and always.
    Constant,
    /// A texture that was not looked at, or cannot be read: it multiplies the number by something in [0, 1].
    Texture,
    /// A texture that was read, with so many different codes.
    Texels(u32),
    /// A texture that was read where a mesh covers it, with so many different codes there.
    Covered(u32),
    /// An animation (`KHR_animation_pointer`).
    Animation,
    /// The levels of filtered maps.
    Maps,
}

/// The values that a number can take over a surface and over time.
///
/// Accuracy: `serde_json` reads a decimal to within 1 ulp, so 0.029999999329447746 may end in 3.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// Smallest value.
    pub lo: f64,
    /// Largest value.
    pub hi: f64,
    /// Why they differ.
    pub spread: Spread,
}

impl Interval {
    /// One value, everywhere and always.
    #[must_use]
    pub const fn constant(x: f64) -> Self {
        Self { lo: x, hi: x, spread: Spread::Constant }
    }

    /// The only value, if there is only one.
    #[must_use]
    pub fn value(&self) -> Option<f64> {
        (self.lo.to_bits() == self.hi.to_bits()).then_some(self.lo)
    }

    /// The values under a monotone map; a falling one turns them round.
    #[must_use]
    pub fn map(self, f: impl Fn(f64) -> f64) -> Self {
        let [a, b] = [f(self.lo), f(self.hi)];
        Self { lo: a.min(b), hi: a.max(b), spread: self.spread }
    }

    /// The values of a function that rises in both of its arguments.
    #[must_use]
    pub fn rising(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let spread = if self.spread == Spread::Constant { other.spread } else { self.spread };
        Self { lo: f(self.lo, other.lo), hi: f(self.hi, other.hi), spread }
    }
}

/// Digits of an interval that mean something.
const DIGITS: usize = 12;

impl fmt::Display for Interval {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // products of factors and texels end in rounding
        let [lo, hi] = [self.lo, self.hi].map(|x| significant(x, DIGITS));
        match self.spread {
            Spread::Constant if self.value().is_none() => write!(f, "[{lo}, {hi}]"),
            Spread::Constant => write!(f, "{lo}"),
            Spread::Texture => write!(f, "[{lo}, {hi}] (texture)"),
            Spread::Texels(1) => write!(f, "{lo} (texture of one level)"),
            Spread::Texels(n) => write!(f, "[{lo}, {hi}] (texture of {n} levels)"),
            Spread::Covered(1) => write!(f, "{lo} (texture of one level where the mesh covers it)"),
            Spread::Covered(n) => {
                write!(f, "[{lo}, {hi}] (texture of {n} levels where the mesh covers it)")
            }
            Spread::Maps => write!(f, "[{lo}, {hi}] (levels of filtered maps)"),
            Spread::Animation => write!(f, "[{lo}, {hi}] (animation)"),
        }
    }
}

/// A channel of a texture that a number is multiplied by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Sampled {
    /// The image, if the texture names one that is known.
    pub image: Option<usize>,
    /// Which of R, G, B, A.
    pub channel: Channel,
    /// How its material reads it; none if it is not asked which texels a mesh covers.
    pub reading: Option<Reading>,
}

/// A channel of a texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Channel {
    /// Red.
    R,
    /// Green.
    G,
    /// Blue.
    B,
    /// Alpha; 1 where the image has none.
    A,
}

/// A number of a layer, as its extension's line in the registry declares it.
#[derive(Debug)]
pub struct Factor {
    /// Its key.
    pub key: &'static str,
    /// Its value where the file gives none; of a colour, of each channel.
    pub default: f64,
    /// The values that it may have.
    pub allowed: &'static Allowed,
    /// Key and channel of the texture that it is multiplied by.
    pub texture: Option<(&'static str, Channel)>,
    /// Numbers in the file: 1, or 3 and 4 of a colour, whose least and largest of R, G and B count.
    pub channels: usize,
}

impl Factor {
    /// A number without a texture.
    #[must_use]
    pub const fn plain(key: &'static str, default: f64, allowed: &'static Allowed) -> Factor {
        Factor { key, default, allowed, texture: None, channels: 1 }
    }

    /// A number that a channel of a texture multiplies.
    #[must_use]
    pub const fn textured(
        key: &'static str,
        default: f64,
        allowed: &'static Allowed,
        texture: (&'static str, Channel),
    ) -> Factor {
        Factor { key, default, allowed, texture: Some(texture), channels: 1 }
    }

    /// A colour of 3 or 4 numbers, with the key of its texture.
    #[must_use]
    pub const fn colour(
        key: &'static str,
        default: f64,
        allowed: &'static Allowed,
        texture: &'static str,
        channels: usize,
    ) -> Factor {
        Factor { key, default, allowed, texture: Some((texture, Channel::R)), channels }
    }
}

/// A number of a layer, as it was read.
#[derive(Debug, Clone, PartialEq)]
pub struct Property {
    /// Its key.
    pub key: &'static str,
    /// Least and largest channel; the same twice for a number.
    pub factor: [f64; 2],
    /// The channels of a colour; the same three times for a number.
    pub values: [f64; 3],
    /// The texture that multiplies it.
    pub texture: Option<Sampled>,
    /// Does an animation change it?
    pub animated: bool,
    /// What an animation can make of it.
    pub allowed: [f64; 2],
    /// Is it a colour? Its texture is then not looked at: colours decide over no axis.
    pub colour: bool,
}

impl Property {
    /// The values that it can take, as far as its texture is known.
    #[must_use]
    pub fn range(&self, look: &Look) -> Interval {
        let [lo, hi] = self.factor;
        if self.animated {
            return Interval { lo: self.allowed[0], hi: self.allowed[1], spread: Spread::Animation };
        }
        let Some(texture) = self.texture else { return Interval { lo, hi, spread: Spread::Constant } };
        match look.levels(texture).filter(|_| !self.colour) {
            Some(levels) => {
                let covered = look.covered(texture).is_some();
                let spread = if covered { Spread::Covered } else { Spread::Texels };
                Interval { lo: lo * levels.lo, hi: hi * levels.hi, spread: spread(levels.count) }
            }
            None => Interval { lo: 0.0, hi, spread: Spread::Texture },
        }
    }
}
