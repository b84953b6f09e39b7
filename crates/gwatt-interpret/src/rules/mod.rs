//! The facts of each language: a file for each, and which belong to a controller.

mod iso;
mod isg;
mod kinds;
mod nci;
mod osp;
mod printer;
mod rs274;
mod siemens;

pub(crate) use kinds::{
    BareG92, CycleWords, KeptVariables, LanguageRules, Macros, SpindleClamp, ToolLengths,
};

use gwatt_machine::{Family, Language};

/// The facts of a controller's language.
pub(crate) fn rules_of(language: &Language) -> &'static LanguageRules {
    match language.family {
        Family::Iso if language.dialect.osp => &osp::RULES,
        Family::Iso => &iso::RULES,
        Family::Rs274 => &rs274::RULES,
        Family::Marlin => &printer::RULES,
        Family::Isg => &isg::RULES,
        Family::Siemens => &siemens::RULES,
        Family::Nci => &nci::RULES,
    }
}
