//! Which G words grbl 1.1 itself has; grblHAL and FluidNC have more.

use super::report::Report;
use gwatt_syntax::source::Span;

/// Whether grbl 1.1 itself has a G word (number × 10; `gcode.c`, step 2).
fn has_word(number: u16) -> bool {
    let plain = number.is_multiple_of(10);
    match number / 10 {
        0..=4 | 10 | 17..=21 | 40 | 49 | 53..=59 | 61 | 80 | 90 | 93 | 94 if plain => true,
        28 | 30 | 92 => plain || number % 10 == 1,
        91 => plain || number == 911,
        38 => (382..=385).contains(&number),
        _ => number == 431,
    }
}

/// Notes a G word that only grblHAL and FluidNC read.
pub(super) fn note_word(number: u16, span: Span, report: &mut Report<'_, '_>) {
    if !has_word(number) {
        let message = "grbl 1.1 does not have this word: it reports error 20 and leaves the line out; \
                       the line counts as grblHAL or FluidNC reads it";
        report.note_once("grbl-word", message, span);
    }
}
