//! Seeded changes of a file.

use brdfbake::verify::seeds::Seeds;

/// The same inputs on every machine.
pub(super) struct Random(Seeds);

impl Random {
    pub(super) fn new(seed: u64) -> Random {
        Random(Seeds::new(seed))
    }

    /// Below n; 0 for n = 0.
    fn below(&mut self, n: usize) -> usize {
        self.0.index(n.max(1))
    }
}

/// Numbers at which lengths and counts turn over.
const EDGES: [u64; 12] = [
    0,
    1,
    0x7f,
    0x80,
    0xff,
    0x7fff,
    0xffff,
    0x7fff_ffff,
    0x8000_0000,
    0xffff_ffff,
    0x7fff_ffff_ffff_ffff,
    0xffff_ffff_ffff_ffff,
];

/// Numbers in a text that are none, or are too large.
const WORDS: [&str; 16] = [
    "-1",
    "0",
    "1e999",
    "-1e-400",
    "nan",
    "inf",
    "null",
    "true",
    "[]",
    "{}",
    "\"",
    "99999999999999999999",
    "\u{feff}",
    "\u{202e}",
    "\\ud800",
    "1e308",
];

/// A seed under one to eight changes, mostly one or two: what is changed much is refused at its first bytes.
pub(super) fn change(random: &mut Random, seeds: &[Vec<u8>], words: &[&str]) -> Vec<u8> {
    let mut bytes = seeds[random.below(seeds.len())].clone();
    let most = [1, 1, 2, 8][random.below(4)];
    for _ in 0..=random.below(most) {
        // headers are where most is decided
        let reach = if random.below(4) == 0 { bytes.len().min(256) } else { bytes.len() };
        let at = random.below(reach);
        match random.below(16) {
            0 | 10..=12 if !bytes.is_empty() => bytes[at] ^= 1 << random.below(8),
            1 | 13 | 14 if !bytes.is_empty() => bytes[at] = u8::try_from(EDGES[random.below(5)]).unwrap(),
            2 | 3 => {
                let edge = EDGES[random.below(EDGES.len())];
                let edge = if random.below(2) == 0 {
                    edge.to_le_bytes()
                } else {
                    edge.to_be_bytes().map(u8::swap_bytes)
                };
                let width = [2, 4, 8][random.below(3)].min(bytes.len() - at.min(bytes.len()));
                bytes[at..at + width].copy_from_slice(&edge[..width]);
            }
            4 => bytes.truncate(at),
            5 => {
                let end = (at + random.below(64)).min(bytes.len());
                bytes.drain(at..end);
            }
            6 => {
                let end = (at + random.below(64)).min(bytes.len());
                let part = bytes[at..end].to_vec();
                bytes.splice(at..at, part);
            }
            7 => {
                let other = &seeds[random.below(seeds.len())];
                let from = random.below(other.len());
                let to = (from + random.below(128)).min(other.len());
                let end = (at + to - from).min(bytes.len());
                bytes.splice(at..end, other[from..to].iter().copied());
            }
            _ => {
                let own = random.below(words.len() + WORDS.len());
                let word = words.get(own).unwrap_or_else(|| &WORDS[own - words.len()]);
                let end = (at + random.below(12)).min(bytes.len());
                bytes.splice(at..end, word.bytes());
            }
        }
    }
    bytes
}
