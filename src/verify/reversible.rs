//! Light retraces its path: F at an angle from one side equals F at the refracted angle from the other.

use super::{Case, Law, Outcome, seeds};
use crate::tables::place;
use crate::terms::fresnel;

/// The law.
pub static LAW: Law = Law {
    id: "fresnel-reversible",
    statement: "F(mu, eta) = F(mu_t, 1 / eta), mu_t the cosine of the refracted ray",
    margin: "1e-7 minus the difference, smallest of 256 texels (the refracted cosine has a square-root edge)",
    code: 3002,
    check,
};

fn check(case: &Case<'_>) -> Outcome {
    let grid = &case.table.grid;
    let spec = &case.bound.spec;
    let (Some(mu), Some(eta)) = (spec.axis("mu"), spec.axis("eta")) else {
        return Outcome::vacuous("no angle or index axis");
    };
    let Some(channel) =
        case.table.channels.iter().position(|c| c.id == "fresnel.f" || c.id == "fresnel.outside")
    else {
        return Outcome::vacuous("no unpolarised channel");
    };
    let mut outcome = Outcome::start();
    for texel in seeds::texels(case.table, 256, 0xf5e5).into_iter().take_while(|_| case.goes_on()) {
        let point = grid.texel(texel);
        let (mu, eta) = (point.values()[mu], point.values()[eta]);
        let f = case.table.at(texel)[channel];
        // sin^2 of the refracted ray; beyond 1 there is none, and all is reflected
        let sin2 = (1.0 - mu) * (1.0 + mu) / (eta * eta);
        let back =
            if sin2 > 1.0 { 1.0 } else { fresnel::dielectric((1.0 - sin2).sqrt(), 1.0 / eta).unpolarised() };
        // within a rounding of the critical angle the two sides may disagree on which it is
        if (sin2 - 1.0).abs() > 1e-12 && mu > 1e-6 {
            outcome.tighten(1e-7 - (f - back).abs(), || {
                format!("{f:.12} against {back:.12}, {}", place(grid, texel))
            });
        }
    }
    outcome
}
