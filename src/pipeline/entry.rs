//! A block that waits to be written, and what may be changed about it.

use super::ends::Places;
use super::executor::Line;
use super::line_key::LineKey;
use super::untouched::{
    BEAM_IS_LIT, COMPENSATED, FEED_MODE, FEEDS_ARE_ROUNDED, MACHINE_COORDINATES, NO_FEED,
    PER_REVOLUTION, RAPIDS_MAY_BE_SLOWER, REFERENCE, UNKNOWN_FEED, WITHOUT_STOP, help,
};
use crate::interpret::{
    FEED_MODE_UNKNOWN, Facts, FastPathState, FeedMode, KnobState, Motion, Move, MoveKind, Step,
};
use crate::limit::{Change, Outcome, Permit, Waiting};
use crate::machine::{AXES, AxisId, Machine, PathMode, RapidJoint, RapidPath};
use crate::power::Assessment;
use crate::rewrite::{Comment, Mark, has_at_most};
use crate::syntax::Block;

/// A block that waits until all its moves are decided.
pub(super) struct Entry {
    pub(super) key: LineKey,
    pub(super) text: Vec<u8>,
    pub(super) block: Block,
    pub(super) facts: Facts,
    pub(super) steps: Vec<Step>,
    /// Some of its steps may come with later blocks.
    pub(super) awaits: bool,
    /// The certificate holds with it and without it, where it may be skipped.
    pub(super) skips: bool,
    /// What is changed in it is put back right after it.
    pub(super) apart: bool,
    /// Corners are taken in one way each time that it runs.
    pub(super) one_corner: bool,
    /// Where a word stops the block before it: it can have that word.
    pub(super) stop_before: bool,
    /// Where no F is in force, it may not have one either: another block cannot.
    pub(super) without_feed: bool,
    /// It has the comment that marks what stands for a rapid.
    marked: bool,
    /// The state after it.
    pub(super) mark: Mark,
    /// The same, as far as plain blocks depend on it; `None` after a plain one.
    pub(super) fast_path_state: Option<FastPathState>,
    pub(super) knobs: Option<KnobState>,
    pub(super) feed_mode: FeedMode,
    /// Path mode of the move before it.
    pub(super) mode_before: PathMode,
    /// Millimetres in a program unit before it.
    pub(super) mm_per_unit_before: f64,
    pub(super) moves: usize,
    /// Of its only move, where it may be written as several blocks.
    pub(super) places: Option<Places>,
    pub(super) decided: Vec<(Assessment, Outcome)>,
}

impl Entry {
    pub(super) fn new(line: &Line<'_, '_>) -> Self {
        let modal = line.interpreter.modal();
        Self {
            key: line.key,
            text: Vec::new(),
            block: Block::default(),
            facts: Facts::default(),
            steps: Vec::new(),
            awaits: false,
            skips: false,
            apart: false,
            one_corner: true,
            stop_before: false,
            without_feed: false,
            marked: false,
            mark: Mark::of(modal),
            fast_path_state: None,
            knobs: None,
            feed_mode: modal.feed_mode,
            mode_before: modal.path_mode,
            mm_per_unit_before: modal.mm_per_unit,
            moves: 0,
            places: None,
            decided: Vec::new(),
        }
    }

    pub(super) fn fill(
        &mut self,
        line: &mut Line<'_, '_>,
        machine: &Machine,
        mode_before: PathMode,
        mm_per_unit_before: f64,
    ) {
        let modal = line.interpreter.modal();
        self.key = line.key;
        self.text.clear();
        self.text.extend_from_slice(line.text);
        std::mem::swap(&mut self.block, line.block);
        std::mem::swap(&mut self.facts, line.facts);
        std::mem::swap(&mut self.steps, line.steps);
        self.awaits = line.interpreter.holds();
        self.moves = self
            .steps
            .iter()
            .filter(|step| matches!(step, Step::Move(_)))
            .count();
        self.mark = Mark::of(modal);
        let plain = self.facts.plain && matches!(self.steps.as_slice(), [Step::Move(_)]);
        self.fast_path_state = (!plain).then(|| line.interpreter.fast_path_state());
        self.knobs = knobs(machine, line.interpreter.knobs());
        self.feed_mode = modal.feed_mode;
        self.mode_before = mode_before;
        self.mm_per_unit_before = mm_per_unit_before;
        self.places = None;
        self.decided.clear();
        self.marked = false;
    }

    /// Looks for the comment that marks what stands for a rapid.
    pub(super) fn look_for(&mut self, comment: &Comment) {
        self.marked = comment.is_in(&self.text);
    }

    /// Whether a move of it is a feed that stands for a rapid.
    fn stands_for_rapid(&self, mv: &Move) -> bool {
        self.marked
            && mv.kind == MoveKind::Feed
            && self.mark.motion == Motion::Linear
            && self.facts.uses_motion
            && self.key == (mv.text, mv.line)
    }

    /// Whether a move cuts nothing although it obeys F, so that its F needs no permission.
    pub(super) fn positions(&self, machine: &Machine, mv: &Move) -> bool {
        self.facts.homes
            || self.facts.moves_by_firmware()
            || positions(machine, self.mark.motion, mv)
            || self.stands_for_rapid(mv)
    }

    /// Whether a step is one of its own.
    pub(super) fn owns(&self, step: &Step) -> bool {
        match step {
            Step::Move(mv) => self.key == (mv.text, mv.line),
            Step::Action(action) => self.key.1 == action.line,
        }
    }

    /// Its moves in order.
    pub(super) fn its_moves(&self) -> impl Iterator<Item = &Move> {
        self.steps.iter().filter_map(|step| match step {
            Step::Move(mv) => Some(mv),
            Step::Action(_) => None,
        })
    }

    /// Whether it moves by a kind that is wanted.
    pub(super) fn moves_by(&self, wanted: fn(MoveKind) -> bool) -> bool {
        self.moves > 0
            && self
                .steps
                .iter()
                .any(|step| matches!(step, Step::Move(mv) if wanted(mv.kind)))
    }

    /// One change for all its moves: the lower value of each word.
    #[inline]
    pub(super) fn change(&self) -> Option<Change> {
        // Round a corner a rapid is another path than a feed.
        if self.facts.compensated && self.decided.iter().any(|(_, it)| it.obstacle.is_some()) {
            return None;
        }
        let mut changes = self
            .decided
            .iter()
            .filter_map(|(_, outcome)| outcome.change.as_deref().copied());
        let first = changes.next()?;
        Some(changes.fold(first, |merged, change| merged.lower(&change)))
    }

    /// One of its moves, with what may be changed.
    pub(super) fn waiting<'a>(&self, machine: &Machine, mv: &'a Move, step: usize) -> Waiting<'a> {
        let permit = self.permit(machine, mv, step);
        Waiting { mv, permit }
    }

    /// What may be changed for one of its moves.
    fn permit(&self, machine: &Machine, mv: &Move, step: usize) -> Permit {
        let facts = &self.facts;
        let mode_before = if step == 0 {
            self.mode_before
        } else {
            mv.path_mode
        };
        let stops = mv.path_mode == PathMode::ExactStop && mode_before == PathMode::ExactStop;
        let planner = &machine.controller.planner;
        let stays = stops || planner.rapid_joint == RapidJoint::All || self.between_stops(machine);
        // What forbids any edit, what forbids an F, what forbids G1 for G0.
        let skips = self.skips || !machine.controller.language.block_delete;
        let edit = self.keeps_its_words(skips);
        let no_feed = self.cannot_get_feed(machine, mv);
        // A rapid gets a feed per minute of its own, whatever F means.
        let apart = mv.kind == MoveKind::Rapid
            && (self.feed_mode_words().next().is_none() || self.may_be_per_minute());
        let feed = [
            (self.mark.feed_mode_word == FEED_MODE_UNKNOWN, FEED_MODE),
            (facts.homes, "it homes the axes"),
            (facts.own_feed.is_some(), facts.own_feed.unwrap_or_default()),
            (facts.dwell_takes_feed, "an F in it would be its dwell"),
            (no_feed.is_some(), no_feed.unwrap_or_default()),
            (
                facts.computed_feed && mv.kind != MoveKind::Rapid && !self.caps_feed(machine),
                "its feed is worked out by the program",
            ),
            (
                self.feed_mode == FeedMode::InverseTime && !apart && !self.has_its_own_time(),
                "its feed is an inverse time (G93)",
            ),
            (
                self.feed_mode == FeedMode::PerRevolution && !apart,
                PER_REVOLUTION,
            ),
        ];
        let rapid = self.stays_rapid(machine, stays);
        let reasons = [edit, first_reason(&feed), first_reason(&rapid)];
        let reason_text = reasons.into_iter().flatten().next().unwrap_or("");
        let reason_help = help(machine, &self.facts, reason_text);
        let feed_accel_mm_s2 = self
            .knobs
            .as_ref()
            .map_or(mv.accel_mm_s2, |knobs| knobs.feed_accel_mm_s2);
        let stopping = planner.rapid_joint == RapidJoint::Stop && mv.kind == MoveKind::Rapid;
        let knows_levels = self
            .knobs
            .as_ref()
            .is_some_and(|it| it.knows_levels(machine));
        // What the program has set could not be put back.
        let unsure_unit = self.knobs.as_ref().is_some_and(|it| it.unsure_unit);
        let printer = &machine.controller.language.printer;
        let may_stop = self.between_stops(machine) && self.may_stop_exactly(machine);
        let blended_rapid = mv.kind == MoveKind::Rapid && mv.path_mode == PathMode::LookAhead;
        Permit {
            edit: reasons[0].is_none(),
            feed_word: reasons[..2] == [None, None],
            as_feed: reasons == [None; 3],
            exact_stop: may_stop,
            stands: !facts.compensated && (stops || blended_rapid && may_stop),
            levels: !facts.compensated && knows_levels && !facts.no_motion_word,
            rests: !facts.compensated && (stops || stopping && self.moves == 1),
            line_before: !facts.compensated,
            // A word for rapids does nothing where the control starts with G1.
            knobs: !facts.compensated && !unsure_unit && !facts.no_motion_word,
            apart: self.apart,
            stop_word: machine.controller.language.exact_stop_word.is_some()
                && self.takes_stop_word(machine, skips),
            unsplit: self.unsplit(mv),
            reason: reason_text,
            reason_help,
            mm_per_unit: facts.feed_mm_per_unit,
            knob_mm_per_unit: printer.limit_unit(self.mm_per_unit_before),
            feed_before: self.feed_before(),
            positions: self.positions(machine, mv),
            feed_accel_mm_s2,
            speed_mm_s: self
                .knobs
                .as_ref()
                .map_or([f64::INFINITY; AXES], |knobs| knobs.speed_mm_s),
        }
    }

    /// Why none of its words may be changed; `skips`: a change is right too where the block
    /// is skipped.
    pub(super) fn keeps_its_words(&self, skips: bool) -> Option<&'static str> {
        let facts = &self.facts;
        let checks = [
            (facts.fixed.is_some(), facts.fixed.unwrap_or_default()),
            (facts.checksum, "it carries a checksum"),
            (
                self.block.delete_level > 0 && !skips,
                "it may be skipped (block delete)",
            ),
            (
                facts.boundary && facts.tool_words.is_none() && !facts.moves_by_firmware(),
                "it stops, changes the tool or ends the program",
            ),
            (facts.turns_knob, "it sets limits itself"),
            (
                facts.compensated && (facts.tool_words.is_some() || facts.stop_word.is_some()),
                COMPENSATED,
            ),
        ];
        let mut found = checks.iter().filter(|(applies, _)| *applies);
        found.next().map(|(_, reason)| *reason)
    }

    /// Whether its rapid may be written as a feed between two dwells of no time, or between
    /// two words for an exact stop, where the feed alone would be blended.
    pub(super) fn between_stops(&self, machine: &Machine) -> bool {
        let mut moving = self.its_moves().filter(|mv| mv.kind != MoveKind::Dwell);
        let one_move = moving.next().is_some() && moving.next().is_none();
        let by_words = self.stop_before && self.may_stop_exactly(machine);
        let by_dwells = machine.controller.planner.dwell_stops && !self.facts.compensated;
        one_move && (by_dwells || by_words)
    }

    /// Whether the word for an exact stop may be put into its block or before it.
    pub(super) fn takes_stop_word(&self, machine: &Machine, skips: bool) -> bool {
        self.keeps_its_words(skips).is_none()
            && self.moves == 1
            && !self.block.words.is_empty()
            && self.may_stop_exactly(machine)
    }

    /// Whether it may run in exact stop, with a word in it or with words before and after it.
    fn may_stop_exactly(&self, machine: &Machine) -> bool {
        let language = &machine.controller.language;
        let mut words = self.block.words.iter();
        // By a word in it, or by lines around it.
        let by_lines =
            language.stops_by_mode() && self.one_corner && self.mark.blend_again().is_some()
                || language.family.facts().stops_by_exact_path
                    && language.g61_1 == PathMode::ExactStop
                    && self.one_corner
                    && self.mark.blend_words().is_some();
        !words.any(|word| word.letter == b'G' && (61.0..=64.0).contains(&word.value))
            && (language.exact_stop_word.is_some() || by_lines && !self.facts.compensated)
    }

    /// Whether it ends at rest as it is, though corners are rounded.
    pub(super) fn rests(&self, machine: &Machine, change: Option<&Change>) -> bool {
        let last = self.its_moves().last();
        change.is_none() && last.is_some_and(|mv| rests(machine, mv))
    }

    /// Whether a rapid of it that is written as a feed needs these dwells.
    pub(super) fn needs_stops(&self, machine: &Machine, change: Option<&Change>) -> bool {
        let blends =
            |step: &Step| matches!(step, Step::Move(mv) if mv.path_mode == PathMode::LookAhead);
        machine.controller.planner.rapid_joint != RapidJoint::All
            && change.is_some_and(|change| change.as_feed)
            && (self.mode_before == PathMode::LookAhead || self.steps.iter().any(blends))
    }

    /// Whether the F that the program works out for it may be held below a value.
    fn caps_feed(&self, machine: &Machine) -> bool {
        let word = self.facts.feed_word;
        word.is_some_and(|word| {
            has_at_most(
                machine.controller.language.family,
                word.number.of(&self.text),
            )
        })
    }

    /// What forbids G1 for G0; `stays`: it ends at rest as a feed too.
    fn stays_rapid(&self, machine: &Machine, stays: bool) -> [(bool, &'static str); 9] {
        let facts = &self.facts;
        let family = machine.controller.language.family.facts();
        [
            (
                facts.machine_coordinates && !family.feeds_in_machine_coordinates,
                MACHINE_COORDINATES,
            ),
            (facts.beam_is_lit, BEAM_IS_LIT),
            (facts.feeds_are_rounded, FEEDS_ARE_ROUNDED),
            (facts.rapids_may_be_slower, RAPIDS_MAY_BE_SLOWER),
            (facts.reference.is_some(), REFERENCE),
            (
                self.works_out_motion(),
                "its motion word is worked out by the program",
            ),
            (!stays, WITHOUT_STOP),
            (
                facts.compensated && self.moves > 1,
                "it goes round a corner under compensation",
            ),
            (
                // The blocks that follow would become lines too.
                facts.no_motion_word && machine.path.rapid == RapidPath::Independent,
                "no motion word is in force that could be put back",
            ),
        ]
    }

    /// Whether the number of its motion word is worked out.
    fn works_out_motion(&self) -> bool {
        let word = self.facts.motion_word;
        word.is_some_and(|word| {
            let plain = |byte: &u8| byte.is_ascii_digit() || b".+- \t".contains(byte);
            !word.number.of(&self.text).iter().all(plain)
        })
    }

    /// Whether its F under G93 is the time of one move, that a lower one makes longer.
    fn has_its_own_time(&self) -> bool {
        self.moves == 1 && self.facts.feed_word.is_some() && !self.facts.compensated
    }

    /// The numbers of its G words that may say what F means.
    fn feed_mode_words(&self) -> impl Iterator<Item = f64> {
        let says =
            |number: f64| (93.0..=99.0).contains(&number) || (930.0..=979.0).contains(&number);
        let words = self.block.words.iter().filter(|word| word.letter == b'G');
        words.map(|word| word.value).filter(move |it| says(*it))
    }

    /// Whether it says by a single word that F is by the revolution, in whose place one for
    /// feeds per minute may stand.
    fn may_be_per_minute(&self) -> bool {
        let mut words = self.feed_mode_words();
        let says = |number: f64| number == 95.0 || number == 99.0;
        self.feed_mode == FeedMode::PerRevolution
            && !self.facts.compensated
            && words.next().is_some_and(says)
            && words.next().is_none()
    }

    /// Why a move for which no F is in force cannot have one.
    fn cannot_get_feed(&self, machine: &Machine, mv: &Move) -> Option<&'static str> {
        if self.mark.feed.is_some() || mv.kind == MoveKind::Rapid {
            return None;
        }
        if !self.lacks_feed() {
            return Some("no F is in force that could be put back");
        }
        if machine.controller.language.power_on_feed_mm_s == f64::INFINITY {
            return Some(UNKNOWN_FEED);
        }
        self.without_feed.then_some(NO_FEED)
    }

    /// Whether its moves obey F, but none is in force: neither its own nor an earlier one.
    pub(super) fn lacks_feed(&self) -> bool {
        let facts = &self.facts;
        self.mark.feed.is_none()
            && self.feed_mode == FeedMode::PerMinute
            && facts.uses_motion
            && facts.uses_feed
            && self
                .its_moves()
                .any(|mv| mv.moves_axes() && mv.kind != MoveKind::Rapid)
    }

    /// The F in force, in program units.
    pub(super) fn feed_before(&self) -> Option<f64> {
        self.mark.feed.as_ref().map(|feed| feed.value)
    }
}

/// The first reason that applies.
fn first_reason(checks: &[(bool, &'static str)]) -> Option<&'static str> {
    let mut applying = checks.iter().filter(|(applies, _)| *applies);
    applying.next().map(|(_, reason)| *reason)
}

/// Whether a move ends at rest before a feed: a rapid that is not blended with feeds.
pub(super) fn rests(machine: &Machine, mv: &Move) -> bool {
    machine.controller.planner.rapid_joint != RapidJoint::All
        && mv.kind == MoveKind::Rapid
        && mv.length_mm > 0.0
}

/// Whether a move that obeys F is a rapid by its motion word, and prints nothing.
pub(super) fn positions(machine: &Machine, motion: Motion, mv: &Move) -> bool {
    machine.controller.language.rapid_uses_feed
        && motion == Motion::Rapid
        && mv.kind == MoveKind::Feed
        && !mv.moving.contains(AxisId::E as usize)
}

/// The knobs in force, where the controller has any.
pub(super) fn knobs(machine: &Machine, state: &KnobState) -> Option<KnobState> {
    (!machine.controller.knobs.is_empty()).then(|| state.clone())
}
