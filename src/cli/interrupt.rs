//! Signals. The first one asks the work to stop, and gives it [`GRACE`]; then the process is ended, wherever it is: in a
//! system call that blocks, or in a library that does not look at the token. Only what must not be cut is waited for
//! ([`Cancel::is_held`]): files on their way to their names. A second signal ends the process at once.

use super::{Exit, output};
use crate::cancel::{AtEnd, Cancel};
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, mpsc};
use std::time::Duration;

/// What work has to stop by itself. The promise is a second; the rest is for a machine that is busy.
const GRACE: Duration = Duration::from_millis(600);

/// How long a line on stderr may take, where nobody may be reading.
const LAST_WORDS: Duration = Duration::from_millis(100);

/// Was the user told that the run was interrupted?
static TOLD: AtomicBool = AtomicBool::new(false);

/// True for whoever is the first to tell of the interrupt.
pub(super) fn is_first_to_tell() -> bool {
    !TOLD.swap(true, Ordering::SeqCst)
}

/// Sets the token on SIGINT, SIGTERM and SIGHUP (Ctrl-C and Ctrl-Break on Windows), and ends what does not stop.
pub(super) fn install(cancel: &Arc<Cancel>) {
    let cancel = Arc::clone(cancel);
    let count = AtomicUsize::new(0);
    // Where no handler can be set, signals end the process as they always did.
    let _ = ctrlc::set_handler(move || {
        if count.fetch_add(1, Ordering::SeqCst) > 0 {
            end(&cancel, "interrupted again: ended at once");
        }
        cancel.set();
        let cancel = Arc::clone(&cancel);
        // a thread of its own, so that the second signal is heard
        std::thread::spawn(move || {
            std::thread::sleep(GRACE);
            while cancel.is_held() {
                std::thread::sleep(Duration::from_millis(10));
            }
            end(&cancel, "interrupted");
        });
    });
}

/// A temporary folder that is removed when it is dropped, and when the process is ended by a signal.
pub(super) struct Scratch<'a> {
    folder: tempfile::TempDir,
    _word: AtEnd<'a>,
}

impl Scratch<'_> {
    /// Makes one.
    pub(super) fn new(cancel: &Cancel) -> std::io::Result<Scratch<'_>> {
        let folder = tempfile::tempdir()?;
        let path = folder.path().to_owned();
        let word = cancel.at_end(move || {
            // what cannot be removed is in the system's folder for such things
            let _ = std::fs::remove_dir_all(path);
        });
        Ok(Scratch { folder, _word: word })
    }

    /// Where it is.
    pub(super) fn path(&self) -> &Path {
        self.folder.path()
    }
}

/// Ends the process with [`Exit::Interrupted`], after a line if somebody reads it.
fn end(cancel: &Cancel, why: &'static str) -> ! {
    cancel.end();
    if is_first_to_tell() {
        let (done, told) = mpsc::channel();
        std::thread::spawn(move || {
            output::talk(why);
            let _ = done.send(());
        });
        let _ = told.recv_timeout(LAST_WORDS);
    }
    std::process::exit(Exit::Interrupted as i32)
}
