//! Where each key and value of a file lies, by path: `table[0].axis[1].warp`.

use super::fault::Place;
use std::collections::HashMap;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// No key of a recipe lies deeper than `table[0].axis[0].warp.power`.
const DEEPEST: usize = 8;

/// Byte ranges of the keys and values of a document.
#[derive(Debug)]
pub(super) struct Spans {
    /// Key, value.
    at: HashMap<String, [Range<usize>; 2]>,
}

impl Spans {
    pub(super) fn of(root: &Spanned<DeTable<'_>>) -> Spans {
        let mut spans = Spans { at: HashMap::new() };
        spans.table("", root.get_ref(), 0);
        spans
    }

    /// The range of a place; that of the nearest section around it if the place itself is not in the file.
    pub(super) fn find(&self, place: &Place) -> Range<usize> {
        let mut path = place.path.as_str();
        let mut wants_key = place.key;
        loop {
            if let Some([key, value]) = self.at.get(path) {
                return if wants_key { key.clone() } else { value.clone() };
            }
            match path.rfind(['.', '[']) {
                Some(end) => path = &path[..end],
                None => return 0..0,
            }
            wants_key = false;
        }
    }

    fn table(&mut self, path: &str, table: &DeTable<'_>, depth: usize) {
        for (key, value) in table {
            let path = join(path, key.get_ref());
            self.value(&path, value, depth);
            self.at.insert(path, [key.span(), value.span()]);
        }
    }

    fn value(&mut self, path: &str, value: &Spanned<DeValue<'_>>, depth: usize) {
        if depth >= DEEPEST {
            return;
        }
        match value.get_ref() {
            DeValue::Table(table) => self.table(path, table, depth + 1),
            DeValue::Array(list) => {
                for (i, item) in list.iter().enumerate() {
                    let path = format!("{path}[{i}]");
                    self.value(&path, item, depth + 1);
                    self.at.insert(path, [item.span(), item.span()]);
                }
            }
            _ => {}
        }
    }
}

/// A key below a path. A key with other characters than a bare one is quoted, so that paths are unambiguous.
pub(super) fn join(path: &str, key: &str) -> String {
    let bare = !key.is_empty() && key.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'-' || b == b'_');
    let key = if bare { key.to_owned() } else { format!("{key:?}") };
    if path.is_empty() { key } else { format!("{path}.{key}") }
}
