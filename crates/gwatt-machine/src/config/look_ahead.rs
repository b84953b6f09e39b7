//! `[planner.look_ahead]` of a profile, `[look_ahead]` of a machine file: how corners are run through.

use std::ops::Range;

use schemars::JsonSchema;
use serde::Deserialize;

use super::findings::Findings;
use super::value::{At, AtLeastOne, Fraction, NotNegative, Num, Part, PerAxis, Positive};
use crate::axis::{AXES, AxisValues};
use crate::controller::Planner;
use crate::look_ahead::{ChordRule, CornerAngle, CornerRule, LookAhead};

/// How corners are run through where the path mode looks ahead. Exactly one of
/// the tables `linuxcnc`, `junction_deviation`, `classic_jerk`, `square_corner`
/// and `speed_step`.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct LookAheadTable {
    /// How many blocks the controller sees ahead; default as many as matter.
    pub(crate) blocks: Option<AtLeastOne>,
    /// How many it may see, where that is a matter of timing; default `blocks`.
    pub(crate) blocks_at_most: Option<AtLeastOne>,
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
    pub(crate) angle: Option<CornerAngle>,
    /// Whether the axes' limits in the direction of the corner count, not the
    /// block's acceleration; default false.
    pub(crate) per_axis: Option<bool>,
    /// Whether with `per_axis` the block's acceleration counts as well, as in Marlin; default
    /// false.
    pub(crate) block_accel: Option<bool>,
    /// Blocks shorter than this also keep to the circle that they are chords
    /// of; default 0: none do.
    pub(crate) small_block_mm: Option<NotNegative>,
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
    /// The part of a chord from which on the number is rounded up, 0 to 1, in place of
    /// `round_up`.
    pub(crate) more_from: Option<Fraction>,
    /// Whether a chord, while nothing waits after it, may be left at the speed from which
    /// the rest of the arc is enough to stop; default false.
    pub(crate) safe_exit: Option<bool>,
}

/// The rules of a table; `None` with any mistake in it.
pub(crate) fn look_ahead(
    findings: &mut Findings<'_>,
    at: Option<&At<LookAheadTable>>,
) -> Option<LookAhead> {
    let table = &at?.value;
    let Some(corner) = corner(findings, table, None).ok()? else {
        if !findings.refused_in("planner.look_ahead") {
            let message = "`look_ahead` has no rule for corners";
            let help = "one of the tables linuxcnc, junction_deviation, classic_jerk, \
                        square_corner and speed_step";
            let span = &at?.span;
            findings.error("machine-missing", span, message, Some(help.to_owned()));
        }
        return None;
    };
    let bare = LookAhead {
        corner,
        blocks: None,
        blocks_at_most: None,
        path_accel_mm_s2: f64::INFINITY,
        min_cruise_ratio: 0.0,
        chords: None,
    };
    Some(with(table, bare))
}

/// Takes what `[look_ahead]` of a machine file gives into the planner of the profile; what
/// it does not give stays.
pub(crate) fn own(
    findings: &mut Findings<'_>,
    at: Option<&At<LookAheadTable>>,
    planner: &mut Planner,
) {
    let Some(at) = at else { return };
    let Some(rules) = planner.look_ahead else {
        let message = "how corners are run through is not modelled for this controller";
        let help = "leave [look_ahead] out: the robust bound counts".to_owned();
        findings.error("machine-kind", &at.span, message, Some(help));
        return;
    };
    if let Ok(found) = corner(findings, &at.value, Some(&rules.corner)) {
        let corner = found.unwrap_or(rules.corner);
        let rules = with(&at.value, LookAhead { corner, ..rules });
        if at.value.blocks_at_most.is_some() && !may_see_more(&rules) {
            let message = "`blocks_at_most` goes with `blocks`, with rules for corners other than \
                           those of LinuxCNC, and without a cruise ratio";
            findings.error("machine-kind", &at.span, message, None);
        }
        planner.look_ahead = Some(rules);
    }
}

/// Whether plans are known to lie between those with the fewest and the most blocks.
fn may_see_more(rules: &LookAhead) -> bool {
    let linuxcnc = matches!(rules.corner, CornerRule::LinuxCnc { .. });
    rules.blocks.is_some() && !linuxcnc && rules.min_cruise_ratio == 0.0
}

/// The rules with what a table gives besides the corner.
fn with(table: &LookAheadTable, rules: LookAhead) -> LookAhead {
    LookAhead {
        corner: rules.corner,
        blocks: table
            .blocks
            .as_ref()
            .map_or(rules.blocks, |it| Some(it.value as u32)),
        blocks_at_most: table
            .blocks_at_most
            .as_ref()
            .map_or(rules.blocks_at_most, |it| Some(it.value as u32)),
        path_accel_mm_s2: or(table.path_accel_mm_s2.as_ref(), rules.path_accel_mm_s2),
        min_cruise_ratio: or(table.min_cruise_ratio.as_ref(), rules.min_cruise_ratio),
        chords: match &table.chords {
            Some(table) => Some(chords(table, rules.chords)),
            None => rules.chords,
        },
    }
}

fn or<B>(number: Option<&Num<B>>, otherwise: f64) -> f64 {
    number.map_or(otherwise, |number| number.value)
}

/// The rule for corners that a table gives, its fields otherwise those of `base` where that
/// is of the same kind; `Err` with a mistake.
fn corner(
    findings: &mut Findings<'_>,
    table: &LookAheadTable,
    base: Option<&CornerRule>,
) -> Result<Option<CornerRule>, ()> {
    let mut rules: Vec<(CornerRule, &Range<usize>)> = Vec::new();
    if let Some(At { value, span }) = &table.linuxcnc {
        rules.push((linuxcnc(value, base), span));
    }
    if let Some(At { value, span }) = &table.junction_deviation {
        rules.push((deviation(value, base).ok_or(())?, span));
    }
    if let Some(At { value, span }) = &table.classic_jerk {
        let known = match base {
            Some(CornerRule::ClassicJerk { step_mm_s }) => Some(step_mm_s),
            _ => None,
        };
        let step_mm_s = steps(value.step_mm_s.as_ref().ok_or(())?, known);
        rules.push((CornerRule::ClassicJerk { step_mm_s }, span));
    }
    if let Some(At { value, span }) = &table.square_corner {
        let known = match base {
            Some(CornerRule::SquareCorner {
                extruder_step_mm_s, ..
            }) => *extruder_step_mm_s,
            _ => 1.0,
        };
        let rule = CornerRule::SquareCorner {
            velocity_mm_s: value.corner_mm_s.as_ref().ok_or(())?.value,
            extruder_step_mm_s: or(value.extruder_step_mm_s.as_ref(), known),
        };
        rules.push((rule, span));
    }
    if let Some(At { value, span }) = &table.speed_step {
        let (known, same) = match base {
            Some(CornerRule::SpeedStep {
                step_mm_s,
                same_kind_only,
            }) => (Some(step_mm_s), *same_kind_only),
            _ => (None, false),
        };
        let rule = CornerRule::SpeedStep {
            step_mm_s: steps(value.step_mm_s.as_ref().ok_or(())?, known),
            same_kind_only: value.same_kind_only.unwrap_or(same),
        };
        rules.push((rule, span));
    }
    if let Some((_, second)) = rules.get(1) {
        let message = "a planner has one rule for corners";
        findings.error("machine-twice", second, message, None);
        return Err(());
    }
    Ok(rules.into_iter().next().map(|(rule, _)| rule))
}

fn linuxcnc(table: &LinuxCncTable, base: Option<&CornerRule>) -> CornerRule {
    let known = match base {
        Some(CornerRule::LinuxCnc {
            cycle_s,
            kink_ratio,
            gap_cycles,
        }) => [*cycle_s, *kink_ratio, *gap_cycles],
        _ => [0.001, 0.1, 4.0],
    };
    CornerRule::LinuxCnc {
        cycle_s: or(table.servo_period_s.as_ref(), known[0]),
        kink_ratio: or(table.kink_ratio.as_ref(), known[1]),
        gap_cycles: or(table.gap_cycles.as_ref(), known[2]),
    }
}

fn deviation(table: &DeviationTable, base: Option<&CornerRule>) -> Option<CornerRule> {
    let (angle, per_axis, block_accel, small) = match base {
        Some(CornerRule::JunctionDeviation {
            angle,
            per_axis,
            block_accel,
            small_block_mm,
            ..
        }) => (*angle, *per_axis, *block_accel, *small_block_mm),
        _ => (CornerAngle::AllAxes, false, false, 0.0),
    };
    Some(CornerRule::JunctionDeviation {
        deviation_mm: table.deviation_mm.as_ref()?.value,
        angle: table.angle.unwrap_or(angle),
        per_axis: table.per_axis.unwrap_or(per_axis),
        block_accel: table.block_accel.unwrap_or(block_accel),
        small_block_mm: or(table.small_block_mm.as_ref(), small),
    })
}

/// Steps of speed; axes that are not named have those of `base`, or no limit.
fn steps(given: &PerAxis<NotNegative>, base: Option<&AxisValues>) -> AxisValues {
    let mut steps = base.copied().unwrap_or([f64::INFINITY; AXES]);
    for (axis, step) in given.iter() {
        steps[axis as usize] = step.value;
    }
    steps
}

fn chords(table: &ChordsTable, base: Option<ChordRule>) -> ChordRule {
    let base = base.unwrap_or(ChordRule {
        max_mm: f64::INFINITY,
        min_mm: 0.0,
        deviation_mm: f64::INFINITY,
        per_second: 0.0,
        per_circle: 0.0,
        more_from: 1.0,
        safe_exit: false,
    });
    ChordRule {
        max_mm: or(table.max_mm.as_ref(), base.max_mm),
        min_mm: or(table.min_mm.as_ref(), base.min_mm),
        deviation_mm: or(table.deviation_mm.as_ref(), base.deviation_mm),
        per_second: or(table.per_second.as_ref(), base.per_second),
        per_circle: or(table.per_circle.as_ref(), base.per_circle),
        more_from: match (&table.more_from, table.round_up) {
            (Some(part), _) => part.value,
            (None, Some(up)) => f64::from(u8::from(!up)),
            (None, None) => base.more_from,
        },
        safe_exit: table.safe_exit.unwrap_or(base.safe_exit),
    }
}
