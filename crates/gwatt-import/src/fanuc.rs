//! Fanuc: parameters as the control punches them, `N01420A1P36000A2P36000`.
//!
//! Sources: Fanuc parameter manuals B-64310EN (30i, 31i, 32i), B-64490EN (0i-D) and B-63530EN
//! (16i, 18i); format: B-63330EN, "Inputting and outputting parameters". Speeds are in mm/min,
//! in 0.1 inch/min on an inch machine where they are whole numbers, of rotary axes in
//! degrees/min; times are in ms, positions in least increments where they are whole numbers.

mod axes;
mod parameters;

use gwatt_machine::AxisId;

use crate::found::{Build, Figure, Found, highest, shown};
use crate::near::Job;
use crate::text::Log;
use parameters::Parameters;

/// Parameters that change how fast the machine moves, and that gwatt has no field for.
const LEFT_OUT: [(u32, &str); 18] = [
    (1432, "largest feeds under AI contour control"),
    (1621, "bell shape of rapids"),
    (1624, "time of jogging"),
    (1710, "override at inner corners"),
    (1730, "feed on arcs"),
    (1731, "feed on arcs"),
    (1732, "feed on arcs"),
    (1735, "acceleration on arcs"),
    (1737, "acceleration on arcs"),
    (1763, "time after interpolation"),
    (1768, "time after interpolation"),
    (1769, "time after interpolation"),
    (1772, "bell shape before interpolation"),
    (1783, "steps of speed at corners"),
    (1785, "feed by acceleration"),
    (1788, "change of acceleration"),
    (1789, "change of acceleration"),
    (1790, "change of acceleration"),
];

/// Reads the parameters.
pub(crate) fn read(job: &Job, log: &mut Log) -> Found {
    let parameters = Parameters::new(job, log);
    let mut found = Found::new("fanuc", "Machine under Fanuc", Build::Screws);
    axes::take(&parameters, &mut found, log);
    profile(&parameters, &mut found);
    path(&parameters, &mut found, log);
    if let Some(decimal) = parameters.bit(3401, 0) {
        let name = if decimal.on {
            "calculator"
        } else {
            "least-increment"
        };
        let why = format!("bit DPI of {}", decimal.source);
        found.language(format!("decimal_point = \"{name}\""), why);
    }
    if let Some(motion) = parameters.bit(3402, 0) {
        let name = if motion.on { "feed" } else { "rapid" };
        let why = format!("bit G01 of {}", motion.source);
        found.language(format!("power_on_motion = \"{name}\""), why);
    }
    if let Some(arc) = parameters.bit(3403, 5) {
        let name = if arc.on { "refused" } else { "line" };
        let why = format!("bit CIR of {}", arc.source);
        found.language(format!("arc_without_center = \"{name}\""), why);
    }
    if let Some(inch) = parameters.bit(0, 2).filter(|bit| bit.on) {
        found.language("units = \"inch\"", format!("bit INI of {}", inch.source));
    }
    let top = parameters
        .figures(3772, log)
        .into_iter()
        .filter(|it| it.value > 0.0);
    let gears = (3741..=3744).flat_map(|number| parameters.figures(number, log));
    found.spindle_rpm = highest(top)
        .or_else(|| highest(gears))
        .filter(|it| it.value > 0.0);
    left_out(&parameters, &mut found, log);
    found
}

/// A lathe has no Y, and X in diameters.
fn profile(parameters: &Parameters<'_>, found: &mut Found) {
    let has = |id: AxisId| found.axes[id as usize].is_some();
    let lathe = has(AxisId::X) && has(AxisId::Z) && !has(AxisId::Y);
    if !lathe {
        return;
    }
    let system = |bit| parameters.bit(3401, bit).is_some_and(|bit| bit.on);
    found.controller = if system(6) {
        "fanuc-lathe-b"
    } else {
        "fanuc-lathe"
    };
    "Lathe under Fanuc".clone_into(&mut found.name);
    found.remarks.push(
        "Without a Y axis this is taken for a lathe; --controller fanuc says that it is none"
            .to_owned(),
    );
    if system(7) {
        found
            .remarks
            .push("Parameter 3401 asks for G-code system C, which gwatt does not read".to_owned());
    }
}

fn path(parameters: &Parameters<'_>, found: &mut Found, log: &mut Log) {
    let straight = parameters.bits(1401, 1);
    if let Some(bit) = straight.iter().find(|bit| !bit.on).or(straight.first()) {
        let name = if bit.on { "linear" } else { "independent" };
        found.path(
            format!("rapid = \"{name}\""),
            format!("bit LRP of {}", bit.source),
        );
    }
    let of_axes: Vec<Figure> = parameters.speeds(1430, log);
    let limits = of_axes.iter().filter(|it| it.value > 0.0);
    // Each axis for itself: the path may be as fast as all together.
    let square: f64 = limits.clone().map(|it| it.value * it.value).sum();
    let top = limits.count();
    let all = highest(parameters.speeds(1422, log)).filter(|it| it.value > 0.0);
    let feed = if top > 0 && top == of_axes.len() {
        let source = of_axes
            .first()
            .map_or(String::new(), |it| it.source.clone());
        Some(Figure::new(
            square.sqrt(),
            format!("all axes of {source} together"),
        ))
    } else if of_axes.iter().all(|it| it.value == 0.0) {
        all
    } else {
        None
    };
    if let Some(feed) = feed {
        found.path(
            format!("max_feed_mm_min = {}", shown(feed.value)),
            feed.source,
        );
    }
}

fn left_out(parameters: &Parameters<'_>, found: &mut Found, log: &mut Log) {
    let mut named: Vec<String> = Vec::new();
    for (number, what) in LEFT_OUT {
        let given = parameters
            .of(number)
            .find(|it| it.text.parse().is_ok_and(|value: f64| value != 0.0));
        if let Some(given) = given {
            named.push(format!("{number} ({what})"));
            log.warning(
                &given.place,
                format!("parameter {number}, {what}, is not taken over"),
                "the robust bound holds for whatever it makes of speeds below the limits of the axes",
            );
        }
    }
    if !named.is_empty() {
        let list = named.join(", ");
        found.remarks.push(format!(
            "Parameters {list}: moves count as without them, which is never slower"
        ));
    }
}

/// Whether a line is one of parameters: a number of at least four digits, and values.
pub(crate) fn parameter_line(line: &str) -> bool {
    let digits = line
        .get(1..)
        .unwrap_or("")
        .bytes()
        .take_while(u8::is_ascii_digit)
        .count();
    digits >= 4
        && parameters::number(line)
            .is_some_and(|(_, rest)| rest.contains('P') || rest.contains('M'))
}
