//! Stopping from outside: one token that every long loop of the library looks at.
//!
//! Whoever starts a run makes a [`Cancel`], lends it to what is called, and sets it from another thread (a signal handler, a
//! button). There is no global state: two runs in one process stop apart from each other. Loops look at the token between
//! texels, points, rows or blocks. Most functions that take it then return [`Cancelled`]; those that come nearer step by step
//! return what they have, and their caller looks at the token. Where there is `name_until`, `name` is the same without a
//! token.
//!
//! ```
//! use brdfbake::cancel::{Cancel, Cancelled};
//!
//! let cancel = Cancel::new();
//! assert_eq!(cancel.check(), Ok(()));
//! cancel.set();
//! assert_eq!(cancel.check(), Err(Cancelled));
//! ```

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Tells work to stop.
#[derive(Default)]
pub struct Cancel {
    set: AtomicBool,
    holds: AtomicUsize,
    /// What is to be undone, by number, if the process is ended in the midst of the work.
    undo: Mutex<Vec<(usize, Undo)>>,
    numbers: AtomicUsize,
}

type Undo = Box<dyn FnOnce() + Send>;

/// The work was stopped from outside; what it had so far is gone.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("interrupted")]
pub struct Cancelled;

/// Takes how many steps are done, of how many. It is called from several threads, and not in order.
pub type Tell<'a> = dyn Fn(usize, usize) + Sync + 'a;

/// A [`Tell`] that nobody listens to.
pub fn untold(_: usize, _: usize) {}

/// Tells of steps that many threads take.
pub(crate) struct Steps<'a> {
    done: AtomicUsize,
    all: usize,
    tell: &'a Tell<'a>,
}

impl<'a> Steps<'a> {
    /// Tells about a hundred times.
    pub(crate) fn new(all: usize, tell: &'a Tell<'a>) -> Steps<'a> {
        tell(0, all);
        Steps { done: AtomicUsize::new(0), all, tell }
    }

    /// One more is done.
    pub(crate) fn step(&self) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        if done == self.all || done.is_multiple_of(self.all.div_ceil(100).max(1)) {
            (self.tell)(done, self.all);
        }
    }
}

impl std::fmt::Debug for Cancel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Cancel")
            .field("set", &self.is_set())
            .field("held", &self.is_held())
            .finish_non_exhaustive()
    }
}

impl Cancel {
    /// A token that is not set.
    #[must_use]
    pub const fn new() -> Cancel {
        let (set, holds, numbers) = (AtomicBool::new(false), AtomicUsize::new(0), AtomicUsize::new(0));
        Cancel { set, holds, undo: Mutex::new(Vec::new()), numbers }
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

    /// Leaves word of what is to be undone if the process is ended in the midst of the work, where nothing is dropped:
    /// temporary folders are to be removed. Until the result is dropped.
    #[must_use = "the word is forgotten when it is dropped"]
    pub fn at_end(&self, undo: impl FnOnce() + Send + 'static) -> AtEnd<'_> {
        let number = self.numbers.fetch_add(1, Ordering::Relaxed);
        self.words(|all| all.push((number, Box::new(undo))));
        AtEnd { cancel: self, number }
    }

    /// Undoes what word was left of, the last first. For a caller that then ends the process.
    pub fn end(&self) {
        let mut all = Vec::new();
        self.words(|words| all.append(words));
        all.into_iter().rev().for_each(|(_, undo)| undo());
    }

    fn words(&self, f: impl FnOnce(&mut Vec<(usize, Undo)>)) {
        f(&mut self.undo.lock().unwrap_or_else(std::sync::PoisonError::into_inner));
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

/// As long as it lives something is to be undone if the process is ended; see [`Cancel::at_end`].
#[derive(Debug)]
pub struct AtEnd<'a> {
    cancel: &'a Cancel,
    number: usize,
}

impl Drop for AtEnd<'_> {
    fn drop(&mut self) {
        self.cancel.words(|all| all.retain(|(number, _)| *number != self.number));
    }
}
