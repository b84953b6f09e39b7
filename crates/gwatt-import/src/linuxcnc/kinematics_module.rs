//! What a module of kinematics makes of the machine.

use crate::found::Found;
use crate::kinematics;
use crate::text::{Log, Place};

/// What a module of kinematics makes of the machine. `gantrykins` gives axes several joints.
pub(super) fn by_name(
    name: &str,
    whole: &str,
    place: &Place<'_>,
    found: &mut Found,
    log: &mut Log,
) {
    match name {
        "trivkins" | "gantrykins" | "" => {}
        "corexykins" => kinematics::core(found, log, place, whole, Some("corexy")),
        other => kinematics::refuse(log, place, other),
    }
}
