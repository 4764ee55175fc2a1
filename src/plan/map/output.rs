//! The files of a map: containers, and how each kind of map is stored in them.

use super::{MapRequest, Packing, RoughnessInput, SbrdfRequest};
use crate::encode::mips::{self, containers};
use crate::encode::{Encoder, Storage};
use crate::maps::sbrdf::MOST_LOBES;
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
    /// The wide lobe beside a narrow one: √α, and its share.
    Wide,
    /// D of each texel, and its doubt.
    Error,
    /// What a conversion of lobes of another kind costs: D, and the largest difference of the reflectance.
    Conversion,
    /// Diffuse albedo beside lobes.
    Diffuse,
    /// Albedo of a lobe, counted from 0.
    Albedo(usize),
    /// Axis and exponent of a lobe.
    Shape(usize),
    /// Direction of the first axis of lobes with Cx ≠ Cy.
    Tangent,
    /// How far lobes are from what they stand for.
    Residual,
    /// The table of the integrals of lobes.
    Normalisation,
}

/// Ids of the maps of the lobes.
const ALBEDOS: [&str; MOST_LOBES] = ["lobe1.albedo", "lobe2.albedo", "lobe3.albedo"];
const SHAPES: [&str; MOST_LOBES] = ["lobe1.shape", "lobe2.shape", "lobe3.shape"];

impl Kind {
    /// Id, as in the names of files.
    #[must_use]
    pub fn id(self) -> &'static str {
        let lobe = |ids: [&'static str; MOST_LOBES], j: usize| ids.get(j).copied().unwrap_or("lobe");
        match self {
            Kind::Roughness => "roughness",
            Kind::Normal => "normal",
            Kind::Anisotropy => "anisotropy",
            Kind::Wide => "wide",
            Kind::Error => "error",
            Kind::Conversion => "conversion",
            Kind::Diffuse => "diffuse",
            Kind::Albedo(j) => lobe(ALBEDOS, j),
            Kind::Shape(j) => lobe(SHAPES, j),
            Kind::Tangent => "tangent",
            Kind::Residual => "residual",
            Kind::Normalisation => "normalisation",
        }
    }

    /// As storage sees it.
    #[must_use]
    pub fn held(self) -> Held {
        match self {
            Kind::Roughness => Held::Roughness,
            Kind::Normal => Held::Normal,
            Kind::Anisotropy | Kind::Tangent => Held::Anisotropy,
            Kind::Wide => Held::Wide,
            Kind::Error | Kind::Conversion | Kind::Residual => Held::Error,
            Kind::Diffuse | Kind::Albedo(_) => Held::Albedo,
            Kind::Shape(_) => Held::Shape,
            Kind::Normalisation => Held::Table,
        }
    }
}

/// What maps of a kind hold, as their storage sees it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Held {
    /// Roughness, and what is packed with it.
    Roughness,
    /// Fitted normals.
    Normal,
    /// Anisotropy.
    Anisotropy,
    /// Errors: few digits.
    Error,
    /// Albedos: from 0 on, some of them above 1.
    Albedo,
    /// Shapes of lobes: numbers between bounds that are told.
    Shape,
    /// A table that is read beside the maps.
    Table,
    /// Wide lobes beside narrow ones.
    Wide,
}

impl Held {
    /// Everything, in the order in which storages are written.
    pub const ALL: [Held; 8] = [
        Held::Roughness,
        Held::Normal,
        Held::Anisotropy,
        Held::Error,
        Held::Albedo,
        Held::Shape,
        Held::Table,
        Held::Wide,
    ];

    /// The word of an output, as in `ktx2:shape=unorm16`.
    #[must_use]
    pub const fn id(self) -> &'static str {
        match self {
            Held::Roughness => "roughness",
            Held::Normal => "normal",
            Held::Anisotropy => "anisotropy",
            Held::Error => "error",
            Held::Albedo => "albedo",
            Held::Shape => "shape",
            Held::Table => "table",
            Held::Wide => "wide",
        }
    }

    /// Storages in order of preference: 8 bits for what is looked at, 16 for normals and lobes, floats where a container has nothing less.
    const fn usual(self) -> &'static [Storage] {
        match self {
            Held::Roughness | Held::Anisotropy | Held::Wide => &[Storage::Unorm8, Storage::Float],
            Held::Normal | Held::Shape => &[Storage::Unorm16, Storage::Float],
            Held::Error => &[Storage::Half, Storage::Unorm8],
            Held::Albedo => &[Storage::Half, Storage::Unorm16],
            Held::Table => &[Storage::Float, Storage::Unorm16],
        }
    }

    /// The usual storage in a container.
    fn usual_in(self, encoder: &dyn Encoder) -> Storage {
        let taken = encoder.mip_storages();
        let found = self.usual().iter().find(|s| taken.contains(s)).or(taken.first());
        found.copied().unwrap_or(Storage::Float)
    }
}

/// A container, and how each map is stored in it. `Display` writes it as recipes do: `ktx2:roughness=bc4+normal=bc5`.
#[derive(Debug, Clone, Copy)]
pub struct Output {
    /// The container: one of [`containers`].
    pub encoder: &'static dyn Encoder,
    /// Storages in the order of [`Held::ALL`].
    storages: [Storage; Held::ALL.len()],
}

impl Output {
    /// The usual storages of a container.
    #[must_use]
    pub fn new(encoder: &'static dyn Encoder) -> Output {
        Output { encoder, storages: Held::ALL.map(|held| held.usual_in(encoder)) }
    }

    /// Reads `container`, with `:word=storage+word=storage` behind it or not.
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
            let (held, storage) = part.split_once('=').ok_or_else(|| Fault::Map {
                why: format!("`{part}` is not of the form `kind=storage`"),
                allowed: Some("such as \"ktx2:roughness=bc4+normal=bc5\"".to_owned()),
                remedy: None,
            })?;
            output = output.with(held, storage)?;
        }
        Ok(output)
    }

    /// With another storage of what maps hold.
    ///
    /// # Errors
    /// [`Fault::Word`] for a word or storage that there is not.
    pub fn with(self, held: &str, storage: &str) -> Result<Output, Fault> {
        let Some(found) = Held::ALL.into_iter().find(|h| h.id() == held) else {
            return Err(unknown_word("kind of map", held, Held::ALL.iter().map(|h| h.id())));
        };
        let taken = self.encoder.mip_storages();
        let Some(storage) = taken.iter().find(|s| s.id() == storage) else {
            let what = format!("{} storage of maps", self.encoder.id());
            return Err(unknown_word(&what, storage, taken.iter().map(|s| s.id())));
        };
        if !storage.is_written() {
            return Err(Fault::without(&format!("storage `{}`", storage.id()), "blocks"));
        }
        Ok(self.stored(found, *storage))
    }

    /// With another storage.
    #[must_use]
    pub fn stored(mut self, held: Held, storage: Storage) -> Output {
        self.storages[held as usize] = storage;
        self
    }

    /// The storage of a map.
    #[must_use]
    pub fn storage(&self, kind: Kind) -> Storage {
        self.storages[kind.held() as usize]
    }
}

impl std::fmt::Display for Output {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.encoder.id())?;
        for (i, (held, storage)) in Held::ALL.into_iter().zip(self.storages).enumerate() {
            // every output tells the first four, and of lobes what is not usual
            if i < 4 || storage != held.usual_in(self.encoder) {
                let between = if i == 0 { ':' } else { '+' };
                write!(f, "{between}{}={}", held.id(), storage.id())?;
            }
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
        let mut out = Vec::new();
        let mut put = |written: bool, kind: Kind| out.extend(written.then_some(kind));
        put(self.sbrdf.is_none(), Kind::Roughness);
        put(self.filter.centre == Centre::Free, Kind::Normal);
        put(
            self.filter.shape == Shape::Anisotropic && self.filter.rule.anisotropic && self.sbrdf.is_none(),
            Kind::Anisotropy,
        );
        put(self.filter.shape == Shape::Two && self.sbrdf.is_none(), Kind::Wide);
        match &self.sbrdf {
            None => put(true, Kind::Error),
            Some(sbrdf) => {
                put(true, Kind::Diffuse);
                for j in 0..sbrdf.lobes.min(MOST_LOBES) {
                    put(true, Kind::Albedo(j));
                    put(true, Kind::Shape(j));
                }
                put(self.filter.shape == Shape::Anisotropic, Kind::Tangent);
                put(true, Kind::Residual);
                put(true, Kind::Normalisation);
            }
        }
        put(self.roughness.from().is_some(), Kind::Conversion);
        out
    }

    /// Is the z of normals left to the shader? In an output of two channels it is, and then in all of them.
    #[must_use]
    pub fn drops_z(&self) -> bool {
        self.outputs.iter().any(|o| mips::most_channels(o.storage(Kind::Normal)) == 2)
    }

    /// Channels of a map, where an image with so many is what the roughness is packed in.
    pub(super) fn channels(&self, kind: Kind, image: usize) -> usize {
        match kind {
            Kind::Roughness => match (self.packing, &self.roughness) {
                (Packing::Gltf, _) => 3,
                (Packing::Image, RoughnessInput::Image { .. }) if self.roughness.packs() => image,
                _ => 1,
            },
            Kind::Normal if self.drops_z() => 2,
            Kind::Normal | Kind::Anisotropy | Kind::Diffuse | Kind::Normalisation => 3,
            Kind::Error | Kind::Conversion | Kind::Residual | Kind::Wide | Kind::Tangent => 2,
            Kind::Albedo(_) => 3 + usize::from(self.sbrdf.as_ref().is_some_and(SbrdfRequest::constants)),
            Kind::Shape(_) => 4,
        }
    }
}
