//! Charts with two logarithmic axes: curves with marks, level lines, a legend; as SVG and as PNG, with the same words in both.

use super::letters;
use super::plot::{COLOURS, Stroke, escape, hex, segment, thinned};

/// Size of the picture, and the frame inside it: left, top, right, bottom.
const SIZE: [f64; 2] = [960.0, 600.0];
const FRAME: [f64; 4] = [84.0, 44.0, 640.0, 540.0];
const INK: [u8; 3] = [48, 48, 48];
const GRID: [u8; 3] = [222, 222, 222];
const LEVEL: [u8; 3] = [130, 130, 130];
/// Height of letters in pixels.
const LETTERS: f64 = 10.0;

/// A curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// What it is, for the legend.
    pub name: String,
    /// Points with positive coordinates.
    pub points: Vec<[f64; 2]>,
}

/// A chart.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    /// Title.
    pub title: String,
    /// What the axes measure.
    pub axes: [String; 2],
    /// Curves, in the order of the legend.
    pub curves: Vec<Curve>,
    /// Levels of y with their words.
    pub levels: Vec<(f64, String)>,
}

struct Text {
    at: [f64; 2],
    /// 0 begins at the place, 1 ends there.
    anchor: f64,
    colour: [u8; 3],
    text: String,
}

#[derive(Default)]
struct Drawing {
    strokes: Vec<Stroke>,
    texts: Vec<Text>,
}

/// Decades that the points lie in.
fn decades(values: impl Iterator<Item = f64>) -> [i32; 2] {
    let (mut lo, mut hi) = (f64::INFINITY, f64::NEG_INFINITY);
    for v in values.filter(|v| *v > 0.0 && v.is_finite()) {
        (lo, hi) = (lo.min(v), hi.max(v));
    }
    if lo > hi {
        return [0, 1];
    }
    let [lo, hi] = [libm::floor(libm::log10(lo) + 1e-9), libm::ceil(libm::log10(hi) - 1e-9)];
    #[allow(clippy::cast_possible_truncation, reason = "powers of ten of numbers are small")]
    let [lo, hi] = [lo as i32, hi as i32];
    [lo, hi.max(lo + 1)]
}

impl Chart {
    fn drawing(&self) -> Drawing {
        let mut d = Drawing::default();
        let points = || self.curves.iter().flat_map(|c| &c.points);
        let x = decades(points().map(|p| p[0]));
        let y = decades(points().map(|p| p[1]));
        let place = |v: f64, [lo, hi]: [i32; 2], from: f64, to: f64| {
            from + (to - from) * (libm::log10(v) - f64::from(lo)) / f64::from(hi - lo)
        };
        let px = |v: f64| place(v, x, FRAME[0], FRAME[2]);
        let py = |v: f64| place(v, y, FRAME[3], FRAME[1]);
        let power = |e: i32| libm::pow(10.0, f64::from(e));
        let every = |[lo, hi]: [i32; 2]| if hi - lo > 10 { 2 } else { 1 };
        for e in (x[0]..=x[1]).step_by(every(x)) {
            d.line([[px(power(e)), FRAME[1]], [px(power(e)), FRAME[3]]], GRID, 1.0, false);
            d.text([px(power(e)), FRAME[3] + 18.0], 0.5, INK, tick(e));
        }
        for e in (y[0]..=y[1]).step_by(every(y)) {
            d.line([[FRAME[0], py(power(e))], [FRAME[2], py(power(e))]], GRID, 1.0, false);
            d.text([FRAME[0] - 8.0, py(power(e)) + 4.0], 1.0, INK, tick(e));
        }
        for (level, words) in self.levels.iter().filter(|l| l.0 >= power(y[0]) && l.0 <= power(y[1])) {
            d.line([[FRAME[0], py(*level)], [FRAME[2], py(*level)]], LEVEL, 1.5, true);
            d.text([FRAME[2] - 4.0, py(*level) - 4.0], 1.0, LEVEL, words.clone());
        }
        let [left, top, right, bottom] = FRAME;
        let corners = [[left, top], [right, top], [right, bottom], [left, bottom], [left, top]];
        corners.windows(2).for_each(|p| d.line([p[0], p[1]], INK, 1.0, false));
        for (i, curve) in self.curves.iter().enumerate() {
            let colour = COLOURS[i % COLOURS.len()];
            let at: Vec<[f64; 2]> = curve.points.iter().map(|p| [px(p[0]), py(p[1])]).collect();
            let dashed = i >= COLOURS.len();
            d.strokes.push(Stroke { points: at.clone(), colour, width: 2.0, dashed });
            at.iter().for_each(|p| d.mark(*p, i, colour));
            let row = top + 14.0 + 22.0 * i as f64;
            d.line([[right + 16.0, row], [right + 44.0, row]], colour, 2.0, dashed);
            d.mark([right + 30.0, row], i, colour);
            d.text([right + 52.0, row + 4.0], 0.0, INK, curve.name.clone());
        }
        d.text([left, 24.0], 0.0, INK, self.title.clone());
        d.text([0.5 * (left + right), bottom + 42.0], 0.5, INK, self.axes[0].clone());
        d.text([left, top - 6.0], 0.0, INK, self.axes[1].clone());
        d
    }

    /// The chart as SVG.
    #[must_use]
    pub fn svg(&self) -> String {
        let d = self.drawing();
        let [w, h] = SIZE;
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {w} {h}\" width=\"{w}\" height=\"{h}\" role=\"img\" font-family=\"sans-serif\" font-size=\"13\">\n\
             <title>{}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
            escape(&self.title)
        );
        for s in &d.strokes {
            let points: Vec<String> =
                thinned(&s.points).iter().map(|p| format!("{:.2},{:.2}", p[0], p[1])).collect();
            let dash = if s.dashed { " stroke-dasharray=\"5 4\"" } else { "" };
            let (colour, width) = (hex(s.colour), s.width);
            svg.push_str(&format!(
                "<polyline fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\"{dash} points=\"{}\"/>\n",
                points.join(" ")
            ));
        }
        for t in &d.texts {
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

    /// The chart as an 8-bit RGB PNG.
    ///
    /// # Errors
    /// What the PNG encoder says.
    pub fn png(&self) -> Result<Vec<u8>, image::ImageError> {
        let d = self.drawing();
        let mut canvas = image::RgbImage::from_pixel(960, 600, image::Rgb([255; 3]));
        let mut strokes = d.strokes;
        for t in d.texts {
            let from = t.at[0] - t.anchor * letters::width(&t.text, LETTERS);
            let lines = letters::strokes(&t.text, [from, t.at[1]], LETTERS);
            strokes.extend(lines.into_iter().map(|points| Stroke {
                points,
                colour: t.colour,
                width: 1.2,
                dashed: false,
            }));
        }
        for stroke in &strokes {
            for pair in stroke.points.windows(2) {
                for [a, b] in dashes(pair[0], pair[1], stroke.dashed) {
                    segment(&mut canvas, a, b, stroke);
                }
            }
        }
        let mut bytes = std::io::Cursor::new(Vec::new());
        canvas.write_to(&mut bytes, image::ImageFormat::Png)?;
        Ok(bytes.into_inner())
    }
}

/// A segment, or the dashes of it.
fn dashes(a: [f64; 2], b: [f64; 2], dashed: bool) -> Vec<[[f64; 2]; 2]> {
    if !dashed {
        return vec![[a, b]];
    }
    let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
    let length = (dx * dx + dy * dy).sqrt().max(1e-9);
    let at = |s: f64| [a[0] + dx * (s / length).min(1.0), a[1] + dy * (s / length).min(1.0)];
    let mut all = Vec::new();
    let mut s = 0.0;
    while s < length {
        all.push([at(s), at(s + 5.0)]);
        s += 9.0;
    }
    all
}

fn tick(e: i32) -> String {
    match e {
        0..=3 => format!("{}", [1, 10, 100, 1000][usize::try_from(e).unwrap_or(0)]),
        e => format!("1e{e}"),
    }
}

impl Drawing {
    fn line(&mut self, points: [[f64; 2]; 2], colour: [u8; 3], width: f64, dashed: bool) {
        self.strokes.push(Stroke { points: points.to_vec(), colour, width, dashed });
    }

    fn text(&mut self, at: [f64; 2], anchor: f64, colour: [u8; 3], text: String) {
        self.texts.push(Text { at, anchor, colour, text });
    }

    /// A small figure that tells curves apart without their colour.
    fn mark(&mut self, [x, y]: [f64; 2], curve: usize, colour: [u8; 3]) {
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
}
