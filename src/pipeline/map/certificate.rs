//! What a conversion of other lobes to GGX costs, texel by texel of the first level: D, and the reflectance.

use super::output::{channel, pyramid};
use crate::encode::mips::MipLevel;
use crate::grid::Channel;
use crate::plan::map::{FromLobe, words};
use serde::{Deserialize, Serialize};

/// Texels that are listed.
const LISTED: usize = 10;

/// Gained energy below this is the accuracy of the sums.
const NOTHING: f32 = 2e-3;

/// What a conversion costs at every texel.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Certificate {
    pub(super) size: [usize; 2],
    /// `[D, largest difference of E over mu in [0.05, 1], what E gains]`.
    pub(super) texels: Vec<[f32; 3]>,
    pub(super) from: &'static str,
    pub(super) rule: &'static str,
    /// What reading between converted numbers costs of D, at most.
    pub(super) between: f64,
}

/// What the record holds of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CertificateRecord {
    /// Id of the parametrisation.
    pub from: String,
    /// `nearest` or `formula`.
    pub rule: String,
    /// D: mean and largest.
    pub distance: [f64; 2],
    /// Largest difference of E over view cosines in [0.05, 1]: mean and largest.
    pub energy: [f64; 2],
    /// What reading between converted numbers adds to D at most, where a map has too many pairs for each to be converted.
    pub between: f64,
    /// Texels where GGX reflects more than what it stands for, and the most of it: a finding.
    pub gained: Gained,
    /// The texels of the largest difference of E.
    pub worst: Vec<Worst>,
}

/// Energy that a conversion gains.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Gained {
    /// How many texels.
    pub texels: usize,
    /// The most.
    pub largest: f64,
}

/// A texel that a conversion changes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Worst {
    /// Column.
    pub x: usize,
    /// Row.
    pub y: usize,
    /// D.
    pub distance: f32,
    /// Largest difference of E.
    pub energy: f32,
}

impl Certificate {
    pub(super) fn new(size: [usize; 2], from: &FromLobe, texels: Vec<[f32; 3]>, between: f64) -> Certificate {
        let rule = words::of(&words::RULES, &from.by);
        Certificate { size, texels, from: from.conversion.id, rule, between }
    }

    pub(super) fn record(&self) -> CertificateRecord {
        let sums = |c: usize| {
            let (sum, most) = self
                .texels
                .iter()
                .fold((0.0, 0.0f64), |(s, m), t| (s + f64::from(t[c]), m.max(f64::from(t[c]))));
            [sum / self.texels.len().max(1) as f64, most]
        };
        let mut order: Vec<usize> = (0..self.texels.len()).collect();
        let worse = |a: &usize, b: &usize| self.texels[*b][1].total_cmp(&self.texels[*a][1]).then(a.cmp(b));
        if order.len() > LISTED {
            order.select_nth_unstable_by(LISTED, worse);
            order.truncate(LISTED);
        }
        order.sort_by(worse);
        let place = |i: usize| {
            let [distance, energy, _] = self.texels[i];
            Worst { x: i % self.size[0], y: i / self.size[0], distance, energy }
        };
        CertificateRecord {
            from: self.from.to_owned(),
            rule: self.rule.to_owned(),
            distance: sums(0),
            energy: sums(1),
            between: self.between,
            gained: Gained {
                texels: self.texels.iter().filter(|t| t[2] > NOTHING).count(),
                largest: sums(2)[1],
            },
            worst: order.into_iter().map(place).collect(),
        }
    }

    /// The map: D, and the largest difference of E.
    pub(super) fn map(&self) -> (Vec<Channel>, Vec<MipLevel>) {
        let unit = [0.0, 1.0];
        let channels = vec![
            channel("distance", "D between the lobe that was told and GGX", unit),
            channel("energy", "largest difference of E over view cosines in [0.05, 1]", unit),
        ];
        let values = self.texels.iter().flat_map(|t| [t[0].min(1.0), t[1].min(1.0)]).collect();
        (channels, pyramid(self.size, 2, values))
    }
}
