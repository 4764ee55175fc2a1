//! Readers and writers of other libraries, stopped from outside: they ask for bytes, or hand them over, piece by piece.

use crate::cancel::Cancel;
use std::io::{self, BufRead, Read, Seek, SeekFrom, Write};

/// What is read or written until a token is set; then every call is an error.
#[derive(Debug)]
pub(super) struct Stoppable<'a, T> {
    inner: T,
    cancel: &'a Cancel,
}

impl<'a, T> Stoppable<'a, T> {
    pub(super) const fn new(inner: T, cancel: &'a Cancel) -> Stoppable<'a, T> {
        Stoppable { inner, cancel }
    }

    pub(super) fn into_inner(self) -> T {
        self.inner
    }

    fn check(&self) -> io::Result<()> {
        // not `Interrupted`: that one is tried again
        self.cancel.check().map_err(io::Error::other)
    }
}

impl<T: Read> Read for Stoppable<'_, T> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.check()?;
        self.inner.read(buffer)
    }
}

impl<T: BufRead> BufRead for Stoppable<'_, T> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        self.check()?;
        self.inner.fill_buf()
    }

    fn consume(&mut self, amount: usize) {
        self.inner.consume(amount);
    }
}

impl<T: Write> Write for Stoppable<'_, T> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.check()?;
        self.inner.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}

impl<T: Seek> Seek for Stoppable<'_, T> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.inner.seek(to)
    }
}
