//! Stopping from outside: one token that every long loop of the library looks at.
//!
//! Whoever starts a run makes a [`Cancel`], lends it to what is called, and sets it from another thread (a signal handler, a
//! button). There is no global state: two runs in one process stop apart from each other. Loops look at the token between
//! texels, points, rows or blocks and return [`Cancelled`]; functions that take it by name end in `_until`, and the same
//! name without that never stops.
//!
//! ```
//! use brdfbake::cancel::{Cancel, Cancelled};
//!
//! let cancel = Cancel::new();
//! assert_eq!(cancel.check(), Ok(()));
//! cancel.set();
//! assert_eq!(cancel.check(), Err(Cancelled));
//! ```

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Tells work to stop.
#[derive(Debug, Default)]
pub struct Cancel {
    set: AtomicBool,
    holds: AtomicUsize,
}

/// The work was stopped from outside; what it had so far is gone.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("interrupted")]
pub struct Cancelled;

impl Cancel {
    /// A token that is not set.
    #[must_use]
    pub const fn new() -> Cancel {
        Cancel { set: AtomicBool::new(false), holds: AtomicUsize::new(0) }
    }

    /// Asks to stop. It cannot be taken back.
    pub fn set(&self) {
        self.set.store(true, Ordering::SeqCst);
    }

    /// Was it asked to stop?
    #[must_use]
    pub fn is_set(&self) -> bool {
        self.set.load(Ordering::Relaxed)
    }

    /// The same for `?`.
    ///
    /// # Errors
    /// [`Cancelled`] once it is set.
    pub fn check(&self) -> Result<(), Cancelled> {
        if self.is_set() { Err(Cancelled) } else { Ok(()) }
    }

    /// Says that what follows must not be cut: files are being moved to their names, or temporary ones taken away. A caller
    /// that ends the process when the work does not stop waits until no hold is left ([`Cancel::is_held`]).
    #[must_use = "the hold ends when it is dropped"]
    pub fn hold(&self) -> Hold<'_> {
        self.holds.fetch_add(1, Ordering::SeqCst);
        Hold(self)
    }

    /// Is something going on that must not be cut?
    #[must_use]
    pub fn is_held(&self) -> bool {
        self.holds.load(Ordering::SeqCst) > 0
    }
}

/// As long as it lives the process is not to be ended; see [`Cancel::hold`].
#[derive(Debug)]
pub struct Hold<'a>(&'a Cancel);

impl Drop for Hold<'_> {
    fn drop(&mut self) {
        self.0.holds.fetch_sub(1, Ordering::SeqCst);
    }
}
