//! Files that do not say what they hold: what the manifest beside them says, and how bare numbers lie.

use super::layout::Layout;
use super::read::{self, Claim, Image, Plane, ReadError};
use super::{Storage, exr_names, texels};
use crate::cancel::Cancel;
use crate::grid::Provenance;
use crate::grid::provenance::Encoding;
use serde::Deserialize;
use std::path::Path;

/// Name of the manifest of an output folder.
pub const MANIFEST: &str = "manifest.json";

/// Longest manifest that is read.
const MAX_MANIFEST: u64 = 1 << 28;

/// What a manifest says of one file.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// What the table is, as the file would say it.
    pub provenance: Provenance,
    /// Container id.
    pub container: String,
    /// blake3 of the bytes.
    pub blake3: String,
}

/// The part of a manifest that is needed here; the rest is left alone.
#[derive(Deserialize)]
struct Listing {
    #[serde(default)]
    tables: Vec<serde_json::Value>,
}

#[derive(Deserialize)]
struct Files {
    #[serde(default)]
    files: Vec<Listed>,
}

#[derive(Deserialize)]
struct Listed {
    file: String,
    container: String,
    blake3: String,
    encoding: Encoding,
}

/// What the manifest in the folder of a file says of it; nothing without manifest, or where it does not name the file as that of one
/// table.
#[must_use]
pub fn entry(path: &Path) -> Option<Entry> {
    let folder = path.parent()?;
    let name = path.file_name()?.to_str()?;
    let manifest = folder.join(MANIFEST);
    if manifest.metadata().ok()?.len() > MAX_MANIFEST {
        return None;
    }
    let listing: Listing = serde_json::from_slice(&std::fs::read(manifest).ok()?).ok()?;
    let mut found = Vec::new();
    for mut table in listing.tables {
        let Ok(files) = Files::deserialize(&table) else { continue };
        // of a manifest `size` is the lengths of the axes, of a file how they were found
        if let Some(table) = table.as_object_mut() {
            table.remove("size");
        }
        for listed in files.files.into_iter().filter(|f| f.file == name) {
            let Ok(provenance) = Provenance::deserialize(&table) else { continue };
            let Listed { container, blake3, encoding, .. } = listed;
            let provenance = Provenance { encoding: Some(encoding), ..provenance };
            found.push(Entry { provenance, container, blake3 });
        }
    }
    if found.len() == 1 { found.pop() } else { None }
}

/// Reads the bytes of a file: as its first bytes tell, or as the layout or the manifest beside it tells. A file that does not say what
/// it holds gets the metadata that the manifest has of it, if its bytes are those that were written.
///
/// # Errors
/// [`ReadError`], as [`read::read_bytes_until`].
pub fn read(path: &Path, bytes: &[u8], layout: Option<&Layout>, cancel: &Cancel) -> Result<Image, ReadError> {
    if let Some(layout) = layout {
        return layout.read(bytes, cancel);
    }
    let own = read::read_bytes_until(cancel, bytes);
    if own.as_ref().is_ok_and(|image| image.provenance.is_some()) {
        return own;
    }
    let Some(entry) = entry(path) else { return own };
    let mut image = match own {
        Err(ReadError::Unknown(_)) if entry.container == "raw" => {
            layout_of(&entry.provenance)?.read(bytes, cancel)?
        }
        own => own?,
    };
    if blake3::hash(bytes).to_hex().as_str() == entry.blake3 {
        image = image.described(entry.provenance);
        image.warnings.push(format!("what it holds is said by {MANIFEST} beside it, not by the file"));
    } else {
        image
            .warnings
            .push(format!("{MANIFEST} beside it tells of other bytes under this name; it is not believed"));
    }
    Ok(image)
}

/// The table in a file of bare numbers, of which `p` tells.
///
/// # Errors
/// [`ReadError`] if the file does not have as many bytes.
pub fn bare(bytes: &[u8], p: &Provenance, cancel: &Cancel) -> Result<Image, ReadError> {
    Ok(layout_of(p)?.read(bytes, cancel)?.described(p.clone()))
}

/// How the numbers of a table lie in a file of bare numbers.
fn layout_of(p: &Provenance) -> Result<Layout, ReadError> {
    let fault =
        |what: &str| ReadError::Fault { format: "raw", fault: format!("{MANIFEST} beside it {what}") };
    let encoding = p.encoding.as_ref().ok_or_else(|| fault("does not say how it is stored"))?;
    let storage =
        Storage::find(&encoding.storage).ok_or_else(|| fault("names a storage that there is not"))?;
    let length = |i: usize| p.axes.get(i).map_or(1, |a| a.axis.len);
    let rows = (1..p.axes.len().max(2)).fold(1usize, |n, i| n.saturating_mul(length(i)));
    let components = texels::packed(storage).unwrap_or(p.channels.len());
    Ok(Layout { size: [length(0), rows], components, storage, planar: false })
}

impl Image {
    /// The picture under the names and in the ranges of metadata that lie beside it. One that says itself what it holds stays as it is.
    #[must_use]
    pub fn described(self, provenance: Provenance) -> Image {
        if self.provenance.is_some() {
            return self;
        }
        let named = provenance.encoding.as_ref().is_some_and(|e| !e.names.is_empty());
        let claim = Claim::Known(Box::new(provenance));
        let Claim::Known(p) = &claim else { return self };
        let own = p.channels.iter().all(|c| self.channels.iter().any(|plane| plane.name == c.id));
        let (channels, mut told) = if own {
            (self.channels, Vec::new())
        } else if named {
            exr_names::as_channels(self.channels, p)
        } else {
            (texels::finish(self.channels.into_iter().map(coded).collect(), Some(&claim)), Vec::new())
        };
        let mut warnings = self.warnings;
        warnings.append(&mut told);
        Image { channels, provenance: Some(claim), warnings, ..self }
    }
}

/// The codes of a plane whose codes were read over [0, 1]; of floats the numbers.
fn coded(mut plane: Plane) -> Plane {
    for v in &mut plane.values {
        *v = plane.sample.encode(*v);
    }
    plane
}
