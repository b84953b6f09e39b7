//! The spindle at 100 % over time, for series and pictures.
//!
//! Output: a [`Turning`] for each move that takes time, in the order of the
//! program, and for each wait of the axes among them.

use super::SpindleBus;
use super::follow::Followed;
use super::shown::{Course, Turning};
use crate::motion::Motion;
use crate::spindle_state::SpindleState;
use crate::{Assessment, Assessor};
use gwatt_motion::{Move, MoveKind};

impl Assessor<'_> {
    /// Takes what the spindle does during the moves passed on since, and during
    /// the waits among them; `None` where the machine has none. It is known
    /// later than the motion.
    pub fn turnings(&mut self) -> Option<std::vec::Drain<'_, Turning>> {
        let shown = self.bus.as_mut()?.shown.as_mut()?;
        Some(shown.turnings.drain(..))
    }
}

impl SpindleBus<'_> {
    /// Shows it during a move, which is judged.
    pub(super) fn show(&mut self, mv: &Move, judged: &Assessment, followed: Option<&Followed>) {
        let taken = self.taken(mv);
        let credited_w = self.credited_w();
        let Some(shown) = &mut self.shown else { return };
        let target = followed.and_then(|it| it.target);
        if let Some(target) = target {
            shown.state.command(&self.motor, target);
        }
        let surface = followed.and_then(|it| it.surface);
        let course = match (followed, surface) {
            (Some(it), _) if !mv.unknown_start.is_empty() => {
                let [most_w, least_w] = it.extremes;
                Course::Unknown([most_w.max(0.0), (-least_w).max(0.0)])
            }
            (_, Some((surface, _))) => Course::Surface(surface),
            _ => course(&shown.state),
        };
        let duration_s = judged.duration_s;
        if duration_s.is_finite() && duration_s > 0.0 {
            shown.turnings.push(Turning {
                duration_s,
                rest: None,
                course,
                power: self.motor.power,
                converter: self.spindle.converter,
                base_load_w: self.spindle.base_load_w,
                credited_w,
                cutting_w: taken.power_w / self.spindle.efficiency,
                cutting_w_s_mm: judged.spindle.cutting_w_s_mm,
            });
        }
        match surface {
            Some((_, end_rpm)) => shown.state.follow(end_rpm),
            None => shown.state.pass([duration_s; 2]),
        }
    }

    /// Shows a wait before a move, whose axes stand for so long.
    pub(super) fn show_wait(&mut self, mv: &Move, duration_s: f64) {
        let place = self.place(Some(mv));
        let credited_w = self.credited_w();
        let Some(shown) = &mut self.shown else { return };
        if let Some(place) = place
            && duration_s > 0.0
        {
            shown.turnings.push(Turning {
                duration_s,
                rest: Some(Motion::rest(place, duration_s)),
                course: course(&shown.state),
                power: self.motor.power,
                converter: self.spindle.converter,
                base_load_w: self.spindle.base_load_w,
                credited_w,
                cutting_w: 0.0,
                cutting_w_s_mm: 0.0,
            });
        }
        if mv.kind == MoveKind::Tap {
            shown.state.pass([duration_s; 2]);
        } else {
            shown.state.settle();
        }
    }
}

/// How it turns in a state that is known, as it is at 100 %.
fn course(state: &SpindleState) -> Course {
    match state.run() {
        Some((trace, since_s)) => Course::Run(trace.clone(), since_s),
        None => Course::Steady(state.target()),
    }
}
