//! `[planner.look_ahead]`: how corners are run through.

use std::ops::Range;

use schemars::JsonSchema;
use serde::Deserialize;

use super::findings::Findings;
use super::value::{At, AtLeastOne, NotNegative, Part, PerAxis, Positive};
use crate::axis::{AXES, AxisValues};
use crate::look_ahead::{ChordRule, CornerAngle, CornerRule, LookAhead};

/// How corners are run through where the path mode looks ahead. Exactly one of
/// the tables `linuxcnc`, `junction_deviation`, `classic_jerk`, `square_corner`
/// and `speed_step`.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct LookAheadTable {
    /// How many blocks the controller sees ahead; default as many as matter.
    pub(crate) blocks: Option<AtLeastOne>,
    /// Acceleration along the path whatever the direction; default none but
    /// the axes' own.
    pub(crate) path_accel_mm_s2: Option<Positive>,
    /// Share of each hill of speed that is cruised at least; default 0.
    pub(crate) min_cruise_ratio: Option<Part>,
    /// How arcs are rounded into chords; default not at all.
    pub(crate) chords: Option<ChordsTable>,
    /// LinuxCNC 2.9: G61, G64 P Q, blend arcs.
    pub(crate) linuxcnc: Option<At<LinuxCncTable>>,
    /// grbl, Marlin, Smoothieware, and CNCs with a corner tolerance.
    pub(crate) junction_deviation: Option<At<DeviationTable>>,
    /// Marlin with `CLASSIC_JERK`.
    pub(crate) classic_jerk: Option<At<StepTable>>,
    /// Klipper.
    pub(crate) square_corner: Option<At<SquareTable>>,
    /// RepRapFirmware, and CNCs with a permitted step of speed per axis.
    pub(crate) speed_step: Option<At<StepTable>>,
}

/// LinuxCNC 2.9.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct LinuxCncTable {
    /// `[EMCMOT] SERVO_PERIOD` in s; default 0.001.
    pub(crate) servo_period_s: Option<Positive>,
    /// `[TRAJ] ARC_BLEND_KINK_RATIO`; default 0.1.
    pub(crate) kink_ratio: Option<Positive>,
    /// `[TRAJ] ARC_BLEND_GAP_CYCLES`; default 4.
    pub(crate) gap_cycles: Option<NotNegative>,
}

/// A circle that passes the corner at a distance.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct DeviationTable {
    /// The distance.
    #[schemars(required)]
    pub(crate) deviation_mm: Option<Positive>,
    /// Which directions make the angle; default all axes.
    pub(crate) angle: Option<AngleName>,
    /// Whether the axes' limits in the direction of the corner count, not the
    /// block's acceleration; default false.
    pub(crate) per_axis: Option<bool>,
    /// Blocks shorter than this also keep to the circle that they are chords
    /// of; default 0: none do.
    pub(crate) small_block_mm: Option<NotNegative>,
}

/// Which directions make the angle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum AngleName {
    AllAxes,
    Linear,
}

/// Klipper's square corner velocity.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct SquareTable {
    /// Speed at a corner of 90 degrees.
    #[schemars(required)]
    pub(crate) corner_mm_s: Option<NotNegative>,
    /// `instantaneous_corner_velocity` of the extruder; default 1.
    pub(crate) extruder_step_mm_s: Option<NotNegative>,
}

/// Steps of speed.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct StepTable {
    /// The largest step of each axis, degrees/s for rotary ones; without a
    /// value it has no limit.
    #[schemars(required)]
    pub(crate) step_mm_s: Option<PerAxis<NotNegative>>,
    /// Only between two moves that extrude or two that do not; default false.
    pub(crate) same_kind_only: Option<bool>,
}

/// Arcs as chords.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ChordsTable {
    /// Longest chord; default none.
    pub(crate) max_mm: Option<Positive>,
    /// Shortest chord; default 0.
    pub(crate) min_mm: Option<NotNegative>,
    /// Distance between arc and chord; default none.
    pub(crate) deviation_mm: Option<Positive>,
    /// Chords per second at the feed; default 0: does not matter.
    pub(crate) per_second: Option<NotNegative>,
    /// Chords of a full circle at least; default 0.
    pub(crate) per_circle: Option<NotNegative>,
    /// Whether the number is rounded up; default false.
    pub(crate) round_up: Option<bool>,
}

/// The rules of a table; `None` with any mistake in it.
pub(crate) fn look_ahead(
    findings: &mut Findings<'_>,
    at: Option<&At<LookAheadTable>>,
) -> Option<LookAhead> {
    let table = &at?.value;
    let mut rules: Vec<(CornerRule, &Range<usize>)> = Vec::new();
    if let Some(At { value, span }) = &table.linuxcnc {
        let rule = CornerRule::LinuxCnc {
            cycle_s: value.servo_period_s.as_ref().map_or(0.001, |it| it.value),
            kink_ratio: value.kink_ratio.as_ref().map_or(0.1, |it| it.value),
            gap_cycles: value.gap_cycles.as_ref().map_or(4.0, |it| it.value),
        };
        rules.push((rule, span));
    }
    if let Some(At { value, span }) = &table.junction_deviation {
        let rule = CornerRule::JunctionDeviation {
            deviation_mm: value.deviation_mm.as_ref()?.value,
            angle: match value.angle {
                Some(AngleName::Linear) => CornerAngle::Linear,
                Some(AngleName::AllAxes) | None => CornerAngle::AllAxes,
            },
            per_axis: value.per_axis.unwrap_or(false),
            small_block_mm: value.small_block_mm.as_ref().map_or(0.0, |it| it.value),
        };
        rules.push((rule, span));
    }
    if let Some(At { value, span }) = &table.classic_jerk {
        let step_mm_s = steps(value.step_mm_s.as_ref()?);
        rules.push((CornerRule::ClassicJerk { step_mm_s }, span));
    }
    if let Some(At { value, span }) = &table.square_corner {
        let rule = CornerRule::SquareCorner {
            velocity_mm_s: value.corner_mm_s.as_ref()?.value,
            extruder_step_mm_s: value.extruder_step_mm_s.as_ref().map_or(1.0, |it| it.value),
        };
        rules.push((rule, span));
    }
    if let Some(At { value, span }) = &table.speed_step {
        let rule = CornerRule::SpeedStep {
            step_mm_s: steps(value.step_mm_s.as_ref()?),
            same_kind_only: value.same_kind_only.unwrap_or(false),
        };
        rules.push((rule, span));
    }
    if let Some((_, second)) = rules.get(1) {
        let message = "a planner has one rule for corners";
        findings.error("machine-twice", second, message, None);
        return None;
    }
    let Some((corner, _)) = rules.into_iter().next() else {
        if !findings.refused_in("planner.look_ahead") {
            let message = "`look_ahead` has no rule for corners";
            let help = "one of the tables linuxcnc, junction_deviation, classic_jerk, \
                        square_corner and speed_step";
            let span = &at?.span;
            findings.error("machine-missing", span, message, Some(help.to_owned()));
        }
        return None;
    };
    Some(LookAhead {
        corner,
        blocks: table.blocks.as_ref().map(|it| it.value as u32),
        path_accel_mm_s2: table
            .path_accel_mm_s2
            .as_ref()
            .map_or(f64::INFINITY, |it| it.value),
        min_cruise_ratio: table.min_cruise_ratio.as_ref().map_or(0.0, |it| it.value),
        chords: table.chords.as_ref().map(chords),
    })
}

fn steps(given: &PerAxis<NotNegative>) -> AxisValues {
    let mut steps = [f64::INFINITY; AXES];
    for (axis, step) in given.iter() {
        steps[axis as usize] = step.value;
    }
    steps
}

fn chords(table: &ChordsTable) -> ChordRule {
    ChordRule {
        max_mm: table.max_mm.as_ref().map_or(f64::INFINITY, |it| it.value),
        min_mm: table.min_mm.as_ref().map_or(0.0, |it| it.value),
        deviation_mm: table
            .deviation_mm
            .as_ref()
            .map_or(f64::INFINITY, |it| it.value),
        per_second: table.per_second.as_ref().map_or(0.0, |it| it.value),
        per_circle: table.per_circle.as_ref().map_or(0.0, |it| it.value),
        round_up: table.round_up.unwrap_or(false),
    }
}
