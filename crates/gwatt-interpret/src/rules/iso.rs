//! ISO 6983 as Fanuc and its relatives read it.

use super::kinds::{
    BareG92, CycleWords, KeptVariables, LanguageRules, Macros, SpindleClamp, ToolLengths,
};
use crate::code::GCode;
use crate::g_codes::{common_g_code, refused_g_name};
use crate::tools::ToolLength;

pub(crate) const RULES: LanguageRules = LanguageRules {
    g_code,
    refused_g: refused_g_name,
    is_state_word: |number| number == 190,
    polar_words: false,
    fixed_meaning: true,
    free_m_words: false,
    extruder_modes: false,
    comments_act: false,
    words_in_parentheses: false,
    checksums: false,
    percent_names_programs: false,
    macros: Macros::MacroB,
    kept: KeptVariables::Numbers,
    feed_in_old_unit: false,
    block_time_in_seconds: false,
    without_feed: None,
    lenient_dwell: false,
    places_in_parameters: false,
    g52_is_g92: false,
    g92_gives_offset: false,
    bare_g92: BareG92::Clamp,
    clamp: SpindleClamp::G92,
    relative_places: false,
    leaves_axes_adrift: true,
    plane_ends_turn: false,
    no_turned_machine_places: true,
    returns_are_rapids: false,
    returns_name_axes: true,
    returns_suspend_frames: false,
    tools_are_listed: false,
    t_selects_offset: true,
    lathe_radius: b'R',
    tool_lengths: ToolLengths::Offsets,
    tool_edges: false,
    offset_numbers_stay: true,
    strict_compensation: false,
    compensation_changes: false,
    corners_may_be_unknown: true,
    chamfer_has_next_feed: false,
    cycle_levels_by_m: false,
    whole_cycle_dwell_s: 1e-3,
    cycles: CycleWords::Fanuc,
    turns_tilt_arcs: false,
    arc_turns: false,
    stray_centres: false,
    radius_word: "R",
};

fn g_code(number: u16) -> Option<GCode> {
    Some(match number {
        410 | 420 => GCode::CompensationOn {
            left: number < 420,
            by_diameter: false,
        },
        650 | 660 | 670 => GCode::MacroCall,
        100 => GCode::DataSetting,
        440 => GCode::ToolLength(ToolLength::Reversed),
        520 => GCode::LocalOffset,
        541 | 1540 => GCode::FurtherOffset,
        960 | 970 => GCode::SurfaceSpeed,
        150 | 160 => GCode::Polar(number == 160),
        680 | 690 => GCode::Rotation(number == 680),
        500 | 510 => GCode::Scaling(number == 510),
        501 | 511 => GCode::Mirror(number == 511),
        _ => return common_g_code(number),
    })
}
