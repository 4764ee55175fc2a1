//! Kinds in closed form: the textbook's formula, written again.

use crate::sweep::kinds::{NONE, Truths};
use crate::sweep::quad::{self, mark, sharp, sorted};
use crate::sweep::texel::{Pick, Texel};
use brdfbake::models::Params;
use brdfbake::terms::{burley_diffusion, dipole, metals, skin};
use serde_json::{Map, Value, json};
use std::f64::consts::{FRAC_PI_2, PI};

/// A value that is known to some units of its rounding.
fn exact(value: f64) -> (f64, f64) {
    (value, 4e-15 * value.abs())
}

pub(crate) fn attempt(kind: &str, layout: &str, pick: &mut Pick) -> Texel {
    let mut params = Map::new();
    let mut set = |key: &str, value: Value| {
        params.insert(key.to_owned(), value);
    };
    let mu = pick.mu();
    let at: Vec<(&str, f64)> = match kind {
        "fresnel-dielectric" => {
            let eta = if pick.0.index(2) == 0 { pick.log(1e-3, 1e3) } else { pick.log(0.4, 3.0) };
            vec![("mu", mu), ("eta", eta)]
        }
        "fresnel-conductor" => {
            let metal = pick.one(&["au", "ag", "al", "cu", "fe", "ni", "ti", "w", "index", "index", "index"]);
            set("metal", json!(metal));
            if metal == "index" {
                set("n", json!(pick.log(1e-3, 1e3)));
                set("k", json!(pick.log(1e-3, 1e3)));
            }
            vec![("mu", mu)]
        }
        "fresnel-schlick" => {
            let variant = pick.one(&["schlick", "generalised", "f82-tint", "lazanyi", "dielectric"]);
            set("variant", json!(variant));
            let numbers: &[(&str, f64, f64)] = match variant {
                "generalised" => &[("f0", 0.0, 1.0), ("f90", 0.0, 1.0), ("exponent", 0.01, 100.0)],
                "f82-tint" => &[("f0", 0.0, 1.0), ("tint", 0.0, 1.0)],
                "lazanyi" => &[("n", 0.01, 1e3), ("k", 1e-3, 1e3), ("a", 0.0, 10.0), ("q", 0.01, 100.0)],
                "dielectric" => &[("eta", 1e-3, 1e3)],
                _ => &[("f0", 0.0, 1.0), ("f90", 0.0, 1.0)],
            };
            for (key, lo, hi) in numbers {
                set(key, json!(if *lo > 0.0 { pick.log(*lo, *hi) } else { pick.between(*lo, *hi) }));
            }
            vec![("mu", mu)]
        }
        "thin-film" => {
            for (key, lo, hi) in [("n2", 1.0, 4.0), ("n3", 0.1, 10.0), ("k3", 1e-3, 10.0)] {
                set(key, json!(pick.log(lo, hi)));
            }
            vec![("mu", mu), ("film", pick.log(1.0, 2e4))]
        }
        "film-sensitivity" => {
            set("scale", json!(pick.log(1e-3, 1e3)));
            vec![("opd", pick.log(1.0, 1e6))]
        }
        "ndf" => {
            set("distribution", json!(pick.one(&["ggx", "beckmann"])));
            vec![("mu_m", 1.0 - pick.log(1e-12, 1.0)), ("alpha", pick.log(1e-4, 2.0))]
        }
        "masking" | "visibility" => {
            set(
                "distribution",
                json!(pick.one(&["ggx", "beckmann", "schlick-ibl", "schlick-analytic", "schlick"])),
            );
            if kind == "masking" {
                vec![("mu", mu), ("alpha", pick.log(1e-6, 2.0))]
            } else {
                set("masking", json!(pick.one(&["correlated", "separable"])));
                set("alpha", json!(pick.log(1e-6, 2.0)));
                vec![("mu", mu.max(1e-6)), ("mu_i", pick.log(1e-6, 1.0))]
            }
        }
        "kelemen-beckmann" => vec![("mu_m", pick.unit()), ("m", pick.log(1e-3, 1.0))],
        "phase-function" | "phase-sampling" => {
            let id = pick.one(&["henyey-greenstein", "rayleigh", "draine", "fog", "isotropic"]);
            set("phase", json!(id));
            let wide = pick.log(1e-3, 1.999);
            let g = if pick.0.index(2) == 0 { wide - 1.0 } else { 1.0 - wide };
            if id == "henyey-greenstein" || id == "draine" {
                set("g", json!(g.clamp(-0.999, 0.999)));
            }
            if id == "draine" {
                set("draine_alpha", json!(pick.log(1e-3, 100.0)));
            }
            if id == "fog" {
                set("diameter", json!(pick.between(5.0, 50.0)));
            }
            if kind == "phase-function" {
                vec![("deflection", pick.between(0.0, PI))]
            } else {
                let u = pick.log(1e-12, 1.0);
                vec![("u", if pick.0.index(2) == 0 { u } else { 1.0 - u })]
            }
        }
        "beer-lambert" => {
            for key in ["sigma_r", "sigma_g", "sigma_b"] {
                set(key, json!(pick.log(1e-9, 1e9)));
            }
            vec![("path", pick.log(1e-6, 1e3))]
        }
        "blackbody" => {
            set("reference", json!(pick.log(500.0, 1e6)));
            vec![("temperature", pick.log(500.0, 1e6))]
        }
        _ => {
            profile(kind, pick, &mut set);
            match kind {
                "preintegrated-skin" => {
                    set("over", json!(pick.one(&["ring", "sphere"])));
                    vec![("ndotl", pick.between(-1.0, 1.0)), ("curvature", pick.log(1e-3, 1e3))]
                }
                "diffusion-sampling" => {
                    let u = pick.log(1e-12, 1.0);
                    vec![("u", if pick.0.index(2) == 0 { u } else { (1.0 - u).max(1e-9) })]
                }
                _ => {
                    let id = match kind {
                        "diffusion-kernel" => "offset",
                        "skin-transmittance" => "thickness",
                        _ => "radius",
                    };
                    vec![(id, pick.log(1e-4, 1e3))]
                }
            }
        }
    };
    Texel::new(kind, layout, "", params, &at)
}

/// Parameters of a diffusion profile.
fn profile(kind: &str, pick: &mut Pick, set: &mut dyn FnMut(&str, Value)) {
    if kind == "diffusion-profile" {
        set("scale", json!(pick.one(&["one", "albedo"])));
    }
    let id = pick.one(&["skin", "gaussians", "burley", "dipole"]);
    set("profile", json!(id));
    match id {
        "gaussians" => {
            let weight = |pick: &mut Pick| pick.log(1e-3, 1.0);
            let row = |pick: &mut Pick| vec![pick.log(1e-4, 1e2), weight(pick), weight(pick), weight(pick)];
            let count = 1 + pick.0.index(4);
            set("gaussians", json!((0..count).map(|_| row(pick)).collect::<Vec<_>>()));
        }
        "burley" => {
            set("fit", json!(pick.one(&["dmfp", "searchlight", "diffuse"])));
            for c in ["r", "g", "b"] {
                set(&format!("albedo_{c}"), json!(pick.between(1e-4, 1.0)));
                set(&format!("length_{c}"), json!(pick.log(1e-2, 1e2)));
            }
        }
        "dipole" => {
            set("eta", json!(pick.between(1.0, 3.0)));
            for c in ["r", "g", "b"] {
                set(&format!("sigma_a_{c}"), json!(pick.log(1e-4, 10.0)));
                set(&format!("sigma_s_{c}"), json!(pick.log(1e-2, 1e2)));
            }
        }
        _ => {}
    }
}

pub(crate) fn truths(t: &Texel) -> Truths {
    let p = t.resolved();
    match t.kind.as_str() {
        "fresnel-dielectric" => dielectric_channels(t),
        "fresnel-conductor" => conductor_channels(t, &p),
        "fresnel-schlick" => vec![schlick_variant(t, &p)],
        "ndf" => ndf(t, &p),
        "masking" => vec![masking(p.choice("distribution").unwrap(), t.axis("mu"), t.axis("alpha")).0],
        "visibility" => vec![visibility(t, &p)],
        "kelemen-beckmann" => {
            let (u, m) = (t.axis("mu_m"), t.axis("m"));
            let tan2 = (1.0 - u) * (1.0 + u) / (u * u);
            vec![exact(0.5 * (0.1 * (-tan2 / (m * m) - 2.0 * m.ln() - 4.0 * u.ln())).exp())]
                .into_iter()
                .map(|(v, _)| (v, 1e-13 * v * (1.0 + 0.1 * tan2 / (m * m))))
                .collect()
        }
        "phase-function" => {
            let f = Phase::new(&p);
            let value = f.at(t.axis("deflection"));
            let most = (0..=20_000).map(|i| f.at(PI * f64::from(i) / 20_000.0)).fold(0.0, f64::max);
            vec![if t.layout == "relative" { exact(value / most) } else { exact(value) }]
                .into_iter()
                .map(|(v, e)| (v, 10.0 * e))
                .collect()
        }
        "beer-lambert" => ["sigma_r", "sigma_g", "sigma_b"]
            .iter()
            .map(|id| {
                let depth = p.number(id).unwrap() * t.axis("path");
                let value = if t.layout == "lost" { -(-depth).exp_m1() } else { (-depth).exp() };
                (value, 1e-15 + 1e-15 * value * depth)
            })
            .collect(),
        "diffusion-profile" => diffusion_profile(t, &p),
        "skin-transmittance" => {
            let profile = Profile::new(&p);
            let factor = if t.layout == "jimenez" { 2f64.sqrt() } else { 1.0 };
            (0..3).map(|c| profile.outside(c, factor * t.axis("thickness"))).collect()
        }
        "merl" => merl(t, &p),
        _ => t.channels().iter().map(|_| NONE).collect(),
    }
}

/// s and p of a dielectric, from the amplitudes as textbooks have them.
fn dielectric(c: f64, eta: f64) -> [f64; 2] {
    let g2 = (eta - 1.0) * (eta + 1.0) + c * c;
    if g2 <= 0.0 {
        return [1.0, 1.0];
    }
    let g = g2.sqrt();
    let (s, p) = ((c - g) / (c + g), (eta * eta * c - g) / (eta * eta * c + g));
    [s * s, p * p]
}

/// `2 int F c dc` of a dielectric by quadrature.
pub(crate) fn dielectric_average(eta: f64) -> f64 {
    let line = if eta < 1.0 { ((1.0 - eta) * (1.0 + eta)).sqrt() } else { 0.0 };
    let edges = sorted(sharp(0.0), mark(1.0), vec![sharp(line)]);
    quad::SECOND
        .pieces(&edges, 1e-14, &mut |at, _, _| {
            let [s, p] = dielectric(at.x, eta);
            at.x * (s + p)
        })
        .value
}

fn dielectric_channels(t: &Texel) -> Truths {
    let (mu, eta) = (t.axis("mu"), t.axis("eta"));
    let (above, below) = (dielectric(mu, eta), dielectric(mu, 1.0 / eta));
    // next to the critical angle g has lost digits, and so has 1/eta
    let near = |eta: f64| {
        let g2 = (eta - 1.0) * (eta + 1.0) + mu * mu;
        4e-15 + 4e-16 * (1.0 + mu * mu) / g2.abs().max(1e-300).sqrt().max(1e-8)
    };
    let mean = |f: [f64; 2]| 0.5 * (f[0] + f[1]);
    t.channels()
        .iter()
        .map(|c| match c.id {
            "fresnel.s" | "fresnel.outside.s" => (above[0], near(eta)),
            "fresnel.p" | "fresnel.outside.p" => (above[1], near(eta)),
            "fresnel.inside.s" => (below[0], near(1.0 / eta)),
            "fresnel.inside.p" => (below[1], near(1.0 / eta)),
            "fresnel.inside" => (mean(below), near(1.0 / eta)),
            _ => (mean(above), near(eta)),
        })
        .collect()
}

/// s and p of a conductor, from complex amplitudes.
pub(crate) fn conductor(c: f64, n: f64, k: f64) -> [f64; 2] {
    let n2 = [(n - k) * (n + k), 2.0 * n * k];
    // q = sqrt(N^2 - sin^2), its imaginary part not negative
    let square = [n2[0] - (1.0 - c) * (1.0 + c), n2[1]];
    let size = square[0].hypot(square[1]);
    let q = if square[0] >= 0.0 {
        let re = (0.5 * (size + square[0])).sqrt();
        [re, if re > 0.0 { 0.5 * square[1] / re } else { 0.0 }]
    } else {
        let im = (0.5 * (size - square[0])).sqrt();
        [0.5 * square[1] / im, im]
    };
    let part = |a: [f64; 2]| {
        let (minus, plus) = ([a[0] - q[0], a[1] - q[1]], [a[0] + q[0], a[1] + q[1]]);
        (minus[0] * minus[0] + minus[1] * minus[1]) / (plus[0] * plus[0] + plus[1] * plus[1])
    };
    [part([c, 0.0]), part([n2[0] * c, n2[1] * c])]
}

fn conductor_channels(t: &Texel, p: &Params) -> Truths {
    let metal = metals::find(p.choice("metal").unwrap());
    let at = |mu: f64, lambda: f64| {
        let (n, k) = metal.map_or((p.number("n").unwrap(), p.number("k").unwrap()), |m| m.index(lambda));
        conductor(mu, n, k)
    };
    let of = |lambda: f64| at(t.axis("mu"), lambda);
    if t.layout == "f82-tint" {
        // Schlick's curve less what takes it through F at 1/7
        let tint = |lambda: f64| {
            let mean = |mu: f64| at(mu, lambda).iter().sum::<f64>() / 2.0;
            let (f0, edge, mu) = (mean(1.0), 1.0 / 7.0, t.axis("mu"));
            let schlick = |mu: f64| f0 + (1.0 - f0) * (1.0 - mu).powi(5);
            let dip = |mu: f64| mu * (1.0 - mu).powi(6);
            let value = schlick(mu) - (schlick(edge) - mean(edge)) / dip(edge) * dip(mu);
            (value.clamp(0.0, 1.0), 3e-14)
        };
        return metals::RGB_NM.map(tint).to_vec();
    }
    let all = metals::RGB_NM.map(of);
    let flat: Vec<f64> = if t.layout == "polarised" {
        (0..6).map(|i| all[i % 3][i / 3]).collect()
    } else {
        all.iter().map(|f| 0.5 * (f[0] + f[1])).collect()
    };
    flat.into_iter().map(|v| (v, 1e-14)).collect()
}

fn schlick_variant(t: &Texel, p: &Params) -> (f64, f64) {
    let n = |id: &str| p.number(id).unwrap();
    let mu = t.axis("mu");
    let m = 1.0 - mu;
    let index = |n: f64, k: f64| ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k);
    let value = match p.choice("variant").unwrap() {
        "generalised" => n("f0") + (n("f90") - n("f0")) * m.powf(n("exponent")),
        "f82-tint" => {
            let plain = |mu: f64| n("f0") + (1.0 - n("f0")) * (1.0 - mu).powi(5);
            let bar = 1.0 / 7.0;
            let b = plain(bar) * (1.0 - n("tint")) / (bar * (1.0 - bar).powi(6));
            plain(mu) - b * mu * m.powi(6)
        }
        "lazanyi" => {
            let f0 = index(n("n"), n("k"));
            f0 + (1.0 - f0) * m.powi(5) - n("a") * mu * m.powf(n("q"))
        }
        "dielectric" => {
            let eta = n("eta");
            let f0 = index(eta, 0.0);
            let square = 1.0 - m * (1.0 + mu) / (eta * eta);
            let cosine = if eta >= 1.0 { mu } else { square.max(0.0).sqrt() };
            if eta < 1.0 && square <= 0.0 { 1.0 } else { f0 + (1.0 - f0) * (1.0 - cosine).powi(5) }
        }
        _ => n("f0") + (n("f90") - n("f0")) * m.powi(5),
    };
    (if t.layout == "clamped" { value.clamp(0.0, 1.0) } else { value }, 1e-13)
}

fn ndf(t: &Texel, p: &Params) -> Truths {
    let (mu, alpha) = (t.axis("mu_m"), t.axis("alpha"));
    let sin2 = (1.0 - mu) * (1.0 + mu);
    let relative = if p.choice("distribution").unwrap() == "ggx" {
        // pi a^2 D
        let q = mu * mu + sin2 / (alpha * alpha);
        1.0 / (q * q)
    } else {
        let x = sin2 / (mu * mu * alpha * alpha);
        if mu > 0.0 { (-x).exp() / (mu * mu * mu * mu) } else { 0.0 }
    };
    let slope = sin2 / (mu * mu * alpha * alpha);
    let value = if t.layout == "relative" { relative } else { relative / (PI * alpha * alpha) };
    vec![(value, value * 1e-14 * (1.0 + slope.min(1e3)))]
}

/// `(exp(-a^2) / (a sqrt pi) - erfc a) / 2`, by the integral of its derivative: `int_a^inf exp(-t^2) / (2 sqrt(pi) t^2) dt`.
fn beckmann_lambda(a: f64) -> f64 {
    if a > 27.0 {
        return 0.0;
    }
    if a < 1e-2 {
        // erfc a = 1 - 2/sqrt(pi) (a - a^3/3 + a^5/10 - a^7/42): nothing cancels
        let a2 = a * a;
        let erf = a * (1.0 - a2 * (1.0 / 3.0 - a2 * (0.1 - a2 / 42.0)));
        return 0.5 * ((-a2).exp() / (a * PI.sqrt()) - 1.0 + 2.0 / PI.sqrt() * erf);
    }
    // in s = 1/t
    let edges = [sharp(0.0), mark(1.0 / a)];
    let sum = quad::SECOND.pieces(&edges, 1e-15, &mut |at, _, _| (-1.0 / (at.x * at.x)).exp());
    sum.value / (2.0 * PI.sqrt())
}

/// G1 and Lambda.
fn masking(distribution: &str, mu: f64, alpha: f64) -> ((f64, f64), f64) {
    let k = match distribution {
        "schlick-ibl" => 0.5 * alpha,
        "schlick-analytic" => (alpha.sqrt() + 1.0) * (alpha.sqrt() + 1.0) / 8.0,
        "schlick" => alpha * (2.0 / PI).sqrt(),
        _ => f64::NAN,
    };
    let lambda = if k.is_finite() {
        k * (1.0 - mu) / mu
    } else {
        let tan = ((1.0 - mu) * (1.0 + mu)).sqrt() / mu;
        match distribution {
            "ggx" => 0.5 * ((alpha * tan).hypot(1.0) - 1.0),
            _ if tan > 0.0 => beckmann_lambda(1.0 / (alpha * tan)),
            _ => 0.0,
        }
    };
    let g = 1.0 / (1.0 + lambda);
    (((if g.is_nan() { 0.0 } else { g }), 1e-14), lambda)
}

fn visibility(t: &Texel, p: &Params) -> (f64, f64) {
    let (mu_o, mu_i) = (t.axis("mu"), t.axis("mu_i"));
    let d = p.choice("distribution").unwrap();
    let ((g_o, _), l_o) = masking(d, mu_o, p.number("alpha").unwrap());
    let ((g_i, _), l_i) = masking(d, mu_i, p.number("alpha").unwrap());
    let separable = p.choice("masking").unwrap() == "separable" || d.starts_with("schlick");
    let g2 = if separable { g_o * g_i } else { 1.0 / (1.0 + l_o + l_i) };
    if t.layout == "g2" { (g2, 1e-14) } else { exact_times(g2 / (4.0 * mu_o * mu_i), 10.0) }
}

fn exact_times(value: f64, times: f64) -> (f64, f64) {
    (value, times * 1e-15 * value.abs())
}

/// Phase functions.
pub(crate) struct Phase {
    id: &'static str,
    g: f64,
    alpha: f64,
    diameter: f64,
}

impl Phase {
    pub(crate) fn new(p: &Params) -> Phase {
        Phase {
            id: p.choice("phase").unwrap(),
            g: p.number("g").unwrap(),
            alpha: p.number("draine_alpha").unwrap(),
            diameter: p.number("diameter").unwrap(),
        }
    }

    pub(crate) fn at(&self, theta: f64) -> f64 {
        let half = (0.5 * theta).sin();
        let cos = theta.cos();
        let hg = |g: f64| {
            let w2 = (1.0 - g) * (1.0 - g) + 4.0 * g * half * half;
            (1.0 - g) * (1.0 + g) / (4.0 * PI * w2 * w2.sqrt())
        };
        let draine = |g: f64, a: f64| hg(g) * (1.0 + a * cos * cos) / (1.0 + a * (1.0 + 2.0 * g * g) / 3.0);
        match self.id {
            "rayleigh" => 3.0 / (16.0 * PI) * (1.0 + cos * cos),
            "draine" => draine(self.g, self.alpha),
            "isotropic" => 1.0 / (4.0 * PI),
            "fog" => {
                let d = self.diameter;
                let g_hg = (-0.099_056_7 / (d - 1.671_54)).exp();
                let g_d = (-2.206_79 / (d + 3.910_29) - 0.428_934).exp();
                let a = (3.624_89 - 8.292_88 / (d + 5.528_25)).exp();
                let w = (-0.599_085 / (d - 0.641_583) - 0.665_888).exp();
                (1.0 - w) * hg(g_hg) + w * draine(g_d, a)
            }
            _ => hg(self.g),
        }
    }
}

/// A diffusion profile of three channels, normalised.
pub(crate) enum Profile {
    Gaussians(Vec<(f64, [f64; 3])>),
    Burley([f64; 3], [f64; 3]),
    /// Effective extinction, depths of source and image, `alpha'/2`, total.
    Dipole([(f64, [f64; 2], f64, f64); 3]),
}

impl Profile {
    pub(crate) fn new(p: &Params) -> Profile {
        let rgb = |stem: &str| ["r", "g", "b"].map(|c| p.number(&format!("{stem}_{c}")).unwrap());
        match p.choice("profile").unwrap() {
            "burley" => {
                let (albedo, length) = (rgb("albedo"), rgb("length"));
                let fit = match p.choice("fit").unwrap() {
                    "searchlight" => burley_diffusion::ShapeFit::Searchlight,
                    "diffuse" => burley_diffusion::ShapeFit::Diffuse,
                    _ => burley_diffusion::ShapeFit::DiffuseMeanFreePath,
                };
                Profile::Burley(
                    [0, 1, 2].map(|c| length[c] / burley_diffusion::scale(fit, albedo[c])),
                    albedo,
                )
            }
            "dipole" => {
                let (a, s) = (rgb("sigma_a"), rgb("sigma_s"));
                let f = dipole::internal_reflectance(p.number("eta").unwrap());
                Profile::Dipole([0, 1, 2].map(|c| {
                    let t = a[c] + s[c];
                    let z = [1.0 / t, (1.0 + 4.0 / 3.0 * (1.0 + f) / (1.0 - f)) / t];
                    let tr = (3.0 * a[c] * t).sqrt();
                    let half = 0.5 * s[c] / t;
                    (tr, z, half, half * ((-tr * z[0]).exp() + (-tr * z[1]).exp()))
                }))
            }
            "gaussians" => {
                let rows = p.rows("gaussians").unwrap();
                let total = |c: usize| rows.iter().map(|r| r[1 + c]).sum::<f64>();
                Profile::Gaussians(
                    rows.iter().map(|r| (r[0], [0, 1, 2].map(|c| r[1 + c] / total(c)))).collect(),
                )
            }
            _ => Profile::Gaussians(
                (0..6).map(|i| (skin::VARIANCES[i], [0, 1, 2].map(|c| skin::WEIGHTS[c][i]))).collect(),
            ),
        }
    }

    /// `2 pi r R`.
    pub(crate) fn ring(&self, c: usize, r: f64) -> f64 {
        match self {
            Profile::Gaussians(lobes) => {
                lobes.iter().map(|(v, w)| w[c] * r / v * (-0.5 * r * r / v).exp()).sum()
            }
            Profile::Burley(l, _) => ((-r / l[c]).exp() + (-r / (3.0 * l[c])).exp()) / (4.0 * l[c]),
            Profile::Dipole(all) => {
                let (tr, z, half, total) = all[c];
                let term = |z: f64| {
                    let d = r.hypot(z);
                    z * (1.0 + tr * d) * (-tr * d).exp() / (d * d) * (r / d)
                };
                half * (term(z[0]) + term(z[1])) / total
            }
        }
    }

    /// Lengths on which a channel changes.
    pub(crate) fn lengths(&self, c: usize) -> Vec<f64> {
        match self {
            Profile::Gaussians(lobes) => lobes.iter().map(|l| l.0.sqrt()).collect(),
            Profile::Burley(l, _) => vec![l[c], 3.0 * l[c]],
            Profile::Dipole(all) => {
                let (tr, z, ..) = all[c];
                vec![z[0], z[1], 1.0 / tr]
            }
        }
    }

    /// Where nothing is left.
    pub(crate) fn end(&self, c: usize) -> f64 {
        let most = self.lengths(c).into_iter().fold(0.0, f64::max);
        match self {
            Profile::Gaussians(_) => 12.0 * most,
            _ => 50.0 * most,
        }
    }

    /// `int_a^b 2 pi r R dr`.
    pub(crate) fn part(&self, c: usize, a: f64, b: f64) -> f64 {
        let edges = sorted(
            if a > 0.0 { mark(a) } else { sharp(a) },
            mark(b),
            self.lengths(c).into_iter().map(mark).collect(),
        );
        quad::SECOND.pieces(&edges, 1e-15, &mut |at, _, _| self.ring(c, at.x)).value
    }

    fn outside(&self, c: usize, r: f64) -> (f64, f64) {
        let end = self.end(c);
        (if r < end { self.part(c, r, end) } else { 0.0 }, 1e-13)
    }
}

fn diffusion_profile(t: &Texel, p: &Params) -> Truths {
    let profile = Profile::new(p);
    let r = t.axis("radius");
    let total = |c: usize| match &profile {
        Profile::Gaussians(_) if p.choice("profile").unwrap() == "gaussians" => {
            p.rows("gaussians").unwrap().iter().map(|row| row[1 + c]).sum()
        }
        Profile::Gaussians(_) => 1.0,
        Profile::Burley(_, albedo) => albedo[c],
        Profile::Dipole(all) => all[c].3,
    };
    (0..3)
        .map(|c| {
            let factor = if p.choice("scale").unwrap() == "albedo" { total(c) } else { 1.0 };
            let (value, error) = match t.layout.as_str() {
                "area" => (profile.ring(c, r) / (2.0 * PI * r), 0.0),
                "inside" => (profile.part(c, 0.0, r), 1e-13),
                _ => (profile.ring(c, r), 0.0),
            };
            // exp(-x) has the rounding of x
            (factor * value, factor * (error + 1e-13 * value.abs()))
        })
        .collect()
}

/// f at half and difference angles, from the angles themselves.
fn merl(t: &Texel, p: &Params) -> Truths {
    let draw = t.draw(false);
    let (h, d, phi) = (t.axis("theta_h"), t.axis("theta_d"), t.axis("phi_d"));
    let (sin_h, cos_h) = h.sin_cos();
    let (sin_d, cos_d) = if d < FRAC_PI_2 { d.sin_cos() } else { (1.0, 0.0) };
    let along = cos_d * cos_h;
    let across = sin_d * phi.cos() * sin_h;
    let (mu_o, mu_i) = (along + across, along - across);
    let alpha = draw.params.number("alpha").unwrap();
    let value = if mu_o > 0.0 && mu_i > 0.0 {
        crate::sweep::lobe::value(&draw, alpha, [h, cos_d], [mu_o, mu_i])
    } else {
        0.0
    };
    // both directions lose digits at the horizon, D its own on its slope
    let slope = (h.tan() / alpha) * (h.tan() / alpha);
    let error = value
        * (1e-13
            + 1e-15 * slope.min(800.0)
            + 1e-15 / mu_o.min(mu_i).max(1e-12)
            + 1e-15 * h / (alpha * alpha));
    ["red", "green", "blue"].map(|c| (p.number(c).unwrap() * value, p.number(c).unwrap() * error)).to_vec()
}
