//! Models at their extremes: values, densities, reciprocity, energy, estimates.

use super::grid::{AZIMUTHS, COSINES, sets};
use super::{ALLOWED, LEAST_DIGITS, Stress, noise};
use crate::cancel::{Cancel, Cancelled};
use crate::integrate::View;
use crate::models::{Brdf, ModelInfo};
use crate::tables::integral::{Functional, integrate};
use crate::verify::cross_check::estimate;
use crate::verify::honest;
use crate::verify::seeds::Seeds;
use crate::verify::survey::RECIPROCAL;
use glam::{DVec2, DVec3};

/// View cosines at which albedos are integrated.
const VIEWS: [f64; 5] = [1.0, 0.5, 0.1, 1e-3, 1e-8];
/// Tolerance of the albedos.
const TOLERANCE: f64 = 1e-5;
/// Albedos of each model that an independent rule judges, seeded.
const JUDGED: usize = 6;
/// Scramblings, and points of each, of the draws that are asked before an estimate is blamed.
const REPLICATES: u32 = 16;
const POINTS: u32 = 512;
/// How many estimates an albedo may be off, and how many times its own estimate the error of the rule is taken to be.
const ESTIMATES: f64 = 3.0;
const DOUBT: f64 = 2.0;
/// Values below this are what is left of a vanished tail.
const NEGLIGIBLE: f64 = 1e-20;

struct Walk<'a> {
    info: &'static ModelInfo,
    cancel: &'a Cancel,
    found: Stress,
}

/// An albedo that an independent rule can be asked for.
struct Integrated {
    set: usize,
    mu: f64,
    value: f64,
    error: f64,
}

pub(super) fn stress(info: &'static ModelInfo, cancel: &Cancel) -> Result<Stress, Cancelled> {
    let mut walk = Walk { info, cancel, found: Stress::new("model", info.id) };
    let sets = sets(info.id, info.params);
    let mut integrated = Vec::new();
    let mut models = Vec::new();
    for (i, (label, params)) in sets.iter().enumerate() {
        cancel.check()?;
        let model = match (info.build)(params) {
            Ok(model) => model,
            Err(_) => {
                // numbers that are in range each by itself, and not together
                walk.found.refused += 1;
                models.push(None);
                continue;
            }
        };
        walk.pairs(&*model, label);
        walk.samples(&*model, label);
        walk.albedos(&*model, label, i, &mut integrated)?;
        models.push(Some(model));
    }
    let mut seeds = Seeds::new(0x4041);
    for _ in 0..JUDGED.min(integrated.len()) {
        let one = &integrated[seeds.index(integrated.len())];
        if let Some(Some(model)) = models.get(one.set) {
            walk.judge(&**model, &sets[one.set].0, one);
        }
    }
    Ok(walk.found)
}

impl Walk<'_> {
    fn pairs(&mut self, model: &dyn Brdf, label: &str) {
        for (i, mu_o) in COSINES.into_iter().enumerate() {
            let wo = direction(mu_o, 0.0);
            let mut lights: Vec<DVec3> = Vec::new();
            // views and lights near each other in the list: every cosine is met with every azimuth
            for (k, phi) in AZIMUTHS.into_iter().enumerate() {
                lights.push(direction(COSINES[(i + k) % COSINES.len()], phi));
            }
            lights.push(DVec3::new(-wo.x, -wo.y, wo.z));
            lights.push(turned(DVec3::new(-wo.x, -wo.y, wo.z), 1e-7));
            lights.push(wo);
            for wi in lights {
                self.pair(model, label, wo, wi);
            }
        }
    }

    fn pair(&mut self, model: &dyn Brdf, label: &str, wo: DVec3, wi: DVec3) {
        let at = || {
            format!("{label}, mu_o = {:e}, mu_i = {:e}, phi = {:.3e}", wo.z, wi.z, libm::atan2(wi.y, wi.x))
        };
        let f = model.eval(wo, wi);
        let pdf = model.pdf(wo, wi);
        self.found.points += 1;
        for (what, v) in [("f", f), ("pdf", pdf)] {
            if !v.is_finite() {
                self.found.blame("not finite", format!("{what} = {v}"), at);
            } else if v < 0.0 {
                self.found.blame("negative", format!("{what} = {v:e}"), at);
            }
        }
        if !f.is_finite() || f < NEGLIGIBLE {
            return;
        }
        if self.info.laws.reciprocal {
            let back = model.eval(wi, wo);
            let off = (f - back).abs() / f.max(back);
            let condition = condition(|h| model.eval(wo, turned(wi, h)), f)
                .max(condition(|h| model.eval(turned(wo, h), wi), f));
            let allowed = (ALLOWED * condition * f64::EPSILON).max(RECIPROCAL);
            if off.is_nan() || off > allowed {
                let message = format!(
                    "f(wo, wi) and f(wi, wo) differ by {off:.1e} of their value, {allowed:.1e} is rounding"
                );
                self.found.blame("not reciprocal", message, at);
            }
        }
        let along = |h: f64| Some(model.eval(wo, turned(wi, h))).filter(|v| v.is_finite());
        if let Some(kept) = noise::digits(along, 0.0, 1.0) {
            self.found.digits(kept, at);
            if kept < LEAST_DIGITS {
                self.found.blame(
                    "digits lost",
                    format!("{kept:.1} of {:.1} digits kept", noise::MOST_DIGITS),
                    at,
                );
            }
        }
    }

    fn samples(&mut self, model: &dyn Brdf, label: &str) {
        let edge = 1e-9;
        for mu in [1.0, 0.5, 1e-3, 1e-8] {
            let wo = direction(mu, 0.3);
            for u in [
                DVec2::splat(edge),
                DVec2::splat(0.5),
                DVec2::splat(1.0 - edge),
                DVec2::new(edge, 1.0 - edge),
            ] {
                let Some(s) = model.sample(wo, u) else { continue };
                let at = || format!("{label}, mu_o = {mu:e}, u = ({:e}, {:e})", u.x, u.y);
                self.found.points += 1;
                let unit = (s.wi.length() - 1.0).abs() <= 1e-9;
                if !(s.pdf.is_finite() && s.pdf >= 0.0 && unit && s.wi.is_finite()) {
                    let message =
                        format!("a drawn direction of length {:e} with pdf {:e}", s.wi.length(), s.pdf);
                    self.found.blame("bad sample", message, at);
                }
            }
        }
    }

    fn albedos(
        &mut self,
        model: &dyn Brdf,
        label: &str,
        set: usize,
        all: &mut Vec<Integrated>,
    ) -> Result<(), Cancelled> {
        for mu in VIEWS {
            self.cancel.check()?;
            let at = || format!("{label}, mu = {mu:e}");
            self.found.points += 1;
            let e = match integrate(model, mu, &[Functional::One], TOLERANCE) {
                Ok(e) => e,
                Err(e) => {
                    // a model that claims no energy law may diverge
                    if self.info.laws.passive {
                        self.found.blame("no albedo", e.to_string(), at);
                    } else {
                        self.found.refused += 1;
                    }
                    continue;
                }
            };
            let (value, error) = (e.value[0], e.error[0]);
            self.found.evaluated(e.evaluations, at);
            if self.info.laws.passive && value - error > 1.0 + 1e-12 {
                self.found.blame("energy gained", format!("E = {value:.9} +- {error:.1e}"), at);
            }
            if value < -error {
                self.found.blame("negative", format!("E = {value:e} +- {error:.1e}"), at);
            }
            all.push(Integrated { set, mu, value, error });
        }
        Ok(())
    }

    /// An estimate against the rule of the law `honest`.
    fn judge(&mut self, model: &dyn Brdf, label: &str, one: &Integrated) {
        let aim = (0.5 * one.error).max(1e-6);
        let Some(truth) = honest::albedo(model, View::from(one.mu), aim) else { return };
        let (value, doubt) = (truth.value, DOUBT * truth.error);
        // a rule that is not sure judges nothing
        if doubt.is_nan() || doubt > one.error.max(TOLERANCE) {
            return;
        }
        let off = (value - one.value).abs();
        // a rule that has passed by a narrow lobe refutes nothing: draws of the model must refute the value, too
        let [drawn] = estimate(model, one.mu, [Functional::One], 0x4041, REPLICATES, POINTS);
        let unseen = 2.0 / f64::from(REPLICATES * POINTS);
        if (drawn.mean - one.value).abs() <= 6.0 * drawn.standard_error + one.error + unseen {
            return;
        }
        if off > ESTIMATES * one.error.max(1e-13) + doubt {
            let (v, e) = (one.value, one.error);
            let message =
                format!("E = {v:.9} +- {e:.1e}, an independent rule finds {value:.9} +- {doubt:.1e}");
            self.found.blame("dishonest estimate", message, || format!("{label}, mu = {:e}", one.mu));
        }
    }
}

/// Relative change of `f` for a relative change of its direction, at the steepest of a few distances.
fn condition(f: impl Fn(f64) -> f64, value: f64) -> f64 {
    let slope = [1e-12, 1e-10, 1e-8, 1e-6]
        .into_iter()
        .map(|h| (f(h) - value).abs().max((f(-h) - value).abs()) / h)
        .filter(|s| s.is_finite())
        .fold(0.0, f64::max);
    1.0 + slope / value
}

fn direction(mu: f64, phi: f64) -> DVec3 {
    let sin = ((1.0 - mu) * (1.0 + mu)).sqrt();
    let (s, c) = libm::sincos(phi);
    DVec3::new(sin * c, sin * s, mu)
}

/// A direction turned by a small angle towards or from the normal; above the horizon.
fn turned(w: DVec3, angle: f64) -> DVec3 {
    let flat = libm::hypot(w.x, w.y);
    let (s, c) = libm::sincos(angle);
    if flat == 0.0 {
        return DVec3::new(s.abs(), 0.0, c);
    }
    // towards the horizon, and back where that would be below it
    let (s, c) = if w.z * c - flat * s < 0.0 { (-s, c) } else { (s, c) };
    let (z, out) = (w.z * c - flat * s, flat * c + w.z * s);
    DVec3::new(w.x / flat * out, w.y / flat * out, z)
}
