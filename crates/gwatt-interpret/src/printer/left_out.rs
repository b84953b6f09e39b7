//! Notes on what commands of printers add to moves and is not counted.

use crate::control::Run;
use gwatt_syntax::source::Span;

/// What is known to be left out of the estimate.
pub(super) fn note_uncounted(run: &mut Run<'_, '_>, letter: u8, number: u16, span: Span) {
    match (letter, number) {
        (b'M', 9000 | 5720 | 4930) => note_advance(run, span),
        (b'M', 4250) => {
            let message =
                "what compensation of backlash adds to moves after a reversal is not counted";
            run.report.note_once("backlash", message, span);
        }
        (b'M', 4200 | 3750) => note_levelling(run, span),
        _ => {}
    }
}

pub(super) fn note_advance(run: &mut Run<'_, '_>, span: Span) {
    let message = "what pressure advance adds to the extruder's moves is not counted";
    run.report.note_once("pressure-advance", message, span);
}

pub(super) fn note_levelling(run: &mut Run<'_, '_>, span: Span) {
    let message = "what bed levelling adds to the moves of Z is not counted";
    run.report.note_once("bed-levelling", message, span);
}

pub(super) fn note_corners(run: &mut Run<'_, '_>, span: Span) {
    let message = "speeds of corners that the program sets by another rule than the machine file's \
                   are not followed: those of the machine file count, and higher ones draw more";
    run.report.note_once("corner-speeds", message, span);
}
