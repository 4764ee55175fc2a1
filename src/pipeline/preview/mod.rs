//! Spheres, or a mesh, under a small sky and a panel of light: once integrated, once as a shader shades them with baked tables.
//!
//! Both are the same shading model, that of three.js: the metallic-roughness material of glTF with GGX, single scattering, plus the
//! light that scatters on between the facets (Fdez-Aguera 2019), whose share is `F_ms E_ms` of the mean irradiance. They differ in how
//! the integrals are done: by rules that converge, or by tables and a prefiltered environment. A third picture has the integrals of the
//! tables done and all else as in the shader: what it differs from the second by is the table alone.

mod environment;
mod mesh;
mod picture;
mod shader;
mod tables;
mod truth;

pub use environment::{Bands, Panel, Sky};
pub use mesh::Mesh;
pub use picture::{exr, png};
pub use shader::{Style, Tables};
pub use tables::{PreviewError, materials, mesh, tables_of};

use crate::cancel::{Cancel, Cancelled};
use crate::grid::axis::count;
use crate::models::ParamError;
use crate::picture::Space;
use glam::{DMat3, DVec3};
use rayon::prelude::*;
use serde::Serialize;
use truth::Truth;

/// Mean of the Schlick factor over the hemisphere, 1/21, as three.js has it.
const MEAN_SCHLICK: f64 = 0.047619;
/// Drawn directions of a preview at most, for the panel.
const DRAWS: usize = 1 << 25;

/// A material: a sphere, or parts of a mesh.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Surface {
    /// What it is called.
    pub name: String,
    /// Linear base colour.
    pub base: [f64; 3],
    /// From dielectric to metal.
    pub metallic: f64,
    /// Perceptual roughness.
    pub roughness: f64,
    /// Reflectance of the dielectric at normal incidence.
    pub f0: f64,
}

/// What is to be seen.
#[derive(Debug, Clone)]
pub struct Scene {
    /// Spheres, from the left; or the materials of the mesh.
    pub surfaces: Vec<Surface>,
    /// What is shaded in place of spheres.
    pub mesh: Option<Mesh>,
    /// The sky.
    pub sky: Sky,
    /// The panel, if there is one.
    pub panel: Option<Panel>,
    /// Diameter of a sphere in pixels; side of the picture of a mesh.
    pub size: usize,
}

/// What is seen at a pixel.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Hit {
    /// Number of the surface.
    surface: usize,
    /// Where, inside the unit sphere.
    at: DVec3,
    /// Its normal.
    normal: DVec3,
}

impl Scene {
    /// Pixels of a row.
    fn width(&self) -> usize {
        if self.mesh.is_some() { self.size } else { self.surfaces.len() * self.size }
    }

    /// What is seen at each pixel, rows from the top.
    fn hits(&self) -> Vec<Option<Hit>> {
        if let Some(mesh) = &self.mesh {
            return mesh.hits(self.size);
        }
        let (width, radius) = (self.width(), 0.5 * count(self.size));
        let sphere = |i: usize| {
            let surface = i % width / self.size;
            let [x, y] = [i % width % self.size, i / width].map(|v| (count(v) + 0.5) / radius - 1.0);
            let z2 = 1.0 - x * x - y * y;
            let normal = (z2 > 0.0).then(|| DVec3::new(x, -y, z2.sqrt()))?;
            Some(Hit { surface, at: normal, normal })
        };
        (0..width * self.size).map(sphere).collect()
    }
}

/// Rows of pixels from the top, the spheres beside each other; linear red, green, blue, NaN outside.
#[derive(Debug, Clone)]
pub struct Preview {
    /// Rows of the picture.
    pub size: usize,
    /// By integration.
    pub integrated: Vec<[f64; 3]>,
    /// By the tables.
    pub read: Vec<[f64; 3]>,
    /// Each sphere, or each material of the mesh, in numbers.
    pub spheres: Vec<Numbers>,
}

/// How far the two are apart.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Numbers {
    /// The sphere, or the material.
    #[serde(flatten)]
    pub surface: Surface,
    /// Pixels where it is seen.
    pub pixels: usize,
    /// Root of the mean square over pixels and colours, in codes of 8-bit sRGB (of 255).
    pub rmse_codes: f64,
    /// The largest, linear.
    pub largest: f64,
    /// The same that the table alone is at fault for.
    pub table_rmse_codes: f64,
    /// Largest that the table alone is at fault for, linear.
    pub table_largest: f64,
    /// What the integrated picture may be off by itself: moments of the sky, and the mean over the pixels for the panel; linear.
    pub own_error: f64,
}

/// A pixel: integrated, read, read with exact integrals in place of the table, and what the first may be off by.
type Pixel = ([f64; 3], [f64; 3], [f64; 3], f64);

/// Shades the spheres, or the mesh.
///
/// # Errors
/// [`ParamError`] for a roughness that the model refuses, [`Cancelled`].
pub fn render(
    scene: &Scene,
    tables: &Tables,
    style: &Style,
    cancel: &Cancel,
) -> Result<Preview, PreviewError> {
    let width = scene.width();
    let hits = scene.hits();
    let mut preview = Preview {
        size: scene.size,
        integrated: vec![[f64::NAN; 3]; hits.len()],
        read: vec![[f64::NAN; 3]; hits.len()],
        spheres: Vec::new(),
    };
    let draws = u32::try_from((DRAWS / hits.len().max(1)).next_power_of_two().clamp(64, 4096)).unwrap_or(64);
    let mut shaded = Vec::new();
    for surface in &scene.surfaces {
        cancel.check()?;
        shaded.push(Shaded::new(surface, style)?);
    }
    // a row after the other, so that the sums are the same on any number of threads
    let rows = hits.par_chunks(width.max(1)).zip(preview.integrated.par_chunks_mut(width.max(1)));
    let rows = rows.zip(preview.read.par_chunks_mut(width.max(1))).enumerate();
    let sums: Vec<Vec<Sums>> = rows
        .map(|(y, ((hits, integrated), read))| {
            cancel.check()?;
            let mut sums = vec![Sums::default(); shaded.len()];
            for (x, hit) in hits.iter().enumerate() {
                let Some(hit) = hit else { continue };
                let column = if scene.mesh.is_some() { x } else { x % scene.size };
                let (of, sums) = (&shaded[hit.surface], &mut sums[hit.surface]);
                let (a, b, exact, error) = of.pixel(scene, tables, style, hit, draws, seed([column, y]));
                (integrated[x], read[x]) = (a, b);
                sums.add(&a, &b, &exact, error);
            }
            Ok(sums)
        })
        .collect::<Result<_, Cancelled>>()?;
    for (s, (surface, shaded)) in scene.surfaces.iter().zip(&shaded).enumerate() {
        let mut all = Sums::default();
        sums.iter().for_each(|row| all.join(&row[s]));
        preview.spheres.push(all.numbers(surface, shaded.truth.error));
    }
    Ok(preview)
}

/// Which directions are drawn for the panel at a pixel.
fn seed([x, y]: [usize; 2]) -> u32 {
    u32::try_from(x * 65_536 + y).unwrap_or(0)
}

#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    pixels: f64,
    squares: [f64; 2],
    largest: [f64; 2],
    error: f64,
}

impl Sums {
    fn add(&mut self, integrated: &[f64; 3], read: &[f64; 3], exact: &[f64; 3], error: f64) {
        self.pixels += 1.0;
        self.error += error;
        for (i, other) in [integrated, exact].into_iter().enumerate() {
            for (a, b) in read.iter().zip(other) {
                let codes = f64::from(Space::Srgb.byte(*a)) - f64::from(Space::Srgb.byte(*b));
                self.squares[i] += codes * codes;
                self.largest[i] = self.largest[i].max((a - b).abs());
            }
        }
    }

    fn join(&mut self, other: &Sums) {
        self.pixels += other.pixels;
        self.error += other.error;
        for i in 0..2 {
            self.squares[i] += other.squares[i];
            self.largest[i] = self.largest[i].max(other.largest[i]);
        }
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a number of pixels")]
    fn numbers(&self, surface: &Surface, moments: f64) -> Numbers {
        let rmse = |i: usize| (self.squares[i] / (3.0 * self.pixels).max(1.0)).sqrt();
        Numbers {
            surface: surface.clone(),
            pixels: self.pixels as usize,
            rmse_codes: rmse(0),
            largest: self.largest[0],
            table_rmse_codes: rmse(1),
            table_largest: self.largest[1],
            own_error: moments + self.error / self.pixels.max(1.0),
        }
    }
}

/// A surface with its lobe.
struct Shaded<'a> {
    surface: &'a Surface,
    roughness: f64,
    bands: Bands,
    truth: Truth,
}

/// The light of a lobe and of a diffuse surface at a pixel.
struct Light {
    /// Radiance that the lobe reflects where F0 is 1 and where it is 0, of the sky.
    sky: [[f64; 3]; 2],
    /// The same of the panel of radiance 1.
    panel: [f64; 2],
    /// Irradiance over pi of the sky; of the panel of radiance 1.
    diffuse: ([f64; 3], f64),
}

impl<'a> Shaded<'a> {
    fn new(surface: &'a Surface, style: &Style) -> Result<Shaded<'a>, ParamError> {
        let roughness = surface.roughness.clamp(style.least_roughness.max(0.02), 1.0);
        Ok(Shaded { surface, roughness, bands: style.bands(roughness), truth: Truth::new(roughness)? })
    }

    fn pixel(
        &self,
        scene: &Scene,
        tables: &Tables,
        style: &Style,
        &Hit { at, normal, .. }: &Hit,
        draws: u32,
        seed: u32,
    ) -> Pixel {
        let (view, mu) = (DVec3::Z, normal.z);
        let tangent = (view - normal * mu).try_normalize().unwrap_or(DVec3::X);
        let frame = DMat3::from_cols(tangent, normal.cross(tangent), normal);
        let place = (at, &frame);
        let panel = scene.panel.as_ref();
        let lookup = tables.look(style, panel, place, mu, self.roughness);
        let moments = self.truth.moments(mu);
        let exact = moments.map(|m| m[0]);
        let irradiance = scene.sky.about(normal, Bands::COSINE);
        let radiance = scene.sky.about(style.direction(view, normal, self.roughness), self.bands);
        let read = |split: [f64; 2], lobe: [f64; 2]| {
            let sky = split.map(|s| radiance.map(|r| r * s));
            let form = panel.map_or(0.0, |p| shader::diffuse(style, p, place));
            self.shade(split, &Light { sky, panel: lobe, diffuse: (irradiance, form) }, scene)
        };
        let (lobe, error) = panel.map_or(([0.0; 2], 0.0), |p| self.truth.panel(p, place, mu, draws, seed));
        let form = panel.map_or(0.0, |p| shader::diffuse(&Style { three: false, ..*style }, p, place));
        let light = Light {
            sky: self.truth.sky(&scene.sky, &frame, &moments),
            panel: lobe,
            diffuse: (irradiance, form),
        };
        let integrated = self.shade(exact, &light, scene);
        let brightest = panel.map_or(0.0, |p| p.radiance.iter().copied().fold(0.0, f64::max));
        (integrated, read(lookup.split, lookup.panel), read(exact, lookup.panel), error * brightest)
    }

    /// The shading model, from the integrals of the lobe and the light.
    fn shade(&self, [scale, bias]: [f64; 2], light: &Light, scene: &Scene) -> [f64; 3] {
        let s = self.surface;
        let missing = 1.0 - (scale + bias);
        // albedo of single scattering, and of what scatters on
        let scatter = |f0: f64| {
            let single = f0 * scale + bias;
            let average = f0 + (1.0 - f0) * MEAN_SCHLICK;
            [single, single * average / (1.0 - missing * average) * missing]
        };
        let dielectric = scatter(s.f0);
        let mixed = |a: f64, b: f64| a + s.metallic * (b - a);
        [0, 1, 2].map(|c| {
            let metal = scatter(s.base[c]);
            let f0 = mixed(s.f0, s.base[c]);
            let (irradiance, form) = (light.diffuse.0[c], light.diffuse.1);
            let body = s.base[c] * (1.0 - s.metallic);
            let sky = f0 * light.sky[0][c]
                + light.sky[1][c]
                + mixed(dielectric[1], metal[1]) * irradiance
                + body * (1.0 - dielectric[0] - dielectric[1]) * irradiance;
            let shining = scene.panel.map_or(0.0, |p| p.radiance[c]);
            sky + shining * (f0 * light.panel[0] + light.panel[1] + body * form)
        })
    }
}
