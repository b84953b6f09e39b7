//! A row as all formats print it: the names and their order in one place.

use std::fmt::Write as _;

use arrayvec::ArrayString;
use serde::{Serialize, Serializer};

use super::figure::Figure;
use crate::machine::{AXES, AxisSet};
use crate::pipeline::Row;

/// Names of the columns of a report, in their order.
pub const COLUMNS: [&str; 23] = [
    "line",
    "n_word",
    "move",
    "axes",
    "start_s",
    "duration_s",
    "peak_w",
    "regen_w",
    "limit_w",
    "ratio",
    "energy_j",
    "action",
    "knob",
    "value_before",
    "value_after",
    "peak_after_w",
    "duration_after_s",
    "regen_after_w",
    "regen_limit_w",
    "certificate",
    "converter",
    "run",
    "file",
];

/// A row with its names; the fields are [`COLUMNS`].
#[derive(Debug, Serialize)]
pub(super) struct Record<'a> {
    line: u64,
    n_word: Option<Figure>,
    #[serde(rename = "move")]
    kind: &'static str,
    axes: Letters,
    start_s: Figure,
    duration_s: Figure,
    peak_w: Figure,
    regen_w: Figure,
    limit_w: Figure,
    ratio: Option<Figure>,
    energy_j: Figure,
    action: &'static str,
    knob: &'a str,
    value_before: Option<Figure>,
    value_after: Option<Figure>,
    peak_after_w: Option<Figure>,
    duration_after_s: Option<Figure>,
    regen_after_w: Option<Figure>,
    regen_limit_w: Option<Figure>,
    certificate: &'static str,
    converter: &'a str,
    run: u32,
    file: &'a str,
}

impl<'a> From<&'a Row> for Record<'a> {
    fn from(row: &'a Row) -> Self {
        Self {
            line: row.line,
            n_word: row.n_word.map(Figure),
            kind: row.kind.name(),
            axes: Letters(row.axes),
            start_s: Figure(row.start_s),
            duration_s: Figure(row.duration_s),
            peak_w: Figure(row.peak_w),
            regen_w: Figure(row.regen_w),
            limit_w: Figure(row.limit_w),
            ratio: row.ratio.map(Figure),
            energy_j: Figure(row.energy_j),
            action: row.action,
            knob: &row.knob,
            value_before: row.value_before.map(Figure),
            value_after: row.value_after.map(Figure),
            peak_after_w: row.peak_after_w.map(Figure),
            duration_after_s: row.duration_after_s.map(Figure),
            regen_after_w: row.regen_after_w.map(Figure),
            regen_limit_w: row.regen_limit_w.map(Figure),
            certificate: row.certificate.name(),
            converter: &row.converter,
            run: row.run,
            file: &row.file,
        }
    }
}

/// Axes as a word of letters (`XYZ`).
#[derive(Debug, Clone, Copy)]
pub(super) struct Letters(pub(super) AxisSet);

impl Serialize for Letters {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut text = ArrayString::<AXES>::new();
        write!(text, "{}", self.0).map_err(serde::ser::Error::custom)?;
        serializer.serialize_str(&text)
    }
}

/// A row for the tests of the formats.
#[cfg(test)]
pub(super) fn example() -> Row {
    use crate::interpret::MoveKind;
    use crate::pipeline::Certificate;
    Row {
        line: 3,
        run: 2,
        file: "sub.nc".into(),
        n_word: Some(101.0),
        kind: MoveKind::Rapid,
        axes: AxisSet(0b111),
        start_s: 360.25,
        duration_s: 1.5,
        peak_w: 4200.0,
        regen_w: 0.1 + 0.2,
        limit_w: 3150.0,
        ratio: Some(0.75),
        energy_j: 1234.5,
        action: "write as feed",
        knob: "F".into(),
        words: "G1 F12345.678".into(),
        feed_allowed: false,
        value_before: None,
        value_after: Some(12345.678),
        peak_after_w: Some(3149.999),
        start_after_s: Some(360.25),
        duration_after_s: Some(1.75),
        regen_after_w: None,
        regen_limit_w: None,
        certificate: Certificate::Planned,
        converter: "left, \"A\"".into(),
        route: None,
    }
}
