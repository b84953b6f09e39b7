//! Which language a controller has.

use super::control::Language;
use super::isg::language::IsgLanguage;
use super::nci::language::NciLanguage;
use super::osp::language::OspLanguage;
use super::printer::language::PrinterLanguage;
use super::siemens::language::SiemensLanguage;
use super::statement::language::MacroLanguage;
use gwatt_machine::Family;

/// How a controller's language reads and executes blocks.
pub(super) fn language_of(language: &gwatt_machine::Language) -> &'static dyn Language {
    match language.family {
        Family::Iso if language.dialect.osp => &OspLanguage,
        Family::Iso | Family::Rs274 => &MacroLanguage,
        Family::Marlin => &PrinterLanguage,
        Family::Isg => &IsgLanguage,
        Family::Siemens => &SiemensLanguage,
        Family::Nci => &NciLanguage,
    }
}
