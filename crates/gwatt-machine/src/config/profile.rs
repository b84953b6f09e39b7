//! The profile's structs to the controller.

use super::controller_file::{
    ArgumentName, CallBlockName, CompensationTable, ControllerFile, DistanceName, DwellTable,
    FeedName, KnobTable, LanguageTable, PlannerTable, RapidKnobName, UnitsName,
};
use super::findings::Findings;
use super::listed_words::{axes_named, ignored};
use super::look_ahead::look_ahead;
use super::named_knob;
use super::one_letter::one_letter;
use super::printer::command;
use super::value::At;
use super::word;
use crate::axis::AxisId;
use crate::controller::{
    ArcRule, ArcWithoutCenter, Controller, CutterCompensation, Language, Planner, PowerOnMotion,
    RapidJoint, RapidKnob, RapidPath, SpindleWait, TapFeed,
};
use crate::dialect::Dialect;
use crate::knob::{Knob, KnobArgument, KnobTarget, KnobUnit};
use crate::queue::{LaserMode, MESSAGE, MESSAGES, Queue, QueueEffect, QueueWord};
use crate::units::SECONDS_PER_MINUTE;

/// Makes a controller; all mistakes go to the findings, and with any of them
/// the result is not to be used.
pub(crate) fn controller(findings: &mut Findings<'_>, file: &ControllerFile) -> Option<Controller> {
    let language = file
        .language
        .as_ref()
        .and_then(|table| language(findings, &table.value));
    let knobs: Vec<Knob> = file
        .knob
        .iter()
        .flatten()
        .filter_map(|table| knob(findings, table))
        .collect();
    let (wired, knobs) = knobs.into_iter().partition(|knob| knob.output().is_some());
    let planner_table = &file.planner.as_ref()?.value;
    Some(Controller {
        name: file.name.as_ref()?.value.clone(),
        description: file.description.clone().unwrap_or_default(),
        language: Language {
            name: file.name.as_ref()?.value.clone(),
            ..language?
        },
        planner: planner(findings, planner_table)?,
        queue: queue(findings, planner_table),
        knobs,
        wired,
        rapid_knob: rapid_knob(findings, planner_table),
    })
}

fn language(findings: &mut Findings<'_>, table: &LanguageTable) -> Option<Language> {
    let dwell = dwell(findings, table);
    let ignored_words = table.ignored.as_deref().unwrap_or_default();
    let (ignored_g, ignored_m) = ignored(findings, ignored_words);
    let power_on = table.power_on?;
    let family = table.family?;
    Some(Language {
        name: String::new(),
        family,
        dwell,
        power_on_feed_mm_s: table
            .power_on_feed_mm_min
            .as_ref()
            .map_or(f64::INFINITY, |it| it.value / SECONDS_PER_MINUTE),
        power_on_motion: table.power_on_motion.unwrap_or(PowerOnMotion::None),
        loose_o_words: table.loose_o_words.unwrap_or(false),
        metric: table.units != Some(UnitsName::Inch),
        units_kept: table.units_kept.unwrap_or(false),
        absolute: table.distance != Some(DistanceName::Incremental),
        arc_absolute: table.arc_centre == Some(DistanceName::Absolute),
        g61: table.g61.unwrap_or(power_on),
        g61_1: table.g61_1.unwrap_or(power_on),
        g64: table.g64.unwrap_or(power_on),
        power_on_mode: power_on,
        power_on_tolerance_mm: table
            .power_on_tolerance_mm
            .as_ref()
            .map_or(0.0, |tolerance| tolerance.value),
        exact_stop_word: exact_stop_word(findings, table),
        tool_change: table.tool_change,
        spindle_before_motion: table.spindle_before_motion.unwrap_or(false),
        tool_change_moves: table
            .tool_change_moves
            .as_deref()
            .map(|axes| axes_named(findings, axes)),
        unknown_moves: Vec::new(),
        rapid_uses_feed: table.rapid_uses_feed.unwrap_or(false),
        ignored_g,
        ignored_m,
        levels: table.levels.clone().unwrap_or_default(),
        block_delete: table.block_delete.unwrap_or(true),
        compensation: table.cutter_compensation.as_ref().and_then(compensation),
        printer: super::printer::printer(findings, table),
        mill_cycles: table.mill_cycles.unwrap_or(false),
        pecks_return_to_r: table.pecks_return_to_r.unwrap_or(false),
        peck_clearance_mm: table.peck_clearance_mm.as_ref().map_or(1.0, |it| it.value),
        cycles_repeat_by_l: table.cycles_repeat_by_l.unwrap_or(false),
        pecks_by_ijk: table.pecks_by_ijk.unwrap_or(false),
        escape_mm: None,
        groove_return_mm: None,
        type_2: table.type_2,
        arc_without_center: (table.arc_without_center).unwrap_or(ArcWithoutCenter::Refused),
        tap_return_factor: None,
        tap_feed: table.tap_feed.unwrap_or(TapFeed::PerMinute),
        cycles_take_d_and_h: table.cycles_take_d_and_h.unwrap_or(false),
        moves_in_machine_at_rapid: table.moves_in_machine_at_rapid.unwrap_or(false),
        arc_tolerance_mm: table
            .arc_tolerance_mm
            .as_ref()
            .map(|[metric, inch]| [metric.value, inch.value]),
        kept_variables: table
            .kept_variables
            .clone()
            .unwrap_or_else(|| family.facts().kept_variables.into_iter().collect()),
        dialect: dialect(table),
    })
}

/// The word for exact stop in one block.
fn exact_stop_word(findings: &mut Findings<'_>, table: &LanguageTable) -> Option<u16> {
    let text = table.exact_stop_word.as_ref()?;
    if let Some((b'G', code)) = word::code(&text.value) {
        return Some(code);
    }
    let message = format!("\"{}\" is not a G word", text.value);
    let help = Some("such as \"G9\"".to_owned());
    findings.error("machine-word", &text.span, message, help);
    None
}

/// How G41 and G42 shift the path.
pub(crate) fn compensation(table: &CompensationTable) -> Option<CutterCompensation> {
    Some(CutterCompensation {
        corner: table.corner?,
        lead: table.lead?,
        idle_blocks: table.idle_blocks.unwrap_or(1),
    })
}

fn dialect(table: &LanguageTable) -> Dialect {
    let whole = |entry: &At<DwellTable>| {
        let letter = word::letter(&entry.value.letter.as_ref()?.value)?;
        Some((letter, entry.value.whole_unit_s.as_ref()?.value))
    };
    let mut dialect = Dialect {
        active: false,
        point: table.decimal_point,
        point_is_known: false,
        dwell_whole: table.dwell.iter().flatten().filter_map(whole).collect(),
        lathe: table.lathe,
        diameter: table.diameter.unwrap_or(false),
        osp: table.osp.unwrap_or(false),
        other_m: table.other_m.unwrap_or(false),
        semicolon_ends_block: table.semicolon_ends_block.unwrap_or(false),
        per_revolution: table.feed.map(|feed| feed == FeedName::PerRevolution),
        inverse_angles: table.inverse_angles.unwrap_or_default(),
        inverse_angles_are_known: false,
        m97_calls: table.m97_calls.unwrap_or(false),
        m16_changes_tool: table.m16_changes_tool.unwrap_or(false),
        taps_return_by_j: table.taps_return_by_j.unwrap_or(false),
        work_offset_group: table.work_offset_group,
        circular_pocket: table.circular_pocket.unwrap_or(false),
        holes_along_z: table.holes_along_z.unwrap_or(false),
        bores_by_hand: table.bores_by_hand.unwrap_or(false),
        g28_all: table.g28_all.unwrap_or(false),
        call_block: table.call_block.map(|name| match name {
            CallBlockName::Q => b'Q',
            CallBlockName::H => b'H',
        }),
        last_g_counts: table.last_g_counts.unwrap_or(false),
    };
    dialect.active = dialect != Dialect::default();
    dialect
}

fn dwell(findings: &mut Findings<'_>, table: &LanguageTable) -> Vec<(u8, f64)> {
    let mut list: Vec<(u8, f64)> = Vec::new();
    for entry in table.dwell.iter().flatten() {
        let (Some(text), Some(unit)) = (&entry.value.letter, &entry.value.unit_s) else {
            continue;
        };
        let Some(letter) = one_letter(findings, text) else {
            continue;
        };
        if list.iter().any(|(other, _)| *other == letter) {
            let message = format!("letter {} is given twice", letter as char);
            findings.error("machine-twice", &text.span, message, None);
        }
        list.push((letter, unit.value));
    }
    list
}

fn planner(findings: &mut Findings<'_>, table: &PlannerTable) -> Option<Planner> {
    Some(Planner {
        rapid: table.rapid?,
        arc_rule: table.arc_rule.unwrap_or(ArcRule::Shared),
        rapid_joint: table.rapid_joint.unwrap_or(RapidJoint::All),
        dwell_stops: table.dwell_stops.unwrap_or(false),
        spindle_wait: table.spindle_wait.unwrap_or(SpindleWait::Unknown),
        shortest_block_s: table.shortest_block_s.as_ref().map_or(0.005, |it| it.value),
        shortest_at_feed_s: table.shortest_at_feed_s.as_ref().map_or(0.0, |it| it.value),
        look_ahead: look_ahead(findings, table.look_ahead.as_ref()),
    })
}

/// Which words stop the motion.
fn queue(findings: &mut Findings<'_>, table: &PlannerTable) -> Queue {
    let mut names = Vec::new();
    let mut list = |words: &Option<Vec<At<String>>>, effect| {
        let mut codes = Vec::new();
        for text in words.iter().flatten() {
            if let Some(word) = queue_word(&text.value) {
                codes.push(word);
            } else if let Some(name) = command(&text.value) {
                names.push((name, effect));
            } else {
                let message = format!("\"{}\" is not a program word", text.value);
                let help =
                    "such as \"M8\", \"S\" for every S, \"MSG\", or a command such as \"SET_LED*\"";
                findings.error("machine-word", &text.span, message, Some(help.to_owned()));
            }
        }
        codes
    };
    Queue {
        stops: list(&table.stops, QueueEffect::Stop),
        stops_on_change: list(&table.stops_on_change, QueueEffect::StopOnChange),
        passes: list(&table.passes, QueueEffect::Pass),
        joins: list(&table.joins, QueueEffect::Join),
        names,
        laser_mode: if table.has_laser_mode == Some(true) {
            LaserMode::Unknown
        } else {
            LaserMode::Off
        },
    }
}

fn queue_word(text: &str) -> Option<QueueWord> {
    let message = MESSAGES.iter().position(|name| *name == text);
    let (letter, number) = message
        .map(|index| (MESSAGE, Some(index as u16)))
        .or_else(|| word::code(text).map(|(letter, number)| (letter, Some(number))))
        .or_else(|| word::letter(text).map(|letter| (letter, None)))?;
    Some(QueueWord { letter, number })
}

/// A rapid may be written as a feed only where it is straight.
fn rapid_knob(findings: &mut Findings<'_>, table: &PlannerTable) -> RapidKnob {
    let Some(knob) = table
        .rapid_knob
        .as_ref()
        .filter(|knob| knob.value != RapidKnobName::None)
    else {
        return RapidKnob::None;
    };
    // Where the machine's rapids are independent, it takes the knob away.
    if knob.value == RapidKnobName::G1 && table.rapid == Some(RapidPath::Independent) {
        let message = "`rapid_knob` = \"g1\" with independent rapids changes the path";
        let help = Some("a feed is straight; use \"none\"".to_owned());
        findings.error("machine-value", &knob.span, message, help);
    }
    RapidKnob::G1
}

fn knob(findings: &mut Findings<'_>, table: &At<KnobTable>) -> Option<Knob> {
    let knob = &table.value;
    let target = knob.target?;
    let unit = knob.unit?;
    let argument = argument(findings, knob)?;
    let output = argument == KnobArgument::Output(0);
    let read_back = named_knob::is_read_back(knob.word.as_ref()?, &argument, target, unit);
    if !read_back && !goes_with(target, unit, output) {
        let message = "`unit` does not go with `target`";
        let help = "accelerations are in \"percent\" or \"per-second-squared\", jerk and rapid-speed in \
                    \"percent\", speed in \"percent\", \"per-second\" or \"per-minute\", and \
                    cruise-ratio is a \"share\", as are accel and speed-share with argument = \"output\"";
        findings.error("machine-kind", &table.span, message, Some(help.to_owned()));
    }
    let text = knob.word.as_ref()?;
    let waits = knob
        .wait
        .as_deref()
        .is_some_and(|it| it.starts_with("M66 "));
    let read_back = match target {
        KnobTarget::SpeedShare => text.value == "M67" && knob.wait.is_none(),
        _ => text.value == "M68" && waits,
    };
    if output && !read_back {
        let message = format!(
            "\"{}\" with argument = \"output\" is not read back",
            text.value
        );
        let help = "\"M68\" with wait = \"M66 P0 L0\" for accel, \"M67\" alone for speed-share";
        let help = Some(help.to_owned());
        findings.error("machine-word", &text.span, message, help);
        return None;
    }
    let code = if named_knob::is_named(text, &argument) {
        named_knob::check(findings, text, &argument, target, unit)?;
        None
    } else if argument == KnobArgument::Value {
        named_knob::check_value(findings, text, target, unit)?;
        None
    } else {
        let code = word::code(&text.value);
        if code.is_none() {
            let message = format!("\"{}\" is not a program word", text.value);
            let help = Some("a letter and a number, such as \"G131\"".to_owned());
            findings.error("machine-word", &text.span, message, help);
        }
        Some(code?)
    };
    Some(Knob {
        code,
        name: match code {
            Some((letter, number)) => format!("{}{}", letter as char, f64::from(number) / 10.0),
            None => text.value.clone(),
        },
        target,
        argument,
        unit,
        step: knob.step.as_ref()?.value,
        min: knob.min.as_ref()?.value,
        verified: knob.verified.unwrap_or(false),
        between_moves: knob.between_moves.unwrap_or(false),
        with_jerk: with_jerk(findings, knob, target, unit),
        barrier: knob.barrier.clone(),
        wait: knob.wait.clone(),
        change_s: 0.0,
        levels: None,
    })
}

/// Whether a word for accelerations acts on the jerk too, for which it has to be a share.
fn with_jerk(
    findings: &mut Findings<'_>,
    table: &KnobTable,
    target: KnobTarget,
    unit: KnobUnit,
) -> bool {
    let Some(asked) = &table.with_jerk else {
        return false;
    };
    let shares = matches!(unit, KnobUnit::Percent | KnobUnit::Share);
    if asked.value && !(target == KnobTarget::Accel && shares) {
        let message = "`with_jerk` goes with target = \"accel\" in \"percent\" or as a \"share\"";
        findings.error("machine-kind", &asked.span, message, None);
    }
    asked.value
}

/// Whether values in a unit can act so; `output`: set by an analog output.
fn goes_with(target: KnobTarget, unit: KnobUnit, output: bool) -> bool {
    match target {
        KnobTarget::Accel | KnobTarget::SpeedShare if output => unit == KnobUnit::Share,
        _ if output => false,
        KnobTarget::SpeedShare => false,
        KnobTarget::Accel | KnobTarget::FeedAccel | KnobTarget::RapidAccel => {
            matches!(unit, KnobUnit::Percent | KnobUnit::PerSecondSquared)
        }
        KnobTarget::Jerk | KnobTarget::RapidSpeed => unit == KnobUnit::Percent,
        KnobTarget::Speed => {
            matches!(
                unit,
                KnobUnit::Percent | KnobUnit::PerSecond | KnobUnit::PerMinute
            )
        }
        KnobTarget::CruiseRatio => unit == KnobUnit::Share,
    }
}

fn argument(findings: &mut Findings<'_>, knob: &KnobTable) -> Option<KnobArgument> {
    let argument = knob.argument.as_ref()?;
    if argument.value != ArgumentName::Path
        && let Some(letters) = &knob.letters
    {
        let message = "`letters` belong to argument = \"path\"";
        findings.error("machine-kind", &letters.span, message, None);
    }
    Some(match argument.value {
        ArgumentName::Assign => KnobArgument::Assign,
        ArgumentName::Axes => KnobArgument::Axes,
        ArgumentName::Index => KnobArgument::Index,
        ArgumentName::Dynamics => KnobArgument::Dynamics,
        // Which one, the machine file says.
        ArgumentName::Output => KnobArgument::Output(0),
        ArgumentName::Value => KnobArgument::Value,
        ArgumentName::Path => {
            let mut list = Vec::new();
            for text in knob.letters.iter().flat_map(|letters| &letters.value) {
                let Some(letter) = one_letter(findings, text) else {
                    continue;
                };
                if AxisId::from_letter(letter).is_some() {
                    let message = format!("{} is an axis", letter as char);
                    let help = Some("for a value per axis use argument = \"axes\"".to_owned());
                    findings.error("machine-word", &text.span, message, help);
                }
                list.push(letter);
            }
            if list.is_empty() && !findings.refused_in("knob") {
                let message = "argument = \"path\" needs `letters`";
                let help = Some("such as letters = [\"P\", \"T\"]".to_owned());
                findings.error("machine-missing", &argument.span, message, help);
            }
            KnobArgument::Path(list)
        }
    })
}
