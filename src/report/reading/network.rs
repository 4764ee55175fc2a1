//! A small neural network in place of the split sum of GGX: inputs are the axes, three hidden layers of 32 units, outputs the channels.
//!
//! Its weights are made by `tests/values/network.py`, which says how. An input is the coordinate of an axis, as the table has it, moved
//! to [-1, 1]. A unit is `h = z / (1 + |z|)`, `z` its bias plus the weighted units below; outputs are `z`, held to [0, 1]. It is evaluated
//! in f32, in one order of sums, with nothing but sums, products and quotients: the same everywhere.

use crate::grid::{Axis, Grid, Quantity, Texel, Warp};

/// Units of the layers.
const SIZES: [usize; 5] = [2, 32, 32, 32, 2];

/// Lines of units, layer by layer: bias, then weights.
const WEIGHTS: &str = include_str!("network.txt");

/// The network.
#[derive(Debug)]
pub(super) struct Network {
    axes: Grid,
    /// Of each layer the units: bias, then weights.
    layers: Vec<Vec<Vec<f32>>>,
}

impl Network {
    /// Reads the weights; none if they are damaged, which a test excludes.
    pub(super) fn new() -> Option<Network> {
        let mut lines = WEIGHTS.lines();
        let mut layers = Vec::new();
        for pair in SIZES.windows(2) {
            let mut layer = Vec::new();
            for _ in 0..pair[1] {
                let unit: Vec<f32> =
                    lines.next()?.split_whitespace().map(|w| w.parse().ok()).collect::<Option<_>>()?;
                layer.push(Some(unit).filter(|u| u.len() == pair[0] + 1)?);
            }
            layers.push(layer);
        }
        let axis = |id: &str, domain: [f64; 2], warp: Warp| {
            Some(Axis::new(Quantity::find(id)?, 2, Texel::Endpoint).over(domain).warped(warp))
        };
        // as in tests/values/network.toml
        let warp = Warp::Coupled { to: "alpha".to_owned(), power: 4.0, scale: 3.0, exponent: 0.25 };
        let mu = axis("mu", [0.0, 1.0], warp)?;
        let roughness = axis("roughness", [0.01, 1.0], Warp::Power(0.5))?;
        Some(Network { axes: Grid::new(vec![mu, roughness]).ok()?, layers })
    }

    /// Scale and bias of a view cosine and an alpha.
    #[allow(clippy::cast_possible_truncation, reason = "it computes in f32")]
    pub(super) fn at(&self, mu: f64, alpha: f64) -> Option<[f64; 2]> {
        // axes of two texels at their ends: the index is the coordinate
        let [u, v, ..] = self.axes.index(&self.axes.point(&[mu, alpha])?);
        let mut values: Vec<f32> = [u, v].map(|x| (2.0 * x - 1.0) as f32).to_vec();
        for (k, layer) in self.layers.iter().enumerate() {
            let last = k + 1 == self.layers.len();
            let unit = |unit: &Vec<f32>| {
                let z = unit[1..].iter().zip(&values).fold(unit[0], |z, (w, x)| z + w * x);
                if last { z.clamp(0.0, 1.0) } else { z / (1.0 + z.abs()) }
            };
            values = layer.iter().map(unit).collect();
        }
        match values[..] {
            [scale, bias] => Some([f64::from(scale), f64::from(bias)]),
            _ => None,
        }
    }

    /// Bytes of the weights in f32.
    pub(super) fn bytes(&self) -> usize {
        4 * self.layers.iter().flatten().map(Vec::len).sum::<usize>()
    }

    /// Products, sums and quotients, with those of its inputs.
    pub(super) fn operations(&self) -> usize {
        let weights: usize = SIZES.windows(2).map(|p| 2 * p[0] * p[1]).sum();
        let units: usize = SIZES[1..SIZES.len() - 1].iter().map(|n| 2 * n).sum();
        weights + units + super::of_coordinates(self.axes.axes()) + 2 * SIZES[0]
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "test")]
    use super::Network;
    use crate::tables::spec::Request;
    use crate::verify::seeds::Seeds;

    /// Twice the root of the mean square of the training, which saw other points; and its largest.
    const OFF: [f64; 2] = [1.3e-3, 1.2e-2];

    #[test]
    fn it_is_near_the_integrals() {
        let network = Network::new().unwrap();
        let bound = Request { kind: "dfg".to_owned(), ..Request::default() }.bind().unwrap();
        let grid = &bound.spec.grid;
        let mut seeds = Seeds::new(7);
        let (mut squares, n) = (0.0, 200);
        for _ in 0..n {
            let point = grid.at_coordinates(&[seeds.unit(), seeds.unit()]);
            let [mu, alpha] = point.values()[..] else { panic!("two axes") };
            let want = bound.baker.texel(&[mu, alpha], 1e-5).unwrap().value;
            for (got, want) in network.at(mu, alpha).unwrap().into_iter().zip(want) {
                assert!((got - want).abs() < OFF[1], "mu {mu}, alpha {alpha}: {got}, {want}");
                squares += (got - want) * (got - want);
            }
        }
        let rms = (squares / f64::from(2 * n)).sqrt();
        assert!(rms < OFF[0], "{rms}");
    }

    #[test]
    fn weights_are_whole_and_the_network_is_a_split_sum() {
        let network = Network::new().unwrap();
        assert_eq!(network.bytes(), 4 * 2274);
        // a mirror at normal view, and at the horizon
        let near = |got: [f64; 2], want: [f64; 2]| got.iter().zip(want).all(|(g, w)| (g - w).abs() < 0.02);
        assert!(near(network.at(1.0, 1e-4).unwrap(), [1.0, 0.0]), "{:?}", network.at(1.0, 1e-4));
        // int of alpha = 1 at normal view: 1 - ln 2, of which the bias has next to nothing
        let rough = network.at(1.0, 1.0).unwrap();
        assert!(near(rough, [1.0 - std::f64::consts::LN_2, 0.0]), "{rough:?}");
    }
}
