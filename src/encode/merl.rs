//! The binary of the MERL database: three little-endian i32 (90, 90, 180), then red, green and blue as f64 planes.
//!
//! A plane is `[theta_h][theta_d][phi_d]`, phi_d fastest. The published reader multiplies the planes by 1/1500, 1.15/1500 and
//! 1.66/1500, so they hold f times the inverse: a reader gets f back to 2 ulp of f64. The format has no place for
//! metadata: the manifest beside the file says what it holds. With `float` values are rounded to 32-bit floats first, as measured
//! data have far fewer digits than f64; `double` keeps all digits.
//!
//! A file is read as a picture 180 wide, with the 90 rows of theta_d below each other for each theta_h: channels R, G, B.
//!
//! Source: [Matusik2003](crate::cite::MATUSIK_2003) and the reader that is published with the database.

use super::read::{Plane, Sample};
use super::{EncodeError, EncodeInput, Encoder, Image, ReadError, Shape, Storage};
use crate::cancel::Cancel;
use crate::grid::{Grid, Texel, Warp};

/// The container. See the module.
#[derive(Debug, Clone, Copy)]
pub struct Merl;

/// What the reader multiplies red, green and blue by.
pub const SCALES: [f64; 3] = [1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0];

/// Quantity, texels, and the power of the warp of each axis, phi_d first.
const AXES: [(&str, usize, f64); 3] = [("phi_d", 180, 1.0), ("theta_d", 90, 1.0), ("theta_h", 90, 0.5)];

impl Encoder for Merl {
    fn id(&self) -> &'static str {
        "merl"
    }

    fn extension(&self) -> &'static str {
        "binary"
    }

    fn storages(&self) -> &'static [Storage] {
        &[Storage::Float, Storage::Double]
    }

    /// One channel is grey, three are a colour; the axes are those of the database.
    fn check_size(&self, shape: &Shape<'_>) -> Result<(), EncodeError> {
        if shape.channels == 2 {
            return Err(EncodeError::Channels {
                format: self.id(),
                storage: shape.storage.id(),
                count: 2,
                limit: 3,
            });
        }
        if !holds(shape.grid) {
            let fault = "it takes the axes of the table kind `merl` only: phi_d 180, theta_d 90, theta_h 90 with warp sqrt, \
                         whole domains, texel centers";
            return Err(EncodeError::Axes { format: self.id(), fault });
        }
        Ok(())
    }

    fn most_channels(&self) -> usize {
        3
    }

    fn holds_metadata(&self) -> bool {
        false
    }

    /// One channel is written three times.
    fn names(&self, _shape: &Shape<'_>) -> &'static [&'static str] {
        &COLOURS
    }

    fn magic(&self) -> &'static [&'static [u8]] {
        &[&[90, 0, 0, 0, 90, 0, 0, 0, 180, 0, 0, 0]]
    }

    fn read(&self, bytes: &[u8], cancel: &Cancel) -> Result<Image, ReadError> {
        let texels = AXES.iter().map(|a| a.1).product::<usize>();
        let (expected, got) = (12 + 24 * texels, bytes.len());
        if got != expected {
            let fault = format!("the file has {got} bytes, the binary of the database takes {expected}");
            return Err(ReadError::Fault { format: self.id(), fault });
        }
        let plane = |(c, numbers): (usize, &[u8])| Plane {
            name: COLOURS[c].to_owned(),
            sample: Sample::Double,
            range: [0.0, 1.0],
            values: numbers
                .chunks_exact(8)
                .take_while(|_| !cancel.is_set())
                .map(|b| double(b) * SCALES[c])
                .collect(),
        };
        Ok(Image {
            format: self.id(),
            width: AXES[0].1,
            height: AXES[1].1 * AXES[2].1,
            channels: bytes[12..].chunks_exact(8 * texels).enumerate().map(plane).collect(),
            provenance: None,
            warnings: Vec::new(),
        })
    }

    /// Three planes of f64, whatever the channels.
    fn most_bytes(&self, shape: &Shape<'_>) -> usize {
        12 + 24 * shape.grid.len()
    }

    fn encode(&self, input: &EncodeInput<'_>) -> Result<Vec<u8>, EncodeError> {
        input.check(self)?;
        let channels = input.channels.len();
        let texels = input.grid.len();
        let mut bytes = Vec::with_capacity(12 + 24 * texels);
        for length in [90i32, 90, 180] {
            bytes.extend_from_slice(&length.to_le_bytes());
        }
        for (colour, scale) in SCALES.into_iter().enumerate() {
            // one channel is grey
            let channel = colour.min(channels - 1);
            for texel in input.values.chunks_exact(channels) {
                bytes.extend_from_slice(&(texel[channel] / scale).to_le_bytes());
            }
        }
        Ok(bytes)
    }
}

/// Names of the planes.
const COLOURS: [&str; 3] = ["R", "G", "B"];

fn double(bytes: &[u8]) -> f64 {
    bytes.try_into().map_or(f64::NAN, f64::from_le_bytes)
}

/// Are these the axes of the database?
fn holds(grid: &Grid) -> bool {
    let axes = grid.axes();
    axes.len() == AXES.len()
        && axes.iter().zip(AXES).all(|(axis, (id, len, power))| {
            let warp = match axis.warp {
                Warp::Linear => 1.0,
                Warp::Power(p) => p,
                _ => f64::NAN,
            };
            let ends = axis.domain.iter().zip(axis.quantity.domain);
            let whole = ends.fold(0.0, |d, (a, b)| d + (a - b).abs()) == 0.0 && axis.clamp.is_none();
            let plain = axis.offset.abs() == 0.0 && axis.value(0, 0.0) < axis.value(1, 0.0);
            axis.quantity.id == id
                && axis.len == len
                && axis.texel == Texel::Center
                && (warp - power).abs() == 0.0
                && whole
                && plain
        })
}
