//! KTX2 as the crate `ktx2` reads it, and by the rules of the specification.

use super::support::{table, written};
use brdfbake::encode::read::read_bytes;
use brdfbake::encode::{FileOption, Storage};
use half::f16;
use ktx2::{Format, Reader, SupercompressionScheme, dfd::Basic};

const FORMATS: [(Storage, [Option<Format>; 4]); 12] = [
    (
        Storage::Half,
        [
            Some(Format::R16_SFLOAT),
            Some(Format::R16G16_SFLOAT),
            Some(Format::R16G16B16A16_SFLOAT),
            Some(Format::R16G16B16A16_SFLOAT),
        ],
    ),
    (
        Storage::Float,
        [
            Some(Format::R32_SFLOAT),
            Some(Format::R32G32_SFLOAT),
            Some(Format::R32G32B32A32_SFLOAT),
            Some(Format::R32G32B32A32_SFLOAT),
        ],
    ),
    (
        Storage::Unorm8,
        [
            Some(Format::R8_UNORM),
            Some(Format::R8G8_UNORM),
            Some(Format::R8G8B8A8_UNORM),
            Some(Format::R8G8B8A8_UNORM),
        ],
    ),
    (
        Storage::Unorm16,
        [
            Some(Format::R16_UNORM),
            Some(Format::R16G16_UNORM),
            Some(Format::R16G16B16A16_UNORM),
            Some(Format::R16G16B16A16_UNORM),
        ],
    ),
    (Storage::Rgb10a2, [Some(Format::A2B10G10R10_UNORM_PACK32); 4]),
    (Storage::R11g11b10, [Some(Format::B10G11R11_UFLOAT_PACK32); 4]),
    (Storage::Rgb9e5, [Some(Format::E5B9G9R9_UFLOAT_PACK32); 4]),
    (Storage::Rgbd, [Some(Format::R8G8B8A8_UNORM); 4]),
    (Storage::Bc4, [Some(Format::BC4_UNORM_BLOCK); 4]),
    (Storage::Bc5, [Some(Format::BC5_UNORM_BLOCK); 4]),
    (Storage::Bc6h, [Some(Format::BC6H_UFLOAT_BLOCK); 4]),
    (Storage::Bc6hSigned, [Some(Format::BC6H_SFLOAT_BLOCK); 4]),
];

#[test]
fn header_descriptor_and_keys_are_those_of_the_specification() {
    for (storage, formats) in FORMATS {
        for channels in 1..=storage.most_channels().unwrap_or(4) {
            let t = table(&[5, 3], channels);
            let (bytes, _) = written(&t, "ktx2", storage, &[]).unwrap();
            let reader = Reader::new(&bytes).unwrap();
            let header = reader.header();
            let format = formats[channels - 1];
            assert_eq!(header.format, format);
            let (mut expected, type_size) = Basic::from_format(format.unwrap()).unwrap();
            expected.color_primaries = None;
            assert_eq!(format!("{:?}", reader.basic_dfd().unwrap()), format!("{expected:?}"), "{storage:?}");
            assert_eq!(reader.dfd_blocks().len(), 1);
            assert_eq!(header.type_size, type_size);
            let sizes = [header.pixel_width, header.pixel_height, header.pixel_depth, header.layer_count];
            assert_eq!(sizes, [5, 3, 0, 0]);
            assert_eq!((header.face_count, header.level_count), (1, 1));
            assert_eq!(header.supercompression_scheme, None);
            rules(&bytes, usize::from(expected.bytes_planes[0]));
        }
    }
}

/// Where the parts lie, their alignment and padding: sections 3.3 to 3.9 and 4 of KTX 2.0.
fn rules(bytes: &[u8], texel: usize) {
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    let long = |at: usize| u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap()) as usize;
    let [dfd, dfd_len, kvd, kvd_len] = [48, 52, 56, 60].map(word);
    assert_eq!((dfd, long(64), long(72)), (80 + 24, 0, 0));
    assert_eq!((word(dfd), kvd), (dfd_len, dfd + dfd_len));
    assert_eq!((dfd % 4, kvd % 4), (0, 0));
    let [start, length, unpacked] = [80, 88, 96].map(long);
    let zstd = word(44) == 2;
    if !zstd {
        assert_eq!((start % texel, start % 4, length), (0, 0, unpacked));
    }
    assert_eq!(start + length, bytes.len());
    assert!(bytes[kvd + kvd_len..start].iter().all(|b| *b == 0) && start - kvd - kvd_len < 4 * texel);
    let reader = Reader::new(bytes).unwrap();
    let keys: Vec<&str> = reader.key_value_data().map(|(k, _)| k).collect();
    assert!(keys.is_sorted() && keys.contains(&"KTXwriter") && keys.contains(&"brdfbake"));
    assert_eq!(keys.contains(&"KTXwriterScParams"), zstd);
    for (key, value) in reader.key_value_data() {
        assert_eq!(value.last(), Some(&0), "{key}");
        assert!(!value[..value.len() - 1].contains(&0) && std::str::from_utf8(value).is_ok());
    }
}

#[test]
fn volumes_and_arrays() {
    use FileOption::Layers;
    for (lengths, options, sizes, orientation) in [
        (&[6][..], &[][..], [6, 1, 0, 0], "rd\0"),
        (&[6, 4], &[], [6, 4, 0, 0], "rd\0"),
        (&[6, 4, 3], &[], [6, 4, 3, 0], "rdi\0"),
        (&[6, 4, 3], &[Layers], [6, 4, 0, 3], "rd\0"),
        (&[6, 4, 3, 2], &[], [6, 4, 0, 6], "rd\0"),
    ] {
        let t = table(lengths, 2);
        let (bytes, values) = written(&t, "ktx2", Storage::Half, options).unwrap();
        let reader = Reader::new(&bytes).unwrap();
        let h = reader.header();
        assert_eq!([h.pixel_width, h.pixel_height, h.pixel_depth, h.layer_count], sizes);
        let told = reader.key_value_data().find(|(k, _)| *k == "KTXorientation").unwrap().1;
        assert_eq!(told, orientation.as_bytes());
        let level = reader.levels().next().unwrap().data;
        let read: Vec<f64> =
            level.chunks_exact(2).map(|b| f16::from_le_bytes([b[0], b[1]]).to_f64()).collect();
        assert_eq!(read, values);
    }
}

#[test]
#[cfg(feature = "zstd")]
fn zstandard_changes_nothing_but_the_size() {
    let t = table(&[64, 64], 2);
    let smooth = brdfbake::grid::Table {
        values: (0..64 * 64 * 2).map(|i| (f64::from(i) / 8192.0).sqrt()).collect(),
        ..t
    };
    let (plain, values) = written(&smooth, "ktx2", Storage::Half, &[]).unwrap();
    let (packed, _) = written(&smooth, "ktx2", Storage::Half, &[FileOption::Zstd]).unwrap();
    assert!(packed.len() < plain.len() * 9 / 10, "{} of {}", packed.len(), plain.len());
    let reader = Reader::new(&packed).unwrap();
    assert_eq!(reader.header().supercompression_scheme, Some(SupercompressionScheme::Zstandard));
    // since 2.0.4 the plane sizes are those of the data before compression
    assert_eq!(reader.basic_dfd().unwrap().bytes_planes[0], 4);
    rules(&packed, 4);
    let level = reader.levels().next().unwrap();
    assert_eq!(level.uncompressed_byte_length, 64 * 64 * 4);
    let [a, b] = [&plain, &packed].map(|f| read_bytes(f).unwrap());
    assert_eq!(a.channels, b.channels);
    assert_eq!(a.channels[1].values, values.iter().skip(1).step_by(2).copied().collect::<Vec<_>>());
}

#[test]
fn missing_components_are_filled() {
    use FileOption::{FillOne, FillZero, Rgba};
    for (options, fill) in
        [(&[Rgba][..], [0.0, 1.0]), (&[Rgba, FillZero], [0.0, 0.0]), (&[Rgba, FillOne], [1.0, 1.0])]
    {
        for storage in [Storage::Half, Storage::Float, Storage::Unorm8, Storage::Unorm16] {
            let t = table(&[3, 3], 2);
            let (bytes, values) = written(&t, "ktx2", storage, options).unwrap();
            let reader = Reader::new(&bytes).unwrap();
            assert_eq!(reader.basic_dfd().unwrap().sample_information.len(), 4);
            let data = reader.levels().next().unwrap().data;
            let size = data.len() / 36;
            for (t, texel) in data.chunks_exact(4 * size).enumerate() {
                for (c, component) in texel.chunks_exact(size).enumerate() {
                    let got = match (storage, component) {
                        (Storage::Half, b) => f16::from_le_bytes([b[0], b[1]]).to_f64(),
                        (Storage::Float, b) => f64::from(f32::from_le_bytes(b.try_into().unwrap())),
                        (Storage::Unorm8, b) => f64::from(b[0]) / 255.0,
                        (_, b) => f64::from(u16::from_le_bytes([b[0], b[1]])) / 65535.0,
                    };
                    assert_eq!(got, if c < 2 { values[t * 2 + c] } else { fill[c - 2] });
                }
            }
        }
    }
}
