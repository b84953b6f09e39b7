//! RepRapFirmware: `config.g` with the files that M98 calls there.
//!
//! Source: Duet documentation, "`GCode` dictionary": M201, M203, M204, M208, M566, M574, M584,
//! M595, M667, M669. Speeds are in mm/min there.

mod blocks;

use blocks::{Blocks, Line};
use gwatt_machine::AxisId;

use crate::expression;
use crate::found::{Build, Figure, Found, entry, highest, shown};
use crate::kinematics;
use crate::near::Job;
use crate::text::{Log, Place};
use crate::words::{Command, Word, commands};

/// Millimetres of an inch.
const INCH: f64 = 25.4;

/// The file that M98 calls.
pub(crate) fn include(line: &str) -> Option<&str> {
    let rest = line.trim_start();
    let rest = rest
        .strip_prefix("M98")?
        .trim_start()
        .strip_prefix(['P', 'p'])?;
    let name = rest.strip_prefix('"')?.split('"').next()?;
    let name = name.rsplit(['/', ':']).next()?;
    (!name.is_empty()).then_some(name)
}

/// What the last commands say of the machine as a whole.
#[derive(Default)]
struct Settings {
    /// The line that is read may not run.
    is_unsure: bool,
    steps: Vec<(AxisId, Figure)>,
    all_kinds: Option<Figure>,
    print: Option<Figure>,
    travel: Option<Figure>,
    rotary: Vec<(AxisId, bool)>,
    ends: Vec<(AxisId, [Option<f64>; 2])>,
}

/// Reads the configuration.
pub(crate) fn read(job: &Job, log: &mut Log) -> Found {
    let mut found = Found::new("reprap", "Printer under RepRapFirmware", Build::Belts);
    let mut settings = Settings::default();
    let mut unit = 1.0;
    let mut mode: Option<Place<'_>> = None;
    let mut blocks = Blocks::default();
    for (_, place) in job.places() {
        let line = blocks.next(&place);
        if line == Line::Bare {
            continue;
        }
        settings.is_unsure = line == Line::Unsure;
        for command in commands(&place) {
            match command.code.as_str() {
                "G20" => unit = INCH,
                "G21" | "M451" if settings.is_unsure => {}
                "G21" => unit = 1.0,
                "M451" => mode = None,
                "M452" | "M453" => mode = Some(command.place.clone()),
                _ => {
                    unsure_unit(log, &command, unit);
                    unsure_block(log, &command, settings.is_unsure);
                    take(&mut found, &mut settings, log, &command, unit);
                }
            }
        }
    }
    if let Some(place) = mode {
        log.error(
            &place,
            "a mode in which G0 moves as fast as M203 permits, and not at F".to_owned(),
            "gwatt reads programs of RepRapFirmware in FFF mode (M451): powers of this machine would be too low",
        );
    }
    finish(&mut found, settings);
    found
}

/// Limits after G20: `GCodeBuffer.cpp` takes them in mm from 3.4 on, in inches before that.
fn unsure_unit(log: &mut Log, command: &Command<'_>, unit: f64) {
    let limits = ["M201", "M203", "M204", "M205", "M566"];
    if unit != 1.0 && limits.contains(&command.code.as_str()) {
        let message = format!(
            "{} after G20: some versions take it in inches, others in mm; inches count",
            command.code
        );
        log.warning(
            &command.place,
            message,
            "write it in mm after G21, and import again",
        );
    }
}

/// Limits in a block of `if` or `while`.
fn unsure_block(log: &mut Log, command: &Command<'_>, is_unsure: bool) {
    let limits = ["M201", "M203", "M204", "M205", "M566"];
    if is_unsure && limits.contains(&command.code.as_str()) {
        log.warning(
            &command.place,
            format!(
                "{} in a block that may not run: the highest of all values counts",
                command.code
            ),
            "where that is too high, import a copy of the file without the blocks that do not run",
        );
    }
}

/// Sets a value; one that may not hold only where it is higher.
fn set(slot: &mut Option<Figure>, figure: Figure, is_unsure: bool) {
    let old = slot.take().filter(|_| is_unsure);
    *slot = highest(old.into_iter().chain([figure]));
}

/// A number, or an expression of numbers in braces.
fn number(log: &mut Log, place: &Place<'_>, text: &str) -> Option<f64> {
    let inner = text
        .strip_prefix('{')
        .and_then(|text| text.strip_suffix('}'));
    let worked_out = inner.and_then(|text| expression::value(text, &|_, _| None, 0));
    worked_out.or_else(|| log.number(place, text))
}

/// The same above 0.
fn positive(log: &mut Log, place: &Place<'_>, text: &str, what: &str) -> Option<f64> {
    let value = number(log, place, text)?;
    if value > 0.0 {
        return Some(value);
    }
    log.positive(place, &shown(value), what)
}

fn take(
    found: &mut Found,
    settings: &mut Settings,
    log: &mut Log,
    command: &Command<'_>,
    unit: f64,
) {
    match command.code.as_str() {
        "M203" => {
            let factor = unit * per_minute(command);
            for (id, figure) in axes(log, command, factor) {
                set(&mut found.axis(id).rapid, figure, settings.is_unsure);
            }
        }
        "M201" => {
            for (id, figure) in axes(log, command, unit) {
                set(&mut found.axis(id).accel, figure, settings.is_unsure);
            }
        }
        "M204" => {
            for (letter, slot) in [('P', &mut settings.print), ('T', &mut settings.travel)] {
                if let Some(word) = command.word(letter)
                    && let Some(value) = positive(log, &word.place, word.text, "an acceleration")
                {
                    let figure = Figure::new(value * unit, command.source(word));
                    set(slot, figure, settings.is_unsure);
                }
            }
        }
        "M566" => steps(settings, log, command, unit / 60.0),
        "M205" => steps(settings, log, command, unit),
        "M208" => limits(settings, log, command, unit),
        "M574" => endstops(found, settings, command),
        "M584" => drives(found, settings, command),
        "M595" => queue(found, log, command),
        "M665" => kinematics::refuse(log, &command.place, "delta (M665)"),
        "M669" | "M667" => kinematics_of(found, log, command),
        _ => {}
    }
}

/// M595: how many moves the planner holds.
fn queue(found: &mut Found, log: &mut Log, command: &Command<'_>) {
    let queue = command
        .word('P')
        .filter(|_| command.word('Q').is_none_or(|q| q.text == "0"));
    let Some(word) = queue else { return };
    let read = log.positive(&word.place, word.text, "a queue");
    if let Some(value) = read.filter(|value| *value >= 2.0) {
        found.look_ahead.clear();
        // Up to half of the queue is fixed, as time goes.
        let seen = (0.5 * value - 1.0).floor().max(1.0);
        let most = (value - 1.0).floor().max(1.0);
        for (name, blocks) in [("blocks", seen), ("blocks_at_most", most)] {
            let field = format!("{name} = {}", shown(blocks));
            found.look_ahead(field, command.source(word));
        }
    }
}

/// Minutes of the time in which M203 counts: `S1` says mm/s (`GCodes2.cpp`, case 203).
fn per_minute(command: &Command<'_>) -> f64 {
    let per_second = command.word('S').is_some_and(|word| word.text == "1");
    if per_second { 60.0 } else { 1.0 }
}

/// The largest of a list of numbers, as several extruders have.
fn largest(log: &mut Log, command: &Command<'_>, word: &Word<'_>) -> Option<Figure> {
    let mut best: Option<f64> = None;
    for piece in word.text.split(':') {
        let what = format!("{} of {}", command.code, word.letter);
        let value = positive(log, &word.place.of(piece), piece, &what)?;
        best = Some(best.map_or(value, |best| best.max(value)));
    }
    best.map(|best| Figure::new(best, command.source(word)))
}

/// A step of speed, which may be 0.
fn step(log: &mut Log, command: &Command<'_>, word: &Word<'_>) -> Option<Figure> {
    let pieces = word
        .text
        .split(':')
        .map(|piece| number(log, &word.place.of(piece), piece));
    let values: Option<Vec<f64>> = pieces.collect();
    let most = values?.into_iter().fold(0.0, f64::max);
    Some(Figure::new(most, command.source(word)))
}

/// The limits of axes that a command gives.
fn axes(log: &mut Log, command: &Command<'_>, factor: f64) -> Vec<(AxisId, Figure)> {
    let of = |word: &Word<'_>| {
        let id = AxisId::from_letter(word.letter as u8)?;
        Some((id, largest(log, command, word)?.times(factor)))
    };
    command.words.iter().filter_map(of).collect()
}

fn steps(settings: &mut Settings, log: &mut Log, command: &Command<'_>, factor: f64) {
    for word in &command.words {
        if word.letter == 'P' && command.code == "M566" {
            if let Some(value) = log.number(&word.place, word.text) {
                settings.all_kinds = Some(Figure::new(value, command.source(word)));
            }
        } else if let Some(id) = AxisId::from_letter(word.letter as u8)
            && let Some(figure) = step(log, command, word)
        {
            let known = settings.steps.iter().position(|(other, _)| *other == id);
            let mut slot = known.map(|at| settings.steps.remove(at).1);
            set(&mut slot, figure.times(factor), settings.is_unsure);
            settings.steps.extend(slot.map(|figure| (id, figure)));
        }
    }
}

/// M208: `S1` minima, else maxima; `X0:200` both.
fn limits(settings: &mut Settings, log: &mut Log, command: &Command<'_>, unit: f64) {
    let minima = command.word('S').is_some_and(|word| word.text == "1");
    for word in &command.words {
        let Some(id) = AxisId::from_letter(word.letter as u8) else {
            continue;
        };
        let mut values = word
            .text
            .split(':')
            .map(|piece| number(log, &word.place.of(piece), piece));
        let first = values.next().flatten().map(|value| value * unit);
        let second = values.next().flatten().map(|value| value * unit);
        let known = settings.ends.iter().position(|(other, _)| *other == id);
        let at = known.unwrap_or(settings.ends.len());
        if known.is_none() {
            settings.ends.push((id, [None; 2]));
        }
        let Some((_, ends)) = settings.ends.get_mut(at) else {
            continue;
        };
        match (second, minima) {
            (Some(second), _) => *ends = [first, Some(second)],
            (None, true) => ends[0] = first,
            (None, false) => ends[1] = first,
        }
    }
}

/// Where an endstop is; homing files may go on from there, so it is shown only.
fn endstops(found: &mut Found, settings: &Settings, command: &Command<'_>) {
    for word in &command.words {
        let Some(id) = AxisId::from_letter(word.letter as u8) else {
            continue;
        };
        let end = match word.text {
            "1" => 0,
            "2" => 1,
            _ => continue,
        };
        let ends = settings.ends.iter().find(|(other, _)| *other == id);
        if let (Some(axis), Some(Some(place))) = (found.known(id), ends.map(|(_, ends)| ends[end]))
        {
            let why = format!("if the homing file ends there: {}", command.source(word));
            axis.maybe
                .push(entry(format!("reference_mm = {}", shown(place)), why));
        }
    }
}

/// M584: drivers of each axis, and which turn.
fn drives(found: &mut Found, settings: &mut Settings, command: &Command<'_>) {
    let turns = command.word('R').map(|word| word.text == "1");
    for word in &command.words {
        let Some(id) = AxisId::from_letter(word.letter as u8) else {
            continue;
        };
        if id != AxisId::E {
            found.axis(id).motors = word.text.split(':').count();
        }
        // The axes that the command makes: X, Y and Z are there from the beginning.
        let made = !matches!(id, AxisId::X | AxisId::Y | AxisId::Z | AxisId::E);
        if let Some(turns) = turns.filter(|_| made) {
            settings.rotary.push((id, turns));
        }
    }
}

/// M669: whether a row of its matrix, `X1:1:0`, lets a motor move several axes.
fn couples(command: &Command<'_>) -> bool {
    command.words.iter().any(|word| {
        let axis = AxisId::from_letter(word.letter as u8).filter(|id| *id != AxisId::E);
        let Some(id) = axis.filter(|_| word.text.contains([':', '{'])) else {
            return false;
        };
        let entries = word.text.split(':').enumerate();
        let others = entries.filter(|(_, entry)| entry.parse() != Ok(0.0_f64));
        let columns: Vec<usize> = others.map(|(column, _)| column).collect();
        // X, Y and Z stand first, others in the order in which M584 has made them.
        let own = |column: usize| column == id as usize || column > 2 && id as usize > 2;
        !matches!(columns.as_slice(), [column] if own(*column))
    })
}

fn kinematics_of(found: &mut Found, log: &mut Log, command: &Command<'_>) {
    if command.code == "M669" && couples(command) {
        return kinematics::refuse(log, &command.place, command.whole);
    }
    let word = command.word('K').or_else(|| command.word('S'));
    let Some(word) = word.filter(|word| command.code == "M669" || word.letter == 'S') else {
        return;
    };
    match (command.code.as_str(), word.letter, word.text) {
        ("M669", 'K', "0") | ("M667", 'S', "0") | ("M669", 'S', _) => {}
        ("M669", 'K', kind @ ("1" | "2" | "5" | "8")) | ("M667", 'S', kind @ ("1" | "2")) => {
            let name = match kind {
                "1" => Some("corexy"),
                "2" => Some("corexz"),
                _ => None,
            };
            kinematics::core(found, log, &command.place, command.whole, name);
        }
        _ => kinematics::refuse(log, &command.place, command.whole),
    }
}

fn finish(found: &mut Found, settings: Settings) {
    for (id, turns) in settings.rotary {
        if let Some(axis) = found.known(id) {
            axis.rotary = turns;
        }
    }
    for (id, ends) in settings.ends {
        if let (Some(axis), [Some(min), Some(max)]) = (found.known(id), ends) {
            axis.comments
                .push(format!("Travel: {} to {} (M208)", shown(min), shown(max)));
        }
    }
    let mut parts = Vec::new();
    let mut sources = Vec::new();
    for (name, figure) in [("print", settings.print), ("travel", settings.travel)] {
        if let Some(figure) = figure {
            parts.push(format!("{name} = {}", shown(figure.value)));
            sources.push(figure.source);
        }
    }
    if !parts.is_empty() {
        found.path(
            format!("accel_mm_s2 = {{ {} }}", parts.join(", ")),
            sources.join(", "),
        );
    }
    if let Some(steps) = crate::marlin::classic(found, settings.steps) {
        let mut fields = vec![steps];
        if let Some(policy) = settings.all_kinds {
            let same = policy.value == 0.0;
            fields.push(entry(format!("same_kind_only = {same}"), policy.source));
        }
        found.corner = Some(("speed_step", fields));
    }
    let note = "Homing speeds stand in homeall.g: reference_mm_min of each axis may have the highest of \
                them; without it homing counts at the full speed of the axes";
    found.remarks.push(note.to_owned());
}
