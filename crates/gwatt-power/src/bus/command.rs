//! Words of the program that speak to the spindle: kept until the moves before
//! them are through, then carried out.

use super::SpindleBus;
use super::queued::Queued;
use crate::Assessment;
use crate::spindle_state::SpindleState;
use crate::spindle_trace::SpindleSpan;
use crate::surface_speed::Surface;
use gwatt_machine::SpindleWait;
use gwatt_motion::{Action, ActionKind, Move};

/// Commands that wait before it is looked whether they still must.
const QUEUE: usize = 4096;

impl SpindleBus<'_> {
    /// Takes an action.
    pub fn act(&mut self, action: &Action, sink: &mut impl FnMut(&Move, &Assessment, &[u8])) {
        let speaks = match action.kind {
            ActionKind::Spindle
            | ActionKind::SpindleRpm
            | ActionKind::SurfaceSpeed
            | ActionKind::SpindleClamp
            | ActionKind::SpindleCenter
            | ActionKind::TapSpeed
            | ActionKind::ToolLoaded
            | ActionKind::ToolSelect
            | ActionKind::ToolChange
            | ActionKind::ToolChangeInMotion
            | ActionKind::Stop
            | ActionKind::End => true,
            ActionKind::Other => {
                matches!(action.value, 13.0 | 14.0 | 19.0) || is_range(action.value)
            }
            _ => false,
        };
        if speaks {
            self.queue.push_back(Queued {
                after: self.pushed,
                action: *action,
            });
            if self.queue.len() > QUEUE {
                self.catch_up(None, sink);
            }
            self.reserve_w = [f64::INFINITY; 2];
        }
    }

    /// Carries out the commands before the next move. What is asked for before a stop that takes a
    /// time of its own comes off during that.
    pub(super) fn catch_up(
        &mut self,
        next: Option<&Move>,
        sink: &mut impl FnMut(&Move, &Assessment, &[u8]),
    ) {
        if let Some(line) = self.unsure
            && next.is_none_or(|mv| mv.line != line)
        {
            (self.unsure, self.before_w) = (None, None);
            self.switched_on = self.direction != 0.0;
        }
        while let Some(queued) = self.queue.front()
            && queued.after <= self.handed
        {
            let action = queued.action;
            self.queue.pop_front();
            if self.may_act_after(&action, next) {
                if self.asked.is_some_and(|line| line != action.line) {
                    // It was asked for before this block: it comes first.
                    self.set_off(sink, next, false);
                }
                self.keep_before();
                self.unsure = Some(action.line);
            }
            if action.kind == ActionKind::Stop {
                self.set_off(sink, next, true);
            }
            self.carry_out(&action);
        }
    }

    /// Whether a word may act after the motion that comes next, which is that of its block.
    fn may_act_after(&self, action: &Action, next: Option<&Move>) -> bool {
        let turns = !matches!(
            action.kind,
            ActionKind::ToolLoaded
                | ActionKind::ToolSelect
                | ActionKind::SpindleCenter
                | ActionKind::TapSpeed
        );
        // Lines of other texts have the same numbers: what is taken for one counts higher.
        turns
            && !self.machine.controller.language.spindle_before_motion
            && next.is_some_and(|mv| mv.line == action.line)
    }

    /// Keeps what the spindle does before a word that may act after the motion.
    fn keep_before(&mut self) {
        let [own, lower] = self.may_draw();
        let before = self.before_w.unwrap_or([own, lower]);
        self.before_w = Some([widest(before[0], own), widest(before[1], lower)]);
    }

    /// Largest and smallest power from now on at the largest overrides, and at lower ones, W.
    fn may_draw(&self) -> [[f64; 2]; 2] {
        let own = self.states[0].henceforth(&self.motor);
        let lower = self.slower.as_ref().map(|it| it.henceforth(&self.motor));
        [own, widest(own, lower.unwrap_or(own))]
    }

    /// A new speed is asked for before or after the motion of its block: from any speed that the
    /// spindle may have had meanwhile.
    fn command_unsure(&mut self, target: f64) {
        if self.states[0].is_steady() {
            self.states[0].command(&self.motor, target);
            self.states[0].blur();
        } else {
            let range = self.states[0].range();
            self.states[0].wander(&self.motor, range, target);
        }
        if let Some(slower) = &mut self.slower {
            let range = slower.state.range();
            slower.wander(&self.motor, range, target, false);
        }
    }

    /// Extremes of a move at the largest overrides, and at lower ones, where a word of its block may
    /// act after it: with what the spindle did before the word, and all that it may do after it.
    pub(super) fn either_order(&self, covered: Option<[f64; 2]>) -> Option<[[f64; 2]; 2]> {
        let before = self.before_w?;
        let after = self.may_draw();
        let [own, lower] = [0, 1].map(|i| widest(before[i], after[i]));
        let covered = covered.unwrap_or(own);
        Some([widest(own, covered), widest(lower, covered)])
    }

    pub(super) fn carry_out(&mut self, action: &Action) {
        let value = action.value;
        match action.kind {
            ActionKind::SpindleRpm => self.rpm = Some(value),
            ActionKind::SpindleClamp => {
                self.clamp_rpm = value;
                return;
            }
            ActionKind::SpindleCenter => {
                self.center_mm = value;
                return;
            }
            ActionKind::SurfaceSpeed => {
                self.surface = (value > 0.0).then_some(Surface {
                    speed_mm_s: value,
                    clamp_rpm: self.clamp_rpm,
                    center_mm: self.center_mm,
                    sign: 1.0,
                });
            }
            ActionKind::TapSpeed if value == 0.0 => return self.tapped(),
            ActionKind::TapSpeed => self.tap_rpm = Some(value),
            ActionKind::ToolLoaded => {
                self.cutting.load(value);
                return;
            }
            ActionKind::ToolSelect => {
                self.cutting.select(value);
                return;
            }
            ActionKind::ToolChange | ActionKind::ToolChangeInMotion => {
                // The spindle stops for it, on most machines.
                self.states[0].lose(&self.motor);
                if let Some(slower) = &mut self.slower {
                    slower.state.lose(&self.motor);
                }
                self.states
                    .iter_mut()
                    .for_each(|state| state.pass([0.0, 0.0]));
                self.wait_unknown();
                return;
            }
            ActionKind::Stop => return self.wait_unknown(),
            ActionKind::Other if is_range(value) => {
                // Gears are changed at low speed, or at rest.
                let target = self.states[0].target();
                if target != 0.0 {
                    let range = [target.min(0.0), target.max(0.0)];
                    self.wander(range, target);
                    self.wait_unknown();
                }
                return;
            }
            ActionKind::End => self.direction = 0.0,
            _ if value == 3.0 || value == 13.0 => self.direction = 1.0,
            _ if value == 4.0 || value == 14.0 => self.direction = -1.0,
            _ => self.direction = 0.0,
        }
        self.lost &= matches!(
            action.kind,
            ActionKind::SpindleRpm | ActionKind::SurfaceSpeed
        );
        self.asked = Some(action.line);
    }

    /// A tap is over, and its axis stands, and the spindle with it. Where that turned before, it
    /// may turn on by itself or wait for a word.
    fn tapped(&mut self) {
        self.tap_rpm = None;
        self.asked = None;
        self.lost = self.direction != 0.0;
        let slower = self.slower.as_mut().map(|slower| &mut slower.state);
        for (side, state) in self.states.iter_mut().chain(slower).enumerate() {
            let factor = self.overrides[usize::from(side == 1)].spindle;
            let rpm = self.rpm.unwrap_or(self.spindle.max_rpm) * factor;
            state.follow(self.direction * rpm.min(self.spindle.max_rpm));
            state.lose(&self.motor);
        }
        let nominal = self.target(self.overrides[1].spindle);
        if let Some(shown) = &mut self.shown {
            shown.state.follow(0.0);
            shown.state.command(&self.motor, nominal);
        }
        self.switched_on = self.direction != 0.0;
    }

    /// Something takes a time that is not known.
    pub(super) fn wait_unknown(&mut self) {
        self.states[0].pass([0.0, f64::INFINITY]);
        if let Some(slower) = &mut self.slower {
            slower.state.pass([0.0, f64::INFINITY]);
        }
    }

    /// The speed that is asked for now, 1/min, at an override.
    pub(super) fn target(&self, factor: f64) -> f64 {
        let max = self.spindle.max_rpm;
        if let Some(rpm) = self.tap_rpm {
            // An override below 100 % may not act on it.
            return (rpm * factor.max(1.0)).clamp(-max, max);
        }
        // Without S what was in force before the program.
        let rpm = self.rpm.unwrap_or(max);
        self.direction * (rpm * factor).min(max)
    }

    /// Sets off the run that was asked for; rows of runs that do not fit, and of others where
    /// they have to be shown, as no move does it.
    pub(super) fn set_off(
        &mut self,
        sink: &mut impl FnMut(&Move, &Assessment, &[u8]),
        next: Option<&Move>,
        shows: bool,
    ) {
        let Some(line) = self.asked.take() else {
            return;
        };
        self.commands = self.commands.wrapping_add(1);
        let in_step = self.tap_rpm.is_some();
        let unsure = self.unsure == Some(line) && !in_step;
        let was_on = self.switched_on;
        self.switched_on = (self.direction != 0.0 || in_step) && (was_on || !unsure);
        for side in 0..2 {
            let target = self.target(self.overrides[side].spindle);
            if unsure && side == 0 {
                self.command_unsure(target);
            } else {
                self.states[side].command(&self.motor, target);
            }
            if let (0, false, Some(slower)) = (side, unsure, &mut self.slower) {
                slower.command(&self.motor, target);
            }
            if self.lost {
                // A speed alone does not say whether it turns.
                self.states[side].lose(&self.motor);
                if let (0, Some(slower)) = (side, &mut self.slower) {
                    slower.state.lose(&self.motor);
                }
            }
        }
        let nominal = self.target(self.overrides[1].spindle);
        if let Some(shown) = &mut self.shown {
            shown.state.command(&self.motor, nominal);
        }
        // Whether a word that stops it is waited for, no profile says.
        let stops = self.direction == 0.0 && self.tap_rpm.is_none();
        let blocks = self.spindle.wait == SpindleWait::Blocks && stops;
        let unknown = blocks || self.spindle.wait == SpindleWait::Unknown;
        if unknown && !self.states[0].is_steady() {
            self.wait_unknown();
        }
        let slower = self.slower.as_ref().map(|slower| &slower.state);
        if self.states[..1]
            .iter()
            .chain(slower)
            .all(SpindleState::is_steady)
        {
            // It does what it did: the moves next to it show that.
            return;
        }
        let mut demand = self.alone(next, self.states[0].henceforth(&self.motor));
        if let (true, Some(slower)) = (self.model.fits(&demand), &self.slower) {
            // Turned down, the run before has come further.
            demand = self.alone(next, slower.henceforth(&self.motor));
        }
        if shows || !self.model.fits(&demand) {
            self.row(
                (line, next),
                demand,
                SpindleSpan::steady(0.0, 0.0),
                0.0,
                sink,
            );
        }
    }
}

/// The larger of two largest powers, the smaller of two smallest.
fn widest(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0].max(b[0]), a[1].min(b[1])]
}

/// M40 to M45: ranges of the spindle's gear.
fn is_range(number: f64) -> bool {
    (40.0..=45.0).contains(&number)
}
