//! Machines whose motors do not move an axis each.

use gwatt_machine::AxisId;

use crate::found::{Figure, Found, FoundAxis};
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

/// Axes that share two motors.
pub(crate) fn pair(kinematics: &str) -> [AxisId; 2] {
    match kinematics {
        "corexz" => [AxisId::X, AxisId::Z],
        _ => [AxisId::X, AxisId::Y],
    }
}

/// A figure of an axis, with what it is.
type Named = (&'static str, fn(&mut FoundAxis) -> &mut Option<Figure>);

/// Gives two axes that share their motors the higher figures of both, since the robust bound of
/// the axes covers the motors only where they are alike.
pub(crate) fn alike(found: &mut Found, log: &mut Log, file: &str) {
    let Some(name) = found.kinematics else { return };
    let pair = pair(name);
    // Both have to be described: what is not known of one is asked for.
    for id in pair {
        found.axis(id);
    }
    let figures: [Named; 3] = [
        ("speed", |axis| &mut axis.rapid),
        ("acceleration", |axis| &mut axis.accel),
        ("servo factor", |axis| &mut axis.servo_factor),
    ];
    for (what, figure) in figures {
        let [first, second] = pair.map(|id| figure(found.axis(id)).clone());
        // What the file does not give is asked for.
        let (Some(first), Some(second)) = (first, second) else {
            continue;
        };
        let (low, low_id, high, high_id) = if first.value < second.value {
            (first, pair[0], second, pair[1])
        } else if second.value < first.value {
            (second, pair[1], first, pair[0])
        } else {
            continue;
        };
        let [low_letter, high_letter] = [low_id, high_id].map(|id| char::from(id.letter()));
        let source = format!(
            "that of {high_letter}: {}; its own: {}",
            high.source, low.source
        );
        *figure(found.axis(low_id)) = Some(Figure::new(high.value, source));
        let message = format!(
            "{low_letter} counts with the {what} of {high_letter}, which is higher: they share their motors"
        );
        let help = "what motors draw is bounded only where both axes are alike; times of moves may be too short";
        log.hint(file, message, help);
    }
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
