//! Images of all kinds that people have, and what is damaged.
#![allow(clippy::unwrap_used, clippy::float_cmp, reason = "test")]

use crate::tolerance::HELD_AS_SINGLE;
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

/// Every kind of picture is filtered or refused: the file, the level and the texel are told, and nothing is written.
#[test]
fn pictures_of_all_kinds_are_filtered_or_refused() {
    use brdfbake::cancel::Cancel;
    use brdfbake::pipeline::Settings;
    use brdfbake::pipeline::map::{Input, MapRequest, Output, RoughnessInput, run};
    use png::{BitDepth, ColorType};
    let dir = tempfile::tempdir().unwrap();
    let save = |name: &str, bytes: &[u8]| {
        let path = dir.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    };
    let bake = |normal: Option<Input>, roughness: RoughnessInput| {
        let out = dir.path().join("out");
        let request = MapRequest::new("m", normal, roughness);
        let request = MapRequest { outputs: vec![Output::parse("exr").unwrap()], check: 1, ..request };
        let done = run(&request, &Settings::new(&out), &Cancel::new(), &|_, _| {}).map(|_| {
            let file = brdfbake::encode::read::read_file(&out.join("m.roughness.exr")).unwrap();
            file.channel("roughness").unwrap().values.clone()
        });
        let written = out.exists();
        let _ = std::fs::remove_dir_all(&out);
        assert_eq!(written, done.is_ok(), "something was written");
        done.map_err(|e| e.to_string())
    };
    let number = || RoughnessInput::Constant(0.5);
    // WebP is a picture as PNG is
    let mut webp = Vec::new();
    let codes: Vec<u8> = (0..12).map(|i| if i % 3 == 1 { 51 } else { 200 }).collect();
    let encoder = image::codecs::webp::WebPEncoder::new_lossless(&mut webp);
    encoder.encode(&codes, 2, 2, image::ExtendedColorType::Rgb8).unwrap();
    let found = bake(None, RoughnessInput::new(save("r.webp", &webp))).unwrap();
    assert!(found.iter().all(|v| (v - 0.2).abs() < HELD_AS_SINGLE), "{found:?}");
    let message = bake(None, RoughnessInput::new(save("cut.webp", &webp[..webp.len() / 2]))).unwrap_err();
    assert!(message.contains("cut.webp: webp:"), "{message}");
    // Basis Universal is told by its name, whichever of its codings it is
    let table = dir.path().join("plain");
    let request = MapRequest::new("b", None, RoughnessInput::new(save("r.webp", &webp)));
    run(&request, &Settings::new(&table), &Cancel::new(), &|_, _| {}).unwrap();
    let mut ktx2 = std::fs::read(table.join("b.roughness.ktx2")).unwrap();
    ktx2[12..16].fill(0);
    let model = u32::from_le_bytes(ktx2[48..52].try_into().unwrap()) as usize + 12;
    for (name, scheme, code) in [("ETC1S", 1, 163), ("UASTC", 2, 166)] {
        (ktx2[44], ktx2[model]) = (scheme, code);
        let message = bake(None, RoughnessInput::new(save("basis.ktx2", &ktx2))).unwrap_err();
        assert!(
            message.contains(&format!("{name} of Basis Universal (KHR_texture_basisu) is not decoded")),
            "{message}"
        );
    }
    // 16 bits: the last digit of one texel of a roughness is kept
    let wide: Vec<u8> = [0x4000u16, 0x4001, 0x8000, 0xffff].iter().flat_map(|v| v.to_be_bytes()).collect();
    let path = save("wide.png", &png([2, 2], ColorType::Grayscale, BitDepth::Sixteen, None, &wide));
    let found = bake(None, RoughnessInput::new(path)).unwrap();
    let expected = [0x4000, 0x4001, 0x8000, 0xffff].map(|v| f64::from(v) / 65535.0);
    assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < HELD_AS_SINGLE), "{found:?}");
    // a palette is what its colours are
    let palette = vec![255, 51, 0, 0, 204, 0];
    let indexed = png([2, 1], ColorType::Indexed, BitDepth::One, Some(palette), &[0b0100_0000]);
    let path = save("palette.png", &indexed);
    let found = bake(None, RoughnessInput::new(path)).unwrap();
    assert!((found[0] - 0.2).abs() < HELD_AS_SINGLE && (found[1] - 0.8).abs() < HELD_AS_SINGLE, "{found:?}");
    // grey has no directions in it
    let grey = png([4, 4], ColorType::Grayscale, BitDepth::Eight, None, &[200; 16]);
    let message = bake(Some(Input::new(save("grey.png", &grey))), number()).unwrap_err();
    assert!(message.contains("no channel `R`; there is Y"), "{message}");
    // truncated, in each of two places, as roughness and as normals
    let whole = png([8, 8], ColorType::Rgb, BitDepth::Eight, None, &[140; 8 * 8 * 3]);
    for cut in [30, whole.len() - 20] {
        let path = save("cut.png", &whole[..cut]);
        for refused in
            [bake(None, RoughnessInput::new(path.clone())), bake(Some(Input::new(path.clone())), number())]
        {
            let message = refused.unwrap_err();
            assert!(message.contains("cut.png: png:"), "{cut}: {message}");
        }
    }
    // normals of no length, of which the first is told and the others are counted
    let path = dir.path().join("none.exr");
    let texel = |x, y| if (x, y) == (2, 1) || y == 3 { (0.0f32, 0.0f32, 0.0f32) } else { (0.0, 0.1, 0.9) };
    exr::prelude::write_rgb_file(&path, 4, 4, texel).unwrap();
    let message = bake(Some(Input { signed: true, ..Input::new(path) }), number()).unwrap_err();
    let expected = "none.exr: level 0, texel (2, 1): the normal has no length; 4 more texels have faults";
    assert!(message.contains(expected), "{message}");
    // the middle code of 8 bits is no direction
    let middle = png([2, 1], ColorType::Rgb, BitDepth::Eight, None, &[128, 128, 255, 128, 127, 128]);
    let message = bake(Some(Input::new(save("middle.png", &middle))), number()).unwrap_err();
    assert!(message.contains("middle.png: level 0, texel (1, 0): the normal has no length"), "{message}");
    // a roughness above 1, and one that is infinite
    for (value, expected) in [(1.5, "roughness 1.5 outside [0, 1]"), (f32::INFINITY, "a value is not finite")]
    {
        let path = dir.path().join("over.exr");
        let texel = |x, y| (0.0f32, if (x, y) == (1, 2) { value } else { 0.5 }, 0.0f32);
        exr::prelude::write_rgb_file(&path, 3, 3, texel).unwrap();
        let message = bake(None, RoughnessInput::new(path)).unwrap_err();
        assert!(message.contains(&format!("over.exr: level 0, texel (1, 2): {expected}")), "{message}");
    }
}
