//! All levels of a pair of maps: every texel's footprint to its lobe, row by row on all threads.
//!
//! A footprint is gathered from the texels themselves up to level [`KEPT`]; there it is merged to at most
//! [`MOST_FACETS`] facets, a quarter of what it had, which the next levels are gathered from. So the work of a level is
//! proportional to its texels, and that of all of them to the texels of the first. A texel depends on nothing but its
//! footprint: the same bytes on any number of threads.

use super::fit::{Centre, Effort, Fitter, Shape};
use super::footprint::{Footprint, MOST_FACETS};
use super::lobe::{Facet, Lobe};
use super::reflected;
use super::rules::{Method, Rule};
use super::surface::Surface;
use super::two::Wide;
use crate::cancel::{Cancel, Cancelled};
use crate::picture::{Coverage, halved};
use glam::DVec3;
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The level whose footprints are merged and kept.
pub const KEPT: usize = 4;

/// Rows that are worked on at once: what is found of them is put together before the next ones.
const BAND: usize = 64;

/// What is asked for.
#[derive(Debug, Clone, Copy)]
pub struct Settings {
    /// The rule.
    pub rule: &'static Rule,
    /// Where the normal comes from.
    pub centre: Centre,
    /// How many widths.
    pub shape: Shape,
    /// How much work.
    pub effort: Effort,
    /// What is made small by the fit.
    pub objective: Objective,
}

/// What the fit makes small.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Objective {
    /// D of the distributions of normals.
    Normals,
    /// The error of the reflected light in four views: see [`super::reflected`].
    Reflected,
}

/// One level of lobes.
#[derive(Debug, Clone, PartialEq)]
pub struct Level<'a> {
    /// Width and height in texels.
    pub size: [usize; 2],
    texels: Texels<'a>,
}

/// Texels, rows from the top.
#[derive(Debug, Clone, PartialEq)]
enum Texels<'a> {
    /// The maps as they are.
    Given(&'a Surface),
    Found(Vec<Texel>),
}

impl<'a> Level<'a> {
    /// The first level: the maps as they are.
    #[must_use]
    pub fn first(surface: &'a Surface) -> Level<'a> {
        Level { size: surface.size, texels: Texels::Given(surface) }
    }

    /// A level of these texels, rows from the top.
    #[must_use]
    pub fn of(size: [usize; 2], texels: Vec<Texel>) -> Level<'a> {
        Level { size, texels: Texels::Found(texels) }
    }

    /// How many texels it has.
    #[must_use]
    #[allow(clippy::len_without_is_empty, reason = "no level is empty")]
    pub fn len(&self) -> usize {
        self.size[0] * self.size[1]
    }

    /// A texel by its number.
    #[must_use]
    pub fn at(&self, i: usize) -> Texel {
        match &self.texels {
            Texels::Given(surface) => given(surface, i),
            Texels::Found(texels) => texels[i],
        }
    }

    /// All texels, rows from the top.
    pub fn iter(&self) -> impl Iterator<Item = Texel> + '_ {
        (0..self.len()).map(|i| self.at(i))
    }
}

fn given(surface: &Surface, i: usize) -> Texel {
    let (normal, roughness) = (surface.normals.at(i), surface.roughness.at(i));
    let [roughness_max, angle] = surface.stretch.as_ref().map_or([roughness, 0.0], |s| s[i]);
    Texel {
        normal,
        roughness,
        roughness_max,
        angle,
        wide: [roughness, 0.0],
        distance: surface.residual.at(i),
        doubt: 0.0,
        at_limit: false,
    }
}

/// What is written of a texel, and what is known of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Texel {
    /// Unit normal.
    pub normal: [f32; 3],
    /// √ of the smaller width.
    pub roughness: f32,
    /// √ of the larger width.
    pub roughness_max: f32,
    /// Direction of the larger width, rad from the tangent.
    pub angle: f32,
    /// Of two lobes: √ of the width of the wide one, and its share.
    pub wide: [f32; 2],
    /// D to the footprint.
    pub distance: f32,
    /// How far D may be wrong.
    pub doubt: f32,
    /// A lobe wider than α = 1 would be nearer.
    pub at_limit: bool,
}

impl Texel {
    /// The wide lobe that is written beside it, where two are.
    #[must_use]
    pub fn second(&self) -> Wide {
        let [r, share] = self.wide.map(f64::from);
        Wide { alpha: r * r, share }
    }

    /// The lobe that is written.
    #[must_use]
    pub fn lobe(&self) -> Lobe {
        let [x, y, z] = self.normal.map(f64::from);
        let square = |r: f32| f64::from(r) * f64::from(r);
        Lobe {
            normal: DVec3::new(x, y, z).normalize(),
            alpha_max: square(self.roughness_max),
            alpha_min: square(self.roughness),
            angle: f64::from(self.angle),
        }
    }
}

/// Why there are no levels.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FilterError {
    /// Stopped from outside.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The normals of a footprint cancel.
    #[error(
        "level {level}, texel ({x}, {y}): the normals of the footprint cancel, there is no lobe about their mean"
    )]
    NoMean {
        /// Level.
        level: usize,
        /// Column.
        x: usize,
        /// Row.
        y: usize,
    },
}

/// A facet between levels.
#[derive(Debug, Clone, Copy)]
struct Kept {
    normal: [f32; 3],
    roughness: f32,
    weight: f32,
    /// √ of the larger width, and its direction.
    stretch: [f32; 2],
}

/// The merged footprints of a level: facets of all texels, one after the other, and where those of a texel begin.
#[derive(Debug, Default)]
struct Store {
    facets: Vec<Kept>,
    starts: Vec<usize>,
    errors: Vec<f32>,
    /// Smallest α of the texels themselves.
    least: Vec<f64>,
    width: usize,
}

/// Where footprints are gathered from.
#[derive(Clone, Copy)]
enum Source<'a> {
    Surface(&'a Surface),
    Store(&'a Store),
}

impl Source<'_> {
    /// Facets, what merging them has cost before, and the smallest α of the texels themselves.
    fn gather(&self, across: &[(usize, f64)], down: &[(usize, f64)]) -> (Vec<Facet>, f64, f64) {
        let mut facets = Vec::with_capacity(across.len() * down.len());
        let (mut error, mut least) = (0.0, f64::INFINITY);
        for (y, wy) in down {
            for (x, wx) in across {
                let weight = wx * wy;
                match self {
                    Source::Surface(s) => {
                        let facet = s.facet(y * s.size[0] + x, weight);
                        least = least.min(facet.alpha);
                        facets.push(facet);
                    }
                    Source::Store(s) => {
                        let texel = y * s.width + x;
                        error += weight * f64::from(s.errors[texel]);
                        least = least.min(s.least[texel]);
                        let own = &s.facets[s.starts[texel]..s.starts[texel + 1]];
                        facets.extend(own.iter().map(|k| k.facet(weight)));
                    }
                }
            }
        }
        (facets, error, least)
    }
}

impl Kept {
    fn facet(&self, weight: f64) -> Facet {
        let [x, y, z] = self.normal.map(f64::from);
        let r = f64::from(self.roughness);
        let normal = DVec3::new(x, y, z).normalize();
        let [wide, angle] = self.stretch.map(f64::from);
        let weight = weight * f64::from(self.weight);
        Facet { normal, alpha: r * r, weight, alpha_max: wide * wide, angle }
    }

    #[allow(clippy::cast_possible_truncation, reason = "rounded to f32 on purpose")]
    fn of(f: &Facet) -> Kept {
        let n = f.normal;
        let (roughness, weight) = (f.alpha.sqrt() as f32, f.weight as f32);
        let stretch = [f.alpha_max.sqrt() as f32, f.angle as f32];
        Kept { normal: [n.x as f32, n.y as f32, n.z as f32], roughness, weight, stretch }
    }
}

/// All levels, the first as it is. `progress` is told of texels that are done and of their number.
///
/// # Errors
/// [`FilterError`].
pub fn filter<'a>(
    surface: &'a Surface,
    settings: &Settings,
    cancel: &Cancel,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<Vec<Level<'a>>, FilterError> {
    let sizes = halved(surface.size[0], surface.size[1]);
    let total: usize = sizes.iter().skip(1).map(|s| s[0] * s[1]).sum();
    let done = AtomicUsize::new(0);
    let mut levels = vec![Level::first(surface)];
    let mut store: Option<Store> = None;
    let mut from = 0;
    for level in 1..sizes.len() {
        let source = store.as_ref().map_or(Source::Surface(surface), Source::Store);
        let keep = level >= KEPT;
        let cover = [0, 1].map(|axis| {
            let step = |k: usize| Coverage::new(sizes[k][axis], sizes[k + 1][axis]);
            (from + 1..level).fold(step(from), |c, k| c.then(&step(k)))
        });
        let job = Job { settings, source, cover: &cover, level, size: sizes[level], keep };
        let tell = |n: usize| progress(done.fetch_add(n, Ordering::Relaxed) + n, total);
        let (found, kept) = job.run(cancel, &tell)?;
        levels.push(found);
        if keep {
            (store, from) = (Some(kept), level);
        }
    }
    Ok(levels)
}

/// The work of a level.
struct Job<'a> {
    settings: &'a Settings,
    source: Source<'a>,
    cover: &'a [Coverage; 2],
    level: usize,
    size: [usize; 2],
    keep: bool,
}

/// A row of texels, with the footprints that are kept of them.
type Row = Vec<(Texel, Vec<Kept>, f32, f64)>;

impl Job<'_> {
    fn run(
        &self,
        cancel: &Cancel,
        tell: &(dyn Fn(usize) + Sync),
    ) -> Result<(Level<'static>, Store), FilterError> {
        let [width, height] = self.size;
        let one = |fitter: &mut Fitter, y: usize| -> Result<Row, FilterError> {
            cancel.check()?;
            let row: Result<Row, FilterError> = (0..width).map(|x| self.texel(fitter, x, y)).collect();
            tell(width);
            row
        };
        let new = || Fitter::new(self.settings.effort);
        let mut texels = Vec::with_capacity(width * height);
        let mut store = Store { width, starts: vec![0], ..Store::default() };
        for first in (0..height).step_by(BAND) {
            let band = first..height.min(first + BAND);
            let rows: Result<Vec<Row>, FilterError> = band.into_par_iter().map_init(new, one).collect();
            for (texel, kept, error, least) in rows?.into_iter().flatten() {
                texels.push(texel);
                if self.keep {
                    store.facets.extend(kept);
                    store.starts.push(store.facets.len());
                    store.errors.push(error);
                    store.least.push(least);
                }
            }
        }
        Ok((Level::of(self.size, texels), store))
    }

    #[allow(clippy::cast_possible_truncation, reason = "rounded to f32 on purpose")]
    fn texel(
        &self,
        fitter: &mut Fitter,
        x: usize,
        y: usize,
    ) -> Result<(Texel, Vec<Kept>, f32, f64), FilterError> {
        let (facets, error, least) = self.source.gather(self.cover[0].of(x), self.cover[1].of(y));
        let none = FilterError::NoMean { level: self.level, x, y };
        let mut footprint = Footprint::new(facets).ok_or(none)?;
        (footprint.merge_error, footprint.least) = (error, least);
        if self.settings.effort == Effort::Fast || self.keep {
            let most = if self.settings.effort == Effort::Exact { 64 * MOST_FACETS } else { MOST_FACETS };
            footprint = footprint.merged(most);
        }
        let Settings { rule, centre, shape, .. } = *self.settings;
        let mut fitted = rule.apply(fitter, &footprint, centre, shape);
        if self.settings.objective == Objective::Reflected && matches!(rule.method, Method::Fit) {
            fitted = reflected::fit(&footprint, &fitted.lobe, centre, shape);
        }
        let lobe = fitted.lobe;
        let n = lobe.normal;
        let texel = Texel {
            normal: [n.x as f32, n.y as f32, n.z as f32],
            roughness: lobe.alpha_min.sqrt() as f32,
            roughness_max: lobe.alpha_max.sqrt() as f32,
            angle: lobe.angle as f32,
            wide: fitted.wide.map_or([0.0; 2], |w| [w.alpha.sqrt() as f32, w.share as f32]),
            distance: fitted.distance as f32,
            doubt: fitted.doubt as f32,
            at_limit: fitted.at_limit,
        };
        let kept = if self.keep { footprint.facets.iter().map(Kept::of).collect() } else { Vec::new() };
        Ok((texel, kept, footprint.merge_error as f32, least))
    }
}
