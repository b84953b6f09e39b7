//! Which G words grbl 1.1 itself has; grblHAL and FluidNC have more.

use super::report::Report;
use gwatt_syntax::source::Span;

/// Whether grbl 1.1 itself has a G word (number × 10; `gcode.c`, step 2).
fn has_word(number: u16) -> bool {
    let plain = number.is_multiple_of(10);
    match number / 10 {
        0..=4 | 10 | 17..=21 | 40 | 49 | 53..=59 | 61 | 80 | 90 | 93 | 94 if plain => true,
        28 | 30 | 91 | 92 => plain || number % 10 == 1,
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

#[cfg(test)]
mod tests {
    use super::has_word;

    #[test]
    fn words_of_grbl_and_others() {
        for own in [
            0, 20, 40, 100, 190, 210, 281, 301, 382, 385, 400, 431, 490, 530, 590, 610, 800, 911,
            921, 930, 940,
        ] {
            assert!(has_word(own), "{own}");
        }
        for other in [
            70, 80, 330, 381, 386, 410, 430, 591, 611, 640, 810, 901, 922, 923, 950, 970,
        ] {
            assert!(!has_word(other), "{other}");
        }
    }
}
