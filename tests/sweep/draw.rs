//! Seeded draws of models, parameters and views from the ranges that the parameters declare.

use brdfbake::models::{Kind, ModelInfo, Param, Params};
use brdfbake::verify::seeds::Seeds;
use serde_json::{Map, Value, json};
use std::f64::consts::TAU;

/// Seed of the draws that gains are calibrated on.
pub(crate) const CALIBRATION: u64 = 0x0ca1_1b7a_7e00;
/// Seed of the draws of the test.
pub(crate) const TEST: u64 = 0x7e57_5eed_0001;

/// A model with its parameters and a view.
#[derive(Debug, Clone)]
pub(crate) struct Draw {
    pub(crate) model: &'static ModelInfo,
    pub(crate) params: Params,
    pub(crate) given: Map<String, Value>,
    pub(crate) mu: f64,
    pub(crate) phi: f64,
}

/// The draw of a number: a row keeps its draw when others are added.
pub(crate) fn draw(model: &'static ModelInfo, seed: u64, number: u64) -> Draw {
    let mut hash = seed ^ number.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    for byte in model.id.bytes() {
        hash = (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
    }
    let mut seeds = Seeds::new(hash);
    for _ in 0..1000 {
        let given = parameters(model, &mut seeds);
        let mu = view(&mut seeds);
        let phi = TAU * seeds.unit();
        let resolved = Params::resolve(model.id, model.params, given.iter().map(|(k, v)| (k.as_str(), v)));
        let Ok(params) = resolved else { continue };
        if (model.build)(&params).is_ok() {
            return Draw { model, params, given, mu, phi };
        }
    }
    panic!("{}: no draw of a thousand can be built", model.id);
}

/// Cosines: the special ones in a quarter of the draws, else spread over six decades.
pub(crate) fn view(seeds: &mut Seeds) -> f64 {
    const SPECIAL: [f64; 4] = [0.0, 1e-154, 1e-12, 1.0];
    if seeds.index(4) == 0 { SPECIAL[seeds.index(4)] } else { libm::pow(10.0, -6.0 * seeds.unit()) }
}

pub(crate) fn parameters(model: &ModelInfo, seeds: &mut Seeds) -> Map<String, Value> {
    let mut given = Map::new();
    // of two widths that follow a common one, half of the draws give both
    let split = seeds.index(2) == 0;
    for param in model.params {
        let follows =
            matches!(param.kind, Kind::Number { preset: brdfbake::models::DefaultValue::Of(_), .. });
        let value = match param.kind {
            Kind::Choice(words) => json!(words[seeds.index(words.len())]),
            Kind::Number { min, max, .. } => json!(number(param, min, max, seeds)),
            Kind::Rows { columns, .. } => {
                let rows = seeds.index(4);
                let cell = |seeds: &mut Seeds, c: &brdfbake::models::Column| {
                    let u = seeds.unit();
                    if c.max > 100.0 {
                        libm::expm1(u * libm::log1p(c.max))
                    } else {
                        c.min + (c.max - c.min) * u
                    }
                };
                let row = |seeds: &mut Seeds| columns.iter().map(|c| cell(seeds, c)).collect::<Vec<f64>>();
                json!((0..rows).map(|_| row(seeds)).collect::<Vec<_>>())
            }
        };
        if !follows || split {
            given.insert(param.id.to_owned(), value);
        }
    }
    given
}

/// Ends in a sixth of the draws; widths and indices by their logarithm, exponents up to their end, the rest uniformly.
fn number(param: &Param, min: f64, max: f64, seeds: &mut Seeds) -> f64 {
    match seeds.index(12) {
        0 => return min,
        1 => return max,
        _ => {}
    }
    let u = seeds.unit();
    let log = |lo: f64, hi: f64| (lo * libm::pow(hi / lo, u)).clamp(min, max);
    match param.id {
        "eta" if seeds.index(2) == 0 => log(0.3, 3.0),
        "eta" | "k" => log(min.max(1e-6), max),
        "gamma" if max > 100.0 => (1.5 + log(1e-3, 1e8)).clamp(min, max),
        _ if max > 100.0 => libm::expm1(u * libm::log1p(max)),
        _ if max <= 2.0 && is_width(param.id) => log(min.max(1e-6), max),
        _ => min + (max - min) * u,
    }
}

/// Is it the width of a lobe? `sigma` of Oren and Nayar goes to pi/2 and is none.
fn is_width(id: &str) -> bool {
    id.starts_with("alpha") || id == "m" || id.ends_with("roughness") || id == "sigma"
}
