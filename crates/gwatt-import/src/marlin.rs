//! Marlin: what `M503` prints, or a list of the same commands.
//!
//! Source: Marlin documentation, M92, M200 to M206, M503. Speeds are in mm/s there, and the
//! classic jerk too.

use gwatt_machine::{ALL_AXES, AxisId};

use crate::found::{Build, Entry, Figure, Found, entry, highest, shown};
use crate::near::Job;
use crate::text::Log;
use crate::words::{Command, commands};

/// Seconds of a minute.
const MIN: f64 = 60.0;
/// Millimetres of an inch.
const INCH: f64 = 25.4;

/// What the last commands of each kind say.
#[derive(Default)]
struct Settings {
    print: Option<Figure>,
    travel: Option<Figure>,
    retract: Option<Figure>,
    deviation: Option<Figure>,
    steps: Vec<(AxisId, Figure)>,
    segment_s: Option<Figure>,
    fields: [Option<Figure>; 3],
    /// M204 S: firmware before 1.1.
    old: bool,
}

/// Reads the settings.
pub(crate) fn read(job: &Job, log: &mut Log) -> Found {
    let mut found = Found::new("marlin", "Printer under Marlin", Build::Belts);
    let mut settings = Settings::default();
    let mut unit = 1.0;
    for (_, place) in job.places() {
        for command in commands(&place) {
            match command.code.as_str() {
                "G20" => unit = INCH,
                "G21" => unit = 1.0,
                _ => take(&mut found, &mut settings, log, &command, unit),
            }
        }
    }
    // Firmware of M204 S had no such curve.
    let may_curve = !settings.old;
    finish(&mut found, settings);
    if may_curve {
        s_curve(&mut found, log, job.name());
    }
    found
}

fn take(
    found: &mut Found,
    settings: &mut Settings,
    log: &mut Log,
    command: &Command<'_>,
    unit: f64,
) {
    match command.code.as_str() {
        "M92" => steps(found, log, command),
        "M203" => axes(found, log, command, unit * MIN, |axis, figure| {
            axis.rapid = highest(
                axis.rapid
                    .take()
                    .filter(|_| figure.1)
                    .into_iter()
                    .chain([figure.0]),
            );
        }),
        "M201" => axes(found, log, command, unit, |axis, figure| {
            axis.accel = highest(
                axis.accel
                    .take()
                    .filter(|_| figure.1)
                    .into_iter()
                    .chain([figure.0]),
            );
        }),
        "M204" => accelerations(settings, log, command, unit),
        "M205" => corners(settings, log, command, unit),
        "M210" => axes(found, log, command, unit, |axis, figure| {
            axis.reference_speed = Some(figure.0);
        }),
        "M207" => retract(settings, log, command, unit, 0),
        "M208" => retract(settings, log, command, unit, 2),
        _ => {}
    }
}

/// Each axis that the command names; the flag says that it is one of several tools, of which
/// the highest counts.
fn axes(
    found: &mut Found,
    log: &mut Log,
    command: &Command<'_>,
    factor: f64,
    mut put: impl FnMut(&mut crate::found::FoundAxis, (Figure, bool)),
) {
    let tool = command.word('T').is_some_and(|word| word.text != "0");
    for word in &command.words {
        let Some(id) = AxisId::from_letter(word.letter as u8) else {
            continue;
        };
        let what = format!("{} of {}", command.code, word.letter);
        if let Some(value) = log.positive(&word.place, word.text, &what) {
            let figure = Figure::new(value * factor, command.source(word));
            put(found.axis(id), (figure, tool));
        }
    }
}

fn steps(found: &mut Found, log: &mut Log, command: &Command<'_>) {
    for word in &command.words {
        if let Some(id) = AxisId::from_letter(word.letter as u8)
            && log.number(&word.place, word.text).is_some()
        {
            let note = format!("Steps per unit of travel: {}", command.source(word));
            found.axis(id).drive = vec![note];
        }
    }
}

/// M204: P, T and R; S and T of old firmware are all moves and retracts.
fn accelerations(settings: &mut Settings, log: &mut Log, command: &Command<'_>, unit: f64) {
    let mut value = |letter: char| {
        let word = command.word(letter)?;
        let number = log.positive(&word.place, word.text, "an acceleration")?;
        Some(Figure::new(number * unit, command.source(word)))
    };
    let [print, retract, travel, all] = ['P', 'R', 'T', 'S'].map(&mut value);
    if let Some(all) = all {
        settings.old = true;
        settings.print = Some(all.clone());
        settings.travel = Some(all);
        settings.retract = travel.or(retract);
        return;
    }
    settings.print = print.or(settings.print.take());
    settings.travel = travel.or(settings.travel.take());
    settings.retract = retract.or(settings.retract.take());
}

fn corners(settings: &mut Settings, log: &mut Log, command: &Command<'_>, unit: f64) {
    for word in &command.words {
        let id = AxisId::from_letter(word.letter as u8);
        let step = id.filter(|id| *id != AxisId::B);
        if step.is_none() && !matches!(word.letter, 'J' | 'B') {
            continue;
        }
        let Some(value) = log.number(&word.place, word.text) else {
            continue;
        };
        let figure = Figure::new(value.max(0.0), command.source(word));
        match word.letter {
            'J' => settings.deviation = Some(figure.times(unit)),
            'B' => settings.segment_s = Some(figure.times(1e-6)),
            _ => {
                let Some(id) = step else { continue };
                settings.steps.retain(|(other, _)| *other != id);
                settings.steps.push((id, figure.times(unit)));
            }
        }
    }
}

/// M207 S and F, M208 S and F: length and speed of retracts and recovers.
fn retract(settings: &mut Settings, log: &mut Log, command: &Command<'_>, unit: f64, at: usize) {
    for (letter, offset, factor) in [('S', 0, unit), ('F', 1, unit / MIN)] {
        if let Some(word) = command.word(letter)
            && let Some(value) = log.number(&word.place, word.text)
            && let Some(slot) = settings.fields.get_mut(at + offset)
        {
            *slot = Some(Figure::new(value.max(0.0) * factor, command.source(word)));
        }
    }
}

fn finish(found: &mut Found, settings: Settings) {
    let mut parts = Vec::new();
    let mut sources = Vec::new();
    for (name, figure) in [
        ("print", settings.print),
        ("travel", settings.travel),
        ("retract", settings.retract),
    ] {
        if let Some(figure) = figure {
            parts.push(format!("{name} = {}", shown(figure.value)));
            sources.push(figure.source);
        }
    }
    if !parts.is_empty() {
        let field = format!("accel_mm_s2 = {{ {} }}", parts.join(", "));
        found.path(field, sources.join(", "));
    }
    if let Some(time) = settings.segment_s {
        found.path(
            format!("shortest_at_feed_s = {}", shown(time.value)),
            time.source,
        );
    }
    if let Some(deviation) = settings.deviation.filter(|it| it.value > 0.0) {
        let field = format!("deviation_mm = {}", shown(deviation.value));
        found.corner = Some(("junction_deviation", vec![entry(field, deviation.source)]));
    } else if let Some(steps) = classic(found, settings.steps) {
        found.corner = Some(("classic_jerk", vec![steps]));
    }
    if let [Some(length), Some(speed), _] = &settings.fields
        && speed.value > 0.0
    {
        let field = format!(
            "retract = {{ length_mm = {}, speed_mm_s = {} }}",
            shown(length.value),
            shown(speed.value)
        );
        found.language(field, format!("{}, {}", length.source, speed.source));
    }
}

/// Steps of speed in the order of the axes, if there are any; old firmware has one for X and Y.
pub(crate) fn classic(found: &Found, mut steps: Vec<(AxisId, Figure)>) -> Option<Entry> {
    let x = steps.iter().find(|(id, _)| *id == AxisId::X).cloned();
    let y = steps.iter().any(|(id, _)| *id == AxisId::Y);
    if let Some((_, x)) = x.filter(|_| !y) {
        steps.push((AxisId::Y, x));
    }
    let mut parts = Vec::new();
    let mut sources: Vec<String> = Vec::new();
    for id in ALL_AXES {
        let step = steps.iter().find(|(other, _)| *other == id);
        let Some((_, step)) = step.filter(|_| found.axes[id as usize].is_some()) else {
            continue;
        };
        parts.push(format!("{} = {}", id.letter() as char, shown(step.value)));
        if !sources.contains(&step.source) {
            sources.push(step.source.clone());
        }
    }
    let field = format!("step_mm_s = {{ {} }}", parts.join(", "));
    (!parts.is_empty()).then(|| entry(field, sources.join(", ")))
}

/// M503 does not say whether `S_CURVE_ACCELERATION` is on: the higher counts.
fn s_curve(found: &mut Found, log: &mut Log, file: &str) {
    let why = "delete it where Configuration.h has S_CURVE_ACCELERATION off";
    for axis in found.axes.iter_mut().flatten() {
        axis.servo_factor = Some(Figure::new(1.875, why));
    }
    log.hint(
        file,
        "M503 does not say whether S_CURVE_ACCELERATION is on, which makes peaks of acceleration \
         1.875 times as high: counted as on"
            .to_owned(),
        "import Configuration.h instead, or delete the servo factors where it is off",
    );
}
