//! Okuma's OSP as one of the languages.

use super::Osp;
use crate::control::{Control, Language, Run};
use crate::own_state::OwnState;
use crate::report::Report;
use gwatt_syntax::Block;

/// Okuma's OSP.
#[derive(Debug)]
pub(crate) struct OspLanguage;

impl Language for OspLanguage {
    fn own_state(&self) -> OwnState {
        OwnState::Osp(Box::new(Osp::new()))
    }

    fn begin_block(&self, control: &mut Control<'_>, block: &Block, _text: &[u8]) -> bool {
        let OwnState::Osp(osp) = &mut control.own else {
            return false;
        };
        osp.only_keeps = false;
        osp.is_beyond_words(block)
    }

    fn read(
        &self,
        control: &mut Control<'_>,
        block: &mut Block,
        report: &mut Report<'_, '_>,
    ) -> bool {
        control.osp_words(block, report)
    }

    fn execute(&self, control: &mut Control<'_>, run: &mut Run<'_, '_>, errors: u64) {
        control.general(run, errors);
    }

    fn value(&self, control: &mut Control<'_>, text: &[u8]) -> Option<f64> {
        control.osp_value(text)
    }

    fn enter(&self, control: &mut Control<'_>) {
        if let OwnState::Osp(osp) = &mut control.own {
            osp.enter();
        }
    }

    fn leave(&self, control: &mut Control<'_>) {
        if let OwnState::Osp(osp) = &mut control.own {
            osp.leave();
        }
    }
}
