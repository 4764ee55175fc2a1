//! Directional albedo: the fraction of light from a uniform sky, or of light along wo, that a surface reflects.

use super::integral::{Functional, integrate};
use super::sweep::Sweep;
use super::{Baker, BindError, ChannelInfo, Layout, ModelUse, Spec, TableInfo, TexelError};
use crate::cite;
use crate::grid::Axis;
use crate::integrate::Estimate;

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "albedo",
    title: "Directional albedo E",
    formula: "E(mu) = int f(wo, wi) mu_i dwi",
    sources: &[(cite::KULLA_CONTY_2017, "slide 'Directional albedo'")],
    coordinates: &["mu"],
    layouts: &[Layout {
        id: "e",
        doc: "the directional albedo",
        channels: &[ChannelInfo { id: "e", meaning: "int f(wo, wi) mu_i dwi", range: [0.0, 1.0] }],
    }],
    extra: &[],
    model: ModelUse::Any("ggx"),
    params: &[],
    laws: &["finite", "range", "energy", "cross-check", "reciprocity"],
    axes: default_axes,
    notes: "Axes: mu, phi (the view azimuth, for anisotropic models), and any number parameter of the model (alpha or roughness, f0, eta, ...).",
    bind,
};

fn default_axes() -> Vec<Axis> {
    super::dfg::view_and_roughness(32)
}

struct Albedo {
    sweep: Sweep,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    Ok(Box::new(Albedo { sweep: Sweep::new(spec, false)? }))
}

impl Baker for Albedo {
    fn texel(&self, at: &[f64], tolerance: f64) -> Result<Estimate, TexelError> {
        let model = self.sweep.model(at)?;
        integrate(&*model, self.sweep.view(at), &[Functional::One], tolerance)
    }

    fn rule(&self) -> String {
        format!("one-dimensional reduction where the model has one; else {}", self.sweep.rule())
    }
}
