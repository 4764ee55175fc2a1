//! How numbers lie in a file that does not say so: bare numbers, told by hand or by the manifest beside them.

use super::raw::Raw;
use super::read::{Image, MAX_SAMPLES, ReadError};
use super::{Encoder, Storage, texels};
use crate::cancel::Cancel;
use std::path::Path;

/// Size, channels and storage of bare numbers: rows from the top, channels interleaved unless they are planar.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Layout {
    /// Width and height in pixels, slices stacked.
    pub size: [usize; 2],
    /// Components of a pixel.
    pub components: usize,
    /// How a number is stored.
    pub storage: Storage,
    /// All numbers of one channel, then those of the next.
    pub planar: bool,
}

impl Layout {
    /// From a text such as `128x64x2:half`: width, height, components, storage; behind it `+planar`.
    ///
    /// # Errors
    /// A sentence that says what is wrong and what is taken.
    pub fn parse(text: &str) -> Result<Layout, String> {
        let wrong = |what: String| {
            format!(
                "{what}; a layout is WIDTHxHEIGHTxCHANNELS:STORAGE, such as 128x64x2:half, with +planar behind it"
            )
        };
        let (lengths, rest) =
            text.split_once(':').ok_or_else(|| wrong(format!("`{text}` has no storage")))?;
        let (id, planar) = match rest.split_once('+') {
            None => (rest, false),
            Some((id, "planar")) => (id, true),
            Some((_, other)) => return Err(wrong(format!("there is no option `{other}`"))),
        };
        let storage =
            super::storage::STORAGES.iter().copied().find(|s| s.id() == id && !s.is_block()).ok_or_else(
                || {
                    let all: Vec<&str> =
                        super::storage::STORAGES.iter().filter(|s| !s.is_block()).map(|s| s.id()).collect();
                    format!("there is no storage `{id}`: {}", all.join(", "))
                },
            )?;
        let numbers: Option<Vec<usize>> =
            lengths.split('x').map(|n| n.parse().ok().filter(|n| *n > 0)).collect();
        match numbers.as_deref() {
            Some(&[width, height, components]) => {
                Ok(Layout { size: [width, height], components, storage, planar })
            }
            _ => Err(wrong(format!("`{lengths}` is not three lengths above 0"))),
        }
    }

    /// Is it the name of a file of bare numbers?
    #[must_use]
    pub fn is_of(path: &Path) -> bool {
        path.extension().is_some_and(|e| e.eq_ignore_ascii_case(Raw.extension()))
    }

    /// The picture in bare numbers.
    ///
    /// # Errors
    /// [`ReadError`] if there are not as many bytes as the layout tells, or too many.
    pub fn read(&self, bytes: &[u8], cancel: &Cancel) -> Result<Image, ReadError> {
        let [width, height] = self.size;
        let components = texels::packed(self.storage).unwrap_or(self.components);
        if components != self.components {
            return Err(fault(format!(
                "{} has {components} components a pixel, not {}",
                self.storage.id(),
                self.components
            )));
        }
        let samples = width.saturating_mul(height).saturating_mul(components);
        let size = texels::bytes(self.storage, components, [width, height, 1]);
        let size = size.filter(|_| samples <= MAX_SAMPLES).ok_or(ReadError::Samples {
            format: FORMAT,
            width,
            height,
        })?;
        if size != bytes.len() {
            let tells = format!("{width} x {height} x {components} {}", self.storage.id());
            return Err(fault(format!("the file has {} bytes, {tells} takes {size}", bytes.len())));
        }
        let channels = if self.planar {
            self.planes(bytes, cancel)
        } else {
            texels::unpack(bytes, self.storage, components, [width, height, 1], cancel)
        };
        Ok(Image {
            format: FORMAT,
            width,
            height,
            channels: texels::finish(channels, None),
            provenance: None,
            warnings: Vec::new(),
        })
    }

    fn planes(&self, bytes: &[u8], cancel: &Cancel) -> Vec<super::read::Plane> {
        let [width, height] = self.size;
        let each = bytes.len() / self.components.max(1);
        let mut all = Vec::new();
        for (c, plane) in bytes.chunks_exact(each.max(1)).enumerate() {
            for mut plane in texels::unpack(plane, self.storage, 1, [width, height, 1], cancel) {
                plane.name = texels::component(c);
                all.push(plane);
            }
        }
        all
    }
}

const FORMAT: &str = "raw";

fn fault(fault: String) -> ReadError {
    ReadError::Fault { format: FORMAT, fault }
}
