//! The images whose levels matter, and where their bytes are: a file, a `data:` URI, or a part of a buffer.
//!
//! Source: glTF 2.0 §3.8.3 (images), §3.6.1 (buffers and views), RFC 2397 (`data:`).

use super::Limits;
use super::data::decode;
use super::error::Fault;
use super::image::{Image, Source};
use super::json::Node;
use super::uri::{Checked, check_uri};
use crate::picture::Wrap;
use serde_json::Value;
use std::collections::BTreeSet;

/// Extensions of a texture that name an image of their own, in the order in which they are looked at after the core `source`.
const SOURCES: [&str; 4] = ["EXT_texture_webp", "KHR_texture_basisu", "EXT_texture_avif", "MSFT_texture_dds"];

/// A texture: its image, if it has one that is known, and what lies beyond its border.
#[derive(Debug, Clone, Copy)]
pub(super) struct Texture {
    pub(super) image: Option<usize>,
    pub(super) wrap: [Wrap; 2],
    /// Does its sampler mix texels? One that says nothing is taken to.
    pub(super) linear: bool,
}

impl Default for Texture {
    fn default() -> Texture {
        Texture { image: None, wrap: [Wrap::Repeat; 2], linear: true }
    }
}

/// Modes of a sampler, as OpenGL numbers them.
const MODES: [(u64, Wrap); 3] = [(10497, Wrap::Repeat), (33071, Wrap::Clamp), (33648, Wrap::Mirror)];

/// Filters that read the nearest texel only, as OpenGL numbers them: of the picture, and of one of its levels.
const NEAREST: [u64; 3] = [9728, 9984, 9986];

/// The wrap modes of each sampler, and whether it mixes texels.
fn samplers(root: &Node<'_>) -> Result<Vec<([Wrap; 2], bool)>, Fault> {
    let Some(list) = root.get("samplers")? else { return Ok(Vec::new()) };
    let mut all = Vec::with_capacity(list.len()?);
    for sampler in list.items()? {
        let mode = |key: &'static str| -> Result<Wrap, Fault> {
            let mode = sampler.get(key)?.map_or(Ok(10497), |mode| mode.whole())?;
            Ok(MODES.iter().find(|(m, _)| *m == mode).map_or(Wrap::Repeat, |(_, wrap)| *wrap))
        };
        let nearest = |key: &'static str| -> Result<bool, Fault> {
            Ok(sampler.get(key)?.map(|f| f.whole()).transpose()?.is_some_and(|f| NEAREST.contains(&f)))
        };
        let linear = !(nearest("magFilter")? && nearest("minFilter")?);
        all.push(([mode("wrapS")?, mode("wrapT")?], linear));
    }
    Ok(all)
}

/// The image of each texture, and how it goes on.
pub(super) fn textures(root: &Node<'_>) -> Result<Vec<Texture>, Fault> {
    let samplers = samplers(root)?;
    let count = root.get("images")?.map_or(Ok(0), |images| images.len())?;
    let Some(list) = root.get("textures")? else { return Ok(Vec::new()) };
    let mut all = Vec::with_capacity(list.len()?);
    for texture in list.items()? {
        let mut image = texture.get("source")?.map(|s| s.index("images", count)).transpose()?;
        if let (None, Some(extensions)) = (image, texture.get("extensions")?) {
            for name in SOURCES {
                let Some(extension) = extensions.get(name)? else { continue };
                image = extension.get("source")?.map(|s| s.index("images", count)).transpose()?;
                if image.is_some() {
                    break;
                }
            }
        }
        let sampler = texture.get("sampler")?.map(|s| s.index("samplers", samplers.len())).transpose()?;
        let (wrap, linear) =
            sampler.and_then(|s| samplers.get(s)).copied().unwrap_or(([Wrap::Repeat; 2], true));
        all.push(Texture { image, wrap, linear });
    }
    Ok(all)
}

/// The images of these numbers, with their bytes where the scene's own file has them.
pub(super) fn images(
    root: &Node<'_>,
    wanted: &BTreeSet<usize>,
    bin: Option<&[u8]>,
    limits: &Limits,
) -> Result<Vec<Image>, Fault> {
    let mut all = Vec::new();
    let Some(list) = root.get("images")? else { return Ok(all) };
    for (index, image) in list.items()?.enumerate().filter(|(index, _)| wanted.contains(index)) {
        let source = match (image.get("uri")?, image.get("bufferView")?) {
            (Some(uri), _) => at_uri(&uri, None, limits)?,
            (None, Some(view)) => in_view(root, &view, bin, limits)?,
            (None, None) => Source::Missing("the image has neither `uri` nor `bufferView`".to_owned()),
        };
        all.push(Image { index, at: image.path(), source });
    }
    Ok(all)
}

/// Where the bytes of one image of a parsed document are, whether a material uses it or not. `bin`: the binary chunk of a GLB.
///
/// # Errors
/// [`Fault`] for a member of the wrong type or a URI that is not followed.
pub fn image_source(
    tree: &Value,
    image: usize,
    bin: Option<&[u8]>,
    limits: &Limits,
) -> Result<Source, Fault> {
    let found = images(&Node::root(tree), &BTreeSet::from([image]), bin, limits)?;
    let missing = || Source::Missing("it is not there".to_owned());
    Ok(found.into_iter().next().map_or_else(missing, |image| image.source))
}

pub(super) fn at_uri(uri: &Node<'_>, part: Option<[u64; 2]>, limits: &Limits) -> Result<Source, Fault> {
    let text = uri.text()?;
    let fault = |source| Fault::Uri { at: uri.path(), uri: crate::math::shown::show(text), source };
    match check_uri(text, limits.data_uri_bytes).map_err(fault)? {
        Checked::Inside(names) | Checked::Above(names) => Ok(Source::File { names, part }),
        Checked::Data { .. } => {
            Ok(decode(text).map_or_else(|e| Source::Missing(e.to_string()), |bytes| cut(&bytes, part)))
        }
    }
}

fn cut(bytes: &[u8], part: Option<[u64; 2]>) -> Source {
    let [from, length] =
        part.unwrap_or([0, bytes.len() as u64]).map(|n| usize::try_from(n).unwrap_or(usize::MAX));
    match bytes.get(from..from.saturating_add(length)) {
        Some(part) => Source::Embedded(part.to_vec()),
        None => {
            Source::Missing(format!("its buffer view ends beyond the {} bytes of the buffer", bytes.len()))
        }
    }
}

/// The bytes of a buffer view.
fn in_view(root: &Node<'_>, view: &Node<'_>, bin: Option<&[u8]>, limits: &Limits) -> Result<Source, Fault> {
    let missing = |what: &str| Ok(Source::Missing(format!("there are no {what}")));
    let Some(views) = root.get("bufferViews")? else { return missing("buffer views") };
    let index = view.index("bufferViews", views.len()?)?;
    let Some(view) = views.items()?.nth(index) else { return missing("buffer views") };
    let part = Some([view.whole_or_zero("byteOffset")?, view.whole_or_zero("byteLength")?]);
    let Some(buffers) = root.get("buffers")? else { return missing("buffers") };
    let index = view.need("buffer", "the index of a buffer")?.index("buffers", buffers.len()?)?;
    let Some(buffer) = buffers.items()?.nth(index) else { return missing("buffers") };
    match (buffer.get("uri")?, bin) {
        (Some(uri), _) => at_uri(&uri, part, limits),
        (None, Some(bin)) if index == 0 => Ok(cut(bin, part)),
        (None, _) => missing("bytes of its buffer"),
    }
}
