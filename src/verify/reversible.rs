//! Light retraces its path: F at an angle from one side equals F at the refracted angle from the other.

use super::{Case, Law, Outcome, Watch, seeds};
use crate::tables::role::{Polarisation, Side};
use crate::tables::{Role, Spec, place};
use crate::terms::fresnel;

/// The law.
pub static LAW: Law = Law {
    id: "fresnel-reversible",
    statement: "F(mu, eta) = F(mu_t, 1 / eta), mu_t the cosine of the refracted ray",
    margin: "what roundings of the refracted sine change, plus the error estimate and 1e-14, minus the difference; smallest of 256 texels",
    code: 3002,
    formal: false,
    concerns: |spec| {
        channels(spec).next().is_some() && spec.axis("mu").is_some() && spec.axis("eta").is_some()
    },
    check,
};

/// Roundings of sin^2 of the refracted ray: of the cosine, of the index, and of the quotient.
const ROUNDINGS: f64 = 8.0;

fn channels(spec: &Spec) -> impl Iterator<Item = (usize, Polarisation, Side)> + '_ {
    spec.layout.channels.iter().enumerate().filter_map(|(c, channel)| match channel.role {
        Role::Dielectric(p, side) => Some((c, p, side)),
        _ => None,
    })
}

fn check(case: &Case<'_>) -> Outcome {
    let (grid, spec) = (&case.table.grid, case.spec());
    let (Some(mu), Some(eta)) = (spec.axis("mu"), spec.axis("eta")) else {
        return Outcome::NotChecked("no axis of angle or index".to_owned());
    };
    let mut watch = Watch::default();
    for texel in seeds::texels(case.table, 256, 0xf5e5).into_iter().take_while(|_| case.goes_on()) {
        let point = grid.texel(texel);
        for (c, p, side) in channels(spec) {
            let (mu, eta) = (point.values()[mu], point.values()[eta]);
            let eta = if side == Side::Inside { 1.0 / eta } else { eta };
            let (f, error) = case.at(texel, c);
            let sin2 = (1.0 - mu) * (1.0 + mu) / (eta * eta);
            // within a rounding of the critical angle the two sides may disagree on which it is
            let step = ROUNDINGS * f64::EPSILON * sin2.max(1.0);
            let back = [sin2 - step, sin2, sin2 + step].map(|sin2| back(sin2, eta, p));
            let resolved = (back[0] - back[1]).abs() + (back[2] - back[1]).abs();
            watch.see(resolved + error + 1e-14 - (f - back[1]).abs(), || {
                format!(
                    "{} = {f:.12} against {:.12}, {}",
                    case.table.channels[c].id,
                    back[1],
                    place(grid, texel)
                )
            });
        }
    }
    watch.outcome("no texel")
}

/// F of the ray that comes back; beyond sin^2 = 1 there is none, and all is reflected.
fn back(sin2: f64, eta: f64, p: Polarisation) -> f64 {
    if sin2 > 1.0 {
        return 1.0;
    }
    let f = fresnel::dielectric((1.0 - sin2).sqrt(), 1.0 / eta);
    match p {
        Polarisation::S => f.s,
        Polarisation::P => f.p,
        Polarisation::None => f.unpolarised(),
    }
}
