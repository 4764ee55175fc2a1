//! Kinds that are integrals over one or two variables, or quantiles of such: spectra, diffusion, phase functions, samples.

use crate::sweep::closed::{Phase, Profile, conductor};
use crate::sweep::kinds::{NONE, Truths};
use crate::sweep::quad::{self, Edge, Setting, mark, sharp, sorted};
use crate::sweep::texel::Texel;
use brdfbake::models::{Brdf, Params};
use brdfbake::terms::blackbody::{planck, wyman_xyz, xyz_to_srgb};
use brdfbake::terms::colour::{cie_xyz, d65};
use brdfbake::terms::metals;
use brdfbake::terms::thin_film::{self, Film};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

pub(crate) fn truths(t: &Texel) -> Truths {
    let p = t.resolved();
    match t.kind.as_str() {
        "thin-film" => {
            let film = Film {
                n2: p.number("n2").unwrap(),
                n3: p.number("n3").unwrap(),
                k3: p.number("k3").unwrap(),
                d_nm: t.axis("film"),
            };
            daylight(&[], &|lambda| thin_film::airy(&film, t.axis("mu"), lambda).unpolarised())
        }
        "fresnel-conductor" => {
            let metal = metals::find(p.choice("metal").unwrap());
            let kinks: Vec<f64> = metal.into_iter().flat_map(|m| m.rows).map(|row| row[0]).collect();
            daylight(&kinks, &|lambda| {
                let (n, k) =
                    metal.map_or((p.number("n").unwrap(), p.number("k").unwrap()), |m| m.index(lambda));
                let [s, p] = conductor(t.axis("mu"), n, k);
                0.5 * (s + p)
            })
        }
        "film-sensitivity" => sensitivity(t, &p),
        "blackbody" => blackbody(t, &p),
        "preintegrated-skin" => skin(t, &p),
        "diffusion-kernel" => kernel(t, &p),
        "diffusion-sampling" => sampling(t, &p),
        "phase-sampling" => vec![phase(t, &p)],
        _ => importance(t),
    }
}

/// Ends of the fitted curves of the eye, between 360 and 830 nm.
fn spectrum() -> Vec<Edge> {
    let eye = [437.0, 442.0, 459.0, 501.1, 530.9, 568.8, 599.8];
    sorted(mark(360.0), mark(830.0), eye.iter().map(|x| mark(*x)).collect())
}

/// Two settings of one integral: value and error.
fn both(mut run: impl FnMut(&Setting) -> f64) -> (f64, f64) {
    let (a, b) = (run(&quad::FIRST), run(&quad::SECOND));
    (b, (a - b).abs() + 1e-15 * b.abs())
}

/// Linear sRGB of a reflectance under D65, a white mirror being 1.
fn daylight(kinks: &[f64], f: &dyn Fn(f64) -> f64) -> Truths {
    let kinks = kinks.iter().copied().filter(|k| *k > 360.0 && *k < 830.0 && k.fract() > 0.0);
    let edges = sorted(mark(360.0), mark(830.0), (361..830).map(f64::from).chain(kinks).map(mark).collect());
    let sum = |c: usize, f: &dyn Fn(f64) -> f64| {
        both(|s| {
            s.pieces(&edges, 1e3 * s.tolerance, &mut |at, _, _| {
                f(at.x) * d65(at.x) * xyz_to_srgb(cie_xyz(at.x))[c]
            })
            .value
        })
    };
    (0..3)
        .map(|c| {
            let (white, value) = (sum(c, &|_| 1.0), sum(c, f));
            (value.0 / white.0, (value.1 + value.0.abs() / white.0 * white.1) / white.0 + 1e-14)
        })
        .collect()
}

/// Transforms of the observer, which is straight between whole nm, over the wavelength: real parts, then imaginary ones.
fn sensitivity(t: &Texel, p: &Params) -> Truths {
    let (opd, scale) = (t.axis("opd"), p.number("scale").unwrap());
    let edges = sorted(mark(360.0), mark(830.0), (361..830).map(f64::from).map(mark).collect());
    let part = |c: usize| {
        let wave = |lambda: f64| {
            let turns = (opd / lambda).fract() * TAU;
            if c < 3 { turns.cos() } else { -turns.sin() }
        };
        both(|s| {
            s.pieces(&edges, 1e3 * s.tolerance, &mut |at, _, _| scale * wave(at.x) * cie_xyz(at.x)[c % 3])
                .value
        })
    };
    (0..6).map(part).collect()
}

fn blackbody(t: &Texel, p: &Params) -> Truths {
    let temperature = t.axis("temperature");
    let fitted = p.choice("eye").unwrap() == "wyman-2013";
    let standard = || sorted(mark(360.0), mark(830.0), (361..830).map(f64::from).map(mark).collect());
    let edges = if fitted { spectrum() } else { standard() };
    let eye = |lambda: f64| if fitted { wyman_xyz(lambda) } else { cie_xyz(lambda) };
    let scale = |temperature: f64| planck(560.0, temperature);
    let sum = |temperature: f64, weight: &dyn Fn([f64; 3]) -> f64| {
        let unit = scale(temperature);
        both(|s| {
            s.pieces(&edges, 1e2 * s.tolerance, &mut |at, _, _| {
                planck(at.x, temperature) / unit * weight(eye(at.x))
            })
            .value
        })
    };
    let y = sum(temperature, &|xyz| xyz[1]);
    let reference = sum(p.number("reference").unwrap(), &|xyz| xyz[1]);
    let factor = match t.layout.as_str() {
        "light" => y.0 * scale(temperature) / (reference.0 * scale(p.number("reference").unwrap())),
        _ => 1.0,
    };
    (0..3)
        .map(|c| {
            let v = sum(temperature, &|xyz| xyz_to_srgb(xyz)[c]);
            let value = factor * v.0 / y.0;
            let error = factor * (v.1 + v.0.abs() / y.0 * y.1) / y.0 + 1e-13 * value.abs();
            (if t.layout == "hue-unclamped" { value } else { value.max(0.0) }, error)
        })
        .collect()
}

fn skin(t: &Texel, p: &Params) -> Truths {
    let profile = Profile::new(p);
    let (mu, curvature) = (t.axis("ndotl"), t.axis("curvature"));
    let (theta, r) = (mu.acos(), 1.0 / curvature);
    let sphere = p.choice("over").unwrap() == "sphere";
    (0..3)
        .map(|c| {
            let mut inner: Vec<Edge> =
                [FRAC_PI_2 - theta, theta - FRAC_PI_2, 1.5 * PI - theta, theta + FRAC_PI_2]
                    .map(mark)
                    .to_vec();
            let far = |length: f64| 2.0 * (0.5 * length / r).min(1.0).asin();
            inner.extend(profile.lengths(c).into_iter().map(|l| mark(far(l))));
            inner.push(mark(far(profile.end(c))));
            let edges = sorted(sharp(0.0), sharp(PI), inner);
            let sum = |s: &Setting, lit: bool, unit: f64| {
                s.pieces(&edges, s.tolerance, &mut |at, _, _| {
                    let (sin, cos) = (0.5 * at.x).sin_cos();
                    let chord = 2.0 * r * sin;
                    let ring = profile.ring(c, chord) / unit;
                    let weight = if sphere { ring * r * cos } else { ring / (TAU * chord) };
                    if !lit {
                        return weight;
                    }
                    weight * if sphere { circle(theta, at.x) } else { sides(theta, at.x) }
                })
                .value
            };
            let unit = sum(&quad::COARSE, false, 1.0);
            both(|s| sum(s, true, unit) / sum(s, false, unit))
        })
        .map(|(v, e)| (v, e + 1e-13))
        .collect()
}

fn sides(theta: f64, x: f64) -> f64 {
    0.5 * ((theta + x).cos().max(0.0) + (theta - x).cos().max(0.0))
}

/// Mean of the clamped cosine over a circle, by quadrature.
fn circle(theta: f64, beta: f64) -> f64 {
    let (a, b) = (theta.cos() * beta.cos(), theta.sin() * beta.sin());
    let end = if b > 0.0 {
        (-a / b).clamp(-1.0, 1.0).acos()
    } else if a > 0.0 {
        PI
    } else {
        0.0
    };
    if end <= 0.0 {
        return 0.0;
    }
    quad::SECOND.adaptive(&[0.0, end], 1e-15, &mut |phi| a + b * phi.cos()).value / PI
}

fn kernel(t: &Texel, p: &Params) -> Truths {
    let profile = Profile::new(p);
    let x = t.axis("offset");
    (0..3)
        .map(|c| {
            let end = profile.end(c);
            let lengths = || profile.lengths(c).into_iter().map(mark);
            let line = |s: &Setting, x: f64, tolerance: f64| {
                let inner = lengths().chain([mark(x)]).collect();
                let edges = sorted(sharp(0.0), mark(end), inner);
                let at = |y: f64| {
                    let r = x.hypot(y);
                    2.0 * profile.ring(c, r) / (TAU * r)
                };
                s.pieces(&edges, tolerance, &mut |y, _, _| at(y.x)).value
            };
            if t.layout == "line" {
                let rough = line(&quad::COARSE, x, 0.0);
                return both(|s| line(s, x, s.tolerance * rough.max(1e-300)));
            }
            let edges = sorted(sharp(0.0), mark(x), lengths().collect());
            both(|s| {
                s.pieces(&edges, s.tolerance, &mut |at, tolerance, _| 2.0 * line(s, at.x, tolerance)).value
            })
        })
        .map(|(v, e)| (v, e + 1e-13 * v.abs()))
        .collect()
}

/// The x where a rising function passes 0, by halving between its ends.
fn root(mut lo: f64, mut hi: f64, f: &dyn Fn(f64) -> f64) -> f64 {
    for _ in 0..200 {
        let middle = if lo > 0.0 && hi / lo > 4.0 { (lo * hi).sqrt() } else { 0.5 * (lo + hi) };
        if middle <= lo || middle >= hi {
            break;
        }
        if f(middle) < 0.0 { lo = middle } else { hi = middle }
    }
    0.5 * (lo + hi)
}

fn sampling(t: &Texel, p: &Params) -> Truths {
    let profile = Profile::new(p);
    let u = t.axis("u").min(1.0 - 0.5 * f64::EPSILON);
    (0..3)
        .map(|c| {
            let end = profile.end(c);
            if u <= 0.0 {
                return (0.0, 0.0);
            }
            // each side of the median by its own integral
            let miss = |r: f64| {
                if u < 0.5 { profile.part(c, 0.0, r) - u } else { (1.0 - u) - profile.part(c, r, end) }
            };
            let r = root(1e-12 * profile.lengths(c)[0], end, &miss);
            (r, 1e-14 * r + (1e-15 + 1e-14 * u.min(1.0 - u)) / profile.ring(c, r))
        })
        .collect()
}

/// The deflection beyond which the part u lies.
fn phase(t: &Texel, p: &Params) -> (f64, f64) {
    let (f, u) = (Phase::new(p), t.axis("u"));
    let width = (1.0 - p.number("g").unwrap().abs()).clamp(1e-3, 1.0);
    let density = |theta: f64| TAU * f.at(theta) * theta.sin();
    let part = |a: f64, b: f64| {
        let inner = [width, 3.0 * width, PI - width, PI - 3.0 * width, 0.1, 0.5, PI - 0.5].map(mark).to_vec();
        let end = |x: f64| if x > 0.0 && x < PI { mark(x) } else { sharp(x) };
        quad::SECOND.pieces(&sorted(end(a), end(b), inner), 1e-16, &mut |at, _, _| density(at.x)).value
    };
    // from the side that holds less
    let miss = |theta: f64| if u < 0.5 { u - part(theta, PI) } else { part(0.0, theta) - (1.0 - u) };
    let theta = if u <= 0.0 {
        PI
    } else if u >= 1.0 {
        0.0
    } else if u < 0.5 {
        // from below: pi - theta keeps its digits
        PI - root(1e-9, PI, &|off| -miss(PI - off))
    } else {
        root(1e-9, PI, &miss)
    };
    let off = (1e-16 + 2e-15 * u.min(1.0 - u)) / density(theta).max(1e-300);
    let off = (off + 1e-15).min(1e-7);
    if t.layout == "angle" {
        (theta, off)
    } else {
        (theta.cos(), off * theta.sin() + 0.5 * off * off + 2e-16)
    }
}

/// Directions by the marginal over theta and the conditional density over phi.
fn importance(t: &Texel) -> Truths {
    let draw = t.draw(false);
    let model: Box<dyn Brdf> = (draw.model.build)(&draw.params).unwrap();
    if model.turns() || model.mirror(1.0).is_some() {
        return t.channels().iter().map(|_| NONE).collect();
    }
    let mu = draw.mu;
    let wo = DVec3::new(((1.0 - mu) * (1.0 + mu)).sqrt(), 0.0, mu);
    let theta_o = mu.acos();
    let alpha = draw.params.optional("alpha").unwrap_or(1.0);
    let f = |theta: f64, phi: f64| {
        let (sin, cos) = theta.sin_cos();
        model.eval(wo, DVec3::new(sin * phi.cos(), sin * phi.sin(), cos))
    };
    let azimuth = |theta: f64, from: f64, to: f64, tolerance: f64| {
        let near = [0.5 * alpha, 2.0 * alpha, 8.0 * alpha].map(|a| mark(PI - a));
        let edges = sorted(mark(from), mark(to), near.into_iter().chain([mark(FRAC_PI_2)]).collect());
        quad::FIRST.pieces(&edges, tolerance, &mut |at, _, _| f(theta, at.x)).value
    };
    let marginal = |a: f64, b: f64, tolerance: f64| {
        let near = [-8.0, -2.0, -0.5, 0.0, 0.5, 2.0, 8.0].map(|k| mark(theta_o + k * alpha));
        let edges = sorted(mark(a), mark(b), near.to_vec());
        quad::FIRST
            .pieces(&edges, tolerance, &mut |at, inner, _| {
                let (sin, cos) = at.x.sin_cos();
                2.0 * sin * cos * azimuth(at.x, 0.0, PI, inner / (sin * cos).max(1e-6))
            })
            .value
    };
    let (u, v) = (t.axis("u"), t.axis("v"));
    let total = marginal(0.0, FRAC_PI_2, 1e-10);
    let tolerance = 1e-12 * total;
    let total = marginal(0.0, FRAC_PI_2, tolerance);
    // halving, the part below the lower end known
    let (mut lo, mut hi, mut below) = (0.0, FRAC_PI_2, 0.0);
    while hi - lo > 1e-13 {
        let middle = 0.5 * (lo + hi);
        let more = marginal(lo, middle, tolerance);
        if below + more < u * total {
            (lo, below) = (middle, below + more);
        } else {
            hi = middle;
        }
    }
    let theta = 0.5 * (lo + hi);
    let (sin, cos) = theta.sin_cos();
    let all = azimuth(theta, 0.0, PI, 0.0);
    let half = 1.0 - (2.0 * v - 1.0).abs();
    let phi = root(0.0, PI, &|phi| azimuth(theta, 0.0, phi, 1e-13 * all) - half * all);
    let phi = if v > 0.5 { TAU - phi } else { phi };
    let off = 1e-10;
    let theta_off = 4e-12 * total / (2.0 * sin * cos * all).max(1e-300) + 1e-13;
    let density = f(theta, phi);
    // how far the azimuth moves with the angle is not known: a part of it
    let phi_off = 3e-13 * all / density.max(1e-300) + 10.0 * theta_off + off * 1e-3;
    let spread = theta_off + sin * phi_off;
    let value = |id: &str| match id {
        "wi.x" => (sin * phi.cos(), spread),
        "wi.y" => (sin * phi.sin(), spread),
        "wi.z" => (cos, sin * theta_off + theta_off * theta_off),
        "mu_i" => (cos, sin * theta_off + theta_off * theta_off),
        "phi" => (phi, phi_off),
        // f at the product's own direction
        _ => NONE,
    };
    t.channels().iter().map(|c| value(c.id)).collect()
}
