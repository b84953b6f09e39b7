//! `gwatt identify`.

use std::fs::File;
use std::io::{self, BufReader, Write};
use std::path::Path;

use anyhow::{Context, Result, ensure};
use gwatt::identify::flexible::{self, Choice, Flexible, Method};
use gwatt::identify::merge::{self, AxisFigures, force_per_torque, six_digits};
use gwatt::identify::response_table::{self, ResponseFigures};
use gwatt::identify::rigid::{self, Figure, Friction, Rigid};
use gwatt::identify::tune::Zero;
use gwatt::identify::{Given, Kind, Quantity, Recording, TransferFunction};
use gwatt::report::{Heading, Verdict, flexible_json, flexible_text, rigid_json, rigid_text};

use super::clash::refuse_clashes;
use super::input::is_dash;
use super::into::{Merged, axis_of};
use super::output::{Spool, Target, print};
use super::terminal::Terminal;
use crate::cli::{FrictionArg, IdentifyArgs, MethodArg, ModelArg};

/// What was found.
enum Found {
    Rigid(Box<Rigid>),
    Flexible(Box<Flexible>),
}

/// Identifies an axis.
pub fn run(args: &IdentifyArgs, terminal: Terminal) -> Result<Verdict> {
    let axis = axis_of(args.axis)?;
    let letter = axis.letter() as char;
    let inputs: Vec<&Path> = std::iter::once(&args.recording)
        .chain(&args.validate)
        .map(AsRef::as_ref)
        .collect();
    let outputs: Vec<&Path> = [&args.json, &args.toml, &args.into, &args.response]
        .into_iter()
        .flatten()
        .map(AsRef::as_ref)
        .collect();
    refuse_clashes(&inputs, &outputs)?;
    let ratio = ratio(args)?;
    let recording = open(&args.recording, letter, ratio)?;
    let name = || args.recording.display().to_string();
    let choice = choice(args)?;
    let is_flexible =
        args.model == Some(ModelArg::Flexible) || (args.model.is_none() && args.method.is_some());
    let (found, validation) = if is_flexible {
        let found = flexible::identify(&recording, &choice).with_context(name)?;
        let validation = match &args.validate {
            Some(path) => Some(
                flexible::predict_error(&found, &open(path, letter, ratio)?, &choice)
                    .with_context(|| path.display().to_string())?,
            ),
            None => None,
        };
        (Found::Flexible(Box::new(found)), validation)
    } else {
        let friction = match args.friction {
            FrictionArg::Symmetric => Friction::Symmetric,
            FrictionArg::Directional => Friction::Directional,
        };
        let found = rigid::fit(&recording, friction, args.bandwidth_hz).with_context(name)?;
        let validation = match &args.validate {
            Some(path) => Some(
                rigid::predict_error(&found, &open(path, letter, ratio)?)
                    .with_context(|| path.display().to_string())?,
            ),
            None => None,
        };
        (Found::Rigid(Box::new(found)), validation)
    };
    let heading = heading(args, letter, &recording, validation);
    deliver(args, &heading, &found, terminal)
}

/// Reads a recording; with `ratio` (N per N·m) what turns is referred to the slide.
fn open(path: &Path, axis: char, ratio: Option<f64>) -> Result<Recording> {
    let name = path.display();
    let read = if is_dash(path) {
        Recording::read(io::stdin().lock(), Some(axis))
    } else {
        let file =
            File::open(path).with_context(|| format!("{name}: cannot read the recording"))?;
        Recording::read(BufReader::new(file), Some(axis))
    };
    let mut recording = read.with_context(|| name.to_string())?;
    if let Some(ratio) = ratio {
        recording
            .refer_to_slide(ratio)
            .with_context(|| name.to_string())?;
    }
    Ok(recording)
}

/// N per N·m.
fn ratio(args: &IdentifyArgs) -> Result<Option<f64>> {
    let Some(lead_mm) = args.lead_mm else {
        return Ok(None);
    };
    let ratio = force_per_torque(lead_mm, args.gear_ratio);
    ensure!(
        ratio.is_finite() && ratio > 0.0,
        "--lead-mm and --gear-ratio must be positive"
    );
    Ok(Some(ratio))
}

/// How a flexible axis is estimated, where that is not given too.
pub(super) fn method(asked: Option<MethodArg>) -> Method {
    match asked {
        None | Some(MethodArg::Iv) => Method::Iv,
        Some(MethodArg::Arx) => Method::Arx,
        Some(MethodArg::Frequency) => Method::Frequency,
        Some(MethodArg::Subspace) => Method::Subspace,
    }
}

fn choice(args: &IdentifyArgs) -> Result<Choice> {
    ensure!(
        args.order.is_none_or(|order| order <= 12),
        "--order is at most 12"
    );
    ensure!(
        args.decimate
            .iter()
            .all(|factor| (1..=1000).contains(factor))
            && args.decimate.len() <= 8,
        "--decimate takes up to eight factors from 1 to 1000"
    );
    let delay_s = args.delay_ms.map(|ms| ms * 1e-3);
    ensure!(
        delay_s.is_none_or(|delay| (0.0..10.0).contains(&delay)),
        "--delay-ms is not between 0 and 10000"
    );
    if let Some(hz) = args.bandwidth_hz {
        ensure!(
            hz.is_finite() && hz > 0.0,
            "--bandwidth-hz {hz} is not positive"
        );
    }
    Ok(Choice {
        method: method(args.method),
        given: Given {
            order: args.order,
            zeros: args.zeros,
            delay_s,
        },
        decimation: args.decimate.clone(),
        from_command: args.from_command,
    })
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
    let slides = motion_slides(recording);
    let mut notes = Vec::new();
    if !recording.ignored.is_empty() {
        notes.push(format!(
            "columns that are passed over: {}",
            recording.ignored.join(", ")
        ));
    }
    let lever_is_missing = is_torque && slides;
    if lever_is_missing {
        notes.push(
            "torque with a motion in metres: figures are for a lever of 1 m; give --lead-mm to get mass and force".to_owned(),
        );
    }
    Heading {
        recording: args.recording.display().to_string(),
        axis,
        rotary: is_torque,
        validation,
        lever_is_missing,
        notes,
    }
}

fn motion_slides(recording: &Recording) -> bool {
    [
        Quantity::Acceleration,
        Quantity::Velocity,
        Quantity::Position,
    ]
    .into_iter()
    .find_map(|quantity| recording.get(quantity))
    .is_some_and(|signal| signal.kind == Kind::Linear)
}

fn figures(heading: &Heading, found: &Found) -> AxisFigures {
    let gravity = match found {
        Found::Rigid(rigid) => Some(rigid.offset),
        Found::Flexible(_) => None,
    };
    let (mass, viscous, coulomb) = match found {
        Found::Rigid(rigid) => (
            rigid.mass.value,
            rigid.viscous.map(|f| f.value),
            rigid.coulomb.map(|f| f.value),
        ),
        Found::Flexible(axis) => (axis.inertia.map_or(f64::NAN, |f| f.value), None, None),
    };
    let std_of = |figure: Option<Figure>| figure.map_or(0.0, |figure| figure.std);
    let std = match found {
        Found::Rigid(rigid) => Some([rigid.mass.std, std_of(rigid.viscous), std_of(rigid.coulomb)]),
        Found::Flexible(axis) => axis.inertia.map(|figure| [figure.std, 0.0, 0.0]),
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
    terminal: Terminal,
) -> Result<Verdict> {
    let method = match args.method {
        None | Some(MethodArg::Iv) => "iv",
        Some(MethodArg::Arx) => "arx",
        Some(MethodArg::Frequency) => "frequency",
        Some(MethodArg::Subspace) => "subspace",
    };
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
        spools.push(spooled(path, |out| toml(heading, &figures, out))?);
    }
    if let (Some(path), Found::Flexible(axis)) = (&args.response, found) {
        spools.push(spooled(path, |out| response(axis, out))?);
    }
    let response = match found {
        Found::Flexible(axis) => Some(response_figures(axis)),
        Found::Rigid(_) => None,
    };
    let merged = match &args.into {
        Some(path) => {
            ensure!(
                usable || response.is_some(),
                "no mass was identified: there is nothing for --into"
            );
            ensure!(
                !heading.lever_is_missing,
                "torque with a motion in metres: give --lead-mm, so that the machine file gets mass and force"
            );
            let axis = axis_of(heading.axis)?;
            let merged = Merged::made(path, |name, text| {
                let text = if usable {
                    merge::into_machine(name, text, axis, &figures, None)?
                } else {
                    text.to_owned()
                };
                match response {
                    Some(response) => {
                        response_table::into_machine(name, &text, &[(axis, response)])
                    }
                    None => Ok(text),
                }
            })?;
            Some((path, merged))
        }
        None => None,
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
    }
    for note in &heading.notes {
        terminal.note(note);
    }
    let stdout_is_taken = [&args.json, &args.toml, &args.response]
        .into_iter()
        .flatten()
        .any(|path| is_dash(path));
    if stdout_is_taken {
        terminal.text(&text);
    } else {
        print(|out| out.write_all(text.as_bytes()))?;
    }
    Ok(Verdict::Fits)
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

fn toml(heading: &Heading, figures: &AxisFigures, out: &mut dyn Write) -> io::Result<()> {
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
