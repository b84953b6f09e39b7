//! `gwatt excite` for an axis of which something is known.

use std::fmt::Write as _;
use std::fs::File;
use std::io::{self, BufReader};
use std::path::Path;

use anyhow::{Context, Result, ensure};
use gwatt::identify::design::{Bounds, Candidate, Known, Proposal, propose};
use gwatt::identify::flexible::{Choice, Method};
use gwatt::identify::{Factor, Given, MappedColumn, Outcome, ReadAs, Recording, TransferFunction};
use gwatt::machine::{Axis, AxisKind, Machine};
use gwatt::report::Verdict;

use super::clash::refuse_clashes;
use super::input::is_dash;
use super::into::axis_of;
use super::setup::load_machine;
use super::signal::{Units, bounds, deliver, show, turns};
use super::terminal::Terminal;
use crate::cli::{ExciteArgs, ValueName};

const PERCENT: f64 = 100.0;

/// An axis with what it may do, where a machine file says so.
struct Subject {
    known: Known,
    /// Force of its acceleration, and its speed, SI.
    of_file: Option<(f64, f64)>,
}

/// Designs a signal.
///
/// # Errors
///
/// A recording or a machine that cannot be used, or bounds that leave no signal.
pub fn run(args: &ExciteArgs, terminal: Terminal) -> Result<Verdict> {
    let inputs: Vec<&Path> = args.for_recording.iter().map(AsRef::as_ref).collect();
    let outputs: Vec<&Path> = args.output.iter().map(AsRef::as_ref).collect();
    refuse_clashes(&inputs, &outputs)?;
    let subject = match (&args.for_recording, &args.machine) {
        (Some(path), _) => Subject {
            known: recorded(args, path)?,
            of_file: None,
        },
        (None, Some(machine)) => of_machine(args, machine, terminal)?,
        (None, None) => anyhow::bail!("give --for or --machine"),
    };
    let known = &subject.known;
    let name = args.name.unwrap_or(if known.rotary {
        ValueName::ExcitationNm
    } else {
        ValueName::ExcitationN
    });
    ensure!(
        !matches!(name, ValueName::CommandMm | ValueName::CommandDeg),
        "signals are designed for forces and torques: give another --name"
    );
    ensure!(
        turns(name) == known.rotary,
        "the axis {}: give another --name",
        if known.rotary {
            "turns, and a force does not"
        } else {
            "slides, and a torque does not"
        }
    );
    let (stroke, speed, units) = bounds(args, known.rotary)?;
    let of_file = |pick: fn((f64, f64)) -> f64| subject.of_file.map(pick);
    let bounds = Bounds {
        amplitude: args
            .amplitude
            .or(of_file(|(force, _)| force))
            .context("give --amplitude")?,
        seconds: args.seconds,
        stroke,
        speed: speed.or(of_file(|(_, speed)| speed)),
    };
    let proposal = propose(known, &bounds)?;
    deliver(args.output.as_deref(), name, &proposal.excitation)?;
    show(&proposal.excitation, terminal);
    terminal.note(described(known, &proposal, units));
    if let Some(remark) = steady(&proposal, units) {
        terminal.note(remark);
    }
    if known.roots.is_empty() {
        terminal.note("nothing is known of its resonances: record this signal, and design another one with --for");
    }
    Ok(Verdict::Fits)
}

/// What a first recording shows.
fn recorded(args: &ExciteArgs, path: &Path) -> Result<Known> {
    let name = path.display().to_string();
    let map = args.map.iter().map(|text| text.parse());
    let read_as = ReadAs {
        axis: match args.axis {
            Some(axis) => Some(axis_of(axis)?.letter() as char),
            None => None,
        },
        map: map.collect::<Outcome<Vec<MappedColumn>>>()?,
        rate_hz: args.rate_hz,
        preset: None,
    };
    let read = if is_dash(path) {
        Recording::read_as(io::stdin().lock(), &read_as)
    } else {
        let file =
            File::open(path).with_context(|| format!("{name}: cannot read the recording"))?;
        Recording::read_as(BufReader::new(file), &read_as)
    };
    let mut recording = read.with_context(|| name.clone())?;
    if args.reverse {
        recording.reverse();
    }
    let choice = Choice {
        method: Method::Iv,
        given: Given::default(),
        from_command: false,
    };
    Known::of_recording(&recording, &choice).with_context(|| name)
}

/// What a machine file says.
fn of_machine(args: &ExciteArgs, name: &str, terminal: Terminal) -> Result<Subject> {
    let machine = load_machine(name, terminal)?;
    let letter = args.axis.context("give --axis")?;
    let id = axis_of(letter)?;
    let axis = machine
        .axes
        .get(id as usize)
        .and_then(Option::as_ref)
        .with_context(|| format!("{name} has no axis {}", id.letter() as char))?;
    ensure!(
        axis.mass_kg > 0.0,
        "axis {} of {name} has no mass: give a first recording with --for",
        id.letter() as char
    );
    let transfer = transfer(&machine, id, axis);
    let mut known = Known::of_figures(
        transfer,
        [axis.viscous_n_s_m, axis.coulomb_n],
        args.samples_per_s().recip(),
    );
    known.rotary = axis.kind == AxisKind::Rotary;
    Ok(Subject {
        known,
        of_file: Some((
            axis.mass_kg * axis.accel_mm_s2 * axis.si_per_unit,
            axis.rapid_mm_s * axis.si_per_unit,
        )),
    })
}

/// From force to acceleration: rigid where the file does not say how it resonates.
fn transfer(machine: &Machine, id: gwatt::machine::AxisId, axis: &Axis) -> TransferFunction {
    let rigid = TransferFunction::constant(1.0 / axis.mass_kg);
    let Some(response) = machine.responses.of(id) else {
        return rigid;
    };
    let zeros: Vec<Factor> = response.zeros.iter().map(Factor::from).collect();
    let poles: Vec<Factor> = response.force_poles.iter().map(Factor::from).collect();
    let degree = |factors: &[Factor]| factors.iter().map(|f| f.degree()).sum::<usize>();
    if degree(&zeros) > degree(&poles) {
        return rigid;
    }
    TransferFunction {
        zeros,
        poles,
        ..rigid
    }
}

/// What each signal leads to, the best one first.
fn described(known: &Known, proposal: &Proposal, units: Units) -> String {
    let mut text = "expected standard errors".to_owned();
    if known.has_noise() {
        text.push_str(", next to the noise of the recording");
    } else {
        text.push_str(", if the noise is a twentieth of the acceleration");
    }
    text.push_str("; at the end how far they are from a correction to 0.1 dB and 0.6° (1: there)");
    for (index, candidate) in std::iter::once(&proposal.best)
        .chain(&proposal.others)
        .enumerate()
    {
        let first = if index == 0 { "written" } else { "       " };
        let _ = write!(text, "\n  {first}  {}", line(known, candidate, units));
    }
    text
}

fn line(known: &Known, candidate: &Candidate, (distance, mm, pace, mm_min): Units) -> String {
    let foreseen = &candidate.foreseen;
    let mut text = format!(
        "{}, amplitude {:.4}, {:.2} {mm}, {:.1} {mm_min}: {} {}",
        candidate.kind,
        candidate.amplitude,
        candidate.travel / distance,
        candidate.fastest / pace,
        if known.rotary { "inertia" } else { "mass" },
        percent(foreseen.inertia)
    );
    for ([frequency, damping], (factor, _)) in foreseen.roots.iter().zip(&known.roots) {
        let is_zero = known.transfer.zeros.contains(factor);
        let _ = write!(
            text,
            ", {} {:.1} Hz {} and its damping {}",
            if is_zero { "zero" } else { "pole" },
            factor.corner_rad_s() / std::f64::consts::TAU,
            percent(*frequency),
            percent(*damping)
        );
    }
    let _ = write!(text, "; {:.2}", candidate.by_wanted);
    text
}

fn percent(share: f64) -> String {
    let value = PERCENT * share;
    let places = if value < 0.1 {
        3
    } else if value < 10.0 {
        2
    } else {
        0
    };
    format!("{value:.places$} %")
}

/// How the axis is to move meanwhile.
fn steady(proposal: &Proposal, (distance, mm, pace, mm_min): Units) -> Option<String> {
    let best = &proposal.best;
    let speed = best.steady?;
    Some(format!(
        "move the axis at {:.1} {mm_min} one way meanwhile, {:.2} {mm} in all: turned back by the signal, its Coulomb friction would change sign and pass for something else",
        speed / pace,
        best.travel / distance
    ))
}
