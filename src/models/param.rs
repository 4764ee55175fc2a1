//! Parameters of models: declared once, used by recipe checks, `describe`, test grids, file metadata and docs.

mod error;

use crate::math::figures::exact;
pub use error::ParamError;
use serde_json::Value as Json;

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
        preset: Preset,
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
pub enum Preset {
    /// A fixed value.
    Value(f64),
    /// The value of another parameter, declared before this one.
    Of(&'static str),
}

/// A resolved value.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A number.
    Number(f64),
    /// A word.
    Choice(&'static str),
    /// Rows of numbers.
    Rows(Vec<Vec<f64>>),
}

/// Resolved parameters: every declared one has a value in its range.
#[derive(Debug, Clone, PartialEq)]
pub struct Params {
    model: &'static str,
    values: Vec<(&'static str, Value)>,
}

impl Params {
    /// Resolves given JSON values against the declared parameters; what is not given gets its default.
    ///
    /// # Errors
    /// [`ParamError`] names the key, what was given and what is allowed.
    pub fn resolve<'a>(
        model: &'static str,
        declared: &'static [Param],
        given: impl IntoIterator<Item = (&'a str, &'a Json)>,
    ) -> Result<Params, ParamError> {
        let mut set: Vec<Option<Value>> = vec![None; declared.len()];
        for (key, value) in given {
            let Some(i) = declared.iter().position(|p| p.is_called(key)) else {
                return Err(unknown(model, declared, key));
            };
            set[i] = Some(parse(model, &declared[i], value)?);
        }
        let mut values: Vec<(&'static str, Value)> = Vec::with_capacity(declared.len());
        for (param, given) in declared.iter().zip(set) {
            let value = given.unwrap_or_else(|| match param.kind {
                Kind::Number { preset: Preset::Value(v), .. } => Value::Number(v),
                Kind::Number { preset: Preset::Of(id), .. } => {
                    values.iter().find(|(k, _)| *k == id).map_or(Value::Number(f64::NAN), |(_, v)| v.clone())
                }
                Kind::Choice(words) => Value::Choice(words.first().copied().unwrap_or_default()),
                Kind::Rows { preset, .. } => Value::Rows(preset.iter().map(|row| row.to_vec()).collect()),
            });
            values.push((param.id, value));
        }
        Ok(Params { model, values })
    }

    /// The same, where a name of the model stands for some values, which given ones replace.
    ///
    /// # Errors
    /// As [`Params::resolve`]; [`ParamError::Twice`] for a parameter that is given under two names.
    pub fn resolve_over(
        model: &'static str,
        declared: &'static [Param],
        implied: &serde_json::Map<String, Json>,
        given: &serde_json::Map<String, Json>,
    ) -> Result<Params, ParamError> {
        let same = |a: &str, b: &str| declared.iter().any(|p| p.is_called(a) && p.is_called(b));
        for (i, other) in given.keys().enumerate() {
            if let Some(key) = given.keys().take(i).find(|key| same(key, other)) {
                return Err(ParamError::Twice { model, key: key.clone(), other: other.clone() });
            }
        }
        Params::resolve(model, declared, implied.iter().chain(given).map(|(k, v)| (k.as_str(), v)))
    }

    /// The model that these belong to.
    #[must_use]
    pub fn model(&self) -> &'static str {
        self.model
    }

    /// A number; NaN if the model has no such parameter (a fault of the model's file, found by the registry test).
    #[must_use]
    pub fn number(&self, id: &str) -> f64 {
        match self.values.iter().find(|(k, _)| *k == id) {
            Some((_, Value::Number(v))) => *v,
            _ => f64::NAN,
        }
    }

    /// A word; empty if the model has no such parameter.
    #[must_use]
    pub fn choice(&self, id: &str) -> &'static str {
        match self.values.iter().find(|(k, _)| *k == id) {
            Some((_, Value::Choice(v))) => v,
            _ => "",
        }
    }

    /// Rows of numbers, each as long as its columns; none if the model has no such parameter.
    #[must_use]
    pub fn rows(&self, id: &str) -> &[Vec<f64>] {
        match self.values.iter().find(|(k, _)| *k == id) {
            Some((_, Value::Rows(rows))) => rows,
            _ => &[],
        }
    }

    /// Replaces a number by the value of an axis. Returns false if there is no such number.
    pub fn set(&mut self, id: &str, value: f64) -> bool {
        match self.values.iter_mut().find(|(k, _)| *k == id) {
            Some((_, Value::Number(v))) => {
                *v = value;
                true
            }
            _ => false,
        }
    }

    /// All values in declared order.
    #[must_use]
    pub fn values(&self) -> &[(&'static str, Value)] {
        &self.values
    }

    /// All values as JSON, without those in `skip`.
    #[must_use]
    pub fn to_json(&self, skip: &[&str]) -> serde_json::Map<String, Json> {
        let json = |v: &Value| match v {
            Value::Number(n) => Json::from(*n),
            Value::Choice(c) => Json::from(*c),
            Value::Rows(rows) => rows.iter().map(|r| Json::from(r.as_slice())).collect(),
        };
        self.values
            .iter()
            .filter(|(k, _)| !skip.contains(k))
            .map(|(k, v)| ((*k).to_owned(), json(v)))
            .collect()
    }
}

fn unknown(model: &'static str, declared: &[Param], key: &str) -> ParamError {
    let ids: Vec<&str> = declared.iter().map(|p| p.id).collect();
    ParamError::Unknown {
        model,
        key: key.to_owned(),
        allowed: if ids.is_empty() { "none".to_owned() } else { ids.join(", ") },
        suggestion: crate::math::nearest::nearest(key, ids.iter().copied()).map(str::to_owned),
    }
}

fn parse(model: &'static str, param: &Param, value: &Json) -> Result<Value, ParamError> {
    let wrong = |allowed: String| ParamError::Kind { model, key: param.id, got: value.to_string(), allowed };
    match param.kind {
        Kind::Number { min, max, .. } => {
            let got = value.as_f64().ok_or_else(|| wrong("a number".to_owned()))?;
            if !(got >= min && got <= max) {
                return Err(ParamError::Range { model, key: param.id, got, min, max });
            }
            Ok(Value::Number(got))
        }
        Kind::Choice(words) => words
            .iter()
            .find(|w| value.as_str() == Some(w))
            .map(|w| Value::Choice(w))
            .ok_or_else(|| wrong(format!("one of {}", words.join(", ")))),
        Kind::Rows { columns, .. } => {
            parse_rows(columns, value).map(Value::Rows).map_err(|(got, allowed)| {
                let got = got.unwrap_or_else(|| value.to_string());
                ParamError::Kind { model, key: param.id, got, allowed }
            })
        }
    }
}

/// Rows of numbers from JSON; else what was given, if it can be named, and what is allowed.
fn parse_rows(columns: &[Column], value: &Json) -> Result<Vec<Vec<f64>>, (Option<String>, String)> {
    let list = || (None, format!("a list of rows [{}]", names(columns)));
    let rows = value.as_array().ok_or_else(list)?;
    let mut out = Vec::with_capacity(rows.len());
    for (i, row) in rows.iter().enumerate() {
        let row = row.as_array().filter(|r| r.len() == columns.len()).ok_or_else(list)?;
        let mut numbers = Vec::with_capacity(columns.len());
        for (cell, column) in row.iter().zip(columns) {
            let got = cell.as_f64().ok_or_else(list)?;
            if !(got >= column.min && got <= column.max) {
                let what = format!("{} = {} in row {}", column.id, exact(got), i + 1);
                return Err((Some(what), format!("in [{}, {}]", exact(column.min), exact(column.max))));
            }
            numbers.push(got);
        }
        out.push(numbers);
    }
    Ok(out)
}

fn names(columns: &[Column]) -> String {
    columns.iter().map(|c| c.id).collect::<Vec<_>>().join(", ")
}

impl Param {
    /// A number parameter.
    #[must_use]
    pub const fn number(
        id: &'static str,
        symbol: &'static str,
        doc: &'static str,
        range: [f64; 2],
        preset: Preset,
    ) -> Param {
        Param {
            id,
            symbol,
            unit: "1",
            doc,
            also: &[],
            spelled: &[],
            sweep: None,
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
