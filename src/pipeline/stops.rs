//! Exact stops that `limit` may put between feeds: what is said where it cannot, and when a
//! program is limited again without them.

use super::{LimitOptions, LimitSummary};
use crate::diagnostic::{Diagnostic, Severity};
use crate::machine::Machine;

/// The rule of what is said where no stop can be put.
const NO_STOP_WORD: &str = "no-stop-word";

/// Whether the stops may be why a program was not certified: blocks for which there was a
/// way exceed the limit all the same.
pub(super) fn in_the_way(summary: &LimitSummary) -> bool {
    let mut reasons = summary.reasons.iter();
    !summary.certified && reasons.any(|reason| reason.rule == "does-not-fit")
}

/// What is said where `--allow stop` can do nothing.
pub(super) fn without_word(machine: &Machine, how: LimitOptions) -> Option<Diagnostic> {
    let controller = &machine.controller;
    if !how.allowed.stop || controller.language.exact_stop_word.is_some() {
        return None;
    }
    let name = &controller.name;
    let (message, help) = if controller.planner.look_ahead.is_some() {
        let message = format!(
            "--allow stop changes nothing: the planner of `{name}` is modelled, so that its \
             feeds have no need of stops"
        );
        (message, "leave it out")
    } else {
        let message = format!(
            "--allow stop changes nothing: the controller `{name}` names no word for an exact \
             stop in one block"
        );
        let help = "where the control has one, give it as `exact_stop_word` in the controller's \
                    profile";
        (message, help)
    };
    Some(Diagnostic {
        severity: Severity::Warning,
        ..Diagnostic::error(NO_STOP_WORD, message).help(help)
    })
}
