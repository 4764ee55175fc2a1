//! Polar plots of a lobe in the plane of incidence: one curve for each angle of incidence, light from the left, the
//! reflected lobe to the right. One list of strokes, drawn as SVG text or as pixels.

use crate::math::frame;
use crate::models::Brdf;
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI};

/// How a value becomes a radius; the largest value of all curves reaches the rim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum Scale {
    /// Radius proportional to f.
    Linear,
    /// Radius proportional to the square root of f.
    Sqrt,
    /// Four decades below the largest value, then nothing.
    Log,
}

/// Decades that the logarithmic scale shows.
const DECADES: f64 = 4.0;

/// Radius of the rim and margins, in pixels.
const RADIUS: f64 = 300.0;
const MARGIN: f64 = 40.0;

/// Points on a curve.
const STEPS: u32 = 1440;

/// Colours that differ for every eye: Okabe and Ito, Color Universal Design (2008).
pub(super) const COLOURS: [[u8; 3]; 6] =
    [[0, 114, 178], [213, 94, 0], [0, 158, 115], [204, 121, 167], [230, 159, 0], [86, 180, 233]];
const GREY: [u8; 3] = [176, 176, 176];

pub(super) struct Stroke {
    pub(super) points: Vec<[f64; 2]>,
    pub(super) colour: [u8; 3],
    pub(super) width: f64,
    /// A lobe of a sum, drawn with gaps.
    pub(super) dashed: bool,
}

/// A drawn plot.
pub struct Figure {
    title: String,
    caption: Vec<(String, [u8; 3])>,
    strokes: Vec<Stroke>,
}

impl std::fmt::Debug for Figure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Figure").field("title", &self.title).field("strokes", &self.strokes.len()).finish()
    }
}

/// f in the plane of incidence for angles of incidence in degrees.
#[must_use]
pub fn polar(title: &str, params: &str, model: &dyn Brdf, degrees: &[f64], scale: Scale) -> Figure {
    let curves: Vec<Vec<(f64, f64)>> =
        degrees.iter().map(|d| curve(d.to_radians(), |o, i| model.eval(o, i))).collect();
    // the lobes of a sum apart, such as its diffuse and its specular part
    let lobes = model.parts().filter(|parts| parts.len() > 1).unwrap_or_default();
    let top = curves.iter().flatten().map(|p| p.1).fold(0.0, f64::max);
    let mut strokes = grid();
    let mut caption = Vec::new();
    for (i, (points, angle)) in curves.iter().zip(degrees).enumerate() {
        let colour = COLOURS[i % COLOURS.len()];
        let peak = points.iter().map(|p| p.1).fold(0.0, f64::max);
        caption.push((format!("{angle} deg: largest f {peak:.3} 1/sr"), colour));
        let outline = points.iter().map(|&(theta, f)| place(theta, radius(f, top, scale))).collect();
        strokes.push(Stroke { points: outline, colour, width: 2.0, dashed: false });
        for &(weight, lobe) in &lobes {
            let apart = curve(angle.to_radians(), |o, i| weight * lobe.eval(o, i));
            let points = apart.iter().map(|&(theta, f)| place(theta, radius(f, top, scale))).collect();
            strokes.push(Stroke { points, colour, width: 1.0, dashed: true });
        }
        // where the light comes from
        let from = -angle.to_radians();
        strokes.push(Stroke {
            points: vec![place(from, RADIUS), place(from, RADIUS + 14.0)],
            colour,
            width: 3.0,
            dashed: false,
        });
    }
    let shown = match scale {
        Scale::Linear => "radius: f".to_owned(),
        Scale::Sqrt => "radius: square root of f".to_owned(),
        Scale::Log => format!("radius: log f, {DECADES} decades"),
    };
    let apart = if lobes.is_empty() { "" } else { "; dashed: its lobes apart" };
    caption.push((format!("{shown}{apart}"), [64, 64, 64]));
    let title = if params.is_empty() { title.to_owned() } else { format!("{title} ({params})") };
    Figure { title, caption, strokes }
}

/// Angle from the normal (negative towards the light) and f.
fn curve(incidence: f64, f: impl Fn(DVec3, DVec3) -> f64) -> Vec<(f64, f64)> {
    let wi = frame::spherical(incidence, PI);
    (0..=STEPS)
        .map(|i| {
            let theta = PI * f64::from(i) / f64::from(STEPS) - FRAC_PI_2;
            let wo = frame::spherical(theta.abs(), if theta < 0.0 { PI } else { 0.0 });
            (theta, f(wo, wi))
        })
        .collect()
}

fn radius(f: f64, top: f64, scale: Scale) -> f64 {
    if !(f > 0.0 && top > 0.0) {
        return 0.0;
    }
    let part = match scale {
        Scale::Linear => f / top,
        Scale::Sqrt => (f / top).sqrt(),
        Scale::Log => 1.0 + libm::log10(f / top) / DECADES,
    };
    RADIUS * part.clamp(0.0, 1.0)
}

/// Pixel position; the origin of the plot is in the middle of the surface.
fn place(theta: f64, r: f64) -> [f64; 2] {
    [MARGIN + RADIUS + r * libm::sin(theta), MARGIN + RADIUS - r * libm::cos(theta)]
}

fn grid() -> Vec<Stroke> {
    let line = |points| Stroke { points, colour: GREY, width: 1.0, dashed: false };
    let arc = |r: f64| (0..=180u32).map(|i| place((f64::from(i) - 90.0).to_radians(), r)).collect();
    let mut strokes: Vec<Stroke> = [0.25, 0.5, 0.75, 1.0].map(|part| line(arc(part * RADIUS))).into();
    for degrees in [-90.0f64, -60.0, -30.0, 0.0, 30.0, 60.0, 90.0] {
        strokes.push(line(vec![place(0.0, 0.0), place(degrees.to_radians(), RADIUS)]));
    }
    strokes
}

impl Figure {
    const WIDTH: f64 = 2.0 * (MARGIN + RADIUS);

    fn height(&self) -> f64 {
        MARGIN + RADIUS + 24.0 * (self.caption.len() as f64 + 1.0)
    }

    /// The plot as SVG.
    #[must_use]
    pub fn svg(&self) -> String {
        let (w, h) = (Self::WIDTH, self.height());
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {w} {h}\" width=\"{w}\" height=\"{h}\" font-family=\"sans-serif\" font-size=\"14\">\n\
             <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n<text x=\"{MARGIN}\" y=\"24\">{}</text>\n",
            escape(&self.title)
        );
        for s in &self.strokes {
            let points: Vec<String> =
                thinned(&s.points).iter().map(|p| format!("{:.2},{:.2}", p[0], p[1])).collect();
            svg.push_str(&format!(
                "<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"{} points=\"{}\"/>\n",
                hex(s.colour),
                s.width,
                if s.dashed { " stroke-dasharray=\"5 4\"" } else { "" },
                points.join(" ")
            ));
        }
        for (i, (text, colour)) in self.caption.iter().enumerate() {
            let y = MARGIN + RADIUS + 24.0 * (i as f64 + 1.0);
            svg.push_str(&format!(
                "<text x=\"{MARGIN}\" y=\"{y}\" fill=\"{}\">{}</text>\n",
                hex(*colour),
                escape(text)
            ));
        }
        svg.push_str("</svg>\n");
        svg
    }

    /// The plot as an 8-bit RGB PNG, without the text (pixels have no fonts here; the SVG has it).
    ///
    /// # Errors
    /// What the PNG encoder says.
    pub fn png(&self) -> Result<Vec<u8>, image::ImageError> {
        let size = |v: f64| u32::try_from(pixel(v)).unwrap_or(1);
        let (w, h) = (size(Self::WIDTH), size(MARGIN + RADIUS + 20.0));
        let mut canvas = image::RgbImage::from_pixel(w, h, image::Rgb([255; 3]));
        for stroke in &self.strokes {
            for (i, pair) in stroke.points.windows(2).enumerate() {
                if stroke.dashed && i % 12 >= 7 {
                    continue;
                }
                segment(&mut canvas, pair[0], pair[1], stroke);
            }
        }
        let mut bytes = std::io::Cursor::new(Vec::new());
        canvas.write_to(&mut bytes, image::ImageFormat::Png)?;
        Ok(bytes.into_inner())
    }
}

/// The line without the points that lie within a twentieth of a pixel of the line through their neighbours.
pub(super) fn thinned(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut kept: Vec<[f64; 2]> = Vec::new();
    for (i, p) in points.iter().enumerate() {
        let (Some(a), Some(b)) = (kept.last(), points.get(i + 1)) else {
            kept.push(*p);
            continue;
        };
        let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
        let [ex, ey] = [p[0] - a[0], p[1] - a[1]];
        let forward = ex * dx + ey * dy >= 0.0 && dx * dx + dy * dy >= ex * ex + ey * ey;
        if !forward || (ex * dy - ey * dx).abs() > 0.05 * (dx * dx + dy * dy).sqrt() {
            kept.push(*p);
        }
    }
    kept
}

/// Blends a segment in: coverage falls over one pixel at the edge of the line.
pub(super) fn segment(canvas: &mut image::RgbImage, a: [f64; 2], b: [f64; 2], stroke: &Stroke) {
    let reach = 0.5 * stroke.width + 1.0;
    let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
    let length2 = (dx * dx + dy * dy).max(1e-12);
    let span = |p: f64, q: f64| pixel(p.min(q) - reach)..=pixel(p.max(q) + reach);
    for y in span(a[1], b[1]) {
        for x in span(a[0], b[0]) {
            let (px, py) = (x as f64 + 0.5 - a[0], y as f64 + 0.5 - a[1]);
            let t = ((px * dx + py * dy) / length2).clamp(0.0, 1.0);
            let (ex, ey) = (px - t * dx, py - t * dy);
            let cover = (0.5 * stroke.width + 0.5 - (ex * ex + ey * ey).sqrt()).clamp(0.0, 1.0);
            let at = u32::try_from(x).ok().zip(u32::try_from(y).ok());
            if let Some(p) = at.filter(|_| cover > 0.0).and_then(|(x, y)| canvas.get_pixel_mut_checked(x, y))
            {
                for (c, s) in p.0.iter_mut().zip(stroke.colour) {
                    // darker wins, so that overlapping segments of a curve do not add up
                    *c = (*c).min(blend(255, s, cover));
                }
            }
        }
    }
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a weighted mean of two bytes is a byte"
)]
fn blend(under: u8, over: u8, cover: f64) -> u8 {
    (f64::from(under) * (1.0 - cover) + f64::from(over) * cover).round() as u8
}

#[allow(clippy::cast_possible_truncation, reason = "coordinates of a picture of a few hundred pixels")]
fn pixel(v: f64) -> i64 {
    v.floor() as i64
}

pub(super) fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

pub(super) fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
