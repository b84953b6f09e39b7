//! What judges a program and watches its limits over time.

use super::Options;
use crate::machine::Machine;
use crate::power::{Assessor, Lower, Want};

/// An assessor that watches limits over time as the options ask for.
pub(super) fn watching<'m>(machine: &'m Machine, options: &Options) -> Assessor<'m> {
    Assessor::new(machine, options.certificate, Want::ALL)
        .starting(options.reading.start)
        .watching()
        .repeating(!options.once)
}

/// The same that watches the machine with its knobs as in `rungs` as well.
pub(super) fn watching_at<'m>(
    machine: &'m Machine,
    rungs: &'m Lower,
    options: &Options,
) -> Assessor<'m> {
    let lower = rungs.machines.iter().map(|rung| watching(rung, options));
    watching(machine, options).with_lower(lower.collect(), rungs)
}
