//! Judged moves as rows, with what was done about them.

use super::{Route, Row};
use crate::interpret::{Move, MoveKind};
use crate::limit::{Change, Split};
use crate::machine::{AxisSet, AxisValues, KnobArgument, KnobTarget, KnobUnit, Machine};
use crate::power::{Assessment, PowerModel};
use crate::rewrite::{SWITCH_ON, knob_lines};

/// The row of a judged move that begins at `start_s`.
pub(super) fn row(
    machine: &Machine,
    model: &PowerModel,
    mv: &Move,
    assessment: &Assessment,
    start_s: f64,
) -> Row {
    let demand = &assessment.demand;
    let limit_w = model.limit_w(demand.converter);
    Row {
        line: mv.line,
        run: mv.run,
        file: String::new(),
        n_word: mv.number,
        kind: mv.kind,
        axes: axes(mv),
        start_s,
        duration_s: assessment.duration_s,
        peak_w: demand.peak_w,
        regen_w: demand.regen_w,
        limit_w,
        ratio: (demand.peak_w > 0.0).then(|| limit_w / demand.peak_w),
        energy_j: demand.energy_j,
        action: "",
        knob: String::new(),
        words: String::new(),
        feed_allowed: false,
        value_before: None,
        value_after: None,
        peak_after_w: None,
        start_after_s: None,
        duration_after_s: None,
        regen_after_w: None,
        certificate: assessment.certificate,
        regen_limit_w: model.regen_limit_w(demand.converter),
        converter: machine
            .converters
            .get(demand.converter)
            .map_or_else(String::new, |it| it.name.clone()),
        route: Route::of(mv),
    }
}

/// What was done: action, word, and its value before and after; `feed_before`
/// is the F in force in program units.
pub(super) fn describe(
    machine: &Machine,
    mv: &Move,
    change: Option<&Change>,
    feed_before: Option<f64>,
    row: &mut Row,
) {
    let Some(change) = change else { return };
    let knobs = &machine.controller.knobs;
    let level = change.accel.and_then(|(knob, _)| knobs.get(knob));
    let rapid_level = level.is_some_and(|knob| knob.target == KnobTarget::RapidSpeed);
    let jerk = level.is_some_and(|knob| knob.target == KnobTarget::Jerk);
    let speed = change.feed.is_some() || change.rapid_percent.is_some() || change.speed.is_some();
    row.action = match (speed, change.accel.is_some()) {
        (false, true) if rapid_level => "lower rapid speed",
        (true, true) if jerk => "lower speed and jerk",
        (false, true) if jerk => "lower jerk",
        (true, true) => "lower speed and acceleration",
        (true, false) if change.as_feed => "rapid as feed",
        (true, false) if change.rapid_percent.is_some() => "lower rapid speed",
        (true, false) if change.speed.is_some() => "lower speed",
        (true, false) => "lower feed",
        (false, true) => "lower acceleration",
        (false, false) if change.stop => "exact stop",
        (false, false) => "",
    };
    let mut names = Vec::new();
    if let Some(feed) = change.feed {
        names.push("F".to_owned());
        row.value_before = feed_before.filter(|_| !change.as_feed);
        row.value_after = Some(feed);
    }
    if let Some((knob, percent)) = change.rapid_percent {
        names.push(knob_name(machine, knob));
        let data = machine.controller.knobs.get(knob);
        let value = |percent: f64| data.map_or(percent, |data| data.of_percent(percent));
        row.value_before = Some(value(mv.rapid_factor * 100.0));
        row.value_after = Some(value(percent));
    }
    if let Some((knob, values)) = &change.speed {
        names.push(knob_name(machine, *knob));
        let axes = AxisSet(mv.moving.0 | mv.unknown_start.0);
        row.value_after = axes.iter().map(|axis| values[axis]).min_by(f64::total_cmp);
    }
    if let Some((knob, values)) = &change.accel {
        names.push(match level_word(machine, *knob, values) {
            Some(word) => word,
            None => knob_name(machine, written(machine, *knob, values)),
        });
        if row.value_after.is_none()
            && level_word(machine, *knob, values).is_none()
            && let Some(axis) = mv
                .moving
                .iter()
                .min_by(|a, b| values[*a].total_cmp(&values[*b]))
        {
            let own = machine.axes[axis].map_or(1.0, |data| data.accel_mm_s2);
            let found = machine.controller.knobs.get(*knob);
            let along = found.is_some_and(|knob| knob.argument == KnobArgument::Value);
            let before = if along {
                mv.path_accel_mm_s2
            } else {
                mv.accel_mm_s2[axis]
            };
            let scale = match found.map(|knob| knob.unit) {
                Some(KnobUnit::Percent) => 100.0 / own,
                Some(KnobUnit::Share) => 1.0 / own,
                _ => 1.0,
            };
            row.value_before = Some(if jerk {
                mv.jerk_factor * 100.0
            } else {
                before * scale
            });
            row.value_after = Some(values[axis]);
        }
    }
    if change.stop {
        names.extend(machine.controller.language.stop_word());
    }
    row.feed_allowed = change.feed.is_some() && mv.kind != MoveKind::Rapid;
    row.knob = names.join(" ");
    row.words = words(machine, change);
}

/// The words of a change as the control takes them, each with its value.
pub(super) fn words(machine: &Machine, change: &Change) -> String {
    let mut words = Vec::new();
    if let Some(feed) = change.feed {
        let motion = if change.as_feed { "G1 " } else { "" };
        words.push(format!("{motion}F{feed}"));
    }
    let knobs = change.knobs(machine);
    for (knob, values) in knobs.into_iter().flatten() {
        let data = machine.controller.knobs.get(knob);
        // It acts only where it is switched on.
        if data.is_some_and(|data| data.target == KnobTarget::SpeedShare) {
            words.push(SWITCH_ON.to_owned());
        }
        words.extend(knob_lines(machine, knob, &values).into_iter().flatten());
    }
    if change.stop {
        words.extend(machine.controller.language.stop_word());
    }
    words.join(" and ")
}

/// The same for a block in pieces; the value is that of the piece with the lowest.
pub(super) fn describe_split(machine: &Machine, mv: &Move, split: &Split, row: &mut Row) {
    let least = |values: &AxisValues| {
        let values = mv.moving.iter().map(|axis| values[axis]);
        values.fold(f64::INFINITY, f64::min)
    };
    let accels = split.pieces.iter().filter_map(|piece| piece.accel);
    let lowest = accels.min_by(|a, b| least(&a.1).total_cmp(&least(&b.1)));
    let change = Change {
        accel: lowest,
        ..Change::NONE
    };
    describe(machine, mv, Some(&change), None, row);
    row.action = "split";
}

/// The knob whose word says these values: where they differ, the one by axis.
fn written(machine: &Machine, knob: usize, values: &AxisValues) -> usize {
    let mut axes = machine.axis_set.iter().map(|axis| values[axis]);
    let first = axes.next();
    let uniform = axes.all(|value| Some(value) == first);
    let by_axis = || machine.controller.knob_by_axis(knob);
    if uniform { None } else { by_axis() }.unwrap_or(knob)
}

/// The word that selects a level, in one piece: `G187P3`.
fn level_word(machine: &Machine, knob: usize, values: &AxisValues) -> Option<String> {
    let levels = machine.controller.knobs.get(knob)?.levels.as_ref()?;
    let level = levels.list.get(values[0] as usize)?;
    Some(level.text().replace(' ', ""))
}

/// The word of a knob, such as `G131`.
pub(super) fn knob_name(machine: &Machine, index: usize) -> String {
    let knob = machine.controller.knobs.get(index);
    knob.map_or_else(String::new, |knob| {
        knob.name.trim_end_matches('=').to_owned()
    })
}

/// Axes that really move, or may.
pub(super) fn axes(mv: &Move) -> AxisSet {
    AxisSet(mv.moving.0 | mv.unknown_start.0)
}
