//! Results as data for serde, with the names and figures of the JSON that the commands write.

use serde::ser::SerializeStruct;
use serde::{Serialize, Serializer};

use super::figure::Figure;
use super::finding::{Finding, UnfitMove};
use super::json::{IdealRecord, LineFigures, PauseRecord, PriceRecord};
use super::over_time::OverTimeRecord;
use super::record::Record;
use crate::pipeline::{Certificate, LimitSummary, Row, Summary};

/// A row, under the names of the columns.
impl Serialize for Row {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Record::from(self).serialize(serializer)
    }
}

/// The figures of a program: those of `check --format json`, with what `report` adds.
#[derive(Serialize)]
struct SummaryRecord<'a> {
    program_lines: u64,
    moves: u64,
    duration_s: Figure,
    peak_w: Figure,
    peak_line: u64,
    regen_w: Figure,
    regen_line: u64,
    energy_j: Option<Figure>,
    fits: bool,
    unfit_count: u64,
    unfit: Vec<UnfitMove<'a>>,
    over_time: Vec<OverTimeRecord<'a>>,
    certificate: Option<&'static str>,
    conditions: &'a [String],
    diagnostics: Vec<Finding<'a>>,
    lines: Vec<LineFigures<'a>>,
}

impl<'a> From<&'a Summary> for SummaryRecord<'a> {
    fn from(summary: &'a Summary) -> Self {
        Self {
            program_lines: summary.lines,
            moves: summary.moves,
            duration_s: Figure(summary.duration_s),
            peak_w: Figure(summary.peak_w),
            peak_line: summary.peak_line,
            regen_w: Figure(summary.regen_w),
            regen_line: summary.regen_line,
            energy_j: summary.energy_j.map(Figure),
            fits: summary.fits(),
            unfit_count: summary.unfit_count,
            unfit: summary.unfit.iter().map(UnfitMove::from).collect(),
            over_time: OverTimeRecord::list(summary),
            certificate: summary.certificate.map(Certificate::name),
            conditions: &summary.conditions,
            diagnostics: summary.notes.iter().map(Finding::from).collect(),
            lines: LineFigures::list(summary),
        }
    }
}

impl Serialize for Summary {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        SummaryRecord::from(self).serialize(serializer)
    }
}

/// What `limit` did, with the figures of the program as it came and as written.
impl Serialize for LimitSummary {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let reasons: Vec<_> = self.reasons.iter().map(Finding::from).collect();
        let mut out = serializer.serialize_struct("LimitSummary", 9)?;
        out.serialize_field("before", &self.before)?;
        out.serialize_field("after", &self.after)?;
        out.serialize_field("edited_lines", &self.edited_lines)?;
        out.serialize_field("certified", &self.certified)?;
        out.serialize_field("pauses", &PauseRecord::list(self))?;
        out.serialize_field("reasons", &reasons)?;
        out.serialize_field("price", &self.prices.first().map(PriceRecord::from))?;
        let prices: Vec<_> = self.prices.iter().map(PriceRecord::from).collect();
        out.serialize_field("prices", &prices)?;
        let ideal = self.ideal.as_ref().map(IdealRecord::from);
        out.serialize_field("with_acceleration_word", &ideal)?;
        out.end()
    }
}
