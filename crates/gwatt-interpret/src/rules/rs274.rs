//! RS274/NGC, as `LinuxCNC`, grbl and `FluidNC` read it.

use super::iso;
use super::kinds::{
    BareG92, CycleWords, KeptVariables, LanguageRules, Macros, SpindleClamp, ToolLengths,
};
use crate::code::GCode;
use crate::g_codes::common_g_code;
use crate::lathe_cycle::lathe_cycle_code;
use crate::tools::ToolLength;

pub(crate) const RULES: LanguageRules = LanguageRules {
    g_code,
    is_state_word: |number| {
        number.is_multiple_of(10) && matches!(number, 190 | 480..=530 | 610..=680 | 700..=730)
    },
    polar_words: true,
    arc_turns: true,
    comments_act: true,
    macros: Macros::OWords,
    kept: KeptVariables::NumbersAndNames,
    feed_in_old_unit: true,
    places_in_parameters: true,
    g52_is_g92: true,
    bare_g92: BareG92::Refused,
    clamp: SpindleClamp::D,
    leaves_axes_adrift: false,
    no_turned_machine_places: false,
    returns_are_rapids: true,
    returns_name_axes: false,
    tools_are_listed: true,
    tool_lengths: ToolLengths::Table,
    offset_numbers_stay: false,
    strict_compensation: true,
    corners_may_be_unknown: false,
    cycles: CycleWords::Rs274,
    turns_tilt_arcs: true,
    t_selects_offset: false,
    ..iso::RULES
};

fn g_code(number: u16) -> Option<GCode> {
    Some(match number {
        410 | 411 | 420 | 421 => GCode::CompensationOn {
            left: number < 420,
            by_diameter: number % 10 == 1,
        },
        70 | 80 => GCode::Diameter(number == 70),
        100 => GCode::DataSetting,
        281 | 301 => GCode::SaveReference,
        431 => GCode::ToolLength(ToolLength::Given),
        432 => GCode::ToolLength(ToolLength::Added),
        520 => GCode::LocalOffset,
        960 | 970 => GCode::SurfaceSpeed,
        _ => return common_g_code(number).or_else(|| lathe_cycle_code(number)),
    })
}
