//! Storages and containers: what is written is what is read, bit for bit.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::float_cmp,
    reason = "tests: stored values are exact"
)]

use crate::sample::{channel, file, hard, provenance, table};
use brdfbake::encode::read::{Claim, Sample, read_bytes};
use brdfbake::encode::{ENCODERS, EncodeError, EncodeInput, Label, encoder, quantise_table};
use brdfbake::encode::{QuantiseError, STORAGES, Storage};
use brdfbake::grid::{Axis, Channel, Grid, Table, Texel};
use proptest::prelude::*;

const UNIT: [f64; 2] = [0.0, 1.0];

/// The neighbour of a positive number.
fn next(x: f64, up: bool) -> f64 {
    if up { f64::from_bits(x.to_bits() + 1) } else { f64::from_bits(x.to_bits() - 1) }
}

/// Value of a non-negative half by the definition of IEEE 754: `(1 + m / 2^10) 2^(e - 15)`, subnormal `m 2^-24`.
fn half(bits: u32) -> f64 {
    let (e, m) = (bits >> 10, f64::from(bits & 0x3ff));
    if e == 0 { m / 16777216.0 } else { (1024.0 + m) * f64::from(1 << (e - 1)) / 16777216.0 }
}

#[test]
fn half_rounds_every_interval_to_the_nearest_even() {
    let q = |v: f64| Storage::Half.quantise(v, UNIT).unwrap();
    for bits in 0..0x7bff {
        let (a, b) = (half(bits), half(bits + 1));
        let middle = (a + b) / 2.0;
        let even = if bits % 2 == 0 { a } else { b };
        for (v, expected) in
            [(a, a), (b, b), (middle, even), (next(middle, false), a), (next(middle, true), b)]
        {
            assert_eq!(q(v).to_bits(), expected.to_bits(), "{v:e} between {a:e} and {b:e}");
            assert_eq!(q(-v).to_bits(), (-expected).to_bits());
        }
        assert_eq!(Storage::Half.ulp(a, UNIT), b - a);
    }
}

#[test]
fn half_does_not_round_twice() {
    // Rounded to f32 first, this is the tie 1 + 2^-11, which then goes to 1.
    let v = 1.0 + 1.0 / 2048.0 + f64::EPSILON;
    assert_eq!(Storage::Half.quantise(v, UNIT).unwrap(), 1.0 + 1.0 / 1024.0);
}

#[test]
fn overflow_is_a_finding() {
    let q = |s: Storage, v: f64| s.quantise(v, UNIT);
    assert_eq!(q(Storage::Half, 65504.0), Ok(65504.0));
    assert_eq!(q(Storage::Half, next(65520.0, false)), Ok(65504.0));
    let error = q(Storage::Half, 65520.0).unwrap_err();
    assert_eq!(error, QuantiseError::Overflow { value: 65520.0, limit: 65504.0, storage: "half" });
    assert_eq!(error.to_string(), "value 65520 overflows half: the largest is 65504");
    assert!(q(Storage::Half, -1e300).is_err());
    assert_eq!(q(Storage::Float, f64::from(f32::MAX)), Ok(f64::from(f32::MAX)));
    assert!(q(Storage::Float, 3.5e38).is_err());
    for storage in STORAGES {
        for v in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(matches!(q(*storage, v), Err(QuantiseError::NotFinite { .. })));
        }
    }
}

#[test]
fn unorm16_has_every_code_and_nothing_beyond_its_range() {
    for range in [UNIT, [-0.18, 0.002], [0.0, 6.25], [-1.0, 1.0]] {
        let [lo, hi] = range;
        let q = |v: f64| Storage::Unorm16.quantise(v, range);
        for code in 0..=65535 {
            let v = lo + f64::from(code) / 65535.0 * (hi - lo);
            assert_eq!(q(v), Ok(v));
        }
        let step = (hi - lo) / 65535.0;
        assert_eq!(Storage::Unorm16.ulp(lo, range), step);
        for outside in [lo - 1e-9, hi + 1e-9] {
            assert!(matches!(q(outside), Err(QuantiseError::OutOfRange { .. })), "{outside}");
        }
    }
    let q = |v: f64| Storage::Unorm16.quantise(v, UNIT);
    assert_eq!(q(0.5), Ok(32768.0 / 65535.0), "32767.5 goes to the even code");
    assert_eq!(q(1.5 / 65535.0), Ok(2.0 / 65535.0));
    assert_eq!(q(0.5 / 65535.0).map(f64::to_bits), Ok(0));
    // Noise of sums is rounding, not a finding.
    assert_eq!(q(1.0 + 4.0 * f64::EPSILON), Ok(1.0));
    assert_eq!(q(-f64::EPSILON).map(f64::to_bits), Ok(0));
    let empty = Storage::Unorm16.quantise(1.0, [1.0, 1.0]).unwrap_err();
    let expected = "unorm16 needs a finite range with lo < hi, got [1, 1]; store it as half or float";
    assert_eq!(empty.to_string(), expected);
}

#[test]
fn default_tolerances_are_half_a_step_below_one() {
    let steps = STORAGES.iter().map(|s| s.default_tolerance()).collect::<Vec<_>>();
    let codes = [0.5 / 255.0, 0.5 / 65535.0, 0.5 / 1023.0];
    assert_eq!(steps[..3], [1.0 / 4096.0, 1.0 / 33554432.0, 1e-9]);
    assert_eq!(steps[3..6], codes);
    assert_eq!(steps[6..9], [1.0 / 256.0, 1.0 / 1024.0, 1.0 / 512.0]);
    // blocks: the finest ramp of BC4 and BC5 has sevenths of 1/255, halfs their bits
    assert_eq!(steps[10..12], [0.5 / 1785.0; 2]);
    assert_eq!(steps[12..14], [1.0 / 4096.0; 2]);
    for storage in STORAGES {
        if !matches!(storage, Storage::Double | Storage::R11g11b10 | Storage::Rgbd) {
            assert_eq!(storage.ulp(0.75, UNIT), 2.0 * storage.default_tolerance());
        }
        assert_eq!(Storage::find(storage.id()), Some(*storage));
    }
}

proptest! {
    #[test]
    fn float_rounds_as_the_processor_does(bits in any::<u64>(), small in -1e-37..1e-37f64, near in -4.0..4.0f64) {
        for v in [f64::from_bits(bits), small, small * 1e-7, near] {
            #[allow(clippy::cast_possible_truncation, reason = "the reference is the rounding of `as`")]
            let expected = f64::from(v as f32);
            match Storage::Float.quantise(v, UNIT) {
                Ok(got) => prop_assert_eq!(got.to_bits(), expected.to_bits()),
                Err(_) => prop_assert!(!expected.is_finite()),
            }
        }
    }
}

#[test]
fn a_table_names_the_texel_that_does_not_fit() {
    let mut t = table(&["albedo"], |_, x| x);
    let rounded = quantise_table(&t, Storage::Half).unwrap();
    let worst = t.values.iter().zip(&rounded.values).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert_eq!(rounded.largest_error.value, worst);
    assert!(worst > 0.0 && worst <= Storage::Half.default_tolerance());
    t.values[5] = 1.25;
    let fault = quantise_table(&t, Storage::Unorm16).unwrap_err();
    assert_eq!((fault.texel, fault.channel.as_str()), (5, "albedo"));
    let expected = "channel albedo at mu = 0.617347, roughness = 0.1: value 1.25 outside the range [0, 1] that \
                    unorm16 encodes; store it as half or float";
    assert_eq!(fault.to_string(), expected);
}

#[test]
fn every_container_gives_back_every_bit() {
    let names = ["dfg.scale", "dfg.bias", "a", "z.cloth"];
    // `merl` holds one shape of table
    for encoder in ENCODERS.iter().filter(|e| !e.magic().is_empty() && e.id() != "merl") {
        for &storage in encoder.storages() {
            let most = encoder.most_channels().min(storage.most_channels().unwrap_or(4)).min(4);
            for n in 1..=most {
                let t = table(&names[..n], hard(storage));
                let p = provenance(&t, storage);
                let rounded = quantise_table(&t, storage).unwrap().values;
                let image = read_bytes(&file(*encoder, &t, storage, &p)).unwrap();
                assert_eq!((image.format, image.width, image.height), (encoder.id(), 7, 5));
                assert!(image.channels.len() == n || !encoder.holds_metadata());
                if encoder.holds_metadata() {
                    assert_eq!(image.known(), Some(&p));
                    assert_eq!(image.contradictions(), Vec::<String>::new());
                } else if storage.is_bounded() || storage == Storage::Rgbd || image.channels.len() != n {
                    // without metadata the components have neither names nor meaning
                    continue;
                }
                for (c, name) in names[..n].iter().enumerate() {
                    let plane = image.channel(name).unwrap_or(&image.channels[c]);
                    assert_eq!(plane.sample.id(), storage.id());
                    let bits = |v: &f64| v.to_bits();
                    let expected: Vec<u64> = rounded.iter().skip(c).step_by(n).map(bits).collect();
                    assert_eq!(plane.values.iter().map(bits).collect::<Vec<_>>(), expected);
                }
            }
        }
    }
}

#[test]
fn rows_run_down_and_slices_are_stacked() {
    let axis = |id: &str, len| Axis::new(brdfbake::grid::Quantity::find(id).unwrap(), len, Texel::Endpoint);
    for (axes, size) in [
        (vec![axis("mu", 3)], (3, 1)),
        (vec![axis("mu", 3), axis("alpha", 2)], (3, 2)),
        (vec![axis("mu", 3), axis("alpha", 2), axis("f0", 4)], (3, 8)),
    ] {
        let grid = Grid::new(axes).unwrap();
        let values: Vec<f64> = (0..grid.len()).map(|i| i as f64 / 64.0).collect();
        let channels = [channel("v")];
        let input = EncodeInput {
            grid: &grid,
            channels: &channels,
            values: &values,
            blocks: &[],
            errors: &[],
            storage: Storage::Half,
            options: &[],
            label: Label::default(),
            cancel: &brdfbake::cancel::Cancel::new(),
        };
        let image = read_bytes(&encoder("exr").unwrap().encode(&input).unwrap()).unwrap();
        assert_eq!((image.width, image.height), size);
        assert_eq!(image.channels[0].values, values);
    }
}

#[test]
fn the_same_table_gives_the_same_bytes() {
    let t = table(&["dfg.scale", "dfg.bias"], |_, x| x);
    for encoder in ENCODERS.iter().filter(|e| e.id() != "merl") {
        let storage = encoder.storages()[0];
        let p = provenance(&t, storage);
        let first = file(*encoder, &t, storage, &p);
        assert!((1..8).all(|_| file(*encoder, &t, storage, &p) == first), "{}", encoder.id());
    }
}

#[test]
fn metadata_is_utf8_and_alone() {
    let t = table(&["v"], |_, x| x);
    let text = "{\"formula\": \"∫ D cosθ dω ≤ 1\"}";
    for encoder in ENCODERS.iter().filter(|e| e.holds_metadata() && !e.magic().is_empty()) {
        let storage = encoder.storages()[0];
        let values = quantise_table(&t, storage).unwrap().values;
        let input = EncodeInput {
            grid: &t.grid,
            channels: &t.channels,
            values: &values,
            blocks: &[],
            errors: &[],
            storage,
            options: &[],
            label: Label { provenance_json: text, ..Label::default() },
            cancel: &brdfbake::cancel::Cancel::new(),
        };
        let bytes = encoder.encode(&input).unwrap();
        let at = bytes.windows(text.len()).filter(|w| *w == text.as_bytes()).count();
        assert_eq!(at, 1, "{}", encoder.id());
        match read_bytes(&bytes).unwrap().provenance {
            Some(Claim::Unknown { text: got, fault }) => {
                assert_eq!(got, text);
                assert!(fault.contains("missing field"), "{fault}");
            }
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn png_claims_linear_samples_and_no_profile() {
    let t = table(&["a", "b"], |_, x| x);
    let bytes = file(encoder("png").unwrap(), &t, Storage::Unorm16, &provenance(&t, Storage::Unorm16));
    let reader = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
    let info = reader.info();
    assert_eq!(info.gama_chunk.map(png::ScaledFloat::into_scaled), Some(100_000));
    assert!(info.srgb.is_none() && info.icc_profile.is_none() && info.chrm_chunk.is_none());
    assert_eq!((info.color_type, info.bit_depth), (png::ColorType::Rgb, png::BitDepth::Sixteen));
}

#[test]
fn a_blue_that_is_not_empty_is_not_hidden() {
    let t = table(&["a", "b", "c"], |_, x| x);
    let two = Table { channels: t.channels[..2].to_vec(), ..t.clone() };
    let image =
        read_bytes(&file(encoder("png").unwrap(), &t, Storage::Unorm16, &provenance(&two, Storage::Unorm16)));
    let image = image.unwrap();
    assert_eq!(image.channels.iter().map(|c| c.name.as_str()).collect::<Vec<_>>(), ["a", "b", "B"]);
    assert_eq!(image.contradictions(), ["the picture has channel `B`, the metadata does not name it"]);
}

#[test]
fn containers_refuse_what_they_cannot_hold() {
    let t = table(&["a", "b", "c", "d", "e"], |_, x| x);
    let values = quantise_table(&t, Storage::Unorm16).unwrap().values;
    let good = EncodeInput {
        grid: &t.grid,
        channels: &t.channels[..1],
        values: &values[..35],
        blocks: &[],
        errors: &[],
        storage: Storage::Unorm16,
        options: &[],
        label: Label::default(),
        cancel: &brdfbake::cancel::Cancel::new(),
    };
    let (png, exr) = (encoder("png").unwrap(), encoder("exr").unwrap());
    let message = |e: Result<Vec<u8>, EncodeError>| e.unwrap_err().to_string();
    assert!(png.encode(&good).is_ok());
    let many = EncodeInput { channels: &t.channels, values: &values, ..good };
    assert_eq!(message(png.encode(&many)), "png:unorm16 cannot hold 5 channels; it holds 1 to 4");
    assert_eq!(message(exr.encode(&good)), "exr cannot store unorm16; it can store half, float");
    let none = EncodeInput { channels: &[], values: &[], ..good };
    assert_eq!(message(png.encode(&none)), "png:unorm16 cannot hold 0 channels; it holds 1 to 4");
    let short = EncodeInput { values: &values[..34], ..good };
    assert_eq!(message(png.encode(&short)), "34 values for 35 texels of 1 channels");
    let mut raw = values[..35].to_vec();
    raw[3] = 0.3;
    let raw = EncodeInput { values: &raw, ..good };
    let expected = "texel 3, channel a: 0.3 is not a unorm16 number; round the table first";
    assert_eq!(message(png.encode(&raw)), expected);
    let twice = [t.channels[0].clone(), t.channels[0].clone()];
    let twice = EncodeInput { channels: &twice, values: &values[..70], ..good };
    assert_eq!(message(png.encode(&twice)), "channel id `a`: is there twice");
    let long = [Channel { id: "x".repeat(256), ..t.channels[0].clone() }];
    let long = EncodeInput { channels: &long, ..good };
    assert!(message(png.encode(&long)).ends_with("is longer than 255 bytes"));
}

#[test]
fn codes_of_a_foreign_png_are_parts_of_one() {
    let mut bytes = Vec::new();
    let mut writer = png::Encoder::new(&mut bytes, 2, 1);
    writer.set_color(png::ColorType::GrayscaleAlpha);
    writer.write_header().unwrap().write_image_data(&[0, 255, 51, 102]).unwrap();
    let image = read_bytes(&bytes).unwrap();
    assert_eq!(image.channel("Y").unwrap().values, [0.0, 51.0 / 255.0]);
    assert_eq!(image.channel("A").unwrap().values, [1.0, 102.0 / 255.0]);
    assert_eq!(image.channels[0].sample, Sample::Unorm8);
}
