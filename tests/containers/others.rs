//! NumPy, raw, CSV, Radiance, PNG with codes of 8 bits; refusals.

use super::support::{table, written};
use crate::tolerance::{FEW_ROUNDINGS, near};
use brdfbake::encode::option::words;
use brdfbake::encode::read::{Sample, read_bytes};
use brdfbake::encode::{ENCODERS, FileOption, Storage, encoder};
use std::collections::BTreeSet;

#[test]
fn numpy_header_is_of_version_one() {
    let t = table(&[6, 4, 3], 2);
    let (bytes, values) = written(&t, "npy", Storage::Double, &[]).unwrap();
    let length = usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    assert_eq!((&bytes[..8], (10 + length) % 64), (&b"\x93NUMPY\x01\x00"[..], 0));
    let header = std::str::from_utf8(&bytes[10..10 + length]).unwrap();
    assert!(header.ends_with('\n'));
    let dict = "{'descr': '<f8', 'fortran_order': False, 'shape': (3, 4, 6, 2), }";
    assert_eq!(header.trim_end(), dict);
    let numbers: Vec<f64> =
        bytes[10 + length..].chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect();
    assert_eq!(numbers, values);
    let image = read_bytes(&bytes).unwrap();
    assert_eq!((image.width, image.height, image.channels.len()), (6, 12, 2));
    assert_eq!(image.channels[1].name, "c1");
}

#[test]
fn raw_is_the_bare_numbers() {
    let t = table(&[3, 2], 2);
    let (bytes, values) = written(&t, "raw", Storage::Float, &[]).unwrap();
    let read: Vec<f64> =
        bytes.chunks_exact(4).map(|b| f64::from(f32::from_le_bytes(b.try_into().unwrap()))).collect();
    assert_eq!(read, values);
}

#[test]
fn csv_has_coordinates_values_and_errors() {
    let t = table(&[3, 2], 2);
    let (bytes, values) = written(&t, "csv", Storage::Double, &[]).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("mu,alpha,v0,v1,error of v0,error of v1"));
    for (i, line) in lines.enumerate() {
        let numbers: Vec<f64> = line.split(',').map(|n| n.parse().unwrap()).collect();
        let (x, y) = ((i % 3) as f64, (i / 3) as f64);
        near!(numbers[0], (x + 0.5) / 3.0, FEW_ROUNDINGS);
        near!(numbers[1], (y + 0.5) / 2.0 * 2.0, FEW_ROUNDINGS);
        assert_eq!(numbers[2..4], values[2 * i..2 * i + 2]);
        assert_eq!(numbers[4..], t.errors[2 * i..2 * i + 2]);
    }
}

#[test]
fn radiance_lines_of_every_length() {
    for width in [1, 7, 8, 9, 130, 300] {
        for channels in 1..=3 {
            let mut t = table(&[width, 3], channels);
            // long runs, short runs and none
            for (i, v) in t.values.iter_mut().enumerate() {
                if i % (width * channels) < width / 2 {
                    *v = 0.25;
                }
            }
            let (bytes, values) = written(&t, "hdr", Storage::Rgbe, &[]).unwrap();
            assert!(bytes.starts_with(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nbrdfbake={"));
            let image = read_bytes(&bytes).unwrap();
            assert_eq!(image.channels.len(), channels);
            for (c, plane) in image.channels.iter().enumerate() {
                let want: Vec<f64> = values.iter().skip(c).step_by(channels).copied().collect();
                assert_eq!((&plane.values, plane.sample), (&want, Sample::Rgbe));
            }
        }
    }
}

#[test]
fn png_of_eight_bits_is_what_a_browser_gets() {
    use png::{BitDepth, ColorType};
    for (storage, channels, options, colour) in [
        (Storage::Unorm8, 1, &[][..], ColorType::Grayscale),
        (Storage::Unorm8, 2, &[], ColorType::Rgb),
        (Storage::Unorm8, 2, &[FileOption::Rgba], ColorType::Rgba),
        (Storage::Rgbd, 3, &[], ColorType::Rgba),
    ] {
        let t = table(&[4, 4], channels);
        let (bytes, values) = written(&t, "png", storage, options).unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
        assert_eq!((reader.info().color_type, reader.info().bit_depth), (colour, BitDepth::Eight));
        let mut data = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut data).unwrap();
        let samples = colour.samples();
        for (t, texel) in data.chunks_exact(samples).enumerate() {
            let got: Vec<f64> = texel.iter().map(|c| f64::from(*c) / 255.0).collect();
            for c in 0..channels {
                let v = if storage == Storage::Rgbd { got[c].powf(2.2) / got[3] } else { got[c] };
                near!(v, values[t * channels + c], FEW_ROUNDINGS);
            }
            if storage == Storage::Unorm8 && samples == 4 {
                assert_eq!(got[2..], [0.0, 1.0]);
            }
        }
        let image = read_bytes(&bytes).unwrap();
        assert_eq!(image.contradictions(), Vec::<String>::new());
        assert_eq!(image.channels[0].values, values.iter().step_by(channels).copied().collect::<Vec<_>>());
    }
}

#[test]
fn refusals_name_what_there_is() {
    let message = |channels, container, storage, options: &[FileOption]| {
        written(&table(&[2, 2], channels), container, storage, options).unwrap_err().to_string()
    };
    use FileOption::{FillOne, FillZero, Rgba, Tiled};
    let dds = message(1, "dds", Storage::Half, &[Tiled]);
    assert_eq!(dds, "dds does not take option `tiled`; it takes rgba, fill-zero, fill-one, layers");
    let both = message(1, "ktx2", Storage::Half, &[FillZero, FillOne]);
    assert_eq!(both, "`fill-zero` and `fill-one` exclude each other");
    let shared = message(1, "ktx2", Storage::Rgb9e5, &[Rgba]);
    assert_eq!(shared, "`rgba` and `rgb9e5` exclude each other");
    assert_eq!(message(5, "ktx2", Storage::Half, &[]), "ktx2:half cannot hold 5 channels; it holds 1 to 4");
    assert_eq!(message(1, "hdr", Storage::Half, &[]), "hdr cannot store half; it can store rgbe");
    assert_eq!(words(&[]), "none");
}

#[test]
fn the_registry_is_sound() {
    let extensions: BTreeSet<&str> = ENCODERS.iter().map(|e| e.extension()).collect();
    assert_eq!(extensions.len(), ENCODERS.len(), "a table may go into every container at once");
    for e in ENCODERS {
        assert!(encoder(e.id()).is_some() && !e.storages().is_empty() && e.most_channels() > 0);
        assert!(e.options().is_sorted());
    }
}
