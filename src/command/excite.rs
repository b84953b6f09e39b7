//! `gwatt excite`.

use anyhow::{Context, Result, bail, ensure};
use gwatt::identify::excitation::{Excitation, Shape, make, order_for, reach};
use gwatt::report::Verdict;

use super::designed;
use super::signal::{bounds, deliver, show, turns};
use super::terminal::Terminal;
use crate::cli::{ExciteArgs, ShapeArg, ValueName};

/// Makes a signal.
pub fn run(args: &ExciteArgs, terminal: Terminal) -> Result<Verdict> {
    let rate_hz = args.samples_per_s();
    ensure!(
        rate_hz.is_finite() && rate_hz > 0.0,
        "--rate-hz {rate_hz} is not positive"
    );
    if args.for_recording.is_some() || args.machine.is_some() {
        return designed::run(args, terminal);
    }
    ensure!(
        args.axis.is_none(),
        "--axis has no meaning without --for or --machine"
    );
    let amplitude = args.amplitude.context("give --amplitude")?;
    let name = args.name.unwrap_or(ValueName::ExcitationNm);
    let signal = make(shape(args)?, amplitude, rate_hz.recip())?;
    let warnings = warnings(args, name, &signal)?;
    deliver(args.output.as_deref(), name, &signal)?;
    show(&signal, terminal);
    for warning in warnings {
        terminal.text(&format!("gwatt: warning: {warning}\n"));
    }
    Ok(Verdict::Fits)
}

fn shape(args: &ExciteArgs) -> Result<Shape> {
    let period_s = args.samples_per_s().recip();
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
    let (from_hz, to_hz) = (
        args.from_hz,
        args.to_hz.unwrap_or(0.4 * args.samples_per_s()),
    );
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

/// Where the axis would leave what it is given.
fn warnings(args: &ExciteArgs, name: ValueName, signal: &Excitation) -> Result<Vec<String>> {
    let rotary = turns(name);
    let (stroke, speed, unit) = bounds(args, rotary)?;
    if stroke.is_none() && speed.is_none() {
        return Ok(Vec::new());
    }
    let (length, fastest) = if matches!(name, ValueName::CommandMm | ValueName::CommandDeg) {
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
