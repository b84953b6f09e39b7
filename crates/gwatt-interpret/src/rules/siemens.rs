//! SINUMERIK 840D and its relatives.

use super::iso;
use super::kinds::{BareG92, CycleWords, KeptVariables, LanguageRules, Macros, ToolLengths};
use crate::siemens::codes::{refused_name, siemens_code};

pub(crate) const RULES: LanguageRules = LanguageRules {
    g_code: siemens_code,
    refused_g: refused_name,
    is_state_word: |_| false,
    fixed_meaning: false,
    free_m_words: true,
    macros: Macros::Own,
    kept: KeptVariables::R,
    without_feed: Some(
        "no F in force: the control's data (SD42110) say which feed then; \
         counted at the speed limits of the axes",
    ),
    bare_g92: BareG92::Refused,
    leaves_axes_adrift: false,
    no_turned_machine_places: false,
    returns_name_axes: false,
    returns_suspend_frames: true,
    tool_lengths: ToolLengths::Elsewhere,
    tool_edges: true,
    compensation_changes: true,
    corners_may_be_unknown: false,
    chamfer_has_next_feed: true,
    cycles: CycleWords::None,
    stray_centres: true,
    radius_word: "CR",
    t_selects_offset: false,
    ..iso::RULES
};
