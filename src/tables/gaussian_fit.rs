//! A sum of Gaussians for a diffusion profile, with what it leaves over.
//!
//! Gaussians are closed under convolution and separate into x and y, so texture-space diffusion blurs by a ladder of
//! them. The k variances are shared by the channels, as the ladder needs; the weights are each channel's own, not
//! negative, and sum to 1, so that the fit keeps the energy.
//!
//! What is minimised: the sum over channels of `int (p - q)^2 dr / int p^2 dr`, p = 2 pi r R and q the same of the fit. (The
//! published fit weighs by r instead of r^2, for which a profile that grows as 1/r has no finite error.) Variances
//! by Nelder and Mead in their logarithms, weights by non-negative least squares within.

use super::profile::{self, Profile, Rgb};
use super::role::Band;
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Setting, Source, Spec, TableInfo, TexelError,
};
use crate::cite;
use crate::grid::{Axis, Quantity, Texel};
use crate::integrate::{Estimate, MAX_CHANNELS, gauss, line};
use crate::math::{least_squares, simplex};
use crate::models::ParamError;
use std::sync::OnceLock;

/// Most Gaussians of a fit.
pub const MOST: usize = 16;

const fn channel(id: &'static str, meaning: &'static str, most: f64, role: Role) -> ChannelInfo {
    ChannelInfo { id, meaning, range: [0.0, most], role }
}

const VARIANCE: ChannelInfo = channel("gaussian.variance", "variance v, mm^2", 1e9, Role::Variance);
const RED: ChannelInfo = channel("weight.r", "weight of red", 1.0, Role::GaussianWeight(Band::Red));
const GREEN: ChannelInfo = channel("weight.g", "weight of green", 1.0, Role::GaussianWeight(Band::Green));
const BLUE: ChannelInfo = channel("weight.b", "weight of blue", 1.0, Role::GaussianWeight(Band::Blue));

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "gaussian-fit",
    title: "Sum of Gaussians fitted to a diffusion profile",
    formula: "R(r) ~ sum w_i exp(-r^2 / (2 v_i)) / (2 pi v_i), w_i >= 0, sum w_i = 1",
    sources: &SOURCES,
    coordinates: &["gaussian"],
    layouts: &[
        Layout {
            id: "weights",
            doc: "texel i holds Gaussian i, the narrowest first; not to be interpolated",
            channels: &[VARIANCE, RED, GREEN, BLUE],
        },
        Layout {
            id: "weights-residual",
            doc: "the same, and in every texel what the fit leaves over: the root of int (p - q)^2 / int p^2, p = 2 pi r R",
            channels: &[
                VARIANCE,
                RED,
                GREEN,
                BLUE,
                channel("residual.r", "relative residual of red", 1.0, Role::GaussianResidual(Band::Red)),
                channel("residual.g", "relative residual of green", 1.0, Role::GaussianResidual(Band::Green)),
                channel("residual.b", "relative residual of blue", 1.0, Role::GaussianResidual(Band::Blue)),
            ],
        },
    ],
    mix: Mix::Layouts,
    model: ModelUse::None,
    params: profile::PARAMS,
    laws: &["finite", "range", "total"],
    axes: default_axes,
    least_tolerance: |_| 0.0,
    blended: false,
    notes: "The length of the axis is the number of Gaussians, at most 16. The error of the texels is rounding; what the fit leaves over stands in \
        the rule of the file and in the layout weights-residual. Switch reconstruction off: nobody reads between Gaussians.",
    bind,
};

/// Own sources, and those of profiles.
static SOURCES: [Source; 3 + profile::SOURCES.len()] = profile::with_sources([
    Source::new(cite::DEON_LUEBKE_2007, "section 14.4.3, sum-of-Gaussians fit"),
    Source::new(cite::LAWSON_HANSON_1974, "chapter 23"),
    Source::new(cite::NELDER_MEAD_1965, "the method"),
]);

fn default_axes(_: &Setting<'_>) -> Vec<Axis> {
    let axis = |q| Axis::new(q, 6, Texel::Endpoint).over([0.0, 5.0]);
    Quantity::find("gaussian").map(axis).into_iter().collect()
}

/// A fit: variances, rising, with the weights of the channels, and the relative residual of each channel.
#[derive(Debug, Clone, PartialEq)]
pub struct GaussianFit {
    /// Variance in mm² and weights.
    pub lobes: Vec<(f64, Rgb)>,
    /// `sqrt(int (p - q)^2 dr / int p^2 dr)`.
    pub residual: Rgb,
    /// Estimated errors of the residuals.
    pub error: Rgb,
}

struct Table {
    axis: Axis,
    profile: Profile,
    /// Made when it is first asked for: a recipe that is only checked needs no fit.
    fit: OnceLock<GaussianFit>,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    let axis = spec.grid.axes()[spec.coordinate("gaussian")?].clone();
    if axis.len > MOST {
        let why = format!("a fit of {} Gaussians; at most {MOST} can be told apart", axis.len);
        return Err(ParamError::Together { model: spec.kind.id, why }.into());
    }
    Ok(Box::new(Table { axis, profile: Profile::new(spec)?, fit: OnceLock::new() }))
}

impl Table {
    fn fit(&self) -> &GaussianFit {
        self.fit.get_or_init(|| fit(&self.profile, self.axis.len))
    }
}

impl Baker for Table {
    fn texel(&self, at: &[f64], _tolerance: f64) -> Result<Estimate, TexelError> {
        let fit = self.fit();
        let apart = |i: usize| (self.axis.value(i, 0.0) - at[0]).abs();
        let nearest = (0..self.axis.len).min_by(|&i, &j| apart(i).total_cmp(&apart(j))).unwrap_or(0);
        let (variance, weights) = fit.lobes[nearest];
        let mut value = [0.0; MAX_CHANNELS];
        value[0] = variance;
        value[1..4].copy_from_slice(&weights);
        value[4..7].copy_from_slice(&fit.residual);
        let mut e = super::closed_form(value, 7)?;
        for (e, error) in e.error[4..7].iter_mut().zip(fit.error) {
            *e += error;
        }
        super::finite(e, 7)
    }

    fn is_whole(&self) -> bool {
        true
    }

    fn rule(&self) -> String {
        let [r, g, b] = self.fit().residual;
        format!(
            "least squares of 2 pi r R over r, weights not negative with sum 1, variances shared; \
             relative residual red {r:.2e}, green {g:.2e}, blue {b:.2e}"
        )
    }
}

/// Nodes of the integrals over r, and the profile there.
struct Problem {
    radii: Vec<f64>,
    weights: Vec<f64>,
    /// `2 pi r R` of each channel.
    ring: [Vec<f64>; 3],
    /// `int p^2 dr`.
    norm: Rgb,
}

/// Fits `count` Gaussians to a profile.
#[must_use]
pub fn fit(profile: &Profile, count: usize) -> GaussianFit {
    let problem = Problem::new(profile);
    let mut squares = |logs: &[f64]| problem.solve(logs).1.iter().map(|r| r * r).sum();
    // there are several minima: begin with narrow Gaussians, with narrower ones, and take the best
    let mut best: Option<(f64, Vec<f64>)> = None;
    for narrow in [0.05, 0.01, 0.002] {
        let ends = [narrow, 0.97].map(|part| radius(profile, part));
        let found = simplex::minimise(&start(ends, count), 0.3, 4, 250 * count, &mut squares);
        let value = squares(&found);
        if best.as_ref().is_none_or(|b| value < b.0) {
            best = Some((value, found));
        }
    }
    let mut logs = best.map_or_else(|| vec![0.0; count], |b| b.1);
    logs.sort_by(f64::total_cmp);
    let (weights, _) = problem.solve(&logs);
    let lobes: Vec<(f64, Rgb)> =
        logs.iter().enumerate().map(|(i, v)| (libm::exp(*v), [0, 1, 2].map(|c| weights[c][i]))).collect();
    let (residual, error) = residuals(profile, &lobes, problem.norm);
    GaussianFit { lobes, residual, error }
}

/// Panels between the first scale of a profile and the one that ends at 0, each a quarter of the next.
const TOWARDS_ZERO: i32 = 4;

/// Relative accuracy of the integrals in a residual.
const ACCURACY: f64 = 1e-11;

/// The relative residuals of lobes and their errors, by an adaptive rule: the nodes of the fit are too few for profiles of wide range.
fn residuals(profile: &Profile, lobes: &[(f64, Rgb)], norm: Rgb) -> (Rgb, Rgb) {
    let scales = profile.scales();
    // a Gaussian may reach further than the profile
    let mut breaks = vec![0.0];
    breaks.extend(scales);
    breaks.extend(lobes.iter().flat_map(|l| [0.3, 1.0, 3.0, 12.0].map(|k| k * l.0.sqrt())));
    breaks.sort_by(f64::total_cmp);
    // each over its norm, so that one tolerance serves all
    let e = line::integrate(&breaks, 6, ACCURACY, &mut |r, out| {
        let ring = profile.ring(r);
        for c in 0..3 {
            let sum: f64 = lobes.iter().map(|(v, w)| w[c] * r / v * libm::exp(-0.5 * r * r / v)).sum();
            let left = ring[c] - sum;
            (out[c], out[3 + c]) = (left * left / norm[c], ring[c] * ring[c] / norm[c]);
        }
    });
    let of = |c: usize| (e.value[c] / e.value[3 + c]).sqrt();
    let error = |c: usize| {
        let (left, all) = (e.value[c], e.value[3 + c]);
        ((left + e.error[c]) / (all - e.error[3 + c]).max(f64::MIN_POSITIVE)).sqrt() - of(c)
    };
    ([0, 1, 2].map(of), [0, 1, 2].map(error))
}

/// Logarithms of variances, evenly spread between those whose Gaussians are at their height at two radii.
fn start(ends: [f64; 2], count: usize) -> Vec<f64> {
    if count == 1 {
        return vec![libm::log(ends[0] * ends[1])];
    }
    let (first, step) = (2.0 * libm::log(ends[0]), 2.0 * libm::log(ends[1] / ends[0]) / (count - 1) as f64);
    (0..count).map(|i| first + i as f64 * step).collect()
}

/// Smallest or largest radius of the channels inside which a part of the light leaves, to a few percent.
fn radius(profile: &Profile, part: f64) -> f64 {
    let scales = profile.scales();
    let (mut lo, mut hi) = (1e-3 * scales[0], scales[scales.len() - 1]);
    for _ in 0..60 {
        let middle = (lo * hi).sqrt();
        let inside = profile.inside(middle);
        let enough =
            if part < 0.5 { inside.iter().any(|f| *f > part) } else { inside.iter().all(|f| *f > part) };
        if enough { hi = middle } else { lo = middle }
    }
    hi
}

impl Problem {
    fn new(profile: &Profile) -> Problem {
        let scales = profile.scales();
        // the narrowest Gaussian may be far inside the first scale, where some profiles are flat or infinite
        let mut ends = vec![0.0];
        ends.extend((1..=TOWARDS_ZERO).rev().map(|k| libm::ldexp(scales[0], -2 * k)));
        ends.extend(scales);
        let mut p = Problem {
            radii: Vec::new(),
            weights: Vec::new(),
            ring: [const { Vec::new() }; 3],
            norm: [0.0; 3],
        };
        let rule = gauss::rule(16);
        for pair in ends.windows(2) {
            for (x, w) in rule.nodes.iter().zip(&rule.weights) {
                let (r, w) = (pair[0] + (pair[1] - pair[0]) * x, (pair[1] - pair[0]) * w);
                p.radii.push(r);
                p.weights.push(w);
                for (c, v) in profile.ring(r).into_iter().enumerate() {
                    p.ring[c].push(v);
                    p.norm[c] += w * v * v;
                }
            }
        }
        p
    }

    /// Weights of each channel for variances given by their logarithms, and the relative residuals.
    fn solve(&self, logs: &[f64]) -> ([Vec<f64>; 3], Rgb) {
        /// Weight of the equation "the weights sum to 1", relative to the others.
        const STIFF: f64 = 1e4;
        let columns: Vec<Vec<f64>> = logs
            .iter()
            .map(|log| {
                let v = libm::exp(log.clamp(-60.0, 60.0));
                self.radii.iter().map(|r| r / v * libm::exp(-0.5 * r * r / v)).collect()
            })
            .collect();
        let dot = |a: &[f64], b: &[f64]| -> f64 {
            a.iter().zip(b).zip(&self.weights).map(|((a, b), w)| a * b * w).sum()
        };
        let gram: Vec<Vec<f64>> =
            columns.iter().map(|a| columns.iter().map(|b| dot(a, b)).collect()).collect();
        let mut residual = [0.0; 3];
        let weights = [0, 1, 2].map(|c| {
            let stiff = STIFF * self.norm[c];
            let b: Vec<f64> = columns.iter().map(|a| dot(a, &self.ring[c]) + stiff).collect();
            let g: Vec<Vec<f64>> = gram.iter().map(|row| row.iter().map(|x| x + stiff).collect()).collect();
            let mut w = least_squares::nonnegative(&g, &b);
            let sum: f64 = w.iter().sum();
            w.iter_mut().for_each(|w| *w /= sum);
            let left: Vec<f64> = (0..self.radii.len())
                .map(|i| self.ring[c][i] - columns.iter().zip(&w).map(|(a, w)| w * a[i]).sum::<f64>())
                .collect();
            residual[c] = (dot(&left, &left) / self.norm[c]).sqrt();
            w
        });
        (weights, residual)
    }
}
