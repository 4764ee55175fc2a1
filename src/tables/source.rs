//! Where a table kind comes from, and which of its tables each source is a source of.

use super::{Role, Spec, TableInfo};
use crate::cite::Cite;
use crate::models::{Kind, Params, source_lines};

/// A source of a table kind.
#[derive(Debug, Clone, Copy)]
pub struct Source {
    /// The work.
    pub cite: Cite,
    /// Equation or section, and what is taken from there.
    pub place: &'static str,
    roles: Option<fn(Role) -> bool>,
    defaults: bool,
    choice: Option<(&'static str, &'static [&'static str])>,
}

impl Source {
    /// A source of every table of the kind.
    #[must_use]
    pub const fn new(cite: Cite, place: &'static str) -> Source {
        Source { cite, place, roles: None, choice: None, defaults: false }
    }

    /// A source of tables that have a channel of a role.
    #[must_use]
    pub const fn of(self, roles: fn(Role) -> bool) -> Source {
        Source { roles: Some(roles), ..self }
    }

    /// A source of tables whose parameter has one of these words.
    #[must_use]
    pub const fn when(self, param: &'static str, words: &'static [&'static str]) -> Source {
        Source { choice: Some((param, words)), ..self }
    }

    /// A source of the default parameters: of tables in which one of them has its default.
    #[must_use]
    pub const fn by_default(self) -> Source {
        Source { defaults: true, ..self }
    }

    /// Is it a source of this table?
    #[must_use]
    pub fn applies(&self, spec: &Spec) -> bool {
        let roles = self.roles.is_none_or(|of| spec.layout.channels.iter().any(|c| of(c.role)));
        let choice = self
            .choice
            .is_none_or(|(param, words)| spec.params.choice(param).is_ok_and(|word| words.contains(&word)));
        roles && choice && (!self.defaults || has_default(spec))
    }
}

/// All sources of a kind.
#[must_use]
pub fn all(kind: &TableInfo) -> Vec<String> {
    let all: Vec<(Cite, &str)> = kind.sources.iter().map(|s| (s.cite, s.place)).collect();
    source_lines(&all)
}

/// Has a parameter of the kind that no axis sweeps its default?
fn has_default(spec: &Spec) -> bool {
    let Ok(defaults) = Params::resolve(spec.kind.id, spec.kind.params, []) else { return false };
    let same = |id: &str| {
        let both = spec.params.number(id).ok().zip(defaults.number(id).ok());
        both.is_some_and(|(a, b)| (a - b).abs() <= 0.0)
    };
    spec.kind.params.iter().any(|p| matches!(p.kind, Kind::Number { .. }) && same(p.id))
}

/// The sources of a table: those of its channels and parameters, not all of its kind.
#[must_use]
pub fn lines(spec: &Spec) -> Vec<String> {
    let all: Vec<(Cite, &str)> =
        spec.kind.sources.iter().filter(|s| s.applies(spec)).map(|s| (s.cite, s.place)).collect();
    source_lines(&all)
}
