//! What judges a program and watches its limits over time.

use super::Options;
use crate::machine::Machine;
use crate::power::{Assessor, Want};

/// An assessor that watches limits over time as the options ask for; at `rungs`, the
/// machine with its knobs at lower overrides, too.
pub(super) fn watching<'m>(
    machine: &'m Machine,
    rungs: &'m [Machine],
    options: &Options,
) -> Assessor<'m> {
    let one = |machine| {
        Assessor::new(machine, options.certificate, Want::ALL)
            .starting(options.reading.start)
            .watching()
            .repeating(!options.once)
    };
    one(machine).with_lower(rungs.iter().map(one).collect())
}
