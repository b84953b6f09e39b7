//! Klipper: `printer.cfg` with the files that it includes.
//!
//! Sources: Klipper documentation, "Configuration reference"; defaults of the extruder's own
//! limits from `klippy/kinematics/extruder.py`.

mod bodies;
mod carriages;
mod config;
mod extruders;
mod homing;
mod macros;

use config::{Config, MIN};

use gwatt_machine::AxisId;

use crate::found::{Build, Figure, Found, FoundAxis, entry, highest, shown};
use crate::ini::{Style, items, last};
use crate::kinematics;
use crate::near::Job;
use crate::text::Log;
use carriages::{Section, section_of};

/// How its files are written.
pub(crate) const STYLE: Style = Style {
    separators: &[':', '='],
    saved: Some("#*#"),
    inline: &['#', ';'],
};

const AXES: [(AxisId, &str); 3] = [
    (AxisId::X, "stepper_x"),
    (AxisId::Y, "stepper_y"),
    (AxisId::Z, "stepper_z"),
];

/// The files that a line includes.
pub(crate) fn include(line: &str) -> Option<&str> {
    let name = line.strip_prefix("[include ")?.split(']').next()?.trim();
    (!name.is_empty()).then_some(name)
}

/// Reads the configuration.
pub(crate) fn read(job: &Job, log: &mut Log) -> Found {
    let items = items(job, STYLE);
    let config = Config { items: &items };
    let mut found = Found::new("klipper", "Printer under Klipper", Build::Belts);
    kinematics_of(&config, &mut found, log);
    let start = macros::at_start(job, log);
    let with_start = |own: Option<Figure>, set: Option<Figure>| highest(own.into_iter().chain(set));
    let velocity = config.positive(log, "printer", "max_velocity");
    let velocity = with_start(velocity, start.velocity);
    let accel = config.positive(log, "printer", "max_accel");
    let accel = with_start(accel, start.accel);
    let z_velocity = config.positive(log, "printer", "max_z_velocity");
    let z_accel = config.positive(log, "printer", "max_z_accel");
    for (id, section) in AXES {
        let axis = found.axis(id);
        let own = |given: &Option<Figure>, all: &Option<Figure>| {
            let all = all.clone();
            match id {
                AxisId::Z => {
                    let other = || all.map(|it| it.named("as Z has none of its own: "));
                    given.clone().or_else(other)
                }
                _ => all,
            }
        };
        axis.rapid = own(&z_velocity, &velocity).map(|it| it.times(MIN));
        axis.accel = own(&z_accel, &accel);
        let section = section_of(&config, id, section);
        stepper(&config, axis, &section, log);
    }
    extruders::take(&config, &mut found, log, velocity.as_ref(), accel.as_ref());
    left_out(&config, &mut found, log);
    corners(&config, &mut found, log, accel.as_ref());
    homing::safe_z(&config, &mut found, log);
    macros::named(job, &items, &mut found, log);
    found
}

fn kinematics_of(config: &Config<'_, '_>, found: &mut Found, log: &mut Log) {
    let Some(item) = last(config.items, "printer", "kinematics") else {
        return;
    };
    match item.value {
        "cartesian" => {}
        "generic_cartesian" => carriages::kinematics_of(config, found, log),
        name @ ("corexy" | "corexz" | "hybrid_corexy" | "hybrid_corexz") => {
            let name = ["corexy", "corexz"]
                .into_iter()
                .find(|known| *known == name);
            kinematics::core(found, log, &item.place, item.whole, name);
        }
        other => kinematics::refuse(log, &item.place, other),
    }
}

/// Travel, homing and transmission of an axis.
fn stepper(config: &Config<'_, '_>, axis: &mut FoundAxis, of: &Section, log: &mut Log) {
    let section = of.carriage.as_str();
    let min = config.number(log, section, "position_min");
    let max = config.number(log, section, "position_max");
    if let Some(max) = &max {
        let min = min.map_or("0".to_owned(), |min| shown(min.value));
        axis.comments.push(format!(
            "Travel: {min} to {} mm: {}",
            shown(max.value),
            max.source
        ));
    }
    let first = config.positive(log, section, "homing_speed");
    let first = first.unwrap_or(Figure::new(5.0, "homing_speed is 5 by default"));
    let second = config.positive(log, section, "second_homing_speed");
    axis.reference_speed =
        highest([Some(first), second].into_iter().flatten()).map(|it| it.times(MIN));
    let probe =
        last(config.items, section, "endstop_pin").is_some_and(|it| it.value.contains("probe:"));
    match config.number(log, section, "position_endstop") {
        Some(_) if probe => {}
        endstop => axis.reference = endstop,
    }
    if probe {
        let note = "where the probe touches: Z after homing is not known";
        axis.comments
            .push(format!("Its endstop is a probe, {note}."));
    }
    let drive = of.steppers.first().map_or(section, String::as_str);
    axis.drive.extend(config.travel_of_a_turn(log, drive));
    axis.motors = of.steppers.len();
}

/// Sections of motors that no axis of a machine file has.
const OTHER_MOTORS: [&str; 4] = [
    "dual_carriage",
    "manual_stepper",
    "extruder_stepper",
    "servo",
];

/// Names what moves and does not count.
fn left_out(config: &Config<'_, '_>, found: &mut Found, log: &mut Log) {
    let mut named: Vec<&str> = Vec::new();
    for item in config.items {
        let kind = item.section.split_whitespace().next().unwrap_or("");
        let is_other = OTHER_MOTORS
            .iter()
            .any(|other| kind.eq_ignore_ascii_case(other));
        if !is_other || named.contains(&item.section.as_str()) {
            continue;
        }
        named.push(&item.section);
        let message = format!("[{}] moves, and does not count", item.section);
        let help = "what moves together with an axis belongs to its mass and rotors; for the rest add \
                    its power to `base_load_w`";
        log.warning(&item.place.of(item.whole), message, help);
    }
    if !named.is_empty() {
        let list = named.join("], [");
        found
            .remarks
            .push(format!("[{list}]: what it moves does not count"));
    }
}

fn corners(config: &Config<'_, '_>, found: &mut Found, log: &mut Log, accel: Option<&Figure>) {
    let ratio = config.number(log, "printer", "minimum_cruise_ratio");
    let to_decel = config.positive(log, "printer", "max_accel_to_decel");
    let ratio = ratio.or_else(|| {
        let (to_decel, accel) = (to_decel?, accel?);
        let ratio = 1.0 - (to_decel.value / accel.value).min(1.0);
        Some(Figure::new(ratio, to_decel.source))
    });
    if let Some(ratio) = ratio {
        if (0.0..1.0).contains(&ratio.value) {
            found.look_ahead(
                format!("min_cruise_ratio = {}", shown(ratio.value)),
                ratio.source,
            );
        } else if let Some(item) = last(config.items, "printer", "minimum_cruise_ratio") {
            let message = format!("{} is not valid for a cruise ratio", ratio.value);
            log.error(&item.place, message, "it is a share from 0 to below 1");
        }
    }
    if let Some(arc) = config.positive(log, "gcode_arcs", "resolution") {
        found.look_ahead(
            format!("chords = {{ max_mm = {} }}", shown(arc.value)),
            arc.source,
        );
    }
    let mut fields = Vec::new();
    if let Some(speed) = config.number(log, "printer", "square_corner_velocity") {
        fields.push(entry(
            format!("corner_mm_s = {}", shown(speed.value)),
            speed.source,
        ));
    }
    if let Some(step) = extruders::corner_step(config, log) {
        if fields.is_empty() {
            fields.push(entry("corner_mm_s = 5", "as Klipper has it by default"));
        }
        fields.push(entry(
            format!("extruder_step_mm_s = {}", shown(step.value)),
            step.source,
        ));
    }
    if !fields.is_empty() {
        found.corner = Some(("square_corner", fields));
    }
    retract(config, found, log);
}

fn retract(config: &Config<'_, '_>, found: &mut Found, log: &mut Log) {
    let section = "firmware_retraction";
    if !config.has(section) {
        return;
    }
    let mut value = |key: &str, otherwise: f64| {
        config
            .number(log, section, key)
            .map_or(otherwise, |it| it.value.max(0.0))
    };
    let [length, speed, extra, back] = [
        value("retract_length", 0.0),
        value("retract_speed", 20.0),
        value("unretract_extra_length", 0.0),
        value("unretract_speed", 10.0),
    ];
    if speed > 0.0 && back > 0.0 {
        let field = format!(
            "retract = {{ length_mm = {}, speed_mm_s = {}, extra_mm = {}, recover_mm_s = {} }}",
            shown(length),
            shown(speed),
            shown(extra),
            shown(back)
        );
        found.language(field, "[firmware_retraction]");
    }
}
