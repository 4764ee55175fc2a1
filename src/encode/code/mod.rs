//! Tables as source code: an array and a function that reads it as a GPU reads a texture.
//!
//! The function takes one argument an axis, in the axis' own quantity (`mu`, `roughness`), and returns the channels. The
//! domain, the warp, its coupling, the direction and the texel convention are inside: the caller needs none of them. It
//! interpolates linearly along every axis and clamps at the edges, like [`lookup`](crate::grid::lookup), in the numbers
//! of the array (f32 for `half` and `float`).
//!
//! What the function computes is described once (`program.rs`) and written by one file a language.
//!
//! The first line is a comment with the provenance as JSON text, in ASCII.

mod c;
mod cpp;
mod glsl;
mod hlsl;
mod js;
mod program;
mod python;
pub mod reader;
mod rust;
mod wgsl;

pub use c::C;
pub use cpp::Cpp;
pub use glsl::Glsl;
pub use hlsl::Hlsl;
pub use js::Js;
pub use python::Python;
pub use rust::Rust;
pub use wgsl::Wgsl;

use super::text::MOST_DIGITS;
use super::{EncodeError, EncodeInput, Encoder, Shape, Storage};
use crate::grid::expression::{Call, Function, Notation};
use program::Program;
pub(crate) use program::coordinates;
use std::fmt::Debug;

/// A number with a point or an exponent, the shortest that reads back to the same bits.
#[allow(clippy::cast_possible_truncation, reason = "the program computes in f32")]
fn number(v: f64, double: bool) -> String {
    if double { format!("{v:?}") } else { format!("{:?}", v as f32) }
}

impl Notation for dyn Syntax + '_ {
    fn number(&self, v: f64, double: bool) -> String {
        format!("{}{}", number(v, double), self.suffix(double))
    }

    fn call(&self, call: &Call<'_>) -> String {
        Syntax::call(self, call)
    }
}

/// How a language writes what a program says. Infix operators are the same in all of them.
pub trait Syntax: Debug + Send + Sync + 'static {
    /// Id of the container.
    fn id(&self) -> &'static str;
    /// File name extension.
    fn extension(&self) -> &'static str {
        self.id()
    }
    /// What begins a comment that ends with its line.
    fn comment(&self) -> &'static str {
        "//"
    }
    /// True if it has 64-bit floats.
    fn has_double(&self) -> bool;
    /// Most channels that its function returns.
    fn most_channels(&self) -> usize;
    /// Behind a number: `f`.
    fn suffix(&self, double: bool) -> &'static str {
        let _ = double;
        ""
    }
    /// A call, with the arguments written.
    #[doc(hidden)]
    fn call(&self, call: &Call<'_>) -> String;
    /// A constant that is an index.
    fn int(&self, name: &str, value: &str) -> String;
    /// A constant that is a number.
    fn float(&self, name: &str, value: &str, double: bool) -> String;
    /// The integer part of a number that is not negative.
    fn truncate(&self, x: &str) -> String;
    /// An index as a number.
    fn widen(&self, i: &str, double: bool) -> String;
    /// The smaller of an index and a number.
    fn least(&self, i: &str, last: usize) -> String;
    /// The type of so many numbers; none in languages that do not read textures.
    fn vector(&self, components: usize) -> Option<&'static str> {
        let _ = components;
        None
    }
    /// A function of named arguments with so many components, in a language with vectors.
    #[doc(hidden)]
    fn function(&self, f: &reader::Lines) -> Option<String> {
        let kind = self.vector(f.results.len())?;
        let arguments: Option<Vec<String>> =
            f.arguments.iter().map(|(name, n)| Some(format!("{} {name}", self.vector(*n)?))).collect();
        Some(format!(
            "{kind} {}({}) {{\n{}    return {kind}({});\n}}\n",
            f.name,
            arguments?.join(", "),
            f.body,
            f.results.join(", ")
        ))
    }
    /// The file, but for the comments above it.
    #[doc(hidden)]
    fn file(&self, parts: &Parts<'_>) -> String;
}

/// The parts of a file.
#[derive(Debug)]
pub struct Parts<'a> {
    /// Stem of the names.
    pub(super) name: &'a str,
    /// Argument names.
    pub(super) arguments: &'a [&'static str],
    /// The numbers, in lines.
    pub(super) numbers: String,
    pub(super) count: usize,
    pub(super) double: bool,
    /// Indented lines of the function, before its result.
    pub(super) body: String,
    /// One expression a channel.
    pub(super) results: Vec<String>,
}

impl Parts<'_> {
    /// `a, b` with something in front of and behind each argument.
    pub(super) fn arguments(&self, before: &str, behind: &str) -> String {
        let all: Vec<String> = self.arguments.iter().map(|a| format!("{before}{a}{behind}")).collect();
        all.join(", ")
    }

    /// The results as indented lines, with commas between.
    pub(super) fn results(&self) -> String {
        self.results.iter().map(|r| format!("        {r}")).collect::<Vec<_>>().join(",\n")
    }
}

/// Most numbers of an array in a shader: a constant of SPIR-V is one instruction of at most 65 535 words, three of which are
/// not its numbers.
const MOST_IN_SHADERS: usize = 65_532;

/// A language as a container.
#[derive(Debug, Clone, Copy)]
pub struct Code<S>(
    /// Its syntax.
    pub S,
);

impl<S: Syntax> Encoder for Code<S> {
    fn id(&self) -> &'static str {
        self.0.id()
    }

    fn extension(&self) -> &'static str {
        self.0.extension()
    }

    fn media_type(&self) -> &'static str {
        "text/plain"
    }

    fn storages(&self) -> &'static [Storage] {
        let all = &[Storage::Float, Storage::Half, Storage::Double];
        if self.0.has_double() { all } else { &all[..2] }
    }

    fn most_channels(&self) -> usize {
        self.0.most_channels()
    }

    fn check_size(&self, shape: &Shape<'_>) -> Result<(), EncodeError> {
        let [width, height, slices] = shape.extent();
        let count = [height, slices, shape.channels].into_iter().fold(width, usize::saturating_mul);
        let limit = if self.0.vector(1).is_some() { MOST_IN_SHADERS } else { 1 << 26 };
        if count > limit {
            return Err(EncodeError::Numbers { format: self.id(), count, limit });
        }
        Ok(())
    }

    /// A number, its suffix, comma and blank; eight of them are a line, with indentation.
    fn most_bytes(&self, shape: &Shape<'_>) -> usize {
        let digits = MOST_DIGITS[usize::from(shape.storage == Storage::Double)];
        // the function that reads it has a length of its own
        (shape.grid.len() * shape.channels).saturating_mul(digits + 4).saturating_add(1 << 16)
    }

    /// The numbers, and the file while it grows.
    fn most_memory(&self, shape: &Shape<'_>) -> usize {
        self.most_bytes(shape).saturating_mul(4)
    }

    fn encode(&self, input: &EncodeInput<'_>) -> Result<Vec<u8>, EncodeError> {
        input.check(self)?;
        let program = Program::new(input);
        let parts = program.parts(&self.0);
        input.cancel.check()?;
        let file = self.0.file(&parts);
        let mut text = program.comment(self.0.comment(), input);
        text.push('\n');
        text.push_str(&file);
        Ok(text.into_bytes())
    }
}
