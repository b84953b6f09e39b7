//! `[language]` of a machine file: how this machine's programs are written, where that is
//! not as in the controller profile.

use super::controller_file::{DistanceName, FeedName, UnitsName};
use super::findings::Findings;
use super::machine_file::OwnLanguageTable;
use super::value::{At, NotNegative};
use super::{listed_words, printer, profile};
use crate::controller::Language;
use crate::printer::Command;
use crate::units::SECONDS_PER_MINUTE;

/// Takes what the table gives into the language of the profile.
pub(crate) fn take(
    findings: &mut Findings<'_>,
    table: &At<OwnLanguageTable>,
    language: &mut Language,
) {
    let own = &table.value;
    order(own, language);
    let dialect = &mut language.dialect;
    dialect.point = own.decimal_point.or(dialect.point);
    dialect.point_is_known = own.decimal_point.is_some();
    dialect.diameter = own.diameter.unwrap_or(dialect.diameter);
    dialect.inverse_angles = own.inverse_angles.unwrap_or(dialect.inverse_angles);
    dialect.inverse_angles_are_known = own.inverse_angles.is_some();
    if let Some(feed) = own.feed {
        dialect.per_revolution = Some(feed == FeedName::PerRevolution);
    }
    if let Some(axes) = &own.tool_change_moves {
        language.tool_change_moves = Some(listed_words::axes_named(findings, axes));
    }
    if let Some(returns) = own.pecks_return_to_r {
        language.pecks_return_to_r = returns;
    }
    if let Some(clearance) = &own.peck_clearance_mm {
        language.peck_clearance_mm = clearance.value;
    }
    let given = |length: &Option<NotNegative>| length.as_ref().map(|length| length.value);
    language.escape_mm = given(&own.escape_mm);
    language.groove_return_mm = given(&own.groove_return_mm);
    language.type_2 = own.type_2.or(language.type_2);
    if let Some(arc) = own.arc_without_center {
        language.arc_without_center = arc;
    }
    if let Some(factor) = &own.tap_return_factor {
        language.tap_return_factor = Some(factor.value);
    }
    language.tap_feed = own.tap_feed.unwrap_or(language.tap_feed);
    if let Some(motion) = own.power_on_motion {
        language.power_on_motion = motion;
    }
    if let Some(feed) = &own.power_on_feed_mm_min {
        language.power_on_feed_mm_s = feed.value / SECONDS_PER_MINUTE;
    }
    dialect.active = true;
    if let Some(units) = own.units {
        language.metric = units == UnitsName::Mm;
        language.units_kept = false;
    }
    if let Some(tolerance) = &own.power_on_tolerance_mm {
        language.power_on_tolerance_mm = tolerance.value;
    }
    if let Some(centre) = own.arc_centre {
        language.arc_absolute = centre == DistanceName::Absolute;
    }
    if let Some(compensation) = &own.cutter_compensation {
        language.compensation = profile::compensation(compensation);
    }
    let (ignored_g, ignored_m) =
        listed_words::ignored(findings, own.ignored.as_deref().unwrap_or_default());
    for (field, list) in [
        ("ignored_macros", &own.ignored_macros),
        ("unknown_macros", &own.unknown_macros),
    ] {
        if list.is_some() && !language.family.facts().printer {
            let message = format!("`{field}` belongs to the controllers of printers");
            findings.error("machine-kind", &table.span, message, None);
        }
    }
    if let Some(retract) = &own.retract {
        if !language.family.facts().printer {
            let message = "`retract` belongs to the controllers of printers";
            findings.error("machine-kind", &retract.span, message, None);
        }
        language.printer.retract = printer::retract(Some(&retract.value));
    }
    if let Some(groups) = &own.home_moves {
        if !language.family.facts().printer {
            let message = "`home_moves` belongs to the controllers of printers";
            findings.error("machine-kind", &groups.span, message, None);
        }
        language.printer.home_moves = printer::groups(&groups.value);
    }
    commands(findings, own, language, [&ignored_g, &ignored_m]);
    language.ignored_g.extend(ignored_g);
    language.ignored_m.extend(ignored_m);
}

/// Takes the commands of a printer. What the machine file says of one stands in place of what
/// the profile says of it; `words`: the G words (number × 10) and M numbers that it ignores.
fn commands(
    findings: &mut Findings<'_>,
    own: &OwnLanguageTable,
    language: &mut Language,
    words: [&[u16]; 2],
) {
    let is_printer = language.family.facts().printer;
    if !is_printer {
        let words = own.unknown_moves.as_deref().unwrap_or_default();
        language.unknown_moves = listed_words::moving_words(findings, words);
    }
    let mut list = |given| printer::commands(findings, given);
    let ignored = list(own.ignored_macros.as_ref());
    let moves = list(own.unknown_moves.as_ref().filter(|_| is_printer));
    let macros = list(own.unknown_macros.as_ref());
    let unknown = |one: &Command| {
        [&moves, &macros]
            .into_iter()
            .flatten()
            .any(|by| covers(by, one))
    };
    let passed = |one: &Command| match one {
        Command::Code(b'G', number) => words[0].contains(number),
        Command::Code(b'M', number) => words[1].contains(&(number / 10)),
        _ => false,
    };
    let said =
        |one: &Command| unknown(one) || passed(one) || ignored.iter().any(|by| covers(by, one));
    language
        .ignored_g
        .retain(|number| !unknown(&Command::Code(b'G', *number)));
    language
        .ignored_m
        .retain(|number| !unknown(&Command::Code(b'M', number * 10)));
    let printer = &mut language.printer;
    for list in [
        &mut printer.ignored_macros,
        &mut printer.unknown_moves,
        &mut printer.unknown_macros,
        &mut printer.shifts,
    ] {
        list.retain(|one| !said(one));
    }
    // Macros, whatever their names: nobody says what they switch.
    printer.may_heat.extend(moves.iter().cloned());
    printer.ignored_macros.extend(ignored);
    printer.unknown_moves.extend(moves);
    printer.unknown_macros.extend(macros);
}

/// Whether all commands of `one` are of `by` too.
fn covers(by: &Command, one: &Command) -> bool {
    match one {
        Command::Code(..) => by == one,
        Command::Macro(name) => by.is_macro(name.as_bytes()),
        Command::Macros(begin) => matches!(by, Command::Macros(_)) && by.is_macro(begin.as_bytes()),
    }
}

/// When words act that stand in a block that moves.
fn order(own: &OwnLanguageTable, language: &mut Language) {
    let before = own.spindle_before_motion;
    language.spindle_before_motion = before.unwrap_or(language.spindle_before_motion);
    language.tool_change = own.tool_change.or(language.tool_change);
}
