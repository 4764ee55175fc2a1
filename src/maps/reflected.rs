//! The other objective: the lobe whose reflected light is nearest to the footprint's, masking included, in four views.
//!
//! Error of a view: ½ ∫ |f(l, v) (n·l) − mean of the facets' f(l, v; nᵢ) (nᵢ·l)| dl over the mesh's hemisphere, by the integral of the mean.
//! f is GGX with height-correlated masking and a Fresnel factor of 1. The views stand at 0°, and at 45° to the mesh's normal with the
//! azimuths 0°, 45°, 90°; their mean is made small. This is a reference: it takes tenths of a second a texel.

use super::fit::{Centre, Fitted, Shape};
use super::footprint::Footprint;
use super::lobe::{self, LEAST_ALPHA, Lobe};
use crate::math::simplex;
use glam::{DMat2, DVec2, DVec3};
use std::f64::consts::{FRAC_PI_4, PI, TAU};

/// Rings and sectors of nodes round the mirror direction of a view.
const NODES: [usize; 2] = [192, 128];

/// What light of direction l meets: f(l, v) (n·l) of a lobe, unit sr⁻¹.
pub(super) fn reflected(lobe: &Prepared, v: DVec3, l: DVec3) -> f64 {
    let [t, b, n] = lobe.axes;
    let local = |w: DVec3| DVec3::new(t.dot(w), b.dot(w), n.dot(w));
    let (lv, ll) = (local(v), local(l));
    if lv.z <= 0.0 || ll.z <= 0.0 {
        return 0.0;
    }
    let h = (lv + ll).normalize();
    let [a, c] = lobe.alphas;
    let (x, y) = (h.x / a, h.y / c);
    let q = x * x + y * y + h.z * h.z;
    let d = 1.0 / (PI * a * c * q * q);
    let lambda = |w: DVec3| {
        let square = (a * a * w.x * w.x + c * c * w.y * w.y) / (w.z * w.z);
        0.5 * ((1.0 + square).sqrt() - 1.0)
    };
    d / (4.0 * lv.z * (1.0 + lambda(lv) + lambda(ll)))
}

/// What a lobe sends to `v` of light from `l`, times the cosine n·l of its own normal: f (n·l), unit sr⁻¹; the Fresnel factor is 1.
#[must_use]
pub fn light(lobe: &Lobe, v: DVec3, l: DVec3) -> f64 {
    reflected(&Prepared::new(lobe), v, l)
}

/// A lobe with its axes.
pub(super) struct Prepared {
    axes: [DVec3; 3],
    alphas: [f64; 2],
}

impl Prepared {
    pub(super) fn new(lobe: &Lobe) -> Prepared {
        let alphas = [lobe.alpha_max.max(LEAST_ALPHA), lobe.alpha_min.max(LEAST_ALPHA)];
        Prepared { axes: lobe.axes(), alphas }
    }

    /// The same lobe seen from the frame of these axes.
    pub(super) fn within(&self, base: &[DVec3; 3]) -> Prepared {
        let seen = |w: DVec3| DVec3::new(base[0].dot(w), base[1].dot(w), base[2].dot(w));
        Prepared { axes: self.axes.map(seen), ..*self }
    }
}

/// A view: its nodes, with solid angle and the footprint's reflected light.
struct View {
    v: DVec3,
    nodes: Vec<(DVec3, f64, f64)>,
    /// ∫ of the footprint's.
    total: f64,
}

impl View {
    /// Rings round the mirror direction, as wide as a lobe of width `alpha` reflects.
    fn new(v: DVec3, alpha: f64, footprint: &Footprint) -> View {
        let facets: Vec<(Prepared, f64)> =
            footprint.facets.iter().map(|f| (Prepared::new(&f.lobe()), f.weight)).collect();
        let mirror = DVec3::new(-v.x, -v.y, v.z);
        let [t, b, n] = lobe::frame(mirror);
        let mut nodes = Vec::with_capacity(NODES[0] * NODES[1]);
        for i in 0..NODES[0] {
            let u = (i as f64 + 0.5) / NODES[0] as f64;
            // theta = 2 atan(alpha sqrt(u/(1 - u))): the half vectors lie as GGX has them
            let tangent = alpha * (u / (1.0 - u)).sqrt();
            let theta = 2.0 * libm::atan(tangent);
            let slope = alpha / ((u * (1.0 - u)).sqrt() * (1.0 - u)) / (1.0 + tangent * tangent);
            let (sin, cos) = libm::sincos(theta);
            let area = slope / NODES[0] as f64 * sin * TAU / NODES[1] as f64;
            for j in 0..NODES[1] {
                let (s, c) = libm::sincos(TAU * (j as f64 + 0.5) / NODES[1] as f64);
                let l = (t * c + b * s) * sin + n * cos;
                if l.z > 0.0 {
                    let truth = facets.iter().map(|(f, w)| w * reflected(f, v, l)).sum();
                    nodes.push((l, area, truth));
                }
            }
        }
        let total = nodes.iter().map(|(_, area, truth)| area * truth).sum();
        View { v, nodes, total }
    }

    fn error(&self, lobe: &Prepared) -> f64 {
        let part = |(l, area, truth): &(DVec3, f64, f64)| area * (reflected(lobe, self.v, *l) - truth).abs();
        0.5 * self.nodes.iter().map(part).sum::<f64>() / self.total
    }
}

/// The views, for lobes of about this width.
fn views(footprint: &Footprint, alpha: f64) -> Vec<View> {
    let view = |theta: f64, phi: f64| crate::math::frame::spherical(theta, phi);
    [(0.0, 0.0), (FRAC_PI_4, 0.0), (FRAC_PI_4, FRAC_PI_4), (FRAC_PI_4, 2.0 * FRAC_PI_4)]
        .into_iter()
        .map(|(theta, phi)| View::new(view(theta, phi), alpha, footprint))
        .collect()
}

/// The mean error of a lobe in the four views.
#[must_use]
pub fn distance(lobe: &Lobe, footprint: &Footprint) -> f64 {
    let views = views(footprint, lobe.alpha_max.max(2.0 * LEAST_ALPHA));
    mean(&views, lobe)
}

fn mean(views: &[View], lobe: &Lobe) -> f64 {
    let prepared = Prepared::new(lobe);
    views.iter().map(|v| v.error(&prepared)).sum::<f64>() / views.len() as f64
}

/// The lobe of least error, searched from `start`.
///
/// Variables are the logarithm of the widths' matrix and the slopes of the normal, each in widths of the start.
#[must_use]
pub fn fit(footprint: &Footprint, start: &Lobe, centre: Centre, shape: Shape) -> Fitted {
    if footprint.is_constant() {
        return Fitted { lobe: *start, wide: None, distance: 0.0, doubt: 0.0, at_limit: false };
    }
    let least = footprint.least.max(LEAST_ALPHA);
    let start = start.within(least, 1.0);
    let views = views(footprint, start.alpha_max);
    let frame = lobe::frame(start.normal);
    let widths = if shape == Shape::Anisotropic { 3 } else { 1 };
    let make = |p: &[f64]| {
        let normal = if centre == Centre::Free {
            let (x, y) = (p[widths] * start.alpha_min, p[widths + 1] * start.alpha_min);
            (frame[0] * x + frame[1] * y + frame[2]).normalize()
        } else {
            start.normal
        };
        if shape != Shape::Anisotropic {
            return Lobe::isotropic(normal, libm::exp(p[0]));
        }
        let half = (p[1] * p[1] + p[2] * p[2]).sqrt();
        let (large, small) = (libm::exp(2.0 * (p[0] + half)), libm::exp(2.0 * (p[0] - half)));
        let (sin, cos) = libm::sincos(0.5 * libm::atan2(p[2], p[1]));
        let along = DVec2::new(cos, sin);
        let outer = DMat2::from_cols(along * along.x, along * along.y);
        Lobe::from_square(normal, outer * (large - small) + DMat2::IDENTITY * small)
    };
    let (large, small) = (libm::log(start.alpha_max), libm::log(start.alpha_min));
    let mut first = vec![0.5 * (large + small)];
    if shape == Shape::Anisotropic {
        let (sin, cos) = libm::sincos(2.0 * start.angle);
        first.extend([0.5 * (large - small) * cos, 0.5 * (large - small) * sin]);
    }
    if centre == Centre::Free {
        first.extend([0.0, 0.0]);
    }
    let found = simplex::minimise(&first, 0.2, 2, 60 * first.len(), &mut |p| {
        mean(&views, &make(p).within(least, 1.0)) + 0.1 * (make(p).alpha_max - 1.0).max(0.0)
    });
    let free = make(&found);
    let lobe = free.within(least, 1.0);
    let (distance, at_limit) = (mean(&views, &lobe), free.alpha_max >= 1.0 - 1e-4);
    Fitted { lobe, wide: None, distance, doubt: 0.0, at_limit }
}
