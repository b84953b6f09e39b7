//! The ISG kernel, Beckhoff `TwinCAT` CNC (TF5200).

use super::iso;
use super::kinds::{BareG92, CycleWords, KeptVariables, LanguageRules, Macros, ToolLengths};
use crate::code::GCode;
use crate::g_codes::common_g_code;

pub(crate) const RULES: LanguageRules = LanguageRules {
    g_code,
    percent_names_programs: true,
    // "Machining time or feedrate (G93/G94/G95/G194)".
    block_time_in_seconds: true,
    macros: Macros::Own,
    kept: KeptVariables::None,
    g92_gives_offset: true,
    bare_g92: BareG92::Refused,
    leaves_axes_adrift: false,
    plane_ends_turn: true,
    no_turned_machine_places: false,
    returns_name_axes: false,
    tool_lengths: ToolLengths::Elsewhere,
    cycles: CycleWords::None,
    t_selects_offset: false,
    ..iso::RULES
};

/// The G words of TF5200, "G functions".
fn g_code(number: u16) -> Option<GCode> {
    match number {
        410 | 420 => Some(GCode::CompensationOn {
            left: number < 420,
            by_diameter: false,
        }),
        // G21 mirrors X and G20 ends it; G70 and G71 set the unit.
        200 | 210 => Some(GCode::MirrorX),
        700 => common_g_code(200),
        710 => common_g_code(210),
        // "Zero offsets (G53/G54/...G59)": G53 deselects them until further
        // notice, it is no word for one block.
        530 => Some(GCode::WorkOffset(0)),
        // G80 to G89 call subprograms of the machine's builder.
        800 => None,
        1610 => Some(GCode::ArcAbsolute(true)),
        1620 => Some(GCode::ArcAbsolute(false)),
        680 => Some(GCode::Rotation(true)),
        690 => Some(GCode::Rotation(false)),
        // Where speed changes, exact stop and blending at the ends of blocks,
        // feed forward, corrections of centres, weightings that are off.
        80 | 90 | 9000 | 9010 | 100..=130 if number.is_multiple_of(10) => Some(GCode::Ignored),
        960 | 970 => Some(GCode::SurfaceSpeed),
        // "Exact stop (G60/G360/G359)".
        600 => Some(GCode::ExactOnce),
        3590 | 3600 => Some(GCode::PathMode),
        2600 | 2610 => Some(GCode::Ignored),
        1150..=1170 | 1350..=1370 | 1640 | 1650 | 1660 | 250 | 260 if number.is_multiple_of(10) => {
            Some(GCode::Ignored)
        }
        _ => common_g_code(number),
    }
}
