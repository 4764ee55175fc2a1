//! Parameters of models: declared once, used by recipe checks, `describe`, test grids, file metadata and docs.

mod error;
mod values;

pub use error::ParamError;
pub use values::{Params, Value};

/// One parameter of a model.
#[derive(Debug, Clone, Copy)]
pub struct Param {
    /// Id, as in recipes.
    pub id: &'static str,
    /// Symbol in formulas.
    pub symbol: &'static str,
    /// Unit; `1` for pure numbers.
    pub unit: &'static str,
    /// One line of meaning.
    pub doc: &'static str,
    /// Other spellings that are accepted.
    pub also: &'static [&'static str],
    /// More of them, for values alone: words that measure something else on an axis.
    pub spelled: &'static [&'static str],
    /// How an axis runs over it by default, in the place of the roughness that the model does not have.
    pub sweep: Option<Sweep>,
    /// A number that may differ between red, green and blue: a list of three is one too.
    pub coloured: bool,
    /// A number in a range, or one of a few words.
    pub kind: Kind,
}

/// The axis that default axes take for a model: its quantity, where it is worth a table, and how it is spread.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sweep {
    /// Id of a quantity that measures the parameter.
    pub quantity: &'static str,
    /// Where the model is of use and keeps the laws that it claims, in that quantity.
    pub domain: [f64; 2],
    /// `w = v^power` of the domain normalised; 1 is an even spread.
    pub power: f64,
}

/// What values a parameter takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// A number in `[min, max]`.
    Number {
        /// Least value.
        min: f64,
        /// Largest value.
        max: f64,
        /// Value if none is given.
        preset: DefaultValue,
    },
    /// One of a few words; the first is the default.
    Choice(&'static [&'static str]),
    /// Any number of rows of numbers, as a list of lists.
    Rows {
        /// What the numbers of a row are.
        columns: &'static [Column],
        /// Rows if none are given.
        preset: &'static [&'static [f64]],
    },
}

/// A column of [`Kind::Rows`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Column {
    /// Name.
    pub id: &'static str,
    /// Least value.
    pub min: f64,
    /// Largest value.
    pub max: f64,
}

/// The default of a number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DefaultValue {
    /// A fixed value.
    Value(f64),
    /// The value of another parameter, declared before this one.
    Of(&'static str),
}

impl Param {
    /// A number parameter.
    #[must_use]
    pub const fn number(
        id: &'static str,
        symbol: &'static str,
        doc: &'static str,
        range: [f64; 2],
        preset: DefaultValue,
    ) -> Param {
        Param {
            id,
            symbol,
            unit: "1",
            doc,
            also: &[],
            spelled: &[],
            sweep: None,
            coloured: false,
            kind: Kind::Number { min: range[0], max: range[1], preset },
        }
    }

    /// A choice parameter; the first word is the default.
    #[must_use]
    pub const fn choice(id: &'static str, doc: &'static str, words: &'static [&'static str]) -> Param {
        Param {
            id,
            symbol: "",
            unit: "",
            doc,
            also: &[],
            spelled: &[],
            sweep: None,
            coloured: false,
            kind: Kind::Choice(words),
        }
    }

    /// Any number of rows of numbers.
    #[must_use]
    pub const fn rows(
        id: &'static str,
        doc: &'static str,
        columns: &'static [Column],
        preset: &'static [&'static [f64]],
    ) -> Param {
        Param {
            id,
            symbol: "",
            unit: "1",
            doc,
            also: &[],
            spelled: &[],
            sweep: None,
            coloured: false,
            kind: Kind::Rows { columns, preset },
        }
    }

    /// Is this its id, or another spelling?
    #[must_use]
    pub fn is_called(&self, name: &str) -> bool {
        self.is_measured_by(name) || self.spelled.contains(&name)
    }

    /// Does an axis of this base quantity run over it?
    #[must_use]
    pub fn is_measured_by(&self, base: &str) -> bool {
        self.id == base || self.also.contains(&base)
    }

    /// The numbers that it takes.
    #[must_use]
    pub fn range(&self) -> Option<[f64; 2]> {
        match self.kind {
            Kind::Number { min, max, .. } => Some([min, max]),
            _ => None,
        }
    }

    /// The same parameter with other accepted spellings.
    #[must_use]
    pub const fn also(mut self, names: &'static [&'static str]) -> Param {
        self.also = names;
        self
    }
    /// The same parameter, of which a list of three gives red, green and blue.
    #[must_use]
    pub const fn coloured(mut self) -> Param {
        self.coloured = true;
        self
    }
    /// The same parameter with spellings that no axis goes by.
    #[must_use]
    pub const fn spelled(mut self, names: &'static [&'static str]) -> Param {
        self.spelled = names;
        self
    }

    /// The same parameter with the axis that default axes take for it.
    #[must_use]
    pub const fn swept(mut self, quantity: &'static str, domain: [f64; 2], power: f64) -> Param {
        self.sweep = Some(Sweep { quantity, domain, power });
        self
    }
}
