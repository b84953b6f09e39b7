//! The classic dialect of `TwinCAT` NC I.

use super::iso;
use super::kinds::{BareG92, CycleWords, KeptVariables, LanguageRules, Macros, ToolLengths};
use crate::g_codes::common_g_code;
use crate::nci::codes::nci_g_code;

pub(crate) const RULES: LanguageRules = LanguageRules {
    g_code: |number| nci_g_code(number, common_g_code),
    is_state_word: |_| false,
    fixed_meaning: false,
    macros: Macros::Own,
    kept: KeptVariables::None,
    bare_g92: BareG92::Refused,
    leaves_axes_adrift: false,
    no_turned_machine_places: false,
    returns_name_axes: false,
    tool_lengths: ToolLengths::Elsewhere,
    corners_may_be_unknown: false,
    cycles: CycleWords::None,
    t_selects_offset: false,
    ..iso::RULES
};
