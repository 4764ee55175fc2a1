//! Where in a request something lies: `table[2].axis[1].domain`. Whoever made the request knows what that is to a person: a line of
//! a file, an argument of a program, a material of a scene.

use std::fmt;

/// A step from a part of a request into a part of that.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Step {
    /// The value of a key.
    Key(String),
    /// An entry of a list, from 0.
    Index(usize),
}

/// A path from the whole request down. `Display` writes it with dots and brackets; a key with other characters than a bare one of
/// TOML is quoted, so that paths are unambiguous.
#[derive(Debug, Clone, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Path(Vec<Step>);

impl Path {
    /// The whole.
    #[must_use]
    pub fn root() -> Path {
        Path::default()
    }

    /// Table number `i`.
    #[must_use]
    pub fn table(i: usize) -> Path {
        Path::root().key("table").index(i)
    }

    /// Map number `i`.
    #[must_use]
    pub fn map(i: usize) -> Path {
        Path::root().key("map").index(i)
    }

    /// The value of a key in it.
    #[must_use]
    pub fn key(&self, key: &str) -> Path {
        self.then(Step::Key(key.to_owned()))
    }

    /// An entry of it.
    #[must_use]
    pub fn index(&self, i: usize) -> Path {
        self.then(Step::Index(i))
    }

    /// One step further.
    #[must_use]
    pub fn then(&self, step: Step) -> Path {
        let mut steps = Vec::with_capacity(self.0.len() + 1);
        steps.extend_from_slice(&self.0);
        steps.push(step);
        Path(steps)
    }

    /// The steps, from the whole on.
    #[must_use]
    pub fn steps(&self) -> &[Step] {
        &self.0
    }

    /// What it is a part of; none for the whole.
    #[must_use]
    pub fn parent(&self) -> Option<Path> {
        let (_, steps) = self.0.split_last()?;
        Some(Path(steps.to_vec()))
    }
}

impl fmt::Display for Path {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, step) in self.0.iter().enumerate() {
            match step {
                Step::Index(n) => write!(f, "[{n}]")?,
                Step::Key(key) => {
                    let dot = if i == 0 { "" } else { "." };
                    let plain = |b: u8| b.is_ascii_alphanumeric() || b == b'-' || b == b'_';
                    if !key.is_empty() && key.bytes().all(plain) {
                        write!(f, "{dot}{key}")?;
                    } else {
                        write!(f, "{dot}{key:?}")?;
                    }
                }
            }
        }
        Ok(())
    }
}

/// Which half of `key = value` is at fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Part {
    /// The key, which should not be there, or not with this name.
    Key,
    /// The value; of a part that is not there, what it is missing in.
    Value,
}

/// Where a fault lies.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Place {
    /// Which part of the request.
    pub path: Path,
    /// Its key or its value.
    pub part: Part,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.path.fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::Path;

    #[test]
    fn paths_are_written_as_a_recipe_would() {
        let path = Path::table(2).key("axis").index(1).key("domain");
        assert_eq!(path.to_string(), "table[2].axis[1].domain");
        assert_eq!(Path::root().key("a b").key("").to_string(), "\"a b\".\"\"");
        assert_eq!(path.parent(), Some(Path::table(2).key("axis").index(1)));
        assert_eq!(Path::root().parent(), None);
    }
}
