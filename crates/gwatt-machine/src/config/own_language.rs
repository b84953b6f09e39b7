//! `[language]` of a machine file: how this machine's programs are written, where that is
//! not as in the controller profile.

use super::controller_file::{DistanceName, UnitsName};
use super::findings::Findings;
use super::machine_file::{ArcWithoutCenterName, OwnLanguageTable};
use super::value::{At, NotNegative};
use super::{listed_words, printer, profile};
use crate::controller::Language;
use crate::units::SECONDS_PER_MINUTE;

/// Takes what the table gives into the language of the profile.
pub(crate) fn take(
    findings: &mut Findings<'_>,
    table: &At<OwnLanguageTable>,
    language: &mut Language,
) {
    let own = &table.value;
    let dialect = &mut language.dialect;
    dialect.point = own.decimal_point.map(profile::point).or(dialect.point);
    dialect.point_is_known = own.decimal_point.is_some();
    dialect.diameter = own.diameter.unwrap_or(dialect.diameter);
    language.tool_change = own
        .tool_change
        .map(profile::tool_change)
        .or(language.tool_change);
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
    language.type_2_as_type_1 = own.type_2_as_type_1 == Some(true);
    language.arc_without_center_is_line =
        own.arc_without_center == Some(ArcWithoutCenterName::Line);
    if let Some(motion) = own.power_on_motion {
        language.power_on_motion = profile::power_on_motion(motion);
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
    let (g, m) = listed_words::ignored(findings, own.ignored.as_deref().unwrap_or_default());
    language.ignored_g.extend(g);
    language.ignored_m.extend(m);
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
    let mut moves = own.unknown_moves.as_ref();
    if !language.family.facts().printer {
        let words = moves.take().map(Vec::as_slice).unwrap_or_default();
        language.unknown_moves = listed_words::moving_words(findings, words);
    }
    let ignored = printer::commands(findings, own.ignored_macros.as_ref());
    let printer = &mut language.printer;
    let moves = printer::commands(findings, moves);
    // Macros, whatever their names: nobody says what they switch.
    printer.may_heat.extend(moves.iter().cloned());
    let macros = printer::commands(findings, own.unknown_macros.as_ref());
    // This machine's macro stands in place of the firmware's command of its name.
    printer.ignored_macros.retain(|one| !macros.contains(one));
    printer.unknown_moves.retain(|one| !macros.contains(one));
    printer.ignored_macros.extend(ignored);
    printer.unknown_moves.extend(moves);
    printer.unknown_macros.extend(macros);
}
