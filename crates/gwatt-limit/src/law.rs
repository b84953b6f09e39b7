//! Values by rule instead of by solution: presets, and the squared ratio.

use super::case::Case;
use super::change::{Change, feed_word, round_to_step};
use super::lever::{Levers, NO_KNOB, Obstacle, SpeedLever};
use super::options::{PresetElse, Strategy};
use super::solver::Solver;
use gwatt_machine::{AXES, AxisSet, AxisValues, Knob, Machine, Preset};
use gwatt_motion::{Move, MoveKind};
use gwatt_plan::{Caps, SpeedBound, speed_bound};

/// The preset for exactly the axes that start together.
pub(super) fn preset_for<'m>(machine: &'m Machine, mv: &Move) -> Option<&'m Preset> {
    let axes = AxisSet(mv.moving.0 | mv.unknown_start.0);
    machine.presets.iter().find(|preset| preset.axes == axes)
}

impl Solver<'_> {
    /// What the preset for its axes says of a move, or what was asked for where there is none.
    pub(super) fn by_preset(&self, case: Case<'_>, levers: &Levers) -> Result<Change, Obstacle> {
        if self.falls_back(case.mv) {
            return self.by_speed(case, levers);
        }
        preset(self, case, levers)
    }

    /// Whether a move that does not fit gets a speed in place of a preset.
    pub(super) fn falls_back(&self, mv: &Move) -> bool {
        self.how.strategy == Strategy::Preset
            && self.how.preset_else == PresetElse::Speed
            && preset_for(self.machine, mv).is_none()
    }

    /// What preset or law say of a move that fits as it is; `None`: nothing.
    pub(super) fn anyway(
        &self,
        case: Case<'_>,
        levers: &Levers,
    ) -> Result<Option<Change>, Obstacle> {
        let Case { mv, assessment, .. } = case;
        let presets = self.how.strategy == Strategy::Preset;
        let stands = assessment.top_speed_mm_s == 0.0 && mv.unknown_start.is_empty();
        let without = presets && preset_for(self.machine, mv).is_none();
        if mv.kind == MoveKind::Dwell || stands || without {
            return Ok(None);
        }
        let change = self.sooner_stopped(case, |case| {
            let change = match self.how.strategy {
                Strategy::Preset => preset(self, case, levers)?,
                _ if squared_factor(self, case) >= 1.0 => Change::NONE,
                strategy => squared_ratio(self, case, levers, strategy)?,
            };
            if assessment.ahead {
                // The certificate plans it with its neighbours.
                return self.respect_floor(case, &change).map(|()| change);
            }
            self.verify(case, change)
        })?;
        Ok((!change.is_none()).then_some(change))
    }
}

/// The limits of the preset for the axes of a move.
pub(super) fn preset(
    solver: &Solver<'_>,
    case: Case<'_>,
    levers: &Levers,
) -> Result<Change, Obstacle> {
    let axes = AxisSet(case.mv.moving.0 | case.mv.unknown_start.0);
    let Some(preset) = preset_for(solver.machine, case.mv) else {
        return Err(Obstacle::new(
            "no-preset",
            format!("the machine has no preset for the axes {axes}"),
            "add a [[preset]] for them, or use another strategy",
        ));
    };
    let mut change = Change::default();
    if preset.has_speed {
        let bound = speed_bound(solver.machine, case.mv, solver.largest, Caps::default());
        let speeds = axis_speeds(&bound);
        let share = axes
            .iter()
            .map(|axis| preset.speed_mm_s[axis] / speeds[axis])
            .fold(1.0, f64::min);
        if share < 1.0 {
            let lever = levers.speed.ok_or_else(|| no_lever(solver, "speed"))?;
            scale_speed(solver, case, lever, share, &mut change)?;
        }
    }
    if preset.has_accel {
        let mut accel = case.mv.accel_mm_s2;
        for axis in axes.iter() {
            accel[axis] = accel[axis].min(preset.accel_mm_s2[axis]);
        }
        if accel != case.mv.accel_mm_s2 {
            let knob = levers.accel_word(solver.machine);
            let knob = knob.ok_or_else(|| no_lever(solver, "acceleration"))?;
            let least = axes.iter().map(|axis| accel[axis]);
            let values = match solver.along_path(knob, case.mv) {
                Some(own) => solver.path_values(knob, least.fold(own, f64::min)),
                None => solver.knob_values(knob, &accel, case.permit),
            };
            let values = values.ok_or_else(|| no_lever(solver, "acceleration"))?;
            change.accel = Some((knob, values));
            change.exact_stop |= solver.halts(case, knob);
        }
    }
    Ok(change)
}

/// V² on the nominal values, 1 at most: V is the limit by the sum of what the commanded
/// axes take at their nominal speeds and accelerations.
fn squared_factor(solver: &Solver<'_>, case: Case<'_>) -> f64 {
    let mut bound = speed_bound(solver.machine, case.mv, solver.largest, Caps::default());
    if case.mv.kind == MoveKind::Rapid {
        // Nominal is the rapid speed of each axis, not its share of the path.
        for axis in case.mv.moving.iter() {
            let rapid = solver.machine.axes[axis].map_or(0.0, |data| data.rapid_mm_s)
                * solver.largest.rapid;
            for side in [&mut bound.positive[axis], &mut bound.negative[axis]] {
                *side = if *side > 0.0 {
                    rapid * case.mv.rapid_factor
                } else {
                    0.0
                };
            }
        }
    }
    let nominal = solver.model.robust(case.mv, &bound, &case.mv.accel_mm_s2);
    let ratio = solver.model.limit_w(nominal.converter) / nominal.peak_w;
    (ratio * ratio).min(1.0)
}

/// Speed or acceleration by the square of that ratio.
pub(super) fn squared_ratio(
    solver: &Solver<'_>,
    case: Case<'_>,
    levers: &Levers,
    strategy: Strategy,
) -> Result<Change, Obstacle> {
    let factor = squared_factor(solver, case);
    let mut change = Change::default();
    if strategy == Strategy::Accel {
        let knob = levers.accel_word(solver.machine);
        let knob = knob.ok_or_else(|| no_lever(solver, "acceleration"))?;
        return solver
            .accel_change(case, knob, factor, &change)
            .ok_or_else(|| no_lever(solver, "acceleration"));
    }
    let lever = levers.speed.ok_or_else(|| no_lever(solver, "speed"))?;
    scale_speed(solver, case, lever, factor, &mut change)?;
    Ok(change)
}

/// Sets a share of the nominal path speed.
fn scale_speed(
    solver: &Solver<'_>,
    case: Case<'_>,
    lever: SpeedLever,
    share: f64,
    change: &mut Change,
) -> Result<(), Obstacle> {
    if let SpeedLever::RapidPercent(knob) = lever {
        let step = solver
            .machine
            .controller
            .knobs
            .get(knob)
            .map_or(1.0, Knob::percent_step);
        let percent = round_to_step(case.mv.rapid_factor * share * 100.0, step);
        change.rapid_percent = (percent > 0.0).then_some((knob, percent));
        return if percent > 0.0 {
            Ok(())
        } else {
            Err(no_lever(solver, "speed"))
        };
    }
    if let SpeedLever::Cap(knob) = lever {
        let speed_mm_s = case.assessment.speed_mm_s * share;
        let values = solver.cap_values(case, knob, speed_mm_s);
        change.speed = values.map(|values| (knob, values));
        return values.map(|_| ()).ok_or_else(|| no_lever(solver, "speed"));
    }
    change.as_feed = lever == SpeedLever::AsFeed;
    change.exact_stop = change.as_feed && case.exact_stop;
    let speed_mm_s = case.assessment.speed_mm_s * share;
    change.feed = Some(feed_word(solver.machine, case.mv, case.permit, speed_mm_s));
    Ok(())
}

fn axis_speeds(bound: &SpeedBound) -> AxisValues {
    let mut speeds = [0.0; AXES];
    for (axis, speed) in speeds.iter_mut().enumerate() {
        *speed = bound.positive[axis].max(bound.negative[axis]);
    }
    speeds
}

fn no_lever(solver: &Solver<'_>, what: &str) -> Obstacle {
    let help = if solver.how.allowed.feed {
        "use another strategy"
    } else {
        "use --allow feed for feeds, or another strategy"
    };
    let message = format!("no permitted word lowers the {what} of this block");
    Obstacle::new(NO_KNOB, message, help)
}
