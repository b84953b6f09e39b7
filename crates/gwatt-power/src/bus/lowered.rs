//! The spindle next to axes at lower overrides.

use crate::spindle_lower::LoweredRun;
use crate::spindle_state::{SpindleMotor, SpindleState};
use crate::spindle_trace::SpindleTrace;
use gwatt_motion::Move;
use gwatt_plan::period::Motion;

/// The spindle where the knobs may stand lower than at the largest.
#[derive(Debug)]
pub(super) struct Slower {
    pub state: SpindleState,
    /// The run from or to rest that stands for its run, see [`LoweredRun`].
    whole: Option<Box<SpindleTrace>>,
    /// Time at the largest overrides since the last command, s: of moves that the knob of
    /// feeds makes last longer, and that of rapids.
    grows_s: [f64; 2],
    /// It has followed X: turned down, its speed need not be lower by as much.
    followed: bool,
}

impl Slower {
    pub fn new(state: SpindleState) -> Self {
        Self {
            state,
            whole: None,
            grows_s: [0.0; 2],
            followed: false,
        }
    }

    /// A move passes, which takes so long at the largest overrides, at least and at most.
    pub fn pass(&mut self, mv: &Move, time_s: [f64; 2]) {
        self.state.pass(time_s);
        for (grows_s, grows) in self.grows_s.iter_mut().zip(mv.kind.knobs()) {
            *grows_s += if grows { time_s[1] } else { 0.0 };
        }
    }

    /// It follows X, and has that speed at the largest overrides.
    pub fn follow(&mut self, speed: f64) {
        self.state.follow(speed);
        self.followed = true;
    }

    /// It is somewhere between two speeds; `follows`: where X wants it.
    pub fn wander(&mut self, motor: &SpindleMotor, range: [f64; 2], target: f64, follows: bool) {
        self.state.wander(motor, range, target);
        self.whole = None;
        self.followed |= follows;
    }

    /// A new speed is asked for. When that is, and so at which speed, is not known where
    /// moves came between.
    pub fn command(&mut self, motor: &SpindleMotor, target: f64) {
        if self.grows_s != [0.0; 2] {
            self.state.pass([0.0, f64::INFINITY]);
        }
        self.grows_s = [0.0; 2];
        let was_steady = self.state.is_steady();
        let start = self.state.target();
        if std::mem::take(&mut self.followed) && target != 0.0 {
            let range = [start.min(0.0), start.max(0.0)];
            return self.wander(motor, range, target, false);
        }
        self.state.command(motor, target);
        self.whole = None;
        if self.state.on_run().is_none() {
            return;
        }
        // Turned down, a run is over sooner, and so is its first half where it turns round.
        if !was_steady {
            self.state.wander(motor, [0.0; 2], target);
        } else if start * target < 0.0 {
            self.state.blur();
        } else if start != 0.0 && target != 0.0 {
            let [from, to] = if target.abs() > start.abs() {
                [0.0, target]
            } else {
                [start, 0.0]
            };
            let from = Motion {
                speed: from,
                accel: 0.0,
            };
            self.whole = Some(Box::new(motor.trace(from, to)));
        }
    }

    /// The run that it is on, and the time since its command at the largest overrides, at
    /// least and at most, s.
    pub(super) fn run(&self) -> Option<(LoweredRun<'_>, [f64; 2])> {
        let (trace, since_s) = self.state.on_run()?;
        let whole = self.whole.as_deref();
        Some((LoweredRun { trace, whole }, since_s))
    }

    /// Largest and smallest power from now on, W.
    pub fn henceforth(&self, motor: &SpindleMotor) -> [f64; 2] {
        let [largest_w, least_w] = match self.run() {
            Some((run, [since_s, _])) => {
                let span = run.over(since_s, f64::INFINITY);
                [span.largest_w, span.least_w]
            }
            None => self.state.henceforth(motor),
        };
        [largest_w.max(0.0), least_w.min(0.0)]
    }

    /// How much of the time since the command grows as the override of a move falls, s;
    /// `None`: any.
    pub(super) fn scaled_s(&self, mv: &Move) -> Option<f64> {
        let [feed_s, rapid_s] = self.grows_s;
        match mv.kind.knobs() {
            [true, false] if rapid_s == 0.0 => Some(feed_s),
            [false, true] if feed_s == 0.0 => Some(rapid_s),
            _ => None,
        }
    }
}
