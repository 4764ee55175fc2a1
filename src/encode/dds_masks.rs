//! Pixels of DDS without a format code: the header says which bits of a pixel are red, green, blue, alpha or luminance.
//!
//! Source: Microsoft, "DDS_PIXELFORMAT structure" of the DDS programming guide.

use super::read::{Plane, ReadError, Sample};
use crate::cancel::Cancel;

/// `DDPF_ALPHAPIXELS`, `DDPF_ALPHA`, `DDPF_RGB`, `DDPF_LUMINANCE`.
const ALPHA_PIXELS: u32 = 0x1;
const ALPHA: u32 = 0x2;
const RGB: u32 = 0x40;
const LUMINANCE: u32 = 0x2_0000;

/// The bits of a pixel.
pub(super) struct Masks {
    bytes: usize,
    /// Name, lowest bit and number of bits of each channel.
    channels: Vec<(&'static str, u32, u32)>,
}

impl Masks {
    /// From the flags, the bits of a pixel and the masks of red, green, blue and alpha.
    pub(super) fn new(flags: u32, bits: u32, masks: [u32; 4]) -> Result<Masks, ReadError> {
        if !matches!(bits, 8 | 16 | 24 | 32) {
            return Err(super::dds_read::fault(format!(
                "{bits} bits a pixel are not supported; 8, 16, 24, 32 are"
            )));
        }
        let named: &[(&str, usize)] = match () {
            () if flags & RGB != 0 => &[("R", 0), ("G", 1), ("B", 2), ("A", 3)],
            () if flags & LUMINANCE != 0 => &[("Y", 0), ("A", 3)],
            () if flags & ALPHA != 0 => &[("A", 3)],
            () => {
                let what = format!(
                    "pixels of flags {flags:#x} are not supported: neither a code, nor colours, luminance or alpha"
                );
                return Err(super::dds_read::fault(what));
            }
        };
        let told = |i: usize| i < 3 || flags & (ALPHA_PIXELS | ALPHA) != 0;
        let mut channels = Vec::new();
        let mut taken = 0u32;
        for &(name, i) in named.iter().filter(|(_, i)| told(*i) && masks[*i] != 0) {
            let mask = masks[i];
            let (low, count) = (mask.trailing_zeros(), mask.count_ones());
            let gap = (u64::from(mask) >> low) + 1 != 1u64 << count;
            if gap || mask & taken != 0 || u64::from(mask) >> bits != 0 {
                return Err(super::dds_read::fault(format!(
                    "mask {mask:#x} of {name} is not one run of {bits} bits of its own"
                )));
            }
            taken |= mask;
            channels.push((name, low, count));
        }
        if channels.is_empty() {
            return Err(super::dds_read::fault("no bit of a pixel has a meaning".to_owned()));
        }
        Ok(Masks { bytes: bits as usize / 8, channels })
    }

    pub(super) fn bytes(&self) -> usize {
        self.bytes
    }

    pub(super) fn channels(&self) -> usize {
        self.channels.len()
    }

    /// The planes of packed pixels, until it is stopped: codes of n bits over 2^n - 1.
    pub(super) fn unpack(&self, pixels: &[u8], cancel: &Cancel) -> Vec<Plane> {
        let sample = if self.channels.iter().all(|c| c.2 <= 8) { Sample::Unorm8 } else { Sample::Unorm16 };
        let plane = |&(name, ..): &(&str, u32, u32)| Plane {
            name: name.to_owned(),
            sample,
            range: [0.0, 1.0],
            values: Vec::with_capacity(pixels.len() / self.bytes),
        };
        let mut planes: Vec<Plane> = self.channels.iter().map(plane).collect();
        for pixel in pixels.chunks_exact(self.bytes).take_while(|_| !cancel.is_set()) {
            let word = pixel.iter().rev().fold(0u64, |w, &b| w << 8 | u64::from(b));
            for (plane, &(_, low, count)) in planes.iter_mut().zip(&self.channels) {
                let largest = (1u64 << count) - 1;
                plane.values.push((word >> low & largest) as f64 / largest as f64);
            }
        }
        planes
    }
}
