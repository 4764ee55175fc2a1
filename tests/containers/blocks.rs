//! Blocks of 4 x 4 texels: decoding against the crate `dds`, choices against every choice there is.

use super::dds_file::decoded;
use super::support::{table, written};
use crate::tolerance::{DIGITS_LOST, near};
use brdfbake::encode::read::read_bytes;
use brdfbake::encode::{EncodeError, EncodeInput, Label, Quantised, Storage, encoder, quantise_table};
use brdfbake::grid::Table;

/// Numbers without pattern.
fn random() -> impl FnMut() -> u64 {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state
    }
}

/// A table of `channels` with these values.
fn with(lengths: &[usize], channels: usize, value: impl Fn(usize) -> f64) -> Table {
    let t = table(lengths, channels);
    Table { values: (0..t.values.len()).map(value).collect(), ..t }
}

fn largest_error(table: &Table, stored: &Quantised) -> f64 {
    table.values.iter().zip(&stored.values).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn any_block_decodes_as_elsewhere() {
    let mut next = random();
    for (storage, channels) in
        [(Storage::Bc4, 1), (Storage::Bc5, 2), (Storage::Bc6h, 3), (Storage::Bc6hSigned, 3)]
    {
        let (mut file, _) = written(&with(&[256, 256], channels, |_| 0.5), "dds", storage, &[]).unwrap();
        for (i, block) in (0u8..=255).cycle().zip(file[148..].chunks_exact_mut(16)) {
            block[..8].copy_from_slice(&next().to_le_bytes());
            block[8..].copy_from_slice(&next().to_le_bytes());
            if channels == 3 {
                // all modes alike, the four reserved ones included
                block[0] = (block[0] & !31) | (i % 32);
            }
        }
        let image = read_bytes(&file).unwrap();
        let (_, texels) = decoded(&file);
        for (c, plane) in image.channels.iter().enumerate() {
            for (i, (got, texel)) in plane.values.iter().zip(&texels).enumerate() {
                let want = f64::from(texel[c]);
                // ramps are rounded to f32 there
                let allowed = if channels == 3 { 0.0 } else { 1e-7 };
                let same = (got - want).abs() <= allowed || got.to_bits() == want.to_bits();
                assert!(same, "{storage:?}, texel {i}, component {c}: {got} for {want}");
            }
        }
    }
}

/// Smallest largest error of a ramp, over every pair of endpoints in both modes.
fn best_ramp(texels: &[f64]) -> f64 {
    let mut best = f64::INFINITY;
    for a in 0..=255u32 {
        for b in 0..=255u32 {
            let parts = if a > b { 7 } else { 5 };
            let mut numbers: Vec<f64> =
                (0..=parts).map(|i| f64::from((parts - i) * a + i * b) / f64::from(parts) / 255.0).collect();
            if a <= b {
                numbers.extend([0.0, 1.0]);
            }
            let error = |v: &f64| numbers.iter().map(|n| (n - v).abs()).fold(f64::INFINITY, f64::min);
            best = texels.iter().map(error).fold(0.0, f64::max).min(best);
        }
    }
    best
}

#[test]
fn no_ramp_is_better() {
    let mut next = random();
    for case in 0..24u32 {
        let [low, high] = [(0.0, 1.0), (0.0, 0.02), (0.97, 1.0), (0.4, 0.47)][case as usize % 4].into();
        let spread = |x: f64| if case.is_multiple_of(3) { x * x * x } else { x };
        let texels: Vec<f64> = (0..16)
            .map(|_| low + (high - low) * spread((next() >> 11) as f64 / (1u64 << 53) as f64))
            .collect();
        let t = with(&[4, 4], 1, |i| texels[i]);
        let stored = quantise_table(&t, Storage::Bc4).unwrap();
        let (got, best) = (largest_error(&t, &stored), best_ramp(&texels));
        near!(got, best, DIGITS_LOST, "case {case}: {got} where {best} is possible");
        assert_eq!(stored.largest_error.value, got);
    }
}

#[test]
fn a_flat_block_holds_every_half() {
    for (storage, sign) in [(Storage::Bc6h, 1.0), (Storage::Bc6hSigned, -1.0)] {
        for first in (0..31744u16).step_by(2048) {
            // one half for each block of 4 x 4, of three channels that have nothing to do with each other
            let half = |i: usize| {
                let (texel, c) = (i / 3, i % 3);
                let block = texel / 4 % 16 + texel / 64 / 4 * 16;
                let bits = (usize::from(first) + 8 * block + [0, 12345, 6789][c]) % 31744;
                sign * half::f16::from_bits(u16::try_from(bits).unwrap()).to_f64()
            };
            let t = with(&[64, 64], 3, half);
            let stored = quantise_table(&t, storage).unwrap();
            assert_eq!(largest_error(&t, &stored), 0.0);
        }
    }
}

#[test]
fn a_bc6h_block_is_at_least_as_good_as_a_plain_one() {
    // the plain block: mode 11, extremes of each channel as ends, nearest of sixteen numbers evenly spaced
    let mut next = random();
    let mut uniform = || (next() >> 11) as f64 / (1u64 << 53) as f64;
    let (mut ours, mut plain) = (0.0, 0.0);
    for _ in 0..64 {
        let [a, b, bend] = [uniform(), uniform(), uniform()];
        let smooth = |i: usize| {
            let (x, y) = ((i / 2 % 4) as f64, (i / 8) as f64);
            let line = a + (b - a) * (x + 0.5 * y) / 4.5;
            (0.1 + 0.8 * if i.is_multiple_of(2) { line } else { (1.0 - line) * (0.5 + 0.5 * bend * x / 3.0) })
                .abs()
        };
        let t = with(&[4, 4], 2, smooth);
        let stored = quantise_table(&t, Storage::Bc6h).unwrap();
        ours += largest_error(&t, &stored);
        let channel = |c: usize| t.values.iter().skip(c).step_by(2).copied();
        let [lo, hi] =
            [f64::min, f64::max].map(|f| [0, 1].map(|c| channel(c).fold(channel(c).next().unwrap(), f)));
        // both channels share the index; the second one runs up or down with it
        let run = |swap: bool| {
            let ends = if swap { [[lo[0], hi[1]], [hi[0], lo[1]]] } else { [lo, hi] };
            let error = |texel: &[f64]| {
                let at = |k: u32| {
                    let w = f64::from(k) / 15.0;
                    (0..2)
                        .map(|c| (ends[0][c] * (1.0 - w) + ends[1][c] * w - texel[c]).abs())
                        .fold(0.0, f64::max)
                };
                (0..16).map(at).fold(f64::INFINITY, f64::min)
            };
            t.values.chunks_exact(2).map(error).fold(0.0, f64::max)
        };
        plain += run(false).min(run(true));
    }
    assert!(ours < 0.7 * plain, "{ours} against {plain}");
}

#[test]
fn edges_slices_and_signs() {
    for storage in [Storage::Bc4, Storage::Bc5, Storage::Bc6h, Storage::Bc6hSigned] {
        for lengths in [&[1][..], &[5], &[4, 4], &[6, 9], &[6, 5, 3], &[3, 2, 2, 2]] {
            for channels in 1..=storage.most_channels().unwrap() {
                let sign =
                    |i: usize| if storage == Storage::Bc6hSigned && i.is_multiple_of(3) { -1.0 } else { 1.0 };
                let t = with(lengths, channels, |i| sign(i) * (i as f64 * 0.37 + 0.2).fract());
                for container in ["dds", "ktx2"] {
                    let (bytes, values) = written(&t, container, storage, &[]).unwrap();
                    let image = read_bytes(&bytes).unwrap();
                    for c in 0..channels {
                        let expected: Vec<f64> = values.iter().skip(c).step_by(channels).copied().collect();
                        assert_eq!(image.channels[c].values, expected, "{storage:?} {lengths:?} {container}");
                    }
                    for rest in image.channels.iter().skip(channels) {
                        assert!(rest.values.iter().all(|v| v.to_bits() == 0));
                    }
                }
            }
        }
    }
}

#[test]
fn ranges_are_those_of_the_channels() {
    let mut t =
        with(&[8, 8], 2, |i| if i.is_multiple_of(2) { -3.0 + 6.0 * i as f64 / 127.0 } else { 1.0 + 1e-9 });
    (t.channels[0].range, t.channels[1].range) = ([-3.0, 3.0], [0.0, 1.0]);
    // within its own error of the end: the end
    t.errors = vec![2e-9; 128];
    let stored = quantise_table(&t, Storage::Bc5).unwrap();
    assert!(stored.values.iter().skip(1).step_by(2).all(|v| *v == 1.0));
    assert!(largest_error(&t, &stored) < 6.0 / 14.0, "{}", largest_error(&t, &stored));
    assert!(stored.values.iter().step_by(2).any(|v| *v < -2.7));
}

#[test]
fn what_blocks_cannot_hold_is_a_finding() {
    let fault = |storage, v: f64| {
        let t = with(&[5, 5], 1, |i| if i == 7 { v } else { 0.5 });
        let fault = quantise_table(&t, storage).unwrap_err();
        assert_eq!(fault.texel, 7);
        fault.fault.to_string()
    };
    let beyond = "value 1.001 outside the range [0, 1] that bc4 encodes; store it as half or float";
    assert_eq!(fault(Storage::Bc4, 1.001), beyond);
    let negative = "value -0.001 is negative and bc6h has no sign; store it as half or float";
    assert_eq!(fault(Storage::Bc6h, -0.001), negative);
    assert_eq!(fault(Storage::Bc6h, 65520.0), "value 65520 overflows bc6h: the largest is 65504");
    assert_eq!(
        fault(Storage::Bc6hSigned, -1e6),
        "value -1000000 overflows bc6h-signed: the largest is 65504"
    );
    assert_eq!(fault(Storage::Bc5, f64::NAN), "value NaN is not a finite number");
    let three = quantise_table(&table(&[4, 4], 3), Storage::Bc5).unwrap_err().to_string();
    assert!(three.ends_with("bc5 holds at most 2 channels, the table has 3"), "{three}");
}

#[test]
fn bytes_that_are_not_those_of_the_values_are_refused() {
    let t = table(&[6, 5], 2);
    let stored = quantise_table(&t, Storage::Bc6h).unwrap();
    let good = EncodeInput {
        grid: &t.grid,
        channels: &t.channels,
        values: &stored.values,
        blocks: &stored.blocks,
        errors: &[],
        storage: Storage::Bc6h,
        options: &[],
        label: Label::default(),
        cancel: &brdfbake::cancel::Cancel::new(),
    };
    let dds = encoder("dds").unwrap();
    let message = |input: &EncodeInput<'_>| match dds.encode(input) {
        Ok(_) => String::new(),
        Err(e) => e.to_string(),
    };
    assert_eq!(message(&good), "");
    let none = "0 bytes of blocks for bc6h, which needs 64: hand over those that came with the values";
    assert_eq!(message(&EncodeInput { blocks: &[], ..good }), none);
    let needless = message(&EncodeInput { storage: Storage::Half, ..good });
    assert!(needless.starts_with("64 bytes of blocks for half, which needs 0"), "{needless}");
    let raw = EncodeInput { values: &t.values, ..good };
    assert!(matches!(dds.encode(&raw), Err(EncodeError::NotQuantised { texel: 0, .. })));
    // a block whose third component is not empty
    let mut other = stored.blocks.clone();
    let three = quantise_table(&table(&[6, 5], 3), Storage::Bc6h).unwrap();
    other[48..].copy_from_slice(&three.blocks[48..]);
    assert!(matches!(
        dds.encode(&EncodeInput { blocks: &other, ..good }),
        Err(EncodeError::NotQuantised { .. })
    ));
}

#[test]
fn any_number_of_threads_gives_the_same_blocks() {
    let t = table(&[21, 18], 2);
    for storage in [Storage::Bc5, Storage::Bc6h] {
        let blocks = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| quantise_table(&t, storage).unwrap().blocks)
        };
        assert_eq!(blocks(1), blocks(3));
    }
}
