//! Words of which roles are made: sides, bands, entries of matrices.

/// From where an interface is seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// From outside, at eta.
    Above,
    /// From below, at 1 / eta.
    Inside,
}

/// Which light of a view is counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Light {
    /// All that leaves the surface: of models that do not transmit, what is reflected.
    All,
    /// What leaves on the side of the view.
    Reflected,
    /// What crosses.
    Transmitted,
}

/// A third of a colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Band {
    /// Red, or 650 nm.
    Red,
    /// Green, or 550 nm.
    Green,
    /// Blue, or 450 nm.
    Blue,
}

impl Band {
    /// 0, 1 or 2.
    #[must_use]
    pub const fn index(self) -> usize {
        self as usize
    }
}

/// Which polarisation of a Fresnel factor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Polarisation {
    /// Perpendicular to the plane of incidence.
    S,
    /// In the plane of incidence.
    P,
    /// The mean of both.
    None,
}

/// An entry of an inverse matrix of a transformed cosine, and what it is divided by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Entry {
    /// m11 / m22.
    M11,
    /// m31 / m22.
    M31,
    /// m13 / m22.
    M13,
    /// m33 / m22.
    M33,
    /// m11 / m33.
    Z11,
    /// m31 / m33.
    Z31,
    /// m22 / m33.
    Z22,
    /// m13 / m33.
    Z13,
    /// a of the sheared family.
    A,
    /// b of the sheared family.
    B,
}

/// Which family a fit is of, where it is a channel how far it is off.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fitted {
    /// All matrices that are even in y.
    Even,
    /// `[[a, 0, b], [0, a, 0], [0, 0, 1]]`.
    Sheared,
}

/// A distance of a fit from what it was fitted to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Distance {
    /// The relative L3 error.
    Cubic,
    /// The total variation.
    Variation,
}

/// Per what a diffusion profile is counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Per {
    /// Per distance: 2 pi r R.
    Ring,
    /// Per area: R.
    Area,
}

/// How the colour of a black body is scaled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Glow {
    /// Luminance 1, not negative.
    Hue,
    /// Luminance 1, as the matrix gives it.
    Unclamped,
    /// Luminance relative to that at a reference, not negative.
    Light,
}

/// A component of a direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Component {
    /// Along the tangent.
    X,
    /// Along the bitangent.
    Y,
    /// Along the normal.
    Z,
    /// Azimuth from the view, rad.
    Azimuth,
}
