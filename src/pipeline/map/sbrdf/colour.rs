//! Base colour and metallic: read, judged, and as F0 and diffuse colour on every level.

use super::super::MapError;
use super::super::input::{Loader, find, judged, resampled};
use super::texels;
use crate::cancel::{Cancel, Cancelled};
use crate::functions::conversion::gltf_anisotropy;
use crate::maps::sbrdf::curve::Curve;
use crate::maps::spec_gloss::Solved;
use crate::maps::{self, Level, TexelFault};
use crate::picture::{Picture, Space, Wrap, shrink};
use crate::plan::map::Source;
use crate::plan::map::sbrdf::{BASE, COLOUR, ColourInput, METALLIC, NumberInput};
use rayon::prelude::*;
use std::path::Path;

/// F0 and diffuse colour of every texel: six planes, or six numbers.
pub(in super::super) struct Colours {
    planes: Vec<Vec<f32>>,
    constant: [f64; 6],
}

/// F0 and diffuse colour of metallic-roughness.
fn split(base: [f64; 3], metallic: f64) -> [f64; 6] {
    let [a, b, c] = Solved { base, metallic }.f0();
    let [x, y, z] = base.map(|v| v * (1.0 - metallic));
    [a, b, c, x, y, z]
}

impl Colours {
    pub(in super::super) fn read(
        base: &ColourInput,
        metallic: &NumberInput,
        (size, wrap): ([usize; 2], [Wrap; 2]),
        loader: &mut Loader<'_>,
    ) -> Result<Colours, MapError> {
        let mut open = |role: &'static str, image: &Source| -> Result<Picture, MapError> {
            Ok(resampled(loader.load(role, image)?, size, wrap))
        };
        let (mut colour, mut number) = ([1.0; 3], 1.0);
        let (mut colours, mut numbers) = (None, None);
        match base {
            ColourInput::Constant(c) => colour = *c,
            ColourInput::Image { image, space } => {
                let (picture, path) = (open(BASE, image)?, image.path());
                let plane = |name: &str| codes(&picture, &path, name, *space);
                colours = Some([plane(COLOUR[0])?, plane(COLOUR[1])?, plane(COLOUR[2])?]);
            }
        }
        match metallic {
            NumberInput::Constant(m) => number = *m,
            NumberInput::Image { image, channel } => {
                let picture = open(METALLIC, image)?;
                numbers = Some(codes(&picture, &image.path(), channel, Space::Linear)?);
            }
        }
        let at = |i: usize| {
            let base = colours.as_ref().map_or(colour, |c| [0, 1, 2].map(|k| f64::from(c[k][i])));
            split(base, numbers.as_ref().map_or(number, |m| f64::from(m[i])))
        };
        if colours.is_none() && numbers.is_none() {
            return Ok(Colours { planes: Vec::new(), constant: split(colour, number) });
        }
        #[allow(clippy::cast_possible_truncation, reason = "rounded to f32 on purpose")]
        let plane = |c: usize| (0..size[0] * size[1]).into_par_iter().map(|i| at(i)[c] as f32).collect();
        Ok(Colours { planes: (0..6).map(plane).collect(), constant: [0.0; 6] })
    }

    /// F0 and diffuse colour of a texel of the first level.
    pub(super) fn at(&self, texel: usize) -> [f64; 6] {
        match self.planes.is_empty() {
            true => self.constant,
            false => std::array::from_fn(|c| f64::from(self.planes[c][texel])),
        }
    }

    /// Mean F0 and mean diffuse colour, of all channels.
    pub(super) fn means(&self) -> (f64, f64) {
        let mean = |c: usize| match self.planes.get(c) {
            Some(p) => p.iter().map(|v| f64::from(*v)).sum::<f64>() / p.len().max(1) as f64,
            None => self.constant[c],
        };
        ((mean(0) + mean(1) + mean(2)) / 3.0, (mean(3) + mean(4) + mean(5)) / 3.0)
    }

    /// The lobes of every texel of every level.
    pub(super) fn levels(
        &self,
        levels: &[Level<'_>],
        curve: &Curve,
        cancel: &Cancel,
    ) -> Result<Vec<texels::Flat>, Cancelled> {
        let mut out = Vec::with_capacity(levels.len());
        let mut smaller: Vec<Vec<f32>> = Vec::new();
        let stride = texels::stride(curve.lobes());
        for (k, level) in levels.iter().enumerate() {
            cancel.check()?;
            if let Some(before) = k.checked_sub(1).and_then(|k| levels.get(k)) {
                let planes = if k == 1 { &self.planes } else { &smaller };
                smaller = planes.par_iter().map(|p| shrink(p, before.size, level.size)).collect();
            }
            let planes = if k == 0 { &self.planes } else { &smaller };
            let texel = |(i, slot): (usize, &mut [f32])| {
                let v: [f64; 6] = match planes.is_empty() {
                    true => self.constant,
                    false => std::array::from_fn(|c| f64::from(planes[c][i])),
                };
                let place = place(&level.at(i));
                texels::put(&curve.texel_of(place, [v[0], v[1], v[2]], [v[3], v[4], v[5]]), slot);
            };
            let mut values = vec![0.0; level.len() * stride];
            values.par_chunks_exact_mut(stride).enumerate().for_each(texel);
            out.push((level.size, values));
        }
        Ok(out)
    }
}

/// Roughness of the smaller width, and strength of the anisotropy, which is 0 of one width.
pub(super) fn place(texel: &maps::Texel) -> [f64; 2] {
    let lobe = texel.lobe();
    let strength = gltf_anisotropy([lobe.alpha_max, lobe.alpha_min]).1;
    [f64::from(texel.roughness), if lobe.alpha_max > lobe.alpha_min { strength } else { 0.0 }]
}

/// A channel, linear, each value judged.
fn codes(picture: &Picture, path: &Path, name: &str, space: Space) -> Result<Vec<f32>, MapError> {
    let plane = find(picture, path, name)?;
    judged(path, picture.width, plane.values.len(), |i| match plane.values[i] {
        v if !v.is_finite() => Err(TexelFault::NotFinite),
        v if !(0.0..=1.0).contains(&v) => Err(TexelFault::Code(f64::from(v))),
        v => Ok(space.decode(v)),
    })
}
