//! Machines whose motors do not move an axis each.

use crate::found::Found;
use crate::text::{Log, Place};

/// `CoreXY` and its relatives: two motors move X and Y (or Z) together.
///
/// Masses: with motor angles `(x ± y)/r` the rotors have the energy `½·2J/r²·(ẋ² + ẏ²)`, so
/// that each of the two axes has the rotors of both.
pub(crate) fn core(found: &mut Found, log: &mut Log, place: &Place<'_>, whole: &str) {
    found.core = true;
    found.remarks.push(format!(
        "{}: two motors move two axes together. Their energy is that of the axes if each of the two \
         has the rotors of both motors. What each motor draws differs from what each axis draws: with \
         the larger mass for both axes straight moves from rest draw the same; at corners and on arcs \
         a motor may drive while the other brakes. With speed, acceleration, mass and friction alike \
         in both axes, --certificate robust covers what the motors draw; else keep a margin.",
        place.source(whole)
    ));
    log.warning(
        place,
        "two motors move two axes together: gwatt counts by axis".to_owned(),
        "give both axes the larger mass and the rotors of both motors; see the head of the file",
    );
}

/// Kinematics for which powers by axis would be wrong.
pub(crate) fn refuse(log: &mut Log, place: &Place<'_>, name: &str) {
    let message = format!("kinematics `{name}`: its motors do not move X, Y and Z each");
    log.error(
        place,
        message,
        "gwatt describes machines whose axes have a drive each (and CoreXY): powers of this one would be wrong",
    );
}
