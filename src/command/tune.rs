//! `gwatt tune`.

use std::fs::File;
use std::io::{BufReader, Read, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use gwatt::identify::flexible::Choice;
use gwatt::identify::response_table::ResponseFigures;
use gwatt::identify::tune::{
    AxisResponse, Discretization, Parameters, Tuned, Wish, excited, of_recording,
};
use gwatt::identify::{Given, IdentifyError, Judgement, Recording};
use gwatt::machine::AxisId;
use gwatt::report::{Verdict, sections_csv, tune_page, tuned_json, tuned_text};
use rayon::prelude::*;

use super::clash::refuse_clashes;
use super::filter_force;
use super::input::is_dash;
use super::into::{Merged, axis_of, written};
use super::model_choice::method;
use super::output::{Spool, Target, print};
use super::setup::load_machine;
use super::terminal::Terminal;
use crate::cli::{DiscretizeArg, TuneArgs};

/// Largest file of parameters that is read.
const BYTES_MAX: u64 = 1 << 20;
/// Orders of models that are tried.
const ORDER_MAX: usize = 12;
/// Sampling period and band where nothing is given.
const PERIOD_S: f64 = 1e-3;
const BAND_HZ: f64 = 50.0;

/// A recording that is given.
struct AxisRecording {
    letter: char,
    path: PathBuf,
}

/// Makes axes answer alike.
pub fn run(args: &TuneArgs, terminal: Terminal) -> Result<Verdict> {
    let given = recordings(&args.recordings)?;
    let inputs: Vec<&Path> = given
        .iter()
        .map(|it| it.path.as_path())
        .chain(args.from.as_deref())
        .collect();
    let files = [&args.json, &args.csv, &args.toml, &args.html, &args.into];
    let outputs: Vec<&Path> = files.into_iter().flatten().map(AsRef::as_ref).collect();
    refuse_clashes(&inputs, &outputs)?;
    let parameters = match &args.from {
        Some(path) => Some(read_parameters(path)?),
        None => None,
    };
    let choice = choice(args)?;
    let identified = given
        .par_iter()
        .map(|it| identify(it, &choice, args.least_accel_mm_s2))
        .collect::<Vec<_>>()
        .into_iter()
        .collect::<Result<Vec<_>>>()?;
    let mut axes = join(identified, parameters.as_ref(), args.from.as_deref());
    for gain in &args.position_gain {
        let letter = gain.letter;
        let axis = axes.iter_mut().find(|axis| axis.letter == letter);
        let axis = axis.with_context(|| format!("--position-gain: there is no axis {letter}"))?;
        ensure!(
            !axis.from_command,
            "--position-gain: the loop of axis {letter} is in its recording already"
        );
        axis.position_gain_1_s = Some(gain.gain_1_s);
    }
    let band_hz = args
        .band_hz
        .or(parameters.as_ref().and_then(|p| p.band_hz))
        .unwrap_or(BAND_HZ);
    if axes.len() == 1 && args.html.is_none() {
        let error = IdentifyError::new(
            "one axis alone has nothing to be like",
            "give a recording of each axis that moves along the path, or --html for a page of this one",
        );
        return Err(error.into());
    }
    let tuned = Tuned::new(axes, wish(args, parameters.as_ref()), band_hz)?;
    deliver(args, &tuned, terminal)
}

/// Letters and paths of the recordings.
fn recordings(list: &[String]) -> Result<Vec<AxisRecording>> {
    let mut found: Vec<AxisRecording> = Vec::new();
    for text in list {
        let named = text.split_once('=').and_then(|(letter, path)| {
            let mut letters = letter.chars();
            let letter = letters.next().filter(|_| letters.next().is_none())?;
            Some((letter, PathBuf::from(path)))
        });
        let (letter, path) = if let Some((letter, path)) = named {
            (axis_of(letter)?, path)
        } else {
            let path = PathBuf::from(text);
            let letter = letter_of(&path)?.with_context(|| {
                format!(
                    "{text}: which axis is this?\n  help: write X={text}, or name its columns x_torque_nm and so on"
                )
            })?;
            (letter, path)
        };
        ensure!(
            !is_dash(&path),
            "recordings of several axes are read from files, not from standard input"
        );
        let letter = letter.letter() as char;
        ensure!(
            found.iter().all(|other| other.letter != letter),
            "axis {letter} is given twice: one recording for each axis"
        );
        found.push(AxisRecording { letter, path });
    }
    Ok(found)
}

/// The axis that the columns name, or else the file's name: a letter that
/// stands alone in it, such as x.csv or axis-x.csv.
fn letter_of(path: &Path) -> Result<Option<AxisId>> {
    let mut beginning = Vec::new();
    let name = path.display();
    let file = File::open(path).with_context(|| format!("{name}: cannot read the recording"))?;
    file.take(1 << 16)
        .read_to_end(&mut beginning)
        .with_context(|| format!("{name}: cannot read the recording"))?;
    let text = String::from_utf8_lossy(&beginning);
    let header = text
        .lines()
        .find(|line| !line.trim_start().starts_with('#') && !line.trim().is_empty())
        .unwrap_or_default();
    let single = |mut axes: Vec<AxisId>| {
        axes.sort_unstable();
        axes.dedup();
        match axes.as_slice() {
            [axis] => Some(*axis),
            _ => None,
        }
    };
    let letter = |text: &str| -> Option<AxisId> {
        let mut letters = text.chars();
        let letter = letters.next().filter(|_| letters.next().is_none())?;
        axis_of(letter).ok()
    };
    let columns = header
        .split(',')
        .filter_map(|name| letter(name.trim().trim_matches('"').split_once('_')?.0));
    if let Some(axis) = single(columns.collect()) {
        return Ok(Some(axis));
    }
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let parts = stem.split(|c: char| !c.is_alphanumeric());
    Ok(single(parts.filter_map(letter).collect()))
}

fn read_parameters(path: &Path) -> Result<Parameters> {
    let name = path.display();
    let mut text = String::new();
    File::open(path)
        .and_then(|file| file.take(BYTES_MAX + 1).read_to_string(&mut text))
        .with_context(|| format!("cannot read {name}"))?;
    if text.len() as u64 > BYTES_MAX {
        bail!("{name} is larger than a file of parameters can be");
    }
    Parameters::read(&text).with_context(|| name.to_string())
}

fn identify(it: &AxisRecording, choice: &Choice, least: Option<f64>) -> Result<AxisResponse> {
    let name = it.path.display().to_string();
    let file =
        File::open(&it.path).with_context(|| format!("{name}: cannot read the recording"))?;
    let read = || -> Result<AxisResponse> {
        let recording = Recording::read(BufReader::new(file), Some(it.letter))?;
        let moved = excited(&recording, it.letter, least)?;
        let mut axis = of_recording(&recording, it.letter, choice)?;
        axis.excited = Some(moved);
        axis.source.clone_from(&name);
        Ok(axis)
    };
    read().with_context(|| name.clone())
}

/// Figures of the file where there are any, responses of the recordings.
fn join(
    identified: Vec<AxisResponse>,
    parameters: Option<&Parameters>,
    from: Option<&Path>,
) -> Vec<AxisResponse> {
    let Some(parameters) = parameters else {
        return identified;
    };
    let mut axes = parameters.axes.clone();
    for axis in &mut axes {
        axis.source = from.map_or(String::new(), |path| path.display().to_string());
    }
    for found in identified {
        match axes.iter_mut().find(|axis| axis.letter == found.letter) {
            Some(axis) => {
                axis.measured = found.measured;
                axis.hold_s = found.hold_s;
                axis.dips = found.dips;
                axis.excited = found.excited;
            }
            None => axes.push(found),
        }
    }
    axes
}

fn wish(args: &TuneArgs, parameters: Option<&Parameters>) -> Wish {
    let discretization = args.discretize.map(|kind| match kind {
        DiscretizeArg::Matched => Discretization::Matched,
        DiscretizeArg::Tustin => Discretization::Tustin,
        DiscretizeArg::Zoh => Discretization::Hold,
    });
    let no_low_pass = args.no_low_pass
        || args.low_pass_hz.is_none()
            && args.low_pass_order.is_none()
            && parameters.is_some_and(|p| p.no_low_pass);
    let of_file = |value: fn(&Parameters) -> Option<f64>| parameters.and_then(value);
    Wish {
        period_s: args
            .period_ms
            .map(|ms| ms * 1e-3)
            .or(of_file(|p| p.period_s))
            .unwrap_or(PERIOD_S),
        discretization: discretization
            .or(parameters.and_then(|p| p.discretization))
            .unwrap_or(Discretization::Matched),
        no_low_pass,
        order: args.low_pass_order.or(parameters.and_then(|p| p.order)),
        bandwidth_hz: args.low_pass_hz.or(of_file(|p| p.bandwidth_hz)),
    }
}

fn choice(args: &TuneArgs) -> Result<Choice> {
    ensure!(
        args.order.is_none_or(|order| order <= ORDER_MAX),
        "--order is at most {ORDER_MAX}"
    );
    if let Some(least) = args.least_accel_mm_s2 {
        ensure!(
            least.is_finite() && least > 0.0,
            "--least-accel-mm-s2 {least} is not positive"
        );
    }
    Ok(Choice {
        method: method(args.method),
        given: Given {
            order: args.order,
            ..Given::default()
        },
        from_command: args.from_command,
    })
}

fn deliver(args: &TuneArgs, tuned: &Tuned, terminal: Terminal) -> Result<Verdict> {
    // Everything is prepared before anything is put in place.
    let mut spools = Vec::new();
    if let Some(path) = &args.json {
        spools.push(spooled(path, |out| tuned_json(tuned, out))?);
    }
    if let Some(path) = &args.csv {
        spools.push(spooled(path, |out| sections_csv(tuned, out))?);
    }
    if let Some(path) = &args.toml {
        let text = Parameters::write(&tuned.axes, &tuned.wish, tuned.band_hz, &tuned.correction);
        spools.push(spooled(path, |out| out.write_all(text.as_bytes()))?);
    }
    if let Some(path) = &args.html {
        spools.push(spooled(path, |out| tune_page(tuned, out))?);
    }
    let is_good = |axis: &AxisResponse| axis.judgement.is_none_or(|it| it == Judgement::Good);
    let is_refused = args.into.is_some() && !args.force && !tuned.axes.iter().all(is_good);
    let forces = match &args.into {
        Some(path) if !is_refused => {
            let machine = load_machine(&path.display().to_string(), terminal)?;
            filter_force::check(tuned, &machine)?
        }
        _ => Vec::new(),
    };
    let merged = match &args.into {
        Some(path) if !is_refused => Some((path, Merged::responses(path, &figures(tuned)?)?)),
        _ => None,
    };
    let text = tuned_text(tuned);
    for spool in spools {
        spool.deliver()?;
    }
    if let Some((path, merged)) = merged {
        merged.deliver(path, terminal)?;
        for force in forces {
            terminal.note(force);
        }
    }
    let files = [&args.json, &args.csv, &args.toml, &args.html];
    if files.into_iter().flatten().any(|path| is_dash(path)) {
        terminal.text(&text);
    } else {
        print(|out| out.write_all(text.as_bytes()))?;
    }
    Ok(written(args.into.as_deref(), is_refused, terminal))
}

fn spooled(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> std::io::Result<()>,
) -> Result<Spool> {
    let mut spool = Target::new(path)?.spool()?;
    write(&mut spool).with_context(|| format!("cannot write {}", path.display()))?;
    Ok(spool)
}

/// What goes into the machine file.
fn figures(tuned: &Tuned) -> Result<Vec<(AxisId, ResponseFigures)>> {
    let filters = tuned.correction.filters.iter();
    let axes = tuned.axes.iter().zip(filters).map(|(axis, filter)| {
        let transfer = axis.transfer();
        let correction = Some((tuned.correction.period_s, filter.sections.clone()));
        let figures = if axis.from_command {
            ResponseFigures {
                zeros: Some(transfer.zeros),
                poles: Some(transfer.poles),
                delay_s: Some(transfer.delay_s),
                correction,
                ..ResponseFigures::default()
            }
        } else {
            ResponseFigures {
                zeros: Some(axis.zero_factors()),
                force_poles: Some(transfer.poles),
                position_gain_1_s: axis.position_gain_1_s,
                correction,
                ..ResponseFigures::default()
            }
        };
        Ok((axis_of(axis.letter)?, figures))
    });
    axes.collect()
}
