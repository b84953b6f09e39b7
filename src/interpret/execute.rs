//! One block at a time, in LinuxCNC's order of execution: feed mode, F, S, T,
//! tool change, spindle, coolant, dwell, plane, units, offsets, path mode,
//! distance mode, reference points and offsets, motion, stop.

use super::code::{GCode, Motion, path_mode};
use super::knob::KnobState;
use super::modal::{Feed, Modal};
use super::moves::{Action, ActionKind, FeedMode, Step};
use super::position::{Position, Start};
use super::report::{Diagnostics, Report};
use super::words::Words;
use crate::machine::{Family, KnobArgument, Machine, PathMode};
use crate::source::Span;
use crate::syntax::{Block, Word};

/// What the rewriter must know of a block besides its moves.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Facts {
    /// The F word that sets the feed (not the one of a dwell).
    pub feed_word: Option<Word>,
    /// The word of the motion group, if the block has one.
    pub motion_word: Option<Word>,
    /// The block moves by the motion word in force, its own or an earlier one.
    pub uses_motion: bool,
    /// That motion obeys F.
    pub uses_feed: bool,
    /// G53: the move is in machine coordinates.
    pub machine_coordinates: bool,
    /// G28 or G30.
    pub reference: bool,
    /// The block carries a checksum.
    pub checksum: bool,
    /// A stop, tool change or end: the modal state must be the original's.
    pub boundary: bool,
    /// The block is executed: not deleted, not behind the end, not empty.
    pub executed: bool,
    /// The block turns a knob.
    pub turns_knob: bool,
    /// Millimetres in a program unit when the block's F is read.
    pub feed_mm_per_unit: f64,
}

/// Executes the blocks of a program.
#[derive(Debug)]
pub struct Interpreter<'m> {
    control: Control<'m>,
    words: Words,
}

/// What holds from block to block.
#[derive(Debug)]
pub(super) struct Control<'m> {
    pub(super) machine: &'m Machine,
    pub(super) modal: Modal,
    pub(super) position: Position,
    pub(super) knobs: KnobState,
    pub(super) loads: u32,
    loads_off: u32,
    block_delete: bool,
    begun: bool,
    ended: bool,
    has_program_number: bool,
}

/// The block that is being executed.
pub(super) struct Run<'a, 'l> {
    pub(super) line: u64,
    pub(super) block: &'a Block,
    pub(super) words: &'a mut Words,
    pub(super) facts: Facts,
    pub(super) steps: &'a mut Vec<Step>,
    pub(super) report: Report<'a, 'l>,
}

impl Run<'_, '_> {
    fn act(&mut self, kind: ActionKind, value: f64) {
        self.steps.push(Step::Action(Action {
            line: self.line,
            kind,
            value,
        }));
    }

    pub(super) fn whole(&self) -> Span {
        Span {
            start: 0,
            end: self.block.text_end,
        }
    }
}

impl<'m> Interpreter<'m> {
    /// Begins a program: state at power-on, axes at `start`; `block_delete`
    /// passes over blocks that begin with `/`.
    #[must_use]
    pub fn new(machine: &'m Machine, start: Start, block_delete: bool) -> Self {
        let control = Control {
            machine,
            modal: Modal::power_on(machine),
            position: Position::new(start),
            knobs: KnobState::new(machine),
            loads: 0,
            loads_off: 0,
            block_delete,
            begun: false,
            ended: false,
            has_program_number: false,
        };
        Self {
            control,
            words: Words::new(),
        }
    }

    /// The modal state after the last block.
    #[must_use]
    pub fn modal(&self) -> &Modal {
        &self.control.modal
    }

    /// The limits in force after the last block.
    #[must_use]
    pub fn knobs(&self) -> &KnobState {
        &self.control.knobs
    }

    /// True once the program has ended (M2, M30, closing `%`).
    #[must_use]
    pub fn ended(&self) -> bool {
        self.control.ended
    }

    /// Executes one block: appends what it does to `steps`. What is not
    /// understood is reported, and the block then does nothing.
    pub fn execute(
        &mut self,
        line: u64,
        text: &[u8],
        block: &Block,
        steps: &mut Vec<Step>,
        diagnostics: &mut Diagnostics,
    ) -> Facts {
        let mut report = Report {
            diagnostics,
            line,
            text,
        };
        if self.control.passes_over(block, &mut report) {
            return Facts::default();
        }
        for issue in &block.issues {
            report.diagnostics.push(issue.diagnostic(line, text));
        }
        if !block.issues.is_empty() || block.words.is_empty() {
            return Facts::default();
        }
        let before = steps.len();
        let errors = report.diagnostics.errors;
        let facts = Facts {
            executed: true,
            ..Facts::default()
        };
        let mut run = Run {
            line,
            block,
            words: &mut self.words,
            facts,
            steps,
            report,
        };
        self.control.run(&mut run);
        if run.report.diagnostics.errors != errors {
            run.steps.truncate(before);
        }
        run.facts
    }
}

impl Control<'_> {
    /// Whether the block is deleted, a tape mark, or behind the end.
    fn passes_over(&mut self, block: &Block, report: &mut Report<'_, '_>) -> bool {
        let all = Span {
            start: 0,
            end: block.text_end,
        };
        if self.ended {
            if !block.tape && !(block.words.is_empty() && block.issues.is_empty()) {
                report.note_once(
                    "behind-the-end",
                    "what follows the end of the program is not executed",
                    all,
                );
            }
            return true;
        }
        if block.tape {
            // The first `%` opens the tape; one behind any block ends it.
            self.ended = self.begun;
            return true;
        }
        if block.delete_level == 0 {
            return false;
        }
        if !self.machine.controller.language.block_delete {
            report.note_once(
                "no-block-delete",
                "this controller executes blocks that begin with `/`",
                all,
            );
            return false;
        }
        self.block_delete
    }

    fn run(&mut self, run: &mut Run<'_, '_>) {
        self.begun = true;
        run.words
            .fill(run.block, &self.machine.controller, &mut run.report);
        run.facts.checksum = run.block.words.iter().any(|word| word.letter == b'*');
        self.program_number(run);
        let dwell_s = self.dwell_time(run);
        self.feed_mode(run);
        self.read_feed(run);
        self.speed_and_tool(run);
        self.m_words(run);
        if let Some(dwell_s) = dwell_s {
            self.dwell(run, dwell_s);
        }
        self.settings(run);
        self.turn_knobs(run);
        self.motion(run);
        self.complain_about_rest(run);
        self.end_of_block(run);
    }

    fn program_number(&mut self, run: &mut Run<'_, '_>) {
        if run.words.take(b'O').is_none() {
            return;
        }
        let span = run.words.span(b'O', run.block);
        if self.has_program_number {
            run.report
                .error(
                    "several-programs",
                    "a second program number: several programs in one file",
                    span,
                )
                .help("give one program at a time; subprograms are not supported");
        }
        self.has_program_number = true;
    }

    fn feed_mode(&mut self, run: &mut Run<'_, '_>) {
        for (code, ..) in &run.words.g {
            if let GCode::FeedMode(mode) = *code {
                if mode != self.modal.feed_mode {
                    // An F of another meaning must not be taken over.
                    self.modal.feed = None;
                }
                self.modal.feed_mode = mode;
            }
        }
    }

    /// Takes the F word. LinuxCNC reads it in the unit in force before the
    /// block; the others in the unit that the block itself sets.
    fn read_feed(&mut self, run: &mut Run<'_, '_>) {
        if run.words.take(b'F').is_none() {
            return;
        }
        let Some(word) = run.words.word(b'F', run.block) else {
            return;
        };
        if word.value < 0.0 {
            run.report
                .error("negative-feed", "the feed is negative", word.span)
                .help("write a positive F");
            return;
        }
        let mut mm_per_unit = self.modal.mm_per_unit;
        if self.machine.controller.language.family != Family::Rs274 {
            for (code, ..) in &run.words.g {
                if let GCode::Units { mm_per_unit: unit } = code {
                    mm_per_unit = *unit;
                }
            }
        }
        let text = word.number.of(run.report.text);
        run.facts.feed_word = Some(word);
        run.facts.feed_mm_per_unit = mm_per_unit;
        let kept = if text.len() > Feed::TEXT_MAX {
            &[]
        } else {
            text
        };
        self.modal.feed = Some(Feed {
            value: word.value,
            mm_per_unit,
            text: kept.iter().copied().collect(),
        });
    }

    fn speed_and_tool(&mut self, run: &mut Run<'_, '_>) {
        let other = run
            .words
            .m
            .iter()
            .any(|(number, _)| self.m_kind(*number) == Some(ActionKind::Other));
        if let Some(value) = run.words.take(b'S')
            && !other
        {
            self.modal.spindle_rpm = value.abs();
            run.act(ActionKind::SpindleSpeed, value);
            self.note_spindle(run);
        }
        if let Some(tool) = run.words.take(b'T')
            && !other
        {
            run.act(ActionKind::ToolSelect, tool);
            run.facts.boundary = true;
        }
    }

    fn note_spindle(&self, run: &mut Run<'_, '_>) {
        if self.machine.spindle.is_none() {
            let span = run.whole();
            let message = "the machine file describes no spindle: its power is not counted";
            run.report.note_once("no-spindle", message, span);
        }
    }

    /// What an M word does; `None` if it is not known.
    fn m_kind(&self, number: u16) -> Option<ActionKind> {
        let value = f64::from(number) / 10.0;
        let word = (b'M', value);
        let is_load = || {
            self.machine
                .loads
                .iter()
                .any(|load| load.on == word || load.off.contains(&word))
        };
        match number {
            0 | 10 | 600 => Some(ActionKind::Stop),
            20 | 300 => Some(ActionKind::End),
            30 | 40 | 50 => Some(ActionKind::Spindle),
            60 => Some(ActionKind::ToolChange),
            70 | 80 | 90 => Some(ActionKind::Coolant),
            _ if self.is_ignored(number) || is_load() => Some(ActionKind::Other),
            _ => None,
        }
    }

    /// Whether the profile says that an M word (number × 10) moves no axis.
    fn is_ignored(&self, number: u16) -> bool {
        number.is_multiple_of(10)
            && self
                .machine
                .controller
                .language
                .ignored_m
                .contains(&(number / 10))
    }

    fn m_words(&mut self, run: &mut Run<'_, '_>) {
        for index in 0..run.words.m.len() {
            let (number, span) = run.words.m[index];
            let value = f64::from(number) / 10.0;
            self.switch_loads(value);
            if matches!(number, 820 | 830)
                && self.machine.controller.language.family == Family::Marlin
            {
                self.modal.extruder_absolute = number == 820;
                continue;
            }
            let Some(kind) = self.m_kind(number) else {
                run.report.refused_m(Word {
                    letter: b'M',
                    value,
                    span,
                    number: span,
                });
                continue;
            };
            match kind {
                ActionKind::Spindle => self.note_spindle(run),
                // Arguments of a word that moves no axis, as in `M106 S255 P1`.
                ActionKind::Other => run.words.unused &= super::words::AXIS_LETTERS,
                _ => {}
            }
            run.facts.boundary |= matches!(
                kind,
                ActionKind::Stop | ActionKind::End | ActionKind::ToolChange
            );
            if !matches!(kind, ActionKind::Stop | ActionKind::End) {
                run.act(kind, value);
            }
        }
    }

    /// Switches loads on. Those that go off do so behind the block's moves,
    /// since controllers differ in when they do.
    fn switch_loads(&mut self, value: f64) {
        for (index, load) in self.machine.loads.iter().enumerate().take(32) {
            if load.on == (b'M', value) {
                self.loads |= 1 << index;
                self.loads_off &= !(1 << index);
            }
            if load.off.contains(&(b'M', value)) {
                self.loads_off |= 1 << index;
            }
        }
    }

    /// Plane, units, compensation, offsets, path and distance mode.
    fn settings(&mut self, run: &mut Run<'_, '_>) {
        for index in 0..run.words.g.len() {
            let (code, number, span) = run.words.g[index];
            match code {
                GCode::Plane(plane) => self.modal.plane = plane,
                GCode::Units { mm_per_unit } => self.modal.mm_per_unit = mm_per_unit,
                GCode::ToolLengthOn => {
                    run.words.take(b'H');
                    let message = "without a tool table the tool length is taken as 0";
                    run.report.note_once("no-tool-table", message, span);
                }
                GCode::PathMode => self.path_mode(number, run),
                GCode::Absolute(absolute) => {
                    self.modal.absolute = absolute;
                    self.modal.extruder_absolute = absolute;
                }
                GCode::ArcAbsolute(absolute) => self.modal.arc_absolute = absolute,
                GCode::MachineCoordinates => run.facts.machine_coordinates = true,
                GCode::Motion(motion) => {
                    self.modal.motion = motion;
                    run.facts.motion_word = run
                        .block
                        .words
                        .iter()
                        .copied()
                        .find(|word| word.span == span);
                }
                GCode::WorkOffset(offset) if offset > 1 => {
                    let message = "without a parameter file all work offsets are taken as 0";
                    run.report.note_once("no-offsets", message, span);
                }
                _ => {}
            }
        }
    }

    fn path_mode(&mut self, number: u16, run: &mut Run<'_, '_>) {
        let asked = path_mode(number, &self.machine.controller.language);
        let exact = self.machine.path.mode == Some(PathMode::ExactStop);
        self.modal.path_mode = if exact { PathMode::ExactStop } else { asked };
        if number == 640 {
            run.words.take(b'P');
            run.words.take(b'Q');
        }
        run.act(ActionKind::PathMode, f64::from(number) / 10.0);
    }

    /// Words by which the program itself limits acceleration or rapid speed.
    fn turn_knobs(&mut self, run: &mut Run<'_, '_>) {
        for index in 0..run.words.knobs.len() {
            let (which, assigned, span) = run.words.knobs[index];
            let Some(knob) = self.machine.controller.knobs.get(which) else {
                continue;
            };
            run.facts.turns_knob = true;
            let unit = self.modal.mm_per_unit;
            let mut turned = false;
            let mut fine = true;
            let valid = |value: f64| value.is_finite() && value > 0.0;
            match (&knob.argument, assigned) {
                (KnobArgument::Assign, Some(value)) if valid(value) => {
                    self.knobs.turn(self.machine, knob, None, value, unit);
                    turned = true;
                }
                (KnobArgument::Axes, None) => {
                    for (axis, value) in run.words.axes().collect::<arrayvec::ArrayVec<_, 10>>() {
                        run.words.take(crate::machine::ALL_AXES[axis].letter());
                        fine &= valid(value);
                        self.knobs.turn(self.machine, knob, Some(axis), value, unit);
                        turned = true;
                    }
                }
                (KnobArgument::Path(letters), None) => {
                    for letter in letters {
                        let Some(value) = run.words.take(*letter) else {
                            continue;
                        };
                        fine &= valid(value);
                        self.knobs.turn_path(*letter, value, unit);
                        turned = true;
                    }
                }
                _ => {}
            }
            if !turned || !fine {
                let code = format!("{}{}", knob.code.0 as char, f64::from(knob.code.1) / 10.0);
                run.report
                    .error(
                        "knob-value",
                        format!("{code} needs values above 0 in the form that its profile states"),
                        span,
                    )
                    .help("see `argument` of this word in the controller profile");
            }
        }
    }

    fn dwell_time(&mut self, run: &mut Run<'_, '_>) -> Option<f64> {
        if run.words.groups & GCode::Dwell.group() == 0 {
            return None;
        }
        let language = &self.machine.controller.language;
        let mut seconds = None;
        for (letter, unit) in &language.dwell {
            if let Some(value) = run.words.take(*letter) {
                seconds = Some(value * unit);
            }
        }
        let span = run.whole();
        match seconds {
            Some(time) if (0.0..=1e9).contains(&time) => return seconds,
            Some(_) => {
                let message = "the time of G4 is negative or beyond reason";
                run.report
                    .error("dwell-time", message, span)
                    .help("write a time from 0 to 1e9 s");
            }
            None if language.family == Family::Marlin => return Some(0.0),
            None => {
                let letters: Vec<_> = language
                    .dwell
                    .iter()
                    .map(|(letter, _)| char::from(*letter).to_string())
                    .collect();
                let help = format!(
                    "this controller takes the time from {}",
                    letters.join(" or ")
                );
                run.report
                    .error("dwell-time", "G4 without a time", span)
                    .help(help);
            }
        }
        None
    }

    /// Words that no code has used: they might mean motion.
    fn complain_about_rest(&self, run: &mut Run<'_, '_>) {
        if self.machine.controller.language.family != Family::Rs274 {
            // Numbers of tool offsets without a code that uses them.
            run.words.take(b'D');
            run.words.take(b'H');
        }
        while run.words.unused != 0 {
            let letter = b'A' + run.words.unused.trailing_zeros() as u8;
            run.words.take(letter);
            let span = run.words.span(letter, run.block);
            let message = format!("nothing in this block uses the {} word", letter as char);
            run.report
                .error("unused-word", message, span)
                .help("take it out, or write the word that it belongs to");
        }
    }

    /// Stops and the end come after the motion.
    fn end_of_block(&mut self, run: &mut Run<'_, '_>) {
        self.loads &= !std::mem::take(&mut self.loads_off);
        if !run.facts.boundary {
            return;
        }
        for index in 0..run.words.m.len() {
            let number = run.words.m[index].0;
            let kind = match self.m_kind(number) {
                Some(kind @ (ActionKind::Stop | ActionKind::End)) => kind,
                _ => continue,
            };
            self.ended |= kind == ActionKind::End;
            run.act(kind, f64::from(number) / 10.0);
        }
    }

    /// True when F counts for the motion in force.
    pub(super) fn obeys_feed(&self) -> bool {
        match self.modal.motion {
            Motion::None => false,
            Motion::Rapid => self.machine.controller.language.rapid_uses_feed,
            Motion::Linear | Motion::ArcCw | Motion::ArcCcw => true,
        }
    }

    /// Whether the feed mode in force is `mode`.
    pub(super) fn feed_mode_is(&self, mode: FeedMode) -> bool {
        self.modal.feed_mode == mode
    }
}
