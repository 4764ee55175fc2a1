//! `brdfbake preview`: spheres as integrals and as tables, and what lies between.

use super::{Exit, Failure, engine, output, scene};
use crate::cancel::Cancel;
use crate::encode::atomic;
use crate::math::figures::{exact, significant};
use crate::pipeline::preview::{self, Mesh, Panel, PreviewError, Scene, Sky, Surface};
use crate::pipeline::{InMemoryError, pool};
use crate::plan::scene::SurveyOptions;
use base64::Engine as _;
use std::path::PathBuf;
use std::sync::Arc;

/// Shown behind the help.
const EXAMPLES: &str = concat!(
    "Examples:",
    "\n  brdfbake preview --roughness 0.2,0.5 --size 64 -o spheres.png",
    "\n  brdfbake preview --scene scene.glb --mesh --turn 30 -o mesh.png",
);

/// What says how the spheres of a row are.
const SPHERES: [&str; 3] = ["roughness", "base", "metallic"];

/// Arguments of `preview`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Shade the materials of a glTF file, each by the mean of its texels, in place of a row over roughness.
    #[arg(long, value_name = "FILE", conflicts_with_all = SPHERES)]
    scene: Option<PathBuf>,
    /// Shade the meshes of that file in place of spheres, seen along -z without perspective.
    #[arg(long, requires = "scene", conflicts_with_all = SPHERES)]
    mesh: bool,
    /// Turn the meshes by this angle, in degrees, round the upright axis, to the right.
    #[arg(
        long,
        value_name = "DEGREES",
        requires = "mesh",
        conflicts_with_all = SPHERES,
        default_value_t = 0.0,
        allow_negative_numbers = true
    )]
    turn: f64,
    /// Roughness of each sphere.
    #[arg(long, value_name = "R", value_delimiter = ',', default_value = "0.1,0.3,0.5,0.7,1")]
    roughness: Vec<f64>,
    /// Linear base colour.
    #[arg(long, value_name = "R,G,B", value_delimiter = ',', num_args = 1, default_value = "1,0.77,0.34")]
    base: Vec<f64>,
    /// From dielectric (0) to metal (1).
    #[arg(long, value_name = "M", default_value_t = 1.0)]
    metallic: f64,
    /// Use the tables of this engine, as it reads them (`list engines`).
    #[arg(long, value_name = "ENGINE")]
    engine: Option<String>,
    /// A uniform white sky in place of the built-in one.
    #[arg(long)]
    furnace: bool,
    /// Add a rectangle of light, shaded by transformed cosines.
    #[arg(long)]
    panel: bool,
    /// Diameter of a sphere in pixels, or side of the picture of a mesh.
    #[arg(long, value_name = "PIXELS", default_value_t = 128, value_parser = clap::value_parser!(u16).range(8..=4096))]
    size: u16,
    /// Output files, .png or .exr; may be given several times. Default: preview.png
    #[arg(short, long = "out", value_name = "FILE")]
    out: Vec<PathBuf>,
    /// Show the picture in a terminal that takes this protocol.
    #[arg(long, value_enum, value_name = "PROTOCOL")]
    terminal: Option<Terminal>,
    /// Print the numbers as JSON.
    #[arg(long, conflicts_with = "terminal")]
    json: bool,
}

/// How a terminal takes pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Terminal {
    /// The graphics protocol of kitty, which Ghostty and WezTerm take too.
    Kitty,
    /// The inline images of iTerm2.
    Iterm,
}

/// Runs it.
///
/// # Errors
/// [`Failure`] for numbers out of range, an engine without a split sum, a scene that is refused, a file that cannot be written.
pub fn run(args: &Args, cancel: &Arc<Cancel>) -> Result<Exit, Failure> {
    let (surfaces, mesh) = surfaces(args)?;
    let engine = args.engine.as_deref().map(engine::find).transpose()?;
    let scene = Scene {
        surfaces,
        mesh,
        sky: if args.furnace { Sky::WHITE } else { Sky::built_in() },
        panel: args.panel.then(Panel::built_in),
        size: usize::from(args.size),
    };
    let made = pool(None)?.install(|| {
        let (tables, style) = preview::tables_of(engine, args.panel, cancel)?;
        if args.panel && tables.cosines.is_none() {
            let name = engine.map_or("the preset", |e| e.title);
            return Err(PreviewError::NoSplit(format!(
                "{name}: --panel: it has no transformed cosines over m22; it"
            )));
        }
        preview::render(&scene, &tables, &style, cancel)
    });
    let made = made.map_err(failure)?;
    let png = || preview::png(&made).map_err(|e| Failure::new(Exit::Internal, e));
    let default = [PathBuf::from("preview.png")];
    let none = args.out.is_empty() && args.terminal.is_none();
    let mut files = Vec::new();
    for path in if none { &default[..] } else { &args.out[..] } {
        let bytes = match path.extension().and_then(|e| e.to_str()) {
            Some("png") => png()?,
            Some("exr") => preview::exr(&made).map_err(|e| Failure::new(Exit::Internal, e))?,
            _ => {
                return Err(Failure::usage(format!(
                    "{}: a preview is written as .png or .exr",
                    path.display()
                )));
            }
        };
        files.push((path.clone(), bytes));
    }
    atomic::write_all(&files, cancel)?;
    if let Some(terminal) = args.terminal {
        output::data(&shown(terminal, &png()?))?;
    }
    if args.json {
        let what = if args.mesh { "materials" } else { "spheres" };
        output::data(&serde_json::json!({ what: made.spheres }).to_string())?;
    } else {
        output::data(&text(&made))?;
    }
    Ok(Exit::Done)
}

/// The spheres that are asked for, or the mesh with its materials.
fn surfaces(args: &Args) -> Result<(Vec<Surface>, Option<Mesh>), Failure> {
    if !args.turn.is_finite() {
        return Err(Failure::usage("--turn takes an angle in degrees"));
    }
    if let Some(path) = &args.scene {
        let options = SurveyOptions::default();
        let (surfaces, mesh, left_out) = if args.mesh {
            let (surfaces, mesh, left_out) = preview::mesh(path, args.turn, &options).map_err(failure)?;
            (surfaces, Some(mesh), left_out)
        } else {
            let (surfaces, left_out) = preview::materials(path, &options).map_err(failure)?;
            (surfaces, None, left_out)
        };
        for line in left_out {
            output::talk(&format!("not shown: {}", crate::report::text::clean(&line)));
        }
        return Ok((surfaces, mesh));
    }
    let unit = |name: &str, v: f64| match (0.0..=1.0).contains(&v) {
        true => Ok(v),
        false => Err(Failure::usage(format!("--{name} {} outside [0, 1]", exact(v)))),
    };
    let [r, g, b] = args.base[..] else {
        return Err(Failure::usage("--base takes three numbers: 1,0.77,0.34"));
    };
    let base = [unit("base", r)?, unit("base", g)?, unit("base", b)?];
    let metallic = unit("metallic", args.metallic)?;
    let sphere = |r: &f64| {
        let roughness = unit("roughness", *r)?;
        Ok(Surface { name: format!("roughness {}", exact(r)), base, metallic, roughness, f0: 0.04 })
    };
    Ok((args.roughness.iter().map(sphere).collect::<Result<_, Failure>>()?, None))
}

fn text(made: &preview::Preview) -> String {
    let mut lines = vec![
        "Rows: integrated; as the shader reads its tables; difference. RMSE in codes of 8-bit sRGB, the rest linear.".to_owned(),
    ];
    for s in &made.spheres {
        if s.pixels == 0 {
            lines.push(format!("{}: not seen", crate::report::text::clean(&s.surface.name)));
            continue;
        }
        lines.push(format!(
            "{}: RMSE {} of 255, largest {}; the table alone: RMSE {}, largest {}; the integrals themselves {}",
            crate::report::text::clean(&s.surface.name),
            significant(s.rmse_codes, 3),
            significant(s.largest, 2),
            significant(s.table_rmse_codes, 3),
            significant(s.table_largest, 2),
            significant(s.own_error, 2)
        ));
    }
    lines.join("\n")
}

/// A PNG as the control sequence of a terminal.
fn shown(terminal: Terminal, png: &[u8]) -> String {
    let data = base64::engine::general_purpose::STANDARD.encode(png);
    match terminal {
        Terminal::Iterm => format!("\x1b]1337;File=inline=1;size={}:{data}\x07", png.len()),
        Terminal::Kitty => {
            // at most 4096 bytes a sequence; base64 is plain ASCII, so any split is one of characters
            let chunks: Vec<&str> =
                data.as_bytes().chunks(4096).filter_map(|c| std::str::from_utf8(c).ok()).collect();
            let sequence = |(i, chunk): (usize, &&str)| {
                let first = if i == 0 { "f=100,a=T," } else { "" };
                format!("\x1b_G{first}m={};{chunk}\x1b\\", u8::from(i + 1 < chunks.len()))
            };
            chunks.iter().enumerate().map(sequence).collect()
        }
    }
}

fn failure(error: PreviewError) -> Failure {
    match error {
        PreviewError::Cancelled(stopped) => Failure::from(stopped),
        PreviewError::Bake(InMemoryError::Bake(e)) => Failure::from(e),
        PreviewError::NoSplit(_) => Failure::new(Exit::Unsupported, error),
        PreviewError::Scene(e) => scene::refused(std::slice::from_ref(&e)),
        PreviewError::NoMaterial { .. } | PreviewError::Param(_) => Failure::input(error),
        _ => Failure::new(Exit::Internal, error),
    }
}
