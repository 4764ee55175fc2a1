//! A table in memory, as a renderer uploads it: `cargo run --release --example in_memory`.
//!
//! The numbers are what `wgpu::Queue::write_texture` takes for `TextureFormat::Rg32Float`; half floats are `Output::parse("raw:half")`.
#![allow(clippy::print_stdout, reason = "an example")]

use brdfbake::plan::{Output, TableRequest};
use brdfbake::tables::spec::Request;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let request = Request { kind: "dfg".into(), model: Some("ggx".into()), ..Request::default() };
    let asked = TableRequest { tolerance: Some(1e-5), ..TableRequest::new("ggx-dfg", request) };
    let baked = brdfbake::bake(asked)?;
    let texels = baked.encode(&Output::parse("raw:float")?)?;
    let [width, height, _] = baked.table().grid.extent();
    let channels = baked.table().channels.len();
    println!("{width} x {height} texels of {channels} channels, {} bytes", texels.len());
    println!("bytes a row: {}", width * channels * 4);
    println!("largest estimated error: {:.1e}", baked.table().largest_error().value);
    for axis in &baked.provenance().axes {
        println!("{}: texture coordinate = {}", axis.axis.quantity.id, axis.coordinate);
    }
    Ok(())
}
