//! Texels fitted to the reader: closed forms in one dimension, gains on split sums, the same bytes for any number of
//! threads.
#![allow(clippy::unwrap_used, clippy::print_stderr, clippy::cast_possible_truncation, reason = "test")]

use crate::tolerance::{DIGITS_LOST, FEW_ROUNDINGS, MANY_ROUNDINGS, near};
use brdfbake::cancel::Cancel;
use brdfbake::encode::read;
use brdfbake::grid::fit::{Samples, places};
use brdfbake::grid::layout::Point;
use brdfbake::grid::provenance::{ChoiceRecord, TexelRecord};
use brdfbake::grid::{Axis, Grid, Quantity, Texel};
use brdfbake::pipeline::{FileRecord, Settings, Silent, run};
use brdfbake::plan::Plan;
use brdfbake::recipe::parse;
use std::path::Path;

fn line(len: usize, texel: Texel) -> Grid {
    Grid::new(vec![Axis::new(Quantity::find("mu").unwrap(), len, texel)]).unwrap()
}

/// Samples of f on a line, the truth there, and the exact texels.
fn sampled(grid: &Grid, f: impl Fn(f64) -> f64) -> (Samples, Vec<f64>, Vec<f64>) {
    let points: Vec<(Point, f64)> =
        places(grid, 4).iter().map(|(x, area)| (grid.at_coordinates(x), *area)).collect();
    let truth = points.iter().map(|(p, _)| f(p.values()[0])).collect();
    let exact = (0..grid.len()).map(|t| f(grid.texel(t).values()[0])).collect();
    (Samples::new(grid, points.iter().map(|(p, a)| (p, *a))), truth, exact)
}

const ALL: [f64; 2] = [-1e9, 1e9];

#[test]
fn the_areas_add_up_to_the_domain() {
    for grid in [line(7, Texel::Center), line(7, Texel::Endpoint)] {
        let sum: f64 = places(&grid, 4).iter().map(|p| p.1).sum();
        near!(sum, 1.0, MANY_ROUNDINGS, "{sum}");
    }
}

#[test]
fn least_squares_of_a_parabola_are_its_projection() {
    // the line nearest to x^2 on [0, 1] in the mean square is x - 1/6
    let grid = line(2, Texel::Endpoint);
    let (samples, truth, exact) = sampled(&grid, |x| x * x);
    let fit = samples.least_squares(&truth, &exact, ALL, &Cancel::new());
    assert!((fit[0] + 1.0 / 6.0).abs() < DIGITS_LOST && (fit[1] - 5.0 / 6.0).abs() < DIGITS_LOST, "{fit:?}");
    // far from the ends a linear spline of spacing h lies h^2 / 6 below x^2 at its knots
    let n = 65;
    let grid = line(n, Texel::Endpoint);
    let (samples, truth, exact) = sampled(&grid, |x| x * x);
    let fit = samples.least_squares(&truth, &exact, ALL, &Cancel::new());
    let h = 1.0 / (n - 1) as f64;
    near!(exact[n / 2] - fit[n / 2], h * h / 6.0, 1e-10 * h * h, "{}", exact[n / 2] - fit[n / 2]);
}

#[test]
fn minimax_of_a_parabola_halves_its_error() {
    // the chord of x^2 over a cell is off by h^2 / 4 at most; moved down by half of that, by h^2 / 8, which is best
    for n in [2, 9, 33] {
        let grid = line(n, Texel::Endpoint);
        let (samples, truth, exact) = sampled(&grid, |x| x * x);
        let h = 1.0 / (n - 1) as f64;
        near!(samples.largest(&exact, &truth), h * h / 4.0, MANY_ROUNDINGS);
        let got = samples.largest(&samples.minimax(&truth, &exact, ALL, &Cancel::new()), &truth) / (h * h);
        assert!((0.125 - 1e-12..0.130).contains(&got), "{n}: {got} h^2");
    }
}

#[test]
fn a_straight_line_stays_what_it_is() {
    let grid = line(6, Texel::Endpoint);
    let (samples, truth, exact) = sampled(&grid, |x| 0.25 + 0.5 * x);
    for fit in [
        samples.least_squares(&truth, &exact, ALL, &Cancel::new()),
        samples.minimax(&truth, &exact, ALL, &Cancel::new()),
    ] {
        assert!(fit.iter().zip(&exact).all(|(a, b)| (a - b).abs() < MANY_ROUNDINGS), "{fit:?}");
    }
}

#[test]
fn fits_stay_in_the_range_and_the_others_are_solved_again() {
    // without a bound the first texel of x^2 would be -1/6; held at 0 the best line is x (3/4): int x^3 / int x^2
    let grid = line(2, Texel::Endpoint);
    let (samples, truth, exact) = sampled(&grid, |x| x * x);
    let fit = samples.least_squares(&truth, &exact, [0.0, 1.0], &Cancel::new());
    assert!(fit[0].abs() < MANY_ROUNDINGS && (fit[1] - 0.75).abs() < DIGITS_LOST, "{fit:?}");
    let fit = samples.minimax(&truth, &exact, [0.0, 1.0], &Cancel::new());
    assert!(fit.iter().all(|v| (0.0..=1.0).contains(v)), "{fit:?}");
}

fn recipe(texels: &str, len: usize, texel: &str, more: &str) -> Plan {
    let source = format!(
        "name = 'x'\n[[table]]\nkind = 'dfg'\nname = 't'\ntexels = '{texels}'\n{more}\n\
         [[table.axis]]\nid = 'mu'\nlength = {len}\ntexel = '{texel}'\n\
         [[table.axis]]\nid = 'roughness'\nlength = {len}\ntexel = '{texel}'\n"
    );
    parse(&source, "x.toml").unwrap_or_else(|e| panic!("{e}"))
}

fn bake(plan: &Plan, out: &Path, jobs: usize) -> FileRecord {
    let settings = Settings { jobs: Some(jobs), ..Settings::new(out) };
    let outcome = run(plan, &settings, &Cancel::new(), &Silent).unwrap();
    outcome.manifest.tables[0].files[0].clone()
}

fn fitted(texels: &str, len: usize, texel: &str, more: &str) -> TexelRecord {
    let dir = tempfile::tempdir().unwrap();
    bake(&recipe(texels, len, texel, more), dir.path(), 2).texels.unwrap()
}

fn figures(c: &ChoiceRecord) -> [f64; 4] {
    let p = c.practical.as_ref().unwrap();
    [c.whole.largest.value, c.whole.mean, p.largest.value, p.mean]
}

#[test]
fn split_sums_read_better_and_all_three_choices_are_reported() {
    // what lies beyond the outermost centres counts for little in the fit, and in full in the mean
    for (texel, mean) in [("endpoint", 0.45), ("center", 0.85)] {
        let record = fitted("least-squares", 32, texel, "");
        assert_eq!((record.asked.as_str(), record.held.as_str()), ("least-squares", "least-squares"));
        let ids: Vec<&str> = record.choices.iter().map(|c| c.texels.as_str()).collect();
        assert_eq!(ids, ["exact", "least-squares", "minimax"]);
        let [exact, squares, minimax] = [0, 1, 2].map(|i| figures(&record.choices[i]));
        assert!(
            squares[1] < mean * exact[1] && squares[3] < 0.65 * exact[3],
            "{texel}: {exact:?} {squares:?}"
        );
        assert!(minimax[1] < 0.8 * exact[1] && minimax[3] < 0.7 * exact[3], "{texel}: {exact:?} {minimax:?}");
        assert!(record.largest_change > 1e-4, "{}", record.largest_change);
        if texel == "center" {
            // the ridge of grazing views lies between the points of the fit
            assert!(minimax[0] < 0.75 * exact[0] && minimax[2] < 0.65 * exact[2], "{exact:?} {minimax:?}");
        }
    }
}

#[test]
fn minimax_is_never_worse_than_exact_as_stored() {
    for (texel, len) in [("endpoint", 16), ("endpoint", 32), ("center", 16)] {
        let dir = tempfile::tempdir().unwrap();
        let file = bake(&recipe("minimax", len, texel, ""), dir.path(), 2);
        let record = file.texels.unwrap();
        let exact = &record.choices[0];
        let got = file.reconstruction.unwrap().whole.largest.value;
        assert!(got <= exact.whole.largest.value, "{texel} {len}: {got}");
        let held = record.choices.iter().find(|c| c.texels == record.held).unwrap();
        near!(held.whole.largest.value, got, FEW_ROUNDINGS);
    }
}

/// Auto holds, channel by channel, what is better than the exact values by every measure; judged here by a denser scan than the
/// program's, with a reader of our own.
#[test]
fn auto_is_better_by_every_measure_or_exact() {
    for (texel, len) in [("endpoint", 32), ("center", 16), ("center", 32)] {
        let dirs = ["exact", "auto"].map(|texels| {
            let dir = tempfile::tempdir().unwrap();
            let file = bake(&recipe(texels, len, texel, ""), dir.path(), 2);
            (dir, file)
        });
        let record = dirs[1].1.texels.clone().unwrap();
        assert_eq!(record.asked, "auto");
        let figures = dirs.each_ref().map(|(dir, _)| scan(&dir.path().join("t.exr"), texel == "center"));
        let mut improved = 0;
        for (c, (exact, auto)) in figures[0].iter().zip(&figures[1]).enumerate() {
            for (i, (e, f)) in exact.iter().zip(auto).enumerate() {
                // the scan has other points than the choice
                assert!(
                    *f <= 1.03 * e,
                    "{texel} {len}, channel {c}, measure {i}: exact {e}, auto {f} ({record:?})"
                );
            }
            improved += usize::from(auto[3] < 0.8 * exact[3]);
        }
        assert!(improved > 0, "{texel} {len}: {figures:?}");
        assert!(record.held != "exact", "{record:?}");
    }
}

/// Largest and mean error over the whole domain, then over the practical one, of scale and bias, at points of no fit.
fn scan(path: &Path, center: bool) -> [[f64; 4]; 2] {
    let image = read::read_file(path).unwrap();
    let (width, height) = (image.width, image.height);
    let bound = recipe("exact", 8, "center", "").tables.remove(0).bound;
    let mut out = [[0.0_f64; 4]; 2];
    let mut counts = [0.0_f64; 2];
    let points: Vec<f64> = (0..173).map(|i| (f64::from(i) + 0.5) / 173.0).collect();
    for &mu in &points {
        for &r in &points {
            let truth = bound.baker.texel(&[mu, r * r], 1e-6).unwrap().value;
            let place = |t: f64, n: usize| {
                let last = (n - 1) as f64;
                let free = if center { t * n as f64 - 0.5 } else { t * last };
                let x = free.clamp(0.0, last);
                let i = (x as usize).min(n - 2);
                (i, x - i as f64)
            };
            let ((x, s), (y, t)) = (place(mu, width), place(r, height));
            let practical = mu >= 0.05 && r >= 0.09;
            counts[0] += 1.0;
            counts[1] += f64::from(u8::from(practical));
            for (c, id) in ["dfg.scale", "dfg.bias"].iter().enumerate() {
                let v = &image.channels.iter().find(|ch| ch.name == *id).unwrap().values;
                let row = |y: usize| v[y * width + x] * (1.0 - s) + v[y * width + x + 1] * s;
                let error = (row(y) * (1.0 - t) + row(y + 1) * t - truth[c]).abs();
                out[c][0] = out[c][0].max(error);
                out[c][1] += error;
                if practical {
                    out[c][2] = out[c][2].max(error);
                    out[c][3] += error;
                }
            }
        }
    }
    for f in &mut out {
        f[1] /= counts[0];
        f[3] /= counts[1];
    }
    out
}

/// The search takes fitted texels: here it then needs fewer of them.
#[test]
fn a_size_is_found_for_fitted_texels() {
    let plan = |texels: &str| {
        let source = format!(
            "name = 'x'\n[[table]]\nkind = 'dfg'\nname = 't'\ntexels = '{texels}'\n\
             size = {{ error = 2e-2, domain = 'practical', longest = 64 }}\n\
             [[table.axis]]\nid = 'mu'\ntexel = 'center'\n\
             [[table.axis]]\nid = 'roughness'\ntexel = 'center'\n"
        );
        parse(&source, "x.toml").unwrap_or_else(|e| panic!("{e}"))
    };
    let texels = ["exact", "auto"].map(|texels| {
        let dir = tempfile::tempdir().unwrap();
        let settings = Settings { jobs: Some(2), ..Settings::new(dir.path()) };
        let outcome = run(&plan(texels), &settings, &Cancel::new(), &Silent).unwrap();
        let table = &outcome.manifest.tables[0];
        let practical = table.files[0].reconstruction.clone().unwrap().practical.unwrap();
        assert!(practical.largest.value <= 2e-2, "{texels}: {}", practical.largest.value);
        // and so says a scan that is not the program's
        let scanned = scan(&dir.path().join("t.exr"), true);
        assert!(scanned.iter().all(|f| f[2] <= 2.1e-2), "{texels}: {scanned:?}");
        table.size.iter().product::<usize>()
    });
    assert!(texels[1] < texels[0], "{texels:?}");
}

#[test]
fn a_layout_that_the_shader_decodes_gains_too() {
    let record = fitted("least-squares", 16, "endpoint", "layout = 'factored'");
    let [exact, squares] = [0, 1].map(|i| figures(&record.choices[i]));
    assert!(squares[3] < 0.6 * exact[3], "{exact:?} {squares:?}");
}

#[test]
fn bounded_and_unsigned_storages_take_every_fitted_value() {
    let dir = tempfile::tempdir().unwrap();
    bake(&recipe("least-squares", 16, "center", "outputs = ['png:unorm8']"), dir.path(), 2);
    bake(&recipe("least-squares", 16, "center", "outputs = ['ktx2:r11g11b10']"), dir.path(), 2);
}

#[test]
fn the_bytes_do_not_depend_on_the_threads_and_the_file_says_what_it_holds() {
    let plan = recipe("least-squares", 16, "endpoint", "");
    let bytes = |jobs| {
        let dir = tempfile::tempdir().unwrap();
        bake(&plan, dir.path(), jobs);
        std::fs::read(dir.path().join("t.exr")).unwrap()
    };
    let one = bytes(1);
    assert_eq!(one, bytes(3));
    let image = read::read_bytes(&one).unwrap();
    let text = brdfbake::report::inspect::inspect("t.exr", &image);
    assert!(text.contains("least-squares: texels are not samples"), "{text}");
    let exact = recipe("exact", 16, "endpoint", "");
    assert_ne!(exact.tables[0].identity, plan.tables[0].identity);
    assert!(exact.tables[0].canonical().get("texels").is_none());
    assert_eq!(plan.tables[0].canonical()["texels"], "least-squares");
}

#[test]
#[ignore = "prints the table of README"]
fn table_of_gains() {
    for texel in ["endpoint", "center"] {
        for len in [16, 32, 64] {
            let start = std::time::Instant::now();
            let record = fitted("minimax", len, texel, "");
            eprintln!("{texel} {len}: {} integrals, {:.1} s", record.samples, start.elapsed().as_secs_f64());
            for c in &record.choices {
                let [w, wm, p, pm] = figures(c);
                eprintln!("  {:14} whole {w:.2e} mean {wm:.2e} practical {p:.2e} mean {pm:.2e}", c.texels);
            }
        }
    }
}
