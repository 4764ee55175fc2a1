//! Reflected and transmitted parts of the light along a view, from above the surface and from inside.
//!
//! Which part and which side a channel counts is said by its [`Role`]; from inside the relative index is 1 / eta.

use super::integral::{Functional, integrate};
use super::role::{Light, Role, Side};
use super::sweep::Sweep;
use super::{BindError, Spec, TexelError, finite};
use crate::integrate::{Estimate, MAX_CHANNELS, View};
use crate::models::Brdf;

/// What a channel holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Wanted {
    part: Light,
    side: Side,
    /// What is missing of 1?
    lost: bool,
}

impl Wanted {
    fn of(role: Role) -> Option<Wanted> {
        match role {
            Role::Albedo(_, part, side) | Role::Average(_, part, side) => {
                Some(Wanted { part, side, lost: false })
            }
            Role::Complement(_, side) | Role::AverageComplement(_, side) => {
                Some(Wanted { part: Light::All, side, lost: true })
            }
            _ => None,
        }
    }
}

/// The parts of a swept model that the channels of a table want.
#[derive(Debug)]
pub(super) struct Sides {
    pub(super) sweep: Sweep,
    wanted: Vec<Wanted>,
}

/// The models of a point: from above and from inside, where they are wanted.
#[derive(Debug)]
pub(super) struct Models([Option<Box<dyn Brdf>>; 2]);

impl Models {
    /// True if a value depends on the azimuth of the view.
    pub(super) fn turns(&self) -> bool {
        self.0.iter().flatten().any(|m| m.turns())
    }
}

impl Sides {
    /// From a spec whose channels are albedos or averages.
    ///
    /// # Errors
    /// [`BindError::Model`] if a channel asks for light that the model does not have.
    pub(super) fn new(spec: &Spec) -> Result<Sides, BindError> {
        let wanted = spec.each(Wanted::of)?;
        let sweep = Sweep::new(spec, false)?;
        let refuse = |why| BindError::Model { kind: spec.kind.id, model: sweep.info().id.to_owned(), why };
        if wanted.iter().any(|w| w.side == Side::Inside) && sweep.info().param("eta").is_none() {
            return Err(refuse("has no parameter eta, so it has no inside"));
        }
        if wanted.iter().any(|w| w.part == Light::Transmitted) && !sweep.transmits()? {
            return Err(refuse("does not transmit; all its light is in channel e or e-avg"));
        }
        Ok(Sides { sweep, wanted })
    }

    /// Number of channels.
    pub(super) fn channels(&self) -> usize {
        self.wanted.len()
    }

    /// True if some channel is seen from inside.
    pub(super) fn inside(&self) -> bool {
        self.wanted.iter().any(|w| w.side == Side::Inside)
    }

    /// The models at a point.
    ///
    /// # Errors
    /// [`TexelError::Param`].
    pub(super) fn models(&self, at: &[f64]) -> Result<Models, TexelError> {
        let build = |side| {
            let any = self.wanted.iter().any(|w| w.side == side);
            any.then(|| self.sweep.model_from(at, side)).transpose()
        };
        Ok(Models([build(Side::Above)?, build(Side::Inside)?]))
    }

    /// The channels at a view, each to the tolerance; reflection and transmission are integrated once for all of them.
    ///
    /// # Errors
    /// [`TexelError`].
    pub(super) fn at(&self, models: &Models, view: View, tolerance: f64) -> Result<Estimate, TexelError> {
        let mut all = Estimate { value: [0.0; MAX_CHANNELS], error: [0.0; MAX_CHANNELS], evaluations: 0 };
        for (side, model) in [Side::Above, Side::Inside].into_iter().zip(&models.0) {
            let Some(model) = model else { continue };
            let wants = |part| self.wanted.iter().any(|w| w.part == part && w.side == side);
            let through = model.transmission().is_some();
            // R and T share the tolerance of their sum
            let each = if through && wants(Light::All) { 0.5 * tolerance } else { tolerance };
            let mut part = |wanted: bool, transmitted: bool| -> Result<(f64, f64), TexelError> {
                if !wanted {
                    return Ok((0.0, 0.0));
                }
                let e = if transmitted {
                    crossing(&**model, view, each)
                } else {
                    reflected(&**model, view, each)
                }?;
                all.evaluations = all.evaluations.saturating_add(e.evaluations);
                Ok((e.value[0], e.error[0]))
            };
            let r = part(wants(Light::All) || wants(Light::Reflected), false)?;
            let t = part(through && (wants(Light::All) || wants(Light::Transmitted)), true)?;
            for (c, wanted) in self.wanted.iter().enumerate().filter(|(_, w)| w.side == side) {
                (all.value[c], all.error[c]) = match wanted.part {
                    Light::All => (r.0 + t.0, r.1 + t.1),
                    Light::Reflected => r,
                    Light::Transmitted => t,
                };
                if wanted.lost {
                    // the errors of quadrature may put E a little above 1
                    all.value[c] = (1.0 - all.value[c]).max(0.0);
                }
            }
        }
        Ok(all)
    }
}

/// R: the part of the light along the view that leaves on its side.
pub(super) fn reflected(model: &dyn Brdf, view: View, tolerance: f64) -> Result<Estimate, TexelError> {
    integrate(model, view, &[Functional::One], tolerance)
}

/// T: the part that crosses; 0 of a model that does not transmit.
///
/// # Errors
/// [`TexelError::NotFinite`].
pub(super) fn crossing(model: &dyn Brdf, view: View, tolerance: f64) -> Result<Estimate, TexelError> {
    finite(model.transmission().map_or(Estimate::ZERO, |t| t.albedo(view, tolerance)), 1)
}
