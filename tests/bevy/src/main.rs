//! Loads baked files through Bevy's own loader and checks the texels.
//!
//! ```sh
//! brdfbake bake --engine bevy -o OUT && brdfbake bake tests/bevy/arrays.toml -o OUT
//! cargo run --manifest-path tests/bevy/Cargo.toml -- OUT
//! ```
//! `samples.ktx2`, which is `dfg.ktx2` with the value at its place in every texel, is compared with `spot_values.csv`, made by `spot_values.py`
//! without brdfbake, and, if BRDFBAKE_SHARED names them, with accurate integrals at all texels. The texels of `dfg.ktx2` are fitted to the
//! reader: they must lie round the samples. `ltc.ktx2` is an array of two layers; its mirror end has a closed form. `array.ktx2` and `volume.ktx2` are compared with the CSV of the same bake: what is checked is that Bevy finds
//! each texel where it belongs.
//!
//! Exit code: 0 all agree, 1 not.

use bevy_asset::RenderAssetUsages;
use bevy_image::{CompressedImageFormats, Image, ImageSampler, ImageType};
use std::path::Path;
use std::process::ExitCode;

type Fault = Box<dyn std::error::Error>;

/// A picture as the engine makes it from the bytes of the file.
fn load(path: &Path) -> Result<Image, Fault> {
    let bytes = std::fs::read(path).map_err(|e| format!("{}: {e}", path.display()))?;
    let kind = ImageType::Extension("ktx2");
    let usage = RenderAssetUsages::default();
    Ok(Image::from_buffer(&bytes, kind, CompressedImageFormats::NONE, false, ImageSampler::linear(), usage)?)
}

fn same(what: &str, got: &str, want: &str) -> Result<(), Fault> {
    if got == want { Ok(()) } else { Err(format!("{what}: got {got}, expected {want}").into()) }
}

/// Size, dimension and format in the engine's own words.
fn describe(image: &Image) -> String {
    let d = &image.texture_descriptor;
    let size = d.size;
    format!(
        "{} x {} x {} {:?} {:?}",
        size.width, size.height, size.depth_or_array_layers, d.dimension, d.format
    )
}

fn half(bits: u16) -> f64 {
    let (sign, exponent, mantissa) = (bits >> 15, i32::from(bits >> 10 & 31), f64::from(bits & 1023));
    let value = match exponent {
        0 => mantissa * 2f64.powi(-24),
        e => (1.0 + mantissa / 1024.0) * 2f64.powi(e - 15),
    };
    if sign == 1 { -value } else { value }
}

fn halves(image: &Image) -> Result<Vec<f64>, Fault> {
    let data = image.data.as_ref().ok_or("no data")?;
    Ok(data.as_chunks::<2>().0.iter().map(|b| half(u16::from_le_bytes(*b))).collect())
}

fn floats(image: &Image) -> Result<Vec<f64>, Fault> {
    let data = image.data.as_ref().ok_or("no data")?;
    Ok(data.as_chunks::<4>().0.iter().map(|b| f64::from(f32::from_le_bytes(*b))).collect())
}

/// Rows of a CSV as numbers, without the header.
fn rows(path: &Path) -> Result<Vec<Vec<f64>>, Fault> {
    let text = std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
    text.lines().skip(1).map(|l| l.split(',').map(|n| Ok(n.trim().parse()?)).collect()).collect()
}

/// The tolerance of the recipe, and half a step of a half float.
fn allowed(value: f64) -> f64 {
    1e-5 + value.abs().max(2f64.powi(-14)) * 2f64.powi(-11)
}

fn compare(texels: &[f64], x: usize, y: usize, want: &[f64]) -> Result<f64, Fault> {
    let mut largest = 0f64;
    for (c, want) in want.iter().enumerate() {
        let got = *texels.get(2 * (64 * y + x) + c).ok_or("too few texels")?;
        let off = (got - want).abs();
        if off > allowed(*want) {
            return Err(format!("texel ({x}, {y}), component {c}: got {got}, expected {want}").into());
        }
        largest = largest.max(off);
    }
    Ok(largest)
}

/// The split sum that Bevy puts in its binary.
fn dfg(folder: &Path) -> Result<(), Fault> {
    let [fitted, image] = ["dfg.ktx2", "samples.ktx2"].map(|name| load(&folder.join(name)));
    let (fitted, image) = (fitted?, image?);
    for picture in [&fitted, &image] {
        same("dfg.ktx2", &describe(picture), "64 x 64 x 1 D2 Rg16Float")?;
    }
    let texels = halves(&image)?;
    same("values", &texels.len().to_string(), &(64 * 64 * 2).to_string())?;
    let spots = rows(&Path::new(env!("CARGO_MANIFEST_DIR")).join("spot_values.csv"))?;
    let mut largest = 0f64;
    for row in &spots {
        let [x, y, _, _, scale, bias, _] = row[..] else { return Err("spot_values.csv: columns".into()) };
        largest = largest.max(compare(&texels, x as usize, y as usize, &[scale, bias])?);
    }
    println!("ok   samples.ktx2: {}, {} spot values within {largest:.1e}", describe(&image), spots.len());
    let off: Vec<f64> = halves(&fitted)?.iter().zip(&texels).map(|(f, t)| (f - t).abs()).collect();
    let mean = off.iter().sum::<f64>() / off.len() as f64;
    let largest = off.iter().copied().fold(0.0, f64::max);
    // another order of rows or columns would be off by 0.2 in the mean
    if off.len() != texels.len() || mean > 1e-3 {
        return Err(format!("dfg.ktx2: {mean} from the samples in the mean").into());
    }
    println!("ok   dfg.ktx2: fitted texels {mean:.1e} from the samples in the mean, {largest:.1e} at most");
    shared(&texels)
}

/// The area lights: layer 0 the matrices, layer 1 magnitude, Fresnel term, 0 and horizon.
fn ltc(folder: &Path) -> Result<(), Fault> {
    let image = load(&folder.join("ltc.ktx2"))?;
    same("ltc.ktx2", &describe(&image), "64 x 64 x 2 D2 Rgba16Float")?;
    let view = image.texture_view_descriptor.as_ref().and_then(|v| v.dimension);
    same("view of ltc.ktx2", &format!("{view:?}"), "Some(D2Array)")?;
    let texels = halves(&image)?;
    same("values", &texels.len().to_string(), &(2 * 64 * 64 * 4).to_string())?;
    // a mirror seen along the normal: all light is reflected, none by the grazing term
    let mirror = &texels[64 * 64 * 4..][..4];
    if (mirror[0] - 1.0).abs() > 1e-3 || mirror[1].abs() > 1e-3 || mirror[2] != 0.0 {
        return Err(format!("ltc.ktx2: layer 1 begins with {mirror:?}, not with a mirror").into());
    }
    // GGX of alpha = 1 is D = 1 / pi, of which E(1) = 1 - ln 2
    let rough = texels[(64 * 64 + 63) * 4];
    if (rough - (1.0 - 2f64.ln())).abs() > 1e-3 {
        return Err(
            format!("ltc.ktx2: E = {rough} at roughness 1 along the normal, expected 1 - ln 2").into()
        );
    }
    println!("ok   ltc.ktx2: {}, both ends of the first row as closed forms have them", describe(&image));
    Ok(())
}

/// All texels, where the shared values are.
fn shared(texels: &[f64]) -> Result<(), Fault> {
    let Some(folder) = std::env::var_os("BRDFBAKE_SHARED") else {
        println!("SKIPPED: BRDFBAKE_SHARED is not set, only the spot values were compared");
        return Ok(());
    };
    let bytes = std::fs::read(Path::new(&folder).join("oracles/engines/bevy/dfg_exact_same_layout.npy"))?;
    // NumPy: magic, version, length of the header, header, data
    let start = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let all: Vec<f64> = bytes[start..].as_chunks::<8>().0.iter().map(|b| f64::from_le_bytes(*b)).collect();
    same("shared values", &all.len().to_string(), &texels.len().to_string())?;
    let mut largest = 0f64;
    for (i, want) in all.as_chunks::<2>().0.iter().enumerate() {
        largest = largest.max(compare(texels, i % 64, i / 64, want)?);
    }
    println!("ok   dfg.ktx2: all texels within {largest:.1e} of accurate integrals");
    Ok(())
}

/// Slices in the order of the file, the components beyond the channel filled.
fn slices(folder: &Path) -> Result<(), Fault> {
    let array = load(&folder.join("array.ktx2"))?;
    same("array.ktx2", &describe(&array), "8 x 6 x 3 D2 Rgba16Float")?;
    let view = array.texture_view_descriptor.as_ref().and_then(|v| v.dimension);
    same("view of array.ktx2", &format!("{view:?}"), "Some(D2Array)")?;
    let texels = halves(&array)?;
    let want = rows(&folder.join("array.csv"))?;
    same("texels", &(texels.len() / 4).to_string(), &want.len().to_string())?;
    for (i, (texel, row)) in texels.as_chunks::<4>().0.iter().zip(&want).enumerate() {
        same(&format!("array, texel {i}"), &format!("{texel:?}"), &format!("{:?}", [row[3], 0.0, 0.0, 1.0]))?;
    }
    println!("ok   array.ktx2: {}, every texel where it belongs", describe(&array));
    let volume = load(&folder.join("volume.ktx2"))?;
    same("volume.ktx2", &describe(&volume), "8 x 6 x 3 D3 R32Float")?;
    let texels = floats(&volume)?;
    let want: Vec<f64> = rows(&folder.join("volume.csv"))?.iter().map(|row| row[3]).collect();
    same("volume", &format!("{texels:?}"), &format!("{want:?}"))?;
    println!("ok   volume.ktx2: {}, every texel where it belongs", describe(&volume));
    Ok(())
}

fn main() -> ExitCode {
    let folder = std::env::args().nth(1).unwrap_or_default();
    let folder = Path::new(&folder);
    let mut code = ExitCode::SUCCESS;
    for check in [dfg, ltc, slices] {
        if let Err(e) = check(folder) {
            println!("FAIL {e}");
            code = ExitCode::from(1);
        }
    }
    code
}
