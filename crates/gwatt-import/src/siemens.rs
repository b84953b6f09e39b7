//! SINUMERIK: machine data of an archive, a `.tea` or an MPF file,
//! `N32000 $MA_MAX_AX_VELO[AX1]=10000`.
//!
//! Source: SINUMERIK 840D sl, "Detailed machine data description"; SINUMERIK ONE,
//! "Machine and setting data". Units of an archive are those of the basic metric system:
//! mm/min and rev/min, m/s² and rev/s², m/s³ and rev/s³, mm and degrees.

mod axes;
mod data;

use crate::found::{Build, Found, shown};
use crate::near::Job;
use crate::text::Log;
use data::Data;

pub(crate) use data::line as data_line;

/// Data that change how fast the machine moves, and that gwatt has no field for.
const LEFT_OUT: [(&str, &str); 6] = [
    ("MAX_ACCEL_OVL_FACTOR", "steps of speed at corners"),
    ("CURV_EFFECT_ON_PATH_ACCEL", "acceleration on arcs"),
    ("CURV_EFFECT_ON_PATH_JERK", "jerk on arcs"),
    ("PATH_TRANS_JERK_LIM", "jerk at corners"),
    ("ACCEL_REDUCTION_SPEED_POINT", "acceleration at high speed"),
    ("FIPO_TYPE", "fine interpolation"),
];

/// Reads the data.
pub(crate) fn read(job: &Job, log: &mut Log) -> Found {
    let data = Data::new(job);
    let mut found = Found::new("siemens", "Machine under SINUMERIK", Build::Screws);
    refuse_units(&data, log);
    axes::take(&data, &mut found, log);
    if let Some(mode) = data.first("G0_LINEAR_MODE") {
        let straight = mode.text != "0" && !mode.text.eq_ignore_ascii_case("false");
        let name = if straight { "linear" } else { "independent" };
        found.path(format!("rapid = \"{name}\""), mode.source());
    }
    // The first group of G words: 1 is G0, 2 is G1.
    let motion = data.at("GCODE_RESET_VALUES", 0);
    let name = motion.and_then(|it| match it.text {
        "1" => Some("rapid"),
        "2" => Some("feed"),
        _ => None,
    });
    if let (Some(motion), Some(name)) = (motion, name) {
        found.language(format!("power_on_motion = \"{name}\""), motion.source());
    }
    if let Some(feed) = data.first("DEFAULT_FEED")
        && let Some(value) = log.number(&feed.place, feed.text)
        && value > 0.0
    {
        found.language(
            format!("power_on_feed_mm_min = {}", shown(value)),
            feed.source(),
        );
    }
    let mut named: Vec<String> = Vec::new();
    for (name, what) in LEFT_OUT {
        if let Some(given) = data.first(name) {
            named.push(format!("{name} ({what})"));
            log.warning(
                &given.place,
                format!("{name}, {what}, is not taken over"),
                "the robust bound holds for whatever it makes of speeds below the limits of the axes",
            );
        }
    }
    if !named.is_empty() {
        let list = named.join(", ");
        found
            .remarks
            .push(format!("{list}: moves count within the limits of the axes"));
    }
    found
}

/// Other units than those of the basic metric system.
fn refuse_units(data: &Data<'_>, log: &mut Log) {
    if let Some(system) = data
        .first("SCALING_SYSTEM_IS_METRIC")
        .filter(|it| matches!(it.text, "0" | "FALSE"))
    {
        let message = "the basic system is inch, whose units are not read".to_owned();
        log.error(
            &system.place,
            message,
            "write the archive with the basic system metric (MD10240 = 1)",
        );
    }
    if let Some(mask) = data
        .first("SCALING_USER_DEF_MASK")
        .filter(|it| !matches!(it.text, "0" | "'H0'" | "'B0'"))
    {
        let message = "the units of machine data are the user's own".to_owned();
        log.error(&mask.place, message, "write the archive with MD10220 = 0");
    }
}
