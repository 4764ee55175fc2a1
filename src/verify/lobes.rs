//! The lobe that a channel is an integral of, at a point of a table.

use crate::integrate::View;
use crate::models::Brdf;
use crate::tables::role::{Lobe, Side};
use crate::tables::{Spec, sweep::Sweep};

/// The lobes of a table.
#[derive(Debug)]
pub(super) struct Lobes {
    model: Option<Sweep>,
    white: Option<Sweep>,
    alpha: Option<usize>,
}

impl Lobes {
    pub(super) fn new(spec: &Spec) -> Lobes {
        let sweep = |white| Sweep::new(spec, white).ok();
        Lobes { model: sweep(false), white: sweep(Lobe::White.is_white(spec)), alpha: spec.axis("alpha") }
    }

    /// The lobe at a point; none where it cannot be built.
    pub(super) fn build(&self, lobe: Lobe, at: &[f64], side: Side) -> Option<Box<dyn Brdf>> {
        match lobe {
            Lobe::Model => self.model.as_ref()?.model_from(at, side).ok(),
            Lobe::White => self.white.as_ref()?.model_from(at, side).ok(),
            Lobe::Other(other) => other.build(at[self.alpha?]).ok(),
        }
    }

    /// The view at a point; a lobe beside the model is isotropic, and the azimuth does not matter.
    pub(super) fn view(&self, lobe: Lobe, at: &[f64]) -> View {
        let view = self.model.as_ref().map_or(View::from(1.0), |s| s.view(at));
        if matches!(lobe, Lobe::Other(_)) { view.in_plane() } else { view }
    }

    /// The swept model, with or without its Fresnel factor.
    pub(super) fn sweep(&self, lobe: Lobe) -> Option<&Sweep> {
        match lobe {
            Lobe::Model => self.model.as_ref(),
            Lobe::White => self.white.as_ref(),
            Lobe::Other(_) => None,
        }
    }
}

/// The lobes that the channels of a table are of, each once.
pub(super) fn lobes_of(spec: &Spec) -> Vec<Lobe> {
    let mut lobes: Vec<Lobe> = Vec::new();
    for lobe in spec.layout.channels.iter().filter_map(|c| c.role.lobe()) {
        if !lobes.contains(&lobe) {
            lobes.push(lobe);
        }
    }
    lobes
}
