//! Firmware of printers as one of the languages.

use super::is_command;
use crate::control::{Control, Language, Run};
use crate::report::Report;
use gwatt_machine::AxisSet;
use gwatt_syntax::Block;

/// Marlin and similar firmware.
#[derive(Debug)]
pub(crate) struct PrinterLanguage;

impl Language for PrinterLanguage {
    fn is_command(&self, control: &Control<'_>, block: &Block, _text: &[u8]) -> bool {
        is_command(block, control.printer.own_motion)
    }

    fn command(&self, control: &mut Control<'_>, run: &mut Run<'_, '_>) {
        control.begun = true;
        control.command_line(run);
    }

    fn prepare(&self, control: &mut Control<'_>, run: &mut Run<'_, '_>) {
        let mut words = run.block.words.iter();
        if words.any(|word| word.letter == b'G' && (0.0..4.0).contains(&word.value)) {
            // It is read once the move before it is in the queue.
            control.printer.pending = AxisSet::default();
        }
    }

    /// What is not understood is a command: see [`Self::is_command`].
    fn read(
        &self,
        control: &mut Control<'_>,
        block: &mut Block,
        report: &mut Report<'_, '_>,
    ) -> bool {
        control.macro_words(block, report)
    }

    fn execute(&self, control: &mut Control<'_>, run: &mut Run<'_, '_>, errors: u64) {
        if run.report.diagnostics.errors == errors && !run.words.is_alone() {
            control.command_line(run);
        } else {
            control.general(run, errors);
        }
    }
}
