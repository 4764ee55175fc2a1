//! Which convention a table of unknown origin follows: its numbers against split sums and albedos under every arrangement of axes,
//! rows, texels and channels that shipped tables are known to have.
//!
//! At seeded pixels the exact values of a candidate are compared with the file's. Arrangements are tried with one model; then every
//! model that can stand in a split sum, with each word of its choices, with the best of them; then every arrangement with the best
//! model. The error of a candidate is the mean over pixels and channels of |file − exact| / max(1, exact), each channel taken for what it is nearest to.

mod text;

use crate::cancel::{Cancel, Cancelled};
use crate::encode::read::Plane;
use crate::encode::{Image, raw_rgbd};
use crate::grid::{Axis, Quantity, Texel};
use crate::models::{Kind, MODELS, ModelInfo};
use crate::picture::Space;
use crate::tables::spec::{Bound, Request};
use crate::verify::seeds::Seeds;
use rayon::prelude::*;
use serde::Serialize;
use serde_json::{Map, json};

/// Mean error above which no candidate is said to fit. Shipped tables of sampled integrals are within 2e-3 of theirs on average, those
/// in 8 bits within 4e-3.
pub const FITS: f64 = 5e-3;

/// Pixels that are compared.
const PIXELS: usize = 48;

/// Arrangements that every model is tried with.
const FINALISTS: usize = 16;

/// Tolerance of the exact values: far below what a shipped table is off by.
const TOLERANCE: f64 = 1e-4;

/// What a channel may hold.
const MEANINGS: [&str; 8] =
    ["dfg.scale", "dfg.bias", "dfg.total", "dfg.loss", "dfg.f82", "dfg.f82-x16", "dfg.cloth", "dfg.diffuse"];

/// Of them those that a table of one or two channels is compared with.
const FEW: usize = 4;

/// Where the numbers of a convention lie.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Arrangement {
    /// What runs along x; the other runs along y.
    pub x: &'static str,
    /// The warp of the cosine: `mu`, `sqrt(1 - mu)`, `mu^2`.
    pub mu: &'static str,
    /// What the roughness axis is: `roughness` (its square is alpha) or `alpha`.
    pub roughness: &'static str,
    /// The end of the cosine at index 0: `low` or `high`.
    pub mu_first: &'static str,
    /// The end of the roughness at index 0.
    pub roughness_first: &'static str,
    /// Where the texels of the cosine lie: `(i + 1/2) / n`, `i / (n - 1)`, `i / n`, `(i + 1) / n`.
    pub mu_texel: &'static str,
    /// The same of the roughness, and `(i + 3/2) / n`.
    pub roughness_texel: &'static str,
}

/// A candidate and how far the file is from it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Candidate {
    /// Where the numbers lie.
    pub arrangement: Arrangement,
    /// Model and its words, such as `ggx masking = separable`.
    pub model: String,
    /// What each channel of the file holds.
    pub channels: Vec<String>,
    /// How the numbers were decoded: `as stored`, `sRGB` or `RGBD`.
    pub decoded: &'static str,
    /// Mean error.
    pub mean: f64,
    /// Largest error.
    pub largest: f64,
    /// The pixel of the largest.
    pub at: [usize; 2],
}

/// The candidates of a file, the best first: one for each value of each property, with the others at their best.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Recognised {
    /// The best.
    pub best: Candidate,
    /// Does it fit ([`FITS`])?
    pub fits: bool,
    /// What was changed, and the best candidate with that.
    pub others: Vec<(String, Candidate)>,
}

/// A function of the texel's number and of the count.
type Place = fn(f64, f64) -> f64;

const TEXELS: [(&str, Place); 5] = [
    ("(i + 1/2) / n", |i, n| (i + 0.5) / n),
    ("i / (n - 1)", |i, n| if n > 1.0 { i / (n - 1.0) } else { 0.0 }),
    ("i / n", |i, n| i / n),
    ("(i + 1) / n", |i, n| (i + 1.0) / n),
    ("(i + 3/2) / n", |i, n| ((i + 1.5) / n).min(1.0)),
];

/// A function of a coordinate.
type Change = fn(f64) -> f64;

/// The cosine of a coordinate.
const WARPS: [(&str, Change); 3] = [("mu", |u| u), ("sqrt(1 - mu)", |u| 1.0 - u * u), ("mu^2", f64::sqrt)];

/// alpha of a coordinate.
const WIDTHS: [(&str, Change); 2] = [("roughness", |r| r * r), ("alpha", |r| r)];

const ENDS: [&str; 2] = ["low", "high"];

/// Numbers of the choices of an arrangement, in the order of its fields.
type Choice = [usize; 7];

impl Arrangement {
    fn new(c: Choice) -> Arrangement {
        Arrangement {
            x: ["cosine", "roughness"][c[0]],
            mu: WARPS[c[1]].0,
            roughness: WIDTHS[c[2]].0,
            mu_first: ENDS[c[3]],
            roughness_first: ENDS[c[4]],
            mu_texel: TEXELS[c[5]].0,
            roughness_texel: TEXELS[c[6]].0,
        }
    }
}

/// Every arrangement.
fn choices() -> Vec<Choice> {
    let counts = [2, WARPS.len(), WIDTHS.len(), 2, 2, TEXELS.len() - 1, TEXELS.len()];
    let all = counts.iter().product::<usize>();
    let choice = |mut number: usize| {
        counts.map(|n| {
            let c = number % n;
            number /= n;
            c
        })
    };
    (0..all).map(choice).collect()
}

/// mu and alpha of a pixel.
fn point(c: Choice, pixel: [usize; 2], size: [usize; 2]) -> [f64; 2] {
    let coordinate = |axis: usize, texel: usize, reversed: bool| {
        let (i, n) = (pixel[axis], size[axis]);
        let i = if reversed { n - 1 - i } else { i };
        (TEXELS[texel].1)(i as f64, n as f64)
    };
    let (mu_axis, roughness_axis) = (c[0], 1 - c[0]);
    let mu = (WARPS[c[1]].1)(coordinate(mu_axis, c[5], c[3] == 1));
    [mu.clamp(0.0, 1.0), (WIDTHS[c[2]].1)(coordinate(roughness_axis, c[6], c[4] == 1)).clamp(0.0, 1.0)]
}

/// A model with its words.
struct Subject {
    name: String,
    bound: Bound,
}

fn subject(info: &ModelInfo, words: &[(&'static str, &'static str)], meanings: &[&str]) -> Option<Subject> {
    let axis = |id: &str| Quantity::find(id).map(|q| Axis::new(q, 2, Texel::Endpoint));
    let mut params = Map::new();
    for (key, word) in words {
        params.insert((*key).to_owned(), json!(word));
    }
    let request = Request {
        kind: "dfg".to_owned(),
        channels: Some(meanings.iter().map(|m| (*m).to_owned()).collect()),
        model: Some(info.id.to_owned()),
        params,
        axes: Some([axis("mu")?, axis("alpha")?].to_vec()),
        ..Request::default()
    };
    let words: Vec<String> = words.iter().map(|(key, word)| format!("{key} = {word}")).collect();
    let name =
        if words.is_empty() { info.id.to_owned() } else { format!("{} {}", info.id, words.join(", ")) };
    Some(Subject { name, bound: request.bind().ok()? })
}

/// Every model that can stand in a split sum, with each of its words.
fn subjects(meanings: &[&str]) -> Vec<Subject> {
    let mut all = Vec::new();
    for info in MODELS.iter().filter(|m| m.splits) {
        let mut words: Vec<Vec<(&'static str, &'static str)>> = vec![Vec::new()];
        for param in info.params {
            if let Kind::Choice(choices) = param.kind {
                let with = |w: &Vec<_>, c: &'static str| [w.as_slice(), &[(param.id, c)]].concat();
                words = words.iter().flat_map(|w| choices.iter().map(move |c| with(w, c))).collect();
            }
        }
        all.extend(words.iter().filter_map(|w| subject(info, w, meanings)));
    }
    all
}

/// The numbers of the file at the pixels, `[pixel][channel]`.
struct Seen {
    decoded: &'static str,
    values: Vec<Vec<f64>>,
}

/// What the stored numbers may stand for: themselves; in 8 bits also codes of sRGB, and of four channels RGBD.
fn seen(image: &Image, pixels: &[[usize; 2]]) -> Vec<Seen> {
    let value = |c: usize, [x, y]: [usize; 2]| image.channels[c].values[y * image.width + x];
    let count = image.channels.len().min(4);
    let stored: Vec<Vec<f64>> = pixels.iter().map(|p| (0..count).map(|c| value(c, *p)).collect()).collect();
    let eight = image.channels.iter().all(|c| c.sample.id() == "unorm8");
    let mut all = Vec::new();
    if eight {
        #[allow(clippy::cast_possible_truncation, reason = "a code of 8 bits over 255")]
        let decode = |p: &Vec<f64>| p.iter().map(|v| f64::from(Space::Srgb.decode(*v as f32))).collect();
        all.push(Seen { decoded: "sRGB", values: stored.iter().map(decode).collect() });
    }
    if eight && count == 4 {
        let decode = |p: &Vec<f64>| raw_rgbd([p[0], p[1], p[2], p[3]]).to_vec();
        all.push(Seen { decoded: "RGBD", values: stored.iter().map(decode).collect() });
    }
    all.insert(0, Seen { decoded: "as stored", values: stored });
    all
}

/// Errors of a candidate: for each channel of the file the nearest meaning.
fn judge(
    seen: &Seen,
    exact: &[Vec<f64>],
    meanings: &[&str],
    pixels: &[[usize; 2]],
) -> (Vec<String>, f64, f64, [usize; 2]) {
    let count = seen.values.first().map_or(0, Vec::len);
    let (mut channels, mut means, mut largest, mut at) = (Vec::new(), Vec::new(), 0.0f64, [0, 0]);
    for c in 0..count {
        let constant = |value: f64| seen.values.iter().all(|p| (p[c] - value).abs() <= 0.0);
        if let Some(value) = [0.0, 1.0].into_iter().find(|v| constant(*v)) {
            channels.push(format!("{value} everywhere"));
            continue;
        }
        let error = |i: usize, m: usize| (seen.values[i][c] - exact[i][m]).abs() / exact[i][m].max(1.0);
        let mean = |m: usize| (0..pixels.len()).map(|i| error(i, m)).sum::<f64>() / pixels.len() as f64;
        let nearest = (0..meanings.len()).map(|m| (m, mean(m))).min_by(|a, b| a.1.total_cmp(&b.1));
        let Some((m, mean)) = nearest else { continue };
        channels.push(meanings[m].to_owned());
        means.push(mean);
        for (i, pixel) in
            pixels.iter().enumerate().filter(|(i, _)| error(*i, m) > largest).collect::<Vec<_>>()
        {
            if error(i, m) > largest {
                (largest, at) = (error(i, m), *pixel);
            }
        }
    }
    let mean = if means.is_empty() { f64::INFINITY } else { means.iter().sum::<f64>() / means.len() as f64 };
    (channels, mean, largest, at)
}

/// Finds the convention of a picture, or `None` where it has none to find: fewer than 2 x 2 pixels, or nothing but constants.
///
/// # Errors
/// [`Cancelled`].
pub fn recognise(image: &Image, seed: u64, cancel: &Cancel) -> Result<Option<Recognised>, Cancelled> {
    let turned = plane(image);
    let image = turned.as_ref().unwrap_or(image);
    let size = [image.width, image.height];
    if size.iter().any(|n| *n < 2) || image.channels.is_empty() {
        return Ok(None);
    }
    let mut seeds = Seeds::new(seed);
    let pixels: Vec<[usize; 2]> = (0..PIXELS).map(|_| size.map(|n| seeds.index(n))).collect();
    let meanings = if image.channels.len() > 2 { &MEANINGS[..] } else { &MEANINGS[..FEW] };
    let search = Search { size, pixels: &pixels, meanings, seen: seen(image, &pixels), cancel };
    let own = subjects(meanings);
    let Some(first) = own.first() else { return Ok(None) };
    let mut all: Vec<(Choice, Candidate)> = choices()
        .into_par_iter()
        .map(|c| search.candidates(first, c))
        .collect::<Result<Vec<_>, _>>()?
        .concat();
    let nearest = |a: &(Choice, Candidate), b: &(Choice, Candidate)| a.1.mean.total_cmp(&b.1.mean);
    all.sort_by(nearest);
    let mut few: Vec<Choice> = Vec::new();
    for (choice, _) in &all {
        if !few.contains(choice) && few.len() < FINALISTS {
            few.push(*choice);
        }
    }
    let jobs: Vec<(&Subject, Choice)> =
        own[1..].iter().flat_map(|s| few.iter().map(move |c| (s, *c))).collect();
    all.extend(
        jobs.into_par_iter().map(|(s, c)| search.candidates(s, c)).collect::<Result<Vec<_>, _>>()?.concat(),
    );
    let Some(model) = all.iter().min_by(|a, b| nearest(a, b)).map(|b| b.1.model.clone()) else {
        return Ok(None);
    };
    if let Some(subject) = own[1..].iter().find(|s| s.name == model) {
        let again = choices().into_par_iter().map(|c| search.candidates(subject, c));
        all.extend(again.collect::<Result<Vec<_>, _>>()?.concat());
    }
    let best = all.iter().min_by(|a, b| nearest(a, b)).filter(|b| b.1.mean.is_finite()).cloned();
    let Some((choice, best)) = best else { return Ok(None) };
    Ok(Some(Recognised { fits: best.mean <= FITS, others: others(&all, choice, &best), best }))
}

/// An array of two axes is read as one row of many channels: the picture of one channel that it is.
fn plane(image: &Image) -> Option<Image> {
    let (width, first) = (image.channels.len(), image.channels.first()?);
    if image.format != "npy" || image.height != 1 || width < 5 {
        return None;
    }
    let value = |i: usize| image.channels[i % width].values[i / width];
    let values = (0..width * image.width).map(value).collect();
    let channel = Plane { name: "c0".to_owned(), values, ..first.clone() };
    let image = Image { width, height: image.width, channels: vec![channel], ..image.clone() };
    Some(image)
}

/// What was recognised, as text. `name` is how the caller calls the file.
#[must_use]
pub fn words(name: &str, found: Option<&Recognised>) -> String {
    text::recognised(name, found)
}

struct Search<'a> {
    size: [usize; 2],
    pixels: &'a [[usize; 2]],
    meanings: &'a [&'static str],
    seen: Vec<Seen>,
    cancel: &'a Cancel,
}

impl Search<'_> {
    /// The candidate of each way to decode the file. A point that the model refuses rules it out.
    fn candidates(&self, subject: &Subject, c: Choice) -> Result<Vec<(Choice, Candidate)>, Cancelled> {
        self.cancel.check()?;
        let exact = |pixel: &[usize; 2]| {
            let at = point(c, *pixel, self.size);
            let estimate = subject.bound.baker.texel(&at, TOLERANCE).ok()?;
            Some(estimate.value[..self.meanings.len()].to_vec())
        };
        let Some(exact) = self.pixels.iter().map(exact).collect::<Option<Vec<_>>>() else {
            return Ok(Vec::new());
        };
        let of = |seen: &Seen| {
            let (channels, mean, largest, at) = judge(seen, &exact, self.meanings, self.pixels);
            let model = subject.name.clone();
            let arrangement = Arrangement::new(c);
            (c, Candidate { arrangement, model, channels, decoded: seen.decoded, mean, largest, at })
        };
        Ok(self.seen.iter().map(of).collect())
    }
}

/// For each property the best candidate with each other value of it.
fn others(all: &[(Choice, Candidate)], choice: Choice, best: &Candidate) -> Vec<(String, Candidate)> {
    let mut found: Vec<(String, Candidate)> = Vec::new();
    let mut note = |what: String, candidate: &Candidate| {
        match found.iter_mut().find(|f| f.0 == what) {
            Some(known) if candidate.mean < known.1.mean => known.1 = candidate.clone(),
            Some(_) => {}
            None => found.push((what, candidate.clone())),
        };
    };
    for (c, candidate) in all {
        let a = &candidate.arrangement;
        let words = [
            format!("{} along x", a.x),
            format!("cosine as {}", a.mu),
            format!("roughness as {}", a.roughness),
            format!("cosine {} first", a.mu_first),
            format!("roughness {} first", a.roughness_first),
            format!("texels of the cosine at {}", a.mu_texel),
            format!("texels of the roughness at {}", a.roughness_texel),
        ];
        for (_, word) in words.into_iter().enumerate().filter(|(i, _)| c[*i] != choice[*i]) {
            note(word, candidate);
        }
        if candidate.model != best.model {
            note(candidate.model.clone(), candidate);
        }
        if candidate.decoded != best.decoded {
            note(format!("decoded {}", candidate.decoded), candidate);
        }
    }
    found.sort_by(|a, b| a.1.mean.total_cmp(&b.1.mean));
    found
}
