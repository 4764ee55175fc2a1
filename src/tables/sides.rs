//! Reflected and transmitted parts of the light along a view, from above the surface and from inside.
//!
//! A channel is named `e` (all that leaves the surface), `r` (reflected) or `t` (transmitted), with `.inside` for a view from
//! below an interface, where the relative index is 1 / eta. Averages have `-avg` in the middle: `t-avg.inside`.

use super::integral::{Functional, integrate};
use super::sweep::Sweep;
use super::{BindError, Spec, TexelError};
use crate::integrate::{Estimate, MAX_CHANNELS, View};
use crate::models::Brdf;

/// Which light a channel counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Part {
    All,
    Reflected,
    Transmitted,
}

/// What a channel holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Wanted {
    part: Part,
    inside: bool,
}

impl Wanted {
    fn of(channel: &str) -> Wanted {
        let (name, inside) = channel.strip_suffix(".inside").map_or((channel, false), |name| (name, true));
        let part = match name.as_bytes().first() {
            Some(b'r') => Part::Reflected,
            Some(b't') => Part::Transmitted,
            _ => Part::All,
        };
        Wanted { part, inside }
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
    /// From a spec whose channels are named as above.
    ///
    /// # Errors
    /// [`BindError::Model`] if a channel asks for light that the model does not have.
    pub(super) fn new(spec: &Spec) -> Result<Sides, BindError> {
        let wanted: Vec<Wanted> = spec.layout.ids().map(Wanted::of).collect();
        let sweep = Sweep::new(spec, false)?;
        let refuse = |why| BindError::Model { kind: spec.kind.id, model: sweep.info().id.to_owned(), why };
        if wanted.iter().any(|w| w.inside) && sweep.info().param("eta").is_none() {
            return Err(refuse("has no parameter eta, so it has no inside"));
        }
        if wanted.iter().any(|w| w.part == Part::Transmitted) && !sweep.transmits()? {
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
        self.wanted.iter().any(|w| w.inside)
    }

    /// The models at a point.
    ///
    /// # Errors
    /// [`TexelError::Param`].
    pub(super) fn models(&self, at: &[f64]) -> Result<Models, TexelError> {
        let build = |inside| {
            let any = self.wanted.iter().any(|w| w.inside == inside);
            any.then(|| self.sweep.model_from(at, inside)).transpose()
        };
        Ok(Models([build(false)?, build(true)?]))
    }

    /// The channels at a view, each to the tolerance; reflection and transmission are integrated once for all of them.
    ///
    /// # Errors
    /// [`TexelError`].
    pub(super) fn at(&self, models: &Models, view: View, tolerance: f64) -> Result<Estimate, TexelError> {
        let mut all = Estimate { value: [0.0; MAX_CHANNELS], error: [0.0; MAX_CHANNELS], evaluations: 0 };
        for (inside, model) in [false, true].into_iter().zip(&models.0) {
            let Some(model) = model else { continue };
            let wants = |part| self.wanted.contains(&Wanted { part, inside });
            let through = model.transmission().is_some();
            // R and T share the tolerance of their sum
            let each = if through && wants(Part::All) { 0.5 * tolerance } else { tolerance };
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
            let r = part(wants(Part::All) || wants(Part::Reflected), false)?;
            let t = part(through && (wants(Part::All) || wants(Part::Transmitted)), true)?;
            for (c, wanted) in self.wanted.iter().enumerate().filter(|(_, w)| w.inside == inside) {
                (all.value[c], all.error[c]) = match wanted.part {
                    Part::All => (r.0 + t.0, r.1 + t.1),
                    Part::Reflected => r,
                    Part::Transmitted => t,
                };
            }
        }
        Ok(all)
    }
}

/// R: the part of the light along the view that leaves on its side.
pub(super) fn reflected(model: &dyn Brdf, view: View, tolerance: f64) -> Result<Estimate, TexelError> {
    integrate(model, view, &[Functional::One], tolerance)
}

/// T: the part that crosses.
///
/// # Errors
/// [`TexelError::NoRule`] for an interface whose widths differ.
pub(super) fn crossing(model: &dyn Brdf, view: View, tolerance: f64) -> Result<Estimate, TexelError> {
    let none = TexelError::NoRule { what: "the transmitted part of an anisotropic interface" };
    let e = model.transmission().and_then(|t| t.albedo(view.mu, tolerance)).ok_or(none)?;
    if e.value[0].is_finite() && e.error[0].is_finite() {
        return Ok(e);
    }
    Err(TexelError::NotFinite { channel: 0, value: e.value[0] })
}
