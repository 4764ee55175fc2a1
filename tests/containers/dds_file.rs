//! DDS as the crate `dds` decodes it.

use super::support::{table, written};
use brdfbake::encode::{FileOption, Storage};
use dds::{ColorFormat, Decoder, Format, ImageViewMut, Size};

/// All surfaces as f32 RGBA.
pub(crate) fn decoded(bytes: &[u8]) -> (Decoder<&[u8]>, Vec<[f32; 4]>) {
    let mut decoder = Decoder::new(bytes).unwrap();
    let mut all = Vec::new();
    while let Some(info) = decoder.surface_info() {
        let Size { width, height } = info.size();
        let mut data = vec![0u8; (width * height) as usize * 16];
        let view = ImageViewMut::new(&mut data, info.size(), ColorFormat::RGBA_F32).unwrap();
        decoder.read_surface(view).unwrap();
        let float = |b: &[u8]| f32::from_ne_bytes(b.try_into().unwrap());
        all.extend(data.chunks_exact(16).map(|t| [0, 4, 8, 12].map(|i| float(&t[i..i + 4]))));
    }
    (decoder, all)
}

#[test]
fn every_format_decodes_to_its_values() {
    let f = |storage, formats: [Format; 4]| (storage, formats);
    for (storage, formats) in [
        f(
            Storage::Half,
            [Format::R16_FLOAT, Format::R16G16_FLOAT, Format::R16G16B16A16_FLOAT, Format::R16G16B16A16_FLOAT],
        ),
        f(
            Storage::Float,
            [Format::R32_FLOAT, Format::R32G32_FLOAT, Format::R32G32B32_FLOAT, Format::R32G32B32A32_FLOAT],
        ),
        f(
            Storage::Unorm8,
            [Format::R8_UNORM, Format::R8G8_UNORM, Format::R8G8B8A8_UNORM, Format::R8G8B8A8_UNORM],
        ),
        f(
            Storage::Unorm16,
            [Format::R16_UNORM, Format::R16G16_UNORM, Format::R16G16B16A16_UNORM, Format::R16G16B16A16_UNORM],
        ),
        f(Storage::Rgb10a2, [Format::R10G10B10A2_UNORM; 4]),
        f(Storage::R11g11b10, [Format::R11G11B10_FLOAT; 4]),
        f(Storage::Rgb9e5, [Format::R9G9B9E5_SHAREDEXP; 4]),
        f(Storage::Bc4, [Format::BC4_UNORM; 4]),
        f(Storage::Bc5, [Format::BC5_UNORM; 4]),
        f(Storage::Bc6h, [Format::BC6H_UF16; 4]),
        f(Storage::Bc6hSigned, [Format::BC6H_SF16; 4]),
    ] {
        for channels in 1..=storage.most_channels().unwrap_or(4) {
            let t = table(&[5, 3], channels);
            let (bytes, values) = written(&t, "dds", storage, &[]).unwrap();
            let (decoder, texels) = decoded(&bytes);
            assert_eq!(decoder.format(), formats[channels - 1], "{storage:?}");
            assert!(decoder.layout().is_texture());
            for (got, want) in texels.iter().zip(values.chunks_exact(channels)) {
                for (c, want) in want.iter().enumerate() {
                    // the decoder divides codes in f32
                    let exact = !storage.is_bounded();
                    let error = (f64::from(got[c]) - want).abs();
                    assert!(error <= if exact { 0.0 } else { 1e-7 }, "{storage:?}: {} {want}", got[c]);
                }
                if channels == 3 && !storage.is_block() {
                    assert_eq!(got[3], 1.0);
                }
            }
        }
    }
}

#[test]
fn volumes_and_arrays() {
    let shapes = [(&[6, 5, 3][..], &[][..]), (&[6, 5, 3], &[FileOption::Layers]), (&[6, 5, 3, 2], &[])];
    for ((lengths, options), storage) in
        shapes.into_iter().flat_map(|s| [Storage::Half, Storage::Bc6h].map(|storage| (s, storage)))
    {
        let t = table(lengths, 2);
        let (bytes, values) = written(&t, "dds", storage, options).unwrap();
        let (decoder, texels) = decoded(&bytes);
        let layout = decoder.layout();
        if lengths.len() == 3 && options.is_empty() {
            assert_eq!(layout.volume().unwrap().main().depth(), 3);
        } else {
            assert_eq!(layout.texture_array().unwrap().len(), lengths[2..].iter().product::<usize>());
        }
        let read: Vec<f64> = texels.iter().flat_map(|t| [t[0], t[1]]).map(f64::from).collect();
        assert_eq!(read, values);
    }
}

#[test]
fn the_reserved_words_lead_to_the_recipe() {
    let (bytes, _) = written(&table(&[2, 2], 1), "dds", Storage::Half, &[]).unwrap();
    assert_eq!(&bytes[32..40], b"brdfbake");
    // the hash of the sample is 0123
    assert_eq!(bytes[40..43], [0x01, 0x23, 0]);
}
