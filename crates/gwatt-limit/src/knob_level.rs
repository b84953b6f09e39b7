//! Levels of knobs that have several.

use gwatt_machine::{AxisValues, Knob, KnobTarget, Level, Machine};
use gwatt_motion::{Move, MoveKind};

/// The level that a change puts in force.
pub(super) fn level_of(
    machine: &Machine,
    accel: Option<(usize, AxisValues)>,
) -> Option<(&Knob, &Level)> {
    let (knob, values) = accel?;
    let knob = machine.controller.knobs.get(knob)?;
    let index = values.first().copied()?;
    let levels = knob.levels.as_ref()?;
    let level = levels.list.iter().zip(0_u32..);
    let mut level = level.filter(|(_, at)| f64::from(*at) == index);
    level.next().map(|(level, _)| (knob, level))
}

/// A move under a level.
pub(super) fn put(knob: &Knob, level: &Level, mv: &mut Move) {
    if knob.sets_accel() {
        mv.accel_mm_s2 = level.accel_mm_s2;
    }
    if mv.kind == MoveKind::Rapid && knob.target != KnobTarget::FeedAccel && sets_speed(knob) {
        mv.rapid_factor = level.rapid_factor;
    }
}

/// Whether a group of levels says how fast rapids are.
pub(super) fn sets_speed(knob: &Knob) -> bool {
    let levels = knob.levels.iter().flat_map(|levels| &levels.list);
    levels.clone().any(|level| level.rapid_factor != 1.0)
}
