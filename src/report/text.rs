//! Pieces of reports: numbers, aligned lines, safe strings.

use std::fmt::Write;

/// A number with six significant digits, without trailing zeros: `0.0312`, `1.5e-7`.
#[must_use]
pub fn number(v: f64) -> String {
    if !v.is_finite() || v.abs() == 0.0 {
        return v.abs().to_string().replace("inf", if v < 0.0 { "-inf" } else { "inf" });
    }
    let scientific = format!("{v:.5e}");
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let trim = |s: &str| {
        let s = if s.contains('.') { s.trim_end_matches('0').trim_end_matches('.') } else { s };
        s.to_owned()
    };
    match exponent.parse::<i32>() {
        Ok(e @ -4..=6) => trim(&format!("{v:.*}", usize::try_from(5 - e).unwrap_or(0))),
        _ => format!("{}e{exponent}", trim(mantissa)),
    }
}

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
    use super::{clean, number};

    #[test]
    fn numbers_are_short_and_true() {
        let cases = [
            (0.0, "0"),
            (-0.0, "0"),
            (1.0, "1"),
            (-2.5, "-2.5"),
            (100.0, "100"),
            (1234567.0, "1234567"),
            (12345678.0, "1.23457e7"),
            (0.03125, "0.03125"),
            (0.0001, "0.0001"),
            (0.999_999_9, "1"),
            (1.5e-7, "1.5e-7"),
            (f64::INFINITY, "inf"),
            (f64::NEG_INFINITY, "-inf"),
            (f64::NAN, "NaN"),
        ];
        for (v, expected) in cases {
            assert_eq!(number(v), expected);
        }
    }

    #[test]
    fn a_file_cannot_steer_the_terminal() {
        assert_eq!(clean("a\u{1b}[31mb\u{202e}c\nd"), "a\\u{1b}[31mb\\u{202e}c\\u{a}d");
    }
}
