//! Machines whose motors do not move an axis each.

use crate::found::Found;
use crate::text::{Log, Place};

/// `CoreXY` and its relatives: two motors move X and Y (or Z) together.
///
/// Masses: with motor angles `(x ± y)/r` the rotors have the energy `½·2J/r²·(ẋ² + ẏ²)`, so
/// that each of the two axes has the rotors of both.
/// `name` is what machine files call it, where they have a word for it.
pub(crate) fn core(
    found: &mut Found,
    log: &mut Log,
    place: &Place<'_>,
    whole: &str,
    name: Option<&'static str>,
) {
    found.core = true;
    found.kinematics = name;
    let energy = format!(
        "{}: two motors move two axes together. Their energy is that of the axes if each of the two \
         has the rotors of both motors. What each motor draws differs from what each axis draws: with \
         the larger mass for both axes straight moves from rest draw the same; at corners and on arcs \
         a motor may drive while the other brakes.",
        place.source(whole)
    );
    if name.is_some() {
        found.remarks.push(format!(
            "{energy} The robust bound covers that where speed, acceleration, mass and friction are \
             alike in both axes, and is taken."
        ));
        log.warning(
            place,
            "two motors move two axes together: they count by the robust bound".to_owned(),
            "give both axes the larger mass and friction, and the rotors of both motors",
        );
        return;
    }
    found.remarks.push(format!(
        "{energy} With speed, acceleration, mass and friction alike in both axes, --certificate robust \
         covers what the motors draw; else keep a margin."
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
