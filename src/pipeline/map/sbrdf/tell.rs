//! What the files say of the lobes: gauge, normalisation, norm, errors, and the ladder of powers.

use super::{Found, MeasuredLobes, maps, texels};
use crate::maps::sbrdf::ladder::{self, Rung};
use crate::maps::sbrdf::nodes::{GRAZING, LIGHTS};
use crate::maps::sbrdf::{EXPONENTS, NORMALISATION, Normalise};
use crate::plan::map::SbrdfRequest;
use crate::plan::map::sbrdf::{MODEL, Origin};
use serde::{Deserialize, Serialize};

/// Lobes and their certificate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SbrdfRecord {
    /// `lafortune`.
    pub model: String,
    /// The formula.
    pub formula: String,
    /// `metallic-roughness` or `tabulated`.
    pub source: String,
    /// Lobes of a texel.
    pub lobes: usize,
    /// Lobes that were fitted, if a residual was asked for and fewer reach it; the maps of the others are black.
    pub fitted: usize,
    /// `incident` or `largest`.
    pub normalise: String,
    /// True if light and viewer may be exchanged.
    pub reciprocal: bool,
    /// What an albedo is.
    pub albedo: String,
    /// What fixes C.
    pub gauge: String,
    /// Order of the lobes of a texel.
    pub order: String,
    /// Exponents of the codes 0 and 1.
    pub exponents: [f64; 2],
    /// The norm of the residuals, and its directions.
    pub norm: String,
    /// Residuals of the levels.
    pub levels: Vec<Residual>,
    /// What reading between fits along the roughness adds at most; it is part of the residuals.
    pub between: f64,
    /// What storage in the first output changes of the lobes of the first level, relative, in the same norm: mean and largest.
    pub storage: [f64; 2],
    /// The table of the integrals.
    pub normalisation: Normalisation,
    /// Levels of a prefiltered environment.
    pub ladder: Ladder,
}

/// Residuals of a level.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Residual {
    /// Mean.
    pub mean: f64,
    /// Largest.
    pub largest: f64,
    /// The same against what the footprints of the level reflect; none of the first level.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub measured: Option<MeasuredLobes>,
}

/// The table of the integrals, and how it is read.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Normalisation {
    /// Texels.
    pub size: [usize; 2],
    /// What runs along the rows.
    pub across: String,
    /// What runs down.
    pub down: String,
    /// Below the horizon.
    pub limit: String,
    /// Largest error of each channel half way between texels.
    pub error: [f64; 3],
}

/// Powers of a prefiltered environment.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Ladder {
    /// Power of each level.
    pub powers: Vec<f64>,
    /// Exponent to level, over the codes of exponents; in the manifest only.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub table: Vec<Rung>,
    /// Largest D between a lobe and what is read for it.
    pub largest: f64,
}

pub(super) fn record(request: &SbrdfRequest, found: &Found, storage: [f64; 2]) -> SbrdfRecord {
    let incident = request.normalise == Normalise::Incident;
    let stride = texels::stride(found.lobes);
    let level = |(k, (_, values)): (usize, &texels::Flat)| {
        let all = || values.chunks_exact(stride).map(|t| f64::from(t[texels::RESIDUAL]));
        Residual {
            mean: all().sum::<f64>() / all().count().max(1) as f64,
            largest: all().fold(0.0, f64::max),
            measured: found.measured.get(k).copied().flatten(),
        }
    };
    let table = ladder::table();
    SbrdfRecord {
        model: MODEL.to_owned(),
        formula: (if incident {
            "diffuse/pi + sum albedo (C i . o)^n / N(i), i the light, N(i) = |C i|^n I(n, u) the integral of (C i . o)^n (n . o) over o, u the cosine between C i and n"
        } else {
            "diffuse/pi + sum albedo constant (C i . o)^n, constant one over the largest integral of (C i . o)^n (n . o) over o"
        })
        .to_owned(),
        source: match request.origin {
            Origin::Metallic { .. } => "metallic-roughness".to_owned(),
            Origin::Tabulated(_) => "tabulated".to_owned(),
        },
        lobes: found.lobes,
        fitted: found.fitted,
        normalise: request.normalise.id().to_owned(),
        reciprocal: !incident,
        albedo: (if incident { "the reflectance of the lobe, exactly" } else { "a bound of its reflectance" })
            .to_owned(),
        gauge: "max |C| = 1".to_owned(),
        order: "falling albedo (luminance), texel by texel".to_owned(),
        exponents: EXPONENTS,
        norm: format!(
            "root of the sum over lights of the integral of (difference of f cos)^2/(f cos + E cos/pi), over that of the target; \
             {LIGHTS} lights of equal projected solid angle and one at cosine {} with the share {}",
            GRAZING[0], GRAZING[1]
        ),
        levels: found.levels.iter().enumerate().map(level).collect(),
        between: found.between,
        storage,
        normalisation: Normalisation {
            size: NORMALISATION,
            across: "v from -1 to 1, both at texel middles; u = v |v|".to_owned(),
            down: "code of the exponent from 0 to 1, both at texel middles".to_owned(),
            limit: "where C i is below the horizon (u < 0) use root^(n + 1); root comes to sqrt(1 - u^2) for large n and is 0 at u = -1, where the lobe is black".to_owned(),
            error: maps::normalisation_error(),
        },
        ladder: Ladder {
            powers: ladder::powers(),
            largest: table.iter().map(|r| r.distance).fold(0.0, f64::max),
            table,
        },
    }
}

impl SbrdfRecord {
    /// Without what only the manifest holds.
    pub(in super::super) fn short(&self) -> SbrdfRecord {
        let mut out = self.clone();
        out.ladder.table.clear();
        out
    }
}
