//! SINUMERIK as one of the languages.

use super::Siemens;
use super::codes::is_beyond_words;
use crate::control::{Control, Language, Run};
use crate::own_state::OwnState;
use crate::report::Report;
use crate::words::Words;
use gwatt_syntax::Block;

/// SINUMERIK 840D and its relatives.
#[derive(Debug)]
pub(crate) struct SiemensLanguage;

impl Language for SiemensLanguage {
    fn own_state(&self) -> OwnState {
        OwnState::Siemens(Box::new(Siemens::new()))
    }

    fn begin_block(&self, control: &mut Control<'_>, block: &Block, text: &[u8]) -> bool {
        if let OwnState::Siemens(siemens) = &mut control.own {
            siemens.begin_block();
        }
        is_beyond_words(block, text)
    }

    fn read(
        &self,
        control: &mut Control<'_>,
        block: &mut Block,
        report: &mut Report<'_, '_>,
    ) -> bool {
        control.begun = true;
        control.siemens_words(block, report)
    }

    fn acts_without_words(&self, control: &Control<'_>) -> bool {
        matches!(&control.own, OwnState::Siemens(siemens) if siemens.is_active())
    }

    fn moves_plainly(&self, control: &Control<'_>, words: &Words) -> bool {
        matches!(&control.own, OwnState::Siemens(siemens) if siemens.is_plain_motion(words))
    }

    fn execute(&self, control: &mut Control<'_>, run: &mut Run<'_, '_>, _errors: u64) {
        control.siemens_block(run);
    }

    fn value(&self, control: &mut Control<'_>, text: &[u8]) -> Option<f64> {
        control.siemens_value(text)
    }

    fn enter(&self, control: &mut Control<'_>) {
        if let OwnState::Siemens(siemens) = &mut control.own {
            siemens.enter();
        }
    }

    fn leave(&self, control: &mut Control<'_>) {
        if let OwnState::Siemens(siemens) = &mut control.own {
            siemens.leave(&mut control.modal, &mut control.knobs, control.machine);
        }
        control.settle_siemens();
    }
}
