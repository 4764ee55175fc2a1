//! The basic data format descriptor of KTX2: what the bits of a texel mean.
//!
//! Source: Khronos Data Format Specification 1.3, section 5 (basic descriptor block), and KTX 2.0 section 3.7. Version 2
//! of the block, colour model RGBSDA with one texel a block, or one of the BC models with 4 x 4; linear transfer. The
//! primaries are unspecified: a table has no colours, and loaders then leave its numbers alone.

use super::Storage;
use super::blocks::Kind;

/// `KHR_DF_MODEL_RGBSDA`.
const MODEL_RGBSDA: u8 = 1;
/// `KHR_DF_MODEL_BC4`, `_BC5`, `_BC6H`.
const MODEL_BC4: u8 = 131;
const MODEL_BC5: u8 = 132;
const MODEL_BC6H: u8 = 133;
/// `KHR_DF_TRANSFER_LINEAR`.
const LINEAR: u8 = 1;
/// Qualifier bits of a sample, above its channel id.
const EXPONENT: u8 = 0x20;
const SIGNED: u8 = 0x40;
const FLOAT: u8 = 0x80;
/// Channel id of alpha.
const ALPHA: u8 = 15;

struct Sample {
    offset: u16,
    bits: u8,
    channel: u8,
    lower: u32,
    upper: u32,
}

/// The descriptor with its length in front.
pub(super) fn descriptor(storage: Storage, components: usize) -> Vec<u8> {
    let samples = samples(storage, components);
    let bytes = u8::try_from(super::texels::size(storage, components)).unwrap_or(0);
    let block = 24 + 16 * samples.len();
    let word = |n: usize| u32::try_from(n).unwrap_or(0);
    let mut out = Vec::with_capacity(4 + block);
    out.extend(word(4 + block).to_le_bytes());
    // vendor Khronos, type basic
    out.extend(0u32.to_le_bytes());
    out.extend((2 | word(block) << 16).to_le_bytes());
    let model = match Kind::of(storage) {
        None => MODEL_RGBSDA,
        Some(Kind::Bc6h { .. }) => MODEL_BC6H,
        Some(Kind::Ramps(1)) => MODEL_BC4,
        Some(Kind::Ramps(_)) => MODEL_BC5,
    };
    out.extend([model, 0, LINEAR, 0]);
    // sides of a block of texels, less one
    let side = if storage.is_block() { 3 } else { 0 };
    out.extend([side, side, 0, 0]);
    out.extend([bytes, 0, 0, 0, 0, 0, 0, 0]);
    for s in samples {
        out.extend(s.offset.to_le_bytes());
        out.extend([s.bits - 1, s.channel]);
        out.extend([0; 4]);
        out.extend(s.lower.to_le_bytes());
        out.extend(s.upper.to_le_bytes());
    }
    out
}

fn samples(storage: Storage, components: usize) -> Vec<Sample> {
    let same = |bits: u8, kind: u8, lower: u32, upper: u32| {
        (0u8..4)
            .take(components)
            .map(|c| Sample {
                offset: u16::from(c) * u16::from(bits),
                bits,
                channel: kind | if c == 3 { ALPHA } else { c },
                lower,
                upper,
            })
            .collect()
    };
    // the ends of a float sample are -1 and 1, those of a code its ends
    let (minus_one, one) = ((-1.0f32).to_bits(), 1.0f32.to_bits());
    match storage {
        Storage::Half => same(16, FLOAT | SIGNED, minus_one, one),
        Storage::Float | Storage::Double => same(32, FLOAT | SIGNED, minus_one, one),
        Storage::Unorm8 | Storage::Rgbd | Storage::Rgbe => same(8, 0, 0, 0xff),
        Storage::Unorm16 => same(16, 0, 0, 0xffff),
        // one sample is all the bits of a channel, or of all of them
        Storage::Bc4 | Storage::Bc5 => same(64, 0, 0, u32::MAX),
        Storage::Bc6h => vec![Sample { offset: 0, bits: 128, channel: FLOAT, lower: 0, upper: one }],
        Storage::Bc6hSigned => {
            let channel = FLOAT | SIGNED;
            vec![Sample { offset: 0, bits: 128, channel, lower: minus_one, upper: one }]
        }
        Storage::Rgb10a2 => {
            let mut samples: Vec<Sample> = same(10, 0, 0, 0x3ff);
            if let Some(alpha) = samples.get_mut(3) {
                (alpha.bits, alpha.upper) = (2, 3);
            }
            samples
        }
        Storage::R11g11b10 => {
            // the lower end of an unsigned float is 0
            [(0, 11, 0), (11, 11, 1), (22, 10, 2)]
                .map(|(offset, bits, c)| Sample { offset, bits, channel: c | FLOAT, lower: 0, upper: one })
                .into()
        }
        Storage::Rgb9e5 => {
            // each channel: nine bits of mantissa, whose 1 is 8448 at the bias, then the common exponent with bias 15
            let mantissa =
                |c: u8| Sample { offset: 9 * u16::from(c), bits: 9, channel: c, lower: 0, upper: 8448 };
            let exponent =
                |c: u8| Sample { offset: 27, bits: 5, channel: c | EXPONENT, lower: 15, upper: 31 };
            (0..3).flat_map(|c| [mantissa(c), exponent(c)]).collect()
        }
    }
}
