//! `brdfbake map --sbrdf lafortune`: lobes of Lafortune at each texel.

use super::Failure;
use crate::maps::sbrdf::Normalise;
use crate::math::figures::short;
use crate::picture::Space;
use crate::pipeline::map::{ColourInput, MapRecord, NumberInput, Origin, SbrdfRequest};
use std::path::PathBuf;

/// Options of SBRDF maps.
#[derive(Debug, clap::Args)]
pub(super) struct Lobes {
    /// Write lobes at each texel in place of the roughness: an SBRDF map.
    #[arg(long, value_enum, value_name = "MODEL")]
    sbrdf: Option<Model>,
    /// Lobes of a texel, 1 to 3.
    #[arg(long, value_name = "K", default_value_t = 2, requires = "sbrdf")]
    lobes: usize,
    /// Fit fewer lobes if the relative residual stays below this; the others are black.
    #[arg(long, value_name = "NUMBER", requires = "sbrdf")]
    residual: Option<f64>,
    /// What a lobe is divided by: its integral at the direction of the light (its albedo is exact, reciprocity is broken), or the
    /// largest one (reciprocal, the albedo is a bound).
    #[arg(long, value_enum, default_value = "incident", requires = "sbrdf")]
    normalise: By,
    /// Base colour: an image, coded as sRGB, or linear numbers R,G,B.
    #[arg(long, value_name = "FILE|R,G,B", default_value = "1,1,1", requires = "sbrdf")]
    base_color: String,
    /// The base colour image is linear.
    #[arg(long, requires = "sbrdf")]
    base_color_linear: bool,
    /// Metallic: an image, or a number.
    #[arg(long, value_name = "FILE|NUMBER", default_value = "1", requires = "sbrdf")]
    metallic: String,
    /// Channel of the metallic image.
    #[arg(long, value_name = "NAME", default_value = "B", requires = "sbrdf")]
    metallic_channel: String,
    /// A tabulated BRDF in place of the maps: a file of the MERL database, or of the container `merl`.
    #[arg(long, value_name = "FILE", requires = "sbrdf", conflicts_with_all = MEASURED_NOT)]
    brdf: Option<PathBuf>,
}

/// What a measured BRDF does nothing with: it has one lobe for all texels, and no maps. `requires` is silent where what is required is
/// refused.
const MEASURED_NOT: [&str; 38] = [
    "base_color",
    "base_color_linear",
    "metallic",
    "metallic_channel",
    "normal",
    "normal_channels",
    "green_down",
    "derive_z",
    "signed",
    "normal_scale",
    "mend_normals",
    "resample",
    "wrap",
    "normal_storage",
    "roughness",
    "roughness_storage",
    "channel",
    "gloss",
    "srgb",
    "from",
    "second_channel",
    "angle_channel",
    "range",
    "log",
    "formula",
    "factor",
    "single",
    "gltf",
    "rule",
    "normals",
    "anisotropic",
    "two_lobes",
    "anisotropy",
    "anisotropy_strength",
    "anisotropy_rotation",
    "exact",
    "objective",
    "compare",
];

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Model {
    Lafortune,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum By {
    Incident,
    Largest,
}

impl Lobes {
    /// What is asked for, if anything is.
    pub(super) fn request(&self) -> Result<Option<SbrdfRequest>, Failure> {
        if self.sbrdf.is_none() {
            return Ok(None);
        }
        let origin = match &self.brdf {
            Some(path) => Origin::Tabulated(path.clone().into()),
            None => Origin::Metallic { base: self.base()?, metallic: self.metallic() },
        };
        let normalise = match self.normalise {
            By::Incident => Normalise::Incident,
            By::Largest => Normalise::Largest,
        };
        Ok(Some(SbrdfRequest { origin, lobes: self.lobes, residual: self.residual, normalise }))
    }

    fn base(&self) -> Result<ColourInput, Failure> {
        let given = &self.base_color;
        let numbers: Result<Vec<f64>, _> = given.split(',').map(|v| v.trim().parse()).collect();
        match numbers.as_deref() {
            Ok([r, g, b]) => Ok(ColourInput::Constant([*r, *g, *b])),
            Ok([grey]) => Ok(ColourInput::Constant([*grey; 3])),
            Ok(_) => Err(Failure::usage(format!("--base-color {given}: one or three numbers are needed"))),
            Err(_) => Ok(ColourInput::Image {
                image: PathBuf::from(given).into(),
                space: if self.base_color_linear { Space::Linear } else { Space::Srgb },
            }),
        }
    }

    fn metallic(&self) -> NumberInput {
        match self.metallic.parse() {
            Ok(m) => NumberInput::Constant(m),
            Err(_) => NumberInput::Image {
                image: PathBuf::from(&self.metallic).into(),
                channel: self.metallic_channel.clone(),
            },
        }
    }
}

/// What is told of lobes.
pub(super) fn lobes(record: &MapRecord, out: &mut String) {
    let Some(told) = &record.sbrdf else { return };
    let (count, over) = (told.fitted, &told.normalise);
    let way = if told.reciprocal { "" } else { " (not reciprocal)" };
    out.push_str(&format!("{count} lobes of Lafortune a texel, each over its {over} integral{way}\n"));
    for (k, level) in told.levels.iter().enumerate() {
        let (mean, largest) = (short(level.mean), short(level.largest));
        let own = level.measured.map_or_else(String::new, |m| {
            format!("; against the footprints {}, refit {}", short(m.mean), short(m.refit))
        });
        out.push_str(&format!("level {k}: residual mean {mean}, largest {largest}{own}\n"));
    }
    let [mean, largest] = told.storage.map(short);
    out.push_str(&format!("storage changes the lobes by {mean} (largest {largest})\n"));
    out.push_str(&format!(
        "reading between fits costs at most {}; between levels of an environment D is at most {}\n",
        short(told.between),
        short(told.ladder.largest)
    ));
}

/// What is told of a conversion.
pub(super) fn conversion(record: &MapRecord, out: &mut String) {
    let Some(c) = &record.conversion else { return };
    let [[dm, dl], [em, el]] = [c.distance, c.energy].map(|p| p.map(short));
    out.push_str(&format!(
        "conversion from {} ({}): D mean {dm}, largest {dl}; E differs by {em} in the mean, {el} at most\n",
        c.from, c.rule
    ));
    if c.gained.texels > 0 {
        let (n, most) = (c.gained.texels, short(c.gained.largest));
        out.push_str(&format!("finding: at {n} texels GGX reflects more than the lobe, {most} at most\n"));
    }
    for place in c.worst.iter().take(3) {
        let (d, e) = (short(f64::from(place.distance)), short(f64::from(place.energy)));
        out.push_str(&format!("worst of the conversion: ({}, {}) D {d}, E {e}\n", place.x, place.y));
    }
}
