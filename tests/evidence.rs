//! `stress` and `converge`: what does not hold is found, what is told is the same on every run.
#![allow(clippy::unwrap_used, reason = "test")]

use brdfbake::cancel::Cancel;
use brdfbake::grid::{Axis, Quantity, Texel};
use brdfbake::models::{Brdf, Chart, Laws, ModelInfo, Sample};
use brdfbake::report::{converge as report, stress as told};
use brdfbake::tables::spec::{Bound, Request};
use brdfbake::verify::converge::{Asked, Chart as Errors, converge};
use brdfbake::verify::stress::{Subject, stress};
use glam::{DVec2, DVec3};

/// Wrong in every way that a model can be: it gains energy, is not reciprocal, negative near the horizon, and infinite along the normal.
#[derive(Debug)]
struct Broken;

impl Brdf for Broken {
    fn eval(&self, wo: DVec3, wi: DVec3) -> f64 {
        match () {
            () if wi.z > 1.0 - 1e-9 && wo.z > 1.0 - 1e-9 => f64::INFINITY,
            () if wi.z < 1e-4 => -1.0,
            () => 0.5 * (1.0 + wo.z),
        }
    }

    fn sample(&self, _wo: DVec3, u: DVec2) -> Option<Sample> {
        Some(Sample { wi: DVec3::new(0.0, 0.0, 0.5 + u.x), pdf: f64::NAN })
    }

    fn pdf(&self, _wo: DVec3, _wi: DVec3) -> f64 {
        1.0
    }

    fn chart(&self) -> Option<Chart> {
        None
    }
}

static BROKEN: ModelInfo = ModelInfo {
    id: "broken",
    title: "",
    formula: "",
    sources: &[],
    params: &[],
    laws: Laws { reciprocal: true, passive: true, isotropic: true },
    notes: "",
    also: &[],
    known: &[],
    splits: false,
    build: |_| Ok(Box::new(Broken)),
};

#[test]
fn a_model_that_breaks_what_it_claims_is_named() {
    let found = Subject::Model(&BROKEN).stress(&Cancel::new()).unwrap();
    let faults: Vec<&str> = found.faults.iter().map(|f| f.fault).collect();
    for fault in ["not finite", "negative", "not reciprocal", "bad sample"] {
        assert!(faults.contains(&fault), "{fault}: {faults:?}");
    }
    assert!(faults.contains(&"energy gained") || faults.contains(&"no albedo"), "{faults:?}");
    let lines = told::text(&[found]);
    assert!(lines.contains("broken (model): DOES NOT HOLD") && lines.contains("mu_o ="), "{lines}");
}

/// Rows of the page are what a walk finds today; each subject has one.
#[test]
fn the_page_of_stability_is_what_is_found() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/src/guide/stability.md");
    let page = std::fs::read_to_string(path).unwrap();
    for subject in Subject::all() {
        assert!(page.contains(&format!("| `{}` |", subject.id())), "no row for {}", subject.id());
    }
    let short =
        ["lambert", "minnaert", "schlick:f32", "gtr-d:f32", "fresnel-schlick", "masking", "beer-lambert"];
    let subjects: Vec<Subject> = short.iter().map(|id| Subject::find(id).unwrap()).collect();
    let found = stress(&subjects, &Cancel::new()).unwrap();
    for row in told::markdown(&found).lines().filter(|l| l.starts_with("| `")) {
        assert!(
            page.contains(row),
            "`brdfbake stress --markdown` writes the tables of src/guide/stability.md anew: {row}"
        );
    }
    assert!(Subject::find("ggxx").is_err_and(|e| e.near.as_deref() == Some("ggx")));
}

fn split_sum() -> Bound {
    let axis = |id| Axis::new(Quantity::find(id).unwrap(), 16, Texel::Center);
    let axes = Some(vec![axis("mu"), axis("roughness")]);
    Request { kind: "dfg".into(), layout: Some("scale-bias".into()), axes, ..Request::default() }
        .bind()
        .unwrap()
}

fn run(seed: u64, power: u32) -> Errors {
    let cancel = Cancel::new();
    converge(&split_sum(), Asked { seed, texels: 24, power, cancel: &cancel }).unwrap().0
}

#[test]
fn errors_fall_as_theory_has_it() {
    let chart = run(3, 12);
    let series = |id: &str| chart.series.iter().find(|s| s.method == id).unwrap();
    // independent points: the root of their number, within what 24 texels and nine budgets tell
    let independent = series("visible-normals-independent").order.unwrap();
    assert!((0.4..0.6).contains(&independent), "{independent}");
    // scrambled nets: above that, and at most 3/2
    let sobol = series("visible-normals-sobol").order.unwrap();
    assert!(sobol > 0.65 && sobol < 1.6, "{sobol}");
    let adaptive = series("adaptive");
    assert!(adaptive.reached.iter().all(Option::is_some), "{:?}", adaptive.reached);
    let at = |id: &str| series(id).reached[1].unwrap_or(f64::INFINITY);
    assert!(at("adaptive") < at("visible-normals-sobol") && at("adaptive") < at("hammersley-f32"));
    // every point that is shown is known to a digit
    for point in chart.series.iter().flat_map(|s| &s.points) {
        assert!(point.largest > 10.0 * chart.reference && point.rms <= point.largest, "{point:?}");
    }
}

#[test]
fn runs_are_equal_and_can_be_compared() {
    let (a, b) = (run(5, 6), run(5, 6));
    assert_eq!(a, b);
    assert_eq!(report::csv(&a), report::csv(&b));
    let other = run(6, 6);
    assert_ne!(a, other);
    let same = report::compare(&a, &b);
    assert!(same.lines().skip(1).all(|l| l.ends_with("1.000")), "{same}");
    assert!(!report::compare(&a, &other).lines().skip(1).all(|l| l.ends_with("1.000")));
    let picture = report::chart(&a);
    let png = image::load_from_memory(&picture.png().unwrap()).unwrap().to_rgb8();
    // lines in the colours of the curves, and letters
    let drawn = png.pixels().filter(|p| p.0 != [255; 3]).count();
    assert!(drawn > 10_000 && png.dimensions() == (960, 600), "{drawn}");
    assert!(picture.svg().contains("2.4e-4: half a step of half floats"));
}
