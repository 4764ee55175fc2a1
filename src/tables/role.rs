//! What the number of a channel is. The list is closed: a law that matches on it cannot take one quantity for another, and a
//! baker that is given a role that it does not know refuses to bind.

use super::integral::Functional;
pub use super::parts::{Band, Component, Distance, Entry, Fitted, Glow, Light, Per, Polarisation, Side};
use super::{OwnNumber, Spec};
use crate::models::{Brdf, ModelInfo, ParamError, Params};

/// The lobe that a channel is an integral of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Lobe {
    /// The model of the table as its parameters make it.
    Model,
    /// The model without its Fresnel factor (f0 = f90 = 1) where that can be split off; else as it is.
    White,
    /// A lobe that shares the axes of the table, but not its model.
    Other(&'static OtherLobe),
}

/// A lobe of its own beside the model of a table.
#[derive(Debug)]
pub struct OtherLobe {
    /// Its model.
    pub info: &'static ModelInfo,
    /// The parameter that follows the width of the table, and how.
    pub param: &'static str,
    /// From alpha to the parameter.
    pub from_alpha: fn(f64) -> f64,
}

impl PartialEq for OtherLobe {
    fn eq(&self, other: &OtherLobe) -> bool {
        self.info.id == other.info.id && self.param == other.param
    }
}

impl OtherLobe {
    /// The lobe at a width.
    ///
    /// # Errors
    /// [`ParamError`] where the model refuses it.
    pub fn build(&self, alpha: f64) -> Result<Box<dyn Brdf>, ParamError> {
        let mut params = Params::resolve(self.info.id, self.info.params, [])?;
        // not bounded by the range of the parameter, which is that of sensible materials
        params.set(self.param, (self.from_alpha)(alpha));
        (self.info.build)(&params)
    }
}

impl Lobe {
    /// The registry entry of the lobe, if the table has one.
    #[must_use]
    pub fn info(self, spec: &Spec) -> Option<&'static ModelInfo> {
        match self {
            Lobe::Model | Lobe::White => spec.model.as_ref().map(|(info, _)| *info),
            Lobe::Other(other) => Some(other.info),
        }
    }

    /// Is the Fresnel factor taken off?
    #[must_use]
    pub fn is_white(self, spec: &Spec) -> bool {
        self == Lobe::White && spec.model.as_ref().is_some_and(|(info, _)| info.splits)
    }
}

/// The Fresnel weight of a part of a split albedo, a function of v = wo.wh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Weight {
    /// 1: the white albedo itself.
    One,
    /// (1 - v)^5.
    Schlick,
    /// 1 - (1 - v)^5.
    SchlickComplement,
    /// v (1 - v)^6 over its value at 1/7.
    F82,
    /// The curve that the table's own parameters name.
    Curve,
}

impl Weight {
    /// As a functional; none for a curve, which the kind must name.
    #[must_use]
    pub const fn functional(self) -> Option<Functional> {
        match self {
            Weight::One => Some(Functional::One),
            Weight::Schlick => Some(Functional::Schlick),
            Weight::SchlickComplement => Some(Functional::SchlickComplement),
            Weight::F82 => Some(Functional::F82),
            Weight::Curve => None,
        }
    }
}

/// What a channel is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Role {
    /// The part of the light along a view that leaves a lobe.
    Albedo(Lobe, Light, Side),
    /// The albedo of a lobe over a divisor, kept in the range of the channel.
    KeptAlbedo(Lobe, f64),
    /// `factor int f w(v) mu_i dwi`: a part of an albedo with its Fresnel weight.
    Split(Lobe, Weight, f64),
    /// `int f ((1 - v)^5 - (1 - mu)^5) mu_i dwi`.
    SplitRest(Lobe),
    /// `int f w mu_i dwi / int f mu_i dwi` of the table's curve.
    SplitMean(Lobe),
    /// `int w p dwi` of the table's curve, p the density of the model's own sampler.
    SampledMean(Lobe),
    /// 1 - E.
    Complement(Lobe, Side),
    /// `max(0, 1 - s E)`, s a parameter of the kind.
    Scaling(Lobe),
    /// 1 / E - 1.
    Gain(Lobe),
    /// (1 - E) / sqrt(pi (1 - E_avg)).
    CompensationLobe(Lobe),
    /// `2 int E mu dmu`.
    Average(Lobe, Light, Side),
    /// 1 - E_avg.
    AverageComplement(Lobe, Side),
    /// The reflected share of the light that energy compensation adds.
    ReflectedShare(Lobe, Side),
    /// An entry of the matrix of a transformed cosine that was fitted to a lobe.
    Matrix(Lobe, Entry),
    /// How far that fit is from the lobe.
    FitDistance(Lobe, Fitted, Distance),
    /// The form factor of a sphere over the texture's own coordinates.
    SphereForm,
    /// 0: not used.
    Unused,
    /// The value f of a lobe.
    Value(Lobe, Band),
    /// A component of the direction that two numbers choose.
    Direction(Lobe, Component),
    /// The density of that direction, 1/sr.
    DirectionDensity(Lobe),
    /// A Fresnel factor of a smooth dielectric.
    Dielectric(Polarisation, Side),
    /// A Fresnel factor of a metal at a wavelength.
    Metal(Polarisation, Band),
    /// The F82-tint curve through a Fresnel factor of a metal.
    MetalTint(Band),
    /// The colour of a metal in daylight.
    MetalColour(Band),
    /// A Fresnel factor in closed form, clamped or not.
    FresnelForm {
        /// Kept in [0, 1]?
        clamped: bool,
    },
    /// The colour of a film in daylight.
    FilmColour(Band),
    /// The same by a series of a few orders.
    FilmSeries(Band),
    /// A transform of a colour-matching function: x, y or z, real or imaginary part.
    Sensitivity {
        /// 0, 1, 2: x, y, z.
        component: usize,
        /// The imaginary part?
        imaginary: bool,
    },
    /// The colour of a black body.
    BlackBody(Glow, Band),
    /// A distribution of facet normals; relative: times pi alpha^2.
    Distribution {
        /// Times pi alpha^2?
        relative: bool,
    },
    /// Half the tenth root of pi times a distribution of normals.
    DistributionRoot,
    /// G1.
    Masking,
    /// G2.
    MaskingShadowing,
    /// G2 / (4 mu_o mu_i).
    Visibility,
    /// Light on a ball, blurred by a diffusion profile.
    BlurredLight(Band),
    /// A diffusion profile.
    Profile(Per, Band),
    /// Its part inside a radius.
    ProfileWithin(Band),
    /// Its part beyond a factor times a thickness.
    ProfileBeyond(f64, Band),
    /// The radius inside which a part of it lies.
    ProfileRadius(Band),
    /// Its line integral.
    Kernel(Band),
    /// The part of the line integral within a distance to either side.
    KernelWithin(Band),
    /// A variance of a sum of Gaussians.
    Variance,
    /// A weight of a sum of Gaussians.
    GaussianWeight(Band),
    /// What a sum of Gaussians leaves of a profile.
    GaussianResidual(Band),
    /// A phase function; relative: over its largest value.
    Phase {
        /// Over its largest value?
        relative: bool,
    },
    /// The deflection inside which a part of the light lies, as a cosine or an angle.
    PhaseQuantile {
        /// An angle?
        angle: bool,
    },
    /// What passes a medium.
    Passed(Band),
    /// What a medium takes.
    Lost(Band),
    /// The albedo of a layer of fibres; coded: over a scale, at most 1.
    FibreAlbedo(Option<f64>),
    /// A parameter of the lobe fitted to such a layer; coded: (p - from) / length, kept in [0, 1].
    FibreLobe(Entry, Option<[f64; 2]>),
    /// How far that lobe is from the layer.
    FibreDistance,
    /// A number that only one kind has, with its own rule.
    Own(&'static OwnNumber),
}

impl Role {
    /// The lobe that the channel is an integral, a sample or a fit of.
    #[must_use]
    pub const fn lobe(self) -> Option<Lobe> {
        match self {
            Role::Albedo(lobe, ..)
            | Role::KeptAlbedo(lobe, _)
            | Role::Split(lobe, ..)
            | Role::SplitRest(lobe)
            | Role::SplitMean(lobe)
            | Role::SampledMean(lobe)
            | Role::Complement(lobe, _)
            | Role::Scaling(lobe)
            | Role::Gain(lobe)
            | Role::CompensationLobe(lobe)
            | Role::Average(lobe, ..)
            | Role::AverageComplement(lobe, _)
            | Role::ReflectedShare(lobe, _)
            | Role::Matrix(lobe, _)
            | Role::FitDistance(lobe, ..)
            | Role::Value(lobe, _)
            | Role::Direction(lobe, _)
            | Role::DirectionDensity(lobe) => Some(lobe),
            _ => None,
        }
    }

    /// The role in words, as in files and reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Role::Albedo(_, Light::Transmitted, _) => "transmitted albedo",
            Role::Albedo(_, Light::Reflected, _) => "reflected albedo",
            Role::Albedo(_, Light::All, _) => "albedo",
            Role::KeptAlbedo(..) => "albedo, scaled and kept in a range",
            Role::Split(_, Weight::One, _) => "split part, weight 1",
            Role::Split(_, Weight::Schlick, _) => "split part, Schlick weight",
            Role::Split(_, Weight::SchlickComplement, _) => "split part, complement of the Schlick weight",
            Role::Split(_, Weight::F82, _) => "split part, F82 weight",
            Role::Split(_, Weight::Curve, _) => "split part, weight of a curve",
            Role::SplitRest(_) => "split part without the mirror's",
            Role::SplitMean(_) => "mean Fresnel weight",
            Role::SampledMean(_) => "mean Fresnel weight of a sampler",
            Role::Complement(..) => "complement",
            Role::Scaling(_) => "complement of a scaled albedo",
            Role::Gain(_) => "gain",
            Role::CompensationLobe(_) => "compensation lobe",
            Role::Average(_, Light::Transmitted, _) => "average of the transmitted albedo",
            Role::Average(_, Light::Reflected, _) => "average of the reflected albedo",
            Role::Average(_, Light::All, _) => "average",
            Role::AverageComplement(..) => "complement of the average",
            Role::ReflectedShare(..) => "reflected share",
            Role::Matrix(..) => "matrix entry",
            Role::FitDistance(..) | Role::FibreDistance => "distance of a fit",
            Role::SphereForm => "form factor",
            Role::Unused => "unused",
            Role::Value(..) => "value",
            Role::Direction(..) => "direction",
            Role::DirectionDensity(_) => "density",
            Role::Dielectric(..) | Role::Metal(..) | Role::MetalTint(_) | Role::FresnelForm { .. } => {
                "Fresnel factor"
            }
            Role::MetalColour(_) | Role::FilmColour(_) | Role::FilmSeries(_) | Role::BlackBody(..) => {
                "colour"
            }
            Role::Sensitivity { .. } => "transform of the eye",
            Role::Distribution { .. } => "distribution of normals",
            Role::DistributionRoot => "tenth root of a distribution of normals",
            Role::Masking => "masking",
            Role::MaskingShadowing => "masking and shadowing",
            Role::Visibility => "visibility",
            Role::BlurredLight(_) => "blurred light",
            Role::Profile(..) => "profile",
            Role::ProfileWithin(_) | Role::KernelWithin(_) => "cumulative distribution",
            Role::ProfileBeyond(..) | Role::Passed(_) => "transmittance",
            Role::ProfileRadius(_) | Role::PhaseQuantile { .. } => "quantile",
            Role::Kernel(_) => "kernel",
            Role::Variance => "variance",
            Role::GaussianWeight(_) => "weight",
            Role::GaussianResidual(_) => "residual",
            Role::Phase { .. } => "phase function",
            Role::Lost(_) => "loss",
            Role::FibreAlbedo(_) => "albedo of a layer",
            Role::FibreLobe(..) => "fitted parameter",
            Role::Own(own) => own.name,
        }
    }

    /// Along which quantity the channel rises (1) or falls (-1) from texel to texel.
    #[must_use]
    pub const fn trend(self) -> Option<(&'static str, f64)> {
        match self {
            Role::Masking => Some(("mu", 1.0)),
            Role::ProfileWithin(_) => Some(("radius", 1.0)),
            Role::ProfileBeyond(..) => Some(("thickness", -1.0)),
            Role::ProfileRadius(_) => Some(("u", 1.0)),
            Role::Kernel(_) => Some(("offset", -1.0)),
            Role::KernelWithin(_) => Some(("offset", 1.0)),
            Role::Passed(_) => Some(("path", -1.0)),
            Role::Lost(_) => Some(("path", 1.0)),
            Role::PhaseQuantile { angle } => Some(("u", if angle { -1.0 } else { 1.0 })),
            // theta rises with u
            Role::Direction(_, Component::Z) => Some(("u", -1.0)),
            Role::Own(own) => own.trend,
            _ => None,
        }
    }
}
