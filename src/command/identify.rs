//! `gwatt identify`.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use gwatt::identify::flexible::{self, Flexible};
use gwatt::identify::judgement;
use gwatt::identify::merge::{self, AxisFigures, six_digits};
use gwatt::identify::response_table::{self, ResponseFigures};
use gwatt::identify::rigid::{self, Figure, Rigid};
use gwatt::identify::tune::Zero;
use gwatt::identify::{Judgement, Kind, Quantity, Recording, TransferFunction};
use gwatt::report::{
    Heading, Verdict, flexible_json, flexible_page, flexible_text, rigid_json, rigid_page,
    rigid_text,
};

use super::clash::refuse_clashes;
use super::input::is_dash;
use super::into::{Merged, axis_of, written};
use super::model_choice::ModelChoice;
use super::output::{Spool, Target, print};
use super::recorded::RecordingReader;
use super::terminal::Terminal;
use crate::cli::{IdentifyArgs, MethodArg};

/// What was found.
enum Found {
    Rigid(Box<Rigid>),
    Flexible(Box<Flexible>),
}

impl Found {
    fn judged(&self) -> Judgement {
        match self {
            Self::Rigid(rigid) => judgement::rigid(rigid),
            Self::Flexible(axis) => judgement::flexible(axis),
        }
    }
}

/// Identifies an axis.
pub fn run(args: &IdentifyArgs, terminal: Terminal) -> Result<Verdict> {
    let axis = axis_of(args.axis)?;
    let letter = axis.letter() as char;
    let inputs: Vec<&Path> = args
        .recordings
        .iter()
        .chain(&args.validate)
        .map(AsRef::as_ref)
        .collect();
    let files = [
        &args.json,
        &args.toml,
        &args.into,
        &args.response,
        &args.html,
    ];
    let outputs: Vec<&Path> = files.into_iter().flatten().map(AsRef::as_ref).collect();
    refuse_clashes(&inputs, &outputs)?;
    let model = ModelChoice::of(args)?;
    let reader = RecordingReader::new(args, letter)?;
    let recordings = args
        .recordings
        .iter()
        .map(|path| reader.open(path))
        .collect::<Result<Vec<_>>>()?;
    let [recording, others @ ..] = recordings.as_slice() else {
        bail!("there is no recording");
    };
    ensure!(
        others.is_empty() || matches!(model, ModelChoice::Rigid { .. }),
        "several recordings are joined for a rigid axis alone: give one for a flexible axis"
    );
    ensure!(
        others.iter().all(|other| kinds(other) == kinds(recording)),
        "some of the recordings have force and motion, others torque or angles: join such of the same signals"
    );
    let second = match &args.validate {
        Some(path) => Some((path, reader.open(path)?)),
        None => None,
    };
    let name = || title(&args.recordings);
    let (found, validation) = match &model {
        ModelChoice::Rigid {
            friction,
            bandwidth_hz,
        } => {
            let found = rigid::fit_all(&recordings, *friction, *bandwidth_hz).with_context(name)?;
            let error = second.map(|(path, other)| {
                rigid::predict_error(&found, &other).with_context(|| path.display().to_string())
            });
            (Found::Rigid(Box::new(found)), error.transpose()?)
        }
        ModelChoice::Flexible(choice) => {
            let found = flexible::identify(recording, choice).with_context(name)?;
            let error = second.map(|(path, other)| {
                flexible::predict_error(&found, &other, choice)
                    .with_context(|| path.display().to_string())
            });
            (Found::Flexible(Box::new(found)), error.transpose()?)
        }
    };
    let heading = heading(args, letter, recording, validation);
    deliver(args, &heading, &found, recording, terminal)
}

/// The recordings by name; many by their number.
fn title(recordings: &[PathBuf]) -> String {
    match recordings {
        [one] => one.display().to_string(),
        many => format!("{} recordings", many.len()),
    }
}

/// Whether force and motion slide or turn.
fn kinds(recording: &Recording) -> [Option<Kind>; 2] {
    let force = recording.get(Quantity::Force);
    [force.map(|signal| signal.kind), motion(recording)]
}

fn heading(
    args: &IdentifyArgs,
    axis: char,
    recording: &Recording,
    validation: Option<f64>,
) -> Heading {
    let force = recording
        .get(Quantity::Force)
        .or_else(|| recording.get(Quantity::Excitation));
    let is_torque = force.is_some_and(|force| force.kind == Kind::Rotary);
    let mut notes = Vec::new();
    if !recording.ignored.is_empty() {
        notes.push(format!(
            "columns that are passed over: {}",
            recording.ignored.join(", ")
        ));
    }
    notes.extend(recording.notes.iter().cloned());
    let lever_is_missing =
        force.is_some_and(|force| motion(recording).is_some_and(|kind| kind != force.kind));
    if lever_is_missing {
        notes.push(format!(
            "{}: figures are for a lever of 1 m; give --lead-mm to get mass and force",
            mixed(is_torque)
        ));
    }
    Heading {
        recording: title(&args.recordings),
        axis,
        rotary: is_torque,
        validation,
        lever_is_missing,
        notes,
    }
}

/// What does not go together without a lever.
fn mixed(is_torque: bool) -> &'static str {
    if is_torque {
        "torque with a motion in metres"
    } else {
        "force with a motion in radians"
    }
}

/// Whether the motion slides or turns; `None` without one.
fn motion(recording: &Recording) -> Option<Kind> {
    [
        Quantity::Acceleration,
        Quantity::Velocity,
        Quantity::Position,
    ]
    .into_iter()
    .find_map(|quantity| recording.get(quantity))
    .map(|signal| signal.kind)
}

fn figures(heading: &Heading, found: &Found) -> AxisFigures {
    let gravity = match found {
        Found::Rigid(rigid) => rigid.offset,
        Found::Flexible(_) => None,
    };
    let (mass, viscous, coulomb) = match found {
        Found::Rigid(rigid) => (
            rigid.mass.value,
            rigid.viscous.map(|f| f.value),
            rigid.coulomb.map(|f| f.value),
        ),
        Found::Flexible(axis) => (
            axis.inertia.map_or(f64::NAN, |f| f.value),
            axis.viscous.map(|f| f.value),
            axis.coulomb.map(|f| f.value),
        ),
    };
    let std_of = |figure: Option<Figure>| figure.map_or(0.0, |figure| figure.std);
    let std = match found {
        Found::Rigid(rigid) => Some([rigid.mass.std, std_of(rigid.viscous), std_of(rigid.coulomb)]),
        Found::Flexible(axis) => axis
            .inertia
            .map(|figure| [figure.std, std_of(axis.viscous), std_of(axis.coulomb)]),
    };
    AxisFigures {
        std,
        rotary: heading.rotary,
        mass,
        viscous,
        coulomb,
        gravity,
        efficiency: None,
    }
}

fn deliver(
    args: &IdentifyArgs,
    heading: &Heading,
    found: &Found,
    recording: &Recording,
    terminal: Terminal,
) -> Result<Verdict> {
    let method = method_name(args.method);
    let judged = found.judged();
    let figures = figures(heading, found);
    let usable = figures.mass.is_finite() && figures.mass > 0.0;
    // Everything is prepared before anything is put in place.
    let mut spools: Vec<Spool> = Vec::new();
    if let Some(path) = &args.json {
        spools.push(spooled(path, |out| match found {
            Found::Rigid(rigid) => rigid_json(heading, rigid, out),
            Found::Flexible(axis) => flexible_json(heading, method, axis, out),
        })?);
    }
    if let Some(path) = &args.toml {
        ensure!(
            usable,
            "no mass was identified: there is nothing for --toml"
        );
        spools.push(spooled(path, |out| toml(heading, &figures, judged, out))?);
    }
    if let (Some(path), Found::Flexible(axis)) = (&args.response, found) {
        spools.push(spooled(path, |out| response(axis, out))?);
    }
    if let Some(path) = &args.html {
        spools.push(spooled(path, |out| match found {
            // What cannot be laid over its recording has figures alone.
            Found::Rigid(axis) => {
                let trace = rigid::trace(axis, recording).ok();
                rigid_page(heading, axis, trace.as_ref(), out)
            }
            Found::Flexible(axis) => flexible_page(heading, method, axis, out),
        })?);
    }
    let response = match found {
        Found::Flexible(axis) => Some(response_figures(axis)),
        Found::Rigid(_) => None,
    };
    let is_refused = args.into.is_some() && judged != Judgement::Good && !args.force;
    let merged = match &args.into {
        Some(path) if !is_refused => {
            let merged = merged(path, heading, &figures, usable, response)?;
            Some((path, merged))
        }
        _ => None,
    };
    let text = match found {
        Found::Rigid(rigid) => rigid_text(heading, rigid),
        Found::Flexible(axis) => flexible_text(heading, method, axis),
    };
    for spool in spools {
        spool.deliver()?;
    }
    if let Some((path, merged)) = merged {
        merged.deliver(path, terminal)?;
        if figures.has_weight() {
            terminal.note("the offset went into the file as weight: take it out there if it is a bias of the sensor");
        }
        if let Found::Rigid(rigid) = found
            && rigid.constant.is_some()
        {
            terminal.note("Coulomb friction and weight in the file are as they were: motion one way determines their sum alone");
        }
    }
    for note in &heading.notes {
        terminal.note(note);
    }
    let stdout_is_taken = [&args.json, &args.toml, &args.response, &args.html]
        .into_iter()
        .flatten()
        .any(|path| is_dash(path));
    if stdout_is_taken {
        terminal.text(&text);
    } else {
        print(|out| out.write_all(text.as_bytes()))?;
    }
    Ok(written(args.into.as_deref(), is_refused, terminal))
}

fn method_name(method: Option<MethodArg>) -> &'static str {
    match method {
        None | Some(MethodArg::Iv) => "iv",
        Some(MethodArg::Arx) => "arx",
        Some(MethodArg::Frequency) => "frequency",
        Some(MethodArg::Subspace) => "subspace",
    }
}

/// The machine file with what was found.
fn merged(
    path: &Path,
    heading: &Heading,
    figures: &AxisFigures,
    usable: bool,
    response: Option<ResponseFigures>,
) -> Result<Merged> {
    ensure!(
        usable || response.is_some(),
        "no mass was identified: there is nothing for --into"
    );
    ensure!(
        !heading.lever_is_missing,
        "{}: give --lead-mm, so that the machine file gets mass and force",
        mixed(heading.rotary)
    );
    let axis = axis_of(heading.axis)?;
    Merged::made(path, |name, text| {
        let text = if usable {
            merge::into_machine(name, text, axis, figures, None)?
        } else {
            text.to_owned()
        };
        match response {
            Some(response) => response_table::into_machine(name, &text, &[(axis, response)]),
            None => Ok(text),
        }
    })
}

/// What goes into the machine file of a flexible axis: from the command all, from
/// force what the loop keeps of it.
fn response_figures(axis: &Flexible) -> ResponseFigures {
    let transfer = axis.transfer.clone();
    if axis.inertia.is_none() {
        return ResponseFigures {
            zeros: Some(transfer.zeros),
            poles: Some(transfer.poles),
            delay_s: Some(transfer.delay_s),
            ..ResponseFigures::default()
        };
    }
    let zeros = axis.zeros.iter().map(|zero| Zero::from(*zero).factor());
    ResponseFigures {
        zeros: Some(zeros.collect()),
        force_poles: Some(transfer.poles),
        ..ResponseFigures::default()
    }
}

fn spooled(path: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<Spool> {
    let mut spool = Target::new(path)?.spool()?;
    write(&mut spool).with_context(|| format!("cannot write {}", path.display()))?;
    Ok(spool)
}

fn toml(
    heading: &Heading,
    figures: &AxisFigures,
    judged: Judgement,
    out: &mut dyn Write,
) -> io::Result<()> {
    if judged != Judgement::Good {
        writeln!(out, "# not to be relied on: {judged}")?;
    }
    let keys = if heading.rotary {
        ["inertia_kg_m2", "viscous_nm_s_rad", "friction_nm"]
    } else {
        ["mass_kg", "viscous_n_s_m", "coulomb_n"]
    };
    writeln!(out, "[axes.{}]", heading.axis)?;
    let values = [Some(figures.mass), figures.viscous, figures.coulomb];
    for (key, value) in keys.iter().zip(values) {
        if let Some(value) = value {
            writeln!(out, "{key} = {}", six_digits(value.max(0.0)))?;
        }
    }
    Ok(())
}

fn response(axis: &Flexible, out: &mut dyn Write) -> io::Result<()> {
    writeln!(
        out,
        "frequency_hz,gain,phase_deg,coherence,model_gain,model_phase_deg"
    )?;
    let measured = &axis.response;
    let fitted = TransferFunction {
        delay_s: axis.fitted_delay_s,
        ..axis.transfer.clone()
    };
    for ((f, g), coherence) in measured
        .frequency_hz
        .iter()
        .zip(&measured.response)
        .zip(&measured.coherence)
    {
        let model = fitted.at_hz(*f);
        writeln!(
            out,
            "{f},{},{},{coherence},{},{}",
            g.norm(),
            libm::atan2(g.im, g.re).to_degrees(),
            model.norm(),
            libm::atan2(model.im, model.re).to_degrees()
        )?;
    }
    Ok(())
}
