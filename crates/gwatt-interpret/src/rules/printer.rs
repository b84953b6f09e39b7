//! Marlin and similar firmware of 3D printers.

use super::iso;
use super::kinds::{BareG92, CycleWords, KeptVariables, LanguageRules, Macros, ToolLengths};
use crate::g_codes::{common_g_code, refused_g_name};

pub(crate) const RULES: LanguageRules = LanguageRules {
    // Marlin: G60 and G61 save a position and return to it. It and Klipper have no G93 and no
    // G95, and F stays per minute; of RepRapFirmware newer versions alone have G93.
    g_code: |number| match number {
        600..=640 | 930 | 950 => None,
        _ => common_g_code(number),
    },
    refused_g: |number| match number {
        930 | 950 => "a feed mode that not all firmware of printers has",
        _ => refused_g_name(number),
    },
    is_state_word: |_| false,
    extruder_modes: true,
    words_in_parentheses: true,
    checksums: true,
    macros: Macros::Own,
    kept: KeptVariables::None,
    without_feed: Some("no F yet: the first moves count at the speed limits of the axes"),
    lenient_dwell: true,
    bare_g92: BareG92::AllAxes,
    relative_places: true,
    leaves_axes_adrift: false,
    no_turned_machine_places: false,
    returns_name_axes: false,
    tool_lengths: ToolLengths::Elsewhere,
    corners_may_be_unknown: false,
    cycles: CycleWords::None,
    t_selects_offset: false,
    ..iso::RULES
};
