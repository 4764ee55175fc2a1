//! Lobes that are asked for in place of a roughness: an SBRDF map.

use super::images::Images;
use super::{MapRequest, RoughnessInput, Source, fault, words};
use crate::maps::sbrdf::{MOST_LOBES, Normalise};
use crate::maps::{Centre, Shape};
use crate::picture::Space;
use crate::plan::fault::Fault;
use crate::plan::faults::Faults;
use crate::plan::place::Path;
use serde_json::{Value as Json, json};

/// What is asked for, beside the roughness, the normals and the outputs.
#[derive(Debug, Clone, PartialEq)]
pub struct SbrdfRequest {
    /// Where the BRDF comes from.
    pub origin: Origin,
    /// Lobes of a texel, 1 to [`MOST_LOBES`].
    pub lobes: usize,
    /// Fit fewer of them if the residual stays below this; the maps of the others are black.
    pub residual: Option<f64>,
    /// What a lobe is divided by.
    pub normalise: Normalise,
}

/// Where the BRDF comes from.
#[derive(Debug, Clone, PartialEq)]
pub enum Origin {
    /// Metallic-roughness: GGX, height-correlated masking, Schlick's Fresnel.
    Metallic {
        /// Base colour.
        base: ColourInput,
        /// Metallic.
        metallic: NumberInput,
    },
    /// A file of the MERL database, or of the container `merl`.
    Tabulated(Source),
}

/// A colour.
#[derive(Debug, Clone, PartialEq)]
pub enum ColourInput {
    /// One for all texels, linear.
    Constant([f64; 3]),
    /// The channels R, G, B of an image, or its grey.
    Image {
        /// The image.
        image: Source,
        /// How its codes are coded; base colours of glTF as sRGB.
        space: Space,
    },
}

/// A number.
#[derive(Debug, Clone, PartialEq)]
pub enum NumberInput {
    /// One for all texels.
    Constant(f64),
    /// A channel of an image.
    Image {
        /// The image.
        image: Source,
        /// Name of the channel.
        channel: String,
    },
}

/// Channels of a colour.
pub const COLOUR: [&str; 3] = ["R", "G", "B"];

/// Lobes of a texel, if nothing else is said.
pub const LOBES: usize = 2;

impl Default for SbrdfRequest {
    /// Two lobes over their own integral, of a white metal.
    fn default() -> SbrdfRequest {
        let (base, metallic) = (ColourInput::Constant([1.0; 3]), NumberInput::Constant(1.0));
        let origin = Origin::Metallic { base, metallic };
        SbrdfRequest { origin, lobes: LOBES, residual: None, normalise: Normalise::Incident }
    }
}

impl SbrdfRequest {
    /// Has each lobe a constant of its own?
    #[must_use]
    pub fn constants(&self) -> bool {
        self.normalise == Normalise::Largest
    }

    /// The images that it reads, with their roles.
    pub(crate) fn images(&self) -> Vec<(&'static str, &Source)> {
        let mut out = Vec::new();
        match &self.origin {
            Origin::Tabulated(source) => out.push((BRDF, source)),
            Origin::Metallic { base, metallic } => {
                if let ColourInput::Image { image, .. } = base {
                    out.push((BASE, image));
                }
                if let NumberInput::Image { image, .. } = metallic {
                    out.push((METALLIC, image));
                }
            }
        }
        out
    }

    /// Everything but its files, as [`MapRequest::canonical`].
    pub(super) fn canonical(&self) -> Json {
        let mut out = json!({
            "model": MODEL,
            "lobes": self.lobes,
            "normalise": self.normalise.id(),
        });
        if let Some(residual) = self.residual {
            out["residual"] = json!(residual);
        }
        match &self.origin {
            Origin::Tabulated(_) => out["brdf"] = json!(true),
            Origin::Metallic { base, metallic } => {
                out["base"] = match base {
                    ColourInput::Constant(c) => json!(c),
                    ColourInput::Image { space, .. } => {
                        json!({ "space": words::of(&words::SPACES, space) })
                    }
                };
                out["metallic"] = match metallic {
                    NumberInput::Constant(m) => json!(m),
                    NumberInput::Image { channel, .. } => json!({ "channel": channel }),
                };
            }
        }
        out
    }
}

/// The one model of lobes.
pub const MODEL: &str = "lafortune";

/// What the images are to the map.
pub(crate) const BASE: &str = "base";
pub(crate) const METALLIC: &str = "metallic";
pub(crate) const BRDF: &str = "brdf";

/// Judges what can be judged without the images.
pub(super) fn judge(request: &MapRequest, sbrdf: &SbrdfRequest, path: &Path, faults: &mut Faults) {
    let own = path.key("sbrdf");
    let mut range = |path: Path, key: &str, got: f64, [min, max]: [f64; 2]| {
        if !(min..=max).contains(&got) {
            faults.value(path, Fault::Range { key: key.to_owned(), got, min, max });
        }
    };
    range(own.key("lobes"), "lobes", sbrdf.lobes as f64, [1.0, MOST_LOBES as f64]);
    if let Some(residual) = sbrdf.residual {
        range(own.key("residual"), "residual", residual, [1e-6, 1.0]);
    }
    if let Origin::Metallic { base, metallic } = &sbrdf.origin {
        if let ColourInput::Constant(c) = base {
            c.iter().enumerate().for_each(|(i, v)| range(own.key(BASE).index(i), BASE, *v, [0.0, 1.0]));
        }
        if let NumberInput::Constant(m) = metallic {
            range(own.key(METALLIC), METALLIC, *m, [0.0, 1.0]);
        }
    }
    let mut wrong = |key: &str, why: &str, remedy| {
        faults.value(path.key(key), fault(why.to_owned(), None, Some(remedy)));
    };
    if request.filter.shape == Shape::Two {
        let why = "lobes are fitted to one width, not to two lobes of GGX";
        wrong("shape", why, "take the isotropic shape, or leave sbrdf out");
    }
    if request.filter.shape == Shape::Anisotropic && matches!(sbrdf.origin, Origin::Tabulated(_)) {
        let why = "a tabulated BRDF of half and difference angles is isotropic";
        wrong("shape", why, "take the isotropic shape, or leave the table out");
    }
    if matches!(sbrdf.origin, Origin::Tabulated(_)) {
        let white = matches!(request.roughness, RoughnessInput::Constant(r) if r.to_bits() == 1f64.to_bits());
        if !white {
            let why = "a tabulated BRDF has a width of its own";
            wrong("roughness", why, "leave the roughness out, or the table");
        }
        if request.normal.is_some() || request.filter.centre == Centre::Free {
            let why = "a tabulated BRDF is one texel: there are no normals to filter";
            wrong("normal", why, "leave the normals out, or the table");
        }
    }
}

/// Looks at its images.
pub(super) fn look<'a>(sbrdf: &'a SbrdfRequest, path: &Path, images: &mut Images<'a>, faults: &mut Faults) {
    let path = path.key("sbrdf");
    match &sbrdf.origin {
        Origin::Tabulated(source) => {
            images.table(source, &path.key(BRDF), faults);
        }
        Origin::Metallic { base, metallic } => {
            if let ColourInput::Image { image, .. } = base {
                let place = path.key(BASE);
                images.look(BASE, image, COLOUR.map(|c| (c, place.clone())).as_slice(), &place, faults);
            }
            if let NumberInput::Image { image, channel } = metallic {
                let place = path.key(METALLIC);
                let named = [(channel.as_str(), place.key("channel"))];
                images.look(METALLIC, image, &named, &place, faults);
            }
        }
    }
}
