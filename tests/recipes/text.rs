//! The text of a plan reads back to the same plan: of every preset, of every engine, and of a thousand random plans.

use brdfbake::encode::ENCODERS;
use brdfbake::grid::fit::Texels;
use brdfbake::grid::provenance::Waiver;
use brdfbake::grid::{Axis, Direction, Texel, Warp};
use brdfbake::models::{Kind, MODELS, ModelInfo, Param};
use brdfbake::plan::{Output, Plan, Sizing, TableRequest};
use brdfbake::recipe::{ENGINES, PRESETS, parse, text};
use brdfbake::tables::driver::OnMiss;
use brdfbake::tables::spec::Request;
use brdfbake::tables::{Mix, ModelUse, TABLES};
use brdfbake::verify::seeds::Seeds;
use rayon::prelude::*;
use std::collections::BTreeSet;

fn assert_reads_back(what: &str, plan: &Plan) {
    let written = text(&plan.name, &plan.requests());
    let again = parse(&written, "again.toml").unwrap_or_else(|e| panic!("{what}: {e}\n{written}"));
    assert_eq!(again.canonical(), plan.canonical(), "{what}\n{written}");
    assert_eq!(again.hash, plan.hash, "{what}\n{written}");
    for (a, b) in again.tables.iter().zip(&plan.tables) {
        assert_eq!(a.identity, b.identity, "{what}\n{written}");
        assert_eq!(format!("{:?}", a.bound.spec), format!("{:?}", b.bound.spec), "{what}\n{written}");
        assert_eq!((&a.outputs, a.files()), (&b.outputs, b.files()), "{what}\n{written}");
        assert_eq!(a.tolerance.to_bits(), b.tolerance.to_bits(), "{what}\n{written}");
    }
    assert_eq!(text(&again.name, &again.requests()), written, "{what}");
}

#[test]
fn presets_and_engines_read_back() {
    for p in PRESETS {
        assert_reads_back(p.id, &p.plan().unwrap());
    }
    for e in ENGINES {
        assert_reads_back(e.id, &e.plan().unwrap());
    }
}

/// The same plans on every machine.
struct Random(Seeds);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0.index(n)
    }
    fn unit(&mut self) -> f64 {
        self.0.unit()
    }
    fn one_in(&mut self, n: usize) -> bool {
        self.below(n) == 0
    }
    fn of<T: Clone>(&mut self, all: &[T]) -> T {
        all[self.below(all.len())].clone()
    }
    fn between(&mut self, [lo, hi]: [f64; 2]) -> f64 {
        lo + (hi - lo) * self.unit()
    }
}

const TEXTS: &[&str] = &["plain", "\"quoted\" \\ and 'more'", "two\nlines\tand a tab", "µ₀ → 1, \u{7f}\u{1}"];

fn param(random: &mut Random, p: &Param) -> Option<serde_json::Value> {
    match p.kind {
        Kind::Number { min, max, .. } => Some(random.between([min, max.min(min + 10.0)]).into()),
        Kind::Choice(words) => Some(random.of(words).into()),
        Kind::Rows { .. } => None,
    }
}

fn axis(random: &mut Random, mut axis: Axis) -> Axis {
    axis.len = 2 + random.below(30);
    let [lo, hi] = axis.domain;
    if random.one_in(3) {
        axis.domain = [lo + 0.25 * (hi - lo) * random.unit(), hi - 0.25 * (hi - lo) * random.unit()];
    }
    if random.one_in(3) {
        let [lo, hi] = axis.domain;
        axis.clamp = Some([lo + 0.1 * (hi - lo) * random.unit(), hi]);
    }
    if random.one_in(2) {
        axis.warp = random.of(&[
            Warp::Linear,
            Warp::Power(0.5),
            Warp::Power(1.0 / 3.0),
            Warp::OneMinusPower(0.7),
            Warp::Coupled { to: "alpha".into(), power: 2.5, scale: 1.0 / 3.0, exponent: 0.5 },
        ]);
    }
    if random.one_in(3) {
        axis.texel = random.of(&[Texel::Center, Texel::Endpoint]);
        axis.direction = random.of(&[Direction::Ascending, Direction::Descending]);
        axis.offset = random.between([-1.0, 1.0]);
    }
    axis
}

fn output(random: &mut Random) -> Output {
    let encoder = random.of(ENCODERS);
    let mut output = Output::new(encoder, random.of(encoder.storages()));
    for option in encoder.options() {
        if random.one_in(4) {
            output = output.with(*option);
        }
    }
    output
}

/// A table as somebody might ask for it; many are refused.
fn table(random: &mut Random, name: &str) -> TableRequest {
    let kind = random.of(TABLES);
    let mut request = Request { kind: kind.id.to_owned(), ..Request::default() };
    let model = match kind.model {
        ModelUse::None => None,
        ModelUse::Any(own) | ModelUse::Split(own) if random.one_in(2) => {
            MODELS.iter().find(|m| m.id == own).copied()
        }
        _ => {
            // a look at what a model does not claim takes long: few of those
            let claims = |m: &&ModelInfo| m.laws.passive && m.laws.reciprocal;
            let all = random.one_in(16);
            let models: Vec<&ModelInfo> = MODELS.iter().copied().filter(|m| all || claims(m)).collect();
            Some(random.of(&models))
        }
    };
    request.model = model.map(|m| m.id.to_owned());
    match kind.mix {
        Mix::Free(_) if random.one_in(2) => {
            let pool = kind.pool();
            let channels: BTreeSet<&str> = (0..3).map(|_| random.of(&pool).id).collect();
            request.channels = Some(channels.into_iter().map(str::to_owned).collect());
        }
        _ => request.layout = Some(random.of(kind.layouts).id.to_owned()),
    }
    for p in kind.params.iter().chain(model.iter().flat_map(|m| m.params)) {
        if random.one_in(4)
            && let Some(value) = param(random, p)
        {
            request.params.insert(p.id.to_owned(), value);
        }
    }
    if random.one_in(2)
        && let Ok(bound) = request.bind()
    {
        request.axes = Some(bound.spec.grid.axes().iter().map(|a| axis(random, a.clone())).collect());
    }
    let mut asked = TableRequest::new(name, request);
    asked.outputs = Some((0..1 + random.below(2)).map(|_| output(random)).collect());
    if random.one_in(2) {
        asked.tolerance = Some(libm::pow(10.0, -1.0 - 5.0 * random.unit()));
    }
    asked.on_miss = random.of(&OnMiss::ALL);
    asked.reconstruction = random.of(&[None, Some(false), Some(true)]);
    asked.texels = random.of(&Texels::ALL);
    if random.one_in(3) {
        let axes = asked.request.axes.as_ref().map_or(0, Vec::len);
        asked.size = Some(Sizing {
            error: libm::pow(10.0, -1.0 - 4.0 * random.unit()),
            practical: random.one_in(2),
            warps: random.one_in(2),
            longest: 8 + random.below(2000),
            axes: (0..axes).filter(|_| random.one_in(2)).collect(),
        });
    }
    for law in kind.laws {
        if random.one_in(3) {
            asked.waivers.push(Waiver { law: (*law).to_owned(), reason: random.of(TEXTS).to_owned() });
        }
    }
    if random.one_in(3) {
        asked.file = Some(format!("{name}.bin"));
        asked.before = random.one_in(2).then(|| random.of(TEXTS).to_owned());
        asked.after = random.one_in(2).then(|| random.of(TEXTS).to_owned());
    }
    asked
}

/// Kinds and keys of so many plans of a seed, each of which was read back.
fn read_back(seed: u64, count: usize) -> (BTreeSet<&'static str>, BTreeSet<String>) {
    let mut random = Random(Seeds::new(seed));
    let (mut plans, mut tries) = (0, 0);
    let (mut kinds, mut keys) = (BTreeSet::new(), BTreeSet::new());
    while plans < count {
        tries += 1;
        assert!(tries < 1000 * count, "{plans} plans of {tries}");
        let name = random.of(&["a", "b-2", "mine"]);
        let tables = (0..1 + random.below(2)).map(|i| table(&mut random, &format!("T_{i}"))).collect();
        let Ok(plan) = Plan::from_requests(name, tables) else { continue };
        plans += 1;
        for t in &plan.tables {
            kinds.insert(t.bound.spec.kind.id);
            keys.extend(t.canonical().as_object().unwrap().keys().cloned());
        }
        assert_reads_back(&format!("seed {seed}, plan {plans}"), &plan);
    }
    (kinds, keys)
}

#[test]
fn a_thousand_random_plans_read_back() {
    let all: Vec<_> = (0..8_u64).into_par_iter().map(|seed| read_back(seed, 125)).collect();
    for kind in TABLES {
        assert!(all.iter().any(|(kinds, _)| kinds.contains(kind.id)), "{} is in no plan", kind.id);
    }
    let keys: BTreeSet<&str> = all.iter().flat_map(|(_, keys)| keys.iter().map(String::as_str)).collect();
    // a new key does not compile until it is here
    let asked = TableRequest {
        name: String::new(),
        request: Request::default(),
        file: Some(String::new()),
        before: Some(String::new()),
        after: Some(String::new()),
        tolerance: Some(0.0),
        outputs: Some(Vec::new()),
        on_miss: OnMiss::Report,
        reconstruction: Some(true),
        size: Some(Sizing::default()),
        texels: Texels::Better,
        waivers: vec![Waiver { law: String::new(), reason: String::new() }],
    };
    let own = serde_json::to_value(&asked).unwrap();
    let meaning = ["axis", "channels", "kind", "layout", "model", "name", "params"];
    for key in own.as_object().unwrap().keys().map(String::as_str).chain(meaning) {
        assert!(keys.contains(key), "no random plan has `{key}`: let `table` above ask for it");
    }
}
