//! Marlin: `Configuration.h` and `Configuration_adv.h`.
//!
//! Which of the compiler's branches hold is not followed: of several values of a name the
//! highest counts, and of several places none. Source: the files' own comments, and Marlin's `planner.cpp` for
//! `S_CURVE_ACCELERATION`, whose speed over time is the quintic `6t⁵ − 15t⁴ + 10t³`: its
//! steepest slope, at the middle, is 15/8 of the mean.

mod defines;

use gwatt_machine::{ALL_AXES, AxisId};

use crate::found::{Build, Figure, Found, FoundAxis, entry, highest, shown};
use crate::kinematics;
use crate::marlin::classic;
use crate::near::Job;
use crate::text::Log;
use defines::{Define, Defines};

/// Steepest slope of the S-curve by its mean.
const S_CURVE: f64 = 1.875;

/// Other kinematics than Cartesian and Core.
const OTHERS: [&str; 9] = [
    "DELTA",
    "MORGAN_SCARA",
    "MP_SCARA",
    "AXEL_TPARA",
    "POLAR",
    "POLARGRAPH",
    "MAKERARM_SCARA",
    "SCARA",
    "FOAMCUTTER_XYUV",
];

/// Reads the configuration.
pub(crate) fn read(job: &Job, log: &mut Log) -> Found {
    let defines = Defines::new(job);
    let mut found = Found::new("marlin", "Printer under Marlin", Build::Belts);
    if let Some(name) = defines.all("CUSTOM_MACHINE_NAME").next() {
        let text = name.value.trim_matches('"').trim();
        if !text.is_empty() {
            text.clone_into(&mut found.name);
        }
    }
    for (name, known) in [
        ("COREXY", Some("corexy")),
        ("COREXZ", Some("corexz")),
        ("COREYZ", None),
        ("COREYX", Some("corexy")),
        ("COREZX", Some("corexz")),
        ("COREZY", None),
        ("MARKFORGED_XY", None),
        ("MARKFORGED_YX", None),
    ] {
        if let Some(define) = defines.all(name).next() {
            kinematics::core(&mut found, log, &define.place, define.whole, known);
        }
    }
    for name in OTHERS {
        if let Some(define) = defines.all(name).next() {
            kinematics::refuse(log, &define.place, name);
        }
    }
    axes(&defines, &mut found, log);
    path(&defines, &mut found, log);
    corners(&defines, &mut found, log);
    found
}

/// Axes after X, Y and Z: the driver that makes one, its name where none is given, and the
/// names of what says so.
const FURTHER: [(&str, AxisId, &str, &str); 6] = [
    ("I_DRIVER_TYPE", AxisId::A, "AXIS4_NAME", "AXIS4_ROTATES"),
    ("J_DRIVER_TYPE", AxisId::B, "AXIS5_NAME", "AXIS5_ROTATES"),
    ("K_DRIVER_TYPE", AxisId::C, "AXIS6_NAME", "AXIS6_ROTATES"),
    ("U_DRIVER_TYPE", AxisId::U, "AXIS7_NAME", "AXIS7_ROTATES"),
    ("V_DRIVER_TYPE", AxisId::V, "AXIS8_NAME", "AXIS8_ROTATES"),
    ("W_DRIVER_TYPE", AxisId::W, "AXIS9_NAME", "AXIS9_ROTATES"),
];

/// The axes in the order of lists, without extruders; each with whether it turns.
fn letters(defines: &Defines<'_>) -> Vec<(AxisId, bool)> {
    let mut list = vec![(AxisId::X, false), (AxisId::Y, false), (AxisId::Z, false)];
    for (driver, usual, name, rotates) in FURTHER {
        if defines.all(driver).next().is_none() {
            continue;
        }
        let given = defines.all(name).next();
        let letter = given.map(|it| it.value.trim_matches('\'').as_bytes());
        let id = match letter {
            Some([letter]) => AxisId::from_letter(*letter).unwrap_or(usual),
            _ => usual,
        };
        list.push((id, defines.is_on(rotates)));
    }
    list
}

fn axes(defines: &Defines<'_>, found: &mut Found, log: &mut Log) {
    let letters = letters(defines);
    // Extruders come last; several have one value or one each.
    let has_extruder = defines.only("EXTRUDERS", 0) != Some(0.0);
    let mut put = |name: &str, factor: f64, set: fn(&mut FoundAxis) -> &mut Option<Figure>| {
        for (values, source) in defines.lists(log, name) {
            if values.len() > letters.len() && !has_extruder {
                let message = format!("{source}: there are more values than axes with a driver");
                let help =
                    "what is driven and has no driver there belongs into the machine file by hand";
                log.hint(job_name(defines), message, help);
            }
            for (at, value) in values.into_iter().enumerate() {
                let known = letters.get(at).copied();
                let Some((id, rotates)) = known.or(has_extruder.then_some((AxisId::E, false)))
                else {
                    break;
                };
                let axis = found.axis(id);
                axis.rotary = rotates;
                let slot = set(axis);
                if slot.as_ref().is_none_or(|old| value * factor > old.value) {
                    *slot = Some(Figure::new(value * factor, source.clone()));
                }
            }
        }
    };
    put("DEFAULT_MAX_FEEDRATE", 60.0, |axis| &mut axis.rapid);
    put("DEFAULT_MAX_ACCELERATION", 1.0, |axis| &mut axis.accel);
    let homing = defines.lists(log, "HOMING_FEEDRATE_MM_M");
    let old = [
        "HOMING_FEEDRATE_XY",
        "HOMING_FEEDRATE_XY",
        "HOMING_FEEDRATE_Z",
    ];
    for (at, (id, old)) in [AxisId::X, AxisId::Y, AxisId::Z]
        .into_iter()
        .zip(old)
        .enumerate()
    {
        let listed = homing.iter().filter_map(|(values, source)| {
            let value = values.get(at)?;
            Some(Figure::new(*value, source.clone()))
        });
        let speed = highest(listed).or_else(|| defines.figure(log, old));
        place(defines, found, log, id);
        if let Some(axis) = found.known(id) {
            axis.reference_speed = speed.filter(|it| it.value > 0.0);
        }
    }
    for (id, axis) in ALL_AXES.into_iter().zip(&mut found.axes) {
        let Some(axis) = axis else { continue };
        for figure in [&axis.rapid, &axis.accel] {
            if let Some(bad) = figure.as_ref().filter(|it| it.value <= 0.0) {
                let letter = id.letter() as char;
                let message = format!("a limit of axis {letter} is not above 0: {}", bad.source);
                log.whole(job_name(defines), message, "a value above 0 is needed");
            }
        }
        if defines.is_on("S_CURVE_ACCELERATION") {
            let source = defines
                .all("S_CURVE_ACCELERATION")
                .next()
                .map(Define::source);
            let source = format!(
                "15/8 at the middle of its curve: {}",
                source.unwrap_or_default()
            );
            axis.servo_factor = Some(Figure::new(S_CURVE, source));
        }
    }
}

fn job_name<'d>(defines: &'d Defines<'_>) -> &'d str {
    defines
        .list
        .first()
        .map_or("", |define| define.place.file())
}

/// Travel, and where homing ends.
fn place(defines: &Defines<'_>, found: &mut Found, log: &mut Log, id: AxisId) {
    let letter = id.letter() as char;
    let [min, max] =
        ["MIN_POS", "MAX_POS"].map(|end| defines.figure(log, &format!("{letter}_{end}")));
    let direction = defines.figure(log, &format!("{letter}_HOME_DIR"));
    let manual = defines.figure(log, &format!("MANUAL_{letter}_HOME_POS"));
    let probed = id == AxisId::Z
        && [
            "USE_PROBE_FOR_Z_HOMING",
            "Z_MIN_PROBE_USES_Z_MIN_ENDSTOP_PIN",
            "Z_SAFE_HOMING",
        ]
        .into_iter()
        .any(|name| defines.is_on(name));
    let moved = ["BED_CENTER_AT_0_0", "HOMING_BACKOFF_POST_MM"]
        .into_iter()
        .any(|name| defines.is_on(name));
    let Some(axis) = found.known(id) else { return };
    if let (Some(min), Some(max)) = (&min, &max) {
        axis.travel(min, max, " mm");
    }
    let end = direction.and_then(|direction| {
        if direction.value < 0.0 {
            min.map(|min| (min, "MIN_POS"))
        } else {
            max.map(|max| (max, "MAX_POS"))
        }
    });
    let direction = defines.only(&format!("{letter}_HOME_DIR"), 0);
    let home = match (manual, end) {
        (Some(manual), end) => {
            let name = format!("MANUAL_{letter}_HOME_POS");
            // What stands in a branch may not hold.
            let sure = end.is_none() || !defines.all(&name).any(|it| it.in_branch);
            Some((manual, name, sure))
        }
        (None, Some((end, name))) => Some((end, format!("{letter}_{name}"), direction.is_some())),
        (None, None) => None,
    };
    let Some((home, name, sure)) = home else {
        return;
    };
    if !sure || defines.only(&name, 0).is_none() {
        let why = format!("{name} depends on `#if`: put what holds in its place");
        let field = format!("reference_mm = {}", shown(home.value));
        axis.maybe.push(entry(field, why));
    } else if probed || moved {
        let why = "not if a probe, BED_CENTER_AT_0_0 or HOMING_BACKOFF_POST_MM ends it elsewhere";
        let field = format!("reference_mm = {}", shown(home.value));
        axis.maybe.push(entry(field, why));
    } else {
        axis.reference = Some(home);
    }
}

fn path(defines: &Defines<'_>, found: &mut Found, log: &mut Log) {
    let mut parts = Vec::new();
    let mut sources = Vec::new();
    for (name, define) in [
        ("print", "DEFAULT_ACCELERATION"),
        ("travel", "DEFAULT_TRAVEL_ACCELERATION"),
        ("retract", "DEFAULT_RETRACT_ACCELERATION"),
    ] {
        if let Some(figure) = defines.figure(log, define).filter(|it| it.value > 0.0) {
            parts.push(format!("{name} = {}", shown(figure.value)));
            sources.push(figure.source);
        }
    }
    if !parts.is_empty() {
        found.path(
            format!("accel_mm_s2 = {{ {} }}", parts.join(", ")),
            sources.join(", "),
        );
    }
    if defines.off.contains(&"SLOWDOWN") && !defines.is_on("SLOWDOWN") {
        found.path("shortest_at_feed_s = 0", "SLOWDOWN is off");
    } else if let Some(time) = defines.figure(log, "DEFAULT_MINSEGMENTTIME") {
        found.path(
            format!("shortest_at_feed_s = {}", shown(time.value.max(0.0) * 1e-6)),
            time.source,
        );
    }
}

fn corners(defines: &Defines<'_>, found: &mut Found, log: &mut Log) {
    if let Some(blocks) = defines
        .figure(log, "BLOCK_BUFFER_SIZE")
        .filter(|it| it.value > 1.0)
    {
        // As 12 of 16 in the controller profile.
        let seen = (blocks.value - 4.0).max(1.0);
        found.look_ahead(format!("blocks = {}", shown(seen)), blocks.source);
    }
    let mut parts = Vec::new();
    let mut sources = Vec::new();
    for (field, name) in [
        ("max_mm", "MAX_ARC_SEGMENT_MM"),
        ("max_mm", "MM_PER_ARC_SEGMENT"),
        ("min_mm", "MIN_ARC_SEGMENT_MM"),
        ("per_circle", "MIN_CIRCLE_SEGMENTS"),
        ("per_second", "ARC_SEGMENTS_PER_SEC"),
    ] {
        let known = parts.iter().any(|part: &String| part.starts_with(field));
        if let Some(figure) = defines
            .figure(log, name)
            .filter(|it| it.value > 0.0 && !known)
        {
            parts.push(format!("{field} = {}", shown(figure.value)));
            sources.push(figure.source);
        }
    }
    if !parts.is_empty() {
        found.look_ahead(
            format!("chords = {{ {} }}", parts.join(", ")),
            sources.join(", "),
        );
    }
    let deviation = ["JUNCTION_DEVIATION_MM", "JUNCTION_DEVIATION_FACTOR"]
        .map(|name| defines.figure(log, name));
    let deviation = deviation
        .into_iter()
        .flatten()
        .next()
        .filter(|it| it.value > 0.0);
    let names_classic = defines.is_on("CLASSIC_JERK") || defines.off.contains(&"CLASSIC_JERK");
    let old = !names_classic && !defines.is_on("JUNCTION_DEVIATION");
    if defines.is_on("CLASSIC_JERK") || old {
        let mut steps = Vec::new();
        for id in ALL_AXES {
            let name = format!("DEFAULT_{}JERK", id.letter() as char);
            if let Some(step) = defines.figure(log, &name) {
                steps.push((id, step));
            }
        }
        if let Some(steps) = classic(found, steps) {
            found.corner = Some(("classic_jerk", vec![steps]));
            return;
        }
    }
    if let Some(deviation) = deviation {
        let field = format!("deviation_mm = {}", shown(deviation.value));
        found.corner = Some(("junction_deviation", vec![entry(field, deviation.source)]));
    }
}
