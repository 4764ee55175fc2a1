//! Files as loaders of other programs want them and as other programs write them.

use super::support::{table, written};
use brdfbake::cancel::Cancel;
use brdfbake::encode::Layout;
use brdfbake::encode::diff::{Pairing, Tolerance, images, images_by};
use brdfbake::encode::read::{Sample, read_bytes};
use brdfbake::encode::{EncodeError, FileOption, Storage};
use exr::prelude::{ReadChannels, ReadLayers, read};
use std::io::Cursor;

/// Header of a DDS without the second one: flags, bits and masks of a pixel.
fn dds(flags: u32, bits: u32, masks: [u32; 4], pixels: &[u8]) -> Vec<u8> {
    let mut words = [0u32; 32];
    words[0] = u32::from_le_bytes(*b"DDS ");
    (words[1], words[2], words[3], words[4]) =
        (124, 0x1007, 1, u32::try_from(pixels.len()).unwrap() * 8 / bits);
    (words[19], words[20], words[22]) = (32, flags, bits);
    words[23..27].copy_from_slice(&masks);
    words[27] = 0x1000;
    words.iter().flat_map(|w| w.to_le_bytes()).chain(pixels.iter().copied()).collect()
}

#[test]
fn pixels_of_dds_are_told_by_masks() {
    let value = |bytes: &[u8]| -> Vec<(String, f64)> {
        let image = read_bytes(bytes).unwrap();
        image.channels.iter().map(|c| (c.name.clone(), c.values[0])).collect()
    };
    let colours = |r: f64, g: f64, b: f64| [("R", r), ("G", g), ("B", b)].map(|(n, v)| (n.to_owned(), v));
    let [x0, x1, x2, x3] = [0.0, 1.0, 2.0, 3.0].map(|v| v / 255.0);
    let alpha = ("A".to_owned(), x3);
    let abgr = dds(0x41, 32, [0xff, 0xff00, 0xff_0000, 0xff00_0000], &[0, 1, 2, 3]);
    assert_eq!(value(&abgr), [&colours(x0, x1, x2)[..], std::slice::from_ref(&alpha)].concat());
    let argb = dds(0x41, 32, [0xff_0000, 0xff00, 0xff, 0xff00_0000], &[0, 1, 2, 3]);
    assert_eq!(value(&argb), [&colours(x2, x1, x0)[..], &[alpha]].concat());
    // alpha that the flags do not tell of is padding
    let xrgb = dds(0x40, 32, [0xff_0000, 0xff00, 0xff, 0xff00_0000], &[0, 1, 2, 3]);
    assert_eq!(value(&xrgb), colours(x2, x1, x0));
    let packed = dds(0x40, 16, [0xf800, 0x07e0, 0x001f, 0], &[0x41, 0x08]);
    assert_eq!(value(&packed), colours(1.0 / 31.0, 2.0 / 63.0, 1.0 / 31.0));
    assert_eq!(value(&dds(0x2_0000, 8, [0xff, 0, 0, 0], &[3])), [("Y".to_owned(), x3)]);
    let wide = dds(0x2_0001, 16, [0xff, 0, 0, 0xff00], &[3, 1]);
    assert_eq!(value(&wide), [("Y".to_owned(), x3), ("A".to_owned(), x1)]);
    for (flags, bits, masks, part) in [
        (0x40, 32, [0xf0f, 0xff_0000, 0, 0], "mask 0xf0f of R"),
        (0x40, 32, [0xff, 0x1ff, 0, 0], "mask 0x1ff of G"),
        (0x40, 16, [0xff_0000, 0, 0, 0], "mask 0xff0000 of R"),
        (0x40, 12, [0xf, 0, 0, 0], "12 bits a pixel"),
        (0x8_0000, 16, [0xff, 0xff00, 0, 0], "flags 0x80000"),
        (0x40, 32, [0; 4], "no bit of a pixel"),
    ] {
        let fault = read_bytes(&dds(flags, bits, masks, &[0; 8])).unwrap_err().to_string();
        assert!(fault.contains(part), "{fault}");
    }
}

/// The three older names of blocks are read as their own.
#[test]
fn older_codes_of_dds_are_read() {
    let t = table(&[4, 4], 1);
    let (modern, _) = written(&t, "dds", Storage::Bc4, &[]).unwrap();
    let expected = read_bytes(&modern).unwrap().channels[0].values.clone();
    for code in [b"BC4U", b"ATI1"] {
        let mut old = [&modern[..84], &code[..], &modern[88..128], &modern[148..]].concat();
        old[80..84].copy_from_slice(&4u32.to_le_bytes());
        assert_eq!(read_bytes(&old).unwrap().channels[0].values, expected);
    }
    let mut other = [&modern[..84], b"DXT1", &modern[88..128], &modern[148..]].concat();
    other[80..84].copy_from_slice(&4u32.to_le_bytes());
    assert!(read_bytes(&other).unwrap_err().to_string().contains("`DXT1` is not supported"));
}

#[test]
fn exr_names_channels_by_position() {
    for (channels, option, names) in [
        (1, FileOption::Positional, &["B", "G", "R"][..]),
        (1, FileOption::Luminance, &["Y"]),
        (2, FileOption::Positional, &["B", "G", "R"]),
        (3, FileOption::Positional, &["B", "G", "R"]),
        (4, FileOption::Positional, &["A", "B", "G", "R"]),
    ] {
        let t = table(&[5, 3], channels);
        let (bytes, values) = written(&t, "exr", Storage::Float, &[option]).unwrap();
        let reader = read().no_deep_data().largest_resolution_level().all_channels().all_layers();
        let file = reader.all_attributes().from_buffered(Cursor::new(&bytes)).unwrap();
        let list = &file.layer_data[0].channel_data.list;
        assert_eq!(list.iter().map(|c| c.name.to_string()).collect::<Vec<_>>(), names);
        for channel in list {
            let place = ["R", "G", "B", "A"].iter().position(|n| *n == channel.name.to_string()).unwrap_or(0);
            let want = |i: usize| match (channels, place) {
                (1, _) => values[i],
                (2, 2) => 0.0,
                (_, c) => values[i * channels + c],
            };
            for (i, v) in channel.sample_data.values_as_f32().enumerate() {
                assert_eq!(f64::from(v), want(i), "{channels} channels, {}", channel.name);
            }
        }
        // this program reads the table back under its own names
        let image = read_bytes(&bytes).unwrap();
        assert_eq!(image.contradictions(), Vec::<String>::new());
        assert_eq!(image.warnings, Vec::<String>::new());
        let column = |c: usize| values.iter().skip(c).step_by(channels).copied().collect::<Vec<f64>>();
        for (c, channel) in image.channels.iter().enumerate() {
            assert_eq!((&channel.name, &channel.values), (&format!("v{c}"), &column(c)));
        }
    }
    let t = table(&[5, 3], 2);
    let both = written(&t, "exr", Storage::Half, &[FileOption::Positional, FileOption::Luminance]);
    assert!(matches!(both, Err(EncodeError::Conflict { .. })));
    let two = written(&t, "exr", Storage::Half, &[FileOption::Luminance]);
    assert!(matches!(two, Err(EncodeError::Channels { limit: 1, .. })));
    let five = written(&table(&[5, 3], 5), "exr", Storage::Half, &[FileOption::Positional]);
    assert!(matches!(five, Err(EncodeError::Channels { limit: 4, .. })));
}

#[test]
fn three_channels_are_four_components_in_ktx2() {
    let t = table(&[5, 3], 3);
    for storage in [Storage::Half, Storage::Float, Storage::Unorm8, Storage::Unorm16] {
        let (padded, values) = written(&t, "ktx2", storage, &[]).unwrap();
        let (three, _) = written(&t, "ktx2", storage, &[FileOption::Rgb]).unwrap();
        let format = |bytes: &[u8]| ktx2::Reader::new(bytes).unwrap().header().format.unwrap();
        let (of_three, of_four) = match storage {
            Storage::Half => (ktx2::Format::R16G16B16_SFLOAT, ktx2::Format::R16G16B16A16_SFLOAT),
            Storage::Float => (ktx2::Format::R32G32B32_SFLOAT, ktx2::Format::R32G32B32A32_SFLOAT),
            Storage::Unorm8 => (ktx2::Format::R8G8B8_UNORM, ktx2::Format::R8G8B8A8_UNORM),
            _ => (ktx2::Format::R16G16B16_UNORM, ktx2::Format::R16G16B16A16_UNORM),
        };
        assert_eq!((format(&three), format(&padded)), (of_three, of_four));
        for bytes in [padded, three] {
            let image = read_bytes(&bytes).unwrap();
            assert_eq!(image.channels.len(), 3);
            assert!(image.channels.iter().enumerate().all(|(c, p)| p.values[7] == values[7 * 3 + c]));
        }
    }
    let two = written(&table(&[5, 3], 2), "ktx2", Storage::Half, &[FileOption::Rgb]);
    assert!(matches!(two, Err(EncodeError::Axes { .. })));
}

#[test]
fn a_ktx2_without_descriptor_is_read_with_a_warning() {
    let (mut bytes, values) = written(&table(&[5, 3], 2), "ktx2", Storage::Half, &[]).unwrap();
    assert_eq!(read_bytes(&bytes).unwrap().warnings, Vec::<String>::new());
    let start = u32::from_le_bytes(bytes[48..52].try_into().unwrap()) as usize;
    bytes[52..56].copy_from_slice(&28u32.to_le_bytes());
    bytes[start..start + 4].copy_from_slice(&28u32.to_le_bytes());
    let image = read_bytes(&bytes).unwrap();
    assert_eq!(image.channels[0].values[1], values[2]);
    assert_eq!(image.warnings.len(), 1);
    assert!(image.warnings[0].contains("describes no channel"), "{:?}", image.warnings);
}

#[test]
fn channels_of_other_names_are_compared_by_position() {
    let t = table(&[5, 3], 2);
    let of = |container: &str, options: &[FileOption]| {
        let (bytes, _) = written(&t, container, Storage::Float, options).unwrap();
        read_bytes(&bytes).unwrap()
    };
    let (ours, array) = (of("exr", &[]), of("npy", &[]));
    let d = images(&ours, &array, Tolerance::default());
    assert!(d.equal(), "{d:?}");
    assert_eq!(d.mapping, ["v0 = c0", "v1 = c1"]);
    // padding of another program is no difference, other numbers are
    let mut padded = array.clone();
    let mut third = padded.channels[0].clone();
    third.values.fill(0.0);
    third.name = "c2".to_owned();
    padded.channels.push(third);
    assert!(images(&ours, &padded, Tolerance::default()).equal());
    padded.channels[2].values[4] = 0.5;
    assert!(!images(&ours, &padded, Tolerance::default()).equal());
    let by = |pairs: &[[&str; 2]]| Pairing::Named(pairs.iter().map(|p| p.map(str::to_owned)).collect());
    let swapped = images_by(&ours, &array, Tolerance::default(), &by(&[["v0", "c1"], ["v1", "c0"]]));
    assert!(!swapped.equal() && swapped.mapping == ["v0 = c1", "v1 = c0"]);
    let missing = images_by(&ours, &array, Tolerance::default(), &by(&[["v0", "x"]]));
    assert_eq!(missing.shape, ["the second has no channel `x`, but c0, c1"]);
}

#[test]
fn bare_numbers_are_read_as_they_are_told_to_lie() {
    let t = table(&[5, 3], 2);
    for (storage, told) in
        [(Storage::Half, "5x3x2:half"), (Storage::Float, "5x3x2:float"), (Storage::Double, "5x3x2:double")]
    {
        let (bytes, values) = written(&t, "raw", storage, &[]).unwrap();
        let image = Layout::parse(told).unwrap().read(&bytes, &Cancel::new()).unwrap();
        assert_eq!((image.width, image.height, image.channels.len()), (5, 3, 2));
        assert_eq!(image.channels[1].sample, Sample::of(storage));
        assert!((0..15).all(|i| image.channels[1].values[i] == values[2 * i + 1]));
        let short = Layout::parse(told).unwrap().read(&bytes[1..], &Cancel::new()).unwrap_err();
        assert!(short.to_string().contains("bytes"), "{short}");
    }
    let planar =
        Layout::parse("2x1x2:unorm8+planar").unwrap().read(&[0, 51, 102, 255], &Cancel::new()).unwrap();
    assert_eq!(planar.channels[1].values, [0.4, 1.0]);
    for (text, part) in [
        ("5x3:half", "three lengths"),
        ("5x3x2", "no storage"),
        ("5x3x2:fp16", "no storage `fp16`"),
        ("0x3x2:half", "above 0"),
        ("1x1x1:half+zstd", "no option"),
    ] {
        let fault = Layout::parse(text).unwrap_err();
        assert!(fault.contains(part), "{fault}");
    }
}
