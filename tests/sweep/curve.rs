//! Curves over the cosine, and the models that are made of them.

use crate::draw::Draw;
use crate::lobe;
use crate::lobes;
use crate::quad::{self, Setting, two_settings};
use crate::truth::{f_avg, masking, once, schlick_of};
use brdfbake::models::microfacet::{Fresnel, Masking};
use std::f64::consts::{FRAC_1_PI, PI};

/// Nodes of a panel.
const ORDER: usize = 24;

/// A function of the cosine as polynomials in w on panels, `mu = 1/(1 + e^-w)`: its behaviour at both ends is spread out.
#[derive(Debug)]
pub(crate) struct Curve {
    panels: Vec<[f64; ORDER]>,
    ends: [f64; 2],
    error: f64,
}

const FROM: f64 = -34.0;
const TO: f64 = 34.0;
const COUNT: usize = 34;

fn node(i: usize) -> f64 {
    -(PI * (i as f64 + 0.5) / ORDER as f64).cos()
}

impl Curve {
    pub(crate) fn new(f: &(dyn Fn(f64) -> f64 + Sync)) -> Curve {
        let width = (TO - FROM) / COUNT as f64;
        let mut panels = Vec::new();
        let mut error = 0.0_f64;
        for k in 0..COUNT {
            let lo = FROM + width * k as f64;
            let mut values = [0.0; ORDER];
            for (i, v) in values.iter_mut().enumerate() {
                let w = lo + 0.5 * width * (1.0 + node(i));
                *v = f(1.0 / (1.0 + (-w).exp()));
            }
            let scale = values.iter().fold(0.0f64, |m, v| m.max(v.abs()));
            let mu = 1.0 / (1.0 + (-lo).exp());
            error = error.max(tail(&values) / (scale + mu));
            panels.push(values);
        }
        Curve { panels, ends: [f(0.0), f(1.0)], error }
    }

    /// What the polynomials leave out, over the sum of the value and the cosine.
    pub(crate) fn error(&self) -> f64 {
        self.error
    }

    pub(crate) fn at(&self, mu: f64) -> f64 {
        let w = if mu < 0.5 { (mu / (1.0 - mu)).ln() } else { -((1.0 - mu) / mu).ln() };
        if w <= FROM {
            return self.ends[0];
        }
        if w >= TO {
            return self.ends[1];
        }
        let width = (TO - FROM) / COUNT as f64;
        let k = (((w - FROM) / width) as usize).min(COUNT - 1);
        let x = 2.0 * (w - FROM - width * k as f64) / width - 1.0;
        let (mut above, mut below) = (0.0, 0.0);
        for (i, v) in self.panels[k].iter().enumerate() {
            let off = x - node(i);
            if off == 0.0 {
                return *v;
            }
            let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
            let weight = sign * ((1.0 - node(i)) * (1.0 + node(i))).sqrt() / off;
            above += weight * v;
            below += weight;
        }
        above / below
    }
}

/// The last two Chebyshev coefficients.
fn tail(values: &[f64; ORDER]) -> f64 {
    let of = |k: usize| {
        let sum: f64 = values
            .iter()
            .enumerate()
            .map(|(i, v)| v * (PI * k as f64 * (i as f64 + 0.5) / ORDER as f64).cos())
            .sum();
        2.0 / ORDER as f64 * sum.abs()
    };
    of(ORDER - 1).max(of(ORDER - 2))
}

/// Kulla-Conty, Turquin, Fdez-Aguera: the white albedo by the same rule as the lobe.
pub(crate) fn compensated(draw: &Draw) -> (f64, f64) {
    let p = &draw.params;
    let mu = draw.mu;
    let (alpha, gamma) = ([p.number("alpha"); 2], p.number("gamma"));
    let single = lobe::microfacet(p.choice("base"), alpha, gamma, masking(p), (schlick_of(p), vec![]));
    let one = Fresnel::Schlick { f0: 1.0, f90: 1.0 };
    let white = lobe::microfacet(p.choice("base"), alpha, gamma, masking(p), (one, vec![]));
    let (e, e_error) = two_settings(|s, t| single.integrate(mu, 0.0, s, t));
    let (w, w_error) = two_settings(|s, t| white.integrate(mu, 0.0, s, t));
    let missing = (1.0 - w).max(0.0);
    match draw.model.id {
        "turquin" => {
            let f0 = p.number("f0");
            let factor = 1.0 + f0 * (1.0 - w) / w;
            (e * factor, e_error * factor + e * f0 * w_error / (w * w))
        }
        "fdez-aguera" => {
            let f = f_avg(p);
            let extra = |m: f64| e * f * m / (1.0 - f * m);
            (e + extra(missing), e_error * 2.0 + (extra(missing + w_error) - extra(missing)).abs())
        }
        _ => {
            let average = |s: &Setting, inner: f64| {
                let breaks = quad::sorted(0.0, 1.0, vec![alpha[0].min(0.9)]);
                s.pieces(&breaks, 10.0 * inner, &mut |at, t, _| {
                    let t = (0.1 * t / at.x).max(inner);
                    2.0 * at.x * (1.0 - once(&white, at.x, s, t).value)
                })
                .value
            };
            let (first, second) = (average(&quad::COARSE, 1e-6), average(&quad::MEDIUM, 1e-11));
            let f = f_avg(p);
            let colour = |missing: f64| {
                let rest = 1.0 - f * missing;
                let slides = if rest > 0.0 { f * (1.0 - missing) / rest } else { 1.0 };
                if p.choice("colour") == "slides" { slides } else { f * slides }
            };
            // a thousandth of the difference to a run that is ten thousand times coarser
            let off = (1e-3 * (first - second).abs()).max(3e-11);
            let slope = (colour(second + off) - colour(second)).abs();
            (e + colour(second) * missing, e_error + w_error * colour(second) + slope * missing)
        }
    }
}

/// The material of glTF: its lobes, with the curve of the sheen.
pub(crate) fn gltf(draw: &Draw) -> (f64, f64) {
    let p = &draw.params;
    let number = |id: &str| p.number(id);
    let square = |id: &str| p.number(id) * p.number(id);
    let mu = draw.mu;
    let (sheen, metallic, rho) = (number("sheen"), number("metallic"), number("base_color"));
    let rough = square("sheen_roughness");
    let cloth = lobe::charlie(rough);
    let curve = (sheen > 0.0).then(|| Curve::new(&|m| once(&cloth, m, &quad::MEDIUM, 1e-11).value));
    let at_view = curve.as_ref().map(|_| two_settings(|s, t| cloth.integrate(mu, 0.0, s, t)));
    let below = |mu_i: f64| {
        curve.as_ref().map_or(1.0, |c| {
            let e = at_view.map_or(0.0, |e| e.0).max(c.at(mu_i));
            (1.0 - sheen * e).max(0.0)
        })
    };
    let coated = number("clearcoat") * Fresnel::Schlick { f0: 0.04, f90: 1.0 }.at(mu);
    let f0 = (1.0 - metallic) * 0.04 + metallic * rho;
    let factor = Fresnel::Schlick { f0, f90: 1.0 };
    let base = lobe::microfacet("ggx", [square("roughness"); 2], 2.0, Masking::Separable, (factor, vec![]));
    let base = base.weighted(&below, if curve.is_some() { vec![mu] } else { vec![] });
    let one = Fresnel::Schlick { f0: 1.0, f90: 1.0 };
    let coat =
        lobe::microfacet("ggx", [square("clearcoat_roughness"); 2], 2.0, Masking::Separable, (one, vec![]));
    let specular = two_settings(|s, t| base.integrate(mu, 0.0, s, t));
    let coat = two_settings(|s, t| coat.integrate(mu, 0.0, s, t));
    let sin = ((1.0 - mu) * (1.0 + mu)).sqrt();
    let matte = two_settings(|s, t| {
        lobes::hemisphere(s, t, &[mu, 0.5], &|mu_i, sin_i, cos, _| {
            let v = (0.5 * (1.0 + mu * mu_i + sin * sin_i * cos)).max(0.0).sqrt();
            let through = 1.0 - Fresnel::Schlick { f0: 0.04, f90: 1.0 }.at(v);
            FRAC_1_PI * through * below(mu_i)
        })
    });
    let matte = ((1.0 - metallic) * rho * matte.0, (1.0 - metallic) * rho * matte.1);
    let cloth = at_view.unwrap_or((0.0, 0.0));
    let slack = curve.as_ref().map_or(0.0, |c| (c.error() + 1e-11) * sheen * (specular.0 + matte.0));
    let open = 1.0 - coated;
    let value = open * (specular.0 + matte.0 + sheen * cloth.0) + coated * coat.0;
    let error = open * (specular.1 + matte.1 + sheen * cloth.1 + slack) + coated * coat.1;
    (value, error)
}
