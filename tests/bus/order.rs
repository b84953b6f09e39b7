//! Words for the spindle in a block that moves: whether they act before or after its motion is the
//! builder's choice on many controls.

use super::{FULL_W, machine};
use crate::runs::rows_of;

/// X of 1000 kg draws 1000 W at the end of its first second, and feeds back as much at the beginning
/// of its last; the spindle's run lasts a second.
const PROGRAM: &str = "G0 X2000 S3000 M3\nX0\nX2000\nX0 M5\nX2000\nX0\n";

/// Drawn and fed back, W, by move.
fn peaks(controller: &str, before_motion: Option<bool>, program: &str) -> Vec<[f64; 2]> {
    peaks_with(controller, before_motion, "wait = false", program)
}

fn peaks_with(
    controller: &str,
    before_motion: Option<bool>,
    spindle: &str,
    program: &str,
) -> Vec<[f64; 2]> {
    let rest = before_motion.map(|it| format!("[language]\nspindle_before_motion = {it}"));
    let machine = machine(controller, "", spindle, &rest.unwrap_or_default());
    let rows = rows_of(&machine, &format!("G90\n{program}M2\n"));
    rows.iter().map(|row| [row.peak_w, row.regen_w]).collect()
}

#[track_caller]
fn assert_near(found: &[[f64; 2]], wanted: &[[f64; 2]]) {
    assert_eq!(found.len(), wanted.len(), "{found:?}");
    for (found, wanted) in found.iter().flatten().zip(wanted.iter().flatten()) {
        assert!((found - wanted).abs() < 1e-3 * wanted, "{found} {wanted}");
    }
}

const AXIS: [f64; 2] = [1000.0, 1000.0];
const STARTS: [f64; 2] = [1000.0 + FULL_W, 1000.0];
const BRAKES: [f64; 2] = [1000.0, 1000.0 + FULL_W];

#[test]
fn both_orders_count_unless_the_machine_file_knows() {
    // Braking begins with the move, so that the spindle has fed back before the axis does.
    let brakes = [1000.0, FULL_W];
    assert_near(
        &peaks("iso", Some(true), PROGRAM),
        &[STARTS, AXIS, AXIS, brakes, AXIS, AXIS],
    );
    // Not known: the run may come at any time of both moves.
    assert_near(
        &peaks("iso", None, PROGRAM),
        &[STARTS, STARTS, AXIS, BRAKES, BRAKES, AXIS],
    );
}

/// A word before the block comes first, and what it has begun may go on until the block's own
/// word acts: it is cut short at any speed.
#[test]
fn words_of_earlier_blocks_come_first() {
    let peaks = |program| peaks("iso", None, program);
    assert_near(
        &peaks("M3 S3000\nG4 P5\nM5\nG0 X2000 M3\nX0\nX2000\n")[1..],
        &[
            [1000.0 + FULL_W, 1000.0 + FULL_W],
            [1000.0 + FULL_W, 1000.0 + FULL_W],
            AXIS,
        ],
    );
    let both = [1000.0 + FULL_W, 1000.0 + FULL_W];
    assert_near(
        &peaks("M3 S3000\nG0 X2000 M5\nG0 X0\nX2000\n"),
        &[both, both, AXIS],
    );
}

/// A gear that is changed in a block that moves, and a dwell.
#[test]
fn gears_and_dwells_have_no_order_either() {
    let found = peaks(
        "haas",
        None,
        "M3 S3000\nG4 P5.\nG0 X2000. M41\nX0\nX2000.\n",
    );
    assert!(found[2][0] > 1000.0 + 0.99 * FULL_W, "{found:?}");
    assert_near(&found[found.len() - 1..], &[AXIS]);
    let found = peaks("iso", None, "G4 P2 M3 S3000\nG0 X2000\nX0\n");
    assert_near(&found[1..], &[STARTS, AXIS]);
}

/// Where moves that cut wait for the speed, the run may come next to the rapid after the block.
#[test]
fn a_run_that_was_waited_for_may_come_later() {
    let program = "M3 S500\nG1 X1000 F60000\nG1 X2000 S3000\nG0 X0\nX2000\n";
    let found = peaks_with("iso", None, "wait = true", program);
    let rapids = &found[found.len() - 2..];
    assert!(rapids[0][0] > 1000.0 + 0.97 * FULL_W, "{found:?}");
    assert_near(&rapids[1..], &[AXIS]);
}

/// LinuxCNC has an order of execution; Fanuc's builder decides.
#[test]
fn controls_with_an_order_of_their_own_keep_it() {
    for controller in ["linuxcnc", "siemens"] {
        assert_eq!(
            peaks(controller, None, PROGRAM),
            peaks(controller, Some(true), PROGRAM)
        );
    }
    for controller in ["fanuc", "haas", "isg", "mazak"] {
        assert_ne!(
            peaks(controller, None, PROGRAM),
            peaks(controller, Some(true), PROGRAM)
        );
    }
}
