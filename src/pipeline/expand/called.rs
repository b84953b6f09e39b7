//! Cycles that are called by their names (SINUMERIK): the blocks at which `MCALL` has one run,
//! and those in which it stands.

use std::collections::BTreeMap;

use super::series::Series;
use crate::interpret::CalledCycle;
use crate::pipeline::executor::Line;
use crate::rewrite::{CallingBlock, Singles, without_modal_call};

/// What such a block becomes, with the line that has set its cycle; `texts` are the lines of
/// the program. All blocks of one
/// `MCALL` share that line, so they are written in another way together or not at all.
pub(super) fn series(
    line: &Line<'_, '_>,
    called: CalledCycle,
    texts: &[&[u8]],
    singles: &Singles<'_>,
) -> Series {
    let number = line.key.1;
    let block = CallingBlock {
        text: line.text,
        block: line.block,
        steps: line.steps,
        called,
        modal: line.interpreter.modal(),
    };
    let mut series = Series::default();
    let n_word = line.block.number.map(|word| word.value);
    series.numbers.insert(number, n_word);
    let place = |place: &_| line.interpreter.place_in_program(place);
    let set_at = match called.set_at {
        _ if line.block.delete_level > 0 || line.facts.checksum => Err("its block may be skipped"),
        _ if line.facts.compensated => Err("it runs under cutter compensation"),
        None => Ok(None),
        Some((0, set_at)) => {
            series.numbers.insert(set_at, None);
            let text = texts.get(set_at as usize - 1).copied();
            match text.and_then(without_modal_call) {
                Some(call) => Ok(Some((set_at, call))),
                None => Err("the block of MCALL does more than set the cycle"),
            }
        }
        Some(_) => Err("MCALL stands in the file of a subprogram"),
    };
    let (written_out, placed) = match &set_at {
        Ok(set_at) => {
            let call = set_at.as_ref().map_or(&[][..], |(_, (_, call))| *call);
            (
                singles.write_called_out(&block, place),
                Singles::call_after(&block, call),
            )
        }
        Err(why) => (Err(*why), Err(*why)),
    };
    let set_at = set_at.ok().flatten();
    let with_call = |bytes: Vec<u8>| {
        let mut lines = BTreeMap::from([(number, bytes)]);
        lines.extend(
            set_at
                .as_ref()
                .map(|(at, (comment, _))| (*at, comment.clone())),
        );
        lines
    };
    let refused = |why| (number, why);
    series.written_out = written_out.map(with_call).map_err(refused).into();
    series.placed = placed.map(with_call).map_err(refused).into();
    series
}
