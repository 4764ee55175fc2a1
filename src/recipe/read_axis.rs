//! `[[table.axis]]` to an [`Axis`]. Ranges are checked later, by the axis itself.

use super::keys::{AXIS, COUPLED, SEARCHED, WARP};
use super::section::{Section, as_number, wrong};
use crate::grid::quantity::QUANTITIES;
use crate::grid::{Axis, Direction, Quantity, Texel, Warp};
use crate::plan::Path;
use crate::plan::fault::{Fault, unknown_word};
use crate::plan::faults::Faults;
use crate::plan::sizing::PROVISIONAL;
use toml::de::{DeTable, DeValue};

/// Warps that have a name.
pub(super) const WORDS: &[(&str, Warp)] = &[
    ("linear", Warp::Linear),
    ("sqrt", Warp::Power(0.5)),
    ("square", Warp::Power(2.0)),
    ("sqrt-one-minus", Warp::OneMinusPower(0.5)),
];

/// Reads an axis; none if its quantity or its length cannot be read.
/// `searched`: its length will be found.
pub(super) fn read(table: &DeTable<'_>, path: &Path, searched: bool, faults: &mut Faults) -> Option<Axis> {
    let section = Section::new(table, path, if searched { &SEARCHED } else { &AXIS }, faults);
    let quantity = section.text("id", faults).and_then(|id| {
        let found = Quantity::find(&id);
        if found.is_none() {
            faults.value(section.path("id"), unknown_word("quantity", &id, QUANTITIES.iter().map(|q| q.id)));
        }
        found
    });
    let length = if searched { Some(PROVISIONAL) } else { section.count("length", faults) };
    let texels = [("center", Texel::Center), ("endpoint", Texel::Endpoint)];
    let texel = section.word("texel", &texels, faults).unwrap_or(Texel::Endpoint);
    let directions = [("ascending", Direction::Ascending), ("descending", Direction::Descending)];
    let direction = section.word("direction", &directions, faults);
    let domain = section.pair("domain", faults);
    let clamp = section.pair("clamp", faults);
    let offset = section.number("offset", faults);
    let warp = warp(&section, faults);
    let mut axis = Axis::new(quantity?, length?, texel);
    axis.domain = domain.unwrap_or(axis.domain);
    axis.direction = direction.unwrap_or(axis.direction);
    axis.offset = offset.unwrap_or(axis.offset);
    axis.warp = warp.unwrap_or(axis.warp);
    axis.clamp = clamp;
    Some(axis)
}

fn warp(section: &Section<'_>, faults: &mut Faults) -> Option<Warp> {
    match section.get("warp")? {
        DeValue::String(word) => {
            let found = WORDS.iter().find(|(w, _)| w == word).map(|(_, warp)| warp.clone());
            if found.is_none() {
                let words = WORDS.iter().map(|(w, _)| *w);
                faults.value(section.path("warp"), unknown_word("warp", word, words));
            }
            found
        }
        DeValue::Table(table) => warp_table(table, &section.path("warp"), faults),
        other => {
            faults.value(section.path("warp"), wrong("warp", other, "a word in quotes, or a table { ... }"));
            None
        }
    }
}

fn warp_table(table: &DeTable<'_>, path: &Path, faults: &mut Faults) -> Option<Warp> {
    let coupled = table.contains_key("coupled");
    let section = Section::new(table, path, if coupled { &COUPLED } else { &WARP }, faults);
    if coupled {
        let to = section.text("coupled", faults);
        let mut number = |key, default| match section.get(key) {
            None => Some(default),
            Some(_) => section.number(key, faults),
        };
        let (power, scale, exponent) = (number("power", 2.0), number("scale", 1.0), number("exponent", 1.0));
        let to = to?;
        if let Some(q) = Quantity::find(&to).filter(|q| q.base.is_some()) {
            let words = std::iter::once(q.base_id());
            faults.value(section.path("coupled"), unknown_word("base quantity", &to, words));
            return None;
        }
        return Some(Warp::Coupled { to, power: power?, scale: scale?, exponent: exponent? });
    }
    let why = match (table.get("power"), table.get("one-minus-power")) {
        (Some(_), None) => return section.number("power", faults).map(Warp::Power),
        (None, Some(_)) => return section.number("one-minus-power", faults).map(Warp::OneMinusPower),
        (Some(_), Some(_)) => "it has both `power` and `one-minus-power`",
        (None, None) => "it has none of `power`, `one-minus-power`, `coupled`",
    };
    faults.value(path.clone(), Fault::WarpForm { why });
    None
}

/// A value of `params`: a number, a word, numbers, or rows of numbers, as JSON.
pub(super) fn param(value: &DeValue<'_>) -> Option<serde_json::Value> {
    match value {
        DeValue::String(s) => Some(serde_json::Value::from(s.as_ref())),
        DeValue::Array(cells)
            if !cells.is_empty() && cells.iter().all(|c| as_number(c.get_ref()).is_some()) =>
        {
            numbers(value)
        }
        DeValue::Array(rows) if rows.iter().all(|row| row.get_ref().as_array().is_some()) => {
            rows.iter().map(|row| numbers(row.get_ref())).collect()
        }
        _ => as_number(value).filter(|v| v.is_finite()).map(serde_json::Value::from),
    }
}

/// A row of finite numbers.
fn numbers(row: &DeValue<'_>) -> Option<serde_json::Value> {
    let cells = row.as_array()?.iter();
    cells.map(|c| as_number(c.get_ref()).filter(|v| v.is_finite()).map(serde_json::Value::from)).collect()
}
