//! Axes next to a run of the spindle at lower overrides: moves begin later after the
//! command, last longer, and pass each place at a lower speed. What the run itself comes to
//! at lower overrides of the spindle is in `spindle_lower`.
//!
//! Input: a planned move, a run, and how much of the time since the command grows as the
//! override falls. Output: peak and regenerative peak of one converter at any override
//! below the largest, never too low.
//!
//! With the largest override as 1, at an override o
//!
//! * a place that is reached after t is reached between t and t/o: the same path run
//!   slowly all along is no quicker, since nothing but the speeds is lower;
//! * an axis that speeds up at a place either does so just as it does at the largest
//!   override, at the same time since the start of the move, or it cruises there;
//! * a cruise draws no more than one at the largest speed, and braking takes and gives
//!   at each place what it does at the largest override, later.
//!
//! From one override to the next lower one each of these is compared with all that the
//! spindle does between the earliest and the latest instant.

use super::demand::larger;
use super::model::{ConverterPower, PowerModel};
use super::overlap::{Axes, Side};
use super::spindle_lower::LoweredRun;
use gwatt_motion::Move;
use gwatt_plan::{Phase, PhaseKind, Plan, Profile, Trajectory};

/// Overrides that follow each other, by ratio, and the least but 0.
const RATIO: f64 = 0.9;
const LEAST: f64 = 0.03;
/// Parts of a ramp.
const PARTS: u32 = 16;

/// When a move begins after the command of a run.
#[derive(Debug, Clone, Copy)]
pub(super) struct Since {
    /// At the largest overrides, at least and at most, s.
    pub span_s: [f64; 2],
    /// How much of that grows as the override of the move falls, s; `None`: the other
    /// knob has a say, and it may begin at any later time.
    pub scaled_s: Option<f64>,
}

impl Since {
    /// The same at an override.
    fn latest_s(&self, share: f64) -> f64 {
        match self.scaled_s {
            None => f64::INFINITY,
            Some(0.0) => self.span_s[1],
            Some(scaled_s) => self.span_s[1] + scaled_s * (1.0 / share - 1.0),
        }
    }
}

/// What the axes ask for in a span of time of the move.
struct Part {
    from_s: f64,
    to_s: f64,
    power_w: f64,
    /// It comes later, and lasts longer, the lower the override.
    stretches: bool,
}

/// Largest power drawn and fed back of axes and spindle, W; the spindle without its base
/// load, the converter with its own. `plan` where the move is planned by itself, and
/// `most_w` what its axes ask for at most.
pub(super) fn peaks(
    model: &PowerModel,
    converter: &ConverterPower,
    mv: &Move,
    plan: Option<&Plan>,
    (duration_s, most_w): (f64, [f64; 2]),
    (run, since): (LoweredRun<'_>, Since),
) -> [f64; 2] {
    let sides = [(Side::Drawn, most_w[0]), (Side::FedBack, most_w[1])];
    sides.map(|(side, most_w)| {
        let own = plan.and_then(|plan| parts(model, converter, mv, plan, side));
        let parts = own.unwrap_or_else(|| {
            vec![Part {
                from_s: 0.0,
                to_s: duration_s,
                power_w: most_w,
                stretches: true,
            }]
        });
        let mut largest = f64::NEG_INFINITY;
        let mut upper = 1.0;
        while upper > 0.0 {
            let lower = if upper > LEAST { upper * RATIO } else { 0.0 };
            let latest_s = since.latest_s(lower);
            for part in &parts {
                let later = if part.stretches { lower } else { 1.0 };
                let window_s = [since.span_s[0] + part.from_s, latest_s + part.to_s / later];
                let span = run.over(window_s[0], window_s[1]);
                let [_, spindle_w] = side.of(&span, converter);
                largest = larger(largest, part.power_w + spindle_w);
            }
            upper = lower;
        }
        let floor_w = if side == Side::FedBack { 0.0 } else { f64::MIN };
        largest.max(floor_w)
    })
}

/// The parts of a line whose speed grows and falls once without limits of jerk; `None` for
/// any other path.
fn parts(
    model: &PowerModel,
    converter: &ConverterPower,
    mv: &Move,
    plan: &Plan,
    side: Side,
) -> Option<Vec<Part>> {
    let Trajectory::Path(profile) = &plan.trajectory else {
        return None;
    };
    let jerks = |phase: &Phase| matches!(phase.kind, PhaseKind::ConstantJerk { .. });
    if mv.arc.is_some() || profile.phases.iter().any(jerks) {
        return None;
    }
    let steady = Plan {
        duration_s: 1.0,
        trajectory: Trajectory::Path(cruise(profile.top_speed_mm_s())),
        ..plan.clone()
    };
    let axes = Axes::new(model, converter, mv, plan, side);
    let cruise_w = Axes::new(model, converter, mv, &steady, side).power_w(0.0, 1.0);
    // Where what an axis gives is credited, or it is compared with its weight, next to rest
    // may be the worst.
    let rest_w = model.tracer_of(converter, side.flow()).rest_w(mv);
    let mut parts = vec![Part {
        from_s: 0.0,
        to_s: plan.duration_s,
        power_w: larger(cruise_w, rest_w),
        stretches: true,
    }];
    let mut start_s = 0.0;
    for phase in &profile.phases {
        let step_s = phase.duration_s / f64::from(PARTS);
        for part in 0..PARTS {
            let [from_s, to_s] = [part, part + 1].map(|end| start_s + f64::from(end) * step_s);
            parts.push(Part {
                from_s,
                to_s,
                power_w: axes.power_w(from_s, to_s),
                stretches: phase.end_velocity_mm_s <= phase.velocity_mm_s,
            });
        }
        start_s += phase.duration_s;
    }
    Some(parts)
}

/// A constant speed, mm/s, for a second.
fn cruise(speed_mm_s: f64) -> Profile {
    let mut profile = Profile::default();
    profile.phases.push(Phase {
        kind: PhaseKind::ConstantAcceleration,
        duration_s: 1.0,
        position_mm: 0.0,
        velocity_mm_s: speed_mm_s,
        end_velocity_mm_s: speed_mm_s,
        accel_mm_s2: 0.0,
    });
    profile
}
