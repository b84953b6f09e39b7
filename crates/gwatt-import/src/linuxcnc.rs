//! LinuxCNC: the INI file, with scales and limits of its HAL files where those are there.
//!
//! Source: LinuxCNC documentation, "INI Configuration", "G-Code Quick Reference". Speeds are
//! in machine units per second; `[AXIS_n]` of a number is that of versions before 2.8.

mod changes;
mod config;
mod hal;
mod kinematics_module;
mod screen;
mod start_up;
mod version;

use config::{Config, INCH, MIN, named, section};
use kinematics_module::by_name;
use std::path::Path;

use gwatt_machine::AxisId;

use crate::found::{Build, Figure, Found, entry, highest, shown};
use crate::ini::{Item, Style, first, items};
use crate::near::{Job, Near};
use crate::text::{File, Log};
use hal::Hal;

/// How its files are written.
const STYLE: Style = Style {
    separators: &['='],
    saved: None,
    inline: &['#', ';'],
};

/// The file that a line includes.
pub(crate) fn include(line: &str) -> Option<&str> {
    let name = line.strip_prefix("#INCLUDE")?.trim();
    (!name.is_empty()).then_some(name)
}

/// Reads the INI file; HAL files that it names are looked for next to it.
pub(crate) fn read(job: &Job, near: &dyn Near, log: &mut Log) -> Found {
    let items = items(job, STYLE);
    let mut found = Found::new("linuxcnc", "Machine under LinuxCNC", Build::Screws);
    if let Some(name) = first(&items, "EMC", "MACHINE").filter(|it| !it.value.is_empty()) {
        name.value.clone_into(&mut found.name);
    }
    let scripts = hal_files(&items, job, near, log);
    let linear = units(&items, log, "LINEAR_UNITS");
    let angular = units(&items, log, "ANGULAR_UNITS");
    let config = Config {
        items,
        linear,
        angular,
        hal: Hal::new(scripts.iter().filter(|file| is_hal(&file.name)), log),
    };
    kinematics_of(&config, &mut found, log);
    let named = first(&config.items, "KINS", "KINEMATICS");
    let named = named.and_then(|it| it.value.split_whitespace().next());
    for module in hal::modules(&scripts) {
        if named != Some(module.name.as_str()) {
            module.take(&mut found, log);
        }
    }
    for (id, joints) in coordinates(&config) {
        axis(&config, &mut found, log, id, &joints);
    }
    trajectory(&config, &mut found, log);
    version::unread(&config, &mut found, log);
    start_up::read(&config, &mut found, log);
    screen::overrides(&config, &mut found, log);
    changes::tool_change(&config, &mut found, log);
    changes::remaps(&config, &mut found, log);
    corners(&config, &mut found, log);
    for name in ["SPINDLE_0", "SPINDLE"] {
        if found.spindle_rpm.is_none() {
            found.spindle_rpm = config.positive(log, &section(name), "MAX_FORWARD_VELOCITY", 1.0);
        }
    }
    found
}

/// The files of HAL that are there. Where the INI file does not name the kinematics (up to
/// 2.7, Machinekit), one that is missing may.
fn hal_files(items: &[Item<'_>], job: &Job, near: &dyn Near, log: &mut Log) -> Vec<File> {
    let named = first(items, "KINS", "KINEMATICS").is_some();
    let mut files = Vec::new();
    for item in items {
        let is_file = matches!(item.key.as_str(), "HALFILE" | "POSTGUI_HALFILE");
        let name = item.value.split_whitespace().next();
        let Some(name) = name.filter(|_| item.section == "HAL" && is_file) else {
            continue;
        };
        let mut found = Vec::new();
        if !name.starts_with("LIB:") {
            found = near.files(job.name(), name);
        }
        if found.is_empty() && item.key == "HALFILE" && !named {
            let message =
                format!("`{name}` was not found, which may load kinematics other than trivkins");
            let help = "each axis counts as driven by its own joint: see its `loadrt` lines, or put it where \
                        the line says";
            log.warning(&item.place, message, help);
        }
        files.extend(found);
    }
    files
}

/// Scripts in Tcl are no lists of settings.
fn is_hal(name: &str) -> bool {
    let extension = Path::new(name).extension();
    extension.is_some_and(|extension| extension.eq_ignore_ascii_case("hal"))
}

/// Millimetres, or degrees, of a unit.
fn units(items: &[Item<'_>], log: &mut Log, key: &str) -> f64 {
    let Some(item) = first(items, "TRAJ", key) else {
        return 1.0;
    };
    match item.value.to_ascii_lowercase().as_str() {
        "mm" | "metric" | "degree" | "degrees" | "deg" => 1.0,
        "inch" | "in" | "imperial" => INCH,
        "cm" => 10.0,
        "rad" | "radian" => 180.0 / std::f64::consts::PI,
        "grad" | "gon" => 0.9,
        other => match other.parse::<f64>() {
            // Units per millimetre, or per degree.
            Ok(number) if number > 0.0 && number.is_finite() => 1.0 / number,
            _ => {
                let message = format!("`{}` is no unit", item.value);
                log.error(&item.place, message, "write mm or inch, degree or rad");
                1.0
            }
        },
    }
}

fn kinematics_of(config: &Config<'_>, found: &mut Found, log: &mut Log) {
    let Some(item) = first(&config.items, "KINS", "KINEMATICS") else {
        return;
    };
    let name = item.value.split_whitespace().next().unwrap_or("");
    by_name(name, item.whole, &item.place, found, log);
}

/// The letters of the axes, each with its joints in the order of `coordinates=`.
fn coordinates(config: &Config<'_>) -> Vec<(AxisId, Vec<usize>)> {
    let kins = first(&config.items, "KINS", "KINEMATICS").and_then(|it| {
        let words = it.value.split_whitespace();
        words
            .rev()
            .find_map(|word| word.strip_prefix("coordinates="))
    });
    let named = kins.or_else(|| first(&config.items, "TRAJ", "COORDINATES").map(|it| it.value));
    let mut axes: Vec<(AxisId, Vec<usize>)> = Vec::new();
    let letters = named
        .unwrap_or("XYZ")
        .bytes()
        .filter(u8::is_ascii_alphabetic);
    for (joint, letter) in letters.enumerate() {
        let Some(id) = AxisId::from_letter(letter.to_ascii_uppercase()) else {
            continue;
        };
        match axes.iter_mut().find(|(known, _)| *known == id) {
            Some((_, joints)) => joints.push(joint),
            None => axes.push((id, vec![joint])),
        }
    }
    axes
}

fn axis(config: &Config<'_>, found: &mut Found, log: &mut Log, id: AxisId, joints: &[usize]) {
    let letter = id.letter() as char;
    let joint = joints.first().copied().unwrap_or(0);
    // Before 2.8 the number is that of the letter in XYZABCUVW.
    let sections = [
        format!("AXIS_{letter}"),
        format!("JOINT_{joint}"),
        format!("AXIS_{}", id as usize),
    ];
    let kind = config
        .item(&sections, "TYPE")
        .map(|it| it.value.to_ascii_uppercase());
    let by_letter = matches!(id, AxisId::A | AxisId::B | AxisId::C);
    let angular = kind.map_or(by_letter, |kind| kind == "ANGULAR");
    // For the interpreter X to Z and U to W are lengths, whatever drives them.
    let odd = angular && !by_letter;
    let rotary = angular && by_letter;
    let unit = match (odd, rotary) {
        (true, _) => config.linear.max(config.angular),
        (_, true) => config.angular,
        _ => config.linear,
    };
    if let Some(item) = config.item(&sections, "TYPE").filter(|_| odd) {
        let message = format!("{letter} is a length in programs, and its joint is ANGULAR");
        let help =
            "it counts as linear, a degree as a millimetre: give its mass as its drive feels it";
        log.warning(&item.place, message, help);
    }
    let mut rapid = config.positive(log, &sections, "MAX_VELOCITY", unit * MIN);
    let accel = config.positive(log, &sections, "MAX_ACCELERATION", unit);
    // The path is never faster, and so is none of its axes.
    let top = version::traj_velocity(config, log).filter(|_| !rotary);
    if let (Some(own), Some(top)) = (&rapid, top)
        && top.value < own.value
    {
        rapid = Some(Figure::new(
            top.value,
            format!("{}, below {}", top.source, own.source),
        ));
    }
    let [min, max] = ["MIN_LIMIT", "MAX_LIMIT"].map(|key| config.number(log, &sections, key, unit));
    let home = config.number(log, &sections[1..], "HOME", unit);
    let search = config.number(log, &sections[1..], "HOME_SEARCH_VEL", unit * MIN);
    let scales = ["STEP_SCALE", "SCALE", "INPUT_SCALE", "OUTPUT_SCALE"];
    let scale = scales
        .iter()
        .find_map(|key| config.item(&sections, key).map(|it| named(it)));
    let to = found.axis(id);
    to.rotary = rotary;
    (to.rapid, to.accel) = (rapid, accel);
    if let (Some(min), Some(max)) = (min, max) {
        to.travel(&min, &max, "");
    }
    if let Some(home) = home {
        let search = search.map_or(String::new(), |it| {
            format!(", {} per minute", shown(it.value.abs()))
        });
        to.comments.push(format!(
            "Home: {}{search}. G28 goes to the place in #5161 and on, at the rapid speed.",
            home.source
        ));
    }
    if let Some(scale) = scale {
        to.drive
            .push(format!("Steps or counts per unit of travel: {scale}"));
    }
    for joint in joints {
        to.drive.extend(config.hal.of(*joint));
    }
    to.motors = joints.len();
}

fn trajectory(config: &Config<'_>, found: &mut Found, log: &mut Log) {
    let angular = config.positive(
        log,
        &section("TRAJ"),
        "MAX_ANGULAR_VELOCITY",
        config.angular * MIN,
    );
    // Of moves of rotary axes alone the other limit holds; where it is not known, none is.
    let turns = found.axes.iter().flatten().any(|axis| axis.rotary);
    let top = match (version::traj_velocity(config, log), angular) {
        (Some(top), None) if !turns => Some(top),
        (Some(top), Some(angular)) if turns => highest([top, angular]),
        (Some(top), Some(_)) => Some(top),
        _ => None,
    };
    if let Some(top) = top {
        found.path(
            format!("max_feed_mm_min = {}", shown(top.value)),
            top.source,
        );
    }
    let left = [
        ("MAX_LINEAR_ACCELERATION", "acceleration along the path"),
        ("ARC_BLEND_ENABLE", "blend arcs"),
        ("ARC_BLEND_FALLBACK_ENABLE", "blends where arcs do not fit"),
        ("ARC_BLEND_RAMP_FREQ", "frequency of ramps"),
        ("PLANNER_TYPE", "planner with limits of jerk"),
        ("MAX_LINEAR_JERK", "jerk along the path"),
    ];
    for (key, what) in left {
        let Some(item) = first(&config.items, "TRAJ", key) else {
            continue;
        };
        if (key == "ARC_BLEND_ENABLE" && item.value == "1")
            || (key.ends_with("_ENABLE") && key.contains("FALLBACK") && item.value == "0")
        {
            continue;
        }
        found.remarks.push(format!("{} ({what})", named(item)));
        let help = "gwatt plans as LinuxCNC 2.9 does without it; --certificate robust holds for any blending";
        log.warning(
            &item.place,
            format!("{key}, {what}, is not taken over"),
            help,
        );
    }
}

fn corners(config: &Config<'_>, found: &mut Found, log: &mut Log) {
    let traj = section("TRAJ");
    if let Some(depth) = config.positive(log, &traj, "ARC_BLEND_OPTIMIZATION_DEPTH", 1.0) {
        found.look_ahead(format!("blocks = {}", shown(depth.value)), depth.source);
    }
    let mut fields = Vec::new();
    if let Some(period) = config.positive(log, &section("EMCMOT"), "SERVO_PERIOD", 1e-9) {
        fields.push(entry(
            format!("servo_period_s = {}", shown(period.value)),
            period.source,
        ));
    }
    if let Some(ratio) = config.positive(log, &traj, "ARC_BLEND_KINK_RATIO", 1.0) {
        fields.push(entry(
            format!("kink_ratio = {}", shown(ratio.value)),
            ratio.source,
        ));
    }
    if let Some(cycles) = config.positive(log, &traj, "ARC_BLEND_GAP_CYCLES", 1.0) {
        fields.push(entry(
            format!("gap_cycles = {}", shown(cycles.value)),
            cycles.source,
        ));
    }
    if !fields.is_empty() {
        found.corner = Some(("linuxcnc", fields));
    }
}
