//! What laying a recording over its prediction has come to.

use std::fmt::Write as _;
use std::io::{self, Write};

use serde::Serialize;

use super::figure::Figure;
use super::quantity::power;
use crate::identify::merge::rounded_up;
use crate::identify::overlay::{Agreement, AxisFactor, BlockPeaks, Overlay};

/// Blocks that are listed for people.
const LISTED: usize = 10;

/// What was laid over what.
#[derive(Debug, Clone)]
pub struct VerifiedNames {
    /// The program.
    pub program: String,
    /// The recording.
    pub log: String,
    /// The machine.
    pub machine: String,
    /// The margin that its file has.
    pub margin: f64,
    /// `servo_factor_motor` that its file has of each axis.
    pub servo_factors: Vec<(char, f64)>,
}

impl VerifiedNames {
    /// Whether the machine file covers what was measured: by its margin alone, or with its
    /// factors of axes.
    #[must_use]
    pub fn covers(&self, overlay: &Overlay) -> bool {
        let mut axes = overlay.axes.iter();
        let has_factors = axes.all(|axis| {
            let present = self.servo_factors.iter().find(|it| it.0 == axis.letter);
            present.is_some_and(|(_, factor)| axis.motor <= *factor)
        });
        overlay.margin() <= self.margin
            || has_factors && overlay.margin_beyond_axes() <= self.margin
    }
}

/// The blocks that draw most above their prediction, worst first.
pub(super) fn worst(overlay: &Overlay) -> Vec<&BlockPeaks> {
    let mut blocks: Vec<&BlockPeaks> = overlay.blocks.iter().collect();
    let excess = |it: &BlockPeaks| it.measured_w - it.predicted_w;
    blocks.sort_by(|a, b| excess(b).total_cmp(&excess(a)));
    blocks
}

/// For people.
#[must_use]
pub fn verified_text(names: &VerifiedNames, overlay: &Overlay) -> String {
    let Overlay {
        start_s,
        pace,
        correlation,
        averaging_s,
        gain,
        offset_w,
        rms_w,
        energy_ratio,
        measured_peak_w,
        factor,
        factor_error,
        short_peaks,
        ..
    } = overlay;
    let mut text = format!("{}: {} on {}\n", names.log, names.program, names.machine);
    let mut line = |name: &str, value: String| {
        let _ = writeln!(text, "  {name:<18}{value}");
    };
    line("begins at", format!("{start_s:.3} s of the log"));
    line(
        "takes",
        format!("{:.2} % of the time that is planned", pace * 100.0),
    );
    line("correlation", format!("{correlation:.4}"));
    if *averaging_s > 0.0 {
        let shown = format!(
            "over {:.0} ms: what is shorter is not in the log",
            averaging_s * 1e3
        );
        line("meter averages", shown);
    }
    line(
        "measured",
        format!(
            "{gain:.3} × predicted {} {}, rms error {}",
            if *offset_w < 0.0 { '-' } else { '+' },
            power(offset_w.abs()),
            power(*rms_w)
        ),
    );
    line("energy", format!("{energy_ratio:.3} × predicted"));
    line("largest", format!("{} measured", power(*measured_peak_w)));
    let needed = overlay.margin();
    let only = if needed <= names.margin { "" } else { "only " };
    let beyond = if overlay.axes.is_empty() {
        String::new()
    } else {
        let beyond = rounded_up(overlay.margin_beyond_axes());
        format!(", or {beyond:.3} next to the factors of axes")
    };
    for axis in &overlay.axes {
        line(&format!("axis {}", axis.letter), axis_factor(axis));
    }
    line(
        "peaks",
        format!(
            "at most {:.3} ± {factor_error:.3} × predicted, {} of them{}",
            factor.seen,
            factor.peaks,
            too_few(*short_peaks)
        ),
    );
    line(
        "margin",
        format!(
            "{:.3} covers them{beyond}; 95 % of others {:.3}, with 95 % confidence; the machine file has {only}{}",
            rounded_up(needed),
            rounded_up(overlay.margin_of_others()),
            names.margin
        ),
    );
    blocks_above(overlay, &mut text);
    let _ = writeln!(text, "verdict: {}", verdict(overlay));
    text
}

/// How many peaks say nothing of their own.
fn too_few(short: usize) -> String {
    match short {
        0 => String::new(),
        more => format!(", {more} with too few samples"),
    }
}

/// What the power of an axis shows.
fn axis_factor(axis: &AxisFactor) -> String {
    let AxisFactor {
        motor,
        peaks,
        measured_peak_w,
        predicted_peak_w,
        ..
    } = axis;
    format!(
        "servo_factor_motor {motor:.3} covers its {peaks} {}: {} measured, {} predicted at most",
        if *peaks == 1 { "peak" } else { "peaks" },
        power(*measured_peak_w),
        power(*predicted_peak_w),
    )
}

/// The blocks that draw more than predicted, worst first.
fn blocks_above(overlay: &Overlay, text: &mut String) {
    let worst = worst(overlay);
    let above: Vec<_> = worst
        .iter()
        .filter(|it| it.measured_w > it.predicted_w)
        .collect();
    if above.is_empty() {
        text.push_str("no block draws more than predicted\n");
    } else {
        let _ = writeln!(
            text,
            "blocks that draw most above their prediction, of {}:",
            overlay.blocks.len()
        );
        for it in above.into_iter().take(LISTED) {
            let _ = writeln!(
                text,
                "  line {:<7} {:>9} measured, {:>9} predicted, {:+.1} %, at {:.2} s",
                it.block,
                power(it.measured_w),
                power(it.predicted_w),
                (it.measured_by_predicted() - 1.0) * 100.0,
                it.start_s,
            );
        }
    }
}

/// The agreement in a sentence.
fn verdict(overlay: &Overlay) -> String {
    let short = overlay.short_peaks;
    let why = match overlay.agreement() {
        Agreement::Good => return "good".to_owned(),
        Agreement::SampledSlowly => &*format!(
            "{short} of {} have too few samples; the margin rests on the slope, measured by predicted: record at shorter steps",
            overlay.factor.peaks
        ),
        Agreement::RunsOtherwise => {
            "times differ along the program: record at 100 % override, without waits for the operator"
        }
        Agreement::AnotherUnit => {
            "measured and predicted differ more than tenfold: say the unit of the log's column, as in power_kw, and check the masses"
        }
        Agreement::AnotherProgram => "the log does not go up and down as this program would",
    };
    format!("{}: {why}", overlay.agreement().name())
}

#[derive(Serialize)]
struct Record<'a> {
    log: &'a str,
    program: &'a str,
    machine: &'a str,
    verdict: &'static str,
    start_s: Figure,
    pace: Figure,
    correlation: Figure,
    averaging_s: Figure,
    gain: Figure,
    offset_w: Figure,
    rms_w: Figure,
    energy_ratio: Figure,
    measured_peak_w: Figure,
    peak_factor: Figure,
    peak_factor_seen: Figure,
    peak_factor_error: Figure,
    peaks: usize,
    short_peaks: usize,
    margin: Figure,
    margin_of_others: Figure,
    margin_beyond_axes: Figure,
    axes: Vec<AxisRecord>,
    blocks: Vec<BlockRecord>,
}

#[derive(Serialize)]
struct AxisRecord {
    axis: char,
    servo_factor_motor: Figure,
    peaks: usize,
    measured_peak_w: Figure,
    predicted_peak_w: Figure,
}

impl From<&AxisFactor> for AxisRecord {
    fn from(it: &AxisFactor) -> Self {
        Self {
            axis: it.letter,
            servo_factor_motor: Figure(it.motor),
            peaks: it.peaks,
            measured_peak_w: Figure(it.measured_peak_w),
            predicted_peak_w: Figure(it.predicted_peak_w),
        }
    }
}

#[derive(Serialize)]
struct BlockRecord {
    line: u64,
    runs: u64,
    start_s: Figure,
    measured_w: Figure,
    predicted_w: Figure,
    measured_by_predicted: Figure,
}

impl From<&BlockPeaks> for BlockRecord {
    fn from(it: &BlockPeaks) -> Self {
        Self {
            line: it.block,
            runs: it.runs,
            start_s: Figure(it.start_s),
            measured_w: Figure(it.measured_w),
            predicted_w: Figure(it.predicted_w),
            measured_by_predicted: Figure(it.measured_by_predicted()),
        }
    }
}

/// As JSON.
///
/// # Errors
/// Those of `out`.
pub fn verified_json(
    names: &VerifiedNames,
    overlay: &Overlay,
    mut out: impl Write,
) -> io::Result<()> {
    let record = Record {
        log: &names.log,
        program: &names.program,
        machine: &names.machine,
        verdict: overlay.agreement().name(),
        start_s: Figure(overlay.start_s),
        pace: Figure(overlay.pace),
        correlation: Figure(overlay.correlation),
        averaging_s: Figure(overlay.averaging_s),
        gain: Figure(overlay.gain),
        offset_w: Figure(overlay.offset_w),
        rms_w: Figure(overlay.rms_w),
        energy_ratio: Figure(overlay.energy_ratio),
        measured_peak_w: Figure(overlay.measured_peak_w),
        peak_factor: Figure(overlay.factor.factor),
        peak_factor_seen: Figure(overlay.factor.seen),
        peak_factor_error: Figure(overlay.factor_error),
        peaks: overlay.factor.peaks,
        short_peaks: overlay.short_peaks,
        margin: Figure(overlay.margin()),
        margin_of_others: Figure(overlay.margin_of_others()),
        margin_beyond_axes: Figure(overlay.margin_beyond_axes()),
        axes: overlay.axes.iter().map(AxisRecord::from).collect(),
        blocks: overlay.blocks.iter().map(BlockRecord::from).collect(),
    };
    serde_json::to_writer_pretty(&mut out, &record)?;
    writeln!(out)
}

/// The blocks as CSV, in order of their lines.
///
/// # Errors
/// Those of `out`.
pub fn verified_csv(overlay: &Overlay, out: impl Write) -> io::Result<()> {
    let mut csv = csv::Writer::from_writer(out);
    for block in &overlay.blocks {
        csv.serialize(BlockRecord::from(block))
            .map_err(io::Error::other)?;
    }
    csv.flush()
}
