//! Words of the machine's controller in programs that are read as another one reads them:
//! only those that this one reads back are written.

use super::Reading;
use crate::diagnostic::Diagnostic;
use crate::interpret::{Diagnostics, Effects, Facts, Interpreter, KnobState};
use crate::machine::{AXES, AxisValues, KnobTarget, Machine, builtin_controller};
use crate::rewrite::knob_lines;
use crate::syntax::{Block, scan_line};

/// What a word is tried with: a share of the machine's own limits.
const TRIED: f64 = 0.5;

/// The machine without the words that the dialect of its programs does not read, if there
/// are any, and the note that names them.
pub(super) fn readable(machine: &Machine) -> Option<(Machine, Diagnostic)> {
    let controller = &machine.controller;
    if controller.name == controller.language.name {
        return None;
    }
    let count = controller.knobs.len();
    let read: Vec<bool> = (0..count).map(|index| is_read(machine, index)).collect();
    if !read.contains(&false) {
        return None;
    }
    let unread = controller
        .knobs
        .iter()
        .zip(&read)
        .filter(|(_, read)| !**read);
    let names: Vec<&str> = unread
        .map(|(knob, _)| knob.name.trim_end_matches('='))
        .collect();
    let message = format!(
        "programs are read as `{}` reads them, which does not have {} as `{}` does: it is not \
         written",
        controller.language.name,
        names.join(", "),
        controller.name
    );
    let mut reading = machine.clone();
    let mut read = read.into_iter();
    let knobs = &mut reading.controller.knobs;
    knobs.retain(|_| read.next().unwrap_or(false));
    Some((reading, Diagnostic::note("unread-word", message)))
}

/// Whether the lines of a word do what they do on the machine's own controller: M203 of Marlin
/// is in mm/s, that of RepRapFirmware in mm/min.
fn is_read(machine: &Machine, index: usize) -> bool {
    let values = tried(machine, index);
    let Some(lines) = values.and_then(|values| knob_lines(machine, index, &values)) else {
        // It is never written by itself.
        return true;
    };
    let Some(found) = after(machine, &lines) else {
        return false;
    };
    builtin_controller(&machine.controller.name).is_none_or(|own| {
        let mut meant = machine.clone();
        meant.controller.language = own.language;
        after(&meant, &lines).is_some_and(|meant| meant == found)
    })
}

/// The limits in force after the lines of a word; `None` where they change nothing, or are not
/// read.
fn after(machine: &Machine, lines: &[String]) -> Option<KnobState> {
    let mut interpreter = Interpreter::new(machine, &Reading::default());
    let before = interpreter.knobs().clone();
    let (mut block, mut facts) = (Block::default(), Facts::default());
    let (mut steps, mut found) = (Vec::new(), Diagnostics::default());
    for (number, line) in (1..).zip(lines) {
        scan_line(line.as_bytes(), number == 1, &mut block);
        let text = line.as_bytes();
        interpreter.execute(
            number,
            text,
            &mut block,
            Effects::new(&mut steps, &mut facts, &mut found),
        );
    }
    let found = Some(interpreter.knobs()).filter(|_| found.list.is_empty());
    found.filter(|found| **found != before).cloned()
}

/// Values that a word is tried with; `None` where there is no such word.
fn tried(machine: &Machine, index: usize) -> Option<AxisValues> {
    let knob = machine.controller.knobs.get(index)?;
    let mut values = [0.0; AXES];
    for axis in machine.axis_set.iter() {
        let Some(data) = &machine.axes[axis] else {
            continue;
        };
        let value = match knob.target {
            KnobTarget::Jerk | KnobTarget::RapidSpeed => 100.0 * TRIED,
            KnobTarget::CruiseRatio => 0.0,
            KnobTarget::Speed => knob.unit.speed_value(data, TRIED * data.rapid_mm_s, 1.0),
            _ => knob.unit.value(data, TRIED * data.accel_mm_s2, 1.0),
        };
        values[axis] = value;
    }
    Some(values)
}
