//! Reports as JSON. Blocks are the only part that grows with the program: they
//! are spooled row by row and copied between head and tail.

use std::io::{self, Read, Write};

use serde::Serialize;

use super::checked::{Checked, chain};
use super::figure::Figure;
use super::finding::{Finding, UnfitMove};
use super::held::Held;
use super::over_time::OverTimeRecord;
use super::record::Record;
use crate::pipeline::{
    Certificate, Failure, Ideal, LimitSummary, Price, Row, RowSink, SetFile, SetSummary, Summary,
};

/// Writes rows as JSON objects with commas between them.
#[derive(Debug)]
pub struct JsonRows<W: Write> {
    out: W,
    any: bool,
}

impl<W: Write> JsonRows<W> {
    /// Writes to `out`, which should be buffered.
    pub fn new(out: W) -> Self {
        Self { out, any: false }
    }

    /// Writes what is still held back and gives `out` back.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn finish(mut self) -> io::Result<W> {
        self.out.flush()?;
        Ok(self.out)
    }
}

impl<W: Write + Send> RowSink for JsonRows<W> {
    fn row(&mut self, row: &Row) -> io::Result<()> {
        let between: &[u8] = if self.any { b",\n" } else { b"\n" };
        self.any = true;
        self.out.write_all(between)?;
        Ok(serde_json::to_writer(&mut self.out, &Record::from(row))?)
    }
}

#[derive(Serialize)]
struct Head<'a> {
    program: &'a str,
    machine: &'a str,
    duration_s: Figure,
    peak_w: Figure,
    peak_line: u64,
    regen_w: Figure,
    energy_j: Option<Figure>,
    fits: bool,
    certificate: Option<&'static str>,
    conditions: &'a [String],
}

impl<'a> Head<'a> {
    fn new(program: &'a str, machine: &'a str, summary: &'a Summary) -> Self {
        Self {
            program,
            machine,
            duration_s: Figure(summary.duration_s),
            peak_w: Figure(summary.peak_w),
            peak_line: summary.peak_line,
            regen_w: Figure(summary.regen_w),
            energy_j: summary.energy_j.map(Figure),
            fits: summary.fits(),
            certificate: summary.certificate.map(Certificate::name),
            conditions: &summary.conditions,
        }
    }
}

#[derive(Serialize)]
struct ReportTail<'a> {
    unfit_count: u64,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    over_time: Vec<OverTimeRecord<'a>>,
    lines: Vec<LineFigures<'a>>,
}

/// What all runs of a line come to.
#[derive(Serialize)]
pub(super) struct LineFigures<'a> {
    line: u64,
    file: &'a str,
    runs: u64,
    duration_s: Figure,
    peak_w: Figure,
    regen_w: Figure,
    energy_j: Figure,
}

impl<'a> LineFigures<'a> {
    pub(super) fn list(summary: &'a Summary) -> Vec<Self> {
        let lines = summary.by_line.iter();
        lines
            .map(|line| Self {
                line: line.line,
                file: &line.file,
                runs: line.runs,
                duration_s: Figure(line.duration_s),
                peak_w: Figure(line.peak_w),
                regen_w: Figure(line.regen_w),
                energy_j: Figure(line.energy_j),
            })
            .collect()
    }
}

#[derive(Serialize)]
struct LimitTail<'a> {
    duration_after_s: Figure,
    peak_after_w: Figure,
    regen_after_w: Figure,
    energy_after_j: Option<Figure>,
    unfit_count: u64,
    lines: Vec<LineFigures<'a>>,
    edited_lines: u64,
    certified: bool,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pauses: Vec<PauseRecord>,
    reasons: Vec<Finding<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    price: Option<PriceRecord>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    prices: Vec<PriceRecord>,
    #[serde(skip_serializing_if = "Option::is_none")]
    with_acceleration_word: Option<IdealRecord<'a>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    over_time: Vec<OverTimeRecord<'a>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    over_time_after: Vec<OverTimeRecord<'a>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    files: Vec<WrittenFile<'a>>,
}

/// What would make a program fit that does not.
#[derive(Serialize)]
pub(super) struct PriceRecord {
    allow: String,
    duration_s: Figure,
    duration_after_s: Figure,
}

impl From<&Price> for PriceRecord {
    fn from(price: &Price) -> Self {
        let [before_s, after_s] = price.duration_s;
        Self {
            allow: price.allowed.names(),
            duration_s: Figure(before_s),
            duration_after_s: Figure(after_s),
        }
    }
}

/// What a word for acceleration would bring.
#[derive(Serialize)]
pub(super) struct IdealRecord<'a> {
    duration_s: Figure,
    #[serde(skip_serializing_if = "Option::is_none")]
    duration_in_pieces_s: Option<Figure>,
    #[serde(skip_serializing_if = "<[String]>::is_empty")]
    settings: &'a [String],
}

impl<'a> From<&'a Ideal> for IdealRecord<'a> {
    fn from(ideal: &'a Ideal) -> Self {
        Self {
            duration_s: Figure(ideal.duration_s),
            duration_in_pieces_s: ideal.in_pieces_s.map(Figure),
            settings: &ideal.settings,
        }
    }
}

/// A file that the certificate is for.
#[derive(Serialize)]
struct WrittenFile<'a> {
    file: &'a str,
    edited_lines: u64,
}

impl<'a> WrittenFile<'a> {
    fn list(files: &'a [SetFile]) -> Vec<Self> {
        let files = files.iter();
        files
            .map(|file| Self {
                file: &file.name,
                edited_lines: file.edited_lines,
            })
            .collect()
    }
}

/// A program of several.
#[derive(Serialize)]
struct LimitedProgram<'a> {
    #[serde(flatten)]
    head: Head<'a>,
    #[serde(flatten)]
    tail: LimitTail<'a>,
}

#[derive(Serialize)]
struct SetHead<'a> {
    machine: &'a str,
    certified: bool,
    programs: Vec<LimitedProgram<'a>>,
}

#[derive(Serialize)]
struct SetTail<'a> {
    files: Vec<WrittenFile<'a>>,
}

/// A dwell that the original does not have.
#[derive(Serialize)]
pub(super) struct PauseRecord {
    line: u64,
    seconds: Figure,
}

impl PauseRecord {
    pub(super) fn list(summary: &LimitSummary) -> Vec<Self> {
        let pauses = summary.pauses.iter().map(|pause| Self {
            line: pause.line,
            seconds: Figure(pause.seconds),
        });
        pauses.collect()
    }
}

/// Writes what `report` found; `blocks` are the rows that [`JsonRows`] wrote.
///
/// # Errors
/// Those of `blocks` and `out`.
pub fn report_json(
    program: &str,
    machine: &str,
    summary: &Summary,
    blocks: impl Read,
    out: impl Write,
) -> io::Result<()> {
    let tail = ReportTail {
        unfit_count: summary.unfit_count,
        over_time: OverTimeRecord::list(summary),
        lines: LineFigures::list(summary),
    };
    write_object(&Head::new(program, machine, summary), blocks, &tail, out)
}

/// Writes what `limit` did. The figures of [`report_json`] are those of the
/// program as it came, certificate and conditions those of what was written.
///
/// # Errors
/// Those of `blocks` and `out`.
pub fn limit_json(
    program: &str,
    machine: &str,
    summary: &LimitSummary,
    blocks: impl Read,
    out: impl Write,
) -> io::Result<()> {
    let LimitedProgram { head, tail } = limited(program, machine, summary);
    write_object(&head, blocks, &tail, out)
}

/// Writes what `limit` did to several programs, `names`, and the files of subprograms that
/// they call. Of one program it is what [`limit_json`] writes, with the files.
///
/// # Errors
/// Those of `blocks` and `out`.
pub fn set_json(
    names: &[&str],
    machine: &str,
    set: &SetSummary,
    blocks: impl Read,
    out: impl Write,
) -> io::Result<()> {
    let files = WrittenFile::list(&set.files);
    let programs = names.iter().zip(&set.programs);
    let programs = programs.map(|(name, summary)| limited(name, machine, summary));
    let mut programs: Vec<_> = programs.collect();
    if let [LimitedProgram { head, tail }] = programs.as_mut_slice() {
        tail.files = files;
        return write_object(head, blocks, tail, out);
    }
    let head = SetHead {
        machine,
        certified: set.certified(),
        programs,
    };
    write_object(&head, blocks, &SetTail { files }, out)
}

/// The parts of what `limit` did to a program.
fn limited<'a>(
    program: &'a str,
    machine: &'a str,
    summary: &'a LimitSummary,
) -> LimitedProgram<'a> {
    let after = Head::new(program, machine, &summary.after);
    let head = Head {
        certificate: after.certificate,
        conditions: after.conditions,
        ..Head::new(program, machine, &summary.before)
    };
    let tail = LimitTail {
        duration_after_s: Figure(summary.after.duration_s),
        peak_after_w: Figure(summary.after.peak_w),
        regen_after_w: Figure(summary.after.regen_w),
        energy_after_j: summary.after.energy_j.map(Figure),
        unfit_count: summary.before.unfit_count,
        lines: LineFigures::list(&summary.before),
        edited_lines: summary.edited_lines,
        certified: summary.certified,
        pauses: PauseRecord::list(summary),
        reasons: summary.reasons.iter().map(Finding::from).collect(),
        price: summary.prices.first().map(PriceRecord::from),
        prices: summary.prices.iter().map(PriceRecord::from).collect(),
        with_acceleration_word: summary.ideal.as_ref().map(IdealRecord::from),
        over_time: OverTimeRecord::list(&summary.before),
        over_time_after: OverTimeRecord::list(&summary.after),
        files: Vec::new(),
    };
    LimitedProgram { head, tail }
}

/// Joins the keys of `head`, `blocks` and the keys of `tail` in one object.
fn write_object(
    head: &impl Serialize,
    mut blocks: impl Read,
    tail: &impl Serialize,
    mut out: impl Write,
) -> io::Result<()> {
    let head = serde_json::to_string(head)?;
    let tail = serde_json::to_string(tail)?;
    let head = head.strip_suffix('}').unwrap_or(&head);
    let tail = tail.strip_prefix('{').unwrap_or(&tail);
    write!(out, "{head},\n\"blocks\":[")?;
    io::copy(&mut blocks, &mut out)?;
    writeln!(out, "],\n{tail}")?;
    out.flush()
}

#[derive(Serialize)]
struct CheckedProgram<'a> {
    program: &'a str,
    machine: &'a str,
    duration_s: Option<Figure>,
    peak_w: Option<Figure>,
    peak_line: Option<u64>,
    regen_w: Option<Figure>,
    fits: bool,
    unfit_count: Option<u64>,
    unfit: Vec<UnfitMove<'a>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    over_time: Vec<OverTimeRecord<'a>>,
    certificate: Option<&'static str>,
    error: Option<String>,
    diagnostics: Vec<Finding<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    baseline: Option<&'a Held>,
}

impl<'a> CheckedProgram<'a> {
    fn new(checked: &'a Checked, machine: &'a str) -> Self {
        let summary = checked.outcome.as_ref().ok();
        let diagnostics = match &checked.outcome {
            Ok(summary) => summary.notes.as_slice(),
            Err(Failure::Refused { diagnostics, .. }) => diagnostics,
            Err(_) => &[],
        };
        let unfit = summary.map_or(&[][..], |summary| &summary.unfit);
        Self {
            program: &checked.program,
            machine,
            duration_s: summary.map(|summary| Figure(summary.duration_s)),
            peak_w: summary.map(|summary| Figure(summary.peak_w)),
            peak_line: summary.map(|summary| summary.peak_line),
            regen_w: summary.map(|summary| Figure(summary.regen_w)),
            fits: summary.is_some_and(Summary::fits),
            unfit_count: summary.map(|summary| summary.unfit_count),
            unfit: unfit.iter().map(UnfitMove::from).collect(),
            over_time: summary.map_or_else(Vec::new, OverTimeRecord::list),
            certificate: summary
                .and_then(|summary| summary.certificate)
                .map(Certificate::name),
            error: checked.outcome.as_ref().err().map(|error| chain(error)),
            diagnostics: diagnostics.iter().map(Finding::from).collect(),
            baseline: checked.held.as_ref(),
        }
    }
}

/// Writes what `check` found as an array with one object a program.
///
/// # Errors
/// Those of `out`.
pub fn check_json(checked: &[Checked], machine: &str, mut out: impl Write) -> io::Result<()> {
    let programs: Vec<_> = checked
        .iter()
        .map(|checked| CheckedProgram::new(checked, machine))
        .collect();
    serde_json::to_writer_pretty(&mut out, &programs)?;
    writeln!(out)
}

/// Version of the lines of [`check_json_line`]: it grows when a key changes its meaning or goes.
const LINE_VERSION: u32 = 1;

/// Writes what `check` found of a program as one object in a line: its keys in
/// [`check_json`], the version of the format, and the energy where it was asked for.
///
/// # Errors
/// Those of `out`.
pub fn check_json_line(checked: &Checked, machine: &str, mut out: impl Write) -> io::Result<()> {
    #[derive(Serialize)]
    struct Line<'a> {
        version: u32,
        gwatt: &'static str,
        #[serde(flatten)]
        program: CheckedProgram<'a>,
        only_subprograms: bool,
        moves: Option<u64>,
        energy_j: Option<Figure>,
    }
    let summary = checked.outcome.as_ref().ok();
    let line = Line {
        version: LINE_VERSION,
        gwatt: env!("CARGO_PKG_VERSION"),
        program: CheckedProgram::new(checked, machine),
        only_subprograms: checked.counted().is_none(),
        moves: summary.map(|summary| summary.moves),
        energy_j: summary.and_then(|summary| summary.energy_j).map(Figure),
    };
    serde_json::to_writer(&mut out, &line)?;
    writeln!(out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::record::example;

    #[test]
    fn a_report_has_its_keys_in_order() -> io::Result<()> {
        let mut rows = JsonRows::new(Vec::new());
        rows.row(&example())?;
        rows.row(&example())?;
        let blocks = rows.finish()?;
        let summary = Summary {
            duration_s: 12.5,
            peak_w: 2000.0,
            peak_line: 3,
            ..Summary::default()
        };
        let mut out = Vec::new();
        report_json("a\"b.ngc", "mill", &summary, &blocks[..], &mut out)?;
        let value: serde_json::Value = serde_json::from_slice(&out)?;
        assert_eq!(value["blocks"].as_array().map(Vec::len), Some(2));
        assert_eq!(value["blocks"][1]["regen_w"], 0.3);
        let text = String::from_utf8_lossy(&out);
        let head = text.lines().next().unwrap_or_default();
        insta::assert_snapshot!(head, @r#"{"program":"a\"b.ngc","machine":"mill","duration_s":12.5,"peak_w":2000,"peak_line":3,"regen_w":0,"energy_j":null,"fits":true,"certificate":null,"conditions":[],"#);
        Ok(())
    }
}
