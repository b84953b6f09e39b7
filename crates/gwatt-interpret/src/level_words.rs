//! Words by which a program selects a level of acceleration or rapid speed, as the
//! machine file describes them.

use super::control::{Control, Run};
use super::letters::{AXIS_LETTERS, bit};
use gwatt_machine::{Levels, Machine};
use gwatt_syntax::Block;
use gwatt_syntax::source::Span;

/// What a block selects.
enum Selected {
    Level(usize),
    /// Whether it is the one before or that of power-on is not known.
    Unclear,
    /// A word of the group with a number that the machine file does not have.
    Unknown,
}

impl Control<'_> {
    /// Selects the level whose words stand in the block.
    pub(super) fn select_level(&mut self, which: usize, span: Span, run: &mut Run<'_, '_>) {
        let Some(knob) = self.machine.controller.knobs.get(which) else {
            return;
        };
        let Some(levels) = &knob.levels else {
            return;
        };
        let selected = selected(levels, run.block, &mut |letter| {
            run.words.take(letter);
        });
        // What else such a word takes, as the E of G187.
        if run.words.groups == 0 && !run.words.axes().any(|(axis, _)| axis != 9) {
            run.words.unused &= AXIS_LETTERS & !bit(b'E');
        }
        run.facts.turns_knob = true;
        match selected {
            Selected::Level(level) => self.turn_to_level(which, Some(level), run),
            Selected::Unclear => {
                let message = "whether this word keeps the level that is in force is not known: the \
                               highest accelerations of all its levels count from here on";
                run.report.note_once("level-unclear", message, span);
                self.turn_to_level(which, None, run);
            }
            Selected::Unknown => {
                let message = format!(
                    "what this level makes of the accelerations is not known: the machine file has {}",
                    knob.name
                );
                run.report.error("level-unknown", message, span).help(
                    "give it under [[levels]] of the machine file; a word that ends a level or \
                         means the same as one goes into its list: word = [\"G5.1 Q0\", \"G8 P0\"]",
                );
            }
        }
    }

    /// Makes moves for which the control may choose a dynamic mode of its own (SINUMERIK:
    /// "DYNPOS: positioning mode, tapping"): the highest accelerations of all of them count.
    pub(super) fn at_any_mode(&mut self, act: impl FnOnce(&mut Self)) {
        let Some((which, _)) = named(self.machine, "DYNPOS") else {
            return act(self);
        };
        let before = self.knobs.levels;
        if let Some(knob) = self.machine.controller.knobs.get(which) {
            self.knobs.select(self.machine, knob, None);
        }
        act(self);
        self.knobs.select_all(self.machine, before);
    }

    /// Puts a level in force; `None`: any of them may be.
    pub(super) fn turn_to_level(
        &mut self,
        which: usize,
        level: Option<usize>,
        run: &mut Run<'_, '_>,
    ) {
        let Some(knob) = self.machine.controller.knobs.get(which) else {
            return;
        };
        self.knobs.select(self.machine, knob, level);
        if knob.change_s > 0.0 {
            self.dwell(run, knob.change_s);
        }
    }
}

/// The group that a name belongs to, and its level; `None` for a level that the machine
/// file does not have.
pub(super) fn named(machine: &Machine, name: &str) -> Option<(usize, Option<usize>)> {
    let knobs = machine.controller.knobs.iter().enumerate();
    let mut groups = knobs.filter_map(|(which, knob)| Some((which, knob.levels.as_ref()?)));
    groups.find_map(|(which, levels)| {
        let level = levels.named(name);
        // All of them are one modal group.
        let kin = |name: &str| name.starts_with("DYN");
        let akin = kin(name) && levels.words().any(|(_, word)| kin(&word.text));
        (level.is_some() || akin).then_some((which, level))
    })
}

/// The level whose words stand in a block: that with the most of them.
fn selected(levels: &Levels, block: &Block, take: &mut impl FnMut(u8)) -> Selected {
    let stands = |code: &(u8, f64)| {
        let mut words = block.words.iter();
        words.any(|word| word.letter == code.0 && (word.value - code.1).abs() < 1e-6)
    };
    let words = || levels.words().filter(|(_, word)| !word.codes.is_empty());
    let found = words()
        .filter(|(_, word)| word.codes.iter().all(stands))
        .max_by_key(|(index, word)| (word.codes.len(), usize::MAX - index));
    let Some((level, word)) = found else {
        return Selected::Unknown;
    };
    word.codes
        .iter()
        .skip(1)
        .for_each(|(letter, _)| take(*letter));
    let has = |letter: u8| block.words.iter().any(|word| word.letter == letter);
    let open = words()
        .filter(|(_, other)| other.code() == word.code())
        .flat_map(|(_, other)| other.codes.iter().skip(1))
        .any(|(letter, _)| has(*letter) && !word.codes.iter().any(|own| own.0 == *letter));
    if open {
        return Selected::Unknown;
    }
    let first = |letter: u8| word.codes.first().is_some_and(|own| own.0 == letter);
    let others = block
        .words
        .iter()
        .any(|other| !first(other.letter) && !word.codes.iter().any(|own| own.0 == other.letter));
    // `G187 E0.01` next to `G187 P1`.
    let alone = word.codes.len() == 1
        && words().any(|(_, other)| other.code() == word.code() && other.codes.len() > 1);
    if alone && others {
        return Selected::Unclear;
    }
    Selected::Level(level)
}
