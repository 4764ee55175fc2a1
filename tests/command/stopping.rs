//! The library's token: every long loop looks at it, and two runs do not share it.

use brdfbake::cancel::{Cancel, Cancelled};
use brdfbake::encode::diff_files::{self, DiffError};
use brdfbake::encode::read::{read_bytes_until, read_file_until};
use brdfbake::encode::{
    ENCODERS, EncodeError, EncodeInput, Label, ReadError, Storage, Tolerance, Unstored, quantise_table_until,
};
use brdfbake::grid::fit::Samples;
use brdfbake::grid::{Axis, Channel, Grid, Quantity, Table, Texel};
use brdfbake::models;
use brdfbake::pipeline::{self, PipelineError, Settings, Silent};
use brdfbake::report::analytic::{self, FitError, Form};
use brdfbake::tables::Bound;
use brdfbake::tables::driver::{self, BakeError, OnMiss, Options};
use brdfbake::tables::spec::Request;
use brdfbake::verify::reconstruction::Probe;
use brdfbake::verify::{self, survey};
use std::sync::atomic::{AtomicUsize, Ordering};

fn set() -> Cancel {
    let cancel = Cancel::new();
    cancel.set();
    cancel
}

fn bound(kind: &str, axes: &[(&str, usize)]) -> Bound {
    let axis = |(id, n): &(&str, usize)| Axis::new(Quantity::find(id).unwrap(), *n, Texel::Center);
    let axes = Some(axes.iter().map(axis).collect());
    Request { kind: kind.to_owned(), axes, ..Request::default() }.bind().unwrap()
}

fn options<'a>(cancel: &'a Cancel, progress: &'a (dyn Fn(usize) + Sync)) -> Options<'a> {
    Options { tolerance: 1e-4, on_miss: OnMiss::Fail, cancel, progress }
}

#[test]
fn a_bake_stops_between_texels() {
    let bound = bound("dfg", &[("mu", 64), ("roughness", 64)]);
    let (cancel, most) = (Cancel::new(), AtomicUsize::new(0));
    let progress = |done: usize| {
        most.fetch_max(done, Ordering::Relaxed);
        cancel.set();
    };
    let stopped = driver::bake(&bound, options(&cancel, &progress));
    assert_eq!(stopped, Err(BakeError::Cancelled(Cancelled)));
    assert!(most.load(Ordering::Relaxed) < 64 * 64);
    // another run in the same process goes on
    assert!(driver::bake(&bound, options(&Cancel::new(), &|_| {})).is_ok());
}

#[test]
fn laws_and_probes_stop() {
    let bound = bound("dfg", &[("mu", 8), ("roughness", 8)]);
    let table = driver::bake(&bound, options(&Cancel::new(), &|_| {})).unwrap();
    let values = table.values.clone();
    assert!(verify::check(&bound, table.clone(), 1e-4, &[]).is_ok());
    assert!(matches!(verify::check_until(&set(), &bound, table, 1e-4, &[]), Err(Cancelled)));
    assert!(Probe::new(&bound, 1e-4, 1 << 10).measure(&values).points > 0);
    let stop = set();
    assert_eq!(Probe::until(&stop, &bound, 1e-4, 1 << 10).measure(&values).points, 0);
    // what is stopped later measures at no new points
    let later = Cancel::new();
    let probe = Probe::until(&later, &bound, 1e-4, 1 << 10);
    let all = probe.measure(&values).points;
    later.set();
    assert!(probe.measure(&values).points < all);
}

#[test]
fn surveys_stop() {
    let info = models::MODELS[0];
    assert!(survey::survey_until(&Cancel::new(), info).is_ok());
    assert_eq!(survey::survey_until(&set(), info), Err(Cancelled));
}

#[test]
fn fits_stop() {
    let split = Request { kind: "dfg".to_owned(), layout: Some("factored".to_owned()), ..Request::default() };
    let split = split.bind().unwrap();
    assert!(matches!(analytic::split_sum_until(&set(), &split, 1), Err(FitError::Cancelled(Cancelled))));
    let table = bound("fresnel-dielectric", &[("mu", 8), ("eta", 8)]);
    let stopped = analytic::table_until(&set(), &table, Form::Rational, 2);
    assert!(matches!(stopped, Err(FitError::Cancelled(Cancelled))));
}

#[test]
fn texels_that_are_fitted_are_left_as_they_were() {
    let grid = Grid::new(vec![Axis::new(Quantity::find("mu").unwrap(), 8, Texel::Center)]).unwrap();
    let points: Vec<_> = (0..=64).map(|i| grid.at_coordinates(&[f64::from(i) / 64.0])).collect();
    let samples = Samples::new(&grid, points.iter().map(|p| (p, 1.0)));
    let truth: Vec<f64> = points.iter().map(|p| p.values()[0].sqrt()).collect();
    let start = vec![0.5; 8];
    assert_ne!(samples.least_squares(&truth, &start, [0.0, 1.0], &Cancel::new()), start);
    assert_eq!(samples.least_squares(&truth, &start, [0.0, 1.0], &set()), start);
    assert_eq!(samples.minimax(&truth, &start, [0.0, 1.0], &set()), start);
}

#[test]
fn blocks_stop() {
    let axis = |id| Axis::new(Quantity::find(id).unwrap(), 16, Texel::Center);
    let grid = Grid::new(vec![axis("mu"), axis("roughness")]).unwrap();
    let table = Table {
        channels: vec![Channel {
            id: "x".into(),
            meaning: "x".into(),
            range: [0.0, 1.0],
            role: String::new(),
        }],
        values: (0..256).map(|i| f64::from(i) / 256.0).collect(),
        errors: vec![0.0; 256],
        evaluations: vec![1; 256],
        grid,
    };
    for storage in [Storage::Bc4, Storage::Bc5, Storage::Bc6h, Storage::Bc6hSigned] {
        assert!(quantise_table_until(&Cancel::new(), &table, storage).is_ok());
        let stopped = quantise_table_until(&set(), &table, storage);
        assert_eq!(stopped, Err(Unstored::Cancelled(Cancelled)), "{storage:?}");
    }
}

/// A small table in every container, with the first storage of each.
#[test]
fn containers_stop() {
    let axis = |id| Axis::new(Quantity::find(id).unwrap(), 16, Texel::Center);
    let grid = Grid::new(vec![axis("mu"), axis("roughness")]).unwrap();
    let channels =
        vec![Channel { id: "x".into(), meaning: "x".into(), role: String::new(), range: [0.0, 1.0] }];
    // numbers of every storage
    let values: Vec<f64> = (0..256).map(|i| f64::from(i % 3 % 2)).collect();
    let mut read = 0;
    for encoder in ENCODERS {
        let input = |cancel| EncodeInput {
            grid: &grid,
            channels: &channels,
            values: &values,
            blocks: &[],
            errors: &[],
            storage: encoder.storages()[0],
            options: &[],
            label: Label::default(),
            cancel,
        };
        let (stop, go) = (set(), Cancel::new());
        match encoder.encode(&input(&go)) {
            Ok(bytes) if !encoder.magic().is_empty() => {
                assert!(read_bytes_until(&go, &bytes).is_ok(), "{}", encoder.id());
                let stopped = read_bytes_until(&stop, &bytes);
                assert!(matches!(stopped, Err(ReadError::Cancelled(Cancelled))), "{}", encoder.id());
                read += 1;
            }
            Ok(_) => {}
            // it takes other axes
            Err(e) => {
                assert!(matches!(e, EncodeError::Axes { .. }), "{}: {e}", encoder.id());
                continue;
            }
        }
        let stopped = encoder.encode(&input(&stop));
        assert!(matches!(stopped, Err(EncodeError::Cancelled(Cancelled))), "{}: {stopped:?}", encoder.id());
    }
    assert!(read >= 6, "{read} containers are read");
}

#[test]
fn files_and_folders_stop() {
    let dir = super::support::folder();
    let path = dir.path().join("a.exr");
    std::fs::write(&path, b"nothing").unwrap();
    assert!(matches!(read_file_until(&set(), &path), Err(ReadError::Cancelled(Cancelled))));
    for (a, b) in [(path.as_path(), path.as_path()), (dir.path(), dir.path())] {
        let stopped = diff_files::paths_until(&set(), a, b, &Tolerance::default().into());
        assert!(matches!(stopped, Err(DiffError::Cancelled(Cancelled))), "{stopped:?}");
    }
}

#[test]
fn a_pipeline_that_is_stopped_writes_nothing() {
    let dir = super::support::folder();
    let plan = brdfbake::recipe::parse(super::support::SMALL, "small.toml").unwrap();
    let settings = Settings::new(dir.path().join("out"));
    let stopped = pipeline::run(&plan, &settings, &set(), &Silent);
    let cancelled = matches!(
        stopped,
        Err(PipelineError::Cancelled(_) | PipelineError::Bake { error: BakeError::Cancelled(_), .. })
    );
    assert!(cancelled, "{stopped:?}");
    assert!(!settings.out.exists());
}

#[test]
fn word_is_kept_until_it_is_dropped() {
    use std::sync::{Arc, Mutex};
    let cancel = Cancel::new();
    let done = Arc::new(Mutex::new(Vec::new()));
    let note = |n: u32| {
        let done = Arc::clone(&done);
        move || done.lock().unwrap().push(n)
    };
    let words: Vec<_> = (0..4).map(|n| cancel.at_end(note(n))).collect();
    drop(words.into_iter().nth(2));
    cancel.end();
    assert_eq!(*done.lock().unwrap(), [] as [u32; 0], "all words were dropped");
    let _kept = [cancel.at_end(note(5)), cancel.at_end(note(6))];
    cancel.end();
    cancel.end();
    assert_eq!(*done.lock().unwrap(), [6, 5], "once, the last first");
}

#[test]
fn holds_are_counted() {
    let cancel = Cancel::new();
    let first = cancel.hold();
    let second = cancel.hold();
    drop(first);
    assert!(cancel.is_held());
    drop(second);
    assert!(!cancel.is_held());
}
