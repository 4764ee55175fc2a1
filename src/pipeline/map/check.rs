//! Measures texels of the written maps against the texels that they stand for, before and after storage.
//!
//! The filter works on merged footprints; here every facet of the first level counts (a regular choice of [`MOST`] where there are more).

use super::MapError;
use super::output::{Map, failed};
use crate::cancel::Cancel;
use crate::encode::{Storage, mips};
use crate::maps::{
    Centre, Effort, Facet, Fitter, Footprint, Level, Lobe, Objective, RULES, Shape, Surface, Texel, Wide,
    reflected, rules,
};
use crate::picture::{Coverage, halved};
use crate::plan::map::{Held, Kind, MapRequest, Output};
use crate::verify::seeds::Seeds;
use glam::DVec3;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Most facets of a footprint that is measured.
const MOST: usize = 4096;

/// Worst texels of a level that are measured in any case.
const WORST: usize = 20;

/// What the measurement of a level came to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// Texels that were measured: a seeded choice, and the twenty worst.
    pub texels: usize,
    /// Mean of D before storage.
    pub mean: f64,
    /// Largest D before storage.
    pub largest: f64,
    /// Largest difference between D as it was told and as it was measured.
    pub miss: f64,
    /// Mean of D after storage in the first output.
    pub stored_mean: f64,
    /// Largest D after storage.
    pub stored_largest: f64,
    /// The same with normals of 16 and of 8 bits a component, where normals are fitted: what fewer bits lose.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub normals: Vec<StoredMeasured>,
    /// The published rules at the same texels, if they were asked for.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub rules: Vec<RuleMeasured>,
}

/// D after storage of normals.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StoredMeasured {
    /// Storage of the normals.
    pub storage: String,
    /// Mean of D.
    pub mean: f64,
    /// Largest D.
    pub largest: f64,
}

/// What a rule came to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RuleMeasured {
    /// Id.
    pub rule: String,
    /// Mean of D.
    pub mean: f64,
    /// Largest D.
    pub largest: f64,
}

/// Storages of fitted normals that are compared.
const NORMALS: [Storage; 2] = [Storage::Unorm16, Storage::Unorm8];

/// One texel: D told, before storage, after it, and of the rules.
struct Sample {
    told: f64,
    before: f64,
    after: f64,
    /// With normals of each of [`NORMALS`].
    normals: Vec<f64>,
    rules: Vec<f64>,
}

pub(super) fn measure(
    request: &MapRequest,
    surface: &Surface,
    levels: &[Level<'_>],
    maps: &[Map],
    cancel: &Cancel,
) -> Result<Vec<Option<Measured>>, MapError> {
    let sizes = halved(surface.size[0], surface.size[1]);
    let mut out = vec![None];
    let mut cover = [0, 1].map(|axis| Coverage::new(surface.size[axis], surface.size[axis]));
    for (k, level) in levels.iter().enumerate().skip(1) {
        cover = [0, 1].map(|axis| cover[axis].then(&Coverage::new(sizes[k - 1][axis], sizes[k][axis])));
        let chosen = choose(level, k, request.check);
        let stored = stored(request.outputs.first(), request, maps, k, cancel)?;
        let others = with_normals(request, maps, k, cancel)?;
        let one = |fitter: &mut Fitter, texel: &usize| -> Result<Option<Sample>, MapError> {
            cancel.check()?;
            let facets = gather(surface, &cover, texel % level.size[0], texel / level.size[0]);
            let Some(footprint) = Footprint::new(facets) else { return Ok(None) };
            let own = &level.at(*texel);
            let two = request.filter.shape == Shape::Two;
            let light = request.filter.objective == Objective::Reflected;
            let mut distance = |(lobe, wide): &(Lobe, Wide)| {
                if two {
                    fitter.distance_of_two(lobe, *wide, &footprint).0
                } else if light {
                    reflected::distance(lobe, &footprint)
                } else {
                    fitter.distance(lobe, &footprint).0
                }
            };
            let before = distance(&(own.lobe(), own.second()));
            let after = distance(&stored.lobe(*texel, own));
            let normals = others.iter().map(|s| distance(&s.lobe(*texel, own))).collect();
            let rules = if request.compare { compare(fitter, &footprint, request) } else { Vec::new() };
            Ok(Some(Sample { told: f64::from(own.distance), before, after, normals, rules }))
        };
        let samples: Result<Vec<Option<Sample>>, MapError> =
            chosen.par_iter().map_init(|| Fitter::new(Effort::Fast), one).collect();
        let samples: Vec<Sample> = samples?.into_iter().flatten().collect();
        out.push((!samples.is_empty()).then(|| sum(&samples)));
    }
    Ok(out)
}

fn compare(fitter: &mut Fitter, footprint: &Footprint, request: &MapRequest) -> Vec<f64> {
    published().map(|r| r.apply(fitter, footprint, Centre::Mean, request.filter.shape).distance).collect()
}

/// The rules that a fit is compared with.
fn published() -> impl Iterator<Item = &'static rules::Rule> {
    RULES.iter().copied().filter(|r| matches!(r.method, rules::Method::Formula(_)))
}

fn sum(samples: &[Sample]) -> Measured {
    let n = samples.len() as f64;
    let mean = |of: &dyn Fn(&Sample) -> f64| samples.iter().map(of).sum::<f64>() / n;
    let largest = |of: &dyn Fn(&Sample) -> f64| samples.iter().map(of).fold(0.0, f64::max);
    // as many as were asked for: all or none
    let compared = samples.first().map_or(0, |s| s.rules.len());
    Measured {
        texels: samples.len(),
        mean: mean(&|s| s.before),
        largest: largest(&|s| s.before),
        miss: largest(&|s| (s.before - s.told).abs()),
        stored_mean: mean(&|s| s.after),
        stored_largest: largest(&|s| s.after),
        normals: NORMALS
            .iter()
            .take(samples.first().map_or(0, |s| s.normals.len()))
            .enumerate()
            .map(|(i, storage)| StoredMeasured {
                storage: storage.id().to_owned(),
                mean: mean(&|s| s.normals[i]),
                largest: largest(&|s| s.normals[i]),
            })
            .collect(),
        rules: published()
            .take(compared)
            .enumerate()
            .map(|(i, r)| RuleMeasured {
                rule: r.id.to_owned(),
                mean: mean(&|s| s.rules[i]),
                largest: largest(&|s| s.rules[i]),
            })
            .collect(),
    }
}

/// Texels of a level: all, or a seeded choice and the worst.
fn choose(level: &Level<'_>, k: usize, count: usize) -> Vec<usize> {
    let n = level.len();
    if n <= count + WORST {
        return (0..n).collect();
    }
    let mut worst: Vec<(f32, usize)> = level.iter().map(|t| t.distance).zip(0..).collect();
    let order = |a: &(f32, usize), b: &(f32, usize)| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1));
    worst.select_nth_unstable_by(WORST, order);
    let worst = worst.into_iter().take(WORST).map(|w| w.1);
    let seeded = (0..count).map(|i| Seeds::new((k as u64) << 32 | i as u64).index(n));
    let mut chosen: Vec<usize> = worst.chain(seeded).collect();
    chosen.sort_unstable();
    chosen.dedup();
    chosen
}

/// The facets under a texel: all, or every so many of each line.
fn gather(surface: &Surface, cover: &[Coverage; 2], x: usize, y: usize) -> Vec<Facet> {
    let under = under(surface.size[0], cover, x, y, MOST);
    under.into_iter().map(|(texel, weight)| surface.facet(texel, weight)).collect()
}

/// The texels of the first level under a texel, with their shares: all, or every so many of each line for at most `most`.
pub(super) fn under(
    width: usize,
    cover: &[Coverage; 2],
    x: usize,
    y: usize,
    most: usize,
) -> Vec<(usize, f64)> {
    let (across, down) = (cover[0].of(x), cover[1].of(y));
    let side = most.isqrt();
    let thin = |line: &[(usize, f64)]| -> Vec<(usize, f64)> {
        let step = line.len().div_ceil(side).max(1);
        let kept: Vec<(usize, f64)> = line.iter().skip(step / 2).step_by(step).copied().collect();
        let total: f64 = kept.iter().map(|p| p.1).sum();
        kept.into_iter().map(|(i, w)| (i, w / total)).collect()
    };
    let (across, down) = (thin(across), thin(down));
    let row = |(y, wy): &(usize, f64)| {
        let (y, wy) = (*y, *wy);
        across.iter().map(move |(x, wx)| (y * width + x, wx * wy)).collect::<Vec<_>>()
    };
    down.iter().flat_map(row).collect()
}

/// What a reader of the first output finds on a level.
struct Stored {
    roughness: Vec<f32>,
    normal: Option<(Vec<f32>, usize, f32)>,
    anisotropy: Option<Vec<f32>>,
    wide: Option<Vec<f32>>,
}

/// The first output with its normals in each of [`NORMALS`]; nothing where none are written.
fn with_normals(
    request: &MapRequest,
    maps: &[Map],
    k: usize,
    cancel: &Cancel,
) -> Result<Vec<Stored>, MapError> {
    let Some(first) = request.outputs.first().filter(|_| request.kinds().contains(&Kind::Normal)) else {
        return Ok(Vec::new());
    };
    let one = |normal: &Storage| stored(Some(&first.stored(Held::Normal, *normal)), request, maps, k, cancel);
    NORMALS.iter().map(one).collect()
}

fn stored(
    output: Option<&Output>,
    request: &MapRequest,
    maps: &[Map],
    k: usize,
    cancel: &Cancel,
) -> Result<Stored, MapError> {
    let Some(output) = output else {
        return Ok(Stored { roughness: Vec::new(), normal: None, anisotropy: None, wide: None });
    };
    let values = |kind: Kind| -> Result<Option<(Vec<f32>, usize)>, MapError> {
        let Some(map) = maps.iter().find(|m| m.kind == kind) else { return Ok(None) };
        let pyramid = map.mips(output.storage(kind), cancel);
        let values = mips::stored(&pyramid, k).map_err(|e| failed(kind, e))?;
        Ok(Some((values, map.channels.len())))
    };
    let roughness = values(Kind::Roughness)?.map_or_else(Vec::new, |(v, n)| {
        let map = maps.iter().find(|m| m.kind == Kind::Roughness);
        let own = map.and_then(|m| m.channels.iter().position(|c| c.id == "roughness")).unwrap_or(0);
        v.into_iter().skip(own).step_by(n).collect()
    });
    let down = request.normal.as_ref().is_some_and(|n| n.convention.green_down);
    let normal = values(Kind::Normal)?.map(|(v, n)| (v, n, if down { -1.0 } else { 1.0 }));
    let anisotropy = values(Kind::Anisotropy)?.map(|(v, _)| v);
    let wide = values(Kind::Wide)?.map(|(v, _)| v);
    Ok(Stored { roughness, normal, anisotropy, wide })
}

impl Stored {
    /// The lobe that a shader makes of a texel; what is not written is taken as it was found.
    fn lobe(&self, texel: usize, own: &Texel) -> (Lobe, Wide) {
        let (mut lobe, mut wide) = (own.lobe(), own.second());
        if let Some(r) = self.roughness.get(texel).copied().map(f64::from) {
            (lobe.alpha_min, lobe.alpha_max) = (r * r, r * r);
        }
        if let Some((values, n, sense)) = &self.normal {
            let t = &values[texel * n..(texel + 1) * n];
            let (x, y) = (f64::from(t[0]), f64::from(t[1]) * f64::from(*sense));
            let z = t.get(2).map_or_else(|| (1.0 - x * x - y * y).max(0.0).sqrt(), |z| f64::from(*z));
            lobe.normal = DVec3::new(x, y, z).normalize();
        }
        if let Some(values) = &self.anisotropy {
            let t = &values[3 * texel..3 * texel + 3];
            let s = f64::from(t[2]);
            lobe.alpha_max = lobe.alpha_min + (1.0 - lobe.alpha_min) * s * s;
            lobe.angle = libm::atan2(f64::from(t[1]), f64::from(t[0]));
        }
        if let Some(values) = &self.wide {
            let [r, share] = [0, 1].map(|c| f64::from(values[2 * texel + c]));
            wide = Wide { alpha: r * r, share };
        }
        (lobe, wide)
    }
}
