//! Error against evaluations and against time, as text, CSV, and charts; and two runs side by side.

use super::chart::{Chart as Picture, Curve};
use crate::math::figures::{short, significant};
use crate::verify::converge::{Chart, Point, REACHED, Series, Times};

/// Words for the tolerances of the level lines.
fn levels() -> Vec<(f64, String)> {
    let words = ["1e-3", "2.4e-4: half a step of half floats", "1e-5"];
    REACHED.into_iter().zip(words.map(str::to_owned)).collect()
}

/// A summary for a terminal.
#[must_use]
pub fn text(chart: &Chart, times: &[Times]) -> String {
    let mut lines = vec![format!(
        "{}: {} texels (seed {}), channels {}; reference by {} to {}",
        chart.subject,
        chart.texels,
        chart.seed,
        chart.channels.join(", "),
        chart.rule,
        short(chart.reference)
    )];
    let head = ["method", "order", "1e-3", "2.4e-4", "1e-5", "smallest error", "at evaluations"];
    let mut rows = vec![head.map(str::to_owned)];
    for s in &chart.series {
        let last = s.points.last();
        let reached: Vec<String> =
            s.reached.iter().map(|r| r.map_or_else(|| "-".to_owned(), |r| format!("{r:.0}"))).collect();
        rows.push([
            s.method.clone(),
            s.order.map_or_else(|| "-".to_owned(), |o| format!("{o:.2}")),
            reached[0].clone(),
            reached[1].clone(),
            reached[2].clone(),
            last.map_or_else(|| "-".to_owned(), |p| significant(p.largest, 3)),
            last.map_or_else(|| "-".to_owned(), |p| format!("{:.0}", p.evaluations)),
        ]);
    }
    lines.push("evaluations of a texel from which on the largest error is within:".to_owned());
    lines.extend(columns(&rows));
    if !times.is_empty() {
        let mut rows = vec![["method", "1e-3", "2.4e-4", "1e-5"].map(str::to_owned)];
        for t in times {
            let cell = |i: usize| t.reached[i].map_or_else(|| "-".to_owned(), microseconds);
            rows.push([t.method.clone(), cell(0), cell(1), cell(2)]);
        }
        lines.push("time of a texel on one thread of this machine:".to_owned());
        lines.extend(columns(&rows));
    }
    lines.join("\n")
}

fn microseconds(s: f64) -> String {
    format!("{} us", significant(s * 1e6, 3))
}

fn columns<const N: usize>(rows: &[[String; N]]) -> Vec<String> {
    let width = |c: usize| rows.iter().map(|r| r[c].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..N).map(width).collect();
    let line = |r: &[String; N]| {
        let cells: Vec<String> = r.iter().zip(&widths).map(|(c, w)| format!("{c:w$}")).collect();
        format!("  {}", cells.join("  ").trim_end())
    };
    rows.iter().map(line).collect()
}

/// One row for each method and budget. Without a clock.
#[must_use]
pub fn csv(chart: &Chart) -> String {
    let mut lines = vec!["method,evaluations,largest,rms,p99,half_ulps,at".to_owned()];
    for s in &chart.series {
        let row = |p: &Point| {
            let Point { evaluations, largest, rms, p99, half_ulps, at } = p;
            format!("{},{evaluations},{largest:e},{rms:e},{p99:e},{half_ulps},\"{at}\"", s.method)
        };
        lines.extend(s.points.iter().map(row));
    }
    lines.join("\n") + "\n"
}

/// One row for each method and budget, with seconds of a texel.
#[must_use]
pub fn time_csv(chart: &Chart, times: &[Times]) -> String {
    let mut lines = vec!["method,seconds,largest,rms,p99".to_owned()];
    for (s, t) in chart.series.iter().zip(times) {
        let row = |(p, seconds): (&Point, &f64)| {
            format!("{},{seconds:e},{:e},{:e},{:e}", s.method, p.largest, p.rms, p.p99)
        };
        lines.extend(s.points.iter().zip(&t.seconds).map(row));
    }
    lines.join("\n") + "\n"
}

/// Largest error over evaluations. Without a clock.
#[must_use]
pub fn chart(chart: &Chart) -> Picture {
    let curve = |s: &Series| Curve {
        name: s.title.clone(),
        points: s.points.iter().map(|p| [p.evaluations, p.largest]).collect(),
    };
    Picture {
        title: chart.subject.clone(),
        axes: ["evaluations of a texel".to_owned(), format!("largest error of {} texels", chart.texels)],
        curves: chart.series.iter().map(curve).collect(),
        levels: levels(),
    }
}

/// Largest error over the time of a texel.
#[must_use]
pub fn time_chart(chart: &Chart, times: &[Times]) -> Picture {
    let curve = |(s, t): (&Series, &Times)| Curve {
        name: s.title.clone(),
        points: s.points.iter().zip(&t.seconds).map(|(p, s)| [s * 1e6, p.largest]).collect(),
    };
    Picture {
        title: chart.subject.clone(),
        axes: [
            "microseconds of a texel, one thread".to_owned(),
            format!("largest error of {} texels", chart.texels),
        ],
        curves: chart.series.iter().zip(times).map(curve).collect(),
        levels: levels(),
    }
}

/// RMS errors of two runs, method by method, where both have the budget.
#[must_use]
pub fn compare(before: &Chart, now: &Chart) -> String {
    let mut rows = vec![["method", "evaluations", "RMS before", "RMS now", "ratio"].map(str::to_owned)];
    for s in &now.series {
        let Some(old) = before.series.iter().find(|o| o.method == s.method) else { continue };
        for p in &s.points {
            let near = |q: &&Point| (q.evaluations - p.evaluations).abs() <= 0.01 * p.evaluations;
            let Some(q) = old.points.iter().find(near) else { continue };
            rows.push([
                s.method.clone(),
                format!("{:.0}", p.evaluations),
                format!("{:.2e}", q.rms),
                format!("{:.2e}", p.rms),
                format!("{:.3}", p.rms / q.rms),
            ]);
        }
    }
    let other = (before.subject != now.subject).then(|| format!("the other run is of {}", before.subject));
    other.into_iter().chain(columns(&rows)).collect::<Vec<_>>().join("\n")
}
