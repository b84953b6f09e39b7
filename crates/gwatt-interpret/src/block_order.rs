//! What the words of a block do, in LinuxCNC's order of execution: feed mode, F, S, T,
//! tool change, spindle, coolant, dwell, plane, units, offsets, path mode,
//! distance mode, reference points and offsets, motion, stop.

use super::control::{Control, Run};
use gwatt_motion::ActionKind;

impl Control<'_> {
    /// A block of any words, which are filled in; `errors` from before that.
    pub(super) fn general(&mut self, run: &mut Run<'_, '_>, errors: u64) {
        if self.macro_call(run) {
            return;
        }
        if self.program_number(run) {
            run.words.unused = 0;
            return;
        }
        let dwell_s = self.dwell_time(run);
        self.feed_mode(run);
        self.read_feed(run);
        self.speed_and_tool(run);
        self.m_words(run);
        if let Some(dwell_s) = dwell_s {
            self.dwell(run, dwell_s);
        }
        self.settings(run);
        self.note_queue_and_spindle(run);
        self.turn_knobs(run);
        self.lathe_corner(run);
        self.motion_in_mode(run);
        if run.report.diagnostics.errors == errors {
            self.complain_about_rest(run);
        }
        self.end_of_block(run);
    }

    /// Stops and the end come after the motion.
    pub(super) fn end_of_block(&mut self, run: &mut Run<'_, '_>) {
        self.loads.settle(run.own_steps());
        self.beam_at_empty_line(run);
        if !run.facts.boundary && run.facts.stop_word.is_none() {
            return;
        }
        if run.words.m.iter().any(|(number, _)| *number == 60) {
            self.change_tool_at_end(run);
        }
        for index in 0..run.words.m.len() {
            let number = run.words.m[index].0;
            let Some(kind @ (ActionKind::Stop | ActionKind::End)) = self.m_kind(number) else {
                continue;
            };
            if kind == ActionKind::End && self.is_grbl() {
                self.reset_modes(run);
            }
            self.ended |= kind == ActionKind::End;
            if self.loads.are_hidden() {
                // However long it lasts, what is on draws meanwhile.
                self.dwell(run, 0.0);
                self.loads.see();
            }
            run.act(kind, f64::from(number) / 10.0);
        }
    }
}
