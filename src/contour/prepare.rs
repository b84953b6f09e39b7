//! What a machine must say before a program can be traced.

use super::follow::NoFollow;
use super::result::{ContourTrouble, Settings};
use crate::machine::{AxisSet, AxisValues, Machine};
use crate::plan::Track;

pub(super) fn trouble(message: String, help: &str) -> ContourTrouble {
    ContourTrouble {
        message,
        help: help.to_owned(),
    }
}

/// The period of the filters, which must be one.
pub(super) fn period(machine: &Machine, settings: Settings) -> Result<f64, ContourTrouble> {
    let mut periods = machine.responses.corrections.iter();
    let Some((first, filter)) = periods.next() else {
        return Ok(settings.period_s);
    };
    let other = periods
        .find(|(_, other)| (other.period_s - filter.period_s).abs() > 1e-9 * filter.period_s);
    if let Some((axis, other)) = other {
        return Err(trouble(
            format!(
                "the filters of {} and {} have different periods: {} and {} ms",
                first.letter() as char,
                axis.letter() as char,
                1e3 * filter.period_s,
                1e3 * other.period_s
            ),
            "design them together: gwatt tune --into",
        ));
    }
    Ok(filter.period_s)
}

pub(super) fn cannot_follow(letter: char, reason: NoFollow) -> ContourTrouble {
    match reason {
        NoFollow::NotProper => trouble(
            format!("axis {letter}: its response has more zeros than poles"),
            "give the poles of its loops too: position_gain_1_s, velocity_bandwidth_hz, or poles",
        ),
        NoFollow::Delay => trouble(
            format!("axis {letter}: its delay is longer than a second"),
            "delay_ms is in milliseconds",
        ),
        NoFollow::Degenerate => trouble(
            format!("axis {letter}: its response cannot be simulated"),
            "check the frequencies of zeros and poles: are they in Hz?",
        ),
    }
}

/// The axes that a track moves.
pub(super) fn moving(track: &Track) -> AxisSet {
    let mut set = AxisSet::default();
    let mut along = |direction: &AxisValues| {
        for (axis, part) in direction.iter().enumerate() {
            if *part != 0.0 {
                set.insert(axis);
            }
        }
    };
    match track {
        Track::Rest(_) => {}
        Track::Line { direction, .. } => along(direction),
        Track::Arc {
            direction, plane, ..
        } => {
            along(direction);
            for axis in plane {
                set.insert(*axis);
            }
        }
        Track::Blend { blend, .. } => {
            for axis in 0..3 {
                if blend.tangent[axis] != 0.0 || blend.normal[axis] != 0.0 {
                    set.insert(axis);
                }
            }
        }
        Track::Axes { profiles, .. } => {
            for (axis, ..) in profiles {
                set.insert(*axis);
            }
        }
    }
    set
}
