//! Coupled storages against an exhaustive search and the formulas of their readers.

use crate::tolerance::{DIGITS_LOST, near};
use brdfbake::encode::{QuantiseError, STORAGES, Storage};
use proptest::prelude::*;

const UNIT: [f64; 2] = [0.0, 1.0];

fn quantised(storage: Storage, mut texel: [f64; 3]) -> [f64; 3] {
    storage.quantise_texel(&mut texel, |_| UNIT).unwrap();
    texel
}

fn largest_error(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// The smallest possible largest error of a shared exponent, over every exponent.
fn shared_best(texel: [f64; 3], top: f64, exponents: std::ops::RangeInclusive<i32>) -> f64 {
    let error = |e: i32| {
        let step = 2f64.powi(e);
        let one = |v: &f64| ((v / step).round().min(top) * step - v).abs();
        texel.iter().map(one).fold(0.0, f64::max)
    };
    exponents.map(error).fold(f64::INFINITY, f64::min)
}

/// What Babylon.js computes from an RGBD texel: `pow(rgb, 2.2) / a`, components in [0, 1].
fn babylon(code: u8, d: u8) -> f64 {
    (f64::from(code) / 255.0).powf(2.2) / (f64::from(d) / 255.0)
}

proptest! {
    #[test]
    fn shared_exponents_are_the_best(
        r in 0.0..4.0f64, g in 0.0..1.0f64, b in 0.0..0.01f64, scale in -20..12i32,
    ) {
        let texel = [r, g, b].map(|v| v * 2f64.powi(scale));
        let got = largest_error(quantised(Storage::Rgb9e5, texel), texel);
        prop_assert_eq!(got, shared_best(texel, 511.0, -24..=7));
        let got = largest_error(quantised(Storage::Rgbe, texel), texel);
        prop_assert_eq!(got, shared_best(texel, 255.0, -135..=119));
    }

    #[test]
    fn rgbd_is_the_best_of_all_divisors(r in 0.0..1.0f64, g in 0.0..1.0f64, b in 0.0..1.0f64, scale in -4..7i32) {
        let texel = [r, g, b].map(|v| v * 2f64.powi(scale));
        let error = |d: u8| {
            let one = |v: &f64| (0..=255).map(|c| (babylon(c, d) - v).abs()).fold(f64::INFINITY, f64::min);
            texel.iter().map(one).fold(0.0, f64::max)
        };
        let best = (1..=255).map(error).fold(f64::INFINITY, f64::min);
        let got = largest_error(quantised(Storage::Rgbd, texel), texel);
        // an error is a difference of numbers as large as the texel
        let m = texel.iter().copied().fold(1e-6, f64::max);
        prop_assert!((got - best).abs() <= DIGITS_LOST * m, "{got} against {best}");
        // its own encoder takes floor(255 / largest)
        let theirs = error((255.0 / m).max(1.0).floor().min(255.0) as u8);
        prop_assert!(got <= theirs + DIGITS_LOST * m);
    }

    #[test]
    fn rounding_twice_changes_nothing(r in 0.0..1.0f64, g in 0.0..1.0f64, b in 0.0..1.0f64) {
        for &storage in STORAGES {
            let n = storage.most_channels().unwrap_or(3);
            let mut once = [r, g, b];
            storage.quantise_texel(&mut once[..n], |_| UNIT).unwrap();
            let mut twice = once;
            storage.quantise_texel(&mut twice[..n], |_| UNIT).unwrap();
            prop_assert_eq!(twice.map(f64::to_bits), once.map(f64::to_bits), "{:?}", storage);
        }
    }
}

#[test]
fn the_largest_of_a_texel_may_give_way() {
    // 511.7 steps: one step finer costs the first 0.7 steps, one coarser the second up to a whole one
    let step = 2f64.powi(-9);
    let texel = [511.6, 0.9, 3.0].map(|n| n * step);
    assert_eq!(quantised(Storage::Rgb9e5, texel), [511.0, 1.0, 3.0].map(|n| n * step));
    let texel = [511.9, 2.0, 4.0].map(|n| n * step);
    assert_eq!(quantised(Storage::Rgb9e5, texel), [512.0, 2.0, 4.0].map(|n| n * step));
}

#[test]
fn small_floats_have_every_number() {
    // unsigned, exponent of 5 bits with bias 15, mantissa of 6 (red, green) or 5 bits (blue)
    for (c, bits) in [(0, 6), (1, 6), (2, 5)] {
        let number = |code: u32| {
            let (e, m) = (code >> bits, f64::from(code & ((1 << bits) - 1)) / f64::from(1 << bits));
            if e == 0 { m * 2f64.powi(-14) } else { (1.0 + m) * 2f64.powi(e as i32 - 15) }
        };
        let last = (31 << bits) - 1;
        for code in 0..last {
            let (a, b) = (number(code), number(code + 1));
            let even = if code % 2 == 0 { a } else { b };
            for (v, expected) in [(a, a), ((a + b) / 2.0, even), (a + (b - a) * 0.51, b)] {
                let mut texel = [0.0; 3];
                texel[c] = v;
                assert_eq!(quantised(Storage::R11g11b10, texel)[c], expected);
            }
        }
        assert_eq!(number(last), [65024.0, 65024.0, 64512.0][c]);
    }
}

#[test]
fn what_cannot_be_stored_is_a_finding() {
    let fault = |s: Storage, v: f64| s.quantise(v, UNIT).unwrap_err();
    for s in [Storage::R11g11b10, Storage::Rgb9e5, Storage::Rgbe, Storage::Rgbd] {
        assert_eq!(fault(s, -0.01), QuantiseError::Negative { value: -0.01, storage: s.id() });
        assert_eq!(s.quantise(-1e-15, UNIT).unwrap().to_bits(), 0);
        assert!(matches!(fault(s, f64::NAN), QuantiseError::NotFinite { .. }));
        let four = s.quantise_texel(&mut [0.1; 4], |_| UNIT);
        assert_eq!(four, Err((3, QuantiseError::Channels { count: 4, limit: 3, storage: s.id() })));
    }
    for (s, largest, beyond) in [
        (Storage::R11g11b10, 65024.0, 65280.0),
        (Storage::Rgb9e5, 65408.0, 65473.0),
        (Storage::Rgbd, 255.0, 255.01),
    ] {
        assert_eq!(s.quantise(largest, UNIT), Ok(largest));
        assert_eq!(
            fault(s, beyond),
            QuantiseError::Overflow { value: beyond, limit: largest, storage: s.id() }
        );
    }
    // a sheen table: 9.13 is beyond every code, and never clamped
    for s in [Storage::Unorm8, Storage::Rgb10a2, Storage::Unorm16] {
        let expected = QuantiseError::OutOfRange { value: 9.13, lo: 0.0, hi: 1.0, storage: s.id() };
        assert_eq!(fault(s, 9.13), expected);
        near!(s.quantise(9.13, [0.0, 10.0]).unwrap(), 9.13, s.ulp(9.13, [0.0, 10.0]) / 2.0);
    }
}

#[test]
fn codes_are_rounded_to_even() {
    for (s, top) in [(Storage::Unorm8, 255.0), (Storage::Rgb10a2, 1023.0)] {
        for code in 0..top as u32 {
            let tie = (f64::from(code) + 0.5) / top;
            let got = (s.quantise(tie, UNIT).unwrap() * top).round();
            // the tie itself is rounded when it is computed: either neighbour, or the even one where it is exact
            assert!(got == f64::from(code) || got == f64::from(code + 1));
            if (tie * top).fract() == 0.5 {
                assert_eq!(got % 2.0, 0.0, "{code}");
            }
            assert_eq!(s.quantise(f64::from(code) / top, UNIT).unwrap(), f64::from(code) / top);
        }
    }
}
