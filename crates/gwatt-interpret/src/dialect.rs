//! What Fanuc, Haas and their relatives have besides ISO 6983: G codes of
//! lathes, incremental words of G-code system A, numbers without a decimal
//! point, and words that move nothing.
//!
//! Fanuc B-63944EN and B-63604EN ("Decimal Point Programming", "G Code List in
//! T Series", "Skip Function (G31)"), Haas mill and lathe operator's manuals.

use super::code::{GCode, Motion};
use super::compensation::Insert;
use super::execute::{Control, Run};
use super::turning::{BOX, FACE, THREAD, THREAD_BOX};
use super::words::{AXIS_LETTERS, bit};
use gwatt_machine::units::MM_PER_INCH;
use gwatt_machine::{Dialect, Lathe, Point};
use gwatt_motion::FeedMode;
use gwatt_syntax::Word;
use gwatt_syntax::source::Span;

/// One least increment of IS-B, in program units.
const LEAST_MM: f64 = 1e-3;
const LEAST_INCH: f64 = 1e-4;
const LEAST_DEG: f64 = 1e-3;

/// Letters of lengths and angles.
const LENGTHS: &[u8] = b"XYZUVWABCIJKR";
/// Words of system A with the axes along which they are incremental.
const INCREMENTAL: [(u8, u8); 4] = [(b'U', b'X'), (b'V', b'Y'), (b'W', b'Z'), (b'H', b'C')];

/// What a dialect makes of a G word.
pub(super) enum Own {
    Code(GCode),
    /// It does not have it.
    Missing,
    /// What the family makes of it.
    Common,
}

/// The G word with this number × 10, where the dialect has a meaning of its own
/// for it.
pub(super) fn dialect_code(number: u16, dialect: &Dialect) -> Own {
    if dialect.osp {
        return super::osp::osp_code(number, dialect.diameter);
    }
    let Some(lathe) = dialect.lathe else {
        return match number {
            310 => Own::Code(GCode::Skip),
            120 | 130 if dialect.circular_pocket => Own::Code(GCode::Pocket(number == 120)),
            _ => Own::Common,
        };
    };
    let special = |number| GCode::Motion(Motion::Special(number));
    let units = |mm_per_unit| GCode::Units { mm_per_unit };
    Own::Code(match (lathe, number) {
        (_, 310) => GCode::Skip,
        (_, 320 | 330) => special(THREAD),
        (Lathe::A, 900) | (Lathe::B, 770) | (Lathe::C, 200) => special(BOX),
        (Lathe::A, 920) | (Lathe::B, 780) | (Lathe::C, 210) => special(THREAD_BOX),
        (Lathe::A, 940) | (Lathe::B, 790) | (Lathe::C, 240) => special(FACE),
        (_, 830 | 840 | 850 | 870 | 880 | 890) => special(number),
        (Lathe::A, 500) => GCode::SetOffset,
        (Lathe::A, 980) => GCode::FeedMode(FeedMode::PerMinute),
        (Lathe::A, 990) => GCode::FeedMode(FeedMode::PerRevolution),
        (Lathe::A, 910 | 930 | 950) => return Own::Missing,
        (Lathe::A | Lathe::B, 700..=760) if number.is_multiple_of(10) => GCode::Turning(number),
        (Lathe::C, 720..=780) if number.is_multiple_of(10) => GCode::Turning(number - 20),
        (Lathe::C, 700) => units(MM_PER_INCH),
        (Lathe::C, 710) => units(1.0),
        // The level that drilling cycles return to.
        (Lathe::B | Lathe::C, 980 | 990) => GCode::Ignored,
        _ => return Own::Common,
    })
}

impl Control<'_> {
    pub(super) fn dialect(&self) -> &Dialect {
        &self.machine.controller.language.dialect
    }

    /// The second look at the words of a block: incremental words become those
    /// of their axes, and numbers without a point get their meaning.
    #[cold]
    pub(super) fn adapt_words(&mut self, run: &mut Run<'_, '_>) {
        let groups = run.words.groups;
        run.words.incremental = 0;
        if groups & (GCode::Dwell.group() | GCode::MacroCall.group()) != 0 {
            return;
        }
        if let Some(point) = self.dialect().point {
            self.points(point, run);
        }
        if self.dialect().lathe != Some(Lathe::A) {
            return;
        }
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
    /// is written, which is never less than it means.
    fn points(&self, point: Point, run: &mut Run<'_, '_>) {
        let inch = run.words.g.iter().find_map(|(code, ..)| match code {
            GCode::Units { mm_per_unit } => Some(*mm_per_unit == MM_PER_INCH),
            _ => None,
        });
        let inch = inch.unwrap_or(self.modal.mm_per_unit == MM_PER_INCH);
        let cycle = run
            .words
            .g
            .iter()
            .any(|(code, ..)| matches!(code, GCode::Turning(_)));
        for word in &run.block.words {
            if !LENGTHS.contains(&word.letter)
                // A count, an angle.
                || cycle && (word.letter == b'A' || word.letter == b'R' && point == Point::Calculator)
                || word.value == 0.0
                || has_point(word.number.of(run.report.text))
            {
                continue;
            }
            if point == Point::Calculator {
                let message = "numbers without a decimal point are taken as whole millimetres, \
                               inches or degrees; where the control takes them for least \
                               increments (Fanuc: parameter 3401 bit DPI = 0), write \
                               decimal_point = \"least-increment\" under [language] in the \
                               machine file";
                run.report.note_once("no-point", message, word.span);
                return;
            }
            let least = match word.letter {
                b'A' | b'B' | b'C' => LEAST_DEG,
                _ if inch => LEAST_INCH,
                _ => LEAST_MM,
            };
            run.words.scale(word.letter, least);
        }
    }

    /// A depth or a step, mm: without a point its number counts least
    /// increments on every control (Fanuc: "decimal point input is not allowed").
    pub(super) fn fine_length(&self, letter: u8, run: &mut Run<'_, '_>) -> Option<f64> {
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

    /// `,C` or `,R` of the present block.
    pub(super) fn fanuc_corner(&mut self, word: &Word, text: &[u8]) {
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
    pub(super) fn argument(&self, word: &Word, run: &Run<'_, '_>) -> f64 {
        let scaled = self.dialect().point == Some(Point::LeastIncrement)
            && (LENGTHS.contains(&word.letter) || word.letter == b'Q')
            && !has_point(word.number.of(run.report.text));
        let inch = self.modal.mm_per_unit == MM_PER_INCH;
        match word.letter {
            _ if !scaled => word.value,
            b'A' | b'B' | b'C' => word.value * LEAST_DEG,
            _ if inch => word.value * LEAST_INCH,
            _ => word.value * LEAST_MM,
        }
    }

    /// A length that is no position, mm.
    pub(super) fn plain_length(&self, letter: u8, run: &mut Run<'_, '_>) -> Option<f64> {
        Some(run.words.take(letter)? * self.modal.mm_per_unit)
    }

    /// The words of a code that changes no motion, as in `G05.1 Q1 R5` or
    /// `G187 P3 E0.01`, where nothing else in the block could use them.
    pub(super) fn arguments_of_ignored(&self, number: u16, run: &mut Run<'_, '_>) {
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
        } else if alone && !run.words.axes().any(|(axis, _)| axis != 9) {
            run.words.unused &= AXIS_LETTERS & !bit(b'E');
        }
    }

    /// Whether an M word (number × 10) that is not known is taken to move no axis.
    pub(super) fn is_other_m(&self, number: u16) -> bool {
        self.dialect().other_m
            && number >= 100
            && number.is_multiple_of(10)
            // M96: a jump on an input (Haas), an interrupt (Fanuc); M109: the
            // operator types a value (Haas).
            && !matches!(number, 960 | 1090)
    }

    /// Says once that such a word is taken to move no axis.
    pub(super) fn note_other_m(number: u16, span: Span, run: &mut Run<'_, '_>) {
        let message = format!(
            "M{} and other M words of the machine's builder are taken to move no axis",
            number / 10
        );
        run.report.note_once("builder-m", &message, span);
    }
}

/// Whether a number stands there as Fanuc's rule for points knows it: with a
/// point, or worked out.
fn has_point(number: &[u8]) -> bool {
    let whole = |byte: &u8| matches!(byte, b'0'..=b'9' | b'+' | b'-' | b' ' | b'\t');
    !number.iter().all(whole)
}
