//! Charts with two logarithmic axes: curves with marks, level lines, a legend; as SVG and as PNG, with the same words in both.

use super::drawing::{COLOURS, Drawing, INK, Stroke};
use crate::picture::PictureError;

/// Size of the picture, and the frame inside it: left, top, right, bottom.
const SIZE: [f64; 2] = [960.0, 600.0];
const FRAME: [f64; 4] = [84.0, 44.0, 640.0, 540.0];
const GRID: [u8; 3] = [222, 222, 222];
const LEVEL: [u8; 3] = [130, 130, 130];

/// Pixels between lines of words at least.
const CLOSE: f64 = 14.0;

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
        let mut d = Drawing::new(SIZE, &self.title);
        let points = || self.curves.iter().flat_map(|c| &c.points);
        let x = decades(points().map(|p| p[0]));
        let y = decades(points().map(|p| p[1]).chain(self.levels.iter().map(|l| l.0)));
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
        let mut right = f64::INFINITY;
        for (level, words) in &self.levels {
            let at = py(*level);
            d.line([[FRAME[0], at], [FRAME[2], at]], LEVEL, 1.5, true);
            // words that would stand on others go to the other side
            let (x, anchor) =
                if (at - right).abs() < CLOSE { (FRAME[0] + 4.0, 0.0) } else { (FRAME[2] - 4.0, 1.0) };
            right = if anchor > 0.5 { at } else { right };
            d.text([x, at - 4.0], anchor, LEVEL, words.clone());
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
        self.drawing().svg()
    }

    /// The chart as an 8-bit RGB PNG.
    ///
    /// # Errors
    /// What the PNG encoder says.
    pub fn png(&self) -> Result<Vec<u8>, PictureError> {
        self.drawing().png()
    }
}

fn tick(e: i32) -> String {
    match e {
        0..=3 => format!("{}", [1, 10, 100, 1000][usize::try_from(e).unwrap_or(0)]),
        e => format!("1e{e}"),
    }
}
