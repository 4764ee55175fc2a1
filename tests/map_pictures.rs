//! Images of all kinds that people have, and what is damaged.
#![allow(clippy::unwrap_used, clippy::float_cmp, reason = "test")]

use brdfbake::picture::{PictureError, read_bytes};

/// A PNG of these bytes a row.
fn png(
    size: [u32; 2],
    colour: png::ColorType,
    depth: png::BitDepth,
    palette: Option<Vec<u8>>,
    rows: &[u8],
) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size[0], size[1]);
    encoder.set_color(colour);
    encoder.set_depth(depth);
    if let Some(palette) = palette {
        encoder.set_palette(palette);
    }
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(rows).unwrap();
    writer.finish().unwrap();
    bytes
}

#[test]
fn palettes_and_bits_are_unfolded() {
    use png::{BitDepth, ColorType};
    let palette = vec![255, 0, 0, 0, 255, 0];
    // two pixels a byte would do: 0b01 in the top bits
    let indexed = png([2, 1], ColorType::Indexed, BitDepth::One, Some(palette), &[0b0100_0000]);
    let picture = read_bytes(&indexed).unwrap();
    assert_eq!(picture.plane("R").unwrap().values, [1.0, 0.0]);
    assert_eq!(picture.plane("G").unwrap().values, [0.0, 1.0]);
    let grey = png([4, 1], ColorType::Grayscale, BitDepth::Two, None, &[0b00_01_10_11]);
    let picture = read_bytes(&grey).unwrap();
    let plane = picture.plane("G").unwrap();
    assert_eq!(plane.name, "Y");
    assert_eq!(plane.values, [0.0, 85.0 / 255.0, 170.0 / 255.0, 1.0]);
    let wide = png([1, 1], ColorType::Rgba, BitDepth::Sixteen, None, &[0, 1, 0x12, 0x34, 0xff, 0xff, 0, 0]);
    let picture = read_bytes(&wide).unwrap();
    let code = |name: &str| picture.plane(name).unwrap().values[0] * 65535.0;
    assert_eq!([code("R"), code("G"), code("B"), code("A")].map(f32::round), [1.0, 4660.0, 65535.0, 0.0]);
}

#[test]
fn jpeg_is_read() {
    let mut bytes = Vec::new();
    let grey: Vec<u8> = vec![200; 64];
    let encoder = image::codecs::jpeg::JpegEncoder::new_with_quality(&mut bytes, 100);
    image::ImageEncoder::write_image(encoder, &grey, 8, 8, image::ExtendedColorType::L8).unwrap();
    let picture = read_bytes(&bytes).unwrap();
    assert_eq!((picture.width, picture.height), (8, 8));
    assert!(picture.planes[0].values.iter().all(|v| (v * 255.0 - 200.0).abs() <= 1.0));
    assert!(matches!(read_bytes(&bytes[..bytes.len() / 3]), Err(PictureError::Damaged { .. })));
}

#[test]
fn what_is_no_image_is_told() {
    use png::{BitDepth, ColorType};
    let whole = png([64, 64], ColorType::Rgb, BitDepth::Eight, None, &[77; 64 * 64 * 3]);
    assert!(read_bytes(&whole).is_ok());
    for cut in [9, 20, 40, whole.len() / 2, whole.len() - 30] {
        assert!(matches!(read_bytes(&whole[..cut]), Err(PictureError::Damaged { .. })), "cut at {cut}");
    }
    assert!(matches!(read_bytes(b"GIF89a"), Err(PictureError::Unknown(_))));
    let picture = read_bytes(&whole).unwrap();
    let message = picture.plane("roughness").unwrap_err().to_string();
    assert_eq!(message, "no channel `roughness`; there is R, G, B");
    // a header that tells of more than is read
    let mut huge = whole;
    huge[16..24].copy_from_slice(&[0, 1, 0, 0, 0, 1, 0, 0]);
    assert!(read_bytes(&huge).is_err());
}
