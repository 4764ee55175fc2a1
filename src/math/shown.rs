//! Text from files and arguments, as messages show it.

/// Given text in a message: control characters escaped, so that it is safe for a terminal, cut after 64 characters.
#[must_use]
pub fn show(text: &str) -> String {
    const LONGEST: usize = 64;
    // quotes and backslashes are harmless and read better as they are
    let escaped = |c: char| if matches!(c, '"' | '\'' | '\\') { vec![c] } else { c.escape_debug().collect() };
    let mut out: String = text.chars().take(LONGEST).flat_map(escaped).collect();
    if text.chars().nth(LONGEST).is_some() {
        out.push('…');
    }
    out
}
