//! `brdfbake map`: parameter maps with filtered levels, and how far each level is from the texels that it stands for.

use super::limits::Limits;
use super::{Exit, Failure, map_facets, map_sbrdf, output};
use crate::cancel::Cancel;
use crate::encode::mips::containers;
use crate::functions::conversion::{By, CONVERSIONS};
use crate::maps::{Centre, Convention, Effort, Objective, RULES, rules};
use crate::math::figures::short;
use crate::math::nearest::offer;
use crate::picture::{Space, Wrap};
use crate::pipeline::map::{MapOutcome, run as filter};
use crate::plan::Fault;
use crate::plan::map::{FromLobe, Input, MapRequest, Output, Packing, RoughnessInput, Second};
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::path::PathBuf;
use std::sync::Arc;

/// Shown behind the help.
const EXAMPLES: &str = "Examples:\n  brdfbake map --normal normal.png --roughness 0.4 -o maps";

/// Arguments of `map`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Normal map: PNG, JPEG, WebP, EXR, KTX2, DDS or HDR. Codes 0..1 stand for -1..1.
    #[arg(short, long, value_name = "FILE")]
    normal: Option<PathBuf>,
    /// Roughness: an image, or a number.
    #[arg(short, long, value_name = "FILE|NUMBER", default_value = "1")]
    roughness: String,
    /// Channel of the roughness, G if not given; its other channels are written too, with plain means. A grey image serves for any colour.
    #[arg(long, value_name = "NAME")]
    channel: Option<String>,
    /// The image holds 1 - roughness (gloss, smoothness).
    #[arg(long)]
    gloss: bool,
    /// The roughness is coded as sRGB, against every format of materials.
    #[arg(long)]
    srgb: bool,
    /// The codes tell of another lobe: a parametrisation of `describe to-ggx`, such as blinn-phong or ward.
    #[arg(long, value_name = "ID", requires = "range")]
    from: Option<String>,
    /// Channel of the second number, of lobes that have two (with --anisotropic).
    #[arg(long, value_name = "NAME", requires = "from")]
    second_channel: Option<String>,
    /// Channel of the angle of the first axis from the tangent: codes 0..1 are half a turn, pi radians.
    #[arg(long, value_name = "NAME", requires = "second_channel")]
    angle_channel: Option<String>,
    /// Numbers that the codes 0 and 1 stand for.
    #[arg(long, value_name = "LO,HI", value_delimiter = ',', requires = "from")]
    range: Vec<f64>,
    /// The codes are spread over the logarithm of the number.
    #[arg(long, requires = "from")]
    log: bool,
    /// Take the GGX lobe of the same peak, not the nearest one.
    #[arg(long, requires = "from")]
    formula: bool,
    /// Factor of the roughness (roughnessFactor of glTF); what is written is for a factor of 1.
    #[arg(long, value_name = "NUMBER", default_value_t = 1.0)]
    factor: f64,
    /// Write the roughness alone, without the channels that it is packed with.
    #[arg(long)]
    single: bool,
    /// Write roughness in G, with occlusion in R and metallic in B as glTF has them; 1 where there is none.
    #[arg(long, conflicts_with = "single")]
    gltf: bool,
    /// Channels of the normal.
    #[arg(long, value_name = "X,Y,Z", value_delimiter = ',', default_values = ["R", "G", "B"], requires = "normal")]
    normal_channels: Vec<String>,
    /// Green grows down (DirectX); glTF has it grow up.
    #[arg(long, requires = "normal")]
    green_down: bool,
    /// Take z = sqrt(1 - x^2 - y^2) in place of the third channel.
    #[arg(long, requires = "normal")]
    derive_z: bool,
    /// The normal map holds numbers from -1 to 1, not codes.
    #[arg(long, requires = "normal")]
    signed: bool,
    /// Factor of x and y of the normals (normalTexture.scale of glTF); what is written is for a scale of 1.
    #[arg(long, value_name = "NUMBER", default_value_t = 1.0, requires = "normal")]
    normal_scale: f64,
    /// Take texels without a direction above the surface as flat (padding that was left black).
    #[arg(long, requires = "normal")]
    mend_normals: bool,
    /// Bring the smaller of both maps to the size of the larger one.
    #[arg(long, requires = "normal")]
    resample: bool,
    /// What lies beyond the borders, where a map is resampled; one word, or one for each axis (repeat,clamp).
    #[arg(long, value_enum, value_delimiter = ',', default_value = "repeat", requires = "resample")]
    wrap: Vec<WrapMode>,
    /// Filter rule: fit, or a published one (`list rules`).
    #[arg(long, default_value = "fit")]
    rule: String,
    /// The normal that the lobes stand about: the mean, as mips of a normal map have it, or a fitted one, which is written.
    #[arg(long, value_enum, default_value = "mean")]
    normals: Normals,
    /// Fit two widths and a direction, as KHR_materials_anisotropy has them, and write them.
    #[arg(long)]
    anisotropic: bool,
    #[command(flatten)]
    facets: map_facets::Facets,
    /// Reference mode: every facet, 16384 nodes, milliseconds a texel.
    #[arg(long)]
    exact: bool,
    /// What the fit makes small: D of the distributions of normals, or the error of the reflected light in four views (slow).
    #[arg(long, value_enum, default_value = "normals")]
    objective: Aim,
    /// Containers, each with storages or not (`ktx2:roughness=bc4+normal=bc5`).
    #[arg(short, long, value_name = "LIST", value_delimiter = ',', default_values = ["ktx2"], long_help = formats())]
    format: Vec<String>,
    /// Storage of the roughness; of the container, if not given (unorm8, in EXR float).
    #[arg(long, value_name = "STORAGE")]
    roughness_storage: Option<String>,
    /// Storage of the normals; of the container, if not given (unorm16, in EXR float).
    #[arg(long, value_name = "STORAGE", requires = "normal")]
    normal_storage: Option<String>,
    /// How the names of the files begin.
    #[arg(long, default_value = "map")]
    name: String,
    /// Texels of a level that are measured against the maps themselves, beside the twenty worst.
    #[arg(long, value_name = "N", default_value_t = 32)]
    check: usize,
    /// Measure every published rule at the same texels.
    #[arg(long)]
    compare: bool,
    /// Output folder.
    #[arg(short, long, value_name = "DIR", default_value = "brdfbake-maps")]
    out: PathBuf,
    #[command(flatten)]
    sbrdf: map_sbrdf::Lobes,
    #[command(flatten)]
    limits: Limits,
    /// Print nothing but errors.
    #[arg(short, long, conflicts_with = "json")]
    quiet: bool,
    /// Print what the files say of themselves as JSON on stdout.
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum WrapMode {
    Repeat,
    Mirror,
    Clamp,
}

impl WrapMode {
    const fn mode(self) -> Wrap {
        match self {
            WrapMode::Repeat => Wrap::Repeat,
            WrapMode::Mirror => Wrap::Mirror,
            WrapMode::Clamp => Wrap::Clamp,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Aim {
    Normals,
    Reflected,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Normals {
    Mean,
    Fit,
}

/// Runs it.
///
/// # Errors
/// [`Failure`] with the exit code of the cause; the output folder is then as it was.
pub fn run(args: &Args, cancel: &Arc<Cancel>) -> Result<Exit, Failure> {
    let request = request(args)?;
    let shown = !args.quiet && std::io::stderr().is_terminal();
    let bar = if shown { ProgressBar::new(0) } else { ProgressBar::hidden() };
    if let Ok(style) = ProgressStyle::with_template("{bar:30} {percent}% {pos}/{len} texels, {eta}") {
        bar.set_style(style);
    }
    let tell = |done: usize, all: usize| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
    };
    let done = filter(&request, &args.limits.settings(&args.out), cancel, &tell);
    bar.finish_and_clear();
    let outcome = done?;
    if args.json {
        let text = serde_json::to_string_pretty(&outcome.record);
        output::data(&text.map_err(|e| Failure::new(Exit::Internal, e))?)?;
    } else if !args.quiet {
        output::talk(&summary(&outcome, &args.out));
    }
    Ok(Exit::Done)
}

fn request(args: &Args) -> Result<MapRequest, Failure> {
    let rule = rules::rule(&args.rule).ok_or_else(|| {
        let offer = offer(&args.rule, RULES.iter().map(|r| r.id));
        Failure::usage(format!("--rule {}: no such rule{offer}", args.rule))
    })?;
    if !args.normal_scale.is_finite() || args.normal_scale < 0.0 {
        return Err(Failure::usage(format!("--normal-scale {} must not be negative", args.normal_scale)));
    }
    let packing = match (args.single, args.gltf) {
        (true, _) => Packing::Single,
        (_, true) => Packing::Gltf,
        _ => Packing::Image,
    };
    let normal = args.normal.as_ref().map(|path| normal(args, path)).transpose()?;
    let mut request = MapRequest::new(&args.name, normal, roughness(args)?);
    request.anisotropy = args.facets.request(request.normal.as_ref(), args.resample)?;
    let filter = &mut request.filter;
    filter.rule = rule;
    filter.centre = if args.normals == Normals::Fit { Centre::Free } else { Centre::Mean };
    filter.shape = args.facets.shape(args.anisotropic);
    filter.effort = if args.exact { Effort::Exact } else { Effort::Fast };
    filter.objective =
        if args.objective == Aim::Reflected { Objective::Reflected } else { Objective::Normals };
    let (factor, check, compare) = (args.factor, args.check, args.compare);
    let outputs = args.format.iter().map(|text| format(args, text)).collect::<Result<_, _>>()?;
    let sbrdf = args.sbrdf.request()?;
    Ok(MapRequest { packing, factor, outputs, check, compare, sbrdf, ..request })
}

/// The help of `--format`, with the containers that there are.
fn formats() -> String {
    let all: Vec<String> = containers()
        .map(|e| {
            let storages: Vec<&str> = e.mip_storages().iter().map(|s| s.id()).collect();
            format!("{} ({})", e.id(), storages.join(", "))
        })
        .collect();
    format!(
        "Containers, each with storages or not (`ktx2:roughness=bc4+normal=bc5`); those of maps are {}",
        all.join("; ")
    )
}

fn normal(args: &Args, path: &std::path::Path) -> Result<Input, Failure> {
    let wrap = match args.wrap[..] {
        [both] => [both.mode(); 2],
        [across, down] => [across.mode(), down.mode()],
        _ => return Err(Failure::usage("--wrap: one word is needed, or two, as in repeat,clamp")),
    };
    let least = if args.derive_z { 2 } else { 3 };
    let mut names = args.normal_channels.clone();
    if names.len() < least || names.len() > 3 {
        let given = names.join(",");
        return Err(Failure::usage(format!("--normal-channels {given}: {least} names are needed")));
    }
    names.resize(3, String::new());
    let [x, y, z] = [0, 1, 2].map(|i| std::mem::take(&mut names[i]));
    Ok(Input {
        image: path.to_owned().into(),
        channels: [x, y, z],
        convention: Convention {
            green_down: args.green_down,
            derive_z: args.derive_z,
            scale: args.normal_scale,
            mend: args.mend_normals,
        },
        signed: args.signed,
        wrap,
        resample: args.resample,
    })
}

fn roughness(args: &Args) -> Result<RoughnessInput, Failure> {
    let from = args.from.as_deref().map(|id| from(args, id)).transpose()?;
    let number = args.roughness.parse::<f64>();
    let of_an_image = [
        ("--channel", args.channel.is_some()),
        ("--srgb", args.srgb),
        ("--from", args.from.is_some()),
        ("--single", args.single),
        ("--resample", args.resample),
    ];
    if let (Ok(_), Some((option, _))) = (&number, of_an_image.iter().find(|(_, given)| *given)) {
        let message =
            format!("{option} tells of an image of the roughness, and it is the number {}", args.roughness);
        return Err(Failure::usage(message));
    }
    Ok(match number {
        Ok(r) => RoughnessInput::Constant(if args.gloss { 1.0 - r } else { r }),
        Err(_) => RoughnessInput::Image {
            image: PathBuf::from(&args.roughness).into(),
            channel: args.channel.clone().unwrap_or_else(|| "G".to_owned()),
            space: if args.srgb { Space::Srgb } else { Space::Linear },
            gloss: args.gloss,
            from,
        },
    })
}

/// What the codes tell of.
fn from(args: &Args, id: &str) -> Result<FromLobe, Failure> {
    let conversion = CONVERSIONS.iter().find(|c| c.id == id).ok_or_else(|| {
        let ids: Vec<&str> = CONVERSIONS.iter().map(|c| c.id).collect();
        let offer = offer(id, ids.iter().copied());
        Failure::usage(format!("--from {id}: no such parametrisation{offer}; there are {}", ids.join(", ")))
    })?;
    let angle = args.angle_channel.clone();
    let second = args.second_channel.clone().map(|channel| Second { channel, angle });
    let [lo, hi] = args.range[..] else {
        return Err(Failure::usage("--range: two numbers are needed, as LO,HI"));
    };
    let by = if args.formula { By::Formula } else { By::Nearest };
    Ok(FromLobe { conversion, range: [lo, hi], log: args.log, by, second })
}

/// A container with its storages.
fn format(args: &Args, text: &str) -> Result<Output, Failure> {
    let refused = |option: String| {
        move |fault: Fault| {
            let more = [fault.allowed(), fault.remedy()].into_iter().flatten();
            Failure::usage(more.fold(format!("{option}: {fault}"), |text, more| format!("{text}; {more}")))
        }
    };
    let mut output = Output::parse(text).map_err(refused(format!("--format {text}")))?;
    for (option, kind, given) in [
        ("--roughness-storage", "roughness", &args.roughness_storage),
        ("--normal-storage", "normal", &args.normal_storage),
    ] {
        if let Some(id) = given {
            output = output.with(kind, id).map_err(refused(format!("{option} {id}")))?;
        }
    }
    Ok(output)
}

/// What was written, level by level.
fn summary(outcome: &MapOutcome, folder: &std::path::Path) -> String {
    let record = &outcome.record;
    let mut out =
        format!("{}: rule {}, normals {}, {}\n", record.name, record.rule, record.normals, record.shape);
    out.push_str(
        "D is half the integral of |footprint - lobe|: 0 the same, 1 disjoint\n\
         level     size       roughness       D mean   largest   measured (largest miss)   stored\n",
    );
    for (k, level) in record.levels.iter().enumerate() {
        let [w, h] = level.size;
        let [lo, hi] = level.roughness;
        let mut line = format!("{k:>5} {:>11}  {lo:.4} .. {hi:.4}", format!("{w}x{h}"));
        if k > 0 {
            line.push_str(&format!("   {:.4}    {:.4}", level.mean, level.largest));
        }
        if let Some(m) = &level.measured {
            line.push_str(&format!("    {:.4} ({:.4})    {:>18.4}", m.mean, m.miss, m.stored_mean));
        }
        let mut told = |n: usize, what: &str| {
            if n > 0 {
                line.push_str(&format!("  {n} {what}"));
            }
        };
        told(level.at_limit, "at the limit alpha = 1");
        told(level.hopeless, "with D >= 0.5");
        if let Some([_, eight]) = level.measured.as_ref().map(|m| &m.normals[..]) {
            line.push_str(&format!("  normals of 8 bits: {:.4}", eight.mean));
        }
        out.push_str(&line);
        out.push('\n');
    }
    map_sbrdf::lobes(record, &mut out);
    map_sbrdf::conversion(record, &mut out);
    let measured: Vec<_> = record.levels.iter().filter_map(|l| l.measured.as_ref()).collect();
    // every level has the same rules
    for (i, rule) in measured.iter().take(1).flat_map(|m| &m.rules).map(|r| &r.rule).enumerate() {
        let means: Vec<String> = measured.iter().map(|m| format!("{:.4}", m.rules[i].mean)).collect();
        out.push_str(&format!("rule {rule:<10} mean D of levels 1..: {}\n", means.join(" ")));
    }
    for place in record.worst.iter().take(5) {
        let limit = if place.at_limit { ", wants alpha > 1" } else { "" };
        let d = short(f64::from(place.distance));
        out.push_str(&format!("worst: level {} ({}, {}) D {d}{limit}\n", place.level, place.x, place.y));
    }
    let folder = folder.display();
    out.push_str(&format!("{folder}: {} files written, {} unchanged", outcome.written, outcome.unchanged));
    out
}
