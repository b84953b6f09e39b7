//! `[language.printer]`: what 3D printers differ in.

use super::printer_table::{RetractTable, SpeedCapName};

use super::controller_file::LanguageTable;
use super::findings::Findings;
use super::one_letter::one_letter;
use super::value::{At, Letter};
use super::word;
use crate::axis::AxisSet;
use crate::family::Family;
use crate::printer::{Command, ExtruderMode, Printer, Retract};
use crate::units::SECONDS_PER_MINUTE;

/// The table of a profile, or the defaults.
pub(crate) fn printer(findings: &mut Findings<'_>, language: &LanguageTable) -> Printer {
    let own = Printer::default();
    let Some(at) = &language.printer else {
        return own;
    };
    if language
        .family
        .is_some_and(|family| family != Family::Marlin)
    {
        let message = "`printer` belongs to family = \"marlin\"";
        findings.error("machine-kind", &at.span, message, None);
    }
    let table = &at.value;
    let mut endstop_letters = Vec::new();
    for text in table.endstop_letters.iter().flatten() {
        endstop_letters.extend(one_letter(findings, text));
    }
    let together = table.home_together.as_ref();
    Printer {
        extruder_mode: table.extruder_mode.unwrap_or(ExtruderMode::Follows),
        several_commands: table.several_commands.unwrap_or(own.several_commands),
        early_limits: table.early_limits.unwrap_or(own.early_limits),
        height_map: table.height_map.unwrap_or(own.height_map),
        speed_cap_mm_s: match table.speed_cap {
            Some(SpeedCapName::None) => None,
            None | Some(SpeedCapName::PerSecond) => Some(1.0),
            Some(SpeedCapName::PerMinute) => Some(1.0 / SECONDS_PER_MINUTE),
        },
        limits_in_mm: table.limits_in_mm.unwrap_or(own.limits_in_mm),
        velocity_limit: table.velocity_limit.unwrap_or(own.velocity_limit),
        drawing_back_travels: table
            .drawing_back_travels
            .unwrap_or(own.drawing_back_travels),
        retract_by_path: table.retract_by_path.unwrap_or(own.retract_by_path),
        feed_factor_spares: table
            .feed_factor_spares
            .as_ref()
            .map_or(own.feed_factor_spares, |letters| set(letters)),
        path_accel_spares: table
            .path_accel_spares
            .as_ref()
            .map_or(own.path_accel_spares, |letters| set(letters)),
        home_together: together.map_or(own.home_together, |list| groups(list)),
        home_moves: own.home_moves,
        retract: retract(table.retract.as_ref().map(|at| &at.value)),
        endstop_letters,
        ignored_macros: commands(findings, table.ignored_macros.as_ref()),
        unknown_moves: commands(findings, table.unknown_moves.as_ref()),
        may_heat: commands(findings, table.may_heat.as_ref()),
        unknown_macros: commands(findings, table.unknown_macros.as_ref()),
        optional_part: commands(findings, table.optional_part.as_ref()),
        shifts: commands(findings, table.shifts.as_ref()),
    }
}

/// Groups of axes.
pub(crate) fn groups(list: &[Vec<At<Letter>>]) -> Vec<AxisSet> {
    list.iter().map(|letters| set(letters)).collect()
}

fn set(letters: &[At<Letter>]) -> AxisSet {
    let mut set = AxisSet::default();
    for letter in letters {
        set.insert(letter.value.axis() as usize);
    }
    set
}

/// How filament is retracted; what is absent is as Marlin has it.
pub(crate) fn retract(table: Option<&RetractTable>) -> Retract {
    let own = Retract::default();
    let Some(table) = table else { return own };
    let speed_mm_s = table
        .speed_mm_s
        .as_ref()
        .map_or(own.speed_mm_s, |n| n.value);
    Retract {
        length_mm: table.length_mm.as_ref().map_or(own.length_mm, |n| n.value),
        speed_mm_s,
        extra_mm: table.extra_mm.as_ref().map_or(own.extra_mm, |n| n.value),
        recover_mm_s: table.recover_mm_s.as_ref().map_or(speed_mm_s, |n| n.value),
        lift_mm: table.lift_mm.as_ref().map_or(own.lift_mm, |n| n.value),
    }
}

/// Names of commands: words such as `G29`, names such as `BED_MESH_*`.
pub(crate) fn commands(
    findings: &mut Findings<'_>,
    list: Option<&Vec<At<String>>>,
) -> Vec<Command> {
    let mut commands = Vec::new();
    for text in list.into_iter().flatten() {
        if let Some(found) = command(&text.value) {
            commands.push(found);
        } else {
            let message = format!("\"{}\" is not a command", text.value);
            let help = Some("a word such as \"G29\", or a name such as \"BED_MESH_*\"".to_owned());
            findings.error("machine-word", &text.span, message, help);
        }
    }
    commands
}

/// A command by its name; `None` where it is none.
pub(crate) fn command(text: &str) -> Option<Command> {
    let name = text.trim().to_ascii_uppercase();
    let code = word::code(&name).filter(|(letter, _)| matches!(letter, b'G' | b'M' | b'T'));
    if let Some((letter, number)) = code {
        return Some(Command::Code(letter, number));
    }
    let stem = name.strip_suffix('*').unwrap_or(&name);
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'_';
    let fine = !stem.is_empty() && stem.bytes().all(plain);
    // A word with a number that no code has: `M9833`, `M620.11`.
    if !fine && word::parse(&name).is_none() {
        return None;
    }
    Some(match name.strip_suffix('*') {
        Some(stem) => Command::Macros(stem.to_owned()),
        None => Command::Macro(name),
    })
}
