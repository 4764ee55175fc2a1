//! From a point of the grid to a model: which axis is the view cosine, which ones are parameters.

use super::role::Side;
use super::{BindError, Spec, TexelError, finite};
use crate::integrate::{Estimate, View};
use crate::math::lanes::LANES;
use crate::models::integral::integrate_four;
use crate::models::{Brdf, Functional, ModelInfo, Params};
use std::f64::consts::TAU;

/// Models with their integrals.
pub type Four = Vec<(Box<dyn Brdf>, Result<Estimate, TexelError>)>;

/// A model whose parameters follow the axes of a grid.
#[derive(Debug, Clone)]
pub struct Sweep {
    info: &'static ModelInfo,
    params: Params,
    /// Axis number of the view cosine, if one sweeps it.
    mu: Option<usize>,
    /// Axis number of the view azimuth, if one sweeps it.
    phi: Option<usize>,
    /// Axis number of the rotation of the tangent, if one sweeps it.
    rotation: Option<usize>,
    /// Axis number of glTF's strength of anisotropy, if one sweeps it.
    anisotropy: Option<usize>,
    /// Axis number and parameter id of the swept parameters.
    swept: Vec<(usize, &'static str)>,
}

impl Sweep {
    /// From a spec that has a model. `white` sets `f0 = f90 = 1`, for tables that split the Fresnel factor off.
    ///
    /// # Errors
    /// [`BindError::Model`] if the spec has none.
    pub fn new(spec: &Spec, white: bool) -> Result<Sweep, BindError> {
        let missing = || BindError::Model { kind: spec.kind.id, model: String::new(), why: "is missing" };
        let (info, params) = spec.model.as_ref().ok_or_else(missing)?;
        let mut params = params.clone();
        if white {
            params.set("f0", 1.0);
            params.set("f90", 1.0);
        }
        let mut sweep =
            Sweep { info, params, mu: None, phi: None, rotation: None, anisotropy: None, swept: Vec::new() };
        for (i, axis) in spec.grid.axes().iter().enumerate() {
            match axis.quantity.base_id() {
                "mu" => sweep.mu = Some(i),
                "phi" => sweep.phi = Some(i),
                "rotation" => sweep.rotation = Some(i),
                "anisotropy" => sweep.anisotropy = Some(i),
                // an axis that the model has no parameter for is one of the table kind
                id => sweep.swept.extend(info.measured(id).map(|p| (i, p.id))),
            }
        }
        Ok(sweep)
    }

    /// The model that is swept.
    #[must_use]
    pub fn info(&self) -> &'static ModelInfo {
        self.info
    }

    /// View cosine at a point (1 if no axis sweeps it).
    #[must_use]
    pub fn mu(&self, at: &[f64]) -> f64 {
        self.mu.map_or(1.0, |i| at[i])
    }

    /// View at a point: its cosine, and its azimuth from the tangent of the grooves (0 if no axis sweeps it).
    #[must_use]
    pub fn view(&self, at: &[f64]) -> View {
        let phi = self.phi.map_or(0.0, |i| at[i]) - self.rotation.map_or(0.0, |i| at[i]);
        View { mu: self.mu(at), phi: if phi < 0.0 { phi + TAU } else { phi } }
    }

    /// Parameters at a point.
    ///
    /// # Errors
    /// [`ParamError`](crate::models::ParamError) for an axis of none.
    pub fn params(&self, at: &[f64]) -> Result<Params, crate::models::ParamError> {
        let mut params = self.params.clone();
        for &(i, id) in &self.swept {
            let before = params.number(id)?;
            params.set(id, at[i]);
            // alpha_x and alpha_y follow alpha, nv follows nu, unless they were set apart
            for other in self.info.followers(id) {
                if (params.number(other)? - before).abs() == 0.0 {
                    params.set(other, at[i]);
                }
            }
        }
        if let Some(i) = self.anisotropy {
            let (alpha, strength) = (params.number("alpha")?, at[i]);
            params.set("alpha_x", alpha + (1.0 - alpha) * strength * strength);
            params.set("alpha_y", alpha);
        }
        Ok(params)
    }

    /// The rule that integrates the model, in words.
    #[must_use]
    pub fn rule(&self) -> String {
        let Ok(model) = (self.info.build)(&self.params) else {
            return "none: the model refuses the parameters".to_owned();
        };
        if model.parts().is_some() {
            return "Gauss-Legendre in the charts of its lobes".to_owned();
        }
        model.chart().map_or("adaptive subdivision", |c| c.name()).to_owned()
    }

    /// The model at a point.
    ///
    /// # Errors
    /// [`TexelError::Param`] where the model refuses the parameters.
    pub fn model(&self, at: &[f64]) -> Result<Box<dyn Brdf>, TexelError> {
        Ok((self.info.build)(&self.params(at)?)?)
    }

    /// The models at four points and their integrals, if the kernel of four views serves them; what is left of a group at the end of a
    /// table is filled up with its last point.
    #[must_use]
    pub fn four(&self, at: &[&[f64]], functionals: &[Functional], tolerance: f64) -> Option<Four> {
        let mut models = Vec::with_capacity(LANES);
        let mut mu = [0.0; LANES];
        for (i, mu) in mu.iter_mut().enumerate() {
            let at = at.get(i).or(at.last())?;
            let model = self.model(at).ok()?;
            // a model that the kernel does not know is not built four times to find that out
            model.four()?;
            models.push(model);
            *mu = self.mu(at);
        }
        let [a, b, c, d] = &models[..] else { return None };
        let four = integrate_four([&**a, &**b, &**c, &**d], mu, functionals, tolerance)?;
        Some(models.into_iter().zip(four.map(|e| finite(e, functionals.len()))).collect())
    }

    /// The model at a point from above or from inside, where its relative index is 1 / eta.
    ///
    /// # Errors
    /// [`TexelError::Param`] where the model refuses the parameters.
    pub fn model_from(&self, at: &[f64], side: Side) -> Result<Box<dyn Brdf>, TexelError> {
        let mut params = self.params(at)?;
        if side == Side::Inside
            && let Some(eta) = params.optional("eta")
        {
            params.set("eta", 1.0 / eta);
        }
        Ok((self.info.build)(&params)?)
    }

    /// Refuses a model that is a mirror with its fixed parameters, for tables that have no use for a delta.
    ///
    /// # Errors
    /// [`BindError::Model`] with `why`; [`BindError::Param`] where the model refuses its fixed parameters.
    pub fn refuse_mirrors(&self, kind: &'static str, why: &'static str) -> Result<(), BindError> {
        let model = (self.info.build)(&self.params)?;
        match model.mirror(1.0) {
            Some(_) => Err(BindError::Model { kind, model: self.info.id.to_owned(), why }),
            None => Ok(()),
        }
    }

    /// Does light cross the surface?
    ///
    /// # Errors
    /// [`BindError::Param`] where the model refuses its fixed parameters.
    pub fn transmits(&self) -> Result<bool, BindError> {
        Ok((self.info.build)(&self.params)?.transmission().is_some())
    }
}
