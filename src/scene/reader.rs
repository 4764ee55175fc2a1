//! How a shader takes the roughness of a material before it reads a table.

use super::factor::{Interval, Spread};

/// What becomes of roughness between the file and the table.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Reader {
    /// The smallest roughness that the shader lets through.
    pub at_least: f64,
    /// Does it add to roughness what the normals of a pixel differ by? Then it may be anything above.
    pub widens: bool,
    /// Are filtered maps planned? Their levels are rougher than the textures wherever there are normals to be filtered.
    pub maps: bool,
    /// How far tables go beyond what the file says, on either side.
    pub margin: f64,
}

impl Reader {
    /// The perceptual roughness that a table is read at.
    #[must_use]
    pub fn roughness(&self, of: Interval) -> Interval {
        let lo = (of.lo - self.margin).max(self.at_least).clamp(0.0, 1.0);
        let hi = (of.hi + self.margin).max(self.at_least).clamp(0.0, 1.0);
        let hi = if self.widens { 1.0 } else { hi };
        // an interval that no texture spreads any more
        let spread = if lo < hi || of.spread == Spread::Constant { of.spread } else { Spread::Constant };
        Interval { lo, hi, spread }
    }
}
