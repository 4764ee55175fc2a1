//! Seeded choices for spot checks: the same on every run, spread over the table.

use crate::grid::Table;

/// A small generator (`SplitMix64`): one multiplication-xorshift a number.
#[derive(Debug, Clone)]
pub struct Seeds(u64);

impl Seeds {
    /// From a seed.
    #[must_use]
    pub fn new(seed: u64) -> Seeds {
        Seeds(seed)
    }

    /// The next 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number in [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// An index below `len`.
    #[allow(clippy::cast_possible_truncation, reason = "the remainder is below len")]
    pub fn index(&mut self, len: usize) -> usize {
        (self.bits() % len as u64) as usize
    }
}

/// Up to `count` texels: the corners of the table first, then seeded ones.
#[must_use]
pub fn texels(table: &Table, count: usize, seed: u64) -> Vec<usize> {
    let len = table.grid.len();
    let [w, h, d] = table.grid.extent();
    let mut picked = vec![0, w - 1, (h - 1) * w, w * h * d - 1];
    let mut seeds = Seeds::new(seed);
    while picked.len() < count {
        picked.push(seeds.index(len));
    }
    picked.truncate(count);
    picked.sort_unstable();
    picked.dedup();
    picked
}
