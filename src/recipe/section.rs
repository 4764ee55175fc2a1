//! One section of a recipe file: its known keys, read by type. A value of the wrong type is a fault and reads as none.

use super::keys::{Is, Keys, Need};
use crate::math::shown::show;
use crate::plan::fault::{Fault, slip, unknown_word};
use crate::plan::faults::Faults;
use crate::plan::{LONGEST_REASON, Path};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Most characters of a text.
pub(super) const LONGEST_TEXT: usize = LONGEST_REASON;

/// Most bytes of the text round the numbers of a file.
pub(super) const LONGEST_AROUND: usize = 1 << 16;

/// A TOML table with the keys that it may have.
#[derive(Debug)]
pub(super) struct Section<'a> {
    table: &'a DeTable<'a>,
    path: Path,
    keys: &'static Keys,
}

impl<'a> Section<'a> {
    /// Takes a table and reports the keys that it should not have, and those that are not there and should be.
    pub(super) fn new(
        table: &'a DeTable<'a>,
        path: &Path,
        keys: &'static Keys,
        faults: &mut Faults,
    ) -> Section<'a> {
        let there = |id: &str| table.contains_key(id);
        for key in table.keys().map(Spanned::get_ref).filter(|k| !keys.ids().any(|id| id == k.as_ref())) {
            let fault = Fault::UnknownKey {
                key: show(key),
                section: keys.name,
                allowed: keys.ids().collect::<Vec<_>>().join(", "),
                suggestion: slip(key, keys.ids()),
            };
            faults.key(path.key(key), fault);
        }
        for key in keys.keys.iter().filter(|k| !there(k.id) && !keys.free.contains(&k.id)) {
            let example = match key.need {
                Need::Always(example) => example,
                Need::Unless(others, example) if !others.iter().any(|id| there(id)) => example,
                _ => continue,
            };
            faults.value(path.clone(), Fault::MissingKey { section: keys.name, key: key.id, example });
        }
        Section { table, path: path.clone(), keys }
    }

    /// Is the key read as the list of keys has it? Else the schema would not be that of the reader.
    fn asks(&self, key: &str, such: impl Fn(&Is) -> bool) {
        debug_assert!(self.keys.takes(key, &such), "{}: `{key}` is read as something else", self.keys.name);
    }

    /// Path of a key.
    pub(super) fn path(&self, key: &str) -> Path {
        self.path.key(key)
    }

    /// The value of a key.
    pub(super) fn get(&self, key: &str) -> Option<&'a DeValue<'a>> {
        self.table.get(key).map(Spanned::get_ref)
    }

    /// A text of 1 to [`LONGEST_TEXT`] characters.
    pub(super) fn text(&self, key: &'static str, faults: &mut Faults) -> Option<String> {
        self.asks(key, |is| matches!(is, Is::Text | Is::Word(_)));
        let value = self.get(key)?;
        let Some(text) = value.as_str() else {
            faults.value(self.path(key), wrong(key, value, "a string"));
            return None;
        };
        let got = text.trim().chars().count();
        if got == 0 || got > LONGEST_TEXT {
            faults.value(self.path(key), Fault::TextLength { key: key.to_owned(), got, limit: LONGEST_TEXT });
            return None;
        }
        Some(text.to_owned())
    }

    /// A text of any characters, up to [`LONGEST_AROUND`] bytes.
    pub(super) fn long_text(&self, key: &'static str, faults: &mut Faults) -> Option<String> {
        self.asks(key, |is| matches!(is, Is::LongText));
        let value = self.get(key)?;
        let Some(text) = value.as_str() else {
            faults.value(self.path(key), wrong(key, value, "a string"));
            return None;
        };
        if text.len() > LONGEST_AROUND {
            let (got, limit) = (text.chars().count(), LONGEST_AROUND);
            faults.value(self.path(key), Fault::TextLength { key: key.to_owned(), got, limit });
            return None;
        }
        Some(text.to_owned())
    }

    /// A number, written as integer or float.
    pub(super) fn number(&self, key: &'static str, faults: &mut Faults) -> Option<f64> {
        self.asks(key, |is| matches!(is, Is::Number));
        let value = self.get(key)?;
        let number = as_number(value);
        if number.is_none() {
            faults.value(self.path(key), wrong(key, value, "a number"));
        }
        number
    }

    /// Two numbers.
    pub(super) fn pair(&self, key: &'static str, faults: &mut Faults) -> Option<[f64; 2]> {
        let items = self.list(key, "two numbers, such as [0.0, 1.0]", faults)?;
        if items.len() != 2 {
            let allowed = "two numbers, such as [0.0, 1.0]".to_owned();
            faults.value(self.path(key), Fault::Count { key, got: items.len(), allowed });
            return None;
        }
        let mut pair = [None; 2];
        for (i, (slot, item)) in pair.iter_mut().zip(items).enumerate() {
            *slot = as_number(item.get_ref());
            if slot.is_none() {
                let entry = format!("{key}[{i}]");
                faults.value(self.path(key).index(i), wrong(&entry, item.get_ref(), "a number"));
            }
        }
        Some([pair[0]?, pair[1]?])
    }

    /// A count; its upper limit is the business of whoever asked.
    pub(super) fn count(&self, key: &'static str, faults: &mut Faults) -> Option<usize> {
        self.asks(key, |is| matches!(is, Is::Count));
        let value = self.get(key)?;
        let Some(integer) = value.as_integer() else {
            faults.value(self.path(key), wrong(key, value, "an integer"));
            return None;
        };
        let count = usize::from_str_radix(integer.as_str(), integer.radix()).ok();
        if count.is_none() {
            let got = as_number(value).unwrap_or(f64::INFINITY);
            faults.value(self.path(key), Fault::Range { key: key.to_owned(), got, min: 1.0, max: 16384.0 });
        }
        count
    }

    /// One of a few words.
    pub(super) fn word<T: Copy>(
        &self,
        key: &'static str,
        words: &[(&'static str, T)],
        faults: &mut Faults,
    ) -> Option<T> {
        self.asks(
            key,
            |is| matches!(is, Is::Word(all) if all().into_iter().eq(words.iter().map(|(w, _)| *w))),
        );
        let value = self.get(key)?;
        let Some(got) = value.as_str() else {
            faults.value(self.path(key), wrong(key, value, "a word in quotes"));
            return None;
        };
        let found = words.iter().find(|(w, _)| *w == got).map(|(_, t)| *t);
        if found.is_none() {
            faults.value(self.path(key), unknown_word(key, got, words.iter().map(|(w, _)| *w)));
        }
        found
    }

    /// A list.
    pub(super) fn list(
        &self,
        key: &'static str,
        expected: &'static str,
        faults: &mut Faults,
    ) -> Option<&'a [Spanned<DeValue<'a>>]> {
        self.asks(key, |is| matches!(is, Is::List(..) | Is::Pair));
        let value = self.get(key)?;
        let list = value.as_array();
        if list.is_none() {
            faults.value(self.path(key), wrong(key, value, expected));
        }
        list.map(|l| &**l)
    }

    /// A list of tables with their paths. An entry that is no table is a fault and left out.
    pub(super) fn tables(
        &self,
        key: &'static str,
        expected: &'static str,
        faults: &mut Faults,
    ) -> Option<Vec<(Path, &'a DeTable<'a>)>> {
        let mut tables = Vec::new();
        for (i, item) in self.list(key, expected, faults)?.iter().enumerate() {
            let path = self.path(key).index(i);
            match item.get_ref().as_table() {
                Some(table) => tables.push((path, table)),
                None => faults.value(path, wrong(key, item.get_ref(), "a table")),
            }
        }
        Some(tables)
    }
}

/// A number of either type. An integer beyond i64 is still a number.
pub(super) fn as_number(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Float(f) => f.as_str().parse().ok(),
        DeValue::Integer(i) if i.radix() == 10 => i.as_str().parse().ok(),
        // a hexadecimal beyond u32 has no use as a number of a recipe
        DeValue::Integer(i) => u32::from_str_radix(i.as_str(), i.radix()).ok().map(f64::from),
        _ => None,
    }
}

/// Keys that are `"on"` or `"off"`.
const SWITCHES: [&str; 6] = ["reconstruction", "signed", "mend", "resample", "log", "compare"];

/// A value of the wrong type.
pub(super) fn wrong(key: &str, value: &DeValue<'_>, expected: &'static str) -> Fault {
    let remedy = match (value, expected) {
        (DeValue::String(s), "a number") if s.trim().parse::<f64>().is_ok() => Some("leave the quotes out"),
        (DeValue::Float(_), "an integer") => Some("write it without a decimal point"),
        (DeValue::Table(_), "[[map]]") => Some("write [[map]], with double brackets"),
        (DeValue::Table(_), "[[table]]") => Some("write [[table]], with double brackets"),
        (DeValue::Table(_), "[[table.axis]]") => Some("write [[table.axis]], with double brackets"),
        (DeValue::Boolean(true), _) if SWITCHES.contains(&key) => Some("write \"on\""),
        (DeValue::Boolean(false), _) if SWITCHES.contains(&key) => Some("write \"off\""),
        _ => None,
    };
    let got = match value {
        DeValue::Table(_) if expected.starts_with("[[") => "a single table",
        DeValue::Float(_) if as_number(value).is_none_or(|v| !v.is_finite()) => "not finite",
        _ => type_name(value),
    };
    Fault::Type { key: key.to_owned(), got, expected, remedy }
}

fn type_name(value: &DeValue<'_>) -> &'static str {
    match value {
        DeValue::String(_) => "a string",
        DeValue::Integer(_) => "an integer",
        DeValue::Float(_) => "a float",
        DeValue::Boolean(_) => "a boolean",
        DeValue::Datetime(_) => "a date",
        DeValue::Array(_) => "a list",
        DeValue::Table(_) => "a table",
    }
}
