//! What is asked of the output before the arguments are parsed, since what is wrong with them is told in the same way: colour, and
//! errors as JSON.

use clap::ValueEnum;
use std::ffi::OsString;
use std::io::IsTerminal;
use std::sync::OnceLock;

/// When to colour what is said to people.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum Color {
    /// On a terminal, unless the environment sets NO_COLOR, or TERM=dumb.
    #[default]
    Auto,
    /// Always, also into files and pipes.
    Always,
    /// Never.
    Never,
}

impl From<Color> for clap::ColorChoice {
    fn from(color: Color) -> clap::ColorChoice {
        match color {
            Color::Auto => clap::ColorChoice::Auto,
            Color::Always => clap::ColorChoice::Always,
            Color::Never => clap::ColorChoice::Never,
        }
    }
}

/// What arguments ask of the output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Asked {
    pub(super) color: Color,
    /// Errors are objects on stdout, too.
    pub(super) json: bool,
}

impl Asked {
    /// Looks through arguments, right or wrong.
    pub(super) fn of(args: impl Iterator<Item = OsString>) -> Asked {
        let mut asked = Asked::default();
        let mut before = String::new();
        for arg in args.map(|a| a.to_string_lossy().into_owned()).take_while(|a| a != "--") {
            let (option, value) = arg.split_once('=').unwrap_or((&before, &arg));
            match option {
                "--color" => asked.color = Color::from_str(value, false).unwrap_or(asked.color),
                "--message-format" => asked.json |= value == "json",
                _ => {}
            }
            asked.json |= arg == "--json";
            before = arg;
        }
        asked
    }
}

static COLOURED: OnceLock<bool> = OnceLock::new();

/// Decides once whether stderr is coloured.
pub(super) fn set(color: Color) {
    let _ = COLOURED.set(match color {
        Color::Always => true,
        Color::Never => false,
        Color::Auto => {
            let set = |name: &str| std::env::var_os(name).filter(|v| !v.is_empty());
            set("NO_COLOR").is_none()
                && set("TERM").is_none_or(|t| t != "dumb")
                && std::io::stderr().is_terminal()
        }
    });
}

/// Is stderr coloured?
pub(super) fn is_coloured() -> bool {
    COLOURED.get().copied().unwrap_or(false)
}

/// How a word stands out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Paint {
    /// It failed.
    Bad,
    /// It is in doubt.
    Doubtful,
    /// It is well.
    Good,
}

/// A word for stderr.
pub(super) fn paint(paint: Paint, word: &str) -> String {
    let code = match paint {
        Paint::Bad => "1;31",
        Paint::Doubtful => "33",
        Paint::Good => "32",
    };
    if is_coloured() { format!("\x1b[{code}m{word}\x1b[0m") } else { word.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arguments_are_looked_through_before_they_are_parsed() {
        let of = |text: &str| Asked::of(text.split(' ').map(OsString::from));
        assert_eq!(of("bake x"), Asked::default());
        assert!(of("bake --message-format json").json && of("bake --message-format=json").json);
        assert!(!of("bake --message-format human").json && of("nonsense --json").json);
        assert!(!of("eval -- --json").json);
        assert_eq!(of("--color never bake").color, Color::Never);
        assert_eq!(of("bake --color=always --wrong").color, Color::Always);
        assert_eq!(of("bake --color=blue").color, Color::Auto);
    }
}
