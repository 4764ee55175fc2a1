//! Which channels of a table are the parts of a split sum, told by their roles, and what a shader makes of them.

use crate::grid::Channel;

/// How channels give the albedo of a surface of F0 and F90 = 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Split {
    /// A channel is the white albedo.
    White(usize),
    /// Parts with weights 1 - Fc and Fc.
    ScaleBias(usize, usize),
    /// Parts with weights 1 and Fc.
    OneSchlick(usize, usize),
}

impl Split {
    /// The reading of these channels, if their roles are those of one.
    #[must_use]
    pub fn of(channels: &[Channel]) -> Option<Split> {
        let role = |r: &str| channels.iter().position(|c| c.role == r);
        let schlick = role("split part, Schlick weight");
        let scale = role("split part, complement of the Schlick weight");
        let one = role("split part, weight 1");
        match (scale, one, schlick) {
            (Some(scale), _, Some(bias)) => Some(Split::ScaleBias(scale, bias)),
            (_, Some(one), Some(schlick)) => Some(Split::OneSchlick(one, schlick)),
            _ => role("albedo").or_else(|| role("reflected albedo")).map(Split::White),
        }
    }

    /// What F0 scales, and what it does not: the albedo is `F0 scale + bias`.
    #[must_use]
    pub fn scale_bias(self, values: &[f64]) -> [f64; 2] {
        match self {
            Split::White(e) => [0.0, values[e]],
            Split::ScaleBias(s, b) => [values[s], values[b]],
            Split::OneSchlick(one, fc) => [values[one] - values[fc], values[fc]],
        }
    }

    /// Does the albedo depend on F0?
    #[must_use]
    pub fn takes_f0(self) -> bool {
        !matches!(self, Split::White(_))
    }
}
