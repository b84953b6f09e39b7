//! Work without Python's lock, which Ctrl-C ends.

use std::io::{self, Cursor, Read, Seek, SeekFrom};
use std::panic;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, Thread};
use std::time::Duration;

use pyo3::prelude::*;

use crate::error;

/// How often signals are looked at.
const SIGNALS: Duration = Duration::from_millis(50);
/// As much as a main thread has.
const STACK_BYTES: usize = 8 << 20;

/// Whether the caller no longer waits: reading and writing fail then, which ends the work.
#[derive(Debug, Clone, Copy)]
pub struct Stop<'a>(&'a AtomicBool);

impl Stop<'_> {
    /// An error as soon as nobody waits.
    pub fn check(self) -> io::Result<()> {
        if self.0.load(Ordering::Relaxed) {
            return Err(io::Error::other("interrupted"));
        }
        Ok(())
    }
}

/// A program whose reading ends when nobody waits.
#[derive(Debug)]
pub struct Reader<'a> {
    text: Cursor<&'a [u8]>,
    stop: Stop<'a>,
}

impl<'a> Reader<'a> {
    pub fn new(text: &'a [u8], stop: Stop<'a>) -> Self {
        let text = Cursor::new(text);
        Self { text, stop }
    }
}

impl Read for Reader<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.stop.check()?;
        self.text.read(buffer)
    }
}

impl Seek for Reader<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.stop.check()?;
        self.text.seek(to)
    }
}

/// Wakes the caller when the work is done, and when it panics.
struct Done<'a>(&'a AtomicBool, Thread);

impl Drop for Done<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Release);
        self.1.unpark();
    }
}

/// Has a thread do `work`, while other threads of Python run and signals are looked at.
///
/// # Errors
/// Those of the work as exceptions, and what a handler of a signal raises.
pub fn run<T: Send>(
    py: Python<'_>,
    work: impl FnOnce(Stop<'_>) -> Result<T, gwatt_core::Error> + Send,
) -> PyResult<T> {
    let (stop, done) = (AtomicBool::new(false), AtomicBool::new(false));
    let caller = thread::current();
    let outcome = thread::scope(|scope| {
        let worker = thread::Builder::new()
            .stack_size(STACK_BYTES)
            .spawn_scoped(scope, || {
                let _done = Done(&done, caller);
                work(Stop(&stop))
            })?;
        while !done.load(Ordering::Acquire) {
            py.detach(|| thread::park_timeout(SIGNALS));
            if let Err(raised) = py.check_signals() {
                stop.store(true, Ordering::Relaxed);
                // What it comes to is no longer of interest.
                let _ = py.detach(|| worker.join());
                return Err(raised);
            }
        }
        match worker.join() {
            Ok(outcome) => Ok(outcome),
            Err(payload) => panic::resume_unwind(payload),
        }
    })?;
    outcome.map_err(|error| error::raise(py, error))
}
