//! Decodes the DDS files that `tests/foreign.rs` writes with the crates `ddsfile` and `image_dds`, its OpenEXR files of positional names
//! with the crate `image`, and compares every texel.
//!
//! ```sh
//! BRDFBAKE_FOREIGN=foreign-out cargo test --test files -- --ignored write_
//! cargo run --manifest-path tests/foreign/dds/Cargo.toml -- foreign-out
//! ```
//! Exit code: 0 all agree, 1 a difference, 2 nothing to compare. Formats that the crate has not (packed words) are told and counted.

use ddsfile::{D3D10ResourceDimension, Dds};
use image_dds::{Surface, SurfaceRgba32Float};
use serde_json::Value;
use std::path::Path;
use std::process::ExitCode;

fn expect(what: &str, got: u64, want: u64) -> Result<(), String> {
    if got == want { Ok(()) } else { Err(format!("{what}: got {got}, expected {want}")) }
}

/// Texels as four floats; `None` if the crate does not know the format.
fn decode(dds: &Dds) -> Result<Option<SurfaceRgba32Float<Vec<f32>>>, String> {
    match Surface::from_dds(dds) {
        Err(image_dds::error::SurfaceError::UnsupportedDdsFormat(_)) => Ok(None),
        surface => surface.and_then(|s| s.decode_rgbaf32()).map(Some).map_err(|e| e.to_string()),
    }
}

fn header(dds: &Dds, want: &Value) -> Result<(), String> {
    let of = |key: &str| want[key].as_u64().unwrap_or(0);
    expect("width", dds.get_width().into(), of("width"))?;
    expect("height", dds.get_height().into(), of("height"))?;
    expect("depth", dds.get_depth().into(), of("depth").max(1))?;
    expect("layers", dds.get_num_array_layers().into(), of("layers").max(1))?;
    expect("levels", dds.get_num_mipmap_levels().into(), 1)?;
    let ten = dds.header10.as_ref().ok_or("no DX10 header")?;
    let volume = ten.resource_dimension == D3D10ResourceDimension::Texture3D;
    expect("a volume", volume.into(), (of("depth") > 0).into())
}

/// What was seen; an error says what is different.
fn check(path: &Path, want: &Value) -> Result<&'static str, String> {
    let bytes = std::fs::read(path).map_err(|e| e.to_string())?;
    let dds = Dds::read(bytes.as_slice()).map_err(|e| e.to_string())?;
    header(&dds, want)?;
    let Some(surface) = decode(&dds)? else { return Ok("header only: image_dds has no such format") };
    expect(
        "values",
        surface.data.len() as u64 / 4,
        dds.get_width() as u64 * u64::from(dds.get_height() * dds.get_depth() * surface.layers),
    )?;
    let storage = want["storage"].as_str().unwrap_or_default();
    if storage == "bc6h-signed" {
        // OpenImageIO and the crate `dds` read these bit for bit
        return Ok("header only: image_dds takes blocks with signs for such without");
    }
    let channels = want["channels"].as_object().ok_or("no channels")?;
    for (c, (name, column)) in channels.iter().enumerate() {
        let column = column.as_array().ok_or("no values")?;
        expect("texels", column.len() as u64, surface.data.len() as u64 / 4)?;
        for (i, bits) in column.iter().enumerate() {
            let bits =
                u64::from_str_radix(bits.as_str().unwrap_or_default(), 16).map_err(|e| e.to_string())?;
            let want = f64::from_bits(bits);
            let texel = &surface.data[4 * i..4 * i + 4];
            let got = match storage {
                // the reader's shader: a power, then a division
                "rgbd" => (f64::from(texel[c])).powf(2.2) / f64::from(texel[3]),
                _ => f64::from(texel[c]),
            };
            // codes are divided in f32
            let allowed = match storage {
                "half" | "float" => 0.0,
                "rgbd" => 2e-6 * want.abs(),
                // decoded to 8 bits, in steps of a ramp that are rounded too
                "bc4" | "bc5" => 1.0 / 255.0,
                _ => 1e-7,
            };
            if (got - want).abs() > allowed {
                return Err(format!("{name}, texel {i}: got {got}, expected {want}"));
            }
        }
    }
    Ok("every texel as expected")
}

/// The crate `image` knows OpenEXR of R, G, B and A only.
fn check_exr(path: &Path, want: &Value) -> Result<&'static str, String> {
    let picture = image::open(path).map_err(|e| e.to_string())?.into_rgba32f();
    expect("width", picture.width().into(), want["width"].as_u64().unwrap_or(0))?;
    expect("height", picture.height().into(), want["height"].as_u64().unwrap_or(0))?;
    for (name, column) in want["channels"].as_object().ok_or("no channels")? {
        let c = ["R", "G", "B", "A"].iter().position(|n| n == name).ok_or("a channel of another name")?;
        for (i, (pixel, bits)) in picture.pixels().zip(column.as_array().ok_or("no values")?).enumerate() {
            let bits =
                u64::from_str_radix(bits.as_str().unwrap_or_default(), 16).map_err(|e| e.to_string())?;
            let (got, want) = (f64::from(pixel.0[c]), f64::from_bits(bits));
            if (got - want).abs() > 0.0 {
                return Err(format!("{name}, pixel {i}: got {got}, expected {want}"));
            }
        }
    }
    Ok("every pixel as expected by the crate image")
}

fn main() -> ExitCode {
    let folder = std::env::args().nth(1).unwrap_or_default();
    let (mut files, mut decoded, mut failed) = (0, 0, 0);
    let Ok(entries) = std::fs::read_dir(&folder) else {
        eprintln!("usage: image-dds-reads-brdfbake FOLDER");
        return ExitCode::from(2);
    };
    let mut paths: Vec<_> = entries.flatten().map(|e| e.path()).collect();
    paths.sort();
    let positional = |p: &Path| p.to_string_lossy().ends_with(".positional.exr");
    for path in paths.iter().filter(|p| p.extension().is_some_and(|e| e == "dds") || positional(p)) {
        let expected = std::fs::read(format!("{}.expected.json", path.display())).unwrap_or_default();
        let check = if positional(path) { check_exr } else { check };
        let result =
            serde_json::from_slice(&expected).map_err(|e| e.to_string()).and_then(|want| check(path, &want));
        files += 1;
        match result {
            Ok(told) => {
                decoded += usize::from(!told.starts_with("header"));
                println!("ok   {}: {told}", path.display());
            }
            Err(e) => {
                failed += 1;
                println!("FAIL {}: {e}", path.display());
            }
        }
    }
    println!("{files} DDS and EXR files, {decoded} decoded, {failed} different");
    if failed > 0 {
        ExitCode::from(1)
    } else if decoded == 0 {
        ExitCode::from(2)
    } else {
        ExitCode::SUCCESS
    }
}
