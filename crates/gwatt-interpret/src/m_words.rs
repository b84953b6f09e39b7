//! M words, S and T: actions, and the loads that they switch.

use super::control::{Control, Run};
use super::facts::{TOOL_CHANGE_UNKNOWN, ToolWords};
use gwatt_machine::ToolChange;
use gwatt_motion::{ActionKind, Step};
use gwatt_syntax::Word;
use gwatt_syntax::source::Span;

/// M29 of Fanuc's controls, times ten: the tap after it is rigid.
const RIGID: u16 = 290;

/// M19, times ten.
const ORIENT: u16 = 190;

/// M70 of SINUMERIK, times ten: the spindle becomes an axis.
const AXIS: u16 = 700;

impl Control<'_> {
    /// Whether canned cycles are those of Fanuc and its relatives.
    fn motion_survives_cycles(&self) -> bool {
        let family = self.machine.controller.language.family;
        family.facts().motion_survives_cycles
    }

    pub(super) fn speed_and_tool(&mut self, run: &mut Run<'_, '_>) {
        self.spindle_mode(run);
        self.look_for_laser();
        self.beam_between_lines(run);
        let other = run
            .words
            .m
            .iter()
            .any(|(number, _)| self.m_kind(*number) == Some(ActionKind::Other))
            && !self.rules.free_m_words
            // Such words stand next to S and T: `S580 M13`.
            && !self.dialect().other_m;
        // S of M19 is an angle, or a speed to turn to it at: it makes no feed slower.
        let orients = !self.rules.places_in_parameters
            && run.words.m.iter().any(|(number, _)| *number == ORIENT);
        if let Some(value) = run.words.take(b'S')
            && !other
            && !(orients && value.abs() <= self.modal.spindle_rpm)
        {
            self.set_speed(value, run);
            let kind = self.kind_of_speed(run);
            self.switches.laser_seen |= kind == ActionKind::SpeedInMotion && self.feeds(run);
            run.act(kind, value);
            self.note_spindle(run);
        }
        if let Some(tool) = run.words.take(b'T')
            && !other
        {
            self.select_tool(tool, run);
            if !self.changes_tool_at_end(run) {
                run.act(ActionKind::ToolSelect, tool);
            }
            run.facts.selects_tool = true;
        }
    }

    pub(super) fn note_spindle(&self, run: &mut Run<'_, '_>) {
        if self.machine.spindle.is_none() {
            let span = run.whole();
            let message = "the machine file describes no spindle: its power is not counted";
            run.report.note_once("no-spindle", message, span);
        }
    }

    /// What an M word does; `None` if it is not known.
    pub(super) fn m_kind(&self, number: u16) -> Option<ActionKind> {
        let value = f64::from(number) / 10.0;
        let word = (b'M', value);
        let is_load = || {
            self.machine
                .loads
                .iter()
                .any(|load| load.on.contains(&word) || load.off.contains(&word))
        };
        match number {
            0 | 10 | 600 => Some(ActionKind::Stop),
            20 | 300 => Some(ActionKind::End),
            170 if self.rules.free_m_words => Some(ActionKind::End),
            30 | 40 | 50 => Some(ActionKind::Spindle),
            60 => Some(ActionKind::ToolChange),
            70 | 80 | 90 => Some(ActionKind::Coolant),
            _ if self.is_ignored(number) || is_load() => Some(ActionKind::Other),
            // SINUMERIK: free M numbers are the machine builder's switches.
            _ if self.rules.free_m_words => Some(ActionKind::Other),
            _ if self.is_other_m(number) => Some(ActionKind::Other),
            _ => None,
        }
    }

    /// A word that moves no axis takes its arguments with it.
    fn other_word(&self, number: u16, span: Span, run: &mut Run<'_, '_>) {
        if self.is_other_m(number) && !self.is_ignored(number) {
            Self::note_other_m(number, span, run);
        }
        if !self.dialect().other_m || run.words.groups == 0 && !run.words.has_axes() {
            run.words.unused &= super::letters::AXIS_LETTERS;
        }
    }

    /// Whether the profile says that an M word (number × 10) moves no axis.
    pub(super) fn is_ignored(&self, number: u16) -> bool {
        number.is_multiple_of(10)
            && self
                .machine
                .controller
                .language
                .ignored_m
                .contains(&(number / 10))
    }

    pub(super) fn m_words(&mut self, run: &mut Run<'_, '_>) {
        for index in 0..run.words.m.len() {
            let (number, span) = run.words.m[index];
            let value = f64::from(number) / 10.0;
            // As it is written: on some controls two words change the tool.
            let mut words = run.block.words.iter();
            let written = words.find(|word| word.span == span);
            self.switch_loads(written.map_or(value, |word| word.value));
            self.switches.switch(number);
            run.facts.announces_tap |= number == RIGID && self.motion_survives_cycles();
            if self.moves_of_itself(b'M', number) {
                if number == 60 {
                    self.load_tool(number, span, run);
                }
                self.builder_moves(number, span, run);
                continue;
            }
            if self.rules.cycle_levels_by_m && self.osp_m_word(number, span, run) {
                continue;
            }
            if self.state_word(number, span, run) {
                continue;
            }
            if matches!(number, 820 | 830) && self.rules.extruder_modes {
                self.extruder_stated(number == 820);
                continue;
            }
            if self.subprogram_word(number, span, run) {
                continue;
            }
            let Some(kind) = self.m_kind(number) else {
                let word = Word {
                    letter: b'M',
                    value,
                    span,
                    number: span,
                };
                let language = &self.machine.controller.language;
                run.report.refused_m(word, language);
                continue;
            };
            match kind {
                ActionKind::Spindle => {
                    self.special.turn_spindle(number);
                    self.note_spindle(run);
                }
                ActionKind::ToolChange => {
                    self.load_tool(number, span, run);
                    self.change_tool(span, run);
                    continue;
                }
                ActionKind::Other
                    if self.rules.free_m_words && (self.is_ignored(number) || number == AXIS) => {}
                ActionKind::Other if self.rules.free_m_words => {
                    let message =
                        "M words of the machine's builder are taken as switches that move no axis";
                    run.report.note_once("builder-m", message, span);
                }
                // Arguments of a word that moves no axis, as in `M106 S255 P1`.
                ActionKind::Other => self.other_word(number, span, run),
                _ => {}
            }
            if !matches!(kind, ActionKind::Stop | ActionKind::End) {
                run.act(kind, value);
            } else if matches!(number, 0 | 10 | 20 | 300) && run.facts.stop_word.is_none() {
                run.facts.stop_word = Some(span);
            } else {
                run.facts.boundary = true;
            }
        }
    }

    /// M6: the tool changes before the motion of its block or after it; where that is not
    /// known, at either place.
    fn change_tool(&mut self, span: Span, run: &mut Run<'_, '_>) {
        let order = self.machine.controller.language.tool_change;
        let first = !run.facts.boundary;
        run.facts.boundary = true;
        match order {
            None if run.words.has_axes() => {
                run.facts.fixed = Some(TOOL_CHANGE_UNKNOWN);
                self.tool_change_moves(span, run);
                run.act(ActionKind::ToolChangeInMotion, 6.0);
                return;
            }
            Some(order)
                if first && !self.tool_change_moves_axes() && changes_nothing_else(order, run) =>
            {
                let select = run.block.words.iter().find(|word| word.letter == b'T');
                run.facts.tool_words = Some(ToolWords {
                    select: select.map(|word| word.span),
                    change: span,
                    order,
                });
            }
            _ => {}
        }
        if order != Some(ToolChange::AfterMotion) {
            self.tool_change_moves(span, run);
            run.act(ActionKind::ToolChange, 6.0);
        }
    }

    fn tool_change_moves_axes(&self) -> bool {
        let moving = self.machine.controller.language.tool_change_moves;
        moving.is_some_and(|axes| !axes.is_empty())
    }

    /// Whether the block changes the tool once the axes stand.
    fn changes_tool_at_end(&self, run: &Run<'_, '_>) -> bool {
        self.machine.controller.language.tool_change == Some(ToolChange::AfterMotion)
            && run.words.m.iter().any(|(number, _)| *number == 60)
    }

    /// A tool that changes once the axes stand, or perhaps then.
    pub(super) fn change_tool_at_end(&mut self, run: &mut Run<'_, '_>) {
        if self.changes_tool_at_end(run) {
            if run.facts.selects_tool {
                run.act(ActionKind::ToolSelect, f64::from(self.tools.selected));
            }
            self.tool_change_moves(run.whole(), run);
            run.act(ActionKind::ToolChange, 6.0);
        } else if run.steps.iter().any(is_in_motion) {
            self.tool_change_moves(run.whole(), run);
            run.act(ActionKind::ToolChangeInMotion, 6.0);
        }
    }

    /// Switches loads on and off.
    pub(super) fn switch_loads(&mut self, value: f64) {
        for (index, load) in self.machine.loads.iter().enumerate().take(32) {
            if load.on.contains(&(b'M', value)) {
                self.loads.switch_on(1 << index);
            }
            if load.off.contains(&(b'M', value)) {
                self.loads.switch_off(1 << index);
            }
        }
    }
}

fn is_in_motion(step: &Step) -> bool {
    matches!(step, Step::Action(action) if action.kind == ActionKind::ToolChangeInMotion)
}

/// Whether M6 may stand on a line of its own before or after the motion of its block, with T.
/// RS274/NGC has S before it ("Order of Execution").
fn changes_nothing_else(order: ToolChange, run: &Run<'_, '_>) -> bool {
    let mut others = run.words.m.iter().filter(|(number, _)| *number != 60);
    let once = run.words.m.len() == others.clone().count() + 1;
    let plain = |number: u16| order == ToolChange::BeforeMotion && matches!(number, 30..=90);
    once && others.all(|(number, _)| plain(*number))
        && !run.block.words.iter().any(|word| word.letter == b'S')
}
