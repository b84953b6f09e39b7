//! FluidNC: `config.yaml`.
//!
//! Source: FluidNC wiki, "Config File Overview", "Axes", "Homing". Only the plain form of
//! YAML that FluidNC itself reads: names and values, nested by indentation.

use std::collections::BTreeMap;

use gwatt_machine::AxisId;

use crate::found::{Build, Figure, Found, entry, shown};
use crate::kinematics;
use crate::near::Job;
use crate::text::{Log, Place};

/// A value with its place.
struct Value<'t> {
    text: &'t str,
    whole: &'t str,
    place: Place<'t>,
}

/// Values by their path: `axes/x/max_rate_mm_per_min`.
fn values(job: &Job) -> BTreeMap<String, Value<'_>> {
    let mut found = BTreeMap::new();
    let mut above: Vec<(usize, String)> = Vec::new();
    for (_, place) in job.places() {
        let line = place.line();
        let trimmed = line.trim();
        let Some((key, rest)) = trimmed
            .split_once(':')
            .filter(|_| !trimmed.starts_with('#'))
        else {
            continue;
        };
        let depth = line.len() - line.trim_start().len();
        while above.last().is_some_and(|(other, _)| *other >= depth) {
            above.pop();
        }
        let text = rest.split(" #").next().unwrap_or(rest).trim();
        above.push((depth, key.trim().to_ascii_lowercase()));
        let names: Vec<&str> = above.iter().map(|(_, name)| name.as_str()).collect();
        let end = text.as_ptr() as usize + text.len() - trimmed.as_ptr() as usize;
        let whole = trimmed.get(..end).unwrap_or(trimmed);
        let place = place.of(if text.is_empty() { trimmed } else { text });
        found.insert(names.join("/"), Value { text, whole, place });
    }
    found
}

/// Reads the configuration.
pub(crate) fn read(job: &Job, log: &mut Log) -> Found {
    let values = values(job);
    let mut found = Found::new("grbl", "Machine under FluidNC", Build::Screws);
    for (path, value) in &values {
        let Some(name) = path
            .strip_prefix("kinematics/")
            .filter(|it| !it.contains('/'))
        else {
            continue;
        };
        match name {
            "cartesian" => {}
            "corexy" => {
                kinematics::core(&mut found, log, &value.place, value.whole, Some("corexy"));
            }
            other => kinematics::refuse(log, &value.place, other),
        }
    }
    for letter in "xyzabc".chars() {
        axis(&mut found, log, &values, letter);
    }
    let mut figure = |path: &str| {
        let value = values.get(path)?;
        let number = log.positive(&value.place, value.text, path)?;
        Some(Figure::new(number, value.place.source(value.whole)))
    };
    if let Some(blocks) = figure("planner_blocks") {
        // One stays free, one runs, and the next is given its speed before another one comes.
        let seen = (blocks.value - 3.0).max(1.0);
        found.look_ahead(format!("blocks = {}", shown(seen)), blocks.source);
    }
    if let Some(tolerance) = figure("arc_tolerance_mm") {
        let field = format!("chords = {{ deviation_mm = {} }}", shown(tolerance.value));
        found.look_ahead(field, tolerance.source);
    }
    if let Some(deviation) = figure("junction_deviation_mm") {
        let field = format!("deviation_mm = {}", shown(deviation.value));
        found.corner = Some(("junction_deviation", vec![entry(field, deviation.source)]));
    }
    found
}

fn axis(found: &mut Found, log: &mut Log, values: &BTreeMap<String, Value<'_>>, letter: char) {
    let start = format!("axes/{letter}");
    let Some(id) = AxisId::from_letter(letter.to_ascii_uppercase() as u8) else {
        return;
    };
    if !values.contains_key(&start) {
        return;
    }
    let mut number = |name: &str| {
        let value = values.get(&format!("{start}/{name}"))?;
        let number = log.number(&value.place, value.text)?;
        Some(Figure::new(number, value.place.source(value.whole)))
    };
    let rapid = number("max_rate_mm_per_min");
    let accel = number("acceleration_mm_per_sec2");
    let travel = number("max_travel_mm");
    let steps = number("steps_per_mm");
    let home = number("homing/mpos_mm");
    let cycle = number("homing/cycle");
    let [seek, feed] = ["homing/seek_mm_per_min", "homing/feed_mm_per_min"].map(&mut number);
    for (what, figure) in [("rate", &rapid), ("acceleration", &accel)] {
        if let Some(bad) = figure.as_ref().filter(|it| it.value <= 0.0) {
            log.whole(
                values.get(&start).map_or("", |it| it.place.file()),
                format!("axis {letter} has no {what}: {}", bad.source),
                "a value above 0 is needed: look at the configuration",
            );
        }
    }
    let axis = found.axis(id);
    (axis.rapid, axis.accel) = (rapid, accel);
    if let Some(travel) = travel {
        axis.comments.push(format!("Travel: {}", travel.source));
    }
    if let Some(steps) = steps {
        axis.drive
            .push(format!("Steps per unit of travel: {}", steps.source));
    }
    if cycle.is_some_and(|cycle| cycle.value > 0.0) {
        axis.reference = home;
        let unit = if axis.rotary { "deg" } else { "mm" };
        let speeds = [seek, feed].into_iter().flatten();
        if let Some(speed) = crate::found::highest(speeds) {
            let field = format!("reference_{unit}_min = {}", shown(speed.value));
            let why = format!(
                "of $H: {}; G28 is a rapid, and would count as that slow too",
                speed.source
            );
            axis.maybe.push(entry(field, why));
        }
    }
    let motors = (0..2).filter(|motor| values.contains_key(&format!("{start}/motor{motor}")));
    axis.motors = motors.count();
}
