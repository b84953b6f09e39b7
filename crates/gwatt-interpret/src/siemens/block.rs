//! The order of execution of a block: modes, feed, spindle, tool, M words, then
//! motion, then a cycle or a modal call, then stops and ends.

use super::code::Code;
use super::cycle_call::Call;
use super::{Called, Siemens};
use crate::code::{GCode, Motion};
use crate::control::{Control, Run};
use crate::facts::CalledCycle;
use crate::jump::{Siemens as Go, Transfer};
use crate::macro_block::not_finite;
use crate::own_state::OwnState;
use crate::report::Report;
use gwatt_machine::units::{MM_PER_INCH, SECONDS_PER_MINUTE};
use gwatt_machine::{AxisKind, PathMode};
use gwatt_motion::{ActionKind, FeedMode, Step};
use gwatt_syntax::Block;

use super::reading::Reading;
use crate::expression::{Cursor, Grammar, Lexis};

impl Control<'_> {
    /// Reads a block that is more than plain words. True when the program does
    /// not go on at the next line.
    #[cold]
    pub(crate) fn siemens_words(&mut self, block: &mut Block, report: &mut Report<'_, '_>) -> bool {
        let Some(mut state) = self.own.take_siemens() else {
            return false;
        };
        let text = report.text.get(..block.text_end as usize);
        let mut reading = Reading {
            control: self,
            state: &mut state,
            cursor: Cursor::new(text.unwrap_or(report.text), Lexis::Sinumerik),
            notes: Vec::new(),
        };
        let read = match not_finite(block) {
            Some(fault) => Err(fault),
            None => reading.read(block),
        };
        for (rule, message, span) in reading.notes {
            report.note_once(rule, message, span);
        }
        let mut transfers = false;
        match read {
            Ok(go) => {
                transfers = go.is_some();
                self.transfer = go.map(Transfer::Siemens);
            }
            Err(fault) => {
                report
                    .error(fault.rule, fault.message, fault.span)
                    .help(fault.help);
                // Nothing of it is executed.
                block.words.clear();
                state.active = true;
                state.begin_block();
            }
        }
        self.ended |= state.is_uncalled();
        self.own = OwnState::Siemens(state);
        self.settle_siemens();
        transfers
    }

    /// The value of an expression.
    pub(crate) fn siemens_value(&mut self, text: &[u8]) -> Option<f64> {
        let mut state = self.own.take_siemens()?;
        let mut reading = Reading {
            control: self,
            state: &mut state,
            cursor: Cursor::new(text, Lexis::Sinumerik),
            notes: Vec::new(),
        };
        let value = reading.whole();
        self.own = OwnState::Siemens(state);
        value
    }

    /// Plain words get the offsets of the frame; where more is in force, each
    /// block takes the long way.
    pub(crate) fn settle_siemens(&mut self) {
        let OwnState::Siemens(state) = &mut self.own else {
            return;
        };
        let shift = state.plain_shift();
        state.special = shift.is_none()
            || !state.adrift.is_empty()
            || state.modal_call.is_some()
            || state.diameter
            || state.returned
            || state.feed_in_mm
            || state.feed_factor != 1.0
            || state.rounds.is_some()
            || state.limits.are_due()
            || state.smoothing.rounds_feeds_more()
            || state.limits.rapids_may_be_slower
            || matches!(self.modal.motion, Motion::None | Motion::Special(_));
        if let Some(shift) = shift {
            self.position.set_shifts(&shift);
        }
    }

    /// Executes a block that is more than plain motion.
    #[cold]
    pub(crate) fn siemens_block(&mut self, run: &mut Run<'_, '_>) {
        if let Some(mut state) = self.own.take_siemens() {
            self.siemens_order(&mut state, run);
            self.own = OwnState::Siemens(state);
        }
        self.settle_siemens();
    }

    fn siemens_order(&mut self, state: &mut Siemens, run: &mut Run<'_, '_>) {
        let errors = run.report.diagnostics.errors;
        let before = run.steps.len();
        if std::mem::take(&mut state.returned) {
            // What SAVE has given back.
            self.raise_limits(&state.limits);
            state.limits.due = true;
        }
        self.program_end(state, run);
        let dwell_s = self.siemens_dwell(run);
        self.spindle_modes(state, run);
        self.feed_mode(run);
        self.siemens_feed(state, run);
        self.spindles(state, run);
        self.siemens_speed(state, run);
        self.raise_speed(state);
        if let Some(word) = run
            .words
            .word(b'D', run.block)
            .filter(|word| word.value >= 0.0)
        {
            self.choice.number = Some(word.value as u32);
        }
        self.m_words(run);
        self.orient(state, run);
        let limit_rpm = state.spindles.limit_rpm();
        self.spindle.unknown_up_to_rpm = limit_rpm.filter(|_| state.surface_speed);
        self.tell_spindle(run);
        if let Some(dwell_s) = dwell_s {
            self.dwell(run, dwell_s);
        }
        self.turn_knobs(run);
        self.dynamic_mode(state, run);
        self.siemens_settings(state, run);
        if run.report.diagnostics.errors != errors {
            return;
        }
        if state.extra.turns_limit {
            run.facts.turns_knob = true;
            self.raise_limits(&state.limits);
        }
        let mode = self.modal.path_mode;
        let g9 = GCode::Siemens(Code::ExactOnce);
        if run.words.g.iter().any(|(code, ..)| *code == g9) {
            self.modal.path_mode = PathMode::ExactStop;
        }
        let cycle = state.extra.cycle.take();
        if let Some(insert) = state.extra.corner.or(state.rounds) {
            self.ask_corner(insert);
        }
        self.siemens_motion(state, run);
        let moves = |step: &Step| matches!(step, Step::Move(mv) if mv.dwell_s == 0.0);
        let moved = run
            .steps
            .get(before..)
            .is_some_and(|steps| steps.iter().any(moves));
        if let Some(call) = cycle {
            run.facts.called = called(state, &call, run);
            self.cycle(state, &call, run);
        } else if moved && run.report.diagnostics.errors == errors {
            self.modal_call(state, run);
        }
        if state.extra.turns_limit || state.limits.are_due() {
            self.settle_limits(&mut state.limits);
        }
        run.facts.feeds_are_rounded |= state.smoothing.rounds_feeds_more();
        run.facts.rapids_may_be_slower |= state.limits.rapids_may_be_slower;
        self.modal.path_mode = mode;
        if state.extra.blends {
            self.choose_path_mode(PathMode::LookAhead);
        }
        if run.report.diagnostics.errors == errors {
            self.complain_about_rest(run);
        }
        self.end_of_block(run);
    }

    /// M17, M2 and M30 in a subprogram return to its caller ("Return to the
    /// calling program").
    fn program_end(&mut self, state: &Siemens, run: &mut Run<'_, '_>) {
        if !state.is_called() {
            return;
        }
        let before = run.words.m.len();
        run.words
            .m
            .retain(|(number, _)| !matches!(*number, 20 | 170 | 300));
        if run.words.m.len() < before {
            self.transfer = Some(Transfer::Siemens(Go::Return));
            run.facts.fixed = Some("it returns from a subprogram");
        }
    }

    /// G4 ("Dwell time"): F in seconds, S in revolutions of the spindle.
    fn siemens_dwell(&self, run: &mut Run<'_, '_>) -> Option<f64> {
        if run.words.groups & GCode::Dwell.group() == 0 {
            return None;
        }
        run.facts.dwell_takes_feed = true;
        let span = run.whole();
        let seconds = run.words.take(b'F');
        let revolutions = run.words.take(b'S');
        let time = match (seconds, revolutions) {
            (Some(seconds), None) => seconds,
            (None, Some(turns)) if self.followed_rpm() > 0.0 => {
                turns * SECONDS_PER_MINUTE / self.followed_rpm()
            }
            (None, Some(_)) => {
                run.report
                    .error("dwell-time", "G4 S, but no spindle speed is in force", span)
                    .help("write S before, or the time as G4 F…");
                return None;
            }
            _ => {
                run.report
                    .error("dwell-time", "G4 without a time", span)
                    .help("write G4 F with seconds, or G4 S with revolutions");
                return None;
            }
        };
        if (0.0..=1e9).contains(&time) {
            return Some(time);
        }
        let message = "the time of G4 is negative or beyond reason";
        run.report
            .error("dwell-time", message, span)
            .help("write a time from 0 to 1e9 s");
        None
    }

    /// G96 and G97 with their kin ("Constant cutting rate"): they choose how F
    /// is meant too.
    fn spindle_modes(&mut self, state: &mut Siemens, run: &mut Run<'_, '_>) {
        for (code, number, _) in &run.words.g {
            let per_revolution = match code {
                GCode::Siemens(Code::SurfaceSpeed { per_revolution }) => {
                    state.surface_speed = true;
                    *per_revolution
                }
                GCode::Siemens(Code::ConstantSpeed { per_revolution }) => {
                    state.surface_speed = false;
                    *per_revolution
                }
                GCode::FeedMode(_) => {
                    state.surface_speed = false;
                    continue;
                }
                _ => continue,
            };
            let mode = if per_revolution {
                FeedMode::PerRevolution
            } else {
                FeedMode::PerMinute
            };
            if mode != self.modal.feed_mode {
                self.modal.feed = None;
            }
            self.modal.feed_mode = mode;
            self.modal.feed_mode_word = *number;
        }
    }

    fn siemens_feed(&mut self, state: &mut Siemens, run: &mut Run<'_, '_>) {
        for (code, number, _) in &run.words.g {
            if let GCode::Units { .. } = code {
                // "Inch or metric dimensions": G70 does not touch F.
                state.feed_in_mm = *number == 700;
            }
        }
        self.read_feed(run);
        if state.feed_in_mm {
            run.facts.feed_mm_per_unit = 1.0;
            if run.facts.feed_word.is_some()
                && let Some(feed) = &mut self.modal.feed
            {
                feed.mm_per_unit = 1.0;
            }
        }
    }

    /// S and T. Under G96, S is a cutting speed: the spindle is taken at its
    /// limit, where a feed per revolution is fastest.
    fn siemens_speed(&mut self, state: &Siemens, run: &mut Run<'_, '_>) {
        if state.surface_speed {
            let span = run.whole();
            let changed = run.words.take(b'S').is_some();
            match state.spindles.limit_rpm() {
                Some(limit) => {
                    let message = "under G96 the spindle is taken at its limit (LIMS)";
                    run.report.note_once("surface-speed", message, span);
                    self.modal.spindle_rpm = limit;
                    if changed {
                        run.act(ActionKind::SpindleSpeed, limit);
                    }
                }
                None if changed => {
                    run.report
                        .error(
                            "surface-speed",
                            "G96 without a limit of the spindle's speed",
                            span,
                        )
                        .help("write LIMS= before it");
                }
                None => {}
            }
        }
        self.speed_and_tool(run);
    }

    fn siemens_settings(&mut self, state: &mut Siemens, run: &mut Run<'_, '_>) {
        self.motion_word(run);
        self.choose_radius(state, run);
        self.compensation_words(run);
        for index in 0..run.words.g.len() {
            let (code, number, span) = run.words.g[index];
            match code {
                GCode::Plane(plane) => self.modal.plane = plane,
                GCode::Units { mm_per_unit } => self.modal.mm_per_unit = mm_per_unit,
                GCode::Absolute(absolute) => self.modal.absolute = absolute,
                GCode::PathMode => {
                    self.choose_path_mode(if number == 600 {
                        PathMode::ExactStop
                    } else {
                        PathMode::LookAhead
                    });
                    state.smoothing.by_distance = number > 6400;
                    run.act(ActionKind::PathMode, f64::from(number) / 10.0);
                }
                GCode::Siemens(Code::Suppress) => {
                    state.extra.machine_coordinates = true;
                    // In this block alone.
                    state.active = true;
                }
                GCode::Siemens(Code::Limits) => {
                    // Limits of the work area or of the spindle: data.
                    run.words.unused &= !super::super::letters::AXIS_LETTERS;
                    run.words.take(b'S');
                }
                GCode::WorkOffset(offset) => {
                    // G500, which may have an offset of its own, is none of them.
                    self.position.datums.own_system = Some(u16::from(offset) + 1);
                    if offset < 2 {
                        continue;
                    }
                    let message = "without a parameter file all work offsets are taken as 0";
                    run.report.note_once("no-offsets", message, span);
                }
                _ => {}
            }
        }
        run.words.take(b'H');
    }

    /// DYNNORM and similar words act in their block ("Dynamic response").
    fn dynamic_mode(&mut self, state: &Siemens, run: &mut Run<'_, '_>) {
        let Some((group, level)) = state.extra.level else {
            return;
        };
        run.facts.turns_knob = true;
        if self.compensation.is_some() {
            let span = run.whole();
            run.report
                .error(
                    "compensation",
                    "a dynamic mode under tool radius compensation is not followed",
                    span,
                )
                .help("write it before G41 or G42, or after G40 and the move after that");
            return;
        }
        self.turn_to_level(group, level, run);
    }

    fn choose_path_mode(&mut self, asked: PathMode) {
        let exact = self.machine.path.mode == Some(PathMode::ExactStop);
        self.modal.path_mode = if exact { PathMode::ExactStop } else { asked };
    }

    /// MCALL: after each block that moves.
    fn modal_call(&mut self, state: &mut Siemens, run: &mut Run<'_, '_>) {
        let Some(modal) = &state.modal_call else {
            return;
        };
        if modal.depth != state.scopes.len() {
            return;
        }
        run.facts.fixed = Some("it calls a cycle or a subprogram (MCALL)");
        match modal.what.clone() {
            Called::Cycle(call) => {
                run.facts.called = Some(CalledCycle {
                    own_steps: run.steps.len(),
                    plain: call.is_plain(),
                    pattern: false,
                    set_at: Some(modal.set_at),
                });
                self.cycle(state, &call, run);
            }
            Called::Program { name, arguments } => {
                state.pending = arguments;
                self.transfer = Some(Transfer::Siemens(Go::Call {
                    name,
                    times: 1,
                    again: false,
                }));
            }
        }
    }

    /// Millimetres in a unit of an axis word; degrees are degrees.
    pub(super) fn unit_of(&self, axis: usize) -> f64 {
        let rotary = self
            .machine
            .axes
            .get(axis)
            .and_then(Option::as_ref)
            .is_some_and(|data| data.kind == AxisKind::Rotary);
        if rotary { 1.0 } else { self.modal.mm_per_unit }
    }

    /// Whether lengths are in inches.
    pub(super) fn in_inches(&self) -> bool {
        self.modal.mm_per_unit == MM_PER_INCH
    }
}

/// What is known of a cycle that a block calls itself: a pattern runs the one that MCALL has
/// set.
fn called(state: &Siemens, call: &Call, run: &Run<'_, '_>) -> Option<CalledCycle> {
    let own_steps = run.steps.len();
    if !call.is_pattern() {
        return Some(CalledCycle {
            own_steps,
            plain: call.is_plain(),
            pattern: false,
            set_at: None,
        });
    }
    let modal = state.modal_call.as_ref();
    match &modal
        .filter(|modal| modal.depth == state.scopes.len())?
        .what
    {
        Called::Cycle(cycle) => Some(CalledCycle {
            own_steps,
            plain: cycle.is_plain(),
            pattern: true,
            set_at: modal.map(|modal| modal.set_at),
        }),
        Called::Program { .. } => None,
    }
}
