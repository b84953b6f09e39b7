//! Blocks that stay one, and strategies that a control cannot follow.

use super::super::{EXACT_STOP, Rig};
use super::{HOW, ISG, notes};
use gwatt::machine::Machine;
use gwatt::pipeline::{Failure, Law, LimitOptions, Options, limit};

#[test]
fn blocks_that_cannot_be_divided_stay_one() {
    let machine = Rig {
        peak_w: 625.0,
        ..ISG
    }
    .machine();
    let line = "it makes several moves, or does something else as well";
    for (program, reason) in [
        (
            "G91\nG0 X300\nM30\n",
            "its places are increments (G91, M83)",
        ),
        ("G0 X300 M8\nM30\n", line),
        (
            "G0 X300 G60\nM30\n",
            "it has other words, or is not where its words say",
        ),
        (
            "G360\nG0 X300\nM30\n",
            "its pieces would not run on into each other as planned",
        ),
        (
            "G0 X300\nX290 Y200\nM30\n",
            "it may be blended with its neighbours, and how the control does that is not \
             modelled",
        ),
        (
            "P1 = 300\nG0 XP1\nM30\n",
            "its values are worked out by the program",
        ),
        (
            "$FOR P1 = 1, 2, 1\nG0 X300\nG4 P1\nX0\nG4 P1\n$ENDFOR\nM30\n",
            "the program has calls or loops, or there are several ways through it",
        ),
        ("G0 X12.6\nM30\n", "one acceleration is as good"),
    ] {
        let found = notes(&machine, HOW, program);
        let message = format!("the block is not written in pieces: {reason}");
        assert_eq!(found, [message], "{program}");
    }
    let mut slow = machine.clone();
    slow.controller.planner.shortest_block_s = 0.2;
    let message = "the block is not written in pieces: its pieces would be shorter than the \
                   control can use";
    assert_eq!(notes(&slow, HOW, "G0 X300\nM30\n"), [message]);
    // Nothing is said where nothing is lowered.
    assert_eq!(notes(&machine, HOW, "G0 X1\nM30\n"), [""; 0]);
}

#[test]
fn strategies_that_the_control_cannot_follow_are_refused() {
    let refused = |machine: &Machine, how: LimitOptions| {
        let input = std::io::Cursor::new(b"G0 X1\n");
        match limit(input, machine, &Options::default(), how, Vec::new(), None) {
            Err(Failure::Unsuitable(message)) => message,
            other => panic!("{other:?}"),
        }
    };
    let rig = Rig {
        controller: "iso",
        ..ISG
    };
    assert_eq!(
        refused(&rig.machine(), HOW),
        "--strategy split: the controller `iso` has no word for acceleration; use optimal"
    );
    let mut machine = ISG.machine();
    for knob in &mut machine.controller.knobs {
        knob.between_moves = false;
    }
    assert_eq!(
        refused(&machine, HOW),
        "--strategy split: the word for acceleration of the controller `isg` is not known to \
         act between moving blocks (between_moves); use optimal"
    );
    let rig = Rig {
        rest: EXACT_STOP,
        ..ISG
    };
    assert_eq!(
        refused(&rig.machine(), HOW),
        "--strategy split: with path.mode = \"exact-stop\" each piece of a block would end at \
         rest; use optimal"
    );
    let patent = LimitOptions {
        law: Law::Patent,
        ..HOW
    };
    let message = "--law patent goes with --strategy speed or accel";
    assert_eq!(refused(&ISG.machine(), patent), message);
}
