//! BC6H: a block of 4 x 4 texels of three half floats in 16 bytes.
//!
//! A block holds one or two pairs of endpoints and an index a texel. With two pairs a number of 5 bits says which texel
//! belongs to which pair. The texel is the interpolation between its endpoints *in the bits of a half*, which grow as
//! the logarithm does. Fourteen modes share the bits between precision of the first endpoint and length of the
//! differences that the others are from it. The index of one texel of each pair lacks its highest bit.
//!
//! The unsigned variant has halfs from 0 to 65504, the signed one -65504 to 65504. Neither has infinities or NaN; only
//! a foreign signed block can hold -infinity, by an endpoint of -32768.
//!
//! Source: Khronos Data Format Specification 1.3, section 19 (BPTC, float), which has the modes, partitions and weights.

/// Number of a texel of the block, row by row from the top.
pub(super) const TEXELS: usize = 16;

/// Endpoints in order of their letters w, x, y, z; red, green, blue.
pub(super) type Endpoints = [[i32; 3]; 4];

/// How the bits of a block are shared out.
#[derive(Debug)]
pub(super) struct Mode {
    /// The first bits of the block.
    code: u128,
    code_bits: usize,
    /// Pairs of endpoints: 1 or 2.
    pub(super) subsets: usize,
    /// Bits of the first endpoint.
    pub(super) base: u32,
    /// Bits of the other endpoints, red, green, blue.
    pub(super) rest: [u32; 3],
    /// True if the other endpoints are stored as signed differences from the first.
    pub(super) differences: bool,
    /// What each bit behind the code holds: `16 (3 endpoint + channel) + bit`.
    layout: [u8; 75],
}

/// No bit of an endpoint.
const NONE: u8 = 255;

/// Reads a layout: `gy4` is bit 4 of green of endpoint y, `rw0-9` bits 0 to 9 in rising order, `rw15-10` in falling order.
const fn layout(text: &str) -> [u8; 75] {
    let text = text.as_bytes();
    let mut bits = [NONE; 75];
    let (mut i, mut n) = (0, 0);
    while i < text.len() {
        if text[i] == b' ' {
            i += 1;
            continue;
        }
        let channel = match text[i] {
            b'r' => 0,
            b'g' => 1,
            _ => 2,
        };
        let slot = 3 * (text[i + 1] - b'w') + channel;
        i += 2;
        let mut ends = [0u8; 2];
        let mut end = 0;
        while i < text.len() && text[i] != b' ' {
            if text[i] == b'-' {
                end = 1;
            } else {
                ends[end] = 10 * ends[end] + text[i] - b'0';
            }
            i += 1;
        }
        let last = if end == 0 { ends[0] } else { ends[1] };
        let mut bit = ends[0];
        loop {
            bits[n] = 16 * slot + bit;
            n += 1;
            if bit == last {
                break;
            }
            bit = if last > bit { bit + 1 } else { bit - 1 };
        }
    }
    bits
}

const fn two(code: u128, base: u32, rest: [u32; 3], text: &str) -> Mode {
    let code_bits = if code < 2 { 2 } else { 5 };
    Mode { code, code_bits, subsets: 2, base, rest, differences: base > 6, layout: layout(text) }
}

const fn one(code: u128, base: u32, rest: u32, text: &str) -> Mode {
    let differences = rest < 10;
    Mode { code, code_bits: 5, subsets: 1, base, rest: [rest; 3], differences, layout: layout(text) }
}

/// Every mode.
pub(super) static MODES: [Mode; 14] = [
    two(
        0,
        10,
        [5, 5, 5],
        "gy4 by4 bz4 rw0-9 gw0-9 bw0-9 rx0-4 gz4 gy0-3 gx0-4 bz0 gz0-3 bx0-4 bz1 by0-3 ry0-4 bz2 rz0-4 bz3",
    ),
    two(
        1,
        7,
        [6, 6, 6],
        "gy5 gz4-5 rw0-6 bz0-1 by4 gw0-6 by5 bz2 gy4 bw0-6 bz3 bz5-4 rx0-5 gy0-3 gx0-5 gz0-3 bx0-5 by0-3 ry0-5 rz0-5",
    ),
    two(
        2,
        11,
        [5, 4, 4],
        "rw0-9 gw0-9 bw0-9 rx0-4 rw10 gy0-3 gx0-3 gw10 bz0 gz0-3 bx0-3 bw10 bz1 by0-3 ry0-4 bz2 rz0-4 bz3",
    ),
    two(
        6,
        11,
        [4, 5, 4],
        "rw0-9 gw0-9 bw0-9 rx0-3 rw10 gz4 gy0-3 gx0-4 gw10 gz0-3 bx0-3 bw10 bz1 by0-3 ry0-3 bz0 bz2 rz0-3 gy4 bz3",
    ),
    two(
        10,
        11,
        [4, 4, 5],
        "rw0-9 gw0-9 bw0-9 rx0-3 rw10 by4 gy0-3 gx0-3 gw10 bz0 gz0-3 bx0-4 bw10 by0-3 ry0-3 bz1-2 rz0-3 bz4-3",
    ),
    two(
        14,
        9,
        [5, 5, 5],
        "rw0-8 by4 gw0-8 gy4 bw0-8 bz4 rx0-4 gz4 gy0-3 gx0-4 bz0 gz0-3 bx0-4 bz1 by0-3 ry0-4 bz2 rz0-4 bz3",
    ),
    two(
        18,
        8,
        [6, 5, 5],
        "rw0-7 gz4 by4 gw0-7 bz2 gy4 bw0-7 bz3-4 rx0-5 gy0-3 gx0-4 bz0 gz0-3 bx0-4 bz1 by0-3 ry0-5 rz0-5",
    ),
    two(
        22,
        8,
        [5, 6, 5],
        "rw0-7 bz0 by4 gw0-7 gy5-4 bw0-7 gz5 bz4 rx0-4 gz4 gy0-3 gx0-5 gz0-3 bx0-4 bz1 by0-3 ry0-4 bz2 rz0-4 bz3",
    ),
    two(
        26,
        8,
        [5, 5, 6],
        "rw0-7 bz1 by4 gw0-7 by5 gy4 bw0-7 bz5-4 rx0-4 gz4 gy0-3 gx0-4 bz0 gz0-3 bx0-5 by0-3 ry0-4 bz2 rz0-4 bz3",
    ),
    two(
        30,
        6,
        [6, 6, 6],
        "rw0-5 gz4 bz0-1 by4 gw0-5 gy5 by5 bz2 gy4 bw0-5 gz5 bz3 bz5-4 rx0-5 gy0-3 gx0-5 gz0-3 bx0-5 by0-3 ry0-5 rz0-5",
    ),
    one(3, 10, 10, "rw0-9 gw0-9 bw0-9 rx0-9 gx0-9 bx0-9"),
    one(7, 11, 9, "rw0-9 gw0-9 bw0-9 rx0-8 rw10 gx0-8 gw10 bx0-8 bw10"),
    one(11, 12, 8, "rw0-9 gw0-9 bw0-9 rx0-7 rw11-10 gx0-7 gw11-10 bx0-7 bw11-10"),
    one(15, 16, 4, "rw0-9 gw0-9 bw0-9 rx0-3 rw15-10 gx0-3 gw15-10 bx0-3 bw15-10"),
];

/// Which texels belong to the second pair of endpoints: bit i for texel i.
pub(super) static PARTITIONS: [u16; 32] = [
    0xcccc, 0x8888, 0xeeee, 0xecc8, 0xc880, 0xfeec, 0xfec8, 0xec80, 0xc800, 0xffec, 0xfe80, 0xe800, 0xffe8,
    0xff00, 0xfff0, 0xf000, 0xf710, 0x008e, 0x7100, 0x08ce, 0x008c, 0x7310, 0x3100, 0x8cce, 0x088c, 0x3110,
    0x6666, 0x366c, 0x17e8, 0x0ff0, 0x718e, 0x399c,
];

/// The texel of the second pair whose index lacks its highest bit.
static ANCHORS: [usize; 32] = [
    15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 2, 8, 2, 2, 8, 8, 15, 2, 8, 2, 2, 8,
    8, 2, 2,
];

/// Weights of the second endpoint in 64ths, by index; of two pairs.
static WEIGHTS_3: [i32; 8] = [0, 9, 18, 27, 37, 46, 55, 64];
/// Of one pair.
static WEIGHTS_4: [i32; 16] = [0, 4, 9, 13, 17, 21, 26, 30, 34, 38, 43, 47, 51, 55, 60, 64];

/// A block as its mode has it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Block {
    /// Number of the mode.
    pub(super) mode: usize,
    /// Number of the partition; 0 with one pair.
    pub(super) partition: usize,
    /// Endpoints as integers of `base` bits, differences already added.
    pub(super) endpoints: Endpoints,
    /// Index of each texel.
    pub(super) indices: [u8; TEXELS],
}

impl Mode {
    /// Weights of the second endpoint, by index.
    pub(super) fn weights(&self) -> &'static [i32] {
        if self.subsets == 2 { &WEIGHTS_3 } else { &WEIGHTS_4 }
    }

    /// Pair of endpoints of a texel.
    pub(super) fn subset(&self, partition: usize, texel: usize) -> usize {
        if self.subsets == 2 { usize::from(PARTITIONS[partition % 32] >> texel & 1) } else { 0 }
    }

    /// True if the index of the texel lacks its highest bit.
    pub(super) fn is_anchor(&self, partition: usize, texel: usize) -> bool {
        texel == 0 || self.subsets == 2 && texel == ANCHORS[partition % 32]
    }

    /// Largest endpoint; the least is 0, or its negative.
    pub(super) fn largest(&self, signed: bool) -> i32 {
        if signed { (1 << (self.base - 1)) - 1 } else { (1 << self.base) - 1 }
    }

    /// True for an endpoint that is used: of signed ones all but the least, which stands for -infinity in 16 bits.
    pub(super) fn holds(&self, q: i32, signed: bool) -> bool {
        if signed { q.abs() <= self.largest(true) } else { (0..=self.largest(false)).contains(&q) }
    }

    /// Can another endpoint of a channel have this value, if the first endpoint is `first`?
    pub(super) fn fits(&self, channel: usize, first: i32, value: i32) -> bool {
        let half = 1 << (self.rest[channel] - 1);
        !self.differences || (-half..half).contains(&(value - first))
    }

    fn index_bits(&self) -> usize {
        if self.subsets == 2 { 3 } else { 4 }
    }

    /// The integer of 16 bits, or of 15 and a sign, that stands for an endpoint.
    pub(super) fn widen(&self, q: i32, signed: bool) -> i32 {
        if self.base >= 16 {
            return q;
        }
        let sign = u32::from(signed);
        let wide = match q.abs() {
            0 => 0,
            m if m >= self.largest(signed) => 0xffff >> sign,
            m => ((m << (16 - sign)) + (0x8000 >> sign)) >> (self.base - sign),
        };
        if q < 0 { -wide } else { wide }
    }
}

/// Interpolation between two wide endpoints.
pub(super) fn mix(a: i32, b: i32, weight: i32) -> i32 {
    (a * (64 - weight) + b * weight + 32) >> 6
}

/// The half that a wide integer stands for, as f64.
pub(super) fn value(wide: i32, signed: bool) -> f64 {
    let magnitude = u64::from(wide.unsigned_abs());
    let bits = (magnitude * 31) >> if signed { 5 } else { 6 };
    // the fields of a half in those of an f64, whose exponent is then 1008 too small
    let scale = f64::from_bits((1008 + 1023) << 52);
    let v = if bits == 0x7c00 { f64::INFINITY } else { f64::from_bits(bits << 42) * scale };
    // a small negative integer becomes 0 without sign
    if wide < 0 && bits > 0 { -v } else { v }
}

/// Sign extension of the low bits.
const fn extend(v: i32, bits: u32) -> i32 {
    v << (32 - bits) >> (32 - bits)
}

impl Block {
    /// The 16 bytes as a little-endian number.
    pub(super) fn bits(&self) -> u128 {
        let mode = &MODES[self.mode];
        let mut bits = mode.code;
        let field = |slot: usize| {
            let (end, c) = (slot / 3, slot % 3);
            let v = self.endpoints[end][c];
            if end > 0 && mode.differences { v - self.endpoints[0][c] } else { v }
        };
        for (i, &what) in mode.layout.iter().enumerate().filter(|(_, w)| **w != NONE) {
            let bit = field(usize::from(what / 16)) >> (what % 16) & 1;
            bits |= u128::from(bit != 0) << (mode.code_bits + i);
        }
        if mode.subsets == 2 {
            bits |= (self.partition as u128) << 77;
        }
        let mut at = if mode.subsets == 2 { 82 } else { 65 };
        for (texel, &index) in self.indices.iter().enumerate() {
            bits |= u128::from(index) << at;
            at += mode.index_bits() - usize::from(mode.is_anchor(self.partition, texel));
        }
        bits
    }

    /// Takes the bits apart; nothing for the four codes that are reserved.
    pub(super) fn parse(bits: u128, signed: bool) -> Option<Block> {
        let short = bits & 3 < 2;
        let code = if short { bits & 3 } else { bits & 31 };
        let number = MODES.iter().position(|m| m.code == code)?;
        let mode = &MODES[number];
        let mut endpoints = [[0; 3]; 4];
        for (i, &what) in mode.layout.iter().enumerate().filter(|(_, w)| **w != NONE) {
            let slot = usize::from(what / 16);
            let bit = i32::from(bits >> (mode.code_bits + i) & 1 == 1);
            endpoints[slot / 3][slot % 3] |= bit << (what % 16);
        }
        let first = endpoints[0];
        for (end, ends) in endpoints.iter_mut().enumerate().take(2 * mode.subsets) {
            for (c, v) in ends.iter_mut().enumerate() {
                if end > 0 && mode.differences {
                    *v = (first[c] + extend(*v, mode.rest[c])) & ((1 << mode.base) - 1);
                }
                if signed {
                    *v = extend(*v, mode.base);
                }
            }
        }
        let partition = if mode.subsets == 2 { usize::try_from(bits >> 77 & 31).unwrap_or(0) } else { 0 };
        let mut at = if mode.subsets == 2 { 82 } else { 65 };
        let mut indices = [0; TEXELS];
        for (texel, index) in indices.iter_mut().enumerate() {
            let width = mode.index_bits() - usize::from(mode.is_anchor(partition, texel));
            *index = u8::try_from(bits >> at & ((1 << width) - 1)).unwrap_or(0);
            at += width;
        }
        Some(Block { mode: number, partition, endpoints, indices })
    }

    /// The texels.
    pub(super) fn texels(&self, signed: bool) -> [[f64; 3]; TEXELS] {
        let mode = &MODES[self.mode];
        let wide = self.endpoints.map(|end| end.map(|q| mode.widen(q, signed)));
        let mut texels = [[0.0; 3]; TEXELS];
        for (i, texel) in texels.iter_mut().enumerate() {
            let pair = 2 * mode.subset(self.partition, i);
            let weight = mode.weights()[usize::from(self.indices[i]) % mode.weights().len()];
            for (c, v) in texel.iter_mut().enumerate() {
                *v = value(mix(wide[pair][c], wide[pair + 1][c], weight), signed);
            }
        }
        texels
    }
}

/// The texels of 16 bytes; zeros where the code of the mode is reserved.
pub(super) fn decode(bytes: [u8; 16], signed: bool) -> [[f64; 3]; TEXELS] {
    let block = Block::parse(u128::from_le_bytes(bytes), signed);
    block.map_or([[0.0; 3]; TEXELS], |b| b.texels(signed))
}
