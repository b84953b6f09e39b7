//! How far a run over programs is: lines that were executed, and how many one pass has.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// Counts lines as they are executed, those of calls and loops each time; copies count
/// together.
#[derive(Debug, Clone, Default)]
pub struct LineCount(Arc<Counts>);

#[derive(Debug, Default)]
struct Counts {
    done: AtomicU64,
    pass: AtomicU64,
}

impl LineCount {
    /// Lines in a row that are counted at once.
    pub(super) const AT_ONCE: u64 = 64;

    /// Lines so far.
    #[must_use]
    pub fn done(&self) -> u64 {
        self.0.done.load(Relaxed)
    }

    /// How many one pass over all programs has; 0 as long as that is not known.
    #[must_use]
    pub fn in_a_pass(&self) -> u64 {
        self.0.pass.load(Relaxed)
    }

    pub(super) fn add(&self, lines: u64) {
        self.0.done.fetch_add(lines, Relaxed);
    }

    /// The first pass begins: what was counted before is forgotten.
    pub(super) fn begin(&self) {
        self.0.pass.store(0, Relaxed);
        self.0.done.store(0, Relaxed);
    }

    /// The first pass is over: the others have as many lines.
    pub(super) fn first_pass_ends(&self) {
        self.0.pass.store(self.done(), Relaxed);
    }
}

/// The same if they count together.
impl PartialEq for LineCount {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}
