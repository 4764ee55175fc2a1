//! Values of the declared parameters, resolved. A name that is not declared is an error wherever it is asked for.

use super::{Column, DefaultValue, Kind, Param, ParamError};
use crate::math::figures::exact;
use serde_json::Value as Json;

/// A resolved value.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A number.
    Number(f64),
    /// Numbers of red, green and blue.
    Rgb([f64; 3]),
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
            let value = match given {
                Some(value) => value,
                None => preset(model, param, &values)?,
            };
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

    /// A number.
    ///
    /// # Errors
    /// [`ParamError::Undeclared`] for one that the model does not have: a fault of whoever asks.
    pub fn number(&self, id: &str) -> Result<f64, ParamError> {
        match self.value(id)? {
            Value::Number(v) => Ok(*v),
            _ => Err(self.undeclared(id, "a number")),
        }
    }

    /// A number for each of red, green and blue; one number is all three.
    ///
    /// # Errors
    /// As [`Params::number`].
    pub fn rgb(&self, id: &str) -> Result<[f64; 3], ParamError> {
        match self.value(id)? {
            Value::Number(v) => Ok([*v; 3]),
            Value::Rgb(all) => Ok(*all),
            _ => Err(self.undeclared(id, "a number or three")),
        }
    }

    /// A number, of a model that may not have it.
    #[must_use]
    pub fn optional(&self, id: &str) -> Option<f64> {
        self.number(id).ok()
    }

    /// Several numbers.
    ///
    /// # Errors
    /// As [`Params::number`].
    pub fn numbers<const N: usize>(&self, ids: [&str; N]) -> Result<[f64; N], ParamError> {
        let mut all = [0.0; N];
        for (slot, id) in all.iter_mut().zip(ids) {
            *slot = self.number(id)?;
        }
        Ok(all)
    }

    /// A word.
    ///
    /// # Errors
    /// As [`Params::number`].
    pub fn choice(&self, id: &str) -> Result<&'static str, ParamError> {
        match self.value(id)? {
            Value::Choice(v) => Ok(v),
            _ => Err(self.undeclared(id, "a word")),
        }
    }

    /// Rows of numbers, each as long as its columns.
    ///
    /// # Errors
    /// As [`Params::number`].
    pub fn rows(&self, id: &str) -> Result<&[Vec<f64>], ParamError> {
        match self.value(id)? {
            Value::Rows(rows) => Ok(rows),
            _ => Err(self.undeclared(id, "rows")),
        }
    }

    /// The value of a parameter.
    ///
    /// # Errors
    /// As [`Params::number`].
    pub fn value(&self, id: &str) -> Result<&Value, ParamError> {
        let found = self.values.iter().find(|(k, _)| *k == id);
        found.map(|(_, value)| value).ok_or_else(|| self.undeclared(id, "a parameter"))
    }

    fn undeclared(&self, id: &str, what: &'static str) -> ParamError {
        ParamError::Undeclared { model: self.model, key: id.to_owned(), what }
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
            Value::Rgb(all) => Json::from(all.as_slice()),
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

/// The default of a parameter, after those that are declared before it.
fn preset(model: &'static str, param: &Param, before: &[(&'static str, Value)]) -> Result<Value, ParamError> {
    Ok(match param.kind {
        Kind::Number { preset: DefaultValue::Value(v), .. } => Value::Number(v),
        Kind::Number { preset: DefaultValue::Of(id), .. } => {
            let leader = before.iter().find(|(k, _)| *k == id).map(|(_, v)| v.clone());
            let what = "a number before it";
            leader.ok_or_else(|| ParamError::Undeclared { model, key: id.to_owned(), what })?
        }
        Kind::Choice(words) => Value::Choice(words.first().copied().unwrap_or_default()),
        Kind::Rows { preset, .. } => Value::Rows(preset.iter().map(|row| row.to_vec()).collect()),
    })
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
            let allowed =
                if param.coloured { "a number, or three in a list: red, green, blue" } else { "a number" };
            let number = |value: &Json| {
                let got = value.as_f64().ok_or_else(|| wrong(allowed.to_owned()))?;
                if !(got >= min && got <= max) {
                    return Err(ParamError::Range { model, key: param.id, got, min, max });
                }
                // -0 and 0 are the same number
                Ok(got + 0.0)
            };
            match value.as_array().map(Vec::as_slice) {
                Some([r, g, b]) if param.coloured => Ok(Value::Rgb([number(r)?, number(g)?, number(b)?])),
                _ => Ok(Value::Number(number(value)?)),
            }
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
