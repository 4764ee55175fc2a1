//! Pictures of containers that have no place for metadata, seen with what a manifest says of them; and files that hold several tables
//! taken apart.

use super::read::{Claim, Image, Plane, ReadError, Sample};
use super::{Storage, texels};
use crate::cancel::Cancel;
use crate::grid::Provenance;

/// The container without header.
const BARE: &str = "raw";

impl Image {
    /// The picture with the names and ranges that `p` has for its channels. One that says itself what it holds stays as it is.
    #[must_use]
    pub fn told_by(mut self, p: &Provenance) -> Image {
        let n = p.channels.len();
        if self.provenance.is_some() || self.channels.len() < n {
            return self;
        }
        let fill = p.encoding.as_ref().map_or(&[][..], |e| &e.fill);
        let filled = |(i, plane): (usize, &Plane)| {
            fill.get(i).is_some_and(|f| plane.values.iter().all(|v| (v - f).abs() == 0.0))
        };
        if self.channels[n..].iter().enumerate().all(filled) {
            self.channels.truncate(n);
        }
        for (plane, channel) in self.channels.iter_mut().zip(&p.channels) {
            let [lo, hi] = channel.range;
            plane.name.clone_from(&channel.id);
            let coded = matches!(
                plane.sample,
                Sample::Unorm8 | Sample::Unorm16 | Sample::Rgb10a2 | Sample::Bc4 | Sample::Bc5
            );
            if coded && lo < hi && (hi - lo).is_finite() {
                plane.range = [lo, hi];
                // they were read over [0, 1]
                plane.values.iter_mut().for_each(|v| *v = lo + *v * (hi - lo));
            }
        }
        self.provenance = Some(Claim::Known(Box::new(p.clone())));
        self
    }

    /// The tables of the file, each as a picture of its own; the picture itself where it holds one, or does not say.
    #[must_use]
    pub fn apart(self) -> Vec<Image> {
        let Some(Claim::Several(all)) = &self.provenance else { return vec![self] };
        let part = |p: &Provenance| {
            let own = |plane: &Plane| {
                let (part, name) = plane.name.split_once('.')?;
                (part == p.name).then(|| Plane { name: name.to_owned(), ..plane.clone() })
            };
            Image {
                channels: self.channels.iter().filter_map(own).collect(),
                provenance: Some(Claim::Known(Box::new(p.clone()))),
                ..self.clone()
            }
        };
        all.iter().map(part).collect()
    }
}

/// The three values of RGBD of four components in [0, 1].
#[must_use]
pub fn raw_rgbd([r, g, b, d]: [f64; 4]) -> [f64; 3] {
    // codes are whole numbers of 255ths
    [r, g, b].map(|v| libm::pow(v, 2.2) / d.max(1.0 / 255.0))
}

/// Numbers without header, as `p` tells.
///
/// # Errors
/// [`ReadError::Fault`] if the size is not that of the table.
pub fn bare(bytes: &[u8], p: &Provenance) -> Result<Image, ReadError> {
    let fault = |fault: String| ReadError::Fault { format: BARE, fault };
    let id = p.encoding.as_ref().map_or("", |e| e.storage.as_str());
    let storage = Storage::find(id).ok_or_else(|| fault(format!("storage `{id}` is not known")))?;
    let n = p.channels.len();
    let components = texels::packed(storage).unwrap_or(n);
    let len = |i: usize| p.axes.get(i).map_or(1, |a| a.axis.len);
    let extent = [len(0), len(1), len(2).saturating_mul(len(3))];
    let size = texels::bytes(storage, components, extent);
    if size != Some(bytes.len()) {
        let size = size.unwrap_or(usize::MAX);
        return Err(fault(format!("{} bytes of numbers, the manifest tells of {size}", bytes.len())));
    }
    let mut planes = texels::unpack(bytes, storage, components, extent, &Cancel::new());
    planes.truncate(n);
    for (plane, channel) in planes.iter_mut().zip(&p.channels) {
        plane.name.clone_from(&channel.id);
        plane.range = channel.range;
        let (sample, range) = (plane.sample, plane.range);
        plane.values.iter_mut().for_each(|v| *v = sample.decode(*v, range));
    }
    Ok(Image {
        format: BARE,
        width: extent[0],
        height: extent[1] * extent[2],
        channels: planes,
        provenance: Some(Claim::Known(Box::new(p.clone()))),
        warnings: Vec::new(),
    })
}
