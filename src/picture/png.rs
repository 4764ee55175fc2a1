//! PNG, opened in one place: as a picture and as a container of tables.

use super::read::Samples;
use png::{BitDepth, ColorType, DecodingError, Limits, Transformations};
use std::io::{BufRead, Seek};

/// A PNG image whose header was read.
pub(crate) struct Png<R: BufRead + Seek> {
    reader: png::Reader<R>,
    /// Bytes of a sample.
    size: usize,
    /// Channels of a pixel, once palettes and transparency are unfolded.
    pub(crate) channels: usize,
}

impl<R: BufRead + Seek> Png<R> {
    /// Reads what stands before the pixels. `limit`: bytes that the decoder may take for rows, text and profiles.
    pub(crate) fn open(file: R, limit: usize) -> Result<Png<R>, DecodingError> {
        let mut decoder = png::Decoder::new_with_limits(file, Limits { bytes: limit });
        // codes of fewer bits become 8, and 16 stay
        decoder.set_transformations(Transformations::EXPAND);
        let reader = decoder.read_info()?;
        let (colour, depth) = reader.output_color_type();
        let channels = match colour {
            ColorType::GrayscaleAlpha => 2,
            ColorType::Rgb => 3,
            ColorType::Rgba => 4,
            ColorType::Grayscale | ColorType::Indexed => 1,
        };
        Ok(Png { reader, size: if depth == BitDepth::Sixteen { 2 } else { 1 }, channels })
    }

    /// Width and height.
    pub(crate) fn size(&self) -> (u32, u32) {
        self.reader.info().size()
    }

    /// Bytes of the decoded image.
    pub(crate) fn bytes(&self) -> u64 {
        self.reader.output_buffer_size().map_or(u64::MAX, |n| u64::try_from(n).unwrap_or(u64::MAX))
    }

    /// All of its pixels.
    pub(crate) fn read(mut self) -> Result<Samples, DecodingError> {
        let bytes = self.reader.output_buffer_size().ok_or(DecodingError::LimitsExceeded)?;
        let mut data = vec![0; bytes];
        self.reader.next_frame(&mut data)?;
        if self.size == 2 {
            // PNG is big-endian
            for sample in data.as_chunks_mut::<2>().0 {
                *sample = u16::from_be_bytes(*sample).to_ne_bytes();
            }
        }
        Ok(Samples::new(self.channels, self.size, data))
    }
}
