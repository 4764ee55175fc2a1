//! Faults with their places in the file, and how they are shown: line, column, the line itself with a caret, a remedy.

use super::span::Spans;
use crate::math::shown::show;
use crate::plan::Place;
use crate::plan::fault::Fault;
use crate::plan::faults::Faults;
use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};
use serde::Serialize;
use std::fmt;
use std::ops::Range;

/// Diagnostics that are shown; the others are counted.
const SHOWN: usize = 50;

/// One fault of a recipe and where it lies.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Diagnostic {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// Path of the key, such as `table[0].axis[1].warp`; empty for the file itself.
    pub key: String,
    /// What is wrong and what was given.
    pub message: String,
    /// What is allowed, or the nearest thing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub allowed: Option<String>,
    /// What to do about it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub remedy: Option<String>,
    /// The fault with its numbers.
    #[serde(skip)]
    pub fault: Fault,
}

/// A recipe that was refused. `Display` shows every diagnostic with its line and a caret.
#[derive(Debug, Clone, PartialEq)]
pub struct RecipeError {
    /// The file, as it was named.
    pub file: String,
    /// The faults in file order, at most 50.
    pub diagnostics: Vec<Diagnostic>,
    /// Further faults that are not listed.
    pub hidden: usize,
    text: String,
    styled: String,
}

impl fmt::Display for RecipeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl std::error::Error for RecipeError {}

impl RecipeError {
    /// A fault of the file as a whole.
    pub(super) fn of_file(file: &str, fault: Fault) -> RecipeError {
        collect("", file, vec![(0..0, String::new(), fault)], 0)
    }

    /// The same text with colours, for a terminal.
    #[must_use]
    pub fn styled(&self) -> &str {
        &self.styled
    }

    /// A file that is not UTF-8 from byte `at` on; `valid` is the text before.
    pub(super) fn not_utf8(file: &str, valid: &str) -> RecipeError {
        let end = valid.len();
        collect(valid, file, vec![(end..end, String::new(), Fault::NotUtf8)], 0)
    }
}

/// Syntax errors, in file order.
pub(super) fn syntax(source: &str, file: &str, errors: &[toml::de::Error]) -> RecipeError {
    let list = errors.iter().map(|e| {
        let span = e.span().unwrap_or(0..0);
        let at = source.get(span.clone()).unwrap_or_default();
        let message = match e.message() {
            "duplicate key" => format!("key `{}` is given twice", show(at)),
            m if at.is_empty() && m.starts_with("string values must be quoted") => {
                "a value is missing after `=`".to_owned()
            }
            m => m.to_owned(),
        };
        (span, String::new(), Fault::Syntax(message))
    });
    collect(source, file, list.collect(), 0)
}

/// Faults with their places looked up.
pub(super) fn locate(source: &str, file: &str, spans: &Spans, faults: Faults) -> RecipeError {
    let one = |(place, fault): (Place, Fault)| (spans.find(&place), place.to_string(), fault);
    let list = faults.list.into_iter().map(one).collect();
    collect(source, file, list, faults.dropped)
}

fn collect(
    source: &str,
    file: &str,
    mut list: Vec<(Range<usize>, String, Fault)>,
    dropped: usize,
) -> RecipeError {
    list.sort_by_key(|(span, ..)| span.start);
    let hidden = dropped + list.len().saturating_sub(SHOWN);
    list.truncate(SHOWN);
    let (mut text, mut styled) = (String::new(), String::new());
    let mut diagnostics = Vec::with_capacity(list.len());
    for (span, key, fault) in list {
        let line = Line::around(source, &span);
        let d = Diagnostic {
            line: line.number,
            column: line.text[..line.span.start].chars().count() + 1,
            key: plain(key),
            message: plain(fault.to_string()),
            allowed: fault.allowed().map(plain),
            remedy: fault.remedy().map(plain),
            fault,
        };
        for (text, renderer) in [(&mut text, Renderer::plain()), (&mut styled, Renderer::styled())] {
            if !text.is_empty() {
                text.push_str("\n\n");
            }
            text.push_str(&render(file, &line, &d, &renderer));
        }
        diagnostics.push(d);
    }
    if hidden > 0 {
        let more = format!("\n\nand {hidden} more");
        text.push_str(&more);
        styled.push_str(&more);
    }
    RecipeError { file: file.to_owned(), diagnostics, hidden, text, styled }
}

/// One line of text without control characters, whatever the file holds.
fn plain(text: String) -> String {
    if !text.contains(char::is_control) {
        return text;
    }
    text.chars().flat_map(|c| if c.is_control() { c.escape_debug().collect() } else { vec![c] }).collect()
}

/// The line on which a span starts.
struct Line<'a> {
    number: usize,
    text: &'a str,
    /// The span inside the line, on character boundaries.
    span: Range<usize>,
}

impl<'a> Line<'a> {
    fn around(source: &'a str, span: &Range<usize>) -> Line<'a> {
        let start = boundary(source, span.start);
        let first = source[..start].rfind('\n').map_or(0, |i| i + 1);
        let last = source[start..].find('\n').map_or(source.len(), |i| start + i);
        let text = source[first..last].trim_end_matches('\r');
        let from = (start - first).min(text.len());
        let to = (boundary(source, span.end).max(start) - first).min(text.len());
        Line { number: source[..first].matches('\n').count() + 1, text, span: from..to.max(from) }
    }
}

fn boundary(source: &str, at: usize) -> usize {
    let mut at = at.min(source.len());
    while !source.is_char_boundary(at) {
        at -= 1;
    }
    at
}

fn render(file: &str, line: &Line<'_>, d: &Diagnostic, renderer: &Renderer) -> String {
    let file: String = file.chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect();
    let mark = AnnotationKind::Primary.span(line.span.clone()).label(d.allowed.as_deref());
    let snippet = Snippet::source(line.text).line_start(line.number).path(file.as_str()).annotation(mark);
    let mut group = Level::ERROR.primary_title(d.message.as_str()).element(snippet);
    if let Some(remedy) = &d.remedy {
        group = group.element(Level::HELP.message(remedy.as_str()));
    }
    renderer.render(&[group])
}
