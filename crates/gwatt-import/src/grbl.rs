//! grbl 1.1 and grblHAL: what `$$` prints.
//!
//! Sources: grbl wiki, "Grbl v1.1 Configuration"; grblHAL wiki, "Report extensions". All
//! values of `$$` are in mm, whatever `$13` says.

use std::collections::BTreeMap;

use gwatt_machine::{ALL_AXES, AxisId};

use crate::found::{Build, Figure, Found, entry, shown};
use crate::near::Job;
use crate::text::{Log, Place};

/// A setting: its text, and where that stands.
struct Setting<'t> {
    text: &'t str,
    whole: &'t str,
    place: Place<'t>,
}

/// The setting in a line: `$120=500.000`, with anything before and after it; none in a comment.
pub(crate) fn setting(line: &str) -> Option<(u16, &str, &str)> {
    let start = line.find('$')?;
    let before = line.get(..start)?;
    let is_open = before.matches('(').count() > before.matches(')').count();
    if before.contains(';') || is_open {
        return None;
    }
    let rest = line.get(start + 1..)?;
    let digits = rest.bytes().take_while(u8::is_ascii_digit).count();
    let number = rest.get(..digits)?.parse().ok()?;
    let after = rest
        .get(digits..)?
        .trim_start()
        .strip_prefix('=')?
        .trim_start();
    let end = after
        .find(|c: char| c.is_whitespace() || matches!(c, '(' | ';' | ',' | '|' | '"' | '\''))
        .unwrap_or(after.len());
    let value = after.get(..end)?;
    let stop = value.as_ptr() as usize - line.as_ptr() as usize + value.len();
    Some((number, value, line.get(start..stop)?))
}

/// Reads the settings.
pub(crate) fn read(job: &Job, log: &mut Log) -> Found {
    let mut found = Found::new("grbl", "Machine under grbl", Build::Screws);
    let settings = settings(job, log);
    // X Y Z A B C U V, in the order of their numbers.
    for (index, id) in (0u16..8).zip(ALL_AXES) {
        axis(&mut found, log, &settings, index, id);
    }
    corners(&mut found, log, &settings);
    laser_mode(&mut found, &settings);
    if let Some(setting) = settings.get(&30)
        && let Some(rpm) = log.number(&setting.place, setting.text)
        && rpm > 0.0
    {
        found.spindle_rpm = Some(Figure::new(rpm, setting.place.source(setting.whole)));
    }
    found
}

/// All settings; of those that stand more than once the last, as the control has it.
fn settings<'t>(job: &'t Job, log: &mut Log) -> BTreeMap<u16, Setting<'t>> {
    let mut settings: BTreeMap<u16, Setting<'t>> = BTreeMap::new();
    let mut is_reported = false;
    for (_, place) in job.places() {
        let Some((number, value, whole)) = setting(place.line()) else {
            continue;
        };
        let found = Setting {
            text: value,
            whole,
            place: place.of(value),
        };
        let here = found.place.clone();
        let earlier = settings.insert(number, found);
        let Some(earlier) = earlier.filter(|it| is_of_motion(number) && it.text != value) else {
            continue;
        };
        if !is_reported {
            is_reported = true;
            let other = earlier.place.source(earlier.whole);
            log.warning(
                &here,
                format!("{other} says otherwise: of each setting the last one counts"),
                "give the settings of one machine, as `$$` prints them",
            );
        }
    }
    settings
}

/// Whether a setting says how axes move.
fn is_of_motion(number: u16) -> bool {
    matches!(number, 11 | 12 | 398 | 110..=117 | 120..=127)
}

fn axis(
    found: &mut Found,
    log: &mut Log,
    settings: &BTreeMap<u16, Setting<'_>>,
    index: u16,
    id: AxisId,
) {
    let mut figure = |base: u16, what: &str| {
        let setting = settings.get(&(base + index))?;
        let value = log.positive(&setting.place, setting.text, what)?;
        Some(Figure::new(value, setting.place.source(setting.whole)))
    };
    let letter = id.letter() as char;
    let rapid = figure(110, &format!("a rate of axis {letter}"));
    let accel = figure(120, &format!("an acceleration of axis {letter}"));
    if !settings.contains_key(&(110 + index)) && !settings.contains_key(&(120 + index)) {
        return;
    }
    let text = |number: u16| settings.get(&(number + index));
    let axis = found.axis(id);
    (axis.rapid, axis.accel) = (rapid, accel);
    if let Some(travel) = text(130) {
        let note = travel.place.source(travel.whole);
        axis.comments.push(format!("Travel: {note}"));
    }
    if let Some(steps) = text(100) {
        let note = steps.place.source(steps.whole);
        axis.drive.push(format!(
            "Steps per unit of travel: {note}; travel of a revolution is the motor's steps by it."
        ));
    }
    homing(found, log, settings, index, id);
}

/// Homing is slower than rapids, but G28 is a rapid: its speed is shown, and not taken.
fn homing(
    found: &mut Found,
    log: &mut Log,
    settings: &BTreeMap<u16, Setting<'_>>,
    index: u16,
    id: AxisId,
) {
    let on = settings.get(&22).and_then(|it| it.text.parse::<u32>().ok());
    if on.is_none_or(|on| on & 1 == 0) {
        return;
    }
    let rotary = matches!(id, AxisId::A | AxisId::B | AxisId::C);
    let unit = if rotary { "deg" } else { "mm" };
    if let Some(seek) = settings.get(&25)
        && let Some(speed) = log.positive(&seek.place, seek.text, "a homing speed")
    {
        let why = format!(
            "of $H: {}; G28 is a rapid, and would count as that slow too",
            seek.place.source(seek.whole)
        );
        let field = format!("reference_{unit}_min = {}", shown(speed));
        found.axis(id).maybe.push(entry(field, why));
    }
    let number = |number: u16| settings.get(&number)?.text.parse::<f64>().ok();
    let mask = settings.get(&23).and_then(|it| it.text.parse::<u32>().ok());
    let (Some(pull_off), Some(travel), Some(mask)) = (number(27), number(130 + index), mask) else {
        return;
    };
    // grbl's limits.c, limits_go_home: towards minus where the bit is set.
    let place = if mask >> index & 1 == 1 {
        pull_off - travel
    } else {
        -pull_off
    };
    let field = format!("reference_{unit} = {}", shown(place));
    let why = "from $23, $27 and $13x; 0 if built with HOMING_FORCE_SET_ORIGIN";
    found.axis(id).maybe.push(entry(field, why));
}

/// `$32`.
fn laser_mode(found: &mut Found, settings: &BTreeMap<u16, Setting<'_>>) {
    let Some(setting) = settings.get(&32) else {
        return;
    };
    let on = match setting.text.parse::<f64>() {
        Ok(0.0) => false,
        Ok(1.0) => true,
        // grblHAL's 2 is lathe mode.
        _ => return,
    };
    found.path(
        format!("laser_mode = {on}"),
        setting.place.source(setting.whole),
    );
}

/// `$11`, `$12`.
fn corners(found: &mut Found, log: &mut Log, settings: &BTreeMap<u16, Setting<'_>>) {
    // grblHAL's planner buffer: one block runs, and the next is given its speed before
    // another one comes.
    if let Some(setting) = settings.get(&398)
        && let Some(value) = log.positive(&setting.place, setting.text, "a number of blocks")
    {
        let field = format!("blocks = {}", shown((value - 2.0).max(1.0).floor()));
        found.look_ahead(field, setting.place.source(setting.whole));
    }
    if let Some(setting) = settings.get(&12)
        && let Some(value) = log.positive(&setting.place, setting.text, "an arc tolerance")
    {
        let field = format!("chords = {{ deviation_mm = {} }}", shown(value));
        found.look_ahead(field, setting.place.source(setting.whole));
    }
    if let Some(setting) = settings.get(&11)
        && let Some(value) = log.positive(&setting.place, setting.text, "a junction deviation")
    {
        let field = format!("deviation_mm = {}", shown(value));
        let source = setting.place.source(setting.whole);
        found.corner = Some(("junction_deviation", vec![entry(field, source)]));
    }
}
