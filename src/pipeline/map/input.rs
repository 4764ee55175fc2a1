//! The images of a planned map, decoded and judged texel by texel.

use super::MapError;
use super::certificate::Certificate;
use super::sbrdf::{Colours, Target};
use crate::cancel::Cancel;
use crate::encode::read;
use crate::maps::sbrdf::tabulated::Tabulated;
use crate::maps::surface;
use crate::maps::{Field, Surface, TexelFault};
use crate::picture::{self, Picture, Plane, Space};
use crate::plan::map::sbrdf::{BRDF, Origin};
use crate::plan::map::{
    ANISOTROPY, AnisotropyInput, FromLobe, Input, Packing, PlannedMap, RoughnessInput, Source,
};
use rayon::prelude::*;
use std::path::Path;

/// What was read.
pub(super) struct Sources {
    pub(super) surface: Surface,
    /// What the roughness is packed with: channels that are written as they are, and which of them it is.
    pub(super) packed: Option<(Picture, usize)>,
    /// What a conversion of lobes of another kind costs.
    pub(super) certificate: Option<Certificate>,
    /// What lobes are fitted to, where they are asked for.
    pub(super) target: Option<Target>,
    /// Name (without folder) and blake3 of each file, with its part.
    pub(super) files: Vec<(&'static str, String, String)>,
}

/// Opens the files of a planned map, and keeps their names.
pub(super) struct Loader<'a> {
    planned: &'a PlannedMap,
    cancel: &'a Cancel,
    files: Vec<(&'static str, String, String)>,
}

impl Loader<'_> {
    /// Opens one, and compares its hash with that of the plan.
    pub(super) fn load(&mut self, role: &'static str, image: &Source) -> Result<Picture, MapError> {
        let (picture, hash) = open(image, self.cancel)?;
        self.known(role, image, hash)?;
        Ok(picture)
    }

    fn known(&mut self, role: &'static str, image: &Source, hash: String) -> Result<(), MapError> {
        if self.planned.inputs.iter().any(|i| i.role == role && i.content != hash) {
            return Err(MapError::Changed { path: image.path() });
        }
        self.files.push((role, image.name(), hash));
        Ok(())
    }

    fn table(&mut self, source: &Source) -> Result<Tabulated, MapError> {
        let unread = |error| MapError::Read { path: source.path(), source: error };
        let bytes = source.bytes(self.cancel).map_err(unread)?;
        self.known(BRDF, source, blake3::hash(&bytes).to_hex().to_string())?;
        let image = read::read_bytes_until(self.cancel, &bytes).map_err(unread)?;
        let mut planes = image.channels.into_iter().map(|c| c.values);
        let planes = [0; 3].map(|_| planes.next().unwrap_or_default());
        Tabulated::new(planes).map_err(|fault| MapError::Table { path: source.path(), fault })
    }
}

pub(super) fn read(planned: &PlannedMap, cancel: &Cancel) -> Result<Sources, MapError> {
    let (request, size) = (&planned.asked, planned.size);
    let mut loader = Loader { planned, cancel, files: Vec::new() };
    let wrap = request.normal.as_ref().map_or([picture::Wrap::Repeat; 2], |n| n.wrap);
    let mut surface = Surface {
        size,
        normals: Field::Constant([0.0, 0.0, 1.0]),
        roughness: Field::Constant(0.0),
        stretch: None,
        residual: Field::Constant(0.0),
    };
    let (mut whole, mut certificate) = (None, None);
    match &request.roughness {
        #[allow(clippy::cast_possible_truncation, reason = "rounded to f32 on purpose")]
        RoughnessInput::Constant(r) => surface.roughness = Field::Constant((*r * request.factor) as f32),
        RoughnessInput::Image { image, channel, space, gloss, from } => {
            let path = image.path();
            let picture = loader.load("roughness", image)?;
            find(&picture, &path, channel)?;
            let picture = resampled(picture, size, wrap);
            let plane = find(&picture, &path, channel)?;
            let factor = if from.is_some() { 1.0 } else { request.factor };
            let codes = roughness(plane, &picture, &path, (*space, *gloss, factor))?;
            match from {
                None => surface.roughness = Field::Map(codes),
                Some(from) => {
                    certificate =
                        Some(convert(from, codes, (&picture, &path), (*space, *gloss), &mut surface)?);
                }
            }
            let index = picture.planes.iter().position(|p| p.name == plane.name).unwrap_or(0);
            whole = request.roughness.packs().then_some((picture, index));
        }
    }
    if let Some(input) = &request.anisotropy {
        let stretched = stretched(input, &surface.roughness, (size, wrap), &mut loader)?;
        surface.stretch = Some(stretched);
    }
    if let Some(input) = &request.normal {
        let picture = loader.load("normal", &input.image)?;
        surface.normals = Field::Map(normals(&picture, input, size)?);
    }
    let target = match request.sbrdf.as_ref().map(|s| &s.origin) {
        None => None,
        Some(Origin::Tabulated(source)) => {
            let table = loader.table(source)?;
            #[allow(clippy::cast_possible_truncation, reason = "rounded to f32 on purpose")]
            let roughness = table.width().sqrt() as f32;
            surface.roughness = Field::Constant(roughness);
            Some(Target::Tabulated(table))
        }
        Some(Origin::Metallic { base, metallic }) => {
            Some(Target::Metallic(Colours::read(base, metallic, (size, wrap), &mut loader)?))
        }
    };
    let packed = packed(request.packing, whole, size);
    Ok(Sources { surface, packed, certificate, target, files: loader.files })
}

/// Larger widths and directions of all texels.
fn stretched(
    input: &AnisotropyInput,
    roughness: &Field<f32>,
    (size, wrap): ([usize; 2], [picture::Wrap; 2]),
    loader: &mut Loader<'_>,
) -> Result<Vec<[f32; 2]>, MapError> {
    let AnisotropyInput { strength, rotation, .. } = *input;
    let texels = size[0] * size[1];
    let Some(image) = &input.image else {
        // along the tangent
        let one = |i| surface::stretch(roughness.at(i), [1.0, 0.5, 1.0], strength, rotation);
        return judged(Path::new(ANISOTROPY), size[0], texels, one);
    };
    let (path, wrap) = (image.path(), if input.resample { input.wrap } else { wrap });
    let picture = resampled(loader.load(ANISOTROPY, image)?, size, wrap);
    let [x, y, s] = AnisotropyInput::CHANNELS.map(|c| find(&picture, &path, c));
    let (x, y, s) = (x?, y?, s?);
    judged(&path, size[0], texels, |i| {
        surface::stretch(roughness.at(i), [x.values[i], y.values[i], s.values[i]], strength, rotation)
    })
}

/// Codes that tell of lobes of another kind, as widths of GGX in a surface.
fn convert(
    from: &FromLobe,
    codes: Vec<f32>,
    (picture, path): (&Picture, &Path),
    (space, gloss): (Space, bool),
    surface: &mut Surface,
) -> Result<Certificate, MapError> {
    let lobes = match &from.second {
        None => from.single(&codes)?,
        Some(second) => {
            let read = |name: &str, space: Space, gloss: bool| {
                roughness(find(picture, path, name)?, picture, path, (space, gloss, 1.0))
            };
            let other = read(&second.channel, space, gloss)?;
            // an angle is a number as it is
            let angle = second.angle.as_ref().map(|a| read(a, Space::Linear, false)).transpose()?;
            from.pairs(&codes, &other, angle.as_deref())?
        }
    };
    surface.residual = Field::Map(lobes.costs.iter().map(|c| c[0]).collect());
    surface.roughness = Field::Map(lobes.roughness);
    surface.stretch = lobes.stretch;
    Ok(Certificate::new(surface.size, from, lobes.costs, lobes.between))
}

/// What the roughness is packed with.
fn packed(packing: Packing, image: Option<(Picture, usize)>, size: [usize; 2]) -> Option<(Picture, usize)> {
    match packing {
        Packing::Single => None,
        Packing::Image => image.filter(|(picture, _)| picture.planes.len() > 1),
        Packing::Gltf => {
            let texels = size[0] * size[1];
            let plane = |name: &str| {
                let own = image.as_ref().and_then(|(picture, _)| picture.plane(name).ok());
                let values = own.map_or_else(|| vec![1.0; texels], |plane| plane.values.clone());
                Plane { name: name.to_owned(), values }
            };
            let planes = vec![plane("R"), plane("G"), plane("B")];
            Some((Picture { width: size[0], height: size[1], planes }, 1))
        }
    }
}

/// Opens an image of any kind that is read, and tells the hash of its bytes.
fn open(image: &Source, cancel: &Cancel) -> Result<(Picture, String), MapError> {
    let unread = |source| MapError::Read { path: image.path(), source };
    let bytes = image.bytes(cancel).map_err(unread)?;
    let hash = blake3::hash(&bytes).to_hex().to_string();
    let wrong = |source| MapError::Picture { path: image.path(), source };
    if picture::is_picture(&bytes) {
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

/// A picture in another size.
pub(super) fn resampled(picture: Picture, size: [usize; 2], wrap: [picture::Wrap; 2]) -> Picture {
    let own = [picture.width, picture.height];
    if own == size {
        return picture;
    }
    let planes = picture.planes.iter().map(|p| p.resampled(own, size, wrap)).collect();
    Picture { width: size[0], height: size[1], planes }
}

pub(super) fn find<'a>(picture: &'a Picture, path: &Path, channel: &str) -> Result<&'a Plane, MapError> {
    picture.plane(channel).map_err(|source| MapError::Picture { path: path.to_owned(), source })
}

/// Judges every texel; the first fault is told, and how many there are.
pub(super) fn judged<T: Send>(
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
    let path = input.image.path();
    let channel = |c: usize| -> Result<Plane, MapError> {
        let plane = find(picture, &path, &input.channels[c])?;
        Ok(if own == size { plane.clone() } else { plane.resampled(own, size, input.wrap) })
    };
    let x = channel(0)?;
    let y = channel(1)?;
    let z = if input.convention.derive_z { None } else { Some(channel(2)?) };
    let codes = |v: f32| if input.signed { 0.5 * v + 0.5 } else { v };
    judged(&path, size[0], size[0] * size[1], |i| {
        let z = z.as_ref().map_or(1.0, |z| z.values[i]);
        input.convention.decode([codes(x.values[i]), codes(y.values[i]), codes(z)])
    })
}
