//! How the spindle is shown over time.

use crate::instant::{Instant, SpindleInstant};
use crate::model::PowerModel;
use crate::motion::Motion;
use crate::spindle::SpindlePower;
use crate::spindle_state::SpindleState;
use crate::spindle_trace::SpindleTrace;
use crate::surface_speed::Surface;
use gwatt_plan::period;

/// Halvings that find where the clamp of G96 begins.
const HALVINGS: u32 = 60;

/// A spindle of which nothing is known but what it cuts with.
const NOT_KNOWN: SpindleInstant = SpindleInstant {
    speed_rpm: f64::NAN,
    accel_rpm_s: f64::NAN,
    torque_nm: f64::NAN,
    power_w: f64::NAN,
    cutting_w: 0.0,
};

/// How it turns.
#[derive(Debug, Clone)]
pub(super) enum Course {
    Steady(f64),
    /// On a run, so many s after its command.
    Run(SpindleTrace, f64),
    /// G96.
    Surface(Surface),
    /// G96 in a move from an unknown start: the most that it draws and feeds back, W.
    Unknown([f64; 2]),
}

/// The spindle during one move, or while the axes wait.
#[derive(Debug, Clone)]
pub struct Turning {
    /// How long it lasts, s.
    pub duration_s: f64,
    /// The axes stand meanwhile, in this place.
    pub rest: Option<Motion>,
    pub(super) course: Course,
    pub(super) power: SpindlePower,
    pub(super) converter: usize,
    pub(super) base_load_w: f64,
    /// What of it takes of what is fed back.
    pub(super) credited_w: f64,
    /// Electrical power of cutting, W, and by speed of the path, W/(mm/s).
    pub(super) cutting_w: f64,
    pub(super) cutting_w_s_mm: f64,
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

impl Turning {
    /// Instants between two at which its law changes, s after its beginning.
    /// `x_mm` gives where X is then.
    #[must_use]
    pub fn switches_s(&self, [from, to]: [f64; 2], x_mm: impl Fn(f64) -> f64) -> Vec<f64> {
        match &self.course {
            Course::Steady(_) | Course::Unknown(_) => Vec::new(),
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
        let cutting_w = self.cutting_w + self.cutting_w_s_mm * instant.path_mm_s;
        let steady = |speed: f64| [period::Motion { speed, accel: 0.0 }; 2];
        let turns = match &self.course {
            Course::Steady(speed) => Some(steady(*speed)),
            Course::Run(trace, since_s) => Some(trace.at_both([since_s + t, since_s + inside])),
            Course::Surface(surface) => {
                let velocity_mm_s = instant.axes[0].velocity_mm_s;
                Some([surface.motion(x_mm[0], x_mm[1], velocity_mm_s); 2])
            }
            Course::Unknown(_) => None,
        };
        let mut motor_w = f64::NAN;
        instant.spindle = NOT_KNOWN;
        if let Some([now, nearby]) = turns {
            let torque_nm = self.power.torque_turning_nm(now.accel, nearby.speed);
            motor_w = self.power.turned_w(now.speed, torque_nm);
            instant.spindle = SpindleInstant {
                speed_rpm: now.speed,
                accel_rpm_s: now.accel,
                torque_nm,
                power_w: self.base_load_w + motor_w,
                cutting_w: 0.0,
            };
        }
        instant.spindle.cutting_w = cutting_w;
        let [drawn_w, fed_back_w] = match self.course {
            Course::Unknown(most_w) => most_w,
            _ => [motor_w.max(0.0), (-motor_w).max(0.0)],
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
        let bounded = matches!(self.course, Course::Unknown(_)) || !instant.unknown_axes.is_empty();
        if bounded {
            // No more is credited than the base load, which is certain.
            *bus_w += drawn_w + more_w;
            *regen_w = (*regen_w + fed_back_w - self.credited_w).max(0.0);
        } else if converter.credit_regen {
            *bus_w += motor_w + more_w;
            let uncertain_w = self.base_load_w - self.credited_w;
            *regen_w = (uncertain_w - *bus_w).max(0.0);
        } else {
            *bus_w += drawn_w + more_w;
            *regen_w += fed_back_w;
        }
    }
}
