//! Fresnel factors by their amplitudes in the angles of Snell's law, with what rounding does to them.

use super::Truth;
use crate::math::complex::Complex;
use crate::tables::metal::Index;
use crate::tables::role::{Polarisation, Side};
use crate::tables::{Role, Spec};
use crate::terms::metals;

/// Roundings of a sine and of a square root that a factor must bear.
const ROUNDINGS: f64 = 4.0 * f64::EPSILON;

/// A number and what rounding may have done to it.
pub(super) type Rounded = Truth;

/// Both polarisations.
#[derive(Debug, Clone, Copy)]
pub(super) struct Factors {
    s: Rounded,
    p: Rounded,
}

impl Factors {
    /// Of unpolarised light.
    pub(super) fn mean(self) -> Rounded {
        Truth { value: 0.5 * (self.s.value + self.p.value), error: 0.5 * (self.s.error + self.p.error) }
    }

    /// Of a polarisation.
    pub(super) fn of(self, p: Polarisation) -> Rounded {
        match p {
            Polarisation::S => self.s,
            Polarisation::P => self.p,
            Polarisation::None => self.mean(),
        }
    }
}

/// Of a smooth dielectric: `r_s = (c - eta c') / (c + eta c')`, `r_p = (eta c - c') / (eta c + c')`, c' the refracted cosine.
pub(super) fn dielectric(cos: f64, eta: f64) -> Factors {
    let sin2 = (1.0 - cos) * (1.0 + cos) / (eta * eta);
    let at = |sin2: f64| {
        if sin2 >= 1.0 {
            return [1.0, 1.0];
        }
        let refracted = (1.0 - sin2).sqrt();
        let s = (cos - eta * refracted) / (cos + eta * refracted);
        let p = (eta * cos - refracted) / (eta * cos + refracted);
        [s * s, p * p]
    };
    // at grazing with equal indices nothing separates the media
    if sin2 < 1.0 && cos + eta * (1.0 - sin2).sqrt() <= 0.0 {
        return Factors { s: Truth { value: 0.0, error: 1.0 }, p: Truth { value: 0.0, error: 1.0 } };
    }
    spread(at, sin2, sin2)
}

/// The factors at a squared sine, with what roundings of terms of a size change.
fn spread(at: impl Fn(f64) -> [f64; 2], sin2: f64, size: f64) -> Factors {
    let step = ROUNDINGS * size.max(1e-3);
    let [here, below, above] = [sin2, sin2 - step, sin2 + step].map(at);
    let one = |i: usize| Truth {
        value: here[i],
        error: (below[i] - here[i]).abs() + (above[i] - here[i]).abs() + ROUNDINGS,
    };
    Factors { s: one(0), p: one(1) }
}

/// Of a conductor, in complex amplitudes.
pub(super) fn conductor(cos: f64, n: f64, k: f64) -> Factors {
    let square = Complex::new(n * n - k * k, 2.0 * n * k);
    let at = |sin2: f64| {
        let q = (square - Complex::real(sin2)).sqrt_upper();
        let ratio = |a: Complex, b: Complex| {
            let r = (a - q).norm2() / (b + q).norm2();
            if r.is_nan() { 0.0 } else { r.min(1.0) }
        };
        let along = square.scale(cos);
        [ratio(Complex::real(cos), Complex::real(cos)), ratio(along, along)]
    };
    spread(at, (1.0 - cos) * (1.0 + cos), 1.0 + n * n + k * k)
}

/// A Fresnel factor of a dielectric over angle and index.
pub(super) fn of_dielectric(spec: &Spec, p: Polarisation, side: Side, at: &[f64]) -> Option<Truth> {
    let (mu, eta) = (at[spec.axis("mu")?], at[spec.axis("eta")?]);
    let eta = if side == Side::Inside { 1.0 / eta } else { eta };
    // 1 / eta is rounded once more
    let mut truth = dielectric(mu, eta).of(p);
    let moved = dielectric(mu, eta * (1.0 + f64::EPSILON)).of(p).value;
    truth.error += (moved - truth.value).abs();
    Some(truth)
}

/// A Fresnel factor of a metal.
///
/// `mu` is the cosine; `band` tells which number of a list is meant.
pub(super) fn of_metal(
    spec: &Spec,
    p: Polarisation,
    (mu, band, lambda_nm): (f64, usize, f64),
    at: &[f64],
) -> Option<Truth> {
    let number = |id: &str| spec.number(id, at).ok();
    let index = Index::of(&spec.params, ["n", "k"]).ok()?;
    let (mut n, mut k) = index.at(band, lambda_nm);
    if matches!(index, Index::Given { .. }) {
        let swept = |id: &str, fixed: f64| spec.axis(id).map_or(fixed, |i| at[i]);
        (n, k) = (swept("n", n), swept("k", k));
    }
    let eta = number("eta")?;
    let own = conductor(mu, n / eta, k / eta).of(p);
    // quotients are rounded
    let moved = conductor(mu, n / eta * (1.0 + f64::EPSILON), k / eta).of(p).value - own.value;
    Some(Truth { value: own.value, error: own.error + 2.0 * moved.abs() })
}

/// A factor in closed form.
pub(super) fn of_form(spec: &Spec, clamped: bool, at: &[f64]) -> Option<Truth> {
    let mu = at[spec.axis("mu")?];
    let number = |id: &str| spec.number(id, at).ok();
    let fall = 1.0 - mu;
    let lerp = |f0: f64, f90: f64, w: f64| f0 * (1.0 - w) + f90 * w;
    let normal = |n: f64, k: f64| {
        let r = Complex::new(n - 1.0, k).over(Complex::new(n + 1.0, k)).norm2();
        if r.is_nan() { 1.0 } else { r }
    };
    let mut size = 1.0;
    let f = match spec.params.choice("variant").ok()? {
        "generalised" => lerp(number("f0")?, number("f90")?, libm::pow(fall, number("exponent")?)),
        "f82-tint" => {
            let at_82 = lerp(number("f0")?, 1.0, libm::pow(6.0 / 7.0, 5.0));
            let b = at_82 * (1.0 - number("tint")?) * 7.0 * libm::pow(7.0 / 6.0, 6.0);
            size += b;
            lerp(number("f0")?, 1.0, libm::pow(fall, 5.0)) - b * mu * libm::pow(fall, 6.0)
        }
        "lazanyi" => {
            let (a, q) = (number("a")?, number("q")?);
            size += a;
            lerp(normal(number("n")?, number("k")?), 1.0, libm::pow(fall, 5.0)) - a * mu * libm::pow(fall, q)
        }
        "dielectric" => return Some(of_schlick_dielectric(mu, number("eta")?)),
        _ => lerp(number("f0")?, number("f90")?, libm::pow(fall, 5.0)),
    };
    let value = if clamped { f.clamp(0.0, 1.0) } else { f };
    Some(Truth { value, error: 8.0 * f64::EPSILON * size })
}

/// Schlick's form of a dielectric: from the denser side in the refracted cosine.
fn of_schlick_dielectric(mu: f64, eta: f64) -> Truth {
    let f0 = libm::pow((eta - 1.0) / (eta + 1.0), 2.0);
    let sin2 = (1.0 - mu) * (1.0 + mu) / (eta * eta);
    let at = |sin2: f64| {
        let cos = if eta < 1.0 { (1.0 - sin2).max(0.0).sqrt() } else { mu };
        let f = if eta < 1.0 && sin2 >= 1.0 { 1.0 } else { f0 + (1.0 - f0) * libm::pow(1.0 - cos, 5.0) };
        [f, f]
    };
    spread(at, sin2, sin2).mean()
}

/// The curve through F at cosines 1 and 1/7.
fn of_tint(spec: &Spec, band: usize, at: &[f64]) -> Option<Truth> {
    let mu = at[spec.axis("mu")?];
    let f = |mu: f64| of_metal(spec, Polarisation::None, (mu, band, metals::RGB_NM[band]), at);
    let (f0, f82) = (f(1.0)?, f(1.0 / 7.0)?);
    let curve = |mu: f64| f0.value + (1.0 - f0.value) * libm::pow(1.0 - mu, 5.0);
    let dip = |mu: f64| mu * libm::pow(1.0 - mu, 6.0);
    // what is left at 1/7 goes with the dip
    let part = dip(mu) / dip(1.0 / 7.0);
    let value = curve(mu) - (curve(1.0 / 7.0) - f82.value) * part;
    let error = 2.0 * f0.error + f82.error + 16.0 * f64::EPSILON;
    Some(Truth { value: value.clamp(0.0, 1.0), error })
}

/// Roles of this file.
pub(super) fn truth(role: Role, spec: &Spec, at: &[f64]) -> Option<Truth> {
    match role {
        Role::Dielectric(p, side) => of_dielectric(spec, p, side, at),
        Role::Metal(p, band) => {
            let mu = at[spec.axis("mu")?];
            of_metal(spec, p, (mu, band.index(), metals::RGB_NM[band.index()]), at)
        }
        Role::MetalTint(band) => of_tint(spec, band.index(), at),
        Role::FresnelForm { clamped } => of_form(spec, clamped, at),
        _ => None,
    }
}
