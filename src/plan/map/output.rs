//! The files of a map: containers, and how each kind of map is stored in them.

use super::{MapRequest, Packing, RoughnessInput};
use crate::encode::mips::{self, containers};
use crate::encode::{Encoder, Storage};
use crate::maps::{Centre, Shape};
use crate::plan::fault::{Fault, unknown_word};

/// What a map holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Kind {
    /// √α, and what it is packed with.
    Roughness,
    /// Fitted normals.
    Normal,
    /// Direction and strength of the wider axis.
    Anisotropy,
    /// D of each texel, and its doubt.
    Error,
}

impl Kind {
    /// Every kind, in the order in which they are written.
    pub const ALL: [Kind; 4] = [Kind::Roughness, Kind::Normal, Kind::Anisotropy, Kind::Error];

    /// Id, as in the names of files.
    #[must_use]
    pub const fn id(self) -> &'static str {
        match self {
            Kind::Roughness => "roughness",
            Kind::Normal => "normal",
            Kind::Anisotropy => "anisotropy",
            Kind::Error => "error",
        }
    }

    /// Storages in order of preference: 8 bits for what is looked at, 16 for normals, floats where a container has nothing less.
    const fn usual(self) -> &'static [Storage] {
        match self {
            Kind::Roughness | Kind::Anisotropy => &[Storage::Unorm8, Storage::Float],
            Kind::Normal => &[Storage::Unorm16, Storage::Float],
            Kind::Error => &[Storage::Half, Storage::Unorm8],
        }
    }
}

/// A container, and how each map is stored in it. `Display` writes it as recipes do: `ktx2:roughness=bc4+normal=bc5`.
#[derive(Debug, Clone, Copy)]
pub struct Output {
    /// The container: one of [`containers`].
    pub encoder: &'static dyn Encoder,
    /// Storage of the roughness and of what is packed with it.
    pub roughness: Storage,
    /// Storage of normals.
    pub normal: Storage,
    /// Storage of anisotropy.
    pub anisotropy: Storage,
    /// Storage of errors.
    pub error: Storage,
}

impl Output {
    /// The usual storages of a container.
    #[must_use]
    pub fn new(encoder: &'static dyn Encoder) -> Output {
        let usual = |kind: Kind| {
            let taken = encoder.mip_storages();
            let found = kind.usual().iter().find(|s| taken.contains(s)).or(taken.first());
            found.copied().unwrap_or(Storage::Float)
        };
        Output {
            encoder,
            roughness: usual(Kind::Roughness),
            normal: usual(Kind::Normal),
            anisotropy: usual(Kind::Anisotropy),
            error: usual(Kind::Error),
        }
    }

    /// Reads `container`, with `:kind=storage+kind=storage` behind it or not.
    ///
    /// # Errors
    /// [`Fault`] for a word that is not known, or a storage that the container does not take.
    pub fn parse(text: &str) -> Result<Output, Fault> {
        let (id, rest) = text.split_once(':').map_or((text, None), |(id, rest)| (id, Some(rest)));
        let Some(encoder) = containers().find(|e| e.id() == id) else {
            return Err(unknown_word("container of maps", id, containers().map(Encoder::id)));
        };
        let mut output = Output::new(encoder);
        for part in rest.into_iter().flat_map(|r| r.split('+')) {
            let (kind, storage) = part.split_once('=').ok_or_else(|| Fault::Map {
                why: format!("`{part}` is not of the form `kind=storage`"),
                allowed: Some("such as \"ktx2:roughness=bc4+normal=bc5\"".to_owned()),
                remedy: None,
            })?;
            output = output.with(kind, storage)?;
        }
        Ok(output)
    }

    /// With another storage of a kind of map.
    ///
    /// # Errors
    /// [`Fault::Word`] for a kind or storage that there is not.
    pub fn with(mut self, kind: &str, storage: &str) -> Result<Output, Fault> {
        let kinds = || Kind::ALL.iter().map(|k| k.id());
        let kind = Kind::ALL.into_iter().find(|k| k.id() == kind);
        let Some(kind) = kind else { return Err(unknown_word("kind of map", storage, kinds())) };
        let taken = self.encoder.mip_storages();
        let Some(storage) = taken.iter().find(|s| s.id() == storage) else {
            let what = format!("{} storage of maps", self.encoder.id());
            return Err(unknown_word(&what, storage, taken.iter().map(|s| s.id())));
        };
        *self.place(kind) = *storage;
        Ok(self)
    }

    fn place(&mut self, kind: Kind) -> &mut Storage {
        match kind {
            Kind::Roughness => &mut self.roughness,
            Kind::Normal => &mut self.normal,
            Kind::Anisotropy => &mut self.anisotropy,
            Kind::Error => &mut self.error,
        }
    }

    /// The storage of a map.
    #[must_use]
    pub fn storage(&self, kind: Kind) -> Storage {
        match kind {
            Kind::Roughness => self.roughness,
            Kind::Normal => self.normal,
            Kind::Anisotropy => self.anisotropy,
            Kind::Error => self.error,
        }
    }
}

impl std::fmt::Display for Output {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.encoder.id())?;
        for (i, kind) in Kind::ALL.into_iter().enumerate() {
            let between = if i == 0 { ':' } else { '+' };
            write!(f, "{between}{}={}", kind.id(), self.storage(kind).id())?;
        }
        Ok(())
    }
}

impl PartialEq for Output {
    fn eq(&self, other: &Output) -> bool {
        self.to_string() == other.to_string()
    }
}

impl Eq for Output {}

impl MapRequest {
    /// The kinds of map that it writes.
    #[must_use]
    pub fn kinds(&self) -> Vec<Kind> {
        let written = |kind: &Kind| match kind {
            Kind::Roughness | Kind::Error => true,
            Kind::Normal => self.filter.centre == Centre::Free,
            Kind::Anisotropy => self.filter.shape == Shape::Anisotropic && self.filter.rule.anisotropic,
        };
        Kind::ALL.into_iter().filter(written).collect()
    }

    /// Is the z of normals left to the shader? In an output of two channels it is, and then in all of them.
    #[must_use]
    pub fn drops_z(&self) -> bool {
        self.outputs.iter().any(|o| mips::most_channels(o.normal) == 2)
    }

    /// Channels of a map, where an image with so many is what the roughness is packed in.
    pub(super) fn channels(&self, kind: Kind, image: usize) -> usize {
        match kind {
            Kind::Roughness => match (self.packing, &self.roughness) {
                (Packing::Gltf, _) => 3,
                (Packing::Image, RoughnessInput::Image { .. }) => image,
                _ => 1,
            },
            Kind::Normal => {
                if self.drops_z() {
                    2
                } else {
                    3
                }
            }
            Kind::Anisotropy => 3,
            Kind::Error => 2,
        }
    }
}
