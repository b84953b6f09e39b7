//! What limiting a program comes to.

use super::certify::{Certified, DOES_NOT_FIT, Reasons};
use super::conditions::conditions;
use super::over_time::OverTime;
use super::writer::Written;
use super::{LimitOptions, LimitSummary, Options, Summary};
use crate::diagnostic::{Diagnostic, Severity};
use crate::machine::{ALL_AXES, Machine, RapidPath};

/// The figures of both programs and the reasons of both halves as one.
pub(super) fn conclude(
    machine: &Machine,
    target: &Machine,
    paths: &[Options],
    how: LimitOptions,
    written: Written,
    certified: Certified,
) -> LimitSummary {
    let Written {
        mut before,
        edited_lines,
        mut reasons,
        may_skip,
        places: _,
        pauses,
    } = written;
    let Certified {
        summary: mut after,
        reasons: found,
        deeper: _,
        paced: _,
    } = certified;
    let lowered_enough = found.count == 0 && reasons.only_power() && after.fits();
    if target != machine || lowered_enough {
        // What cannot reach the lower limit keeps the machine's own, or else the
        // figures show it; and the moves next to one may have been lowered enough for it.
        reasons = Reasons::default();
    }
    reasons.extend(found);
    let help = if reasons.list.iter().any(|it| it.rule != DOES_NOT_FIT) {
        NEXT_TO_OTHERS
    } else {
        how.allowed.else_helps(has_other_words(machine))
    };
    let unfit = reasons.list.iter_mut().filter(|it| it.rule == DOES_NOT_FIT);
    unfit.for_each(|reason| reason.help = Some(help.to_owned()));
    let missed = after.over_time.iter().filter(|it| !it.rating.fits());
    for reason in missed.map(OverTime::reason) {
        reasons.count += 1;
        reasons.list.push(reason);
    }
    let slower = reasons.only_power();
    reasons
        .list
        .sort_by(|a, b| (&a.file, a.line).cmp(&(&b.file, b.line)));
    reasons.list.truncate(Summary::KEPT);
    for summary in [&mut before, &mut after] {
        summary.conditions = conditions(machine, paths, summary);
    }
    if before
        .notes
        .iter()
        .any(|note| note.rule == "no-motion-word")
    {
        let taken = "blocks before the first motion word are taken for rapids (G0)";
        after.conditions.push(taken.to_owned());
    }
    if let Some(comment) = paths.first().and_then(|it| it.comment(machine)) {
        let text = comment.text();
        let taken = format!("feeds with the comment {text} stand for rapids: F may be lowered");
        after.conditions.push(taken);
    }
    let rooms = machine.path.clearance_mm.iter().zip(ALL_AXES);
    let rooms: Vec<String> = rooms
        .filter_map(|(room, axis)| Some(format!("{} {}", char::from(axis.letter()), (*room)?)))
        .collect();
    let each_for_itself = machine.path.rapid == RapidPath::Independent;
    if how.allowed.straighten && each_for_itself && !rooms.is_empty() {
        after.conditions.push(format!(
            "rapids of several axes may run along lines beyond the clearance ({}, machine \
             coordinates)",
            rooms.join(", ")
        ));
    }
    let certified = reasons.count == 0 && after.fits();
    LimitSummary {
        before,
        after,
        edited_lines,
        may_skip,
        pauses,
        certified,
        slower,
        reasons: reasons.list,
        prices: Vec::new(),
        ideal: None,
    }
}

/// What helps where other blocks stay as they are.
const NEXT_TO_OTHERS: &str =
    "blocks next to it may be what draws this much: mend those named for other reasons first";

/// Whether there are words for accelerations, which other strategies write.
pub(super) fn has_other_words(machine: &Machine) -> bool {
    let controller = &machine.controller;
    !controller.knobs.is_empty() || !controller.wired.is_empty()
}

/// That something is right only as the switches of block delete are set.
pub(super) fn holds_one_way(found: Diagnostic) -> Diagnostic {
    let message = format!(
        "this holds only for the blocks with / that are skipped or executed as --block-delete \
         says; otherwise {}",
        found.message
    );
    Diagnostic {
        severity: Severity::Warning,
        rule: "holds-one-way",
        message,
        help: None,
        ..found
    }
}
