//! The files of a pair of maps, decoded and judged texel by texel.

use super::{MapError, MapRequest};
use crate::cancel::Cancel;
use crate::encode::read;
use crate::functions::conversion::{By, Conversion};
use crate::maps::surface;
use crate::maps::{Convention, Field, Surface, TexelFault};
use crate::picture::{self, Picture, Plane, Space, Wrap};
use rayon::prelude::*;
use std::path::{Path, PathBuf};

/// A normal map.
#[derive(Debug, Clone, PartialEq)]
pub struct Input {
    /// The file.
    pub path: PathBuf,
    /// Names of the channels of x, y and z.
    pub channels: [String; 3],
    /// How its numbers are to be read.
    pub convention: Convention,
    /// True if the numbers are on [−1, 1] already, as float images may have them.
    pub signed: bool,
    /// What lies beyond the border, where it is resampled.
    pub wrap: [Wrap; 2],
    /// Resample it to the size of the roughness map.
    pub resample: bool,
}

/// Where the roughness comes from.
#[derive(Debug, Clone, PartialEq)]
pub enum RoughnessInput {
    /// One number for all texels.
    Constant(f64),
    /// A channel of an image.
    Image {
        /// The file.
        path: PathBuf,
        /// Name of the channel.
        channel: String,
        /// True if its codes are coded as sRGB, which no format of materials asks for.
        space: Space,
        /// True if it holds 1 − r: gloss, smoothness.
        gloss: bool,
        /// True to write the roughness alone, and not the other channels of the image.
        single: bool,
        /// What the codes tell of, if it is no roughness.
        from: Option<FromLobe>,
    },
}

/// Codes of lobes of another kind.
#[derive(Debug, Clone, Copy)]
pub struct FromLobe {
    /// The parametrisation, of one number.
    pub conversion: &'static Conversion,
    /// Numbers of the codes 0 and 1.
    pub range: [f64; 2],
    /// True if the codes are spread over the logarithm.
    pub log: bool,
    /// How the lobe becomes GGX.
    pub by: By,
}

impl PartialEq for FromLobe {
    fn eq(&self, other: &FromLobe) -> bool {
        let key = |f: &FromLobe| (f.conversion.id, f.range.map(f64::to_bits), f.log, f.by);
        key(self) == key(other)
    }
}

impl FromLobe {
    /// Roughness and D of a code.
    #[allow(clippy::cast_possible_truncation, reason = "rounded to f32 on purpose")]
    fn convert(&self, code: f32) -> [f32; 2] {
        let [lo, hi] = self.range;
        let c = f64::from(code);
        let number = if self.log { lo * libm::pow(hi / lo, c) } else { lo + (hi - lo) * c };
        let found = self.conversion.convert([number.clamp(lo.min(hi), lo.max(hi)); 2], self.by);
        [found.alphas[0].min(1.0).sqrt() as f32, found.distance as f32]
    }

    /// The same of many codes, each of them once.
    fn convert_all(&self, codes: &[f32]) -> Vec<[f32; 2]> {
        let mut keys: Vec<u32> = codes.iter().map(|c| c.to_bits()).collect();
        keys.sort_unstable();
        keys.dedup();
        let found: Vec<[f32; 2]> = keys.par_iter().map(|k| self.convert(f32::from_bits(*k))).collect();
        let at = |c: &f32| keys.binary_search(&c.to_bits()).map_or([0.0; 2], |i| found[i]);
        codes.iter().map(at).collect()
    }

    fn check(&self) -> Result<(), MapError> {
        let (_, [least, most]) = self.conversion.numbers[0];
        let wrong = |v: &&f64| !(least..=most).contains(*v) || (self.log && **v <= 0.0);
        match self.range.iter().find(wrong) {
            None => Ok(()),
            Some(v) => Err(MapError::Number {
                what: "range",
                got: *v,
                allowed: "what the parametrisation takes (describe to-ggx; above 0 if logarithmic)",
            }),
        }
    }
}

/// What was read.
pub(super) struct Sources {
    pub(super) surface: Surface,
    /// The image of the roughness, whose other channels are written too; and which of them it is.
    pub(super) packed: Option<(Picture, usize)>,
    /// Name (without folder) and blake3 of each file, with its part.
    pub(super) files: Vec<(&'static str, String, String)>,
}

pub(super) fn read(request: &MapRequest, cancel: &Cancel) -> Result<Sources, MapError> {
    if !(request.factor > 0.0 && request.factor <= 1.0) {
        return Err(MapError::Number { what: "factor", got: request.factor, allowed: "(0, 1]" });
    }
    let mut files = Vec::new();
    let mut load = |role: &'static str, path: &Path| -> Result<Picture, MapError> {
        let (picture, hash) = open(path, cancel)?;
        let name = path.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
        files.push((role, name, hash));
        Ok(picture)
    };
    let (mut packed, mut size) = (None, None);
    let mut residual = Field::Constant(0.0);
    let roughness = match &request.roughness {
        RoughnessInput::Constant(r) if !(0.0..=1.0).contains(r) => {
            return Err(MapError::Number { what: "roughness", got: *r, allowed: "[0, 1]" });
        }
        #[allow(clippy::cast_possible_truncation, reason = "rounded to f32 on purpose")]
        RoughnessInput::Constant(r) => Field::Constant((*r * request.factor) as f32),
        RoughnessInput::Image { path, channel, space, gloss, single, from } => {
            let picture = load("roughness", path)?;
            let plane = find(&picture, path, channel)?;
            let field = match from {
                None => roughness(plane, &picture, path, (*space, *gloss, request.factor))?,
                Some(from) => {
                    from.check()?;
                    if request.factor < 1.0 {
                        let allowed = "1, where the codes tell of another lobe";
                        return Err(MapError::Number { what: "factor", got: request.factor, allowed });
                    }
                    let codes = roughness(plane, &picture, path, (*space, *gloss, 1.0))?;
                    let found = from.convert_all(&codes);
                    residual = Field::Map(found.iter().map(|f| f[1]).collect());
                    found.iter().map(|f| f[0]).collect()
                }
            };
            size = Some(([picture.width, picture.height], path.clone()));
            let index = picture.planes.iter().position(|p| p.name == plane.name).unwrap_or(0);
            packed = (!single && picture.planes.len() > 1).then_some((picture, index));
            Field::Map(field)
        }
    };
    let normals = match &request.normal {
        None => Field::Constant([0.0, 0.0, 1.0]),
        Some(input) => {
            let picture = load("normal", &input.path)?;
            let own = [picture.width, picture.height];
            let (target, other) = size.clone().unwrap_or((own, PathBuf::new()));
            if target != own && !input.resample {
                return Err(MapError::Sizes { a: input.path.clone(), b: other, sizes: [own, target] });
            }
            size = Some((target, other));
            Field::Map(normals(&picture, input, target)?)
        }
    };
    let Some((size, _)) = size else { return Err(MapError::Nothing) };
    Ok(Sources { surface: Surface { size, normals, roughness, residual }, packed, files })
}

/// Opens an image of any kind that is read, and tells the hash of its bytes.
fn open(path: &Path, cancel: &Cancel) -> Result<(Picture, String), MapError> {
    let unread = |source| MapError::Read { path: path.to_owned(), source };
    let bytes = read::load_until(cancel, path).map_err(unread)?;
    let hash = blake3::hash(&bytes).to_hex().to_string();
    let wrong = |source| MapError::Picture { path: path.to_owned(), source };
    if picture::MAGIC.iter().any(|(magic, _)| bytes.starts_with(magic)) {
        return Ok((picture::read_bytes(&bytes).map_err(wrong)?, hash));
    }
    let image = read::read_bytes_until(cancel, &bytes).map_err(unread)?;
    let (width, height) = (image.width, image.height);
    if width * height > picture::MAX_PIXELS || width * height == 0 {
        return Err(wrong(picture::PictureError::Pixels { width, height }));
    }
    #[allow(clippy::cast_possible_truncation, reason = "rounded to f32 on purpose")]
    let plane = |p: &read::Plane| Plane {
        name: p.name.clone(),
        values: p.values.iter().map(|v| *v as f32).collect(),
    };
    Ok((Picture { width, height, planes: image.channels.iter().map(plane).collect() }, hash))
}

fn find<'a>(picture: &'a Picture, path: &Path, channel: &str) -> Result<&'a Plane, MapError> {
    picture.plane(channel).map_err(|source| MapError::Picture { path: path.to_owned(), source })
}

/// Judges every texel; the first fault is told, and how many there are.
fn judged<T: Send>(
    path: &Path,
    width: usize,
    texels: usize,
    one: impl Fn(usize) -> Result<T, TexelFault> + Sync,
) -> Result<Vec<T>, MapError> {
    let found: Vec<Result<T, TexelFault>> = (0..texels).into_par_iter().map(&one).collect();
    let faults = found.iter().filter(|r| r.is_err()).count();
    if let Some((i, fault)) = found.iter().enumerate().find_map(|(i, r)| r.as_ref().err().map(|e| (i, *e))) {
        let (x, y) = (i % width, i / width);
        return Err(MapError::Texel { path: path.to_owned(), x, y, fault, others: faults - 1 });
    }
    Ok(found.into_iter().flatten().collect())
}

#[allow(clippy::cast_possible_truncation, reason = "rounded to f32 on purpose")]
fn roughness(
    plane: &Plane,
    picture: &Picture,
    path: &Path,
    (space, gloss, factor): (Space, bool, f64),
) -> Result<Vec<f32>, MapError> {
    judged(path, picture.width, plane.values.len(), |i| {
        let code = surface::roughness(plane.values[i])?;
        let r = space.decode(code);
        let r = if gloss { 1.0 - r } else { r };
        // a factor of 1 leaves every bit
        Ok(if factor < 1.0 { (f64::from(r) * factor) as f32 } else { r })
    })
}

fn normals(picture: &Picture, input: &Input, size: [usize; 2]) -> Result<Vec<[f32; 3]>, MapError> {
    let own = [picture.width, picture.height];
    let channel = |c: usize| -> Result<Plane, MapError> {
        let plane = find(picture, &input.path, &input.channels[c])?;
        Ok(if own == size { plane.clone() } else { plane.resampled(own, size, input.wrap) })
    };
    let x = channel(0)?;
    let y = channel(1)?;
    let z = if input.convention.derive_z { None } else { Some(channel(2)?) };
    let codes = |v: f32| if input.signed { 0.5 * v + 0.5 } else { v };
    judged(&input.path, size[0], size[0] * size[1], |i| {
        let z = z.as_ref().map_or(1.0, |z| z.values[i]);
        input.convention.decode([codes(x.values[i]), codes(y.values[i]), codes(z)])
    })
}
