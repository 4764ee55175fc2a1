//! Finds a BC6H block for sixteen texels.
//!
//! What is made small is the sum of the eighth powers of all errors of the block: a smooth stand-in for the largest one
//! that still cares for the others. Errors are those of the decoded values, not of their bits.
//!
//! 1. A line through the texels of a subset, in the space where BC6H interpolates: from the two texels farthest apart,
//!    then least squares for the ends at the indices of the texels, weighted by what a step there is worth.
//! 2. One line in every mode with one pair of endpoints; then the [`KEPT`] partitions whose lines are best in every mode
//!    with two, wherever the differences of the endpoints have the bits.
//! 3. Rounded ends are moved, one channel at a time, both ends together, by steps that halve, while that helps.
//!
//! Everything has a fixed order and is f64 with `+ - * /`, so that the same texels give the same bytes everywhere.

use super::bc6h::{Block, Endpoints, MODES, Mode, PARTITIONS, TEXELS, mix, value};
use super::bc6h_line::{Costs, Line, Subset, Target};

/// Partitions that are tried in every mode.
const KEPT: usize = 6;
/// Rounds of moves at one step.
const MOVES: usize = 6;
/// A rounded line that costs this many times the best block is not worth moving: moves do not halve an error.
const HOPELESS: f64 = 256.0;

/// The cheapest block so far.
struct Best {
    cost: f64,
    block: Option<Block>,
}

/// The block for these texels. Channels from `channels` on hold 0.
pub(super) fn encode(values: &[[f64; 3]; TEXELS], channels: usize, signed: bool) -> [u8; 16] {
    let target = Target::new(values, channels.clamp(1, 3), signed);
    let mut best = Best { cost: f64::INFINITY, block: None };
    let [single, double] = [1, 2].map(|n| MODES.iter().enumerate().filter(move |(_, m)| m.subsets == n));
    if let Some((_, mode)) = single.clone().next() {
        let whole = [Subset::new(mode, 0, 0)];
        let lines = [target.line(&whole[0], mode.weights()).0];
        for (number, _) in single {
            target.attempt(number, 0, &whole, &lines, &mut best);
        }
    }
    if let Some((_, mode)) = double.clone().next().filter(|_| best.cost > 0.0) {
        for (partition, subsets, lines) in target.ranked(mode) {
            for (number, _) in double.clone() {
                target.attempt(number, partition, &subsets, &lines, &mut best);
            }
        }
    }
    best.block.map_or(0, |b| b.bits()).to_le_bytes()
}

impl Target<'_> {
    /// The partitions whose lines are best, with their subsets and lines.
    fn ranked(&self, mode: &Mode) -> Vec<(usize, [Subset; 2], [Line; 2])> {
        let mut all: Vec<_> = (0..PARTITIONS.len())
            .map(|partition| {
                let subsets = [0, 1].map(|pair| Subset::new(mode, partition, pair));
                let [a, b] = subsets.each_ref().map(|s| self.line(s, mode.weights()));
                (a.1 + b.1, (partition, subsets, [a.0, b.0]))
            })
            .collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        all.truncate(KEPT);
        all.into_iter().map(|(_, found)| found).collect()
    }

    /// Rounds lines to a mode and moves their ends; keeps the block if it is the best.
    fn attempt(&self, number: usize, partition: usize, subsets: &[Subset], lines: &[Line], best: &mut Best) {
        let mode = &MODES[number];
        let mut endpoints: Endpoints = [[0; 3]; 4];
        for (pair, line) in lines.iter().enumerate() {
            for (end, wide) in line.0.iter().enumerate() {
                for (c, v) in wide.iter().enumerate().take(self.channels) {
                    endpoints[2 * pair + end][c] = round(*v, mode, self.signed);
                }
            }
        }
        if !fits(mode, &endpoints) {
            return;
        }
        let mut block = Block { mode: number, partition, endpoints, indices: [0; TEXELS] };
        let mut searches: Vec<Search<'_>> =
            subsets.iter().enumerate().map(|(pair, s)| Search::new(self, s, pair, &mut block)).collect();
        if searches.iter().map(|s| s.cost).sum::<f64>() >= HOPELESS * best.cost {
            return;
        }
        for search in &mut searches {
            search.refine(&mut block);
        }
        let cost = searches.iter().map(|s| s.cost).sum();
        if cost < best.cost {
            *best = Best { cost, block: Some(block) };
        }
    }
}

/// The moves of one pair of endpoints.
struct Search<'a> {
    target: &'a Target<'a>,
    subset: &'a Subset,
    /// Number of its first endpoint.
    at: usize,
    costs: Costs,
    cost: f64,
}

impl<'a> Search<'a> {
    fn new(target: &'a Target<'a>, subset: &'a Subset, pair: usize, block: &mut Block) -> Search<'a> {
        let mode = &MODES[block.mode];
        let mut search =
            Search { target, subset, at: 2 * pair, costs: [[[0.0; 16]; TEXELS]; 3], cost: f64::INFINITY };
        for c in 0..target.channels {
            let mut costs = [[0.0; 16]; TEXELS];
            search.channel(mode, c, &block.endpoints, &mut costs);
            search.costs[c] = costs;
        }
        let costs = search.costs.each_ref();
        search.cost = target.assign(subset, costs, mode.weights().len(), f64::INFINITY, &mut block.indices);
        search
    }

    /// Costs of a channel with these endpoints.
    fn channel(&self, mode: &Mode, c: usize, endpoints: &Endpoints, costs: &mut [[f64; 16]; TEXELS]) {
        let signed = self.target.signed;
        let [a, b] = [0, 1].map(|end| mode.widen(endpoints[self.at + end][c], signed));
        let mut palette = [0.0; 16];
        for (p, w) in palette.iter_mut().zip(mode.weights()) {
            *p = value(mix(a, b, *w), signed);
        }
        self.target.cost(self.subset, c, &palette[..mode.weights().len()], costs);
    }

    /// Moves the ends while that helps.
    fn refine(&mut self, block: &mut Block) {
        let [a, b] = [0, 1].map(|end| block.endpoints[self.at + end]);
        let longest = (0..self.target.channels).map(|c| (a[c] - b[c]).abs()).max().unwrap_or(0);
        let mut step = 1;
        while step * 16 <= longest {
            step *= 2;
        }
        while step > 0 {
            for _ in 0..MOVES {
                let moved = (0..self.target.channels).filter(|&c| self.moves(c, step, block)).count();
                if moved == 0 {
                    break;
                }
            }
            step /= 2;
        }
    }

    /// Tries the eight moves of the two ends of a channel; true if one of them helped.
    fn moves(&mut self, c: usize, step: i32, block: &mut Block) -> bool {
        const ALL: [[i32; 2]; 8] = [[-1, -1], [-1, 0], [-1, 1], [0, -1], [0, 1], [1, -1], [1, 0], [1, 1]];
        let mode = &MODES[block.mode];
        let signed = self.target.signed;
        let before = self.cost;
        let mut costs = [[0.0; 16]; TEXELS];
        for direction in ALL {
            let mut endpoints = block.endpoints;
            let mut allowed = true;
            for (end, d) in direction.iter().enumerate() {
                let q = &mut endpoints[self.at + end][c];
                *q += d * step;
                allowed &= mode.holds(*q, signed);
            }
            if !allowed || !fits(mode, &endpoints) {
                continue;
            }
            self.channel(mode, c, &endpoints, &mut costs);
            let mut all = self.costs.each_ref();
            all[c] = &costs;
            let mut indices = block.indices;
            let cost = self.target.assign(self.subset, all, mode.weights().len(), self.cost, &mut indices);
            if cost < self.cost {
                self.cost = cost;
                self.costs[c] = costs;
                block.endpoints = endpoints;
                block.indices = indices;
            }
        }
        self.cost < before
    }
}

/// Do all endpoints fit the differences of the mode?
fn fits(mode: &Mode, endpoints: &Endpoints) -> bool {
    let first = endpoints[0];
    endpoints[1..2 * mode.subsets].iter().all(|end| (0..3).all(|c| mode.fits(c, first[c], end[c])))
}

/// The endpoint of a mode nearest to a wide number.
#[allow(clippy::cast_possible_truncation, reason = "at most 16 bits")]
fn round(wide: f64, mode: &Mode, signed: bool) -> i32 {
    let step = f64::from(1 << (16 - mode.base));
    // the middle of a step stands for it
    let middle = if mode.base < 16 { 0.5 } else { 0.0 };
    let q = (wide.abs() / step - middle).round_ties_even().max(0.0) as i32;
    let q = q.min(mode.largest(signed));
    if wide < 0.0 { -q } else { q }
}
