//! What the function of a table computes, apart from the language: names, steps, results.
//!
//! For every axis `n`: `xn`, the fractional index, clamped to the texels; `in` and `jn`, the texels beside it; `tn`, how
//! far it is from the first to the second. Then for every corner `k` of the cell its weight `wk` and the place `ak` of
//! its first channel.

use super::{MOST_DIGITS, Parts, Syntax, number};
use crate::cancel::Cancel;
use crate::encode::{EncodeInput, Storage};
use crate::grid::Axis;
use crate::grid::axis::count;
use crate::grid::expression::Expression;
use crate::grid::scalar::Scalar;
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
    /// The program of a table.
    pub(super) fn new<'a>(input: &EncodeInput<'a>) -> Program<'a> {
        let axes = input.grid.axes();
        let indices = indices(axes, false);
        Program {
            name: name_of(input.label.name),
            arguments: axes.iter().map(|a| a.quantity.id).collect(),
            indices,
            lengths: axes.iter().map(|a| a.len).collect(),
            values: input.values,
            channels: input.channels.len(),
            double: input.storage == Storage::Double,
            cancel: input.cancel,
        }
    }

    /// The provenance, then what the arguments and results are: line comments, in ASCII.
    pub(super) fn comment(&self, mark: &str, input: &EncodeInput<'_>) -> String {
        let mut text = format!("brdfbake {}\n{}_lookup:", input.label.provenance_json, self.name);
        for axis in input.grid.axes() {
            let [lo, hi] = axis.domain;
            let _ = write!(text, "\n  {} in [{lo}, {hi}]: {}", axis.quantity.id, axis.quantity.meaning);
        }
        text.push_str("\nreturns");
        for c in input.channels {
            let _ = write!(text, "\n  {}: {}", c.id, c.meaning.replace(['\n', '\r'], " "));
        }
        let lines: Vec<String> = text.lines().map(|l| format!("{mark} {}", ascii(l))).collect();
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

/// Fractional index on each axis, clamped to the texels; see [`coordinates`].
pub(super) fn indices(axes: &[Axis], clamped: bool) -> Vec<Expression> {
    let index = |(axis, x): (&Axis, Expression)| axis.index_at(x).at_least(0.0).at_most(count(axis.len - 1));
    axes.iter().zip(coordinates(axes, clamped)).map(index).collect()
}

/// Axis coordinates in [0, 1] as expressions in the axes' own quantities.
/// `clamped`: what lies outside of a domain counts as its end in couplings too.
pub(crate) fn coordinates(axes: &[Axis], clamped: bool) -> Vec<Expression> {
    let one = |axis: &Axis| {
        let base = axis.warp.couples_to().unwrap_or_default();
        let coupled = match axes.iter().find(|a| a.quantity.base_id() == base) {
            Some(other) => {
                let [lo, hi] = other.domain;
                let value = Expression::name(other.quantity.id);
                other.quantity.to_base(if clamped { value.at_least(lo).at_most(hi) } else { value })
            }
            None => Expression::name(base),
        };
        axis.coordinate_of(Expression::name(axis.quantity.id), coupled)
    };
    axes.iter().map(one).collect()
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
