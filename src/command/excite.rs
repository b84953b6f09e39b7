//! `gwatt excite`.

use std::io::{BufWriter, Write};
use std::path::Path;

use anyhow::{Context, Result, bail, ensure};
use gwatt::identify::excitation::{Excitation, Shape, make, order_for, reach};
use gwatt::report::Verdict;
use gwatt::units::{M_PER_MM, RAD_PER_DEG, SECONDS_PER_MINUTE};

use super::output::Target;
use super::terminal::Terminal;
use crate::cli::{ExciteArgs, ShapeArg, ValueName};

/// Makes a signal.
pub fn run(args: &ExciteArgs, terminal: Terminal) -> Result<Verdict> {
    ensure!(
        args.rate_hz.is_finite() && args.rate_hz > 0.0,
        "--rate-hz {} is not positive",
        args.rate_hz
    );
    let signal = make(shape(args)?, args.amplitude, args.rate_hz.recip())?;
    let warnings = warnings(args, &signal)?;
    let target = match &args.output {
        Some(path) => Target::new(path)?,
        None => Target::new(Path::new("-"))?,
    };
    let mut spool = BufWriter::new(target.spool()?);
    write(args, &signal, &mut spool).context("cannot write the signal")?;
    let spool = spool
        .into_inner()
        .map_err(std::io::IntoInnerError::into_error)?;
    spool.deliver()?;
    tell(&signal, terminal);
    for warning in warnings {
        terminal.text(&format!("gwatt: warning: {warning}\n"));
    }
    Ok(Verdict::Fits)
}

fn shape(args: &ExciteArgs) -> Result<Shape> {
    let period_s = args.rate_hz.recip();
    if let Some(resolution) = args.resolution_hz {
        ensure!(
            resolution.is_finite() && resolution > 0.0,
            "--resolution-hz {resolution} is not positive"
        );
    }
    let seconds = args
        .seconds
        .or(args.resolution_hz.map(f64::recip))
        .unwrap_or(10.0);
    let (from_hz, to_hz) = (args.from_hz, args.to_hz.unwrap_or(0.4 * args.rate_hz));
    Ok(match args.shape {
        ShapeArg::MSequence => {
            ensure!(args.hold > 0, "--hold 0 makes no signal");
            let order = match (args.order, args.resolution_hz) {
                (Some(order), _) => order,
                (None, Some(hz)) => order_for(hz, args.hold, period_s).with_context(|| {
                    format!("{hz} Hz need more than 20 bits: give a larger --hold")
                })?,
                (None, None) => 12,
            };
            Shape::MSequence {
                order,
                hold: args.hold,
                repetitions: args.repeat,
            }
        }
        ShapeArg::LogSweep | ShapeArg::LinearSweep => Shape::Sweep {
            from_hz,
            to_hz,
            seconds,
            logarithmic: args.shape == ShapeArg::LogSweep,
        },
        ShapeArg::Random => Shape::Random {
            from_hz,
            to_hz,
            seconds,
            seed: args.seed,
        },
    })
}

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

fn write(args: &ExciteArgs, signal: &Excitation, out: &mut impl Write) -> std::io::Result<()> {
    writeln!(out, "time_s,{}", column(args.name))?;
    for (k, value) in signal.values.iter().enumerate() {
        // Twelve digits: the rounding of k/rate is no jitter.
        let time = format!("{:.12}", k as f64 / args.rate_hz);
        let time = time.trim_end_matches('0').trim_end_matches('.');
        writeln!(out, "{time},{value}")?;
    }
    Ok(())
}

fn tell(signal: &Excitation, terminal: Terminal) {
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

/// Where the axis would leave what it is given.
fn warnings(args: &ExciteArgs, signal: &Excitation) -> Result<Vec<String>> {
    let rotary = matches!(
        args.name,
        ValueName::ExcitationNm | ValueName::TorqueNm | ValueName::CommandDeg
    );
    let (stroke, speed, unit) = if rotary {
        ensure!(
            args.stroke_mm.is_none() && args.speed_mm_min.is_none(),
            "a torque or an angle turns: give --stroke-deg and --speed-rpm, or another --name"
        );
        (
            args.stroke_deg.map(|s| s * RAD_PER_DEG),
            args.speed_rpm
                .map(|n| n * 2.0 * std::f64::consts::PI / SECONDS_PER_MINUTE),
            (
                RAD_PER_DEG,
                "deg",
                2.0 * std::f64::consts::PI / SECONDS_PER_MINUTE,
                "rpm",
            ),
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
    };
    if stroke.is_none() && speed.is_none() {
        return Ok(Vec::new());
    }
    let (length, fastest) = if matches!(args.name, ValueName::CommandMm | ValueName::CommandDeg) {
        let steps = signal.values.iter().zip(signal.values.iter().skip(1));
        let largest = steps.map(|(a, b)| (b - a).abs()).fold(0.0, f64::max);
        let low = signal.values.iter().copied().fold(f64::MAX, f64::min);
        let high = signal.values.iter().copied().fold(f64::MIN, f64::max);
        ((high - low) * unit.0, largest * unit.0 / signal.period_s)
    } else {
        let Some(mass) = args.mass_kg.or(args.inertia_kg_m2) else {
            bail!("to compare with stroke and speed give --mass-kg or --inertia-kg-m2");
        };
        ensure!(
            mass.is_finite() && mass > 0.0,
            "the mass {mass} is not positive"
        );
        let (half, fastest, _) = reach(&signal.values, signal.period_s, mass);
        (2.0 * half, fastest)
    };
    let mut warnings = Vec::new();
    if let Some(stroke) = stroke.filter(|stroke| length > *stroke) {
        warnings.push(format!(
            "without friction the axis would travel {:.3} {}, and {:.3} are free: lower --amplitude, or excite in a closed loop",
            length / unit.0,
            unit.1,
            stroke / unit.0
        ));
    }
    if let Some(speed) = speed.filter(|speed| fastest > *speed) {
        warnings.push(format!(
            "the axis would reach {:.1} {}, and {:.1} are allowed: lower --amplitude",
            fastest / unit.2,
            unit.3,
            speed / unit.2
        ));
    }
    Ok(warnings)
}
