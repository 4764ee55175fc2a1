//! Draws of texels, and the truths of the kinds that are integrals of a model.

use crate::sweep::draw::{self, Draw};
use crate::sweep::quad::{self, two_settings};
use crate::sweep::texel::{Pick, Texel};
use crate::sweep::truth;
use crate::sweep::{closed, fog, lines};
use brdfbake::models;
use brdfbake::terms::{fresnel, schlick};
use serde_json::{Map, Value, json};
use std::f64::consts::PI;

/// Truths of the channels of a texel; an infinite error where there is none.
pub(crate) type Truths = Vec<(f64, f64)>;

/// Kinds that are drawn here: how many texels of each a count of 100 stands for. What is an integral of integrals is dear.
pub(crate) const KINDS: &[(&str, u64)] = &[
    ("dfg", 100),
    ("albedo", 100),
    ("average-albedo", 16),
    ("compensation", 20),
    ("glass-compensation", 6),
    ("generalised-schlick", 60),
    ("sheen-scaling", 40),
    ("ltc-magnitude", 40),
    ("fresnel-dielectric", 40),
    ("fresnel-conductor", 60),
    ("fresnel-schlick", 60),
    ("thin-film", 60),
    ("film-sensitivity", 40),
    ("ndf", 40),
    ("masking", 40),
    ("visibility", 40),
    ("kelemen-beckmann", 40),
    ("preintegrated-skin", 60),
    ("diffusion-profile", 60),
    ("diffusion-kernel", 60),
    ("diffusion-sampling", 60),
    ("skin-transmittance", 40),
    ("phase-function", 40),
    ("phase-sampling", 100),
    ("beer-lambert", 30),
    ("blackbody", 40),
    ("airlight", 60),
    ("airlight-surface", 20),
    ("importance", 30),
    ("merl", 40),
];

/// Layouts without truths here (`*`: all of the kind), and why.
pub(crate) const WITHOUT: &[(&str, &str, &str)] = &[
    ("ltc-matrix", "*", "fitted: its residuals are integrated in fits.rs for the matrices that were found"),
    (
        "gaussian-fit",
        "*",
        "fitted: its residuals are integrated in fits.rs for the Gaussians that were found",
    ),
    ("sheen-ltc", "*", "fitted to a solved layer: tests/sheen.rs walks in it, and looks for better lobes"),
    (
        "ltc-magnitude",
        "packed",
        "magnitude-fresnel with the form factor of a sphere, which tests/ltc.rs compares",
    ),
    (
        "thin-film",
        "series",
        "a published series, which is what it is by definition: tests/terms/thin_film.rs",
    ),
    (
        "importance",
        "direction-pdf",
        "as direction; its density is held by the chi-square tests of tests/chi2.rs",
    ),
];

/// Models with a Fresnel factor that can be split off, and a width.
const SPLIT: &[&str] = &[
    "ggx",
    "ggx",
    "beckmann",
    "student-t",
    "gtr",
    "torrance-sparrow",
    "ggx-schlick-masking",
    "kelemen",
    "velvet-neubelt",
];

/// The texel of a number.
pub(crate) fn draw(kind: &str, seed: u64, number: u64) -> Texel {
    let mut pick = Pick::new(kind, seed, number);
    for _ in 0..1000 {
        let texel = attempt(kind, &mut pick);
        if texel.bind().is_ok_and(|b| {
            !matches!(b.baker.texel(&texel.at, 1.0), Err(brdfbake::tables::TexelError::Param(_)))
        }) {
            return texel;
        }
    }
    panic!("{kind}: no texel of a thousand can be bound");
}

fn layout(kind: &str, pick: &mut Pick) -> String {
    let all: Vec<&str> = brdfbake::tables::find(kind).unwrap().layouts.iter().map(|l| l.id).collect();
    pick.one(&all).to_owned()
}

/// Parameters of a model at random, without those on axes.
fn model(id: &str, without: &[&str], pick: &mut Pick) -> Map<String, Value> {
    let (info, _) = models::find(id).unwrap();
    let mut given = draw::parameters(info, &mut pick.0);
    given.retain(|k, _| !without.contains(&k.as_str()));
    given
}

fn attempt(kind: &str, pick: &mut Pick) -> Texel {
    let layout = layout(kind, pick);
    let mu = pick.mu();
    match kind {
        "dfg" | "generalised-schlick" => {
            let id = if layout == "visible" { pick.one(&["ggx", "beckmann"]) } else { pick.one(SPLIT) };
            let mut params = model(id, &["alpha", "alpha_x", "alpha_y", "f0", "f90"], pick);
            if kind == "generalised-schlick" {
                let dielectric = pick.0.index(2) == 0;
                params.insert("curve".to_owned(), json!(if dielectric { "dielectric" } else { "power" }));
                let (key, value) =
                    if dielectric { ("eta", pick.log(1.0, 1e3)) } else { ("exponent", pick.log(1e-3, 5e4)) };
                params.insert(key.to_owned(), json!(value));
            }
            let alpha = pick.log(1e-6, 1.0);
            Texel::new(kind, &layout, id, params, &[("mu", mu), ("alpha", alpha)])
        }
        "albedo" | "average-albedo" => {
            let glass = layout != "e" && layout != "e-avg" && layout != "r";
            let narrow: &[&str] =
                &["ggx", "beckmann", "kelemen", "student-t", "torrance-sparrow", "ggx-conductor"];
            let ids: Vec<&str> = models::MODELS.iter().map(|m| m.id).collect();
            let id = match (glass, kind) {
                (true, _) => pick.one(&["ggx-glass", "beckmann-glass"]),
                (_, "albedo") => pick.one(&ids),
                _ => pick.one(narrow),
            };
            let without: &[&str] = if kind == "albedo" && !glass { &[] } else { &["alpha_x", "alpha_y"] };
            let params = model(id, without, pick);
            if kind == "average-albedo" {
                // some axis there must be
                let alpha = pick.log(1e-6, 1.0);
                let mut params = params;
                params.remove("alpha");
                return Texel::new(kind, &layout, id, params, &[("alpha", alpha)]);
            }
            Texel::new(kind, &layout, id, params, &[("mu", mu), ("phi", pick.between(0.0, 6.28))])
        }
        "compensation" => {
            let id = pick.one(&["ggx", "beckmann", "student-t", "kelemen"]);
            let params = model(id, &["alpha_x", "alpha_y"], pick);
            Texel::new(kind, &layout, id, params, &[("mu", mu)])
        }
        "glass-compensation" => {
            let id = pick.one(&["ggx-glass", "beckmann-glass"]);
            let mut params = model(id, &["alpha_x", "alpha_y", "alpha", "eta"], pick);
            params.insert("alpha".to_owned(), json!(pick.log(0.01, 1.0)));
            params.insert("eta".to_owned(), json!(pick.log(1.05, 3.0)));
            Texel::new(kind, &layout, id, params, &[("mu", mu)])
        }
        "sheen-scaling" => {
            let id = pick.one(&["charlie", "charlie-neubelt", "velvet-neubelt", "sggx-fiber", "ltc-sheen"]);
            let mut params = model(id, &[], pick);
            params.insert("sheen".to_owned(), json!(pick.between(0.0, 1.0)));
            Texel::new(kind, &layout, id, params, &[("mu", mu)])
        }
        "ltc-magnitude" => {
            let id = pick.one(&["ggx", "beckmann", "student-t", "kelemen", "phong", "blinn-phong"]);
            let params = model(id, &[], pick);
            Texel::new(kind, "magnitude-fresnel", id, params, &[("mu", mu), ("phi", pick.between(0.0, 6.28))])
        }
        "importance" => {
            let id = pick.one(&["ggx", "beckmann", "lambert", "oren-nayar", "charlie", "kelemen"]);
            let mut params = model(id, &["alpha", "alpha_x", "alpha_y"], pick);
            if models::find(id).unwrap().0.param("alpha").is_some_and(|p| p.id == "alpha") {
                params.insert("alpha".to_owned(), json!(pick.log(0.03, 1.0)));
            }
            if id == "charlie" {
                params.insert("roughness".to_owned(), json!(pick.log(0.1, 1.0)));
            }
            let (u, v) = (pick.unit(), pick.unit());
            Texel::new(kind, &layout, id, params, &[("u", u), ("v", v), ("mu", pick.between(0.05, 1.0))])
        }
        "merl" => {
            let id = pick.one(&["ggx", "beckmann", "kelemen", "torrance-sparrow"]);
            let mut params = model(id, &["alpha_x", "alpha_y", "alpha"], pick);
            params.insert("alpha".to_owned(), json!(pick.log(1e-3, 1.0)));
            let (a, b, c) = (pick.between(0.0, PI), pick.between(0.0, 0.5 * PI), pick.between(0.0, 0.5 * PI));
            Texel::new(kind, &layout, id, params, &[("phi_d", a), ("theta_d", b), ("theta_h", c)])
        }
        "airlight" | "airlight-surface" => fog::attempt(kind, &layout, pick),
        _ => closed::attempt(kind, &layout, pick),
    }
}

/// The truths of a texel's channels.
pub(crate) fn truths(t: &Texel) -> Truths {
    match t.kind.as_str() {
        "dfg" => t.channels().iter().map(|c| dfg(t, c.id)).collect(),
        "ltc-magnitude" => magnitude(t),
        "albedo" => t
            .channels()
            .iter()
            .map(|c| side(t, c.id, &|d| truth::albedo(d).unwrap_or(NONE), &crossing))
            .collect(),
        "average-albedo" => {
            t.channels().iter().map(|c| side(t, c.id, &mean_reflected, &mean_crossing)).collect()
        }
        "compensation" => compensation(t),
        "glass-compensation" => glass(t),
        "generalised-schlick" => generalised(t),
        "sheen-scaling" => {
            let (e, error) = truth::albedo(&t.draw(false)).unwrap_or(NONE);
            let sheen = t.resolved().number("sheen").unwrap();
            let of = |id: &str| {
                if id == "sheen.scaling" { ((1.0 - sheen * e).max(0.0), sheen * error) } else { (e, error) }
            };
            t.channels().iter().map(|c| of(c.id)).collect()
        }
        "importance" | "preintegrated-skin" | "diffusion-kernel" | "diffusion-sampling"
        | "phase-sampling" | "blackbody" | "film-sensitivity" => lines::truths(t),
        "thin-film" | "fresnel-conductor" if t.layout == "srgb" => lines::truths(t),
        "airlight" | "airlight-surface" => fog::truths(t),
        _ => closed::truths(t),
    }
}

/// No truth.
pub(crate) const NONE: (f64, f64) = (0.0, f64::INFINITY);

/// `int (f / F) g(wo.wh) mu_i dwi` of a split model.
fn weighted(draw: &Draw, g: impl Fn(f64) -> f64 + Sync + Copy) -> (f64, f64) {
    if draw.flat() {
        let value = truth::schlick_of(&draw.params).at(draw.mu) * g(draw.mu);
        return (value, 2e-16 * value.abs());
    }
    let Some((lobe, slack)) = truth::half_vector(draw) else { return NONE };
    let lobe = lobe.times(g);
    let (e, error) = two_settings(|s, t| lobe.integrate(draw.mu, draw.phi, s, t));
    (e, error + slack * e)
}

fn power5(v: f64) -> f64 {
    let m = 1.0 - v;
    m * m * m * m * m
}

/// (1 - mu)^5 of the F82 term, 1 at v = 1/7.
fn f82(v: f64) -> f64 {
    v * power5(v) * (1.0 - v) * 823_543.0 / 46_656.0
}

fn plain(id: &str, params: Value, mu: f64) -> (f64, f64) {
    let (info, _) = models::find(id).unwrap();
    let given: Map<String, Value> = params.as_object().unwrap().clone();
    let mut params = models::Params::resolve(info.id, info.params, []).unwrap();
    for (k, v) in &given {
        // not bounded by the range of the parameter
        params.set(k, v.as_f64().unwrap());
    }
    truth::albedo(&Draw { model: info, params, given, mu, phi: 0.0 }).unwrap_or(NONE)
}

fn dfg(t: &Texel, channel: &str) -> (f64, f64) {
    let draw = t.draw(true);
    let alpha = t.axis("alpha");
    match channel {
        "dfg.scale" => weighted(&draw, |v| 1.0 - power5(v)),
        "dfg.bias" | "dfg.fc" => weighted(&draw, power5),
        "dfg.f82" => weighted(&draw, f82),
        "dfg.loss" => {
            let (e, error) = weighted(&draw, |_| 1.0);
            (1.0 - e, error)
        }
        "dfg.rest" => {
            let mirror = power5(draw.mu);
            let ((bias, a), (e, b)) = (weighted(&draw, power5), weighted(&draw, |_| 1.0));
            (bias - mirror * e, a + mirror * b)
        }
        "dfg.cloth" => plain("charlie-neubelt", json!({ "roughness": alpha.max(1e-6) }), draw.mu),
        "dfg.diffuse" => plain("burley-diffuse", json!({ "r": alpha.sqrt() }), draw.mu),
        _ => weighted(&draw, |_| 1.0),
    }
}

fn magnitude(t: &Texel) -> Truths {
    let splits = models::find(&t.model).unwrap().0.splits;
    let draw = t.draw(splits);
    if splits {
        return vec![weighted(&draw, |_| 1.0), weighted(&draw, power5)];
    }
    vec![truth::albedo(&draw).unwrap_or(NONE), NONE]
}

type OfDraw<'a> = &'a dyn Fn(&Draw) -> (f64, f64);

fn crossing(draw: &Draw) -> (f64, f64) {
    truth::transmitted(draw).map_or((0.0, 0.0), |t| t.unwrap_or(NONE))
}

/// A channel named as in `tables/sides.rs`.
fn side(t: &Texel, channel: &str, reflected: OfDraw<'_>, crossing: OfDraw<'_>) -> (f64, f64) {
    let (name, inside) = channel.strip_suffix(".inside").map_or((channel, false), |n| (n, true));
    let mut draw = t.draw(false);
    if inside {
        let eta = 1.0 / draw.params.number("eta").unwrap();
        draw.params.set("eta", eta);
    }
    match name.as_bytes()[0] {
        b'r' => reflected(&draw),
        b't' => crossing(&draw),
        _ => {
            let (r, t) = (reflected(&draw), crossing(&draw));
            (r.0 + t.0, r.1 + t.1)
        }
    }
}

/// `2 int e mu dmu`, in ln mu, with a part at the critical angle.
fn mean(
    draw: &Draw,
    setting: &quad::Setting,
    e: &(dyn Fn(&Draw, &quad::Setting, f64) -> f64 + Sync),
) -> (f64, f64) {
    let eta = draw.params.optional("eta").unwrap_or(f64::NAN);
    let breaks = if eta < 1.0 { vec![((1.0 - eta) * (1.0 + eta)).sqrt()] } else { vec![] };
    let mut ends = vec![quad::mark(0.0), quad::mark(18.0)];
    let inner: Vec<quad::Edge> = breaks.iter().map(|mu| quad::sharp(-mu.ln())).collect();
    ends = quad::sorted(
        ends[0],
        ends[1],
        inner.into_iter().chain([1.0, 2.5, 5.0, 9.0].map(quad::mark)).collect(),
    );
    let sum = setting.pieces(&ends, 10.0 * setting.tolerance, &mut |at, _, _| {
        let mu = (-at.x).exp();
        2.0 * mu * mu * e(&Draw { mu, ..draw.clone() }, setting, setting.tolerance / mu)
    });
    (sum.value, sum.error + 3.0 * setting.tolerance)
}

fn mean_reflected(draw: &Draw) -> (f64, f64) {
    if draw.flat() {
        return mean(draw, &quad::MEDIUM, &|d, _, _| crate::sweep::lobe::fresnel(&d.params).0.at(d.mu));
    }
    let setting = if draw.model.id.ends_with("-glass") { &quad::LOOSE } else { &quad::MEDIUM };
    mean(draw, setting, &|d, setting, tolerance| {
        let (lobe, _) = truth::half_vector(d).unwrap();
        truth::once(&lobe, d.mu, setting, tolerance).value
    })
}

fn mean_crossing(draw: &Draw) -> (f64, f64) {
    if !draw.model.id.ends_with("-glass") {
        return (0.0, 0.0);
    }
    mean(draw, &quad::LOOSE, &truth::transmitted_once)
}

fn compensation(t: &Texel) -> Truths {
    let draw = t.draw(true);
    let (e, error) = weighted(&draw, |_| 1.0);
    let missing = (1.0 - e).max(0.0);
    let needs = t.layout != "turquin";
    let (mean, mean_error) = if needs { mean_reflected(&draw) } else { (1.0, 0.0) };
    let average = (1.0 - mean).max(0.0);
    let of = |id: &str| match id {
        "ms.missing" => (missing, error),
        "ms.missing-avg" => (average, mean_error),
        "ms.turquin" => (missing / e, 2.0 * error / (e * e)),
        _ if average > 0.0 => {
            let value = missing / (PI * average).sqrt();
            (value, error / (PI * average).sqrt() + 0.5 * value * mean_error / average)
        }
        _ => (0.0, 0.0),
    };
    t.channels().iter().map(|c| of(c.id)).collect()
}

fn glass(t: &Texel) -> Truths {
    let above = t.draw(false);
    let mut inside = above.clone();
    let eta = above.params.number("eta").unwrap();
    inside.params.set("eta", 1.0 / eta);
    let missing = |d: &Draw| {
        let (r, t) = (truth::albedo(d).unwrap_or(NONE), crossing(d));
        ((1.0 - (r.0 + t.0)).max(0.0), r.1 + t.1)
    };
    let means = if t.layout == "full" {
        [&above, &inside].map(|d| {
            let (r, t) = (mean_reflected(d), mean_crossing(d));
            (1.0 - (r.0 + t.0), r.1 + t.1)
        })
    } else {
        [(0.0, 0.0); 2]
    };
    let [m, i] = means;
    let x = i.0 / (m.0 + i.0);
    let dx = (m.1 + i.1) / (m.0 + i.0);
    let pass = |eta: f64| 1.0 - closed::dielectric_average(eta);
    t.channels()
        .iter()
        .map(|c| match c.id {
            "ms.missing" => missing(&above),
            "ms.missing.inside" => missing(&inside),
            "ms.missing-avg" => m,
            "ms.missing-avg.inside" => i,
            "ms.reflect" => (1.0 - x * pass(eta), dx),
            _ => (1.0 - (1.0 - x) * pass(1.0 / eta), dx),
        })
        .collect()
}

fn generalised(t: &Texel) -> Truths {
    let own = t.resolved();
    let draw = t.draw(true);
    let (exponent, eta) = (own.number("exponent").unwrap(), own.number("eta").unwrap());
    let dielectric = own.choice("curve").unwrap() == "dielectric";
    let f0 = fresnel::dielectric(1.0, eta).unpolarised();
    let curve = move |v: f64| {
        if dielectric {
            ((fresnel::dielectric(v, eta).unpolarised() - f0) / (1.0 - f0)).max(0.0)
        } else {
            (1.0 - v).max(0.0).powf(exponent)
        }
    };
    let value = match t.layout.as_str() {
        "part" => weighted(&draw, curve),
        "visible" => {
            if draw.flat() {
                (curve(draw.mu), 1e-15)
            } else {
                let lobe =
                    crate::sweep::lobe::visible(&draw.model.id[..], draw.params.number("alpha").unwrap())
                        .times(curve);
                two_settings(|s, t| lobe.integrate(draw.mu, 0.0, s, t))
            }
        }
        _ => {
            let ((s, a), (e, b)) = (weighted(&draw, curve), weighted(&draw, |_| 1.0));
            (s / e, (a + s / e * b) / e)
        }
    };
    let _ = schlick::weight(1.0);
    vec![value]
}
