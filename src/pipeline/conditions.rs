//! What the figures of a run rest on.

use super::assumptions::assumptions;
use super::{Certificate, Options, Start, Summary};
use crate::diagnostic::Diagnostic;
use crate::interpret::BlockDelete;
use crate::machine::{CornerRule, Family, KnobTarget, Machine, PathMode, Spindle, SpindleWait};

/// How the spindle counts.
fn spindle_condition(spindle: &Spindle) -> &'static str {
    match spindle.wait {
        SpindleWait::Nothing => "the spindle runs while the axes move: nothing waits for its speed",
        SpindleWait::Feeds => {
            "the spindle runs while rapids move; moves that cut wait for its speed"
        }
        SpindleWait::Blocks => "whatever comes next waits for the spindle's speed",
        SpindleWait::Unknown => {
            "whether moves wait for the spindle is not known: they count with it, \
             their times without"
        }
    }
}

/// How limits of jerk count.
fn jerk_condition(machine: &Machine, summary: &Summary) -> Option<&'static str> {
    let mut axes = machine.axes.iter().flatten();
    let limited = axes.any(|axis| axis.jerk_mm_s3 > 0.0);
    limited.then_some(if summary.ahead {
        "limits of jerk: speed follows S-curves; joints that limit the speed are passed \
         without acceleration along the path, and what a corner itself does to an axis is not limited"
    } else {
        "limits of jerk: speed follows S-curves, from rest to rest"
    })
}

/// How curves of force count.
fn curve_condition(machine: &Machine) -> Option<&'static str> {
    (!machine.force_curves.is_empty()).then_some(
        "force curves: moves from rest to rest follow them; with look-ahead peaks are those of \
         ramps along the curves, and times those of the lowest acceleration up to the move's speed",
    )
}

/// Which overrides the figures hold for.
fn overrides_condition(machine: &Machine) -> String {
    let limits = &machine.limits;
    let percent = |factor: f64| factor * 100.0;
    let (what, [feed, rapid, spindle]) = match limits.override_at {
        Some(at) => ("these overrides alone", [at.feed, at.rapid, at.spindle]),
        None => (
            "any overrides that are not turned while axes move, at most",
            [
                limits.feed_override_max,
                limits.rapid_override_max,
                limits.spindle_override_max,
            ],
        ),
    };
    let [feed, rapid, spindle] = [feed, rapid, spindle].map(percent);
    format!("{what}: feed {feed} %, rapid {rapid} %, spindle {spindle} %")
}

/// What is said where a single setting lies above the machine's largest.
pub(super) fn above_largest(machine: &Machine) -> Option<Diagnostic> {
    let limits = &machine.limits;
    let at = limits.override_at?;
    let above = at.feed > limits.feed_override_max || at.spindle > limits.spindle_override_max;
    let percent = |factor: f64| (factor * 1000.0).round() / 10.0;
    let [feed, spindle] = [limits.feed_override_max, limits.spindle_override_max].map(percent);
    let message = format!(
        "the override lies above the machine's largest: feed {feed} %, spindle {spindle} %"
    );
    let help = "give the largest as override_max_percent under [limits] of the machine file";
    above.then(|| Diagnostic::note("override-above-largest", message).help(help))
}

/// For which overrides limits over time hold.
fn over_time_condition(machine: &Machine, summary: &Summary) -> String {
    let looked_at = summary.over_time.iter().any(|it| it.rating.looked_at);
    let mut said = if summary.over_time.iter().any(|it| it.rating.is_open()) {
        "limits over time at lower overrides are not all looked at, since the program does not fit \
         at the largest"
            .to_owned()
    } else if looked_at {
        "limits over time at lower overrides: where a bound over all of them leaves one open, ranges \
         of feed and rapid overrides have bounds of their own, small enough to keep it in each"
            .to_owned()
    } else {
        "limits over time hold at every lower override too (bounded for all at once)".to_owned()
    };
    let rules = machine.controller.planner.look_ahead;
    if rules.is_some_and(|rules| !matches!(rules.corner, CornerRule::LinuxCnc { .. })) {
        said.push_str("; what drives make of steps of speed counts as at the larger overrides");
    }
    if machine.spindle.is_some() {
        said.push_str("; the spindle's runs are placed as at the largest override");
    }
    said
}

/// How the blocks count that may be skipped, and how many ways through the program.
fn ways_conditions(paths: &[Options]) -> impl Iterator<Item = String> {
    let switches = |path: &Options| path.reading.block_delete;
    let first = paths.first().map_or(BlockDelete::NONE, switches);
    let skips = paths.iter().any(|path| switches(path) != first);
    let blocks = match first {
        _ if skips => {
            "blocks with / may be executed or skipped: what is said here holds with and without them"
        }
        BlockDelete::ALL => "blocks with / are skipped",
        BlockDelete::NONE => "blocks with / are executed",
        _ => "blocks with / are skipped where their switches are on",
    };
    let found = paths.iter().filter(|path| switches(path) == first).count();
    let probes = (found > 1).then(|| {
        format!("probes touch or do not, in {found} ways through the program: the worst counts")
    });
    [Some(blocks.to_owned()), probes].into_iter().flatten()
}

/// Where places come from that the program does not give.
fn place_conditions(machine: &Machine, options: &Options) -> impl Iterator<Item = String> {
    let reading = &options.reading;
    let axes = || machine.axes.iter().flatten();
    let sources = [
        (
            machine.offsets.iter().any(Option::is_some) || !machine.further_offsets.is_empty(),
            "work offsets are those under [offsets] of the machine file: with others this does not hold",
        ),
        (
            axes().any(|axis| axis.reference_mm.is_some()),
            "the reference point is reference_mm of the machine file",
        ),
        (
            reading.tools.is_some(),
            "lengths and radii of tools are those of the tool table",
        ),
        (
            reading.parameters.is_some() || !reading.given.is_empty(),
            "the control keeps the parameters that were given",
        ),
    ];
    let given = sources.into_iter().filter(|(given, _)| *given);
    given.map(|(_, said)| said.to_owned())
}

/// Which outputs act on the motion.
fn output_conditions(machine: &Machine) -> impl Iterator<Item = String> {
    let knobs = machine.controller.knobs.iter();
    knobs.filter_map(|knob| {
        let number = knob.output()?;
        let share = match knob.target {
            KnobTarget::SpeedShare => {
                format!("the speed of all moves (M67 E{number} under M52 P1)")
            }
            _ => format!("all accelerations (M68 E{number})"),
        };
        Some(format!(
            "analog output {number} sets the share of {share}, and is 1 or was never set before \
             the program"
        ))
    })
}

/// The ISG kernel keeps its weightings from one program to the next ("Weighting of the maximum
/// acceleration").
fn weights_condition(machine: &Machine) -> Option<&'static str> {
    (machine.controller.language.family == Family::Isg).then_some(
        "weightings of speed and acceleration (G129 to G131, G230, G231) are 100 % where a program \
         begins",
    )
}

/// Which levels hold when a program begins.
fn level_conditions(machine: &Machine) -> impl Iterator<Item = String> {
    let knobs = machine.controller.knobs.iter();
    let levels = knobs.filter_map(|knob| knob.levels.as_ref());
    levels.filter_map(|levels| {
        let level = levels.list.get(levels.power_on)?;
        Some(format!(
            "{} holds when the program begins, and each level acts as the machine file has it",
            level.text()
        ))
    })
}

/// How moves are planned.
fn plan_conditions(machine: &Machine, summary: &Summary) -> Vec<String> {
    let modelled = machine.controller.planner.look_ahead.is_some();
    let on_lines = summary.ahead && !modelled;
    let mut conditions = vec![match summary.certificate {
        Some(Certificate::Robust) => {
            "robust: blended moves hold for any look-ahead, blending and filtering that \
             keeps each axis inside its own limits; times are those with a stop at each block"
                .to_owned()
        }
        _ if on_lines => {
            "planned: blocks of one line between two stops run on into each other, each with \
             its own speed and acceleration"
                .to_owned()
        }
        _ if summary.ahead => format!(
            "planned: the look-ahead of `{}`, as its profile describes it",
            machine.controller.name
        ),
        _ => "planned: every block ends at rest (exact stop)".to_owned(),
    }];
    if summary.ahead && modelled && summary.certificate == Some(Certificate::Robust) {
        conditions.push(format!(
            "the other moves are planned with the look-ahead of `{}`",
            machine.controller.name
        ));
    }
    let corner = machine.controller.planner.look_ahead.map(|it| it.corner);
    let stepped = corner.is_some_and(|corner| !matches!(corner, CornerRule::LinuxCnc { .. }));
    if summary.ahead && modelled && corner.is_some() && !stepped {
        conditions.push(format!(
            "corners before a G61 or G64 of the program, if there are any, are rounded within {} mm \
             (power_on_tolerance_mm), as the control starts",
            machine.controller.language.power_on_tolerance_mm
        ));
    }
    if summary.ahead && stepped {
        conditions.push(format!(
            "the drives spread steps of speed at corners over {} ms (path.response_time_s)",
            (machine.path.response_time_s * 1e6).round() / 1e3
        ));
    }
    conditions
}

/// What limits over time rest on.
fn over_time_conditions(machine: &Machine, options: &Options, summary: &Summary) -> Vec<String> {
    let mut conditions = Vec::new();
    if summary.over_time.is_empty() {
        return conditions;
    }
    let runs = if options.once {
        "one run"
    } else {
        "a program that repeats without a pause"
    };
    conditions.push(format!(
        "limits over time are reduced by the margin and hold for {runs}"
    ));
    if machine.limits.override_at.is_none() {
        conditions.push(over_time_condition(machine, summary));
    }
    if summary.certificate == Some(Certificate::Robust) {
        conditions.push(
            "blended moves last no longer than with a stop at both ends, and no shorter than \
             their path at full speed"
                .to_owned(),
        );
    }
    conditions
}

/// What the figures rest on, in plain sentences; `paths` are the ways through the program.
pub(super) fn conditions(machine: &Machine, paths: &[Options], summary: &Summary) -> Vec<String> {
    let Some(options) = paths.first() else {
        return Vec::new();
    };
    let percent = |factor: f64| factor * 100.0;
    let limits = &machine.limits;
    let mut conditions = plan_conditions(machine, summary);
    if machine.path.mode == Some(PathMode::ExactStop) {
        conditions
            .push("path.mode of the machine file is exact-stop: G64 is overridden".to_owned());
    }
    conditions.push(overrides_condition(machine));
    conditions.push(format!(
        "margin {} % of the converter's power",
        percent(limits.margin)
    ));
    conditions.extend(assumptions(machine));
    conditions.extend(output_conditions(machine));
    conditions.extend(weights_condition(machine).map(str::to_owned));
    conditions.extend(level_conditions(machine));
    conditions.push(format!("read as {}", machine.controller.language.name));
    conditions.push(match options.reading.start {
        Start::Unknown => "start position unknown".to_owned(),
        Start::At(at) if at.iter().all(|value| *value == 0.0) => {
            "start position 0 for every axis".to_owned()
        }
        Start::At(_) => "start position as given".to_owned(),
    });
    conditions.extend(place_conditions(machine, options));
    conditions.extend(ways_conditions(paths));
    if let Some(spindle) = &machine.spindle {
        conditions.push(spindle_condition(spindle).to_owned());
    }
    let cuts = machine
        .spindle
        .as_ref()
        .is_some_and(|it| it.cutting_power_w > 0.0)
        || !machine.tools.is_empty();
    conditions.push(
        if cuts {
            "cutting counts as the machine file has it; emergency stop and feed hold are not covered"
        } else {
            "cutting forces are not counted; emergency stop and feed hold are not covered"
        }
        .to_owned(),
    );
    conditions.extend(over_time_conditions(machine, options, summary));
    conditions.extend(jerk_condition(machine, summary).map(str::to_owned));
    conditions.extend(curve_condition(machine).map(str::to_owned));
    conditions
}
