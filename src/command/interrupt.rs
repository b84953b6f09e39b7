//! Temporary files with a name, and signals that end the run: the names go first.
//!
//! Signals are caught from the first such name on, or from the first progress bar on.

use std::collections::HashSet;
use std::path::PathBuf;
use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError};

/// The files that are to go.
static NAMES: LazyLock<Mutex<HashSet<PathBuf>>> = LazyLock::new(|| {
    #[cfg(unix)]
    unix::catch();
    Mutex::default()
});

fn names() -> MutexGuard<'static, HashSet<PathBuf>> {
    // A set of names is whole whatever happened.
    NAMES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What is to be done before a signal ends the run.
static BEFORE: Mutex<Option<fn()>> = Mutex::new(None);

/// Has a signal that ends the run do this first.
pub fn before_the_end(what: fn()) {
    *BEFORE.lock().unwrap_or_else(PoisonError::into_inner) = Some(what);
    LazyLock::force(&NAMES);
}

fn end() {
    let before = *BEFORE.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(before) = before {
        before();
    }
}

/// Makes, renames or removes a file, so that no signal comes between that and the
/// change of its name in the list.
pub fn guarded<T>(change: impl FnOnce(&mut HashSet<PathBuf>) -> T) -> T {
    change(&mut names())
}

#[cfg(unix)]
mod unix {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;
    use std::ffi::c_int;
    use std::{fs, thread};

    /// Ends the run as the signal would have, without what it leaves in folders.
    pub fn catch() {
        let ignored = ignored();
        let wanted = [SIGHUP, SIGINT, SIGTERM];
        let wanted = wanted.into_iter().filter(|signal| !ignored(*signal));
        // Where they cannot be caught they end the run as ever.
        let Ok(mut signals) = Signals::new(wanted) else {
            return;
        };
        let wait = move || {
            for signal in &mut signals {
                super::end();
                let names = super::names();
                for name in &*names {
                    let _ = fs::remove_file(name);
                }
                let _ = emulate_default_handler(signal);
            }
        };
        let _ = thread::Builder::new().spawn(wait);
    }

    /// Which signals are to be ignored, as of a run in the background: that remains
    /// so.
    fn ignored() -> impl Fn(c_int) -> bool {
        let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
        let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
        let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
        move |signal| mask.is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
    }
}
