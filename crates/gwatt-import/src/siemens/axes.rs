//! Axes and spindles of the machine data.

use std::fmt::Write as _;

use gwatt_machine::{ALL_AXES, AxisId};

use super::data::{Data, Datum};
use crate::found::{Figure, Found, entry, highest, shown};
use crate::text::Log;

/// Degrees of a revolution, millimetres of a metre.
const TURN: f64 = 360.0;
const METRE: f64 = 1000.0;
/// Machine axes that a control may have.
const MOST: usize = 31;

/// Words that select the entries of `MAX_AX_ACCEL`.
const WORDS: [&str; 5] = ["DYNNORM", "DYNPOS", "DYNROUGH", "DYNSEMIFIN", "DYNFINISH"];

/// A machine axis.
struct Axis<'d, 't> {
    data: &'d Data<'t>,
    number: usize,
    name: &'d str,
    rotary: bool,
}

/// Reads the axes that have a speed.
pub(super) fn take(data: &Data<'_>, found: &mut Found, log: &mut Log) {
    let mut levels: Vec<(AxisId, Vec<f64>)> = Vec::new();
    let mut left: Vec<String> = Vec::new();
    for number in 1..=MOST {
        let name = data
            .entry("AXCONF_MACHAX_NAME_TAB", number - 1)
            .unwrap_or("");
        let mut axis = Axis {
            data,
            number,
            name,
            rotary: false,
        };
        let is_known =
            axis.value("MAX_AX_VELO").is_some() || axis.value("POS_LIMIT_PLUS").is_some();
        if !is_known && axis.value("MAX_AX_ACCEL").is_none() {
            continue;
        }
        let is_spindle = axis
            .value("SPIND_ASSIGN_TO_MACHAX")
            .is_some_and(|it| it.text != "0");
        axis.rotary = axis
            .value("IS_ROT_AX")
            .is_some_and(|it| it.text == "1" || it.text.eq_ignore_ascii_case("true"));
        if is_spindle {
            spindle(&axis, found, log);
            continue;
        }
        let Some(id) = letter(data, number, name) else {
            left.push(if name.is_empty() {
                format!("AX{number}")
            } else {
                name.to_owned()
            });
            continue;
        };
        if found.axes[id as usize].is_some() {
            left.push(format!("AX{number} {name}"));
            continue;
        }
        levels.extend(one(&axis, found, log, id).map(|list| (id, list)));
    }
    if !left.is_empty() {
        let list = left.join(", ");
        found.remarks.push(format!(
            "Axes {list}: gwatt has no letter for them, or another axis of it"
        ));
        log.hint(
            data.file(),
            format!("axes without a letter of their own are left out: {list}"),
            "what moves with other axes (gantries) belongs to the masses of those",
        );
    }
    table(found, &levels);
}

/// The letter that programs have for a machine axis.
fn letter(data: &Data<'_>, number: usize, name: &str) -> Option<AxisId> {
    let single = |name: &str| match name.as_bytes() {
        [letter] => AxisId::from_letter(letter.to_ascii_uppercase()).filter(|id| *id != AxisId::E),
        _ => None,
    };
    if data.has("AXCONF_MACHAX_USED") {
        let channel = (0..MOST).find(|c| {
            data.entry("AXCONF_MACHAX_USED", *c)
                .and_then(|it| it.parse().ok())
                == Some(number)
        })?;
        let geometry = (0..3).find(|g| {
            data.entry("AXCONF_GEOAX_ASSIGN_TAB", *g)
                .and_then(|it| it.parse().ok())
                == Some(channel + 1)
        });
        let named = geometry
            .and_then(|g| data.entry("AXCONF_GEOAX_NAME_TAB", g))
            .or_else(|| data.entry("AXCONF_CHANAX_NAME_TAB", channel));
        if let Some(named) = named {
            return single(named);
        }
    }
    if name.is_empty() {
        return (number <= 3)
            .then(|| ALL_AXES.get(number - 1).copied())
            .flatten();
    }
    // X1 is X where the file has no other name.
    single(name.trim_end_matches(|c: char| c.is_ascii_digit()))
}

impl<'t> Axis<'_, 't> {
    fn is_of(&self, datum: &Datum<'_>) -> bool {
        let axis = datum.axis();
        let by_number = axis.strip_prefix("AX").and_then(|it| it.parse().ok()) == Some(self.number);
        by_number || (!self.name.is_empty() && axis == self.name)
    }

    fn value<'a>(&'a self, name: &'a str) -> Option<&'a Datum<'t>> {
        // By its number or its name: the last counts.
        self.data.of(name).filter(|datum| self.is_of(datum)).last()
    }

    /// All entries, by their number.
    fn figures(&self, name: &str, log: &mut Log, factor: f64) -> Vec<(usize, Figure)> {
        let mut list: Vec<(usize, Figure)> = Vec::new();
        for datum in self.data.of(name).filter(|datum| self.is_of(datum)) {
            if let Some(value) = log.number(&datum.place, datum.text) {
                let figure = Figure::new(value * factor, datum.source());
                let number = datum.number().unwrap_or(0);
                list.retain(|(other, _)| *other != number);
                list.push((number, figure));
            }
        }
        list
    }

    fn figure(&self, name: &str, log: &mut Log, factor: f64) -> Option<Figure> {
        let list = self.figures(name, log, factor);
        list.into_iter().next().map(|(_, figure)| figure)
    }

    fn positive(&self, name: &str, log: &mut Log, factor: f64) -> Option<Figure> {
        let datum = self.value(name)?;
        let value = log.positive(&datum.place, datum.text, name)?;
        Some(Figure::new(value * factor, datum.source()))
    }
}

/// Fixed points of an axis (MD30600).
const FIXED_POINTS: usize = 4;

fn spindle(axis: &Axis<'_, '_>, found: &mut Found, log: &mut Log) {
    let limit = axis.figure("SPIND_VELO_LIMIT", log, 1.0);
    let limit = limit.or_else(|| axis.figure("MAX_AX_VELO", log, 1.0));
    found.spindle_rpm =
        highest(found.spindle_rpm.take().into_iter().chain(limit)).filter(|it| it.value > 0.0);
}

/// Reads an axis; gives its accelerations by level where they differ.
fn one(axis: &Axis<'_, '_>, found: &mut Found, log: &mut Log, id: AxisId) -> Option<Vec<f64>> {
    let [length, unit] = if axis.rotary {
        [TURN, TURN]
    } else {
        [1.0, METRE]
    };
    let rapid = axis.positive("MAX_AX_VELO", log, length);
    let accels = axis.figures("MAX_AX_ACCEL", log, unit);
    let factors = [
        axis.figures("G00_ACCEL_FACTOR", log, 1.0),
        axis.figures("G0_ACCEL_FACTOR", log, 1.0),
        axis.figures("SOFT_ACCEL_FACTOR", log, 1.0),
    ];
    let raised =
        highest(factors.into_iter().flatten().map(|(_, it)| it)).filter(|it| it.value > 1.0);
    let mut accel = highest(accels.iter().map(|(_, it)| it.clone())).filter(|it| it.value > 0.0);
    if let (Some(accel), Some(raised)) = (&mut accel, &raised) {
        accel.value *= raised.value;
        accel.source = format!("{}, times {}", accel.source, raised.source);
    }
    let speeds = [
        "REFP_VELO_SEARCH_CAM",
        "REFP_VELO_SEARCH_MARKER",
        "REFP_VELO_POS",
    ];
    let speeds = speeds.map(|name| axis.figure(name, log, length));
    let reference_speed = highest(speeds.into_iter().flatten()).filter(|it| it.value > 0.0);
    let reference = axis.figure("REFP_SET_POS", log, 1.0);
    // Those that follow each other from the first on.
    let fixed = axis.figures("FIX_POINT_POS", log, 1.0);
    let fixed = (0..FIXED_POINTS)
        .map_while(|number| fixed.iter().find(|(at, _)| *at == number))
        .map(|(_, figure)| figure.clone());
    let further_references: Vec<Figure> = fixed.collect();
    let jerk = axis.figures("MAX_AX_JERK", log, unit);
    let [min, max] = ["POS_LIMIT_MINUS", "POS_LIMIT_PLUS"].map(|name| axis.figure(name, log, 1.0));
    let drive = [
        "LEADSCREW_PITCH",
        "DRIVE_AX_RATIO_NUMERA",
        "DRIVE_AX_RATIO_DENOM",
        "POSCTRL_GAIN",
    ];
    let drive: Vec<String> = drive
        .iter()
        .filter_map(|name| axis.value(name).map(Datum::source))
        .collect();
    let to = found.axis(id);
    to.rotary = axis.rotary;
    (to.rapid, to.accel) = (rapid, accel);
    (to.reference_speed, to.reference) = (reference_speed, reference);
    to.further_references = further_references;
    if let (Some(min), Some(max)) = (min, max) {
        to.travel(&min, &max, "");
    }
    if let Some(jerk) = highest(jerk.into_iter().map(|(_, it)| it)) {
        let field = if axis.rotary {
            "jerk_deg_s3"
        } else {
            "jerk_mm_s3"
        };
        let why = format!(
            "if every program runs under SOFT: {}; BRISK has no limit",
            jerk.source
        );
        to.maybe
            .push(entry(format!("{field} = {}", shown(jerk.value)), why));
    }
    if !drive.is_empty() {
        to.drive.push(format!("Of its drive: {}", drive.join(", ")));
    }
    by_level(&accels, raised.is_some())
}

/// The accelerations of the five words, where they differ and nothing raises them.
fn by_level(accels: &[(usize, Figure)], raised: bool) -> Option<Vec<f64>> {
    let of = |level: usize| {
        accels
            .iter()
            .find(|(number, _)| *number == level)
            .map(|(_, it)| it.value)
    };
    let list: Option<Vec<f64>> = (0..WORDS.len()).map(of).collect();
    let list = list.filter(|list| !raised && list.iter().all(|value| *value > 0.0))?;
    let first = list.first().copied()?;
    list.iter().any(|value| *value != first).then_some(list)
}

/// `[[levels]]` of axes whose accelerations differ.
fn table(found: &mut Found, levels: &[(AxisId, Vec<f64>)]) {
    if levels.is_empty() {
        return;
    }
    let mut text = String::from(
        "# What each word of technology makes of the axes: MAX_AX_ACCEL by its index.\n[[levels]]\nacts_on = \"all\"\nlevel = [\n",
    );
    for (at, word) in WORDS.iter().enumerate() {
        let value = |(id, list): &(AxisId, Vec<f64>)| {
            let value = list.get(at).copied().unwrap_or(0.0);
            format!("{} = {}", id.letter() as char, shown(value))
        };
        let values: Vec<String> = levels.iter().map(value).collect();
        let on = if at == 0 { ", power_on = true" } else { "" };
        let _ = writeln!(
            text,
            "    {{ word = \"{word}\"{on}, accel_mm_s2 = {{ {} }} }},",
            values.join(", ")
        );
    }
    text.push_str("]\n");
    found.tables.push(text);
}
