//! Adaptive quadrature for the checks: Kronrod's rules of 15, 21 and 31 points with the Gauss rules inside them, several channels at once,
//! values that carry errors of their own. It shares no grading and no stopping with the bakers, and no rule
//! but the numbers of the shortest one, which some tables of one variable are integrated by (in other panels; a test below sums powers).
//!
//! The error of a panel is the plain difference of the two rules, and a hundredth of that of the panel it is a half of at least; where
//! the halves change the whole by more than it admitted, theirs is raised by that factor. Dear, but not easily fooled.

use crate::integrate::line;
use std::collections::BinaryHeap;

/// Most channels of one pass.
pub(super) const WIDE: usize = 8;

/// A number for each channel, and its error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sum {
    pub(super) value: [f64; WIDE],
    pub(super) error: [f64; WIDE],
}

impl Sum {
    pub(super) const ZERO: Sum = Sum { value: [0.0; WIDE], error: [0.0; WIDE] };

    /// One exact number.
    pub(super) fn single(value: f64) -> Sum {
        let mut sum = Sum::ZERO;
        sum.value[0] = value;
        sum
    }

    /// One number with its error.
    pub(super) fn known(value: f64, error: f64) -> Sum {
        let mut sum = Sum::single(value);
        sum.error[0] = error;
        sum
    }

    pub(super) fn scale(&mut self, factor: f64) {
        for (v, e) in self.value.iter_mut().zip(&mut self.error) {
            *v *= factor;
            *e *= factor.abs();
        }
    }

    pub(super) fn add(&mut self, other: &Sum, factor: f64) {
        for c in 0..WIDE {
            self.value[c] += factor * other.value[c];
            self.error[c] += factor.abs() * other.error[c];
        }
    }
}

/// Part of the error of a panel that its halves keep at least: across a kink two rules may agree by chance.
const REMEMBERED: f64 = 0.01;

/// Relative rounding of a sum.
const ROUNDING: f64 = 1e-15;

/// A Kronrod rule: nodes in (0, 1) from the outermost, the last in the middle, with their weights, and the weights of the Gauss nodes
/// among them, which are every second one.
struct Rule {
    nodes: &'static [f64],
    kronrod: &'static [f64],
    gauss: &'static [f64],
}

/// Errors below which the longer rule is the cheaper one, and above which the shortest is.
const FINE: f64 = 3e-6;
const COARSE: f64 = 2e-5;

impl Rule {
    fn of(target: f64) -> &'static Rule {
        match target {
            t if t < FINE => &LONG,
            t if t > COARSE => &SHORTEST,
            _ => &SHORT,
        }
    }
}

/// 15 and 7 points, those of [`line`].
static SHORTEST: Rule = Rule { nodes: &line::NODES, kronrod: &line::KRONROD, gauss: &line::GAUSS };

/// 21 and 10 points.
static SHORT: Rule = Rule {
    nodes: &[
        0.995_657_163_025_808_080_735_527_280_689_003,
        0.973_906_528_517_171_720_077_964_012_084_452,
        0.930_157_491_355_708_226_001_207_180_059_508,
        0.865_063_366_688_984_510_732_096_688_423_493,
        0.780_817_726_586_416_897_063_717_578_345_042,
        0.679_409_568_299_024_406_234_327_365_114_874,
        0.562_757_134_668_604_683_339_000_099_272_694,
        0.433_395_394_129_247_190_799_265_943_165_784,
        0.294_392_862_701_460_198_131_126_603_103_866,
        0.148_874_338_981_631_210_884_826_001_129_720,
        0.0,
    ],
    kronrod: &[
        0.011_694_638_867_371_874_278_064_396_062_192,
        0.032_558_162_307_964_727_478_818_972_459_390,
        0.054_755_896_574_351_996_031_381_300_244_580,
        0.075_039_674_810_919_952_767_043_140_916_190,
        0.093_125_454_583_697_605_535_065_465_083_366,
        0.109_387_158_802_297_641_899_210_590_325_805,
        0.123_491_976_262_065_851_077_958_109_585_166,
        0.134_709_217_311_473_325_928_054_001_771_707,
        0.142_775_938_577_060_080_797_094_273_138_717,
        0.147_739_104_901_338_491_374_841_515_972_068,
        0.149_445_554_002_916_905_664_936_468_389_821,
    ],
    gauss: &[
        0.066_671_344_308_688_137_593_568_809_893_332,
        0.149_451_349_150_580_593_145_863_396_957_658,
        0.219_086_362_515_982_043_995_534_934_228_163,
        0.269_266_719_309_996_355_091_226_921_569_469,
        0.295_524_224_714_752_870_173_815_619_188_769,
    ],
};

/// 31 and 15 points.
static LONG: Rule = Rule {
    nodes: &[
        0.998_002_298_693_397_060_285_172_840_152_271,
        0.987_992_518_020_485_428_489_565_718_586_613,
        0.967_739_075_679_139_134_257_347_978_784_337,
        0.937_273_392_400_705_904_307_758_947_710_209,
        0.897_264_532_344_081_900_882_509_656_454_496,
        0.848_206_583_410_427_216_200_648_320_774_217,
        0.790_418_501_442_465_932_967_649_294_817_947,
        0.724_417_731_360_170_047_416_186_054_613_938,
        0.650_996_741_297_416_970_533_735_895_313_275,
        0.570_972_172_608_538_847_537_226_737_253_911,
        0.485_081_863_640_239_680_693_655_740_232_351,
        0.394_151_347_077_563_369_897_207_370_981_045,
        0.299_180_007_153_168_812_166_780_024_266_389,
        0.201_194_093_997_434_522_300_628_303_394_596,
        0.101_142_066_918_717_499_027_074_231_447_392,
        0.0,
    ],
    kronrod: &[
        0.005_377_479_872_923_348_987_792_051_430_128,
        0.015_007_947_329_316_122_538_374_763_075_807,
        0.025_460_847_326_715_320_186_874_001_019_653,
        0.035_346_360_791_375_846_222_037_948_478_360,
        0.044_589_751_324_764_876_608_227_299_373_280,
        0.053_481_524_690_928_087_265_343_147_239_430,
        0.062_009_567_800_670_640_285_139_230_960_803,
        0.069_854_121_318_728_258_709_520_077_099_147,
        0.076_849_680_757_720_378_894_432_777_482_659,
        0.083_080_502_823_133_021_038_289_247_286_104,
        0.088_564_443_056_211_770_647_275_443_693_774,
        0.093_126_598_170_825_321_225_486_872_747_346,
        0.096_642_726_983_623_678_505_179_907_627_589,
        0.099_173_598_721_791_959_332_393_173_484_603,
        0.100_769_845_523_875_595_044_946_662_617_570,
        0.101_330_007_014_791_549_017_374_792_767_493,
    ],
    gauss: &[
        0.030_753_241_996_117_268_354_628_393_577_204,
        0.070_366_047_488_108_124_709_267_416_450_667,
        0.107_159_220_467_171_935_011_869_546_685_869,
        0.139_570_677_926_154_314_447_804_794_511_028,
        0.166_269_205_816_993_933_553_200_860_481_209,
        0.186_161_000_015_562_211_026_800_561_866_423,
        0.198_431_485_327_111_576_456_118_326_443_839,
        0.202_578_241_925_561_272_880_620_199_967_519,
    ],
};

struct Panel {
    ends: [f64; 2],
    sum: Sum,
    /// What halving can mend: the difference of the rules, without the errors of the values.
    own: [f64; WIDE],
    worst: f64,
    number: usize,
}

impl PartialEq for Panel {
    fn eq(&self, other: &Panel) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Panel {}

impl PartialOrd for Panel {
    fn partial_cmp(&self, other: &Panel) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Panel {
    fn cmp(&self, other: &Panel) -> std::cmp::Ordering {
        self.worst.total_cmp(&other.worst).then(other.number.cmp(&self.number))
    }
}

/// Panels by their errors, and the sums of those.
struct Panels {
    heap: BinaryHeap<Panel>,
    own: [f64; WIDE],
    target: [f64; WIDE],
    channels: usize,
    made: usize,
}

impl Panels {
    fn push(&mut self, mut panel: Panel) {
        for (sum, own) in self.own.iter_mut().zip(&panel.own) {
            *sum += own;
        }
        self.made += 1;
        panel.number = self.made;
        let excess = panel.own.iter().zip(&self.target).take(self.channels).map(|(e, t)| e / t);
        panel.worst = excess.fold(0.0, f64::max);
        self.heap.push(panel);
    }

    fn pop(&mut self) -> Option<Panel> {
        let panel = self.heap.pop()?;
        for (sum, own) in self.own.iter_mut().zip(&panel.own) {
            *sum -= own;
        }
        Some(panel)
    }

    /// NaN compares false and ends the work.
    fn is_done(&self) -> bool {
        !self.own.iter().zip(&self.target).take(self.channels).any(|(e, t)| e > t)
    }
}

/// `int f` from the first break to the last, until the differences of the rules add up to less than `target` in each of
/// `channels` channels, or `most` panels are made.
pub(super) fn integrate(
    breaks: &[f64],
    channels: usize,
    target: &[f64; WIDE],
    most: usize,
    f: &mut dyn FnMut(f64) -> Sum,
) -> Sum {
    let mut panels = Panels { heap: BinaryHeap::new(), own: [0.0; WIDE], target: *target, channels, made: 0 };
    let rule = Rule::of(target.iter().take(channels).copied().fold(f64::INFINITY, f64::min));
    for pair in breaks.windows(2).filter(|p| p[1] > p[0]) {
        panels.push(panel(rule, [pair[0], pair[1]], channels, f));
    }
    while panels.made < most && !panels.is_done() {
        let Some(whole) = panels.pop() else { break };
        let [a, b] = whole.ends;
        let middle = 0.5 * (a + b);
        if !(middle > a && middle < b) {
            panels.push(whole);
            break;
        }
        let mut halves = [panel(rule, [a, middle], channels, f), panel(rule, [middle, b], channels, f)];
        doubt(&whole, &mut halves, channels);
        halves.into_iter().for_each(|half| panels.push(half));
    }
    let mut panels = panels.heap.into_vec();
    panels.sort_unstable_by_key(|p| p.number);
    let mut total = Sum::ZERO;
    for p in &panels {
        total.add(&p.sum, 1.0);
    }
    total
}

/// Raises the errors of halves by what is known of the whole.
fn doubt(whole: &Panel, halves: &mut [Panel; 2], channels: usize) {
    for c in 0..channels {
        let least = REMEMBERED * whole.own[c];
        // a whole that its halves change by more than it admitted was a lie, and so may they be
        let apart = (halves[0].sum.value[c] + halves[1].sum.value[c] - whole.sum.value[c]).abs();
        let lied = apart > whole.own[c] && apart > ROUNDING * whole.sum.value[c].abs();
        let lie = if lied { (apart / whole.own[c].max(f64::MIN_POSITIVE)).min(1e3) } else { 1.0 };
        for half in halves.iter_mut() {
            let raised = lie * half.own[c].max(least);
            half.sum.error[c] += raised - half.own[c];
            half.own[c] = raised;
        }
    }
}

fn panel(rule: &Rule, ends: [f64; 2], channels: usize, f: &mut dyn FnMut(f64) -> Sum) -> Panel {
    let (half, middle) = (0.5 * (ends[1] - ends[0]), 0.5 * (ends[0] + ends[1]));
    let (mut kronrod, mut gauss, mut size) = (Sum::ZERO, [0.0; WIDE], [0.0; WIDE]);
    for (k, (&node, &weight)) in rule.nodes.iter().zip(rule.kronrod).enumerate() {
        let sides: &[f64] = if node > 0.0 { &[-1.0, 1.0] } else { &[0.0] };
        for side in sides {
            let at = f(middle + side * half * node);
            kronrod.add(&at, half * weight);
            for c in 0..channels {
                size[c] += half * weight * at.value[c].abs();
                if k % 2 == 1 {
                    gauss[c] += half * rule.gauss[k / 2] * at.value[c];
                }
            }
        }
    }
    let mut own = [0.0; WIDE];
    for c in 0..channels {
        own[c] = (kronrod.value[c] - gauss[c]).abs();
        kronrod.error[c] += own[c] + ROUNDING * size[c];
    }
    Panel { ends, sum: kronrod, own, worst: 0.0, number: 0 }
}

/// A function of one channel: value and error.
pub(super) fn integral(breaks: &[f64], target: f64, f: &mut dyn FnMut(f64) -> f64) -> (f64, f64) {
    let sum = integrate(breaks, 1, &[target; WIDE], 400, &mut |x| Sum::single(f(x)));
    (sum.value[0], sum.error[0])
}

/// Maps [0, 1] to itself with both ends spread: `x^3 (10 - 15 x + 6 x^2)` and its slope. Ends where a function bends without bound
/// become flat, and what happens on the scale 1e-6 of an end is met by the nodes.
pub(super) fn spread(x: f64) -> (f64, f64) {
    let y = 1.0 - x;
    let value = if x < 0.5 { rise(x) } else { 1.0 - rise(y) };
    (value, 30.0 * (x * y) * (x * y))
}

fn rise(x: f64) -> f64 {
    x * x * x * (10.0 + x * (6.0 * x - 15.0))
}

#[cfg(test)]
mod tests {
    use super::{LONG, Rule, SHORT, SHORTEST};

    /// Both rules sum powers exactly: Kronrod's to three halves of its length, Gauss' to twice its own.
    #[test]
    fn rules_are_exact() {
        for (rule, kronrod, gauss) in [(&SHORTEST, 22, 12), (&SHORT, 30, 18), (&LONG, 46, 28)] {
            let power = |x: f64, n: i32| (0..n).fold(1.0, |p, _| p * x);
            let sum = |rule: &Rule, weights: &dyn Fn(usize) -> f64, n: i32| -> f64 {
                let one =
                    |(k, x): (usize, &f64)| weights(k) * power(*x, n) * if *x > 0.0 { 2.0 } else { 1.0 };
                rule.nodes.iter().enumerate().map(one).sum()
            };
            for n in (0..=kronrod).step_by(2) {
                let s = sum(rule, &|k| rule.kronrod[k], n);
                assert!((s - 2.0 / f64::from(n + 1)).abs() < 4e-16 * 4.0, "{n}: {s}");
            }
            for n in (0..=gauss).step_by(2) {
                let s = sum(rule, &|k| if k % 2 == 1 { rule.gauss[k / 2] } else { 0.0 }, n);
                assert!((s - 2.0 / f64::from(n + 1)).abs() < 4e-16 * 4.0, "{n}: {s}");
            }
        }
    }
}
