//! Pieces of reports: numbers, aligned lines, safe strings.

pub use crate::math::figures::short as number;
use std::fmt::Write;

/// Text from a file with its control characters spelled out, so that a file cannot steer a terminal.
#[must_use]
pub fn clean(s: &str) -> String {
    let mut out = String::with_capacity(s.len());
    for c in s.chars() {
        // Bidirectional overrides and isolates reorder what is shown; they are not control characters to Rust.
        if c.is_control() || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}') {
            out.extend(c.escape_unicode());
        } else {
            out.push(c);
        }
    }
    out
}

/// `1 texel`, `2 texels`.
#[must_use]
pub fn counted(n: usize, word: &str) -> String {
    format!("{n} {word}{}", if n == 1 { "" } else { "s" })
}

/// Lines of a report: a label in a column of its own, then text.
#[derive(Debug, Default)]
pub(super) struct Lines(String);

impl Lines {
    /// A line without label.
    pub(super) fn plain(&mut self, text: &str) {
        self.0.push_str(&clean(text));
        self.0.push('\n');
    }

    /// A labelled line; further lines of the text are indented below the first.
    pub(super) fn item(&mut self, label: &str, text: &str) {
        for (i, line) in text.lines().enumerate() {
            let label = if i == 0 { label } else { "" };
            // Writing into a String cannot fail.
            let _ = writeln!(self.0, "  {:<15} {}", clean(label), clean(line));
        }
    }

    /// The report.
    pub(super) fn finish(self) -> String {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::clean;

    #[test]
    fn a_file_cannot_steer_the_terminal() {
        assert_eq!(clean("a\u{1b}[31mb\u{202e}c\nd"), "a\\u{1b}[31mb\\u{202e}c\\u{a}d");
    }
}
