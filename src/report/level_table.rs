//! The levels of a machine, as `machine check` shows them.

use std::fmt::Write as _;

use super::aligned::aligned;
use super::text::rounded;
use crate::machine::{ALL_AXES, AxisKind, Knob, KnobTarget, Level, Levels, Machine};

/// One level a line: its words, the moves that it acts on, and what it makes of the axes.
#[must_use]
pub fn level_table(machine: &Machine) -> String {
    let knobs = machine.controller.knobs.iter();
    let groups = knobs.filter_map(|knob| Some((knob, knob.levels.as_ref()?)));
    let rows: Vec<[String; 3]> = groups
        .flat_map(|(knob, levels)| rows(machine, knob, levels))
        .collect();
    aligned(&rows, "  ")
}

fn rows(machine: &Machine, knob: &Knob, levels: &Levels) -> Vec<[String; 3]> {
    let acts_on = match knob.target {
        KnobTarget::FeedAccel => "feeds",
        KnobTarget::RapidAccel | KnobTarget::RapidSpeed => "rapids",
        _ => "all moves",
    };
    let list = levels.list.iter().enumerate();
    list.map(|(index, level)| {
        let words: Vec<&str> = level.words.iter().map(|word| word.text.as_str()).collect();
        let holds = if index == levels.power_on {
            ", from the start"
        } else {
            ""
        };
        [
            words.join(" or "),
            format!("{acts_on}{holds}"),
            makes(machine, knob, level),
        ]
    })
    .collect()
}

fn makes(machine: &Machine, knob: &Knob, level: &Level) -> String {
    let mut text = String::new();
    for axis in machine.axis_set.iter().filter(|_| knob.sets_accel()) {
        let (Some(id), Some(Some(data))) = (ALL_AXES.get(axis), machine.axes.get(axis)) else {
            continue;
        };
        let unit = match data.kind {
            AxisKind::Linear => "mm/s2",
            AxisKind::Rotary => "deg/s2",
        };
        let blank = if text.is_empty() { "" } else { ", " };
        let accel = rounded(level.accel_mm_s2[axis]);
        let _ = write!(text, "{blank}{} {accel} {unit}", id.letter() as char);
    }
    if knob.target == KnobTarget::RapidSpeed || level.rapid_factor != 1.0 {
        let blank = if text.is_empty() { "" } else { ", " };
        let percent = rounded(level.rapid_factor * 100.0);
        let _ = write!(text, "{blank}{percent} % of the rapid speed");
    }
    text
}
