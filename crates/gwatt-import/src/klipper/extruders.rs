//! Extruders: the highest limits of all of them are those of E.
//!
//! Source: Klipper documentation, "Configuration reference", `[extruder]`; defaults from
//! `klippy/kinematics/extruder.py`.

use std::f64::consts::PI;

use gwatt_machine::AxisId;

use super::config::{Config, MIN};
use crate::found::{Figure, Found, highest, shown};
use crate::text::Log;

/// As many as Klipper looks for.
const MOST: usize = 100;

/// The sections of extruders: `extruder`, `extruder1` …
pub(super) fn sections(config: &Config<'_, '_>) -> Vec<String> {
    let names = (0..MOST).map(|number| match number {
        0 => "extruder".to_owned(),
        number => format!("extruder{number}"),
    });
    names.filter(|section| config.has(section)).collect()
}

/// Reads all extruders.
pub(super) fn take(
    config: &Config<'_, '_>,
    found: &mut Found,
    log: &mut Log,
    velocity: Option<&Figure>,
    accel: Option<&Figure>,
) {
    let sections = sections(config);
    if sections.is_empty() {
        return;
    }
    let all: Option<Vec<[Option<Figure>; 2]>> = sections
        .iter()
        .map(|section| limits(config, log, section, [velocity, accel]))
        .collect();
    let axis = found.axis(AxisId::E);
    if let Some(all) = all {
        axis.rapid =
            highest(all.iter().filter_map(|[speed, _]| speed.clone())).map(|it| it.times(MIN));
        axis.accel = highest(all.into_iter().filter_map(|[_, accel]| accel));
    }
    for section in &sections {
        axis.drive.extend(config.travel_of_a_turn(log, section));
    }
}

/// Speed and acceleration of an extruder. Its own limits hold for moves of the extruder alone;
/// next to the axes it follows them, as fast as the largest cross section permits: the higher
/// counts. `None` where what they depend on is not there.
fn limits(
    config: &Config<'_, '_>,
    log: &mut Log,
    section: &str,
    of_axes: [Option<&Figure>; 2],
) -> Option<[Option<Figure>; 2]> {
    let nozzle = config.positive(log, section, "nozzle_diameter");
    let filament = config.positive(log, section, "filament_diameter");
    let cross = config.positive(log, section, "max_extrude_cross_section");
    let (nozzle, filament) = (nozzle?, filament?);
    let area = PI / 4.0 * filament.value * filament.value;
    let usual = 4.0 * nozzle.value * nozzle.value / area;
    let ratio = cross.as_ref().map_or(usual, |it| it.value / area);
    let with_axes = |all: Option<&Figure>, ratio: f64, why: &str| {
        all.map(|all| {
            Figure::new(
                all.value * ratio,
                format!("{why}: {} x {}", all.source, shown(round(ratio))),
            )
        })
    };
    let mut limit = |key: &str, all: Option<&Figure>| {
        let own = config.positive(log, section, key);
        let own = own.or_else(|| with_axes(all, usual, "by default"));
        let next = with_axes(all, ratio, "next to the axes");
        highest([own, next].into_iter().flatten())
    };
    let [velocity, accel] = of_axes;
    Some([
        limit("max_extrude_only_velocity", velocity),
        limit("max_extrude_only_accel", accel),
    ])
}

/// The highest step of speed at corners, where one of the extruders has its own.
pub(super) fn corner_step(config: &Config<'_, '_>, log: &mut Log) -> Option<Figure> {
    let key = "instantaneous_corner_velocity";
    let sections = sections(config);
    let given: Vec<Figure> = sections
        .iter()
        .filter_map(|section| config.number(log, section, key))
        .collect();
    let usual = Figure::new(1.0, format!("{key} is 1 by default"));
    let is_usual = given.len() < sections.len() && !given.is_empty();
    highest(given.into_iter().chain(is_usual.then_some(usual)))
}

/// Four digits of a ratio.
fn round(value: f64) -> f64 {
    (value * 1e4).round() / 1e4
}
