//! The integrand of each half-vector lobe, with its lines: written for [`crate::sweep::facets`], from terms in closed form.

use crate::sweep::draw::Draw;
use crate::sweep::facets::{Facets, Lines, Pair};
use crate::sweep::quad::{Setting, Sum, mark, sharp, sorted};
use brdfbake::math::special::cos_pow;
use brdfbake::models::Params;
use brdfbake::models::microfacet::{Beckmann, Fresnel, Ggx, Masking, StudentT};
use brdfbake::terms::smith::Ndf;
use brdfbake::terms::{charlie, clearcoat, gtr, schlick_masking, sggx, velvet};
use glam::DVec3;
use std::f64::consts::{FRAC_1_PI, PI};
use std::sync::Arc;

/// Where `exp(-rho^2)` has no digits left that matter.
pub(crate) const GAUSSIAN_END: f64 = 10.0;

/// A lobe bound to a view.
pub(crate) struct Lobe<'a> {
    alpha: [f64; 2],
    end: f64,
    tail: f64,
    lines: Lines,
    /// What is computed once for a view.
    view: Box<dyn Fn(DVec3) -> f64 + Sync + 'a>,
    f: Box<dyn Fn(&Pair) -> f64 + Sync + 'a>,
}

fn nothing(_: DVec3) -> f64 {
    0.0
}

impl Lobe<'_> {
    pub(crate) fn integrate(&self, mu: f64, phi: f64, setting: &Setting, tolerance: f64) -> Sum {
        let (alpha, end, tail, lines) = (self.alpha, self.end, self.tail, self.lines.clone());
        let phi = if alpha[0] == alpha[1] { 0.0 } else { phi };
        let sin = ((1.0 - mu) * (1.0 + mu)).sqrt();
        let view = (self.view)(DVec3::new(sin * phi.cos(), sin * phi.sin(), mu));
        Facets { mu, phi, alpha, end, tail, lines, view, f: &*self.f }.integrate(setting, tolerance)
    }
}

impl<'a> Lobe<'a> {
    /// The lobe times a function of wo.wh.
    pub(crate) fn times<'b>(self, weight: impl Fn(f64) -> f64 + Sync + 'b) -> Lobe<'b>
    where
        'a: 'b,
    {
        let f = self.f;
        Lobe { f: Box::new(move |p| weight(p.cos_d) * f(p)), ..self }
    }

    /// The lobe times a function of mu_i, with the lines of that.
    pub(crate) fn weighted<'b>(self, weight: &'b (dyn Fn(f64) -> f64 + Sync), lines: Vec<f64>) -> Lobe<'b>
    where
        'a: 'b,
    {
        let (f, mut all) = (self.f, self.lines);
        all.mu_i.extend(lines);
        Lobe {
            alpha: self.alpha,
            end: self.end,
            tail: self.tail,
            lines: all,
            view: self.view,
            f: Box::new(move |p| weight(p.mu_i) * f(p)),
        }
    }
}

/// A function of the pair and of what the lobe gives there.
pub(crate) fn over<'a>(lobe: Lobe<'a>, of: impl Fn(&Pair, f64) -> f64 + Sync + 'a) -> Lobe<'a> {
    let f = lobe.f;
    Lobe { f: Box::new(move |p| of(p, f(p))), end: f64::INFINITY, ..lobe }
}

/// The Fresnel factor of a model by its parameters, and the cosines at which it is not smooth.
pub(crate) fn fresnel(params: &Params) -> (Fresnel, Vec<f64>) {
    let Some(eta) = params.optional("eta") else {
        let number = |id: &str| params.number(id).unwrap();
        return (Fresnel::Schlick { f0: number("f0"), f90: number("f90") }, vec![]);
    };
    // relative to the medium above, where a model has one
    let outside = params.optional("outside").unwrap_or(1.0);
    let (eta, k) = (eta / outside, params.optional("k").map(|k| k / outside));
    let line = if eta < 1.0 { vec![((1.0 - eta) * (1.0 + eta)).sqrt()] } else { vec![] };
    let factor = k.map_or(Fresnel::Dielectric { eta }, |k| Fresnel::Conductor { eta, k });
    (factor, line)
}

/// Density of slopes over the widths, times rho^2 so that long tails do not underflow: `P22 ax ay rho^2`.
pub(crate) fn density(base: &str, gamma: f64) -> (fn(f64, f64) -> f64, f64, f64) {
    fn ggx(rho: f64, _: f64) -> f64 {
        let part = 1.0 / (rho + 1.0 / rho);
        FRAC_1_PI * part * part
    }
    fn beckmann(rho: f64, _: f64) -> f64 {
        FRAC_1_PI * (-rho * rho).exp() * rho * rho
    }
    fn student(rho: f64, gamma: f64) -> f64 {
        let b = gamma - 1.0;
        let log = if rho < 1e100 { (rho * rho / b).ln_1p() } else { 2.0 * rho.ln() - b.ln() };
        FRAC_1_PI * (2.0 * rho.ln() - gamma * log).exp()
    }
    match base {
        "ggx" => (ggx, f64::INFINITY, 1.0),
        "beckmann" => (beckmann, GAUSSIAN_END, 0.0),
        _ => (student, f64::INFINITY, 2.0 * gamma - 3.0),
    }
}

/// A microfacet lobe with Smith masking.
pub(crate) fn microfacet<'a>(
    base: &str,
    alpha: [f64; 2],
    gamma: f64,
    masking: Masking,
    (factor, line): (Fresnel, Vec<f64>),
) -> Lobe<'a> {
    let ndf: Arc<dyn Ndf> = match base {
        "ggx" => Arc::new(Ggx::new(alpha[0], alpha[1])),
        "beckmann" => Arc::new(Beckmann::new(alpha[0], alpha[1])),
        _ => Arc::new(StudentT::new(alpha[0], alpha[1], gamma)),
    };
    let (p22, end, tail) = density(base, gamma);
    let of_view = Arc::clone(&ndf);
    let f = move |p: &Pair| {
        let v = smith(masking, [p.mu_o, p.mu_i], [p.view, ndf.mu_lambda(p.wi)]);
        factor.at(p.cos_d) * p22(p.rho, gamma) * v * p.cosines() * p.slopes()
    };
    let view = Box::new(move |wo| of_view.mu_lambda(wo));
    Lobe { alpha, end, tail, lines: Lines { cos_d: line, ..Lines::default() }, view, f: Box::new(f) }
}

/// `G2 / (4 mu_o mu_i)` of two cosines and their `mu Lambda`.
fn smith(masking: Masking, [o, i]: [f64; 2], [hidden_o, hidden_i]: [f64; 2]) -> f64 {
    match masking {
        Masking::Correlated => 0.25 / (o * i + (o * hidden_i + i * hidden_o)),
        Masking::Separable => 0.25 / ((o + hidden_o) * (i + hidden_i)),
    }
}

/// Beckmann's distribution with the visibility and the lines given.
fn gaussian<'a>(
    alpha: f64,
    factor: Fresnel,
    lines: Lines,
    visibility: impl Fn(&Pair) -> f64 + Sync + 'a,
) -> Lobe<'a> {
    let (p22, end, tail) = density("beckmann", 0.0);
    let f = move |p: &Pair| factor.at(p.cos_d) * p22(p.rho, 0.0) * visibility(p) * p.slopes();
    Lobe { alpha: [alpha; 2], end, tail, lines, view: Box::new(nothing), f: Box::new(f) }
}

/// `V mu_i (wo.wh)` of V-cavities, `V = min(1, 2 h.z mu / v) / (4 mu_o mu_i)`.
fn grooves(p: &Pair) -> f64 {
    0.25 * (p.cos_d / p.mu_o).min(2.0 * p.wh.z * (p.mu_i / p.mu_o.max(p.mu_i)))
}

fn groove_lines() -> Lines {
    Lines { grooves: true, ..Lines::default() }
}

pub(crate) fn torrance_sparrow<'a>(alpha: f64, factor: Fresnel, scale: f64) -> Lobe<'a> {
    gaussian(alpha, factor, groove_lines(), move |p| scale * grooves(p))
}

pub(crate) fn kelemen<'a>(alpha: f64, factor: Fresnel, scale: f64) -> Lobe<'a> {
    gaussian(alpha, factor, Lines::default(), move |p| scale * 0.25 * p.mu_i / p.cos_d)
}

pub(crate) fn schlick_masked<'a>(alpha: f64, kind: &str, factor: Fresnel) -> Lobe<'a> {
    let kind = match kind {
        "ibl" => schlick_masking::K::Ibl,
        "analytic" => schlick_masking::K::Analytic,
        _ => schlick_masking::K::Schlick,
    };
    let k = schlick_masking::k(kind, alpha);
    let (p22, end, tail) = density("ggx", 2.0);
    let f = move |p: &Pair| {
        let v = schlick_masking::visibility(k, p.mu_o, p.mu_i);
        factor.at(p.cos_d) * p22(p.rho, 2.0) * v * p.cosines() * p.slopes()
    };
    Lobe { alpha: [alpha; 2], end, tail, lines: Lines::default(), view: Box::new(nothing), f: Box::new(f) }
}

/// A lobe with `f mu_i (wo.wh)` of its own.
fn general<'a>(alpha: [f64; 2], lines: Lines, f: impl Fn(&Pair) -> f64 + Sync + 'a) -> Lobe<'a> {
    let f = move |p: &Pair| f(p) * p.facets();
    Lobe { alpha, end: f64::INFINITY, tail: 0.0, lines, view: Box::new(nothing), f: Box::new(f) }
}

/// Slope width of `cos^n`.
fn width(n: f64) -> f64 {
    (2.0 / (n + 2.0)).sqrt()
}

fn power(p: &Pair, n: f64) -> f64 {
    let log = if p.r < 1e100 { 0.5 * (p.r * p.r).ln_1p() } else { p.r.ln() };
    (-n * log).exp()
}

/// `scale (n.wh)^n`, over mu_i if asked.
pub(crate) fn blinn<'a>(n: f64, scale: f64, over_cosine: bool) -> Lobe<'a> {
    general([width(n); 2], Lines::default(), move |p| {
        scale * power(p, n) * p.cos_d * if over_cosine { 1.0 } else { p.mu_i }
    })
}

pub(crate) fn blinn_microfacet<'a>(n: f64, factor: Fresnel) -> Lobe<'a> {
    general([width(n); 2], groove_lines(), move |p| {
        factor.at(p.cos_d) * (n + 2.0) / (2.0 * PI) * power(p, n) * grooves(p)
    })
}

/// `A (1 + b (1 - h.z))^(-c)` in grooves; A from the integral of `D cos`, by quadrature in `ln(1 - h.z)`.
pub(crate) fn abc<'a>(b: f64, c: f64, factor: Fresnel) -> Lobe<'a> {
    let fall = move |t: f64| (-c * (b * t).ln_1p()).exp();
    let edges = sorted(sharp(0.0), mark(1.0), [1.0 / b, 30.0 / b].map(mark).to_vec());
    let unit =
        crate::sweep::quad::SECOND.pieces(&edges, 0.0, &mut |at, _, _| (1.0 - at.x) * fall(at.x)).value;
    let peak = 0.5 / (PI * unit);
    let width = (2.0 / (b * (1.0 + (c - 2.0).max(0.0)))).sqrt().min(1.0);
    general([width; 2], groove_lines(), move |p| {
        // 1 - h.z = r^2 / (root (root + 1)), root = sqrt(1 + r^2)
        let root = p.r.hypot(1.0);
        factor.at(p.cos_d) * peak * fall((p.r / root) * (p.r / (root + 1.0))) * grooves(p)
    })
}

pub(crate) fn ashikhmin_shirley<'a>(rs: f64, nu: f64, nv: f64, mu: f64) -> Lobe<'a> {
    let scale = ((nu + 1.0) * (nv + 1.0)).sqrt() / (8.0 * PI);
    let factor = Fresnel::Schlick { f0: rs, f90: 1.0 };
    let lines = Lines { mu_i: vec![mu], ..Lines::default() };
    general([width(nu), width(nv)], lines, move |p| {
        let (x2, y2) = (p.wh.x * p.wh.x, p.wh.y * p.wh.y);
        let sin2 = x2 + y2;
        let e = if sin2 > 0.0 { nu * (x2 / sin2) + nv * (y2 / sin2) } else { 0.0 };
        scale * power(p, e) * factor.at(p.cos_d) * (p.mu_i / p.mu_o.max(p.mu_i))
    })
}

/// Ward's four.
pub(crate) fn ward<'a>(id: &str, alpha: [f64; 2]) -> Lobe<'a> {
    let alpha = alpha.map(|a| a.max(1e-7));
    let scale = 0.25 / (PI * alpha[0] * alpha[1]);
    let norm = id.to_owned();
    let mut lobe = general(alpha, Lines::default(), move |p| {
        let cos2 = p.wh.z * p.wh.z;
        let exact = scale * (-p.rho * p.rho).exp();
        let root = (p.mu_i / p.mu_o).sqrt();
        match norm.as_str() {
            "ward" => exact * root * p.cos_d,
            "ward-approximate" => {
                scale * (-2.0 * p.rho * p.rho * cos2 / (1.0 + p.wh.z)).exp() * root * p.cos_d
            }
            "ward-duer" => exact * (p.cos_d / p.mu_o),
            _ => exact * (p.mu_i / p.cos_d) / (cos2 * cos2),
        }
    });
    if id != "ward-approximate" {
        lobe.end = GAUSSIAN_END;
    }
    lobe
}

pub(crate) fn coat<'a>(gloss: f64, strength: f64) -> Lobe<'a> {
    let alpha = clearcoat::alpha(gloss);
    let factor = Fresnel::Schlick { f0: clearcoat::F0, f90: 1.0 };
    general([alpha; 2], Lines::default(), move |p| {
        let v = 0.25 * strength * (clearcoat::g(p.mu_o) * clearcoat::g(p.mu_i));
        factor.at(p.cos_d) * gtr::d(alpha, 1.0, p.wh) * v * p.cosines()
    })
}

/// Cloth: the widths are those of the cotangent.
fn cloth<'a>(rho: f64, mut lines: Lines, f: impl Fn(&Pair) -> f64 + Sync + 'a) -> Lobe<'a> {
    lines.rho.push(rho);
    general([1.0; 2], lines, f)
}

pub(crate) fn charlie<'a>(roughness: f64) -> Lobe<'a> {
    let lines = Lines { mu_i: vec![1e-7, 0.5], normal: true, ..Lines::default() };
    cloth((1.0 / roughness).sqrt(), lines, move |p| {
        let v = charlie::visibility(roughness, p.mu_o.max(1e-7), p.mu_i.max(1e-7));
        charlie_d(roughness, p) * v * p.cosines()
    })
}

fn charlie_d(roughness: f64, p: &Pair) -> f64 {
    let e = 1.0 / roughness;
    let sin2 = p.wh.x * p.wh.x + p.wh.y * p.wh.y;
    0.5 * FRAC_1_PI * (2.0 + e) * cos_pow(sin2.sqrt(), p.wh.z * p.wh.z, e)
}

pub(crate) fn charlie_neubelt<'a>(roughness: f64) -> Lobe<'a> {
    cloth((1.0 / roughness).sqrt(), Lines::default(), move |p| {
        charlie_d(roughness, p) * 0.25 * p.cosines() / (p.mu_o + p.mu_i * (1.0 - p.mu_o))
    })
}

pub(crate) fn velvet_ashikhmin<'a>(sigma: f64) -> Lobe<'a> {
    cloth(1.0 / sigma, groove_lines(), move |p| velvet::d_2000(sigma, p.wh) * grooves(p))
}

pub(crate) fn velvet_neubelt<'a>(alpha: f64, factor: Fresnel) -> Lobe<'a> {
    cloth(1.0 / alpha, Lines::default(), move |p| {
        factor.at(p.cos_d) * velvet::d_2007(alpha, p.wh) * 0.25 * p.cosines()
            / (p.mu_o + p.mu_i * (1.0 - p.mu_o))
    })
}

pub(crate) fn fibres<'a>(sigma: f64) -> Lobe<'a> {
    cloth(1.0 / sigma, Lines::default(), move |p| {
        let area = sggx::projected_area(sigma, p.wi) * p.mu_o + sggx::projected_area(sigma, p.wo) * p.mu_i;
        let depth = area / (p.mu_o * p.mu_i);
        0.25 * sggx::d(sigma, p.wh) * -(-depth).exp_m1() * (p.cosines() / area)
    })
}

/// GTR with the masking of its own distribution, given as a curve.
pub(crate) fn gtr_lobe<'a>(
    alpha: f64,
    gamma: f64,
    masking: Masking,
    factor: Fresnel,
    of_view: impl Fn(f64) -> f64 + Sync + 'a,
    mu_lambda: impl Fn(f64) -> f64 + Sync + 'a,
) -> Lobe<'a> {
    let mut lobe = general([alpha; 2], Lines::default(), move |p| {
        let v = smith(masking, [p.mu_o, p.mu_i], [p.view, mu_lambda(p.mu_i)]);
        factor.at(p.cos_d) * gtr::d(alpha, gamma, p.wh) * v * p.cosines()
    });
    lobe.view = Box::new(move |wo| of_view(wo.z));
    lobe
}

/// `mu Lambda(mu)` of GTR: `int D(m) max(0, -w.m) dm` by azimuth: with the cosine z of m and t of the horizon of w,
/// `int max(0, -(s r cos p + mu z)) dp = 2 (s r sin e - mu z e)`, `e = acos(mu z / (s r))`, r the sine of m.
pub(crate) fn gtr_mu_lambda(alpha: f64, gamma: f64, mu: f64, setting: &Setting) -> f64 {
    let s = ((1.0 - mu) * (1.0 + mu)).sqrt();
    if s <= 0.0 {
        return 0.0;
    }
    // slopes beyond cot(theta): z = 1/sqrt(1 + t^2)
    let from = mu / s;
    let d = |t: f64| gtr::d(alpha, gamma, DVec3::new(t, 0.0, 1.0) / t.hypot(1.0));
    let breaks = sorted(sharp(from), mark(1e60), [alpha, 1.0, 2.0 * from, from + alpha].map(mark).to_vec());
    let peak =
        crate::sweep::quad::COARSE.pieces(&breaks, 0.0, &mut |at, _, _| shape(&d, s, mu, from, at.x)).value;
    setting.pieces(&breaks, 1e-14 * peak, &mut |at, _, _| shape(&d, s, mu, from, at.x)).value
}

fn shape(d: &dyn Fn(f64) -> f64, s: f64, mu: f64, from: f64, t: f64) -> f64 {
    let root = t.hypot(1.0);
    let off = ((t - from) * (t + from)).max(0.0).sqrt();
    // e = acos(from / t), sin e = off / t; s t sin e - mu e without cancellation
    let e = off.atan2(from);
    let area = if e < 0.05 {
        // mu (tan e - e)
        let e2 = e * e;
        mu * e
            * e2
            * (1.0 / 3.0
                + e2 * (2.0 / 15.0 + e2 * (17.0 / 315.0 + e2 * (62.0 / 2835.0 + e2 * 1382.0 / 155_925.0))))
    } else {
        s * off - mu * e
    };
    2.0 * d(t) * area / root * (t / root) / (root * root)
}

/// The density of visible normals as directions that they reflect to: `D max(0, wo.wm) / (mu_o + mu_o Lambda) dwm`.
pub(crate) fn visible<'a>(base: &str, alpha: f64) -> Lobe<'a> {
    let ndf: Box<dyn Ndf> =
        if base == "ggx" { Box::new(Ggx::isotropic(alpha)) } else { Box::new(Beckmann::isotropic(alpha)) };
    let (p22, end, tail) = density(base, 2.0);
    // f mu_i dwi = 4 V mu_i (wo.wm) D dwm: here 4 V mu_i is 1 / (mu_o + hidden)
    let f = move |p: &Pair| p22(p.rho, 2.0) * (0.25 * p.cos_d / (p.mu_o + p.view)) * p.slopes();
    let view = Box::new(move |wo| ndf.mu_lambda(wo));
    Lobe { alpha: [alpha; 2], end, tail, lines: Lines::default(), view, f: Box::new(f) }
}

/// f of an isotropic facet lobe from the angle of the half vector, `wo.wh`, and both cosines.
pub(crate) fn value(draw: &Draw, alpha: f64, [theta_h, cos_d]: [f64; 2], [o, i]: [f64; 2]) -> f64 {
    let p = &draw.params;
    let factor = fresnel(p).0.at(cos_d);
    let (tan, cos) = (theta_h.tan(), theta_h.cos());
    let rho = tan / alpha;
    let base = if draw.model.id == "ggx" { "ggx" } else { "beckmann" };
    let (p22, ..) = density(base, 2.0);
    let d = p22(rho, 2.0) / (rho * rho * alpha * alpha * cos.powi(4));
    let d = if rho > 0.0 { d } else { FRAC_1_PI / (alpha * alpha) };
    let hidden = |mu: f64| {
        let w = DVec3::new(((1.0 - mu) * (1.0 + mu)).max(0.0).sqrt(), 0.0, mu);
        if base == "ggx" {
            Ggx::isotropic(alpha).mu_lambda(w)
        } else {
            Beckmann::isotropic(alpha).mu_lambda(w)
        }
    };
    let v = match draw.model.id {
        "kelemen" => 0.25 / (cos_d * cos_d),
        "torrance-sparrow" => 0.25 * (1.0 / (o * i)).min(2.0 * cos / (cos_d * o.max(i))),
        _ => smith(crate::sweep::truth::masking(p), [o, i], [hidden(o), hidden(i)]),
    };
    factor * d * v
}
