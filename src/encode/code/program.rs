//! What the function of a table computes, apart from the language: names, steps, results.
//!
//! For every axis `n`: `xn`, the fractional index, clamped to the texels; `in` and `jn`, the texels beside it; `tn`, how
//! far it is from the first to the second. Then for every corner `k` of the cell its weight `wk` and the place `ak` of
//! its first channel.

use super::expression::{Expression, number};
use super::{MOST_DIGITS, Parts, Syntax};
use crate::cancel::Cancel;
use crate::encode::{EncodeError, EncodeInput, Storage};
use crate::grid::axis::count;
use crate::grid::{Axis, Direction, Texel, Warp};
use std::fmt::Write;

/// Numbers in a line of the array.
const IN_A_LINE: usize = 8;

/// A table and the function that reads it.
pub(super) struct Program<'a> {
    name: String,
    arguments: Vec<&'static str>,
    /// Fractional index on each axis.
    indices: Vec<Expression>,
    lengths: Vec<usize>,
    values: &'a [f64],
    channels: usize,
    double: bool,
    cancel: &'a Cancel,
}

impl Program<'_> {
    /// The program of a table; refused if an axis sweeps a quantity whose map to its base is not known here.
    pub(super) fn new<'a>(input: &EncodeInput<'a>) -> Result<Program<'a>, EncodeError> {
        let axes = input.grid.axes();
        let indices = indices(axes, false)?;
        Ok(Program {
            name: name_of(input.label.name),
            arguments: axes.iter().map(|a| a.quantity.id).collect(),
            indices,
            lengths: axes.iter().map(|a| a.len).collect(),
            values: input.values,
            channels: input.channels.len(),
            double: input.storage == Storage::Double,
            cancel: input.cancel,
        })
    }

    /// The provenance, then what the arguments and results are: line comments, in ASCII.
    pub(super) fn comment(&self, input: &EncodeInput<'_>) -> String {
        let mut text = format!("brdfbake {}\n{}_lookup:", input.label.provenance_json, self.name);
        for axis in input.grid.axes() {
            let [lo, hi] = axis.domain;
            let _ = write!(text, "\n  {} in [{lo}, {hi}]: {}", axis.quantity.id, axis.quantity.meaning);
        }
        text.push_str("\nreturns");
        for c in input.channels {
            let _ = write!(text, "\n  {}: {}", c.id, c.meaning.replace(['\n', '\r'], " "));
        }
        let lines: Vec<String> = text.lines().map(|l| format!("// {}", ascii(l))).collect();
        lines.join("\n")
    }

    /// The parts in a language; not all numbers if it is stopped.
    pub(super) fn parts(&self, syntax: &dyn Syntax) -> Parts<'_> {
        let suffix = syntax.suffix(self.double);
        let mut numbers =
            String::with_capacity(self.values.len() * (MOST_DIGITS[usize::from(self.double)] + 4));
        for (i, v) in self.values.iter().enumerate() {
            let before = match i % IN_A_LINE {
                0 if self.cancel.is_set() => break,
                _ if i == 0 => "    ",
                0 => ",\n    ",
                _ => ", ",
            };
            let _ = write!(numbers, "{before}{}{suffix}", number(*v, self.double));
        }
        let mut lines = Vec::new();
        for (n, index) in self.indices.iter().enumerate() {
            lines.push(syntax.float(&format!("x{n}"), &index.write(syntax, self.double), self.double));
            lines.push(syntax.int(&format!("i{n}"), &syntax.truncate(&format!("x{n}"))));
            lines
                .push(syntax.int(&format!("j{n}"), &syntax.least(&format!("i{n} + 1"), self.lengths[n] - 1)));
            let t = format!("x{n} - {}", syntax.widen(&format!("i{n}"), self.double));
            lines.push(syntax.float(&format!("t{n}"), &t, self.double));
        }
        let corners = 1usize << self.lengths.len();
        for k in 0..corners {
            lines.push(syntax.float(
                &format!("w{k}"),
                &self.weight(k).write(syntax, self.double),
                self.double,
            ));
            lines.push(syntax.int(&format!("a{k}"), &self.place(k)));
        }
        let result = |c: usize| {
            let term = |k: usize| format!("w{k} * {}_table[{}]", self.name, offset(k, c));
            (0..corners).map(term).collect::<Vec<_>>().join(" + ")
        };
        Parts {
            name: &self.name,
            arguments: &self.arguments,
            numbers,
            count: self.values.len(),
            double: self.double,
            body: lines.iter().map(|l| format!("    {l}\n")).collect(),
            results: (0..self.channels).map(result).collect(),
        }
    }

    /// Weight of a corner: the product over the axes of `t` or `1 - t`.
    fn weight(&self, corner: usize) -> Expression {
        let one = |n: usize| {
            let t = Expression::name(format!("t{n}"));
            if corner >> n & 1 == 1 { t } else { Expression::Number(1.0).minus(t) }
        };
        (1..self.lengths.len()).fold(one(0), |product, n| product.times(one(n)))
    }

    /// Place of the first channel of a corner.
    fn place(&self, corner: usize) -> String {
        let texel = |n: usize| format!("{}{n}", if corner >> n & 1 == 1 { 'j' } else { 'i' });
        let last = self.lengths.len() - 1;
        let place = (0..last).rev().fold(texel(last), |slower, n| {
            let inner = if slower.contains(' ') { format!("({slower})") } else { slower };
            format!("{} + {} * {inner}", texel(n), self.lengths[n])
        });
        match (self.channels, place.contains(' ')) {
            (1, _) => place,
            (n, true) => format!("({place}) * {n}"),
            (n, false) => format!("{place} * {n}"),
        }
    }
}

fn offset(corner: usize, channel: usize) -> String {
    if channel == 0 { format!("a{corner}") } else { format!("a{corner} + {channel}") }
}

/// Fractional index on each axis; see [`coordinates`].
pub(super) fn indices(axes: &[Axis], clamped: bool) -> Result<Vec<Expression>, EncodeError> {
    Ok(axes.iter().zip(coordinates(axes, clamped)?).map(|(axis, x)| index(axis, x)).collect())
}

/// Axis coordinates in [0, 1] as expressions in the axes' own quantities; refused if a quantity has no map to its base here.
/// `clamped`: what lies outside of a domain counts as its end in couplings too.
pub(crate) fn coordinates(axes: &[Axis], clamped: bool) -> Result<Vec<Expression>, EncodeError> {
    let one = |axis: &Axis| {
        let coupled = match axis.warp.couples_to() {
            None => Expression::Number(0.0),
            Some(base) => match axes.iter().find(|a| a.quantity.base_id() == base) {
                Some(other) if clamped => {
                    let [lo, hi] = other.domain;
                    to_base(other, Expression::name(other.quantity.id).clamp(lo, hi))?
                }
                Some(other) => to_base(other, Expression::name(other.quantity.id))?,
                None => Expression::name(base),
            },
        };
        Ok(coordinate(axis, coupled))
    };
    axes.iter().map(one).collect()
}

/// The axis coordinate of a value, clamped to the domain.
fn coordinate(axis: &Axis, coupled: Expression) -> Expression {
    use Expression::Number;
    let [lo, hi] = axis.domain;
    let v = Expression::name(axis.quantity.id).minus(Number(lo)).over(Number(hi - lo)).clamp(0.0, 1.0);
    let x = match &axis.warp {
        Warp::Linear => v,
        Warp::Power(p) => v.pow(*p),
        Warp::OneMinusPower(p) => Number(1.0).minus(Number(1.0).minus(v).pow(*p)),
        Warp::Coupled { power, scale, exponent, .. } => {
            let c = Number(*scale).times(coupled.max(0.0).pow(*exponent));
            // v = c = 0 is 0; any other pair is far above the smallest divisor
            let ratio = v.clone().times(Number(1.0).plus(c.clone())).over(v.plus(c).max(1e-30));
            ratio.pow(1.0 / power)
        }
    };
    if axis.direction == Direction::Descending { Number(1.0).minus(x) } else { x }
}

/// [`Axis::index`] as an expression, clamped to the texels.
fn index(axis: &Axis, x: Expression) -> Expression {
    use Expression::Number;
    let last = count(axis.len - 1);
    let place = match axis.texel {
        Texel::Center => x.times(Number(count(axis.len))).minus(Number(0.5 + axis.offset)),
        Texel::Endpoint => x.times(Number(last)).minus(Number(axis.offset)),
    };
    place.clamp(0.0, last)
}

/// The base quantity of an axis, from its own.
fn to_base(axis: &Axis, v: Expression) -> Result<Expression, EncodeError> {
    let one = || Expression::Number(1.0);
    match axis.quantity.id {
        id if id == axis.quantity.base_id() => Ok(v),
        "roughness" | "sheen_roughness" => Ok(v.pow(2.0)),
        "theta" => Ok(v.cos().max(0.0)),
        "f0_root4" => Ok(one().plus(v.clone().pow(2.0)).over(one().minus(v.pow(2.0)))),
        id => Err(EncodeError::Name { id: id.to_owned(), fault: "has no map to its base quantity in code" }),
    }
}

/// A name as an identifier of every language.
pub(super) fn name_of(name: &str) -> String {
    let mut id: String = name
        .chars()
        .take(64)
        .map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' })
        .collect();
    // two underscores are reserved in GLSL and C++, and so is one in front
    while id.contains("__") {
        id = id.replace("__", "_");
    }
    let id = id.trim_matches('_');
    match id.chars().next() {
        Some(c) if c.is_ascii_alphabetic() => id.to_owned(),
        Some(_) => format!("t{id}"),
        None => "brdf".to_owned(),
    }
}

/// Other characters than ASCII as JSON escapes them.
fn ascii(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        if c.is_ascii() {
            out.push(c);
        } else {
            let mut units = [0; 2];
            for unit in c.encode_utf16(&mut units) {
                let _ = write!(out, "\\u{unit:04x}");
            }
        }
    }
    // a backslash at the end would make the next line a part of the comment
    if out.ends_with('\\') {
        out.push('.');
    }
    out
}
