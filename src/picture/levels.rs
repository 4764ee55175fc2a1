//! The codes that occur in each channel of an image, without planes of floats: as little memory as the decoder takes.

use super::PictureError;
use super::read::{Header, SLACK, Samples, decode, named};

/// The codes of a channel, as numbers in [0, 1].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Levels {
    /// Smallest.
    pub lo: f64,
    /// Largest.
    pub hi: f64,
    /// How many different ones.
    pub count: u32,
}

impl Levels {
    /// One value everywhere.
    pub const ONE: Levels = Levels { lo: 1.0, hi: 1.0, count: 1 };
}

/// The codes of a decoded image.
#[derive(Debug)]
pub struct Codes<'a> {
    /// Width and height.
    pub size: [usize; 2],
    samples: &'a Samples,
}

impl Codes<'_> {
    /// The levels of R, G, B and A over the texels that count; alpha is 1 where there is none, and grey is all three colours.
    #[must_use]
    pub fn levels(&self, counts: impl Fn(usize) -> bool) -> [Levels; 4] {
        let samples = self.samples;
        let names = samples.names();
        let find = |name: &str| names.iter().position(|n| *n == name);
        ["R", "G", "B", "A"].map(|name| {
            let grey = || if name == "A" { None } else { find("Y") };
            find(name).or_else(grey).map_or(Levels::ONE, |channel| count(samples, channel, &counts))
        })
    }
}

/// The levels of R, G, B and A of a PNG, JPEG or WebP image. `allow` is asked with the bytes that decoding takes before they are
/// taken, and says how many there may be if it refuses.
///
/// # Errors
/// [`PictureError::Unknown`] for another format, [`PictureError::Memory`] where `allow` refuses, [`PictureError::Damaged`].
pub fn levels(bytes: &[u8], allow: impl FnOnce(u64) -> Result<(), u64>) -> Result<[Levels; 4], PictureError> {
    codes(bytes, allow, |codes| codes.levels(|_| true))
}

/// As [`levels`], whatever is made of the codes.
///
/// # Errors
/// As [`levels`].
pub fn codes<T>(
    bytes: &[u8],
    allow: impl FnOnce(u64) -> Result<(), u64>,
    make: impl FnOnce(&Codes<'_>) -> T,
) -> Result<T, PictureError> {
    let ask = |header: &Header| {
        if let Err(limit) = allow(header.needed) {
            let Header { width, height, needed } = *header;
            return Err(PictureError::Memory { width, height, needed, limit });
        }
        Ok(header.needed.saturating_add(SLACK))
    };
    decode(bytes, named(bytes), ask, |header, samples| {
        make(&Codes { size: [header.width as usize, header.height as usize], samples })
    })
}

/// The levels of a channel.
fn count(samples: &Samples, channel: usize, counts: &impl Fn(usize) -> bool) -> Levels {
    let most = if samples.are_wide() { 65535_u16 } else { 255 };
    let mut seen = vec![false; usize::from(most) + 1];
    for (_, code) in samples.codes(channel).enumerate().filter(|(i, _)| counts(*i)) {
        seen[usize::from(code)] = true;
    }
    let occur = || (0..=most).zip(&seen).filter(|(_, seen)| **seen).map(|(code, _)| code);
    let [lo, hi] =
        [occur().next(), occur().next_back()].map(|code| f64::from(code.unwrap_or(0)) / f64::from(most));
    Levels { lo, hi, count: u32::try_from(occur().count()).unwrap_or(u32::MAX) }
}
