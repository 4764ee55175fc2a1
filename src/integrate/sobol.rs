//! Scrambled Sobol points in the unit square, and the standard error of independent replicates.
//!
//! The first 2ᵏ points put exactly one point in every dyadic box of area 2⁻ᵏ, for every k; Owen's scrambling keeps
//! that, makes every point uniform on the square (so the mean is unbiased) and makes different seeds independent (so
//! the spread of a few replicates is an honest error estimate). For smooth integrands the error falls nearly as
//! N^(−3/2). This is the cross-check of the bakers, never the baker.

use crate::math::sum::Sum;
use glam::DVec2;

/// 2³².
const TWO_32: f64 = 4_294_967_296.0;

/// One randomisation of the two-dimensional Sobol sequence; the seed determines every point.
///
/// ```
/// use brdfbake::integrate::sobol::Sobol;
/// let sobol = Sobol::new(7);
/// let mean = (0..1024).map(|i| sobol.point(i).x).sum::<f64>() / 1024.0;
/// assert!((mean - 0.5).abs() < 1e-4);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sobol {
    seed_x: u32,
    seed_y: u32,
}

impl Sobol {
    /// The sequence of a seed. Different seeds give independent scramblings.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        let [a, b, c, d, e, f, g, h] = mix(seed).to_le_bytes();
        Self { seed_x: u32::from_le_bytes([a, b, c, d]), seed_y: u32::from_le_bytes([e, f, g, h]) }
    }

    /// Point `index`, in the open square (0, 1)².
    ///
    /// Source: [Burley2020](crate::cite::BURLEY_2020) §3 (hash-based nested uniform scrambling), after
    /// [Laine and Karras 2011](crate::cite::LAINE_KARRAS_2011), with the mixing constants of
    /// [Vegdahl2021](crate::cite::VEGDAHL_2021). Each coordinate is the centre of one of 2³² cells.
    #[must_use]
    pub fn point(&self, index: u32) -> DVec2 {
        let x = scramble(index.reverse_bits(), self.seed_x);
        let y = scramble(second_dimension(index), self.seed_y);
        DVec2::new((f64::from(x) + 0.5) / TWO_32, (f64::from(y) + 0.5) / TWO_32)
    }

    /// The first `n` points in order. Powers of two are the balanced counts.
    pub fn points(self, n: u32) -> impl Iterator<Item = DVec2> {
        (0..n).map(move |i| self.point(i))
    }
}

/// `SplitMix64`'s finaliser: every bit of the seed reaches every bit of the result.
fn mix(seed: u64) -> u64 {
    let mut z = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// The second Sobol coordinate of `index` as a binary fraction: Pascal's triangle modulo 2 applied to its bits.
fn second_dimension(index: u32) -> u32 {
    let (mut rest, mut direction, mut x) = (index, 1_u32 << 31, 0_u32);
    while rest != 0 {
        if rest & 1 == 1 {
            x ^= direction;
        }
        rest >>= 1;
        direction ^= direction >> 1;
    }
    x
}

/// Owen's nested scrambling: each bit is flipped or not depending on the seed and on the bits above it only.
fn scramble(x: u32, seed: u32) -> u32 {
    // On mirrored bits "the bits above" are those below, and carries of + and · travel only upwards.
    let mut x = x.reverse_bits();
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^= x.wrapping_mul(0x53a2_2864);
    x.reverse_bits()
}

/// A mean with the standard error that its independent replicates show.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReplicateMean {
    /// Mean over all points of all replicates.
    pub mean: f64,
    /// Sample standard deviation of the replicates' means over √replicates; ∞ for a single one.
    pub standard_error: f64,
}

/// Integrates `f` over the unit square: `replicates` independent scramblings of `points` points each.
///
/// Replicate r uses the seed made of `seed` and r; all sums are compensated and in a fixed order, so the result is
/// the same on every machine. `f` may return several channels; they share the points, so their errors are correlated.
/// Guard: 0 replicates or points count as 1. Choose `points` a power of two, and at least 8 replicates: the standard
/// error of the standard error is 1/√(2 (replicates − 1)) of it.
pub fn replicate_mean<const N: usize>(
    seed: u64,
    replicates: u32,
    points: u32,
    mut f: impl FnMut(DVec2) -> [f64; N],
) -> [ReplicateMean; N] {
    let (replicates, points) = (replicates.max(1), points.max(1));
    let means: Vec<[f64; N]> = (0..replicates)
        .map(|replicate| {
            let mut sums = [Sum::default(); N];
            for u in Sobol::new(mix(seed).wrapping_add(u64::from(replicate))).points(points) {
                for (sum, value) in sums.iter_mut().zip(f(u)) {
                    sum.add(value);
                }
            }
            sums.map(|sum| sum.total() / f64::from(points))
        })
        .collect();
    let count = f64::from(replicates);
    std::array::from_fn(|channel| {
        let of_channel = || means.iter().map(|mean| mean[channel]);
        let mean = of_channel().collect::<Sum>().total() / count;
        let squares = of_channel().map(|x| (x - mean) * (x - mean)).collect::<Sum>().total();
        let standard_error =
            if replicates > 1 { (squares / (count - 1.0) / count).sqrt() } else { f64::INFINITY };
        ReplicateMean { mean, standard_error }
    })
}
