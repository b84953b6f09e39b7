//! The words of one block, sorted by letter, with checks that need no state.

use arrayvec::ArrayVec;

use super::code::{GCode, Motion, Own};
use super::dialect::dialect_code;
use super::g_codes::{code_number, exact_once};
use super::grbl_words::note_word;
use super::letters::{AXIS_LETTERS, POLAR, SLOTS, bit, letter_of, slot};
use super::report::Report;
use super::special::special_code;
use crate::rules::rules_of;
use gwatt_machine::Controller;
use gwatt_syntax::source::Span;
use gwatt_syntax::{Block, Word};

/// The bit of the motion group.
const MOTION_GROUP: u32 = 1;

/// Words that a block may have.
const WORDS_MAX: usize = 256;

/// The words of a block by letter. A buffer, filled again for each block.
#[derive(Debug)]
pub(super) struct Words {
    values: [f64; SLOTS],
    /// Index in `Block::words` of each letter's word.
    index: [u16; SLOTS],
    /// Letters that stand in the block.
    pub(super) present: u32,
    /// Letters that no code has used yet.
    pub(super) unused: u32,
    /// G words with their number × 10, in order.
    pub(super) g: ArrayVec<(GCode, u16, Span), 16>,
    /// M words with their number × 10.
    pub(super) m: ArrayVec<(u16, Span), 16>,
    /// Words that turn a knob: index in `controller.knobs`, value after `=`.
    pub(super) knobs: ArrayVec<(usize, Option<f64>, Span), 8>,
    /// Modal groups that have a word.
    pub(super) groups: u32,
    /// Axis letters whose words are incremental whatever the distance mode.
    pub(super) incremental: u32,
    /// The block carries a checksum.
    pub(super) checksum: bool,
    /// Two G words of one modal group of which the last counts: where the first ends, and
    /// where the last begins.
    pub(super) repeated: Option<[u32; 2]>,
}

impl Words {
    pub(super) fn new() -> Self {
        Self {
            values: [0.0; SLOTS],
            index: [0; SLOTS],
            present: 0,
            unused: 0,
            g: ArrayVec::new(),
            m: ArrayVec::new(),
            knobs: ArrayVec::new(),
            groups: 0,
            incremental: 0,
            checksum: false,
            repeated: None,
        }
    }

    /// Sorts the words of `block`. What is wrong is reported.
    pub(super) fn fill(
        &mut self,
        block: &Block,
        controller: &Controller,
        report: &mut Report<'_, '_>,
    ) {
        self.present = 0;
        self.groups = 0;
        self.checksum = false;
        self.repeated = None;
        self.g.clear();
        self.m.clear();
        self.knobs.clear();
        if let Some(word) = block.words.get(WORDS_MAX) {
            // Each of thousands of words that are wrong would be looked at in a long line.
            let message = "more than 256 words in a block";
            report
                .error("too-many-words", message, word.span)
                .help("write two blocks");
            self.unused = 0;
            return;
        }
        let plain = !controller.language.dialect.active;
        let mut words = block.words.iter().enumerate().peekable();
        while let Some((index, word)) = words.next() {
            match word.letter {
                b'G' if plain && self.add_motion(word) => {}
                b'G' | b'M' => {
                    let number = code_number(word.value);
                    let knob = number.and_then(|number| {
                        controller.knobs.iter().position(|knob| {
                            let levels = knob.levels.as_ref();
                            knob.code == Some((word.letter, number)) && knob.output().is_none()
                                || levels.is_some_and(|it| it.begins(word.letter, number))
                        })
                    });
                    if let Some(knob) = knob {
                        let assigned = words
                            .next_if(|(_, next)| next.letter == b'=')
                            .map(|(_, next)| next.value);
                        self.add_knob(knob, assigned, *word, report);
                    } else if word.letter == b'G' {
                        self.add_g(*word, controller, report);
                    } else {
                        self.add_m(*word, controller, report);
                    }
                }
                b'A'..=b'Z' => self.add(index, word, report),
                b'@' | b'^' if rules_of(&controller.language).polar_words => {
                    self.add(index, word, report);
                }
                b'*' if block.number.is_some() => {
                    self.checksum = true;
                    super::printer::verify_checksum(*word, controller, report);
                }
                _ => {
                    report.error(
                        "unknown-word",
                        format!("`{}` has no meaning here", word.letter as char),
                        word.span,
                    );
                }
            }
        }
        self.unused = self.present;
        if let Some(between) = self.repeated {
            check_order(between, block, report);
        }
    }

    fn add_knob(
        &mut self,
        knob: usize,
        assigned: Option<f64>,
        word: Word,
        report: &mut Report<'_, '_>,
    ) {
        if self.knobs.try_push((knob, assigned, word.span)).is_err() {
            report.error("too-many-words", "too many words in a block", word.span);
        }
    }

    #[inline]
    fn add(&mut self, index: usize, word: &Word, report: &mut Report<'_, '_>) {
        let mask = bit(word.letter);
        let slot = slot(word.letter);
        if self.present & mask != 0 || self.groups & GCode::MacroCall.group() != 0 {
            self.add_again(word, report);
            return;
        }
        self.present |= mask;
        self.values[slot] = word.value;
        self.index[slot] = index as u16;
    }

    /// A letter for the second time; those of a macro call are its arguments,
    /// which it reads itself.
    #[cold]
    fn add_again(&self, word: &Word, report: &mut Report<'_, '_>) {
        if self.groups & GCode::MacroCall.group() != 0 {
            return;
        }
        let message = format!("the block has two {} words", word.letter as char);
        report
            .error("word-twice", message, word.span)
            .help("write each letter once in a block");
    }

    /// G0 to G3, which every controller has, the short way; false for others.
    #[inline]
    fn add_motion(&mut self, word: &Word) -> bool {
        let motion = match word.value {
            0.0 => Motion::Rapid,
            1.0 => Motion::Linear,
            2.0 => Motion::ArcCw,
            3.0 => Motion::ArcCcw,
            _ => return false,
        };
        if self.groups & MOTION_GROUP != 0 || self.g.is_full() {
            return false;
        }
        self.groups |= MOTION_GROUP;
        let number = word.value as u16 * 10;
        self.g.push((GCode::Motion(motion), number, word.span));
        true
    }

    fn add_g(&mut self, word: Word, controller: &Controller, report: &mut Report<'_, '_>) {
        let known = code_number(word.value).and_then(|number| {
            let ignored = || {
                controller
                    .language
                    .ignored_g
                    .contains(&number)
                    .then_some(GCode::Ignored)
            };
            if controller.language.unknown_moves.contains(&(b'G', number)) {
                return Some((GCode::Ignored, number));
            }
            let dialect = &controller.language.dialect;
            if dialect.active {
                match dialect_code(number, dialect) {
                    Own::Code(code) => return Some((code, number)),
                    Own::Missing => return None,
                    Own::Common => {}
                }
            }
            (rules_of(&controller.language).g_code)(number)
                .or_else(|| special_code(number, &controller.language))
                .or_else(|| exact_once(number, &controller.language))
                .or_else(ignored)
                .map(|code| (code, number))
        });
        let Some((code, number)) = known else {
            report.refused_g(word, &controller.language);
            return;
        };
        if controller.language.loose_o_words {
            note_word(number, word.span, report);
        }
        if self.groups & code.group() != 0 && !matches!(code, GCode::Ignored | GCode::ExactOnce) {
            if controller.language.dialect.last_g_counts && self.replace(code, number, word.span) {
                let message = "of several G words of one group in a block the last counts";
                report.note_once("last-g-counts", message, word.span);
                return;
            }
            report
                .error(
                    "modal-group-twice",
                    "two G words of one modal group in a block",
                    word.span,
                )
                .help("keep the one that is meant, or write two blocks");
            return;
        }
        self.groups |= code.group();
        if self.g.try_push((code, number, word.span)).is_err() {
            report.error(
                "too-many-words",
                "more than 16 G words in a block",
                word.span,
            );
        }
    }

    /// Takes a G word for the one of its group that came before it, where both only set what
    /// is in force.
    fn replace(&mut self, code: GCode, number: u16, span: Span) -> bool {
        let same = |(old, ..): &(GCode, u16, Span)| old.group() == code.group();
        let Some(at) = self.g.iter().position(same) else {
            return false;
        };
        let Some(&(old, old_number, old_span)) = self.g.get(at) else {
            return false;
        };
        if !is_plain_modal(old, old_number) || !is_plain_modal(code, number) {
            return false;
        }
        let first = self.repeated.map_or(old_span.end, |[first, _]| first);
        self.repeated = Some([first, span.start]);
        self.g.remove(at);
        self.g.push((code, number, span));
        true
    }

    fn add_m(&mut self, word: Word, controller: &Controller, report: &mut Report<'_, '_>) {
        let Some(mut number) = code_number(word.value) else {
            report.error(
                "unknown-code",
                format!("M{} is not a valid word", word.value),
                word.span,
            );
            return;
        };
        let language = &controller.language;
        let described =
            language.unknown_moves.contains(&(b'M', number)) || language.ignored_m.contains(&16);
        if number == 160 && language.dialect.m16_changes_tool && !described {
            number = 60;
        }
        if self.m.try_push((number, word.span)).is_err() {
            report.error(
                "too-many-words",
                "more than 16 M words in a block",
                word.span,
            );
        }
    }

    /// True for a block of axis words, arc words and F, with no G word but one
    /// of the motion group: most blocks of a long program.
    #[inline]
    pub(super) fn is_plain_motion(&self) -> bool {
        const PLAIN: u32 = AXIS_LETTERS | bit(b'F') | bit(b'I') | bit(b'J') | bit(b'K') | bit(b'R');
        self.present & !PLAIN == 0
            && self.groups & !MOTION_GROUP == 0
            && self.m.is_empty()
            && self.knobs.is_empty()
    }

    /// True for a block without any G or M word, as `X10 S1`.
    pub(super) fn is_alone(&self) -> bool {
        self.g.is_empty() && self.m.is_empty() && self.knobs.is_empty()
    }

    /// True where no G word but one of the motion group stands in the block.
    #[inline]
    pub(super) fn only_moves(&self) -> bool {
        self.groups & !MOTION_GROUP == 0
    }

    /// Whether the letter stands in the block.
    pub(super) fn has(&self, letter: u8) -> bool {
        self.present & bit(letter) != 0
    }

    /// Takes the word of one letter for that of another.
    pub(super) fn rename(&mut self, from: u8, to: u8) {
        let (at, place) = (slot(from), slot(to));
        self.values[place] = self.values[at];
        self.index[place] = self.index[at];
        for mask in [&mut self.present, &mut self.unused] {
            *mask = *mask & !bit(from) | bit(to);
        }
    }

    /// Multiplies the value of a letter's word.
    pub(super) fn scale(&mut self, letter: u8, factor: f64) {
        self.values[slot(letter)] *= factor;
    }

    /// Value of a letter's word if no other code has used it; it is used now.
    pub(super) fn take(&mut self, letter: u8) -> Option<f64> {
        let free = self.unused & bit(letter) != 0;
        self.unused &= !bit(letter);
        free.then(|| self.values[slot(letter)])
    }

    /// The letter's word in its block.
    pub(super) fn word(&self, letter: u8, block: &Block) -> Option<Word> {
        self.has(letter).then(|| {
            block
                .words
                .get(usize::from(self.index[slot(letter)]))
                .copied()
        })?
    }

    /// Where the letter's word stands.
    pub(super) fn span(&self, letter: u8, block: &Block) -> Span {
        self.word(letter, block).map_or(
            Span {
                start: 0,
                end: block.text_end,
            },
            |word| word.span,
        )
    }

    /// Axis letters that no code has used, with values.
    #[inline]
    pub(super) fn axes(&self) -> Axes<'_> {
        Axes {
            letters: self.unused & AXIS_LETTERS,
            values: &self.values,
        }
    }

    /// The first letter that no code has used.
    pub(super) fn left_over(&self) -> Option<u8> {
        (self.unused != 0).then(|| letter_of(self.unused.trailing_zeros()))
    }

    /// True when an axis letter is left.
    pub(super) fn has_axes(&self) -> bool {
        self.unused & (AXIS_LETTERS | POLAR) != 0
    }
}

/// Whether a G word only sets what is in force: of several in a block the last may count.
fn is_plain_modal(code: GCode, number: u16) -> bool {
    match code {
        GCode::Motion(motion) => !matches!(motion, Motion::None | Motion::Special(_)),
        GCode::Plane(_)
        | GCode::Absolute(_)
        | GCode::Units { .. }
        | GCode::FeedMode(_)
        | GCode::Retract(_)
        | GCode::WorkOffset(_) => true,
        GCode::CompensationOff | GCode::CompensationOn { .. } => {
            matches!(number, 400 | 410 | 420)
        }
        GCode::ToolLength(_) => matches!(number, 430 | 440 | 490),
        _ => false,
    }
}

/// Refuses a block whose words of lengths stand on both sides of the last of two G words of a
/// group: it was hardly written for a control on which the last one holds for all of them.
#[cold]
fn check_order([first, last]: [u32; 2], block: &Block, report: &mut Report<'_, '_>) {
    let lengths =
        |word: &&Word| matches!(word.letter, b'A'..=b'C' | b'I'..=b'K' | b'R' | b'U'..=b'Z');
    let mut words = block.words.iter().filter(lengths);
    let between = words
        .clone()
        .any(|word| (first..last).contains(&word.span.start));
    let Some(after) = words
        .find(|word| word.span.start > last)
        .filter(|_| between)
    else {
        return;
    };
    let message = "two G words of one modal group, with words before and after the last of them";
    let help = "on this control the last one holds for the whole block: write two blocks";
    report
        .error("modal-group-twice", message, after.span)
        .help(help);
}

/// Axes and values of the axis words of a block.
pub(super) struct Axes<'a> {
    letters: u32,
    values: &'a [f64; SLOTS],
}

impl Iterator for Axes<'_> {
    type Item = (usize, f64);

    #[inline]
    fn next(&mut self) -> Option<(usize, f64)> {
        if self.letters == 0 {
            return None;
        }
        let letter = self.letters.trailing_zeros() as usize;
        self.letters &= self.letters - 1;
        Some((usize::from(AXIS_OF_LETTER[letter]), self.values[letter]))
    }
}

/// The axis that a letter names.
#[inline]
pub(super) fn axis_of(letter: u8) -> Option<usize> {
    let axis = *AXIS_OF_LETTER.get(usize::from(letter.wrapping_sub(b'A')))?;
    (axis != NO_AXIS).then_some(usize::from(axis))
}

const NO_AXIS: u8 = u8::MAX;

/// Axis index of each letter from A.
const AXIS_OF_LETTER: [u8; 26] = {
    let mut table = [NO_AXIS; 26];
    let letters = *b"XYZABCUVWE";
    let mut axis = 0;
    while axis < letters.len() {
        table[(letters[axis] - b'A') as usize] = axis as u8;
        axis += 1;
    }
    table
};
