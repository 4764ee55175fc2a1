//! Lines for a shader that reads a table as a texture: texture coordinates from the quantities of the axes, and values
//! from what the sampler returns. Two functions, `NAME_uv` and `NAME_decode`; the sampling stays the engine's own.

use super::program::{indices, name_of};
use super::{Glsl, Hlsl, Syntax, Wgsl};
use crate::encode::EncodeError;
use crate::grid::Grid;
use crate::grid::axis::count;
use crate::grid::expression::Expression;
use crate::grid::scalar::Scalar;

/// Languages that read textures.
static LANGUAGES: &[&dyn Syntax] = &[&Glsl, &Hlsl, &Wgsl];

/// A function.
#[derive(Debug)]
pub struct Lines {
    pub(super) name: String,
    /// Names and components.
    pub(super) arguments: Vec<(&'static str, usize)>,
    /// Indented lines before the result.
    pub(super) body: String,
    pub(super) results: Vec<String>,
}

/// What the shader makes of a texel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Decode {
    /// The components as they are.
    Plain,
    /// Loss and rest of a split sum to scale and bias; a third component stays.
    ScaleBias,
    /// Loss and rest to the integral of Fc and the total; a third component stays.
    Multiscatter,
}

/// Both functions in a language: `glsl`, `hlsl` or `wgsl`. `channels` are the ids of what a texel holds.
///
/// # Errors
/// [`EncodeError::Unknown`] for another language, [`EncodeError::Axes`] for a table that is no picture,
/// [`EncodeError::Channels`] for more than four channels.
pub fn lines(
    name: &str,
    grid: &Grid,
    channels: &[&str],
    decode: Decode,
    language: &str,
) -> Result<String, EncodeError> {
    let unknown = || EncodeError::Unknown { id: language.to_owned() };
    let syntax = LANGUAGES.iter().find(|s| s.id() == language).ok_or_else(unknown)?;
    let name = name_of(name);
    let (uv, decoded) = (coordinates(&name, grid, *syntax)?, values(&name, channels.len(), decode, *syntax));
    let limit =
        || EncodeError::Channels { format: syntax.id(), storage: "texel", count: channels.len(), limit: 4 };
    let meaning = match decode {
        Decode::Plain => channels.join(", "),
        Decode::ScaleBias => third("dfg.scale, dfg.bias", channels),
        Decode::Multiscatter => third("dfg.fc, dfg.total", channels),
    };
    let uv = syntax.function(&uv).ok_or_else(limit)?;
    let decoded = syntax.function(&decoded).ok_or_else(limit)?;
    Ok(format!(
        "// where to sample: linear filter, clamped to the edge, one level\n{uv}\n\
         // what was sampled ({}), to {meaning}\n{decoded}",
        channels.join(", ")
    ))
}

fn third(two: &str, channels: &[&str]) -> String {
    channels.get(2).map_or_else(|| two.to_owned(), |c| format!("{two}, {c}"))
}

fn coordinates(name: &str, grid: &Grid, syntax: &dyn Syntax) -> Result<Lines, EncodeError> {
    let axes = grid.axes();
    if axes.len() != 2 {
        return Err(EncodeError::Axes { format: syntax.id(), fault: "a picture has two" });
    }
    let mut body = String::new();
    for (n, index) in indices(axes, true).iter().enumerate() {
        let line = syntax.float(&format!("x{n}"), &index.write(syntax, false), false);
        body.push_str(&format!("    {line}\n"));
    }
    let result = |n: usize| {
        let x = Expression::name(format!("x{n}")).plus(Expression::Number(0.5));
        x.over(Expression::Number(count(axes[n].len))).write(syntax, false)
    };
    Ok(Lines {
        name: format!("{name}_uv"),
        arguments: axes.iter().map(|a| (a.quantity.id, 1)).collect(),
        body,
        results: (0..2).map(result).collect(),
    })
}

/// E = 1 - loss, bias = E (1 - mu)^5 + rest, scale = E - bias: see the layout `factored` of the table `dfg`.
fn values(name: &str, channels: usize, decode: Decode, syntax: &dyn Syntax) -> Lines {
    let component = |c: usize| format!("texel.{}", ["x", "y", "z", "w"].get(c).copied().unwrap_or("w"));
    let mut lines = Lines {
        name: format!("{name}_decode"),
        arguments: vec![("texel", 4), ("mu", 1)],
        body: String::new(),
        results: (0..channels).map(component).collect(),
    };
    if decode == Decode::Plain {
        lines.arguments.truncate(1);
        return lines;
    }
    for (name, value) in [
        ("albedo", "1.0 - texel.x"),
        ("m", "1.0 - mu"),
        ("m2", "m * m"),
        ("bias", "albedo * (m2 * m2 * m) + texel.y"),
    ] {
        lines.body.push_str(&format!("    {}\n", syntax.float(name, value, false)));
    }
    let two = if decode == Decode::ScaleBias { ["albedo - bias", "bias"] } else { ["bias", "albedo"] };
    lines.results.splice(0..2.min(channels), two.map(str::to_owned));
    lines
}
