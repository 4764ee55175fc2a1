//! What a shader makes of baked tables, as an engine writes it.

use super::environment::{Bands, Panel};
use crate::grid::{Grid, Table};
use crate::integrate::gauss;
use crate::report::split::Split;
use glam::{DMat3, DVec3};

/// The tables that shade, as the engine reads them: bilinear, with its storage, its texels, and without knowing of offsets.
#[derive(Debug)]
pub struct Tables {
    /// Split sum.
    pub split: Table,
    /// Which of its channels are what.
    pub reading: Split,
    /// Transformed cosines: matrix, and magnitude with Fresnel.
    pub cosines: Option<[Table; 2]>,
}

/// What an engine does beside its tables.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Style {
    /// The least roughness that it shades.
    pub least_roughness: f64,
    /// three.js: the reflected direction is bent to the normal by `roughness^4`, the environment has six levels, and the form factor
    /// of what the horizon cuts is that of a sphere. Without: the reflected direction, a level for every roughness, an exact clip.
    pub three: bool,
}

/// Radiance of the lobes of a pixel before colours: what F0 scales, and what it does not.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lookup {
    /// Scale and bias.
    pub(super) split: [f64; 2],
    /// Radiance of the panel in the lobe, times magnitude - fresnel and fresnel.
    pub(super) panel: [f64; 2],
}

/// Levels of the environment in three.js: 256 to 8 texels a side.
const LEVELS: f64 = 5.0;

impl Style {
    /// What is left of the bands of the sky in the prefiltered environment: view, normal and reflection are one direction (Karis).
    #[must_use]
    pub fn bands(&self, roughness: f64) -> Bands {
        if !self.three {
            return prefiltered(roughness);
        }
        // as PMREMGenerator spaces its levels, and the sampler blends them
        let lod = LEVELS * roughness * (2.0 - roughness);
        let of = |level: f64| prefiltered(1.0 - (1.0 - level / LEVELS).max(0.0).sqrt());
        let below = lod.floor().min(LEVELS - 1.0);
        of(below).mix(of(below + 1.0), lod - below)
    }

    /// Where the environment is read.
    #[must_use]
    pub fn direction(&self, view: DVec3, normal: DVec3, roughness: f64) -> DVec3 {
        let mirrored = normal * (2.0 * normal.dot(view)) - view;
        if !self.three {
            return mirrored;
        }
        let bend = roughness * roughness * roughness * roughness;
        (mirrored + (normal - mirrored) * bend).normalize()
    }

    fn clipped(&self, matrix: &DMat3, polygon: &[DVec3; 4]) -> f64 {
        let bent: Vec<DVec3> = polygon.iter().map(|p| *matrix * *p).collect();
        if !self.three {
            return crate::terms::ltc::Ltc::COSINE.form_factor(&bent).max(0.0);
        }
        let vector = (0..4).map(|i| edge(bent[i].normalize(), bent[(i + 1) % 4].normalize())).sum::<DVec3>();
        let length = vector.length();
        ((length * length + vector.z) / (length + 1.0)).max(0.0)
    }
}

/// A side of a polygon: the angle that it spans times the normal of its plane, over a turn.
fn edge(a: DVec3, b: DVec3) -> DVec3 {
    let normal = a.cross(b);
    let length = normal.length();
    let angle = libm::atan2(length, a.dot(b));
    if length > 0.0 { normal * (angle / length / std::f64::consts::TAU) } else { DVec3::ZERO }
}

/// A GGX lobe seen along its normal, weighted by the cosine: `w(c) = c / (1 + a^2 + (a^2 - 1) c)^2`, a the width, c the cosine.
fn prefiltered(roughness: f64) -> Bands {
    let a2 = roughness * roughness * roughness * roughness;
    if a2 < 1e-12 {
        return Bands::MIRROR;
    }
    // c = 1 - a2 t: the lobe has the width a2; t from 0 to 1/a2 in logarithmic steps
    let rule = gauss::rule(64);
    let end = libm::log1p(1.0 / a2);
    let (mut sum, mut bands) = (0.0, [0.0; 2]);
    for (x, w) in rule.nodes.iter().zip(&rule.weights) {
        let t = libm::expm1(end * x);
        let c = 1.0 - a2 * t;
        let d = 1.0 + a2 + (a2 - 1.0) * c;
        let weight = w * (t + 1.0) * c / (d * d);
        sum += weight;
        bands[0] += weight * c;
        bands[1] += weight * (1.5 * c * c - 0.5);
    }
    Bands(bands.map(|b| b / sum))
}

impl Tables {
    /// Reads the tables at a place with a frame: that of its normal, the tangent towards the view.
    pub(super) fn look(
        &self,
        style: &Style,
        panel: Option<&Panel>,
        (at, frame): (DVec3, &DMat3),
        mu: f64,
        roughness: f64,
    ) -> Lookup {
        let mut values = vec![0.0; self.split.channels.len()];
        read(&self.split, mu, roughness, &mut values);
        let split = self.reading.scale_bias(&values);
        let Some((panel, [matrix, magnitude])) = panel.zip(self.cosines.as_ref()) else {
            return Lookup { split, panel: [0.0; 2] };
        };
        let (mut m, mut scale) = ([0.0; 4], vec![0.0; magnitude.channels.len()]);
        read(matrix, mu, roughness, &mut m);
        read(magnitude, mu, roughness, &mut scale);
        let [m11, m31, m13, m33] = m;
        let inverse = DMat3::from_cols(DVec3::new(m11, 0.0, m31), DVec3::Y, DVec3::new(m13, 0.0, m33));
        let local = seen(panel, at, frame);
        let factor = style.clipped(&inverse, &local);
        Lookup { split, panel: [factor * (scale[0] - scale[1]), factor * scale[1]] }
    }
}

/// The corners of the panel from a point of the surface, counter-clockwise about the normal.
fn seen(panel: &Panel, at: DVec3, frame: &DMat3) -> [DVec3; 4] {
    let [a, b, c, d] = panel.corners().map(|c| frame.transpose() * (c - at));
    [d, c, b, a]
}

/// The form factor of the panel for a diffuse surface.
pub(super) fn diffuse(style: &Style, panel: &Panel, (at, frame): (DVec3, &DMat3)) -> f64 {
    let local = seen(panel, at, frame);
    style.clipped(&DMat3::IDENTITY, &local)
}

fn read(table: &Table, mu: f64, roughness: f64, out: &mut [f64]) {
    let grid: &Grid = &table.grid;
    let value = |base: &str| match base {
        "mu" => Some(mu),
        "alpha" => Some(roughness * roughness),
        _ => None,
    };
    let base: Vec<f64> = grid
        .axes()
        .iter()
        .map(|a| value(a.quantity.base_id()).unwrap_or_else(|| a.quantity.to_base(a.value_at(0.5, 0.0))))
        .collect();
    if let Some(point) = grid.point(&base) {
        table.read(&point, out);
    }
}
