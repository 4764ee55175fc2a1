//! Values that the texels of a row share, computed once: averages over the view, which do not depend on it.
//!
//! A value is a pure function of its key, so it does not matter which thread computes it.

use super::TexelError;
use crate::models::{Params, Value};
use std::collections::BTreeMap;
use std::sync::Mutex;

/// Values by model parameters and tolerance.
#[derive(Debug)]
pub(super) struct Memo<T> {
    known: Mutex<BTreeMap<Vec<u64>, T>>,
}

/// Most values that are kept; a table has far fewer rows.
const KEPT: usize = 1 << 16;

impl<T: Clone> Memo<T> {
    pub(super) fn new() -> Memo<T> {
        Memo { known: Mutex::new(BTreeMap::new()) }
    }

    /// The value for the numbers among the parameters (words do not change within a table) and a tolerance.
    ///
    /// # Errors
    /// Those of `compute`.
    pub(super) fn get(
        &self,
        params: &Params,
        tolerance: f64,
        compute: impl FnOnce() -> Result<T, TexelError>,
    ) -> Result<T, TexelError> {
        let number = |v: &Value| if let Value::Number(n) = v { Some(n.to_bits()) } else { None };
        let key: Vec<u64> =
            params.values().iter().filter_map(|(_, v)| number(v)).chain([tolerance.to_bits()]).collect();
        let lock = || self.known.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if let Some(value) = lock().get(&key) {
            return Ok(value.clone());
        }
        // without the lock: two threads may compute the same value, with the same bits
        let value = compute()?;
        let mut known = lock();
        if known.len() >= KEPT {
            known.clear();
        }
        known.insert(key, value.clone());
        Ok(value)
    }
}
