//! Curves over the cosine, and the models that are made of them.

use crate::sweep::draw::Draw;
use crate::sweep::lobe;
use crate::sweep::lobes;
use crate::sweep::quad::{self, mark, sharp, sorted, two_settings};
use crate::sweep::truth::{f_avg, masking, once, schlick_of};
use brdfbake::math::special::cos_pow;
use brdfbake::models::microfacet::{Fresnel, Masking};
use brdfbake::terms::charlie;
use std::f64::consts::{FRAC_1_PI, PI};

/// A function of the cosine as polynomials in w on panels, `mu = 1/(1 + e^-w)`: its behaviour at both ends is spread out.
#[derive(Debug)]
pub(crate) struct Curve {
    /// Ends of the panels in w.
    edges: Vec<f64>,
    panels: Vec<Vec<f64>>,
    ends: [f64; 2],
    error: f64,
}

fn node(i: usize, order: usize) -> f64 {
    -(PI * (i as f64 + 0.5) / order as f64).cos()
}

/// Panels of about equal length between edges.
pub(crate) fn split(edges: &[f64], length: f64) -> Vec<f64> {
    let mut all = vec![edges[0]];
    for pair in edges.windows(2) {
        let count = ((pair[1] - pair[0]) / length).ceil();
        all.extend((1..=count as usize).map(|k| pair[0] + (pair[1] - pair[0]) * k as f64 / count));
    }
    all
}

impl Curve {
    /// With `order` nodes on each panel; beyond the edges it has its ends.
    pub(crate) fn new(edges: Vec<f64>, order: usize, f: &(dyn Fn(f64) -> f64 + Sync)) -> Curve {
        let mut error = 0.0;
        let cosine = |w: f64| 1.0 / (1.0 + (-w).exp());
        let panels = edges
            .windows(2)
            .map(|pair| {
                let at = |i| f(cosine(pair[0] + 0.5 * (pair[1] - pair[0]) * (1.0 + node(i, order))));
                let values: Vec<f64> = (0..order).map(at).collect();
                let scale = values.iter().fold(0.0f64, |m, v| m.max(v.abs()));
                let (lo, hi) = (cosine(pair[0]), cosine(pair[1]));
                error += tail(&values) / (scale + lo) * (hi - lo);
                values
            })
            .collect();
        Curve { edges, panels, ends: [f(0.0), f(1.0)], error }
    }

    /// What the polynomials leave out, over the sum of the value and the cosine, on the average.
    pub(crate) fn error(&self) -> f64 {
        self.error
    }

    pub(crate) fn at(&self, mu: f64) -> f64 {
        let w = if mu < 0.5 { (mu / (1.0 - mu)).ln() } else { -((1.0 - mu) / mu).ln() };
        if w <= self.edges[0] {
            return self.ends[0];
        }
        let k = self.edges.partition_point(|e| *e <= w) - 1;
        if k >= self.panels.len() {
            return self.ends[1];
        }
        let (lo, hi) = (self.edges[k], self.edges[k + 1]);
        let x = 2.0 * (w - lo) / (hi - lo) - 1.0;
        let order = self.panels[k].len();
        let (mut above, mut below) = (0.0, 0.0);
        for (i, v) in self.panels[k].iter().enumerate() {
            let at = node(i, order);
            let off = x - at;
            if off == 0.0 {
                return *v;
            }
            let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
            let weight = sign * ((1.0 - at) * (1.0 + at)).sqrt() / off;
            above += weight * v;
            below += weight;
        }
        above / below
    }
}

/// The last two Chebyshev coefficients.
fn tail(values: &[f64]) -> f64 {
    let order = values.len();
    let of = |k: usize| {
        let at = |i: usize| (PI * k as f64 * (i as f64 + 0.5) / order as f64).cos();
        2.0 / order as f64 * values.iter().enumerate().map(|(i, v)| v * at(i)).sum::<f64>().abs()
    };
    of(order - 1).max(of(order - 2))
}

/// Kulla-Conty, Turquin, Fdez-Aguera: the white albedo by the same rule as the lobe.
pub(crate) fn compensated(draw: &Draw) -> (f64, f64) {
    let p = &draw.params;
    let mu = draw.mu;
    let (alpha, gamma) = ([p.number("alpha").unwrap(); 2], p.optional("gamma").unwrap_or(f64::NAN));
    let single =
        lobe::microfacet(p.choice("base").unwrap(), alpha, gamma, masking(p), (schlick_of(p), vec![]));
    let one = Fresnel::Schlick { f0: 1.0, f90: 1.0 };
    let white = lobe::microfacet(p.choice("base").unwrap(), alpha, gamma, masking(p), (one, vec![]));
    let (e, e_error) = two_settings(|s, t| single.integrate(mu, 0.0, s, t));
    let (w, w_error) = two_settings(|s, t| white.integrate(mu, 0.0, s, t));
    let missing = (1.0 - w).max(0.0);
    match draw.model.id {
        "turquin" => {
            let f0 = p.number("f0").unwrap();
            let factor = 1.0 + f0 * (1.0 - w) / w;
            (e * factor, e_error * factor + e * f0 * w_error / (w * w))
        }
        "fdez-aguera" => {
            let f = f_avg(p);
            let extra = |m: f64| e * f * m / (1.0 - f * m);
            (e + extra(missing), e_error * 2.0 + (extra(missing + w_error) - extra(missing)).abs())
        }
        _ => {
            // 1 - E_avg in ln mu; what lies beyond e^-18 is 1e-15
            let missed = quad::MEDIUM.adaptive(&[0.0, 1.0, 2.5, 5.0, 9.0, 18.0], 1e-10, &mut |w| {
                let mu = (-w).exp();
                2.0 * mu * mu * (1.0 - once(&white, mu, &quad::MEDIUM, 1e-11 / mu).value)
            });
            let (second, off) = (missed.value, missed.error + 2e-11);
            let f = f_avg(p);
            let colour = |missing: f64| {
                let rest = 1.0 - f * missing;
                let slides = if rest > 0.0 { f * (1.0 - missing) / rest } else { 1.0 };
                if p.choice("colour").unwrap() == "slides" { slides } else { f * slides }
            };
            let slope = (colour(second + off) - colour(second)).abs();
            (e + colour(second) * missing, e_error + w_error * colour(second) + slope * missing)
        }
    }
}

/// ln(1e-7): where the masking of Charlie ends.
const CLAMP: f64 = -16.118_095_650_958_32;

/// E of Charlie to 1e-11 in plain coordinates, for the many values of a curve; the lines are those of its masking.
fn charlie(roughness: f64, mu: f64) -> f64 {
    let e = 1.0 / roughness;
    let sin = ((1.0 - mu) * (1.0 + mu)).sqrt();
    let v = |mu_i: f64| charlie::visibility(roughness, mu.max(1e-7), mu_i.max(1e-7));
    let heights = sorted(sharp(0.0), sharp(1.0), vec![mark(1e-7), mark(0.5), sharp(mu)]);
    let outer = quad::MEDIUM.pieces(&heights, 1e-11, &mut |at, tolerance, i| {
        let below = if i + 2 == heights.len() { at.to } else { 1.0 - at.x };
        let sin_i = (below * (1.0 + at.x)).sqrt();
        // the half vector passes the normal where the azimuths are opposite
        let ring = quad::MEDIUM.pieces(&[mark(0.0), mark(1.0), sharp(PI)], tolerance, &mut |turn, _, j| {
            let half = if j == 1 { (0.5 * turn.to).sin() } else { (0.5 * turn.x).cos() };
            let height = (at.x + mu) * (at.x + mu);
            // |H_xy|^2 = (s - s_i)^2 + 4 s s_i cos^2(phi/2)
            let gap = (mu - at.x) * (mu + at.x) / (sin + sin_i);
            let flat = gap * gap + 4.0 * sin * sin_i * half * half;
            let square = flat + height;
            cos_pow((flat / square).sqrt(), height / square, e)
        });
        2.0 * ring.value * v(at.x) * at.x
    });
    0.5 * FRAC_1_PI * (2.0 + e) * outer.value
}

/// The material of glTF: its lobes, with the curve of the sheen.
pub(crate) fn gltf(draw: &Draw) -> (f64, f64) {
    let p = &draw.params;
    let number = |id: &str| p.number(id).unwrap();
    let square = |id: &str| p.number(id).unwrap() * p.number(id).unwrap();
    let mu = draw.mu;
    let (sheen, metallic, rho) = (number("sheen"), number("metallic"), number("base_color"));
    let rough = square("sheen_roughness");
    let cloth = lobe::charlie(rough);
    let curve =
        (sheen > 0.0).then(|| Curve::new(split(&[CLAMP, 0.0, 30.0], 2.0), 16, &|m| charlie(rough, m)));
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
    let masking =
        if p.choice("masking").unwrap() == "separable" { Masking::Separable } else { Masking::Correlated };
    let base = lobe::microfacet("ggx", [square("roughness"); 2], 2.0, masking, (factor, vec![]));
    let base = base.weighted(&below, if curve.is_some() { vec![mu] } else { vec![] });
    let one = Fresnel::Schlick { f0: 1.0, f90: 1.0 };
    let coat = lobe::microfacet("ggx", [square("clearcoat_roughness"); 2], 2.0, masking, (one, vec![]));
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
    let slack = curve.as_ref().map_or(0.0, |c| (c.error() + 2e-10) * sheen * (specular.0 + matte.0));
    let open = 1.0 - coated;
    let value = open * (specular.0 + matte.0 + sheen * cloth.0) + coated * coat.0;
    let error = open * (specular.1 + matte.1 + sheen * cloth.1 + slack) + coated * coat.1;
    (value, error)
}
