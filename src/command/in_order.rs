//! Work on many items at once, with results in their order.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::mpsc;
use std::thread;

use anyhow::{Context, Result};
use rayon::iter::{ParallelBridge, ParallelIterator};

/// Does `work` for all `items`, so many at once, and hands the results over in
/// the order of the items as soon as each one's turn comes.
pub fn in_order<I: Sync, O: Send>(
    items: &[I],
    at_once: usize,
    work: impl Fn(&I) -> O + Sync,
    mut each: impl FnMut(O) -> Result<()>,
) -> Result<()> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(at_once)
        .build()
        .context("cannot start threads")?;
    // Set when results are no longer wanted: the output is closed.
    let closed = AtomicBool::new(false);
    thread::scope(|scope| {
        let (sender, results) = mpsc::channel();
        let (pool, work, closed) = (&pool, &work, &closed);
        scope.spawn(move || {
            // A bridge takes the items one after another.
            pool.install(|| {
                items.iter().enumerate().par_bridge().for_each_with(
                    sender,
                    |sender, (index, item)| {
                        // Nobody listens any more: the output is closed.
                        let _ = sender.send((index, work(item)));
                    },
                );
            });
        });
        let mut early = BTreeMap::new();
        let mut next = 0;
        for (index, result) in results {
            early.insert(index, result);
            while let Some(result) = early.remove(&next) {
                if let Err(error) = each(result) {
                    closed.store(true, Relaxed);
                    return Err(error);
                }
                next += 1;
            }
        }
        Ok(())
    })
}
