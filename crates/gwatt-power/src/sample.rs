//! A move for tests of what holds moves.

use gwatt_interpret::{Diagnostics, Effects, Facts, Interpreter, Move, Reading, Step};
use gwatt_machine::Machine;
use gwatt_syntax::{Block, scan_line};

/// Any move of a machine with X and Y.
pub(super) fn any_move(machine: &Machine) -> Move {
    let text = b"G21 G90 G64 P0.01 G1 X1 Y40 F600\n";
    let reading = Reading::default();
    let mut interpreter = Interpreter::new(machine, &reading);
    let (mut block, mut steps) = (Block::default(), Vec::new());
    let (mut facts, mut found) = (Facts::default(), Diagnostics::default());
    scan_line(text, true, &mut block);
    interpreter.execute(
        1,
        text,
        &mut block,
        Effects::new(&mut steps, &mut facts, &mut found),
    );
    let moves = steps.into_iter().find_map(|step| match step {
        Step::Move(mv) => Some(mv),
        Step::Action(_) => None,
    });
    moves.expect("a move")
}
