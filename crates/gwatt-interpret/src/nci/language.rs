//! NC I as one of the languages.

use super::Nci;
use crate::control::{Control, Language, Run};
use crate::own_state::OwnState;
use crate::report::Report;
use gwatt_syntax::Block;

/// The classic dialect of `TwinCAT` NC I.
#[derive(Debug)]
pub(crate) struct NciLanguage;

impl Language for NciLanguage {
    fn own_state(&self) -> OwnState {
        OwnState::Nci(Nci::default())
    }

    /// Each block is read: what is no plain word of this language is refused.
    fn begin_block(&self, _control: &mut Control<'_>, _block: &Block, _text: &[u8]) -> bool {
        true
    }

    fn read(
        &self,
        control: &mut Control<'_>,
        block: &mut Block,
        report: &mut Report<'_, '_>,
    ) -> bool {
        control.nci_words(block, report);
        false
    }

    fn acts_without_words(&self, control: &Control<'_>) -> bool {
        matches!(&control.own, OwnState::Nci(nci) if nci.is_active())
    }

    fn prepare(&self, control: &mut Control<'_>, run: &mut Run<'_, '_>) {
        control.take_dynamics(run);
    }

    fn execute(&self, control: &mut Control<'_>, run: &mut Run<'_, '_>, errors: u64) {
        control.general(run, errors);
    }
}
