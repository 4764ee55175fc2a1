//! Everything that is listed bakes: every kind with every layout, every free channel and every model, from a recipe of kind, name
//! and model alone; every preset; every engine. What cannot is refused when it is read, with the reason.
//!
//! The short form, on axes of a few texels, runs with the others: every kind with every layout and channel, every kind with every
//! model. All three at once take minutes, on whole axes an hour: `cargo test --release --test baked listed -- --ignored --nocapture`.
#![allow(clippy::unwrap_used, clippy::print_stderr, reason = "test")]

use brdfbake::encode;
use brdfbake::grid::{Axis, Grid};
use brdfbake::models::MODELS;
use brdfbake::pipeline::{self, PipelineError, Settings, Silent, TableRecord};
use brdfbake::plan::{Output, Plan, PlannedTable, TableRequest};
use brdfbake::recipe::{ENGINES, PRESETS};
use brdfbake::tables::driver::{self, Options};
use brdfbake::tables::spec::Request;
use brdfbake::tables::{Bound, Mix, ModelUse, TABLES};
use brdfbake::verify;
use std::collections::BTreeMap;
use std::fmt::Debug;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, OnceLock};

/// What becomes of a recipe.
#[derive(Debug, Clone, PartialEq)]
enum End {
    Baked,
    /// When it is read.
    Refused(String),
    /// Too late.
    Failed(String),
}

/// Words of which a refusal has one: each is a reason that a person can act on.
const REASONS: &[&str] = &[
    "does not transmit; all its light is in channel",
    "has no parameter eta, so it has no inside",
    "has a Fresnel factor that cannot be split off; use one with",
    "is no interface; use one that transmits, such as",
    "is a mirror: ",
    "has no number that an axis measures, so it is one value here",
    "is not reciprocal: ",
    "is anisotropic with these parameters: ",
    "has no alpha, so that every row",
    "does not keep law",
    "has no value on these axes: ",
    "overflows half: the largest is 65504",
];

/// Axes of three texels, of two where there are more than two axes; none of an axis that counts something is left out.
fn short(bound: Bound) -> Bound {
    let mut spec = bound.spec;
    let len = if spec.grid.axes().len() > 2 { 2 } else { 3 };
    let counts = |a: &Axis| a.quantity.id == "gaussian";
    let cut = |a: &Axis| Axis { len: if counts(a) { a.len } else { a.len.min(len) }, ..a.clone() };
    spec.grid = Grid::new(spec.grid.axes().iter().map(cut).collect()).unwrap();
    let baker = (spec.kind.bind)(&spec).unwrap();
    Bound { spec, baker }
}

/// Which of the combinations of kind, layout or channel, and model.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Which {
    All,
    /// Each layout and channel with the kind's own model and with glass, which has them all; each model with one layout or channel.
    Pairs,
}

/// Every kind x layout or free channel x model (none: the kind's own), with a name for each. A channel that is a layout by itself
/// is that layout.
fn minimal(which: Which) -> Vec<(String, Request)> {
    let mut all = Vec::new();
    for kind in TABLES {
        let models: Vec<Option<&str>> = match kind.model {
            ModelUse::None => vec![None],
            ModelUse::Any(own) | ModelUse::Split(own) => {
                let others = MODELS.iter().map(|m| m.id).filter(|id| *id != own);
                [None].into_iter().chain(others.map(Some)).collect()
            }
        };
        let alone = |id: &str| kind.layouts.iter().any(|l| l.channels.len() == 1 && l.channels[0].id == id);
        for (turn, model) in models.into_iter().enumerate() {
            let mut of_model = Vec::new();
            let request =
                Request { kind: kind.id.to_owned(), model: model.map(str::to_owned), ..Request::default() };
            let name = format!("{} {}", kind.id, model.unwrap_or("-"));
            for layout in kind.layouts {
                let request = Request { layout: Some(layout.id.to_owned()), ..request.clone() };
                of_model.push((format!("{name} layout {}", layout.id), request));
            }
            if matches!(kind.mix, Mix::Free(_)) {
                for channel in kind.pool().into_iter().filter(|c| !alone(c.id)) {
                    let request = Request { channels: Some(vec![channel.id.to_owned()]), ..request.clone() };
                    of_model.push((format!("{name} channel {}", channel.id), request));
                }
            }
            if which == Which::Pairs && !matches!(model, None | Some("ggx-glass")) {
                let chosen = turn % of_model.len();
                of_model = vec![of_model.swap_remove(chosen)];
            }
            all.extend(of_model);
        }
    }
    all
}

/// Bakes a planned table, checks its laws and rounds it as its outputs do; writes nothing.
fn bake(planned: &PlannedTable) -> End {
    let cancel = Default::default();
    let options = Options {
        tolerance: planned.tolerance,
        on_miss: planned.asked.on_miss,
        cancel: &cancel,
        progress: &|_| {},
    };
    let table = match driver::bake(&planned.bound, options) {
        Ok(table) => table,
        Err(e) => return End::Failed(e.to_string()),
    };
    let verified = match verify::check(&planned.bound, table, planned.tolerance, &planned.asked.waivers) {
        Ok((verified, _)) => verified,
        Err(findings) => {
            return End::Failed(findings.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "));
        }
    };
    for output in &planned.outputs {
        let storage = output.storage;
        if let Err(e) = encode::quantise_table(verified.table(), storage) {
            return End::Failed(format!("{output}: {e}"));
        }
    }
    End::Baked
}

/// Bakes what a request asks for; unless in `full`, on short axes.
fn end(request: Request, full: bool) -> End {
    let mut plan = match Plan::from_requests("minimal", vec![TableRequest::new("t", request)]) {
        Ok(plan) => plan,
        Err(e) => return End::Refused(e.to_string()),
    };
    let mut planned = plan.tables.remove(0);
    if !full {
        planned.bound = short(planned.bound);
    }
    bake(&planned)
}

/// Does the work of two threads at a time, and collects what became of each job.
fn all<J: Clone + Send + Sync, E: Debug + Send>(
    jobs: &[(String, J)],
    work: impl Fn(J) -> E + Sync,
) -> BTreeMap<String, E> {
    let (next, ends) = (AtomicUsize::new(0), Mutex::new(BTreeMap::new()));
    let one = || {
        while let Some((name, job)) = jobs.get(next.fetch_add(1, Ordering::Relaxed)) {
            let start = std::time::Instant::now();
            let end = work(job.clone());
            if std::env::var_os("LISTED_TIMES").is_some() {
                eprintln!("{name}: {:.2} s {end:?}", start.elapsed().as_secs_f64());
            }
            ends.lock().unwrap().insert(name.clone(), end);
        }
    };
    std::thread::scope(|s| {
        s.spawn(one);
        s.spawn(one);
    });
    ends.into_inner().unwrap()
}

fn check_minimal(which: Which, full: bool) {
    let only = std::env::var("LISTED_ONLY").unwrap_or_default();
    let jobs: Vec<_> =
        minimal(which).into_iter().filter(|(n, _)| only.split_whitespace().all(|w| n.contains(w))).collect();
    let ends = all(&jobs, |request| end(request, full));
    let failed: Vec<String> = ends
        .iter()
        .filter_map(|(name, end)| match end {
            End::Failed(why) => Some(format!("{name}: {why}")),
            End::Refused(why) if !REASONS.iter().any(|r| why.contains(r)) => {
                Some(format!("{name}: refused without a reason that is known: {why}"))
            }
            _ => None,
        })
        .collect();
    assert!(failed.is_empty(), "{} of {}:\n{}", failed.len(), ends.len(), failed.join("\n"));
    if only.is_empty() {
        for kind in TABLES {
            for layout in kind.layouts {
                let of = |(name, end): (&String, &End)| {
                    *end == End::Baked
                        && name.starts_with(&format!("{} ", kind.id))
                        && name.ends_with(&format!(" layout {}", layout.id))
                };
                assert!(ends.iter().any(of), "{} {}: no model bakes", kind.id, layout.id);
            }
        }
    }
}

/// Bakes a plan as the command does, into a folder of its own; the tables, as the manifest has them.
fn run(mut plan: Plan, full: bool) -> Result<Vec<TableRecord>, String> {
    if !full {
        plan.tables = plan
            .tables
            .into_iter()
            .map(|mut t| {
                t.bound = short(t.bound);
                // MERL holds its own axes only: on short ones its table goes into another container
                let channels = t.bound.spec.layout.channels.len();
                t.outputs.retain(|o| o.shape(&t.bound.spec.grid, channels).check(o.encoder).is_ok());
                if t.outputs.is_empty() {
                    t.outputs.push(Output::parse("npy:float").unwrap());
                }
                t
            })
            .collect();
    }
    let out = tempfile::tempdir().unwrap();
    let settings = Settings { jobs: Some(1), ..Settings::new(out.path()) };
    match pipeline::run(&plan, &settings, &Default::default(), &Silent) {
        Ok(outcome) => Ok(outcome.manifest.tables),
        Err(PipelineError::Laws(findings)) => Err(format!("{findings:?}")),
        Err(e) => Err(e.to_string()),
    }
}

/// What became of every preset and engine.
pub(crate) type Shipped = BTreeMap<String, Result<Vec<TableRecord>, String>>;

fn bake_plans(full: bool) -> Shipped {
    let only = std::env::var("LISTED_ONLY").unwrap_or_default();
    let presets = PRESETS.iter().map(|p| (p.id.to_owned(), (true, p.id)));
    let engines = ENGINES.iter().map(|e| (e.id.to_owned(), (false, e.id)));
    let jobs: Vec<_> =
        presets.chain(engines).filter(|(n, _)| only.split_whitespace().all(|w| n.contains(w))).collect();
    all(&jobs, |(preset, id)| {
        let plan = if preset {
            brdfbake::recipe::preset(id).unwrap().plan()
        } else {
            brdfbake::recipe::engine(id).unwrap().plan()
        };
        run(plan.unwrap(), full)
    })
}

/// Presets and engines on short axes, baked once for all tests that look at them.
pub(crate) fn shipped() -> &'static Shipped {
    static SHORT: OnceLock<Shipped> = OnceLock::new();
    SHORT.get_or_init(|| bake_plans(false))
}

fn check_plans(shipped: &Shipped) {
    let failed: Vec<_> = shipped.iter().filter(|(_, end)| end.is_err()).collect();
    assert!(failed.is_empty(), "{failed:#?}");
}

#[test]
fn minimal_recipes_bake_or_are_refused_when_read() {
    check_minimal(Which::Pairs, false);
}

#[test]
#[ignore = "long: minutes; every kind, layout or channel and model at once"]
fn all_minimal_recipes_bake_or_are_refused_when_read() {
    check_minimal(Which::All, false);
}

#[test]
fn presets_and_engines_bake_on_short_axes() {
    check_plans(shipped());
}

#[test]
#[ignore = "an hour: every minimal recipe in full"]
fn minimal_recipes_bake_in_full() {
    check_minimal(Which::All, true);
}

#[test]
#[ignore = "minutes: every preset and engine in full"]
fn presets_and_engines_bake_in_full() {
    check_plans(&bake_plans(true));
}
