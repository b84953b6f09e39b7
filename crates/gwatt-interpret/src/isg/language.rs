//! The ISG kernel as one of the languages.

use super::Isg;
use crate::control::{Control, Language, Run};
use crate::own_state::OwnState;
use crate::report::Report;
use gwatt_syntax::Block;

/// The ISG kernel.
#[derive(Debug)]
pub(crate) struct IsgLanguage;

impl Language for IsgLanguage {
    fn own_state(&self) -> OwnState {
        OwnState::Isg(Box::new(Isg::new()))
    }

    fn begin_block(&self, control: &mut Control<'_>, block: &Block, _text: &[u8]) -> bool {
        matches!(&control.own, OwnState::Isg(isg) if isg.is_beyond_words(block))
    }

    fn read(
        &self,
        control: &mut Control<'_>,
        block: &mut Block,
        report: &mut Report<'_, '_>,
    ) -> bool {
        control.isg_words(block, report)
    }

    fn execute(&self, control: &mut Control<'_>, run: &mut Run<'_, '_>, errors: u64) {
        control.general(run, errors);
    }

    fn value(&self, control: &mut Control<'_>, text: &[u8]) -> Option<f64> {
        control.isg_value(text)
    }

    fn enter(&self, control: &mut Control<'_>) {
        if let OwnState::Isg(isg) = &mut control.own {
            isg.enter();
        }
    }

    fn leave(&self, control: &mut Control<'_>) {
        if let OwnState::Isg(isg) = &mut control.own {
            isg.leave();
        }
    }
}
