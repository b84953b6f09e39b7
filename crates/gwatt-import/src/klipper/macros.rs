//! Commands that stand in the configuration: macros, and what runs at the start.

use crate::found::{Figure, Found, highest};
use crate::ini::Item;
use crate::near::Job;
use crate::text::{Log, Place};

/// Limits that are set before any program runs.
#[derive(Default)]
pub(super) struct AtStart {
    /// mm/s.
    pub(super) velocity: Option<Figure>,
    /// mm/s².
    pub(super) accel: Option<Figure>,
}

/// What `SET_VELOCITY_LIMIT` and M204 set in `[delayed_gcode]`, which runs by itself.
pub(super) fn at_start(job: &Job, log: &mut Log) -> AtStart {
    let mut found = AtStart::default();
    let mut runs = false;
    for (_, place) in job.places() {
        let line = place.line();
        if let Some(name) = line.strip_prefix('[') {
            runs = name.to_ascii_lowercase().starts_with("delayed_gcode ");
        }
        let code = line.split(['#', ';']).next().unwrap_or(line);
        let command = code.trim_start().to_ascii_uppercase();
        let sets = command.starts_with("SET_VELOCITY_LIMIT") || command.starts_with("M204");
        if runs && sets {
            limits(&mut found, log, &place, code);
        }
    }
    found
}

fn limits(found: &mut AtStart, log: &mut Log, place: &Place<'_>, code: &str) {
    for word in code.split_whitespace().skip(1) {
        let upper = word.to_ascii_uppercase();
        let (slot, length) = if upper.starts_with("VELOCITY=") {
            (&mut found.velocity, "VELOCITY=".len())
        } else if upper.starts_with("ACCEL=") {
            (&mut found.accel, "ACCEL=".len())
        } else if upper.starts_with(['S', 'P', 'T']) && !upper.contains('=') {
            (&mut found.accel, 1)
        } else {
            continue;
        };
        let value = word.get(length..).unwrap_or("");
        match value.parse::<f64>() {
            Ok(number) if number > 0.0 && number.is_finite() => {
                let source = place.source(&format!("at the start: {word}"));
                let set = Figure::new(number, source);
                *slot = highest(slot.take().into_iter().chain([set]));
            }
            _ => log.warning(
                &place.of(word),
                format!("`{word}` runs by itself and sets a limit that is not taken over"),
                "compare it with max_velocity and max_accel, and put the highest into the machine file",
            ),
        }
    }
}

/// Programs call macros, whose commands stand in the configuration.
pub(super) fn named(items: &[Item<'_>], found: &mut Found) {
    let list = |kind: &str| {
        let mut names: Vec<String> = Vec::new();
        for item in items {
            if let Some(name) = item.section.strip_prefix(kind) {
                let name = name.trim().to_ascii_uppercase();
                if !names.contains(&name) {
                    names.push(name);
                }
            }
        }
        names.join(", ")
    };
    let macros = list("gcode_macro ");
    if !macros.is_empty() {
        found.remarks.push(format!(
            "Macros ({macros}): what a program calls of them is written into a file of its name, or \
             listed under `ignored_macros` or `unknown_moves` in [language]"
        ));
    }
    let delayed = list("delayed_gcode ");
    if !delayed.is_empty() {
        found.remarks.push(format!(
            "Commands that run by themselves ([delayed_gcode] {delayed}): limits of speed and \
             acceleration in them count, macros and moves in them do not"
        ));
    }
}
