//! Which of the controller's words a program gets, where those that may be used are not always
//! of use: without them it is tried too.

use super::strategy::trusting;
use super::{Failure, LimitOptions, LimitSummary};
use crate::diagnostic::Diagnostic;
use crate::limit::Allowed;
use crate::machine::{KnobTarget, Machine};

/// Limits a program for a machine, from its beginning.
type Run<'a> = &'a mut dyn FnMut(&Machine, LimitOptions) -> Result<LimitSummary, Failure>;

/// The program with the words that no document confirms, where they are permitted, and where
/// it fits with them; else the one without. `chooses`: false where one round is enough.
pub(super) fn with_words(
    machine: &Machine,
    how: LimitOptions,
    chooses: bool,
    run: Run<'_>,
) -> Result<LimitSummary, Failure> {
    let Some((trusting, note)) = trusting(machine, how) else {
        return with_share(machine, how, chooses, run);
    };
    let mut summary = with_share(&trusting, how, chooses, run)?;
    if !summary.certified && chooses {
        let allowed = Allowed {
            unverified: false,
            ..how.allowed
        };
        let without = with_share(machine, LimitOptions { allowed, ..how }, chooses, run);
        // A strategy may need these words.
        let without = match without {
            Err(Failure::Unsuitable(_)) => None,
            found => Some(found?).filter(|it| it.certified),
        };
        if let Some(mut without) = without {
            let message = "--allow unverified: the program fits without the words that it permits, \
                           and was not found to fit with them: they are not written";
            let note = Diagnostic::note("unverified", message.to_owned());
            without.before.notes.push(note);
            return Ok(without);
        }
        summary = with_share(&trusting, how, chooses, run)?;
    }
    summary.before.notes.push(note);
    Ok(summary)
}

/// The program with the output that holds the speed of moves to a share while they run, which
/// leaves rapids what they are; or else, where only that one fits, the one without.
fn with_share(
    machine: &Machine,
    how: LimitOptions,
    chooses: bool,
    run: Run<'_>,
) -> Result<LimitSummary, Failure> {
    let first = run(machine, how)?;
    let tries = chooses && !first.certified;
    let Some(without) = without_share(machine).filter(|_| tries) else {
        return Ok(first);
    };
    let second = run(&without, how)?;
    if second.certified {
        return Ok(second);
    }
    run(machine, how)
}

/// The machine for which that output is not written; `None` where it has none.
fn without_share(machine: &Machine) -> Option<Machine> {
    let mut without = machine.clone();
    let mut found = false;
    for knob in &mut without.controller.knobs {
        if knob.verified && knob.target == KnobTarget::SpeedShare && knob.output().is_some() {
            knob.verified = false;
            found = true;
        }
    }
    found.then_some(without)
}
