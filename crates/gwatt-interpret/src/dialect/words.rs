//! Words of Fanuc, Haas and their relatives, as blocks have them.

use super::{INCREMENTAL, LEAST_DEG, LEAST_INCH, LEAST_MM, LENGTHS, NO_POINT, has_point};
use crate::code::{GCode, Motion};
use crate::compensation::Insert;
use crate::control::{Control, Run};
use crate::letters::{AXIS_LETTERS, bit};
use crate::places::EXTRUDER;
use crate::report::Report;
use gwatt_machine::units::MM_PER_INCH;
use gwatt_machine::{Dialect, Lathe, Point};
use gwatt_syntax::Word;
use gwatt_syntax::source::Span;

/// P of G5 that chooses how blocks are read, and moves nothing (Fanuc B-63014EN, "High-Speed
/// Machining", "High-Speed Cycle Machining": P10001 to P10999 run stored data; Mitsubishi,
/// "High-speed Machining Mode": P1 and P2).
const MODES_OF_G5: [f64; 4] = [0.0, 1.0, 2.0, 10_000.0];

impl Control<'_> {
    pub(crate) fn dialect(&self) -> &Dialect {
        &self.machine.controller.language.dialect
    }

    /// The second look at the words of a block: incremental words become those
    /// of their axes, and numbers without a point get their meaning.
    #[cold]
    pub(crate) fn adapt_words(&mut self, run: &mut Run<'_, '_>) {
        let groups = run.words.groups;
        run.words.incremental = 0;
        self.position.points.begin_block();
        if groups & (GCode::Dwell.group() | GCode::MacroCall.group()) != 0 {
            return;
        }
        if let Some(point) = self.dialect().point
            && self.points(point, run)
        {
            let in_cycle = self.special.active != 0;
            self.position.points.begin(in_cycle);
        }
        if self.dialect().lathe == Some(Lathe::A) {
            self.incremental_words(run);
        }
        self.follow_points(run);
    }

    /// Words of system A that are incremental become those of their axes.
    fn incremental_words(&self, run: &mut Run<'_, '_>) {
        let groups = run.words.groups;
        for (letter, axis) in INCREMENTAL {
            if !run.words.has(letter)
                || letter == b'H' && self.machine.axes[5].is_none()
                || letter == b'U' && self.machine.axes[0].is_none()
            {
                continue;
            }
            let span = run.words.span(letter, run.block);
            if run.words.has(axis) {
                let [letter, axis] = [letter as char, axis as char];
                run.report
                    .error(
                        "word-twice",
                        format!("{axis} and {letter} in one block are words of the same axis"),
                        span,
                    )
                    .help(format!(
                        "{letter} is the incremental word of {axis}: keep one"
                    ));
                continue;
            }
            if groups & GCode::MachineCoordinates.group() != 0 {
                let message = format!("{} is incremental, and G53 takes places", letter as char);
                run.report
                    .error("incremental-in-g53", message, span)
                    .help("write X, Y, Z or C");
            }
            run.words.rename(letter, axis);
            run.words.incremental |= bit(axis);
        }
    }

    /// Numbers without a point: least increments, or a note. F is taken as it
    /// is written, which is never less than it means. Whether there is one that keeps its value.
    fn points(&self, point: Point, run: &mut Run<'_, '_>) -> bool {
        let inch = run.words.g.iter().find_map(|(code, ..)| match code {
            GCode::Units { mm_per_unit } => Some(*mm_per_unit == MM_PER_INCH),
            _ => None,
        });
        let inch = inch.unwrap_or(self.modal.mm_per_unit == MM_PER_INCH);
        let mut codes = run.words.g.iter();
        let ignored = !run.words.g.is_empty() && codes.all(|(code, ..)| *code == GCode::Ignored);
        if ignored && !run.words.axes().any(|(axis, _)| axis != EXTRUDER) {
            // R of G05.1 Q1 R5 is a level.
            return false;
        }
        for word in &run.block.words {
            if !LENGTHS.contains(&word.letter)
                || self.counts(word.letter, run)
                || word.value == 0.0
                || has_point(word.number.of(run.report.text))
            {
                continue;
            }
            if point == Point::Calculator {
                self.note_no_point(word.span, &mut run.report);
                return true;
            }
            let least = match word.letter {
                b'A' | b'B' | b'C' => LEAST_DEG,
                _ if inch => LEAST_INCH,
                _ => LEAST_MM,
            };
            run.words.scale(word.letter, least);
        }
        false
    }

    /// Whether a word that is a length elsewhere is a count or an angle in this block.
    pub(super) fn counts(&self, letter: u8, run: &Run<'_, '_>) -> bool {
        let mut codes = run.words.g.iter();
        match letter {
            b'A' | b'R' => {
                let turns = codes.any(|(code, ..)| matches!(code, GCode::Turning(_)));
                turns && (letter == b'A' || self.dialect().point == Some(Point::Calculator))
            }
            // K of a drilling cycle says how often, unless its shift has that direction.
            b'K' if self.dialect().lathe.is_none() => {
                let begins = codes.find_map(|(code, ..)| match code {
                    GCode::Motion(Motion::Special(number)) => Some(*number),
                    _ => None,
                });
                let number = begins.unwrap_or(self.special.active);
                number != 0 && !(matches!(number, 760 | 870) && self.modal.plane[2] != 2)
            }
            _ => false,
        }
    }

    /// Says once what numbers without a point are taken for, where the machine file does not.
    fn note_no_point(&self, span: Span, report: &mut Report<'_, '_>) {
        if self.dialect().point_is_known {
            return;
        }
        let message = "numbers without a decimal point are taken as whole millimetres, inches or \
                       degrees; where the control takes them for least increments (Fanuc: \
                       parameter 3401 bit DPI = 0), write decimal_point = \"least-increment\" under \
                       [language] in the machine file, else \"calculator\"";
        report.note_once(NO_POINT, message, span);
    }

    /// Q of a milling cycle, in units of the program. Of a peck, `depth` is that of the hole:
    /// one that is deeper in whole units counts least increments, which makes more pecks.
    pub(crate) fn cycle_q(&self, depth: Option<f64>, run: &mut Run<'_, '_>) -> Option<f64> {
        let word = run.words.word(b'Q', run.block)?;
        let value = run.words.take(b'Q')?;
        let point = self.dialect().point;
        let (Some(point), false) = (point, has_point(word.number.of(run.report.text))) else {
            return Some(value);
        };
        let inch = self.modal.mm_per_unit == MM_PER_INCH;
        let fine = value * if inch { LEAST_INCH } else { LEAST_MM };
        if point == Point::LeastIncrement {
            return Some(fine);
        }
        if value == 0.0 {
            return Some(value);
        }
        self.note_no_point(word.span, &mut run.report);
        let too_deep = !self.dialect().point_is_known
            && depth.is_some_and(|depth| value.abs() > depth && fine.abs() < depth);
        Some(if too_deep { fine } else { value })
    }

    /// A depth or a step, mm: without a point its number counts least
    /// increments on every control (Fanuc: "decimal point input is not allowed").
    pub(crate) fn fine_length(&self, letter: u8, run: &mut Run<'_, '_>) -> Option<f64> {
        let word = run.words.word(letter, run.block)?;
        run.words.take(letter)?;
        // The word itself: it may have been scaled already.
        let unit = self.modal.mm_per_unit;
        let least = if has_point(word.number.of(run.report.text)) {
            1.0
        } else if unit == MM_PER_INCH {
            LEAST_INCH
        } else {
            LEAST_MM
        };
        Some(word.value * least * unit)
    }

    /// Notes a length that has no point, which is not scaled; whether it is one.
    fn note_point(&self, word: &Word, report: &mut Report<'_, '_>) -> bool {
        let pointless = self.dialect().point == Some(Point::Calculator)
            && word.value != 0.0
            && !has_point(word.number.of(report.text));
        if pointless {
            self.note_no_point(word.span, report);
        }
        pointless
    }

    /// `,C` or `,R` of the present block.
    pub(crate) fn fanuc_corner(&mut self, word: &Word, report: &mut Report<'_, '_>) {
        self.note_point(word, report);
        let text = report.text;
        let least =
            self.dialect().point == Some(Point::LeastIncrement) && !has_point(word.number.of(text));
        let scale = match least {
            false => 1.0,
            true if self.modal.mm_per_unit == MM_PER_INCH => LEAST_INCH,
            true => LEAST_MM,
        };
        let length_mm = word.value * scale * self.modal.mm_per_unit;
        if length_mm > 0.0 {
            self.ask_corner(if word.letter == b'C' {
                Insert::Legs(length_mm)
            } else {
                Insert::Round {
                    radius_mm: length_mm,
                    modal: false,
                }
            });
        }
    }

    /// The value of an argument of a macro call (B-63944EN, "Macro Call": the
    /// decimal places of each address).
    pub(crate) fn argument(&mut self, word: &Word, report: &mut Report<'_, '_>) -> f64 {
        let length = LENGTHS.contains(&word.letter) || word.letter == b'Q';
        if length && self.note_point(word, report) {
            self.position.points.give_argument();
        }
        let scaled = self.dialect().point == Some(Point::LeastIncrement)
            && length
            && !has_point(word.number.of(report.text));
        let inch = self.modal.mm_per_unit == MM_PER_INCH;
        match word.letter {
            _ if !scaled => word.value,
            b'A' | b'B' | b'C' => word.value * LEAST_DEG,
            _ if inch => word.value * LEAST_INCH,
            _ => word.value * LEAST_MM,
        }
    }

    /// A length that is no position, mm.
    pub(crate) fn plain_length(&self, letter: u8, run: &mut Run<'_, '_>) -> Option<f64> {
        Some(run.words.take(letter)? * self.modal.mm_per_unit)
    }

    /// The words of a code that changes no motion, as in `G05.1 Q1 R5` or
    /// `G187 P3 E0.01`, where nothing else in the block could use them.
    pub(crate) fn arguments_of_ignored(&self, number: u16, run: &mut Run<'_, '_>) {
        if !self.dialect().active {
            return;
        }
        let span = run.whole();
        if number == 1870 && run.words.has(b'P') {
            let message = "G187 P1 lets a Haas accelerate harder than P2 and P3: the \
                           accelerations of the machine file have to be those of the \
                           smoothness that the program selects, or each level's stands under \
                           [[levels]]";
            run.report.note_once("smoothness", message, span);
        }
        let p = run.words.word(b'P', run.block).map(|word| word.value);
        if number == 50 && p.is_some_and(|p| !MODES_OF_G5.contains(&p)) {
            let at = run.words.span(b'P', run.block);
            let message = "G5 with this P runs a high-speed cycle that the control keeps, which \
                           moves axes in ways that the program does not say";
            run.report
                .error("unsupported-code", message, at)
                .help("write the moves out; G5 P0, P1, P2 and P10000 are modes");
        }
        let on = |letter| run.words.word(letter, run.block).map(|word| word.value) == Some(1.0);
        if number == 51 && on(b'Q') || number == 80 && on(b'P') {
            let message = "G5.1 Q1 and G8 P1 may give the axes other accelerations: those of the \
                           machine file have to be the highest that the program selects, or each \
                           word's stand under [[levels]]";
            run.report.note_once("control-mode", message, span);
        }
        let alone = run.words.groups & !GCode::Ignored.group() == 0;
        if matches!(number, 51 | 220) {
            // G5.1 Q2 X0 Y0 Z0, G22 X Y Z I J K: axes that it concerns.
            run.words.unused = 0;
        } else if alone && !run.words.axes().any(|(axis, _)| axis != EXTRUDER) {
            run.words.unused &= AXIS_LETTERS & !bit(b'E');
        }
    }

    /// Whether an M word (number × 10) that is not known is taken to move no axis.
    pub(crate) fn is_other_m(&self, number: u16) -> bool {
        self.dialect().other_m
            && number >= 100
            && number.is_multiple_of(10)
            // M96: a jump on an input (Haas), an interrupt (Fanuc); M109: the
            // operator types a value (Haas).
            && !matches!(number, 960 | 1090)
    }

    /// Says once that such a word is taken to move no axis.
    pub(crate) fn note_other_m(number: u16, span: Span, run: &mut Run<'_, '_>) {
        let message = format!(
            "M{} and other M words of the machine's builder are taken to move no axis",
            number / 10
        );
        run.report.note_once("builder-m", &message, span);
    }
}
