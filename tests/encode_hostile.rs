//! Damaged and hostile pictures: an error, never a panic, never a picture with holes.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "tests")]

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
                ("u", FlatSamples::U32((0..n).map(|i| i as u32).collect())),
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
        for compression in [
            Compression::Uncompressed,
            Compression::RLE,
            Compression::ZIP1,
            Compression::ZIP16,
            Compression::PIZ,
            Compression::PXR24,
            Compression::B44,
            Compression::B44A,
            Compression::DWAA(None),
            Compression::DWAB(None),
        ] {
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
}

#[test]
fn other_files_are_named_as_such() {
    assert!(matches!(read_bytes(b""), Err(ReadError::Unknown(_))));
    let message = read_bytes(b"GIF89a..").unwrap_err().to_string();
    assert_eq!(message, "neither an EXR nor a PNG file (it begins with [47, 49, 46, 38, 39, 61, 2e, 2e])");
}
