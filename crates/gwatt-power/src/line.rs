//! Blocks of one line between two stops, on controls whose corners are not modelled.
//!
//! Where the path goes straight on there is no corner: nothing is blended, and no rule of
//! the control matters but that it runs each block with the block's own speed and
//! acceleration, as it runs one block between two stops. So such blocks are planned
//! together. As soon as anything else joins them, or stands between them, they get the
//! robust bound like all others.

mod judging;

use super::duty_cycle::DutyCycle;
use super::model::PowerModel;
use gwatt_machine::{AXES, CornerAngle, CornerRule, LookAhead, Machine};
use gwatt_motion::Move;

/// Blocks that are planned together at most.
const BLOCKS_MAX: usize = 256;
/// How far the end of a block may lie next to the line, mm: places are rounded.
const BESIDE_MM: f64 = 3e-6;

/// Straight on every joint is passed at the speed of the slower block.
const STRAIGHT_ON: LookAhead = LookAhead {
    blocks_at_most: None,
    corner: CornerRule::JunctionDeviation {
        deviation_mm: 1.0,
        angle: CornerAngle::AllAxes,
        per_axis: false,
        block_accel: false,
        small_block_mm: 0.0,
    },
    blocks: None,
    path_accel_mm_s2: f64::INFINITY,
    min_cruise_ratio: 0.0,
    chords: None,
};

/// The blocks of a line that began at rest, with the texts of their lines.
#[derive(Debug, Default)]
pub(super) struct Line {
    blocks: Vec<(Move, Vec<u8>)>,
    /// The move before the first, or a dwell, has ended at rest.
    rested: bool,
    /// Something stands after the last move that may stop it.
    closed: bool,
}

/// Whether blocks of one line are planned together though corners are not modelled. What
/// runs next to the axes, and limits over time, know nothing of such lines.
#[must_use]
pub fn plans_lines(machine: &Machine, model: &PowerModel) -> bool {
    let modelled = machine.controller.planner.look_ahead.is_some();
    !modelled && machine.spindle.is_none() && DutyCycle::new(machine, model).is_none()
}

impl Line {
    pub fn is_empty(&self) -> bool {
        self.blocks.is_empty()
    }

    /// Nothing is put together across this place.
    pub fn close(&mut self) {
        self.closed = true;
    }
}

/// Whether a move goes on in the direction of another one, at the same F and with the same
/// switched loads.
fn straight_on(last: &Move, mv: &Move) -> bool {
    let least_mm = last.length_mm.min(mv.length_mm);
    let turns = (0..AXES).any(|axis| {
        let [before, after] = [last, mv].map(|mv| (mv.end[axis] - mv.start[axis]) / mv.length_mm);
        let off = (after - before).abs();
        off.is_nan() || off > 2.0 * BESIDE_MM / least_mm
    });
    !turns
        && last.kind == mv.kind
        && last.feed_mm_s == mv.feed_mm_s
        && last.rapid_factor == mv.rapid_factor
        && last.loads == mv.loads
}
