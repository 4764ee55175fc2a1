//! How near a search for a size came that found none, and what may help.

/// How near a search came that found nothing.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum Reached {
    /// Nothing was tried.
    #[default]
    Nothing,
    /// Some axis alone leaves too much, however the others are read: the least of that.
    Alone {
        /// The axis.
        axis: &'static str,
        /// Its length.
        len: usize,
        /// What it leaves.
        error: f64,
    },
    /// The least error of all tables that were tried.
    Trial(f64),
}

impl Reached {
    /// The nearer of two searches.
    pub(super) fn nearer(self, other: Reached) -> Reached {
        match (self, other) {
            (Reached::Trial(a), Reached::Trial(b)) => Reached::Trial(a.min(b)),
            (Reached::Trial(_), _) | (Reached::Alone { .. }, Reached::Nothing) => self,
            (Reached::Alone { error: a, .. }, Reached::Alone { error: b, .. }) if a <= b => self,
            _ => other,
        }
    }

    pub(super) fn trial(&mut self, error: f64) {
        *self = self.nearer(Reached::Trial(error));
    }

    pub(super) fn only(&mut self, axis: &'static str, len: usize, error: f64) {
        *self = self.nearer(Reached::Alone { axis, len, error });
    }
}

impl std::fmt::Display for Reached {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Reached::Nothing => f.write_str("no length was tried"),
            Reached::Alone { axis, len, error } => {
                write!(f, "axis {axis} alone leaves {error:.1e} at {len} texels")
            }
            Reached::Trial(error) => write!(f, "the best reached {error:.1e}"),
        }
    }
}

/// What may help, of what is not asked for already.
pub(super) fn remedy(searched: bool, longer: bool) -> String {
    let mut all = vec!["ask for a larger error"];
    if longer {
        all.push("allow a larger `longest`");
    }
    if !searched {
        all.push("allow `warps = \"search\"`");
    }
    all.extend(["store it in more bits", "move an axis off the corner where it bends"]);
    let last = all.pop().unwrap_or_default();
    format!("{}, or {last}", all.join(", "))
}

#[cfg(test)]
mod tests {
    use super::{Reached, remedy};

    #[test]
    fn what_came_nearest_is_told_and_no_advice_is_what_is_set_already() {
        let mut reached = Reached::default();
        assert_eq!(reached.to_string(), "no length was tried");
        reached.only("mu", 8, 0.25);
        reached.only("mu", 8, 0.5);
        assert_eq!(reached.to_string(), "axis mu alone leaves 2.5e-1 at 8 texels");
        reached.trial(0.75);
        reached.only("mu", 8, 0.125);
        reached.trial(0.5);
        assert_eq!(reached.to_string(), "the best reached 5.0e-1");
        assert!(remedy(false, true).contains("search") && remedy(false, true).contains("`longest`"));
        let all_set = remedy(true, false);
        assert!(!all_set.contains("search") && !all_set.contains("longest"), "{all_set}");
        assert!(
            all_set.starts_with("ask for a larger error, ") && all_set.contains(", or move an axis"),
            "{all_set}"
        );
    }
}
