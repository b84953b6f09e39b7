//! Returns to the reference point, and rapids in machine coordinates: their way is gone by
//! a rapid of its own before them.

use std::collections::BTreeMap;

use super::{Lines, Series};
use crate::interpret::{Modal, Motion, Step};
use crate::machine::AxisSet;
use crate::pipeline::front::Line;
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
pub(super) fn series(line: &Line<'_, '_>, before: &Before) -> Option<Series> {
    let mut moving = AxisSet::default();
    for step in &*line.steps {
        if let Step::Move(mv) = step {
            moving.0 |= mv.moving.0;
        }
    }
    if moving.is_empty() {
        return None;
    }
    let (text, number) = line.key;
    let facts = &*line.facts;
    let written = if text != 0 {
        Err("it stands in the file of a subprogram")
    } else if line.block.delete_level > 0 || facts.checksum {
        Err("its block may be skipped")
    } else if facts.compensated {
        Err("it runs under cutter compensation")
    } else if let Some(why) = line.interpreter.unsure_of_places(moving) {
        Err(why)
    } else {
        let block = Return {
            text: line.text,
            block: line.block,
            steps: line.steps,
            motion_before: before.motion,
            absolute_before: before.absolute,
            modal: line.interpreter.modal(),
            in_machine: facts.machine_coordinates,
        };
        block.write(|place| line.interpreter.place_in_program(place))
    };
    let lines: Lines = match written {
        Ok(bytes) => Ok(BTreeMap::from([(number, bytes)])),
        Err(why) => Err((number, why)),
    };
    Some(Series {
        stays: STAYS,
        numbers: BTreeMap::from([(number, line.block.number.map(|word| word.value))]),
        written_out: lines.clone(),
        placed: lines,
        ..Series::default()
    })
}
