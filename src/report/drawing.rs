//! A picture as a list of strokes, words and fields of pixels, written as SVG or as pixels, with the same words in both: those of
//! pixels are strokes ([`super::letters`]), so that no font of any system enters a file.

use super::letters;
use crate::picture::{PictureError, write_png};

/// Height of letters in pixels.
const LETTERS: f64 = 10.0;
/// Width of one letter in pixels, at most: as strokes.
pub(super) const LETTER: f64 = letters::ADVANCE * LETTERS / letters::HEIGHT;

/// Colours that differ for every eye: Okabe and Ito, Color Universal Design (2008).
pub(super) const COLOURS: [[u8; 3]; 6] =
    [[0, 114, 178], [213, 94, 0], [0, 158, 115], [204, 121, 167], [230, 159, 0], [86, 180, 233]];

/// Of words.
pub(super) const INK: [u8; 3] = [48, 48, 48];

/// A line through points.
#[derive(Debug, Clone)]
pub(super) struct Stroke {
    pub(super) points: Vec<[f64; 2]>,
    pub(super) colour: [u8; 3],
    pub(super) width: f64,
    pub(super) dashed: bool,
}

#[derive(Debug, Clone)]
struct Text {
    at: [f64; 2],
    /// 0 begins at the place, 1 ends there.
    anchor: f64,
    colour: [u8; 3],
    text: String,
}

/// Pixels, row by row. (In an SVG they are base64, which is there for pages.)
#[cfg(feature = "report")]
#[derive(Debug, Clone)]
pub(super) struct Field {
    /// Left and top.
    pub(super) at: [u32; 2],
    pub(super) width: u32,
    pub(super) pixels: Vec<[u8; 3]>,
}

/// What is drawn.
#[derive(Debug, Clone)]
pub(super) struct Drawing {
    size: [f64; 2],
    title: String,
    #[cfg(feature = "report")]
    fields: Vec<Field>,
    pub(super) strokes: Vec<Stroke>,
    texts: Vec<Text>,
}

impl Drawing {
    /// An empty one; its title is for those who do not see it.
    pub(super) fn new(size: [f64; 2], title: &str) -> Drawing {
        Drawing {
            size,
            title: title.to_owned(),
            #[cfg(feature = "report")]
            fields: Vec::new(),
            strokes: Vec::new(),
            texts: Vec::new(),
        }
    }

    pub(super) fn line(&mut self, points: [[f64; 2]; 2], colour: [u8; 3], width: f64, dashed: bool) {
        self.strokes.push(Stroke { points: points.to_vec(), colour, width, dashed });
    }

    /// Words; `anchor` is 0 where they begin at the place, 1 where they end there.
    pub(super) fn text(&mut self, at: [f64; 2], anchor: f64, colour: [u8; 3], text: String) {
        self.texts.push(Text { at, anchor, colour, text });
    }

    #[cfg(feature = "report")]
    pub(super) fn field(&mut self, field: Field) {
        self.fields.push(field);
    }

    /// A small figure that tells curves apart without their colour.
    pub(super) fn mark(&mut self, [x, y]: [f64; 2], curve: usize, colour: [u8; 3]) {
        let shape: &[[f64; 2]] = match curve % 5 {
            0 => &[[-3.0, -3.0], [3.0, -3.0], [3.0, 3.0], [-3.0, 3.0], [-3.0, -3.0]],
            1 => &[[-4.0, 3.0], [4.0, 3.0], [0.0, -4.0], [-4.0, 3.0]],
            2 => &[[0.0, -4.0], [4.0, 0.0], [0.0, 4.0], [-4.0, 0.0], [0.0, -4.0]],
            3 => &[[-3.0, -3.0], [3.0, 3.0]],
            _ => &[[-4.0, 0.0], [4.0, 0.0]],
        };
        let points = shape.iter().map(|p| [x + p[0], y + p[1]]).collect();
        self.strokes.push(Stroke { points, colour, width: 1.5, dashed: false });
    }

    /// The picture as SVG.
    pub(super) fn svg(&self) -> String {
        let [w, h] = self.size;
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {w} {h}\" width=\"{w}\" height=\"{h}\" role=\"img\" font-family=\"sans-serif\" font-size=\"13\">\n\
             <title>{}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
            escape(&self.title)
        );
        #[cfg(feature = "report")]
        self.fields.iter().for_each(|f| svg.push_str(&image_element(f)));
        for s in &self.strokes {
            let points: Vec<String> =
                thinned(&s.points).iter().map(|p| format!("{:.2},{:.2}", p[0], p[1])).collect();
            let dash = if s.dashed { " stroke-dasharray=\"5 4\"" } else { "" };
            let (colour, width) = (hex(s.colour), s.width);
            svg.push_str(&format!(
                "<polyline fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\"{dash} points=\"{}\"/>\n",
                points.join(" ")
            ));
        }
        for t in &self.texts {
            let anchor = if t.anchor < 0.25 {
                "start"
            } else if t.anchor < 0.75 {
                "middle"
            } else {
                "end"
            };
            svg.push_str(&format!(
                "<text x=\"{:.2}\" y=\"{:.2}\" text-anchor=\"{anchor}\" fill=\"{}\">{}</text>\n",
                t.at[0],
                t.at[1],
                hex(t.colour),
                escape(&t.text)
            ));
        }
        svg.push_str("</svg>\n");
        svg
    }

    /// The picture as an 8-bit RGB PNG.
    pub(super) fn png(&self) -> Result<Vec<u8>, PictureError> {
        let mut canvas = Canvas::white(self.size.map(|v| usize::try_from(pixel(v.ceil())).unwrap_or(1)));
        #[cfg(feature = "report")]
        for field in &self.fields {
            for (i, p) in (0..).zip(&field.pixels) {
                let (x, y) = (field.at[0] + i % field.width, field.at[1] + i / field.width);
                if let Some(under) = canvas.pixel(x as usize, y as usize) {
                    *under = *p;
                }
            }
        }
        let mut strokes = self.strokes.clone();
        for t in &self.texts {
            let from = t.at[0] - t.anchor * letters::width(&t.text, LETTERS);
            let lines = letters::strokes(&t.text, [from, t.at[1]], LETTERS);
            let stroke = |points| Stroke { points, colour: t.colour, width: 1.2, dashed: false };
            strokes.extend(lines.into_iter().map(stroke));
        }
        for stroke in &strokes {
            let mut walked = 0.0;
            for pair in stroke.points.windows(2) {
                for [a, b] in dashes(pair[0], pair[1], stroke.dashed, &mut walked) {
                    segment(&mut canvas, a, b, stroke);
                }
            }
        }
        write_png(canvas.size, 3, canvas.pixels.as_flattened())
    }
}

/// Pixels that are drawn on, row by row.
struct Canvas {
    /// Width and height.
    size: [usize; 2],
    pixels: Vec<[u8; 3]>,
}

impl Canvas {
    fn white([width, height]: [usize; 2]) -> Canvas {
        Canvas { size: [width, height], pixels: vec![[255; 3]; width * height] }
    }

    fn pixel(&mut self, x: usize, y: usize) -> Option<&mut [u8; 3]> {
        if x < self.size[0] { self.pixels.get_mut(y * self.size[0] + x) } else { None }
    }
}

/// Pixels inside an SVG.
#[cfg(feature = "report")]
fn image_element(field: &Field) -> String {
    use base64::Engine as _;
    let height = u32::try_from(field.pixels.len()).unwrap_or(0) / field.width.max(1);
    let bytes: Vec<u8> = field.pixels.iter().flatten().copied().collect();
    let mut png = Vec::new();
    let mut encoder = png::Encoder::new(&mut png, field.width, height);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::High);
    let written = encoder.write_header().and_then(|mut w| w.write_image_data(&bytes));
    // a vector cannot refuse bytes
    let data =
        if written.is_ok() { base64::engine::general_purpose::STANDARD.encode(&png) } else { String::new() };
    let ([x, y], width) = (field.at, field.width);
    format!(
        "<image x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" href=\"data:image/png;base64,{data}\"/>\n"
    )
}

/// A segment, or the dashes of it; `walked` is how far along its line it begins.
fn dashes(a: [f64; 2], b: [f64; 2], dashed: bool, walked: &mut f64) -> Vec<[[f64; 2]; 2]> {
    const DASH: f64 = 5.0;
    const PERIOD: f64 = 9.0;
    if !dashed {
        return vec![[a, b]];
    }
    let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
    let length = (dx * dx + dy * dy).sqrt().max(1e-9);
    let at = |s: f64| [a[0] + dx * (s / length).min(1.0), a[1] + dy * (s / length).min(1.0)];
    // a long segment begins with a dash, so that its corner is seen
    if length >= PERIOD {
        *walked = 0.0;
    }
    let mut all = Vec::new();
    let mut s = -(*walked % PERIOD);
    while s < length {
        let (from, to) = (s.max(0.0), s + DASH);
        if to > from {
            all.push([at(from), at(to)]);
        }
        s += PERIOD;
    }
    *walked += length;
    all
}

/// The line without the points that lie within a twentieth of a pixel of the line through their neighbours.
fn thinned(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
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
fn segment(canvas: &mut Canvas, a: [f64; 2], b: [f64; 2], stroke: &Stroke) {
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
            let at = usize::try_from(x).ok().zip(usize::try_from(y).ok());
            if let Some(p) = at.filter(|_| cover > 0.0).and_then(|(x, y)| canvas.pixel(x, y)) {
                for (c, s) in p.iter_mut().zip(stroke.colour) {
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

/// A text in lines of at most so many pixels, broken between words.
pub(super) fn wrapped(text: &str, width: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if letters::width(&format!("{line} {word}"), LETTERS) <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

pub(super) fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

pub(super) fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
