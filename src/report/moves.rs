//! Moves as JSON, one a line.

use std::f64::consts::TAU;
use std::io::{self, Write};

use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

use super::figure::{Figure, Position};
use crate::interpret::{Move, MoveKind};
use crate::machine::{ALL_AXES, AxisId, AxisSet, AxisValues};
use crate::units::SECONDS_PER_MINUTE;

/// Writes a move as one line of JSON. `axes` are those of the machine;
/// `seconds` is its duration, if it can be known.
///
/// # Errors
/// Those of `out`.
pub fn write_move(
    mv: &Move,
    seconds: Option<f64>,
    axes: AxisSet,
    mut out: impl Write,
) -> io::Result<()> {
    serde_json::to_writer(&mut out, &MoveLine::new(mv, seconds, axes))?;
    out.write_all(b"\n")
}

#[derive(Serialize)]
#[allow(
    clippy::struct_field_names,
    reason = "`line` is the name in the output"
)]
struct MoveLine<'a> {
    line: u64,
    kind: &'static str,
    start: Coordinates<'a>,
    end: Coordinates<'a>,
    #[serde(skip_serializing_if = "Option::is_none")]
    center: Option<Center>,
    #[serde(skip_serializing_if = "Option::is_none")]
    plane: Option<String>,
    /// Positive from the first axis of the plane to the second: counter-clockwise,
    /// as the `rotation` of `LinuxCNC`'s canonical arcs.
    #[serde(skip_serializing_if = "Option::is_none")]
    turns: Option<Figure>,
    feed_mm_min: Option<Figure>,
    seconds: Option<Figure>,
}

impl<'a> MoveLine<'a> {
    fn new(mv: &'a Move, seconds: Option<f64>, axes: AxisSet) -> Self {
        let has_feed = !matches!(mv.kind, MoveKind::Rapid | MoveKind::Dwell);
        Self {
            line: mv.line,
            kind: mv.kind.name(),
            start: Coordinates {
                values: &mv.start,
                axes,
                unknown: AxisSet(mv.unknown_start.0 & !mv.assumed_start.0),
            },
            end: Coordinates {
                values: &mv.end,
                axes,
                unknown: AxisSet::default(),
            },
            center: mv.arc.map(|arc| Center {
                plane: arc.plane,
                center: arc.center,
            }),
            plane: mv.arc.map(|arc| plane_name(arc.plane)),
            turns: mv.arc.map(|arc| Figure(arc.sweep_rad / TAU)),
            feed_mm_min: has_feed.then_some(Figure(mv.feed_mm_s * SECONDS_PER_MINUTE)),
            seconds: seconds.map(Figure),
        }
    }
}

/// The name of a plane as G17 to G19 have it: ZX for the one that turns from Z
/// to X.
fn plane_name(plane: [usize; 2]) -> String {
    plane
        .iter()
        .filter_map(|&axis| ALL_AXES.get(axis))
        .map(|axis| axis.letter() as char)
        .collect()
}

/// Values of the machine's axes, by letter; null where not known.
struct Coordinates<'a> {
    values: &'a AxisValues,
    axes: AxisSet,
    unknown: AxisSet,
}

impl Serialize for Coordinates<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        for (axis, &value) in ALL_AXES.iter().zip(self.values) {
            let index = *axis as usize;
            if self.axes.contains(index) {
                let known = !self.unknown.contains(index);
                map.serialize_entry(letter(*axis), &known.then_some(Position(value)))?;
            }
        }
        map.end()
    }
}

/// The centre of an arc, by the letters of its plane.
struct Center {
    plane: [usize; 2],
    center: [f64; 2],
}

impl Serialize for Center {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(2))?;
        for (&axis, &value) in self.plane.iter().zip(&self.center) {
            if let Some(axis) = ALL_AXES.get(axis) {
                map.serialize_entry(letter(*axis), &Position(value))?;
            }
        }
        map.end()
    }
}

fn letter(axis: AxisId) -> &'static str {
    ["X", "Y", "Z", "A", "B", "C", "U", "V", "W", "E"][axis as usize]
}
