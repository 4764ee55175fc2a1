//! Channels that are linear in integrals of a lobe over directions: `constant + sum factor int f g(wo.wh) mu_i dwi`.

use crate::integrate::View;
use crate::tables::integral::Functional;
use crate::tables::role::{Light, Lobe, Side};
use crate::tables::{Role, Spec};

/// Such a channel at a view.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Linear {
    pub(super) lobe: Lobe,
    pub(super) side: Side,
    /// Which light the integrals count; weights other than 1 are of reflected light.
    pub(super) light: Light,
    pub(super) constant: f64,
    pub(super) terms: Vec<(Functional, f64)>,
}

impl Linear {
    /// A channel by its role; none if it is not linear in such integrals.
    pub(super) fn of(role: Role, spec: &Spec, view: View, at: &[f64]) -> Option<Linear> {
        let one = |lobe, side, light, constant, factor| Linear {
            lobe,
            side,
            light,
            constant,
            terms: vec![(Functional::One, factor)],
        };
        Some(match role {
            Role::Albedo(lobe, light, side) => one(lobe, side, light, 0.0, 1.0),
            Role::Complement(lobe, side) => one(lobe, side, Light::All, 1.0, -1.0),
            Role::Split(lobe, weight, factor) => {
                let g = weight.functional().or_else(|| curve(spec, at))?;
                Linear { terms: vec![(g, factor)], ..one(lobe, Side::Above, Light::Reflected, 0.0, 1.0) }
            }
            Role::SplitRest(lobe) => {
                let m = 1.0 - view.mu;
                let terms = vec![(Functional::Schlick, 1.0), (Functional::One, -(m * m * m * m * m))];
                Linear { terms, ..one(lobe, Side::Above, Light::Reflected, 0.0, 1.0) }
            }
            _ => return None,
        })
    }
}

/// Is a channel linear in integrals of its lobe?
pub(super) fn is_linear(role: Role) -> bool {
    matches!(role, Role::Albedo(..) | Role::Complement(..) | Role::Split(..) | Role::SplitRest(_))
}

/// The curve of [`Weight::Curve`](crate::tables::role::Weight::Curve) that the parameters of a kind name, at a point.
pub(super) fn curve(spec: &Spec, at: &[f64]) -> Option<Functional> {
    let number = |id: &str| spec.number(id, at).ok();
    Some(match spec.params.choice("curve").ok()? {
        "dielectric" => Functional::Dielectric(number("eta")?),
        _ => Functional::Power(number("exponent")?),
    })
}
