//! Okuma's OSP: ISO 6983 with words and variables of its own.

use super::iso;
use super::kinds::{KeptVariables, LanguageRules};
use crate::g_codes::refused_g_name;
use crate::osp::codes::refused_name;

pub(crate) const RULES: LanguageRules = LanguageRules {
    refused_g: |number| refused_name(number).unwrap_or_else(|| refused_g_name(number)),
    lathe_radius: b'L',
    cycle_levels_by_m: true,
    whole_cycle_dwell_s: 1.0,
    kept: KeptVariables::Common,
    ..iso::RULES
};
