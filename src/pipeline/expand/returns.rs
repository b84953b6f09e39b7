//! Returns to the reference point, and rapids in machine coordinates: their way is gone by
//! a rapid of its own before them.

use std::collections::BTreeMap;

use super::series::{Lines, Series};
use crate::interpret::{Modal, Motion, Step, TWO_OF_A_GROUP};
use crate::machine::{AxisKind, AxisSet, Lathe, Machine};
use crate::pipeline::executor::Line;
use crate::rewrite::Return;

/// What is said where such a block stays as it is.
const STAYS: &str = "the way to the reference point is not gone by a feed";

/// The state before a block, as far as it matters.
pub(super) struct Before {
    motion: Motion,
    absolute: bool,
}

impl Before {
    pub(super) fn of(modal: &Modal) -> Self {
        Self {
            motion: modal.motion,
            absolute: modal.absolute,
        }
    }
}

/// What such a block becomes.
pub(super) fn series(line: &Line<'_, '_>, before: &Before, machine: &Machine) -> Option<Series> {
    let language = &machine.controller.language;
    let mut moving = AxisSet::default();
    for step in &*line.steps {
        if let Step::Move(mv) = step {
            moving.0 |= mv.moving.0 | mv.unknown_start.0;
        }
    }
    if moving.is_empty() {
        return None;
    }
    let (_, number) = line.key;
    let facts = &*line.facts;
    let unknown_point = facts
        .reference
        .filter(|point| !line.interpreter.knows_reference(*point, moving));
    let written = if line.block.delete_level > 0 || facts.checksum {
        Err("its block may be skipped")
    } else if facts.fixed == Some(TWO_OF_A_GROUP) {
        Err(TWO_OF_A_GROUP)
    } else if facts.compensated {
        Err("it runs under cutter compensation")
    } else if facts.beam_is_lit {
        Err("the laser is on: it would burn along a feed")
    } else if facts.feeds_are_rounded {
        Err("corners of feeds are rounded more than those of rapids")
    } else if facts.rapids_may_be_slower {
        Err("OVRRAP may hold rapids to less than they count")
    } else if let Some(point) = unknown_point {
        Err(not_known(point, machine))
    } else if let Some(why) = line.interpreter.unsure_of_places(moving) {
        Err(why)
    } else {
        let block = Return {
            text: line.text,
            block: line.block,
            steps: line.steps,
            motion_before: before.motion,
            arcs_stand_alone: !language.family.facts().arcs_need_words,
            absolute_before: before.absolute,
            modal: line.interpreter.modal(),
            in_machine: facts.machine_coordinates,
            increments: language.dialect.lathe == Some(Lathe::A),
            tool_change: language.tool_change,
        };
        if language.family.facts().returns_in_machine_coordinates {
            write_in_machine(&block, moving, machine)
        } else {
            block.write(|place| line.interpreter.place_in_program(place))
        }
    };
    let mut lines = Lines::default();
    lines.add(number, written);
    Some(Series {
        stays: STAYS,
        numbers: BTreeMap::from([(number, line.block.number.map(|word| word.value))]),
        written_out: lines.clone(),
        placed: lines,
        ..Series::default()
    })
}

/// Why a return cannot be gone by feeds before it where nobody has said where it leads.
fn not_known(point: u16, machine: &Machine) -> &'static str {
    let stored = machine
        .controller
        .language
        .family
        .facts()
        .reference_in_parameters;
    match (point > 1, stored) {
        (false, false) => {
            "where it leads is not known: give reference_mm of the axes in the machine file"
        }
        (false, true) => {
            "where it leads is not known: give the control's --parameters, or G28 under [offsets] in \
             the machine file"
        }
        (true, true) => {
            "where it leads is not known: give the control's --parameters, or G30 under [offsets] in \
             the machine file"
        }
        (true, false) => {
            "where it leads is not known: give further_reference_mm of the axes in the machine \
             file"
        }
    }
}

/// The way to the reference point of SINUMERIK.
fn write_in_machine(
    block: &Return<'_>,
    moving: AxisSet,
    machine: &Machine,
) -> Result<Vec<u8>, &'static str> {
    let linear = |axis: usize| {
        let data = machine.axes[axis].as_ref();
        data.is_some_and(|data| data.kind == AxisKind::Linear)
    };
    if !moving.iter().all(linear) {
        return Err("it turns a rotary axis");
    }
    block.write_in_machine(block.modal.mm_per_unit)
}
