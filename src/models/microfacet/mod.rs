//! The shared body of every microfacet reflection model: `f = F(v) D(wh) G2(wo, wi) / (4 mu_o mu_i)`, `v = wo.wh`.
//!
//! Source: [Walter2007](crate::cite::WALTER_2007) Eq. 20. A model file names a [`Distribution`], a masking and a
//! [`Fresnel`] factor; everything else is here.

mod beckmann;
pub mod four;
mod fresnel;
mod ggx;
mod reduction;
mod student_t;

pub use crate::terms::beckmann::Beckmann;
pub use crate::terms::ggx::Ggx;
pub use crate::terms::student_t::StudentT;
pub use fresnel::Fresnel;

use super::{Brdf, DefaultValue, Functional, Param, ParamError, Params, Sample};
use crate::integrate::{BATCH, Chart, Estimate, FacetLobe, Nodes};
use crate::math::figures::exact;
use crate::math::frame;
use crate::terms::smith::Ndf;
use glam::{DVec2, DVec3};
use std::fmt::Debug;

/// How the masking of the two directions is combined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Masking {
    /// `G2 = 1 / (1 + Lambda(wo) + Lambda(wi))`, [Heitz2014](crate::cite::HEITZ_2014) Eq. 99.
    Correlated,
    /// `G2 = G1(wo) G1(wi)`, [Walter2007](crate::cite::WALTER_2007) Eq. 23.
    Separable,
}

/// What a model adds to a distribution of normals: how to integrate it, and a kernel over batches.
pub trait Distribution: Ndf {
    /// The widths along both tangents; 0 is the mirror.
    fn widths(&self) -> [f64; 2];

    /// The width, if it is the same along both tangents.
    fn alpha(&self) -> Option<f64> {
        let [x, y] = self.widths();
        ((x - y).abs() == 0.0).then_some(x)
    }

    /// D vanishes in f64 beyond `tan(theta) = reach * alpha`; infinite for a power-law tail.
    fn reach(&self) -> f64 {
        f64::INFINITY
    }

    /// What its chart knows of it.
    fn facets(&self) -> FacetLobe {
        FacetLobe::smith(self.widths(), self.reach())
    }

    /// `D V` at a batch of nodes.
    fn dv_nodes(&self, nodes: &Nodes, masking: Masking, out: &mut [f64; BATCH]) {
        default_dv_nodes(self, nodes, masking, out);
    }

    /// Part of the facets that the chart leaves out at a view cosine, because they are steeper than its finest scale.
    fn left_out(&self, _mu_o: f64) -> f64 {
        0.0
    }

    /// What the kernel of four views needs, if it knows the distribution.
    fn four(&self, _masking: Masking, _reflectances: [f64; 2]) -> Option<four::Facets> {
        None
    }

    /// White directional albedo by a one-dimensional reduction, if there is one.
    fn reduced_albedo(&self, _mu_o: f64, _masking: Masking, _tolerance: f64) -> Option<Estimate> {
        None
    }
}

/// `D V` at a batch of nodes by the terms.
fn default_dv_nodes<N: Ndf + ?Sized>(ndf: &N, nodes: &Nodes, masking: Masking, out: &mut [f64; BATCH]) {
    let wo = nodes.wo();
    for (i, o) in out[..nodes.len].iter_mut().enumerate() {
        *o = ndf.d(nodes.wh(i)) * masking.visibility(ndf, wo, nodes.wi(i));
    }
}

impl Masking {
    /// `G2 / (4 mu_o mu_i)` of a distribution.
    pub fn visibility<N: Ndf + ?Sized>(self, ndf: &N, wo: DVec3, wi: DVec3) -> f64 {
        match self {
            Masking::Correlated => ndf.visibility(wo, wi),
            Masking::Separable => ndf.visibility_separable(wo, wi),
        }
    }
}

/// A microfacet reflection.
#[derive(Debug)]
pub struct Microfacet<D: Distribution> {
    /// Normals and masking.
    pub distribution: D,
    /// True if the widths are 0: a mirror, without a density.
    pub flat: bool,
    /// How the masking is combined.
    pub masking: Masking,
    /// The Fresnel factor.
    pub fresnel: Fresnel,
}

impl<D: Distribution> Brdf for Microfacet<D> {
    fn eval(&self, wo: DVec3, wi: DVec3) -> f64 {
        if self.flat || !frame::both_above(wo, wi) {
            return 0.0;
        }
        let Some(h) = frame::half_vector(wo, wi) else { return 0.0 };
        self.fresnel.at(h.cos_d)
            * self.distribution.d(h.wh)
            * self.masking.visibility(&self.distribution, wo, wi)
    }

    fn sample(&self, wo: DVec3, u: DVec2) -> Option<Sample> {
        let wm = self.distribution.sample_visible(wo, u);
        let wi = frame::reflect(wo, wm);
        (wi.z > 0.0).then(|| Sample { wi, pdf: self.pdf(wo, wi) })
    }

    fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        match frame::half_vector(wo, wi) {
            Some(h) if frame::both_above(wo, wi) => self.distribution.d_visible(wo, h.wh) / (4.0 * h.cos_d),
            _ => 0.0,
        }
    }

    fn chart(&self) -> Option<Chart> {
        Some(Chart::facets(self.fresnel.marks(self.distribution.facets())))
    }

    fn turns(&self) -> bool {
        self.distribution.alpha().is_none()
    }

    fn eval_nodes(&self, nodes: &Nodes, out: &mut [f64; BATCH]) {
        self.distribution.dv_nodes(nodes, self.masking, out);
        self.fresnel.scale_nodes(nodes, out);
    }

    fn four(&self) -> Option<four::Facets> {
        match self.fresnel {
            Fresnel::Schlick { f0, f90 } if !self.flat => self.distribution.four(self.masking, [f0, f90]),
            _ => None,
        }
    }

    fn mirror(&self, mu_o: f64) -> Option<f64> {
        self.flat.then(|| self.fresnel.at(mu_o))
    }

    fn own_error(&self, mu_o: f64) -> f64 {
        self.distribution.left_out(mu_o)
    }

    fn reduced(&self, mu_o: f64, functionals: &[Functional], tolerance: f64) -> Option<Estimate> {
        let [Functional::One] = functionals else { return None };
        let constant = self.fresnel.constant()?;
        let mut e = self.distribution.reduced_albedo(mu_o, self.masking, tolerance)?;
        e.value[0] *= constant;
        e.error[0] *= constant;
        Some(e)
    }
}

/// `alpha`: width along both tangents; 0 is the mirror.
pub const ALPHA: Param = Param::number(
    "alpha",
    "alpha",
    "width of the distribution; alpha = roughness^2",
    [0.0, 2.0],
    DefaultValue::Value(0.25),
)
.also(&["m"]);
/// `alpha_x`.
pub const ALPHA_X: Param = Param::number(
    "alpha_x",
    "alpha_x",
    "width along the tangent; equal to alpha unless given",
    [0.0, 2.0],
    DefaultValue::Of("alpha"),
);
/// `alpha_y`.
pub const ALPHA_Y: Param = Param::number(
    "alpha_y",
    "alpha_y",
    "width along the bitangent; equal to alpha unless given",
    [0.0, 2.0],
    DefaultValue::Of("alpha"),
);
/// `masking`.
pub const MASKING: Param = Param::choice(
    "masking",
    "how Smith masking of the two directions is combined",
    &["correlated", "separable"],
);
/// `f0`.
pub const F0: Param =
    Param::number("f0", "F0", "reflectance at normal incidence", [0.0, 1.0], DefaultValue::Value(1.0))
        .also(&["F0"]);
/// `f90`.
pub const F90: Param =
    Param::number("f90", "F90", "reflectance at grazing incidence", [0.0, 1.0], DefaultValue::Value(1.0))
        .also(&["F90"]);
/// `eta` of a dielectric.
pub const ETA_DIELECTRIC: Param = Param::number(
    "eta",
    "eta",
    "relative index of refraction, below over above; below 1 from inside, with total internal reflection",
    [1e-3, 1e3],
    DefaultValue::Value(1.5),
)
.also(&["ior"]);
/// `eta` of a conductor.
pub const ETA_CONDUCTOR: Param = Param::number(
    "eta",
    "eta",
    "real part of the relative index of refraction",
    [1e-3, 1e3],
    DefaultValue::Value(0.2),
)
.also(&["n"]);
/// `outside` of a conductor.
pub const OUTSIDE: Param = Param::number(
    "outside",
    "eta_i",
    "index of the medium above, 1.5 for a coat of varnish: eta and k are divided by it",
    [0.1, 10.0],
    DefaultValue::Value(1.0),
);
/// `k` of a conductor.
pub const K: Param = Param::number(
    "k",
    "k",
    "extinction coefficient; 0 is a dielectric",
    [0.0, 1e3],
    DefaultValue::Value(3.9),
);

/// The masking that the parameters name.
///
/// # Errors
/// [`ParamError::Undeclared`] where none is declared.
pub fn masking(params: &Params) -> Result<Masking, ParamError> {
    let separable = params.choice("masking")? == "separable";
    Ok(if separable { Masking::Separable } else { Masking::Correlated })
}

/// The Fresnel factor of a conductor whose parameters are [`ETA_CONDUCTOR`], [`K`] and [`OUTSIDE`].
///
/// # Errors
/// [`ParamError::Undeclared`] where one of them is not declared.
pub fn conductor(params: &Params) -> Result<Fresnel, ParamError> {
    let [eta, k, outside] = params.numbers(["eta", "k", "outside"])?;
    Ok(Fresnel::Conductor { eta: eta / outside, k: k / outside })
}

/// Both widths: each zero or neither (a groove of zero width has no density along one axis only).
///
/// # Errors
/// [`ParamError::Together`] if just one is 0.
pub fn alphas(model: &'static str, params: &Params) -> Result<[f64; 2], ParamError> {
    let (x, y) = (params.number("alpha_x")?, params.number("alpha_y")?);
    if (x > 0.0) == (y > 0.0) {
        Ok([x, y])
    } else {
        let why = format!(
            "alpha_x = {} and alpha_y = {}: give both a width, or neither (the mirror)",
            exact(x),
            exact(y)
        );
        Err(ParamError::Together { model, why })
    }
}

/// Builds a boxed model from its parts.
///
/// # Errors
/// As [`alphas`].
pub fn build<D: Distribution + 'static>(
    model: &'static str,
    params: &Params,
    distribution: impl Fn(f64, f64) -> D,
    fresnel: Fresnel,
) -> Result<Box<dyn Brdf>, ParamError> {
    let [x, y] = alphas(model, params)?;
    Ok(Box::new(Microfacet {
        distribution: distribution(x, y),
        flat: x <= 0.0,
        masking: masking(params)?,
        fresnel,
    }))
}
