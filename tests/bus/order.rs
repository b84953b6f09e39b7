//! Words for the spindle in a block that moves: whether they act before or after its motion is the
//! builder's choice on many controls.

use super::{FULL_W, machine};
use crate::runs::rows_of;

/// X of 1000 kg draws 1000 W at the end of its first second, and feeds back as much at the beginning
/// of its last; the spindle's run lasts a second.
const PROGRAM: &str = "G0 X2000 S3000 M3\nX0\nX2000\nX0 M5\nX2000\nX0\n";

/// Drawn and fed back, W, by move.
fn peaks(controller: &str, order: &str) -> Vec<[f64; 2]> {
    let rest = match order {
        "" => String::new(),
        order => format!("[language]\nspindle_words = \"{order}\""),
    };
    let machine = machine(controller, "", "wait = false", &rest);
    let rows = rows_of(&machine, &format!("G90\n{PROGRAM}M2\n"));
    rows.iter().map(|row| [row.peak_w, row.regen_w]).collect()
}

#[track_caller]
fn assert_near(found: &[[f64; 2]], wanted: [[f64; 2]; 6]) {
    assert_eq!(found.len(), wanted.len());
    for (found, wanted) in found.iter().flatten().zip(wanted.iter().flatten()) {
        assert!((found - wanted).abs() < 1e-3 * wanted, "{found} {wanted}");
    }
}

#[test]
fn both_orders_count_unless_the_machine_file_knows() {
    let (axis, both) = ([1000.0, 1000.0], 1000.0 + FULL_W);
    // Braking begins with the move, so that the spindle has fed back before the axis does.
    let [starts, brakes] = [[both, 1000.0], [1000.0, FULL_W]];
    assert_near(
        &peaks("iso", "before-motion"),
        [starts, axis, axis, brakes, axis, axis],
    );
    assert_near(
        &peaks("iso", "after-motion"),
        [axis, starts, axis, axis, brakes, axis],
    );
    // Not known: the run may come at any time of both moves.
    let [start, brake] = [[both, 1000.0], [1000.0, both]];
    assert_near(&peaks("iso", ""), [start, start, axis, brake, brake, axis]);
}

/// LinuxCNC has an order of execution; Fanuc's builder decides.
#[test]
fn controls_with_an_order_of_their_own_keep_it() {
    for controller in ["linuxcnc", "siemens"] {
        assert_eq!(peaks(controller, ""), peaks(controller, "before-motion"));
    }
    for controller in ["fanuc", "haas", "isg", "mazak"] {
        assert_ne!(peaks(controller, ""), peaks(controller, "before-motion"));
    }
}
