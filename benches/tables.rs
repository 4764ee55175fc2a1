//! Time, evaluations and largest estimated error of every kind of table: the tables of the preset `everything`.
//!
//! `cargo bench --bench tables` prints a table; nothing is asserted. All threads.
#![allow(clippy::print_stdout, clippy::unwrap_used, missing_docs, reason = "a report")]

use brdfbake::cancel::Cancel;
use brdfbake::recipe::preset;
use brdfbake::tables::driver::{self, OnMiss, Options};
use std::time::Instant;

fn main() {
    let plan = preset("everything").unwrap().plan().unwrap();
    let cancel = Cancel::new();
    println!("\n### Every kind of table at the default tolerance\n");
    println!(
        "| table | texels | time | evaluations a texel | largest error | asked |\n|---|---|---|---|---|---|"
    );
    let mut total = 0.0;
    for planned in &plan.tables {
        let options = Options {
            tolerance: planned.tolerance,
            on_miss: OnMiss::Report,
            cancel: &cancel,
            progress: &|_| {},
        };
        let start = Instant::now();
        let table = driver::bake(&planned.bound, options).unwrap();
        let seconds = start.elapsed().as_secs_f64();
        total += seconds;
        let texels = table.grid.len();
        println!(
            "| `{}` | {texels} | {:.1} ms | {:.0} | {:.1e} | {:.1e} |",
            planned.name(),
            seconds * 1e3,
            table.total_evaluations() as f64 / texels as f64,
            table.largest_error().value,
            planned.tolerance
        );
    }
    println!("\ntotal {total:.2} s, without laws and comparison between texels");
}
