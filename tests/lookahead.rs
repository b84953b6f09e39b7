//! Look-ahead planners through their public interface.

mod certain;
mod chords;
mod corners;
mod glide;
mod klipper;
mod linuxcnc;
mod measured;
mod overrides;
mod profile;
mod limited;
mod recorded;
mod recorder;
mod rotary;
mod side_by_side;
mod words;
mod steps;
mod tandem;

use gwatt::interpret::{
    ActionKind, Diagnostics, Effects, Facts, Interpreter, MoveKind, Reading, Step,
};
use gwatt::machine::{AXES, LookAhead, Machine, QueueEffect};
use gwatt::plan::Overrides;
use gwatt::plan::lookahead::{CornerSet, Element, Joint, PathPlanner, Planned};
use gwatt::syntax::{Block, scan_line};
use std::collections::HashMap;

use crate::machines::{linear_axes, machine_from};

/// Blends without a tolerance.
pub(crate) const FREE: Joint = Joint::Blend {
    tolerance_mm: 0.0,
    join_mm: 0.0,
};

/// A machine with X, Y and Z alike.
pub(crate) fn machine(controller: &str, speed_mm_s: f64, accel_mm_s2: f64) -> Machine {
    machine_from(&format!(
        "schema = 1\nname = \"test\"\ncontroller = \"{controller}\"\n[converter]\n\
         peak_power_w = 1e9\n{}",
        linear_axes("XYZ", [speed_mm_s * 60.0, accel_mm_s2, 100.0], "")
    ))
}

/// A straight feed.
pub(crate) fn line(to: [f64; 3], feed_mm_s: f64, accel_mm_s2: f64, joint: Joint) -> Element<usize> {
    let length_mm = to.iter().map(|d| d * d).sum::<f64>().sqrt();
    let mut start = [0.0; AXES];
    for (change, d) in start.iter_mut().zip(to) {
        *change = d / length_mm;
    }
    Element {
        tag: 0,
        rapid: false,
        length_mm,
        feed_mm_s,
        pace: 1.0,
        speed_mm_s: 1e3,
        accel_mm_s2,
        drive_accel_mm_s2: f64::INFINITY,
        path_accel_mm_s2: f64::INFINITY,
        jerk_mm_s3: f64::INFINITY,
        jerk_factor: 1.0,
        curve_speed_mm_s: f64::INFINITY,
        axis_accel_mm_s2: [accel_mm_s2; AXES],
        start,
        end: start,
        curve: None,
        set: CornerSet::None,
        joint,
    }
}

/// All pieces of elements, tagged by their index, that end at rest.
pub(crate) fn plan(
    machine: &Machine,
    rule: LookAhead,
    elements: &[Element<usize>],
) -> Vec<Planned<usize>> {
    let mut planner = PathPlanner::new(machine, rule);
    let mut pieces = Vec::new();
    for (tag, element) in elements.iter().enumerate() {
        planner.push(&Element { tag, ..*element });
        pieces.extend(std::iter::from_fn(|| planner.pop()));
    }
    planner.stop();
    pieces.extend(std::iter::from_fn(|| planner.pop()));
    pieces
}

/// Speed at the start of a piece, mm/s.
pub(crate) fn start(piece: &Planned<usize>) -> f64 {
    piece
        .profile()
        .phases
        .first()
        .map_or(0.0, |phase| phase.velocity_mm_s)
}

/// Speed at its end, mm/s.
pub(crate) fn end(piece: &Planned<usize>) -> f64 {
    piece
        .profile()
        .phases
        .last()
        .map_or(0.0, |phase| phase.end_velocity_mm_s)
}

fn word(text: &str, letter: char) -> Option<f64> {
    let (_, rest) = text.split_once(letter)?;
    let end = rest
        .find(|c: char| !c.is_ascii_digit() && c != '.')
        .unwrap_or(rest.len());
    rest[..end].parse().ok()
}

/// The pieces of a program, and the time of its dwells in s.
pub(crate) type Run = (Vec<Planned<u64>>, f64);

/// Plans a program as its controller would; pieces carry line numbers, and the
/// second figure is the time of the dwells.
pub(crate) fn plan_program(machine: &Machine, program: &[u8]) -> Run {
    plan_elements(machine, program).0
}

/// The same, with the last element of each line.
pub(crate) fn plan_elements(
    machine: &Machine,
    program: &[u8],
) -> (Run, HashMap<u64, Element<u64>>) {
    let mut elements = HashMap::new();
    let reading = Reading::default();
    let mut interpreter = Interpreter::new(machine, &reading);
    let (mut block, mut diagnostics) = (Block::default(), Diagnostics::default());
    let mut steps = Vec::new();
    let mut facts = Facts::default();
    let rule = machine.controller.planner.look_ahead.unwrap();
    let mut planner = PathPlanner::new(machine, rule);
    let (mut pieces, mut dwells_s, mut joint) = (Vec::new(), 0.0, FREE);
    for (text, number) in program.split_inclusive(|byte| *byte == b'\n').zip(1..) {
        scan_line(text, number == 1, &mut block);
        steps.clear();
        interpreter.execute(
            number,
            text,
            &mut block,
            Effects::new(&mut steps, &mut facts, &mut diagnostics),
        );
        let code = String::from_utf8_lossy(text);
        let code = code.split(['(', ';']).next().unwrap();
        if code.contains("G61.1") {
            joint = Joint::Stop;
        } else if code.contains("G61") {
            joint = Joint::Exact;
        } else if code.contains("G64") {
            let tolerance_mm = word(code, 'P').unwrap_or(0.0);
            joint = Joint::Blend {
                tolerance_mm,
                join_mm: word(code, 'Q').unwrap_or(tolerance_mm),
            };
        }
        for step in &steps {
            match step {
                Step::Move(mv) if mv.kind == MoveKind::Dwell => {
                    planner.stop();
                    dwells_s += mv.dwell_s;
                }
                Step::Move(mv) => {
                    let element = Element::of(machine, mv, Overrides::default(), joint, mv.line);
                    if let Some(element) = element {
                        planner.push(&element);
                        elements.insert(mv.line, element);
                    }
                }
                Step::Action(action) => {
                    let letter = match action.kind {
                        ActionKind::SpindleSpeed => b'S',
                        ActionKind::Offset => b'G',
                        _ => b'M',
                    };
                    let number = (action.value * 10.0).round() as u16;
                    let said = machine.controller.queue.effect(letter, number);
                    let ends = matches!(action.kind, ActionKind::Stop | ActionKind::End);
                    let parts = matches!(action.kind, ActionKind::PathMode | ActionKind::Feed);
                    if ends || said == Some(QueueEffect::Stop) {
                        planner.stop();
                    } else if parts || said == Some(QueueEffect::Pass) {
                        planner.part();
                    }
                }
            }
        }
        pieces.extend(std::iter::from_fn(|| planner.pop()));
    }
    assert_eq!(diagnostics.errors, 0, "{:?}", diagnostics.list);
    planner.stop();
    pieces.extend(std::iter::from_fn(|| planner.pop()));
    ((pieces, dwells_s), elements)
}

/// How long pieces and dwells last together, s.
pub(crate) fn total_s(planned: &Run) -> f64 {
    planned.0.iter().map(Planned::duration_s).sum::<f64>() + planned.1
}
