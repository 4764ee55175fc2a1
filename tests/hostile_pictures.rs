//! Pictures of scenes that claim, repeat or hide more than they hold: known or unknown, in no more memory than was allowed.

#![allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "codes of 8 bits")]
#![allow(clippy::float_cmp, reason = "the ends of the whole range are the numbers themselves")]

use super::{MB, alone, crc, peak};
use brdfbake::plan::scene::{SurveyOptions, Texels, bytes_of, survey};
use brdfbake::scene::LeftOutKind;
use std::borrow::Cow;

/// Memory beside four bytes for each pixel of the limit.
const BESIDE: usize = 64 * MB;

fn png(size: [u32; 2], colour: png::ColorType, depth: png::BitDepth, row: &[u8], profile: usize) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut info = png::Info::with_size(size[0], size[1]);
    (info.color_type, info.bit_depth) = (colour, depth);
    if colour == png::ColorType::Indexed {
        info.palette = Some(Cow::Owned(vec![0, 10, 0, 0, 200, 0]));
    }
    if profile > 0 {
        info.icc_profile = Some(Cow::Owned(vec![0; profile]));
    }
    let mut encoder = png::Encoder::with_info(&mut bytes, info).unwrap();
    encoder.set_deflate_compression(png::DeflateCompression::Level(1));
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&row.repeat(size[1] as usize)).unwrap();
    writer.finish().unwrap();
    bytes
}

fn chunk(kind: &[u8], data: &[u8]) -> Vec<u8> {
    let body = [kind, data].concat();
    [&u32::try_from(data.len()).unwrap().to_be_bytes()[..], &body, &crc(&body).to_be_bytes()].concat()
}

/// Interlaced by Adam7 (PNG, 8.2), grey of 8 bits, stored and not compressed: the value is that of the pass.
fn interlaced(side: u32) -> Vec<u8> {
    const PASSES: [[u32; 4]; 7] =
        [[0, 0, 8, 8], [4, 0, 8, 8], [0, 4, 4, 8], [2, 0, 4, 4], [0, 2, 2, 4], [1, 0, 2, 2], [0, 1, 1, 2]];
    let mut rows = Vec::new();
    for (pass, [x, y, dx, dy]) in PASSES.into_iter().enumerate() {
        for _ in (y..side).step_by(dy as usize) {
            rows.push(0);
            rows.extend((x..side).step_by(dx as usize).map(|_| 20 * pass as u8 + 20));
        }
    }
    let (mut a, mut b) = (1_u32, 0_u32);
    for byte in &rows {
        a = (a + u32::from(*byte)) % 65521;
        b = (b + a) % 65521;
    }
    let length = u16::try_from(rows.len()).unwrap();
    let mut zlib = vec![0x78, 1, 1];
    zlib.extend(length.to_le_bytes());
    zlib.extend((!length).to_le_bytes());
    zlib.extend(&rows);
    zlib.extend((b << 16 | a).to_be_bytes());
    let head = [&side.to_be_bytes()[..], &side.to_be_bytes(), &[8, 0, 0, 0, 1]].concat();
    [b"\x89PNG\r\n\x1a\n".to_vec(), chunk(b"IHDR", &head), chunk(b"IDAT", &zlib), chunk(b"IEND", &[])]
        .concat()
}

/// Middle grey: every block is a code for "no difference" of one bit and, where rows are coded at once, one for "no more".
fn jpeg(side: u16, components: u8, progressive: bool) -> Vec<u8> {
    let segment = |marker: u8, data: &[u8]| {
        let length = u16::try_from(data.len() + 2).unwrap().to_be_bytes();
        [&[0xff, marker], &length[..], data].concat()
    };
    let mut frame = vec![8];
    frame.extend([side.to_be_bytes(), side.to_be_bytes()].concat());
    frame.push(components);
    (1..=components).for_each(|c| frame.extend([c, 0x11, 0]));
    let table = |class: u8| [vec![class, 1], vec![0; 15], vec![0]].concat();
    let mut scan = vec![components];
    (1..=components).for_each(|c| scan.extend([c, 0]));
    scan.extend([0, if progressive { 0 } else { 63 }, 0]);
    let bits =
        usize::from(side).div_ceil(8).pow(2) * usize::from(components) * if progressive { 1 } else { 2 };
    let start = if progressive { 0xc2 } else { 0xc0 };
    [
        vec![0xff, 0xd8],
        segment(0xdb, &[vec![0], vec![1; 64]].concat()),
        segment(start, &frame),
        segment(0xc4, &table(0)),
        segment(0xc4, &table(0x10)),
        segment(0xda, &scan),
        vec![0; bits.div_ceil(8)],
        vec![0xff, 0xd9],
    ]
    .concat()
}

/// A file with another number at a place.
fn with(mut file: Vec<u8>, at: usize, bytes: &[u8]) -> Vec<u8> {
    file[at..at + bytes.len()].copy_from_slice(bytes);
    if file.starts_with(b"\x89PNG") {
        let sum = crc(&file[12..29]);
        file[29..33].copy_from_slice(&sum.to_be_bytes());
    }
    file
}

fn cut(file: &[u8]) -> Vec<u8> {
    file[..file.len() * 2 / 3].to_vec()
}

/// Name, file, and the levels of its green (as codes of 8 bits) or what is said of it.
type Hostile = (&'static str, Vec<u8>, Result<[u8; 2], &'static str>);

fn pictures() -> Vec<Hostile> {
    use png::BitDepth::{Eight, One, Sixteen};
    use png::ColorType::{Grayscale, Indexed, Rgb, Rgba};
    let plain = || png([64, 64], Rgb, Eight, &[3, 100, 9].repeat(64), 0);
    let webp = |side: u32| {
        let mut bytes = Vec::new();
        let codes = [7, 90, 7, 255].repeat((side * side) as usize);
        image::codecs::webp::WebPEncoder::new_lossless(&mut bytes)
            .encode(&codes, side, side, image::ExtendedColorType::Rgba8)
            .unwrap();
        bytes
    };
    let grey = |side, components, progressive| jpeg(side, components, progressive);
    vec![
        ("plain.png", plain(), Ok([100, 100])),
        ("bits.png", png([8192, 8192], Grayscale, One, &[0x55; 1024], 0), Err("--pixels")),
        ("palette.png", png([64, 64], Indexed, One, &[0x55; 8], 0), Ok([10, 200])),
        ("beyond-palette.png", png([64, 64], Indexed, Eight, &[9; 64], 0), Ok([0, 0])),
        ("wide.png", png([64, 64], Rgb, Sixteen, &[0, 0, 0x80, 0x80, 0, 0].repeat(64), 0), Ok([128, 128])),
        ("wide-at-the-limit.png", png([1024, 1024], Rgba, Sixteen, &[0; 8192], 0), Err("--pixels")),
        ("profile.png", png([64, 64], Grayscale, Eight, &[77; 64], 200 * MB), Ok([77, 77])),
        ("interlaced.png", interlaced(16), Ok([20, 140])),
        ("interlaced-cut.png", cut(&interlaced(16)), Err("png")),
        ("claims.png", with(plain(), 16, &[0, 0, 0x7f, 0xff, 0, 0, 0x7f, 0xff]), Err("--pixels")),
        ("claims-little.png", with(plain(), 16, &[0, 0, 4, 0, 0, 0, 4, 0]), Err("png")),
        ("nothing.png", with(plain(), 16, &[0, 0, 0, 0]), Err("png")),
        (
            "cut.png",
            cut(&png([300, 300], Rgb, Eight, &(0..900).map(|i| (i * 7) as u8).collect::<Vec<_>>(), 0)),
            Err("png"),
        ),
        ("head.png", b"\x89PNG\r\n\x1a\n".to_vec(), Err("png")),
        ("grey.jpg", grey(64, 1, false), Ok([128, 128])),
        ("colour.jpg", grey(64, 3, false), Ok([128, 128])),
        ("at-the-limit.jpg", grey(1024, 3, false), Ok([128, 128])),
        ("progressive.jpg", grey(512, 3, true), Ok([128, 128])),
        ("progressive-bomb.jpg", grey(8192, 3, true), Err("--pixels")),
        ("inks.jpg", grey(64, 4, false), Err("CMYK")),
        ("claims.jpg", with(grey(64, 3, false), 76, &[0xff, 0xff, 0xff, 0xff]), Err("--pixels")),
        ("cut.jpg", cut(&grey(512, 3, false)), Err("cut short")),
        ("head.jpg", vec![0xff, 0xd8, 0xff], Err("jpeg")),
        ("lossless.webp", webp(64), Ok([90, 90])),
        ("large.webp", webp(2048), Err("--pixels")),
        ("cut.webp", cut(&webp(64)), Err("webp")),
        ("text.png", b"hello".to_vec(), Err("not an image")),
        ("empty.png", Vec::new(), Err("not an image")),
    ]
}

#[test]
fn hostile_pictures_are_known_or_unknown_in_the_memory_that_is_allowed() {
    let _alone = alone();
    let folder = tempfile::tempdir().unwrap();
    let pixels = 1 << 20;
    let all = pictures();
    for texels in Texels::ALL {
        for (name, bytes, wanted) in &all {
            std::fs::write(folder.path().join(name), bytes).unwrap();
            let text = format!(
                r#"{{ "asset": {{ "version": "2.0" }}, "images": [{{ "uri": "{name}" }}], "textures": [{{ "source": 0 }}],
                    "materials": [{{ "pbrMetallicRoughness": {{ "metallicFactor": 0, "metallicRoughnessTexture": {{ "index": 0 }} }} }}],
                    "meshes": [{{ "primitives": [{{ "attributes": {{ "TEXCOORD_0": 0 }}, "material": 0 }}] }}],
                    "accessors": [{{ "componentType": 5126, "count": 3, "type": "VEC2" }}] }}"#
            );
            let file = folder.path().join("a.gltf");
            std::fs::write(&file, text).unwrap();
            let options = SurveyOptions { pixels, texels, ..SurveyOptions::default() };
            let (taken, found) = peak(|| survey(std::slice::from_ref(&file), &options));
            let needs = found.unwrap().needs;
            let allowed = usize::try_from(bytes_of(pixels)).unwrap() + BESIDE;
            assert!(taken <= allowed, "{name}: {taken} bytes, {allowed} are allowed");
            // a mirror everywhere asks for no table
            let range = needs
                .needs
                .first()
                .map_or([0.0; 2], |n| [n.ranges["roughness"].lo, n.ranges["roughness"].hi]);
            let unknown = needs.left_out.iter().find(|l| l.kind == LeftOutKind::Unknown);
            match wanted {
                Ok(codes) => {
                    assert!(unknown.is_none(), "{name}: {unknown:?}");
                    // a triangle without an extent lies on the corner, where a repeated texture mixes all four
                    let whole = texels == Texels::Whole;
                    let found = range.map(|v| (v * 255.0).round() as u8);
                    assert!(
                        found == *codes || !whole && codes[0] <= found[0] && found[1] <= codes[1],
                        "{name}: {found:?}"
                    );
                }
                Err(told) => {
                    assert_eq!(range, [0.0, 1.0], "{name}");
                    let why = &unknown.unwrap_or_else(|| panic!("{name} is known")).why;
                    assert!(why.contains(told), "{name}: {why}");
                }
            }
        }
    }
}
