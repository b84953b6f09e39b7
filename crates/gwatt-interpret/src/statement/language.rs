//! RS274/NGC, and ISO 6983 with Fanuc's custom macro B.

use crate::control::{Control, Language, Run};
use crate::expression::Reader;
use crate::report::Report;
use gwatt_syntax::Block;

/// Both languages: what they differ in are facts.
#[derive(Debug)]
pub(crate) struct MacroLanguage;

impl Language for MacroLanguage {
    fn is_command(&self, control: &Control<'_>, _block: &Block, text: &[u8]) -> bool {
        control.is_dollar(text)
    }

    fn command(&self, control: &mut Control<'_>, run: &mut Run<'_, '_>) {
        control.dollar(run);
    }

    fn read(
        &self,
        control: &mut Control<'_>,
        block: &mut Block,
        report: &mut Report<'_, '_>,
    ) -> bool {
        control.line_of_grbl(block, report)
    }

    fn execute(&self, control: &mut Control<'_>, run: &mut Run<'_, '_>, errors: u64) {
        control.general(run, errors);
    }

    fn value(&self, control: &mut Control<'_>, text: &[u8]) -> Option<f64> {
        Reader::new(text, 0).value(control).ok().flatten()
    }
}
