//! Where each key and value of a file lies, by path: `table[0].axis[1].warp`.

use crate::plan::{Part, Path, Place};
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
    at: HashMap<Path, [Range<usize>; 2]>,
}

impl Spans {
    pub(super) fn of(root: &Spanned<DeTable<'_>>) -> Spans {
        let mut spans = Spans { at: HashMap::new() };
        spans.table(&Path::root(), root.get_ref(), 0);
        spans
    }

    /// The range of a place; that of the nearest section around it if the place itself is not in the file.
    pub(super) fn find(&self, place: &Place) -> Range<usize> {
        let mut path = place.path.clone();
        let mut wants_key = place.part == Part::Key;
        loop {
            if let Some([key, value]) = self.at.get(&path) {
                return if wants_key { key.clone() } else { value.clone() };
            }
            match path.parent() {
                Some(parent) => path = parent,
                None => return 0..0,
            }
            wants_key = false;
        }
    }

    fn table(&mut self, path: &Path, table: &DeTable<'_>, depth: usize) {
        for (key, value) in table {
            let path = path.key(key.get_ref());
            self.value(&path, value, depth);
            self.at.insert(path, [key.span(), value.span()]);
        }
    }

    fn value(&mut self, path: &Path, value: &Spanned<DeValue<'_>>, depth: usize) {
        if depth >= DEEPEST {
            return;
        }
        match value.get_ref() {
            DeValue::Table(table) => self.table(path, table, depth + 1),
            DeValue::Array(list) => {
                for (i, item) in list.iter().enumerate() {
                    let path = path.index(i);
                    self.value(&path, item, depth + 1);
                    self.at.insert(path, [item.span(), item.span()]);
                }
            }
            _ => {}
        }
    }
}
