//! Damaged and hostile pictures: an error, never a panic, never a picture with holes.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "tests")]

use crate::sample;
use brdfbake::encode::read::{ReadError, read_bytes};
use exr::image::write::WritableImage;
use exr::prelude::{
    AnyChannel, AnyChannels, Blocks, Compression, Encoding, FlatSamples, Image, Layer, LayerAttributes,
    LineOrder, Text, f16,
};
use proptest::prelude::*;
use std::io::Cursor;
use std::sync::OnceLock;

const SIZE: (usize, usize) = (19, 37);

/// An EXR of another make: half, float and integer channels, `layers` parts.
fn exr_file(compression: Compression, blocks: Blocks, layers: usize) -> Vec<u8> {
    let n = SIZE.0 * SIZE.1;
    let wave = |i: usize| ((i * 7919) % 1000) as f32 / 999.0;
    let layer = |l: usize| {
        let channels = AnyChannels::sort(
            [
                ("f", FlatSamples::F32((0..n).map(wave).collect())),
                ("h", FlatSamples::F16((0..n).map(|i| f16::from_f32(wave(i))).collect())),
                ("u", FlatSamples::U32((0..n).map(|i| u32::try_from(i).unwrap()).collect())),
            ]
            .into_iter()
            .map(|(name, samples)| AnyChannel::new(name, samples))
            .collect(),
        );
        let encoding = Encoding { compression, blocks, line_order: LineOrder::Increasing };
        let name = Text::new_or_panic(format!("part{l}"));
        Layer::new(SIZE, LayerAttributes::named(name), encoding, channels)
    };
    let mut bytes = Cursor::new(Vec::new());
    let layers: Vec<_> = (0..layers).map(layer).collect();
    let attributes = exr::prelude::ImageAttributes::with_size(SIZE);
    Image::from_layers(attributes, layers).write().non_parallel().to_buffered(&mut bytes).unwrap();
    bytes.into_inner()
}

fn png_file(colour: png::ColorType, depth: png::BitDepth) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 21, 13);
    encoder.set_color(colour);
    encoder.set_depth(depth);
    if colour == png::ColorType::Indexed {
        encoder.set_palette((0..=255).collect::<Vec<u8>>()[..48].to_vec());
    }
    encoder.add_ztxt_chunk("brdfbake".to_owned(), "{\"x\": 1}".to_owned()).unwrap();
    let mut writer = encoder.write_header().unwrap();
    let row = (21 * colour.samples() * depth as usize).div_ceil(8);
    writer.write_image_data(&vec![0x33; row * 13]).unwrap();
    writer.finish().unwrap();
    bytes
}

/// One file of every kind.
fn seeds() -> &'static [Vec<u8>] {
    static SEEDS: OnceLock<Vec<Vec<u8>>> = OnceLock::new();
    SEEDS.get_or_init(|| {
        use png::{BitDepth, ColorType};
        let mut seeds = Vec::new();
        for compression in sample::COMPRESSIONS {
            seeds.push(exr_file(compression, Blocks::ScanLines, 1));
        }
        seeds.push(exr_file(Compression::ZIP16, Blocks::Tiles(exr::math::Vec2(8, 8)), 1));
        seeds.push(exr_file(Compression::RLE, Blocks::ScanLines, 3));
        for (colour, depth) in [
            (ColorType::Grayscale, BitDepth::One),
            (ColorType::Grayscale, BitDepth::Sixteen),
            (ColorType::GrayscaleAlpha, BitDepth::Eight),
            (ColorType::Rgb, BitDepth::Sixteen),
            (ColorType::Rgba, BitDepth::Eight),
            (ColorType::Indexed, BitDepth::Four),
        ] {
            seeds.push(png_file(colour, depth));
        }
        seeds
    })
}

#[test]
fn every_kind_is_read() {
    for seed in seeds() {
        let image = read_bytes(seed).unwrap();
        let area = image.width * image.height;
        assert!(image.channels.iter().all(|c| c.values.len() == area));
    }
}

#[test]
fn every_truncation_is_an_error() {
    for seed in seeds().iter().filter(|s| s.starts_with(b"v/1\x01")) {
        for len in 0..seed.len() {
            assert!(read_bytes(&seed[..len]).is_err(), "{len} of {} bytes", seed.len());
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(
        std::env::var("BRDFBAKE_FUZZ").ok().and_then(|n| n.parse().ok()).unwrap_or(2000)
    ))]

    #[test]
    fn flipped_bytes_do_not_panic(
        seed in 0..18usize,
        flips in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        cut in prop::option::of(any::<prop::sample::Index>()),
    ) {
        let mut bytes = seeds()[seed].clone();
        for (at, value) in flips {
            let at = at.index(bytes.len());
            bytes[at] = value;
        }
        if let Some(cut) = cut {
            bytes.truncate(cut.index(bytes.len()));
        }
        if let Ok(image) = read_bytes(&bytes) {
            let area = image.width * image.height;
            prop_assert!(image.channels.iter().all(|c| c.values.len() == area));
        }
    }

    #[test]
    fn flipped_header_bytes_do_not_panic(
        seed in 0..18usize,
        flips in prop::collection::vec((0..420usize, any::<u8>()), 1..4),
    ) {
        let mut bytes = seeds()[seed].clone();
        for (at, value) in flips {
            let at = at % bytes.len();
            bytes[at] = value;
        }
        let _ = read_bytes(&bytes);
    }

    #[test]
    fn flipped_png_bytes_with_good_checksums_do_not_panic(
        seed in 12..18usize,
        flips in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
    ) {
        let mut bytes = seeds()[seed].clone();
        for (at, value) in flips {
            let at = at.index(bytes.len());
            bytes[at] = value;
        }
        let _ = read_bytes(&repaired(bytes));
    }
}

/// CRC-32 of a PNG chunk, so that a forged chunk gets past the checksum.
fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |crc, &b| {
        (0..8).fold(crc ^ u32::from(b), |c, _| if c & 1 == 1 { c >> 1 ^ 0xedb8_8320 } else { c >> 1 })
    })
}

/// The PNG with the checksum of every chunk made right again.
fn repaired(mut bytes: Vec<u8>) -> Vec<u8> {
    let mut at = 8;
    while let Some(head) = bytes.get(at..at + 8) {
        let len = u32::from_be_bytes(head[..4].try_into().unwrap()) as usize;
        let Some(body) = bytes.get(at + 4..at + 8 + len) else { break };
        let sum = crc(body).to_be_bytes();
        let Some(slot) = bytes.get_mut(at + 8 + len..at + 12 + len) else { break };
        slot.copy_from_slice(&sum);
        at += 12 + len;
    }
    bytes
}

#[test]
fn a_forged_size_is_refused_before_memory_is_asked_for() {
    let mut bytes = png_file(png::ColorType::Rgb, png::BitDepth::Sixteen);
    bytes[16..24].copy_from_slice(&[0, 1, 0, 0, 0, 1, 0, 0]);
    let message = read_bytes(&repaired(bytes)).unwrap_err().to_string();
    assert_eq!(message, "png: the header tells of 65536 x 65536 pixels; at most 2^28 samples are read");

    let mut bytes = exr_file(Compression::ZIP16, Blocks::ScanLines, 1);
    let at = bytes.windows(10).position(|w| w == b"dataWindow").unwrap() + 10 + 1 + 6 + 4;
    bytes[at + 8..at + 12].copy_from_slice(&0xff_ffff_i32.to_le_bytes());
    let message = read_bytes(&bytes).unwrap_err().to_string();
    assert_eq!(message, "exr: the header tells of 16777216 x 37 pixels; at most 2^28 samples are read");
}

#[test]
fn a_block_named_twice_is_an_error_and_not_a_hole() {
    let mut bytes = exr_file(Compression::ZIP1, Blocks::ScanLines, 1);
    assert!(read_bytes(&bytes).is_ok());
    // The offset table has 37 entries and ends where its own first entry points to.
    let table = (0..bytes.len() - 8)
        .find(|&i| u64::from_le_bytes(bytes[i..i + 8].try_into().unwrap()) == (i + 37 * 8) as u64)
        .unwrap();
    let first: [u8; 8] = bytes[table..table + 8].try_into().unwrap();
    bytes[table + 8..table + 16].copy_from_slice(&first);
    let message = read_bytes(&bytes).unwrap_err().to_string();
    assert_eq!(message, "exr: invalid: a block is there twice");
}

#[test]
fn a_text_bomb_is_left_packed() {
    // 64 MiB of blanks pack into 64 kB; texts are unpacked up to 16 MiB.
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 1, 1);
    encoder.add_ztxt_chunk("brdfbake".to_owned(), " ".repeat(1 << 26)).unwrap();
    encoder.write_header().unwrap().write_image_data(&[7]).unwrap();
    let image = read_bytes(&bytes).unwrap();
    assert!(image.provenance.is_none());
}

#[test]
fn other_files_are_named_as_such() {
    assert!(matches!(read_bytes(b""), Err(ReadError::Unknown(_))));
    let message = read_bytes(b"GIF89a..").unwrap_err().to_string();
    assert_eq!(
        message,
        "not a file of exr, ktx2, dds, png, hdr, npy, pfm, merl (it begins with [47, 49, 46, 38, 39, 61, 2e, 2e])"
    );
}
