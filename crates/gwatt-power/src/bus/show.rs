//! The spindle at 100 % over time, for whoever wants to see it.
//!
//! Output: a [`Turning`] for each move that takes time, in the order of the
//! program, and for each wait of the axes among them.

use super::SpindleBus;
use super::follow::Followed;
use crate::instant::{Instant, SpindleInstant};
use crate::model::PowerModel;
use crate::motion::Motion;
use crate::spindle::SpindlePower;
use crate::spindle_state::SpindleState;
use crate::spindle_trace::SpindleTrace;
use crate::surface_speed::Surface;
use crate::{Assessment, Assessor};
use gwatt_motion::{Move, MoveKind};
use gwatt_plan::period;

/// Halvings that find where the clamp of G96 begins.
const HALVINGS: u32 = 60;

/// The spindle during one move, or while the axes wait.
#[derive(Debug, Clone)]
pub struct Turning {
    /// How long it lasts, s.
    pub duration_s: f64,
    /// The axes stand meanwhile, in this place.
    pub rest: Option<Motion>,
    course: Course,
    power: SpindlePower,
    converter: usize,
    base_load_w: f64,
    /// What of it takes of what is fed back.
    credited_w: f64,
    /// Electrical power of cutting, W, and by speed of the path, W/(mm/s).
    cutting_w: f64,
    cutting_w_s_mm: f64,
}

/// How it turns.
#[derive(Debug, Clone)]
enum Course {
    Steady(f64),
    /// On a run, so many s after its command.
    Run(SpindleTrace, f64),
    /// G96.
    Surface(Surface),
}

/// What is shown.
#[derive(Debug)]
pub(crate) struct Shown {
    /// Where the spindle is: after a tap's reversal, which its axis does not
    /// wait for to the end, a little later than for the figures.
    pub(super) state: SpindleState,
    pub(super) turnings: Vec<Turning>,
}

impl Default for Shown {
    fn default() -> Self {
        Self {
            state: SpindleState::steady(0.0),
            turnings: Vec::new(),
        }
    }
}

impl Assessor<'_> {
    /// Takes what the spindle does during the moves handed on since, and during
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
        let course = match surface {
            Some((surface, _)) => Course::Surface(surface),
            None => course(&shown.state),
        };
        let duration_s = judged.duration_s;
        // The motion of others is not shown either.
        let known = duration_s.is_finite() && mv.unknown_start.is_empty();
        if known && duration_s > 0.0 {
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

impl Turning {
    /// Instants between two at which its law changes, s after its beginning.
    /// `x_mm` gives where X is then.
    #[must_use]
    pub fn switches_s(&self, [from, to]: [f64; 2], x_mm: impl Fn(f64) -> f64) -> Vec<f64> {
        match &self.course {
            Course::Steady(_) => Vec::new(),
            Course::Run(trace, since_s) => {
                let switches = trace.instants().map(|t| t - since_s);
                switches.filter(|t| *t > from && *t < to).collect()
            }
            Course::Surface(surface) => {
                let beyond = |t: f64| surface.beyond_clamp_mm(x_mm(t));
                let (mut low, mut high) = (from, to);
                let sign = beyond(low);
                if sign * beyond(high) >= 0.0 {
                    return Vec::new();
                }
                for _ in 0..HALVINGS {
                    let middle = f64::midpoint(low, high);
                    if beyond(middle) * sign > 0.0 {
                        low = middle;
                    } else {
                        high = middle;
                    }
                }
                vec![high]
            }
        }
    }

    /// Adds it to an instant of the motion, `t` seconds after its beginning, by
    /// the laws that hold at `inside`; X is at `x_mm` at both.
    pub fn add(
        &self,
        model: &PowerModel,
        [t, inside]: [f64; 2],
        x_mm: [f64; 2],
        instant: &mut Instant,
    ) {
        let steady = |speed: f64| [period::Motion { speed, accel: 0.0 }; 2];
        let [now, nearby] = match &self.course {
            Course::Steady(speed) => steady(*speed),
            Course::Run(trace, since_s) => trace.at_both([since_s + t, since_s + inside]),
            Course::Surface(surface) => {
                let velocity_mm_s = instant.axes[0].velocity_mm_s;
                [surface.motion(x_mm[0], x_mm[1], velocity_mm_s); 2]
            }
        };
        let torque_nm = self.power.torque_turning_nm(now.accel, nearby.speed);
        let motor_w = self.power.turned_w(now.speed, torque_nm);
        let cutting_w = self.cutting_w + self.cutting_w_s_mm * instant.path_mm_s;
        instant.spindle = SpindleInstant {
            speed_rpm: now.speed,
            accel_rpm_s: now.accel,
            torque_nm,
            power_w: self.base_load_w + motor_w,
            cutting_w,
        };
        let index = self.converter;
        let (Some(bus_w), Some(regen_w), Some(converter)) = (
            instant.bus_w.get_mut(index),
            instant.regen_w.get_mut(index),
            model.converters.get(index),
        ) else {
            return;
        };
        let more_w = self.base_load_w + cutting_w;
        if converter.credit_regen {
            *bus_w += motor_w + more_w;
            let uncertain_w = self.base_load_w - self.credited_w;
            *regen_w = (uncertain_w - *bus_w).max(0.0);
        } else {
            *bus_w += motor_w.max(0.0) + more_w;
            *regen_w += (-motor_w).max(0.0);
        }
    }
}
