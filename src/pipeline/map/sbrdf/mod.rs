//! SBRDF maps: parameter maps or a tabulated BRDF to lobes of Lafortune at every texel of every level.
//!
//! The roughness is filtered as for any map; F0 and the diffuse colour are linear, and their smaller levels are means of areas.
//! Every texel of every level is then read from one [`Curve`]. A tabulated BRDF is one texel.

mod colour;
mod maps;
mod refit;
mod tell;
mod texels;

pub(super) use colour::Colours;
pub(super) use maps::map;
pub use refit::MeasuredLobes;
pub use tell::{Ladder, Normalisation, Residual, SbrdfRecord};

use super::MapError;
use super::output::Map;
use crate::cancel::{Cancel, Cancelled};
use crate::maps::sbrdf::curve::{self as curves, Curve, mixture};
use crate::maps::sbrdf::fit::{Problem, start};
use crate::maps::sbrdf::nodes::Directions;
use crate::maps::sbrdf::tabulated::Tabulated;
use crate::maps::{self as maps_, Level, Shape, Surface};
use crate::plan::map::{MapRequest, SbrdfRequest};
use refit::Footprints;

/// What lobes are fitted to.
pub(super) enum Target {
    /// Metallic-roughness, with the roughness of the surface.
    Metallic(Colours),
    /// A table of values.
    Tabulated(Tabulated),
}

/// Lobes of all texels, level by level, and how they were found.
pub(super) struct Found {
    /// Lobes that were fitted, and lobes of a texel; those beyond the fitted ones are black.
    fitted: usize,
    lobes: usize,
    /// Sizes, and the numbers of all texels: see [`texels`].
    levels: Vec<texels::Flat>,
    /// Has each lobe a constant of its own?
    constants: bool,
    /// What reading between the fits costs.
    between: f64,
    /// What was measured of the levels, against their footprints.
    measured: Vec<Option<MeasuredLobes>>,
    problems: Problems,
}

/// The problem of a texel of the first level, to measure storage by.
enum Problems {
    /// Roughness and strength of each texel; of one width the strengths are not there.
    Roughness {
        places: Vec<[f32; 2]>,
        stretched: bool,
        mean: [f64; curves::TERMS],
        request: SbrdfRequest,
    },
    One(Box<Problem>),
}

impl Problems {
    fn at(&self, texel: usize) -> Problem {
        match self {
            Problems::Roughness { places, stretched, mean, request } => {
                let [r, s] = places[texel].map(f64::from);
                match stretched {
                    true => curves::stretched(r, s, *mean, request.normalise),
                    false => curves::problem(r, *mean, request.normalise),
                }
            }
            Problems::One(problem) => (**problem).clone(),
        }
    }
}

/// Fits lobes to the texels of all levels.
pub(super) fn find(
    (request, sbrdf): (&MapRequest, &SbrdfRequest),
    target: &Target,
    (surface, levels): (&Surface, &[Level<'_>]),
    cancel: &Cancel,
) -> Result<Found, Cancelled> {
    match target {
        Target::Metallic(colours) => {
            let (f0, diffuse) = colours.means();
            let mean = mixture(f0, diffuse);
            let range = range(levels);
            let stretched = request.filter.shape == Shape::Anisotropic;
            let most = if stretched { strongest(levels) } else { 0.0 };
            let fit = |k: usize| match stretched {
                true => Curve::stretched(range, most, mean, k, sbrdf.normalise, cancel),
                false => Curve::new(range, mean, k, sbrdf.normalise, cancel),
            };
            let curve = fewest(sbrdf, fit, Curve::largest)?;
            #[allow(clippy::cast_possible_truncation, reason = "rounded to f32 on purpose")]
            let place = |t: maps_::Texel| colour::place(&t).map(|v| v as f32);
            let places = levels.first().map_or_else(Vec::new, |l| l.iter().map(place).collect());
            let mut flat = colours.levels(levels, &curve, cancel)?;
            let footprints = Footprints { request, sbrdf, surface, colours, levels };
            let measured = footprints.follow(&mut flat, cancel)?;
            let found = Found {
                fitted: curve.lobes(),
                lobes: curve.lobes(),
                levels: flat,
                constants: sbrdf.constants(),
                between: curve.between,
                measured,
                problems: Problems::Roughness { places, stretched, mean, request: sbrdf.clone() },
            };
            Ok(found.with(sbrdf.lobes))
        }
        Target::Tabulated(table) => tabulated(sbrdf, table, cancel),
    }
}

/// The fewest lobes that reach the residual that is asked for, or all of them.
fn fewest<T>(
    sbrdf: &SbrdfRequest,
    fit: impl Fn(usize) -> Result<T, Cancelled>,
    residual: impl Fn(&T) -> f64,
) -> Result<T, Cancelled> {
    for k in sbrdf.residual.map_or(sbrdf.lobes, |_| 1)..sbrdf.lobes {
        let found = fit(k)?;
        if sbrdf.residual.is_some_and(|r| residual(&found) <= r) {
            return Ok(found);
        }
    }
    fit(sbrdf.lobes)
}

/// The largest strength of all levels.
fn strongest(levels: &[Level<'_>]) -> f64 {
    levels.iter().flat_map(Level::iter).map(|t| colour::place(&t)[1]).fold(0.0, f64::max)
}

/// Least and largest roughness of all levels.
fn range(levels: &[Level<'_>]) -> [f64; 2] {
    let all = || levels.iter().flat_map(Level::iter).map(|t| f64::from(t.roughness));
    [all().fold(1.0, f64::min), all().fold(0.0, f64::max)]
}

/// Steps of the one fit of a table.
const STEPS: usize = 80;

/// One texel from a table.
fn tabulated(sbrdf: &SbrdfRequest, table: &Tabulated, cancel: &Cancel) -> Result<Found, Cancelled> {
    let alpha = table.width();
    let directions = Directions::new(alpha);
    let channel = |c: usize| {
        let value = |i, o: glam::DVec3| table.value(i, o)[c].map_or(f64::NAN, |f| f * o.z);
        directions.sample(value).into_iter().map(|v| Some(v).filter(|v| v.is_finite())).collect()
    };
    let problem = Problem::new(directions.clone(), &[0, 1, 2].map(channel), &[1.0 / 3.0; 3], sbrdf.normalise);
    let fit = |k: usize| {
        cancel.check()?;
        Ok(problem.finish(&problem.descend(&start(alpha, k), STEPS)))
    };
    let fit = fewest(sbrdf, fit, |f| f.all())?;
    let texel = curves::placed(&fit);
    let found = Found {
        fitted: fit.shapes.len(),
        lobes: fit.shapes.len(),
        levels: vec![([1, 1], texels::flat(&texel))],
        constants: sbrdf.constants(),
        between: 0.0,
        measured: Vec::new(),
        problems: Problems::One(Box::new(problem)),
    };
    Ok(found.with(sbrdf.lobes))
}

impl Found {
    /// With black lobes up to this number: the last one again, with an albedo of 0.
    fn with(mut self, lobes: usize) -> Found {
        if lobes > self.lobes {
            let more = texels::stride(lobes) - texels::stride(self.lobes);
            for (_, values) in &mut self.levels {
                let padded = values.chunks_exact(texels::stride(self.lobes)).flat_map(|texel| {
                    let black = texels::black(texel, self.lobes);
                    texel.iter().copied().chain(black.into_iter().cycle().take(more))
                });
                *values = padded.collect();
            }
            self.lobes = lobes;
        }
        self
    }

    /// What the files say of the lobes.
    pub(super) fn record(
        &self,
        request: &MapRequest,
        sbrdf: &SbrdfRequest,
        maps: &[Map],
        cancel: &Cancel,
    ) -> Result<SbrdfRecord, MapError> {
        let storage = match request.outputs.first() {
            Some(first) => maps::storage_error(self, maps, *first, cancel)?,
            None => [0.0; 2],
        };
        Ok(tell::record(sbrdf, self, storage))
    }
}
