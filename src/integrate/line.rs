//! Adaptive quadrature of functions of one variable, several channels in one pass.
//!
//! A panel is summed by Kronrod's rule of 15 points and by the Gauss rule of 7 points inside it. The panel with the
//! largest estimate is halved until the estimates add up to less than the tolerance. Callers name the places where the
//! integrand has kinks, and the scales of its peaks: between two breaks it may be narrow, but must not hide.
//!
//! Source: [Piessens1983](crate::cite::PIESSENS_1983), routine QAG with the pair (7, 15), and its estimate
//! `m (200 |K - G| / m)^(3/2)`, m the integral of |f - mean f|, at most m.

use super::stop::{Estimate, MAX_CHANNELS, ROUNDING, Sums};

/// Most panels.
pub const MAX_PANELS: usize = 1000;

/// Nodes in (0, 1), the last in the middle; mirrored at 0.
pub const NODES: [f64; 8] = [
    0.991_455_371_120_812_639_206_854_697_526_329,
    0.949_107_912_342_758_524_526_189_684_047_851,
    0.864_864_423_359_769_072_789_712_788_640_926,
    0.741_531_185_599_394_439_863_864_773_280_788,
    0.586_087_235_467_691_130_294_144_691_258_384,
    0.405_845_151_377_397_166_906_606_412_076_961,
    0.207_784_955_007_898_467_600_689_403_773_245,
    0.0,
];

/// Kronrod weights of the nodes.
pub const KRONROD: [f64; 8] = [
    0.022_935_322_010_529_224_963_732_008_058_970,
    0.063_092_092_629_978_553_290_700_663_189_204,
    0.104_790_010_322_250_183_839_876_322_541_518,
    0.140_653_259_715_525_918_745_189_590_510_238,
    0.169_004_726_639_267_902_826_583_426_598_550,
    0.190_350_578_064_785_409_913_256_402_421_014,
    0.204_432_940_075_298_892_414_161_999_234_649,
    0.209_482_141_084_727_828_012_999_174_891_714,
];

/// Gauss weights of every second node.
pub const GAUSS: [f64; 4] = [
    0.129_484_966_168_869_693_270_611_432_679_082,
    0.279_705_391_489_276_667_901_467_771_423_780,
    0.381_830_050_505_118_944_950_369_775_488_975,
    0.417_959_183_673_469_387_755_102_040_816_327,
];

#[derive(Debug, Clone, Copy)]
struct Panel {
    ends: [f64; 2],
    value: Sums,
    error: Sums,
    /// Integral of |f|.
    magnitude: Sums,
}

/// `int f` from the first break to the last, every channel to `tolerance` (absolute). `f` writes the channels at x.
///
/// Breaks that are not increasing are left out. The result may miss the tolerance: its error then says so.
/// Accuracy: the estimates were never exceeded by analytic integrands with their kinks at breaks (`tests/tables_skin.rs`).
///
/// ```
/// use brdfbake::integrate::line;
/// let e = line::integrate(&[0.0, 1.0], 1, 1e-12, &mut |x, out| out[0] = x.sqrt());
/// assert!((e.value[0] - 2.0 / 3.0).abs() <= e.error[0].max(1e-12));
/// ```
pub fn integrate(
    breaks: &[f64],
    channels: usize,
    tolerance: f64,
    f: &mut dyn FnMut(f64, &mut Sums),
) -> Estimate {
    let channels = channels.min(MAX_CHANNELS);
    let mut panels: Vec<Panel> = Vec::new();
    let mut from = breaks.first().copied().unwrap_or(0.0);
    for &to in breaks {
        if to > from {
            panels.push(panel([from, to], channels, f));
            from = to;
        }
    }
    let mut count = panels.len();
    while panels.len() < MAX_PANELS && exceeds(&panels, channels, tolerance) {
        let Some(worst) = widest(&panels, channels) else { break };
        let [a, b] = panels[worst].ends;
        let middle = 0.5 * (a + b);
        if !(middle > a && middle < b) {
            break;
        }
        panels[worst] = panel([a, middle], channels, f);
        panels.push(panel([middle, b], channels, f));
        count += 2;
    }
    let mut e = Estimate {
        value: total(&panels, |p| p.value),
        error: total(&panels, |p| p.error),
        evaluations: u32::try_from(15 * count).unwrap_or(u32::MAX),
    };
    let magnitude = total(&panels, |p| p.magnitude);
    for (e, m) in e.error.iter_mut().zip(&magnitude) {
        *e += m * ROUNDING;
    }
    e
}

/// NaN counts as done: it does not get better by subdivision.
fn exceeds(panels: &[Panel], channels: usize, tolerance: f64) -> bool {
    let error = total(panels, |p| p.error);
    error[..channels].iter().any(|e| *e > tolerance) && !error[..channels].iter().any(|e| e.is_nan())
}

/// The panel with the largest error of any channel; none if there is no error left.
fn widest(panels: &[Panel], channels: usize) -> Option<usize> {
    let mut worst = (None, 0.0);
    for (i, panel) in panels.iter().enumerate() {
        for &e in &panel.error[..channels] {
            if e > worst.1 {
                worst = (Some(i), e);
            }
        }
    }
    worst.0
}

fn total(panels: &[Panel], part: impl Fn(&Panel) -> Sums) -> Sums {
    let mut sums = [0.0; MAX_CHANNELS];
    for panel in panels {
        for (s, p) in sums.iter_mut().zip(part(panel)) {
            *s += p;
        }
    }
    sums
}

fn panel(ends: [f64; 2], channels: usize, f: &mut dyn FnMut(f64, &mut Sums)) -> Panel {
    let (half, middle) = (0.5 * (ends[1] - ends[0]), 0.5 * (ends[0] + ends[1]));
    let mut values = [[0.0; MAX_CHANNELS]; 15];
    for (i, &node) in NODES.iter().enumerate() {
        f(middle - half * node, &mut values[i]);
        if i < 7 {
            f(middle + half * node, &mut values[14 - i]);
        }
    }
    let mut out = Panel {
        ends,
        value: [0.0; MAX_CHANNELS],
        error: [0.0; MAX_CHANNELS],
        magnitude: [0.0; MAX_CHANNELS],
    };
    for c in 0..channels {
        let (mut kronrod, mut gauss, mut magnitude) = (0.0, 0.0, 0.0);
        for (i, v) in values.iter().enumerate() {
            let k = i.min(14 - i);
            kronrod += KRONROD[k] * v[c];
            magnitude += KRONROD[k] * v[c].abs();
            if k % 2 == 1 {
                gauss += GAUSS[k / 2] * v[c];
            }
        }
        let spread: f64 = values
            .iter()
            .enumerate()
            .map(|(i, v)| KRONROD[i.min(14 - i)] * (v[c] - 0.5 * kronrod).abs())
            .sum();
        let difference = (kronrod - gauss).abs();
        let ratio = 200.0 * difference / spread;
        // 0/0 is a constant: no error; a ratio above 1 proves nothing, so the spread itself counts
        let error = if difference > 0.0 { spread * (ratio * ratio.sqrt()).min(1.0) } else { difference };
        out.value[c] = half * kronrod;
        out.error[c] = half * error;
        out.magnitude[c] = half * magnitude;
    }
    out
}
