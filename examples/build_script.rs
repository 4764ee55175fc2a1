//! A build script that bakes tables: this file as `build.rs`, with `brdfbake` in `[build-dependencies]`. Here it runs as an example:
//! `OUT_DIR=target/tables cargo run --release --example build_script`.
//!
//! The crate then holds the file: `include_bytes!(concat!(env!("OUT_DIR"), "/dfg-scale-bias.ktx2"))`. See [`brdfbake::build`] for the
//! lines of `Cargo.toml` that make build scripts fast.
#![allow(clippy::print_stdout, reason = "Cargo reads what a build script prints")]

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let out = std::env::var("OUT_DIR").map_err(|_| "OUT_DIR is not set: Cargo sets it for build scripts")?;
    let built = brdfbake::build::recipe("presets/split-sum.toml", out)?;
    println!("{}", built.lines.join("\n"));
    Ok(())
}
