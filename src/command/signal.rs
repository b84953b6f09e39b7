//! Signals of `excite`: their columns and units, and the file that they go into.

use std::io::{BufWriter, Write};
use std::path::Path;

use anyhow::{Context, Result, ensure};
use gwatt::identify::excitation::Excitation;
use gwatt::units::{M_PER_MM, RAD_PER_DEG, RAD_S_PER_RPM, SECONDS_PER_MINUTE};

use super::output::Target;
use super::terminal::Terminal;
use crate::cli::{ExciteArgs, ValueName};

/// The column of a value.
fn column(name: ValueName) -> &'static str {
    match name {
        ValueName::ExcitationNm => "excitation_nm",
        ValueName::ExcitationN => "excitation_n",
        ValueName::TorqueNm => "torque_nm",
        ValueName::ForceN => "force_n",
        ValueName::CommandMm => "command_mm",
        ValueName::CommandDeg => "command_deg",
    }
}

/// Whether it is of an axis that turns.
pub fn turns(name: ValueName) -> bool {
    matches!(
        name,
        ValueName::ExcitationNm | ValueName::TorqueNm | ValueName::CommandDeg
    )
}

/// A unit of distance and one of speed, by SI, with their names.
pub type Units = (f64, &'static str, f64, &'static str);

/// Stroke and speed that are given, SI, and the units of such an axis.
///
/// # Errors
///
/// Those of the other kind of axis.
pub fn bounds(args: &ExciteArgs, rotary: bool) -> Result<(Option<f64>, Option<f64>, Units)> {
    Ok(if rotary {
        ensure!(
            args.stroke_mm.is_none() && args.speed_mm_min.is_none(),
            "a torque or an angle turns: give --stroke-deg and --speed-rpm, or another --name"
        );
        (
            args.stroke_deg.map(|s| s * RAD_PER_DEG),
            args.speed_rpm.map(|n| n * RAD_S_PER_RPM),
            (RAD_PER_DEG, "deg", RAD_S_PER_RPM, "rpm"),
        )
    } else {
        ensure!(
            args.stroke_deg.is_none() && args.speed_rpm.is_none(),
            "a force or a distance slides: give --stroke-mm and --speed-mm-min, or another --name"
        );
        (
            args.stroke_mm.map(|s| s * M_PER_MM),
            args.speed_mm_min.map(|v| v * M_PER_MM / SECONDS_PER_MINUTE),
            (M_PER_MM, "mm", M_PER_MM / SECONDS_PER_MINUTE, "mm/min"),
        )
    })
}

/// Says what a signal covers.
pub fn show(signal: &Excitation, terminal: Terminal) {
    terminal.note(format_args!(
        "{} samples, {:.3} s; {:.3} to {:.1} Hz, resolution {:.3} Hz; peak {}, rms {:.4}",
        signal.values.len(),
        signal.values.len() as f64 * signal.period_s,
        signal.band_hz.0,
        signal.band_hz.1,
        signal.resolution_hz,
        signal.peak,
        signal.rms
    ));
}

/// Writes a signal, whole or not at all.
pub fn deliver(output: Option<&Path>, name: ValueName, signal: &Excitation) -> Result<()> {
    let target = Target::new(output.unwrap_or(Path::new("-")))?;
    let mut spool = BufWriter::new(target.spool()?);
    write(name, signal, &mut spool).context("cannot write the signal")?;
    let spool = spool
        .into_inner()
        .map_err(std::io::IntoInnerError::into_error)?;
    spool.deliver()?;
    Ok(())
}

fn write(name: ValueName, signal: &Excitation, out: &mut impl Write) -> std::io::Result<()> {
    writeln!(out, "time_s,{}", column(name))?;
    let rate_hz = signal.period_s.recip();
    for (k, value) in signal.values.iter().enumerate() {
        // Twelve digits: the rounding of k/rate is no jitter.
        let time = format!("{:.12}", k as f64 / rate_hz);
        let time = time.trim_end_matches('0').trim_end_matches('.');
        writeln!(out, "{time},{value}")?;
    }
    Ok(())
}
