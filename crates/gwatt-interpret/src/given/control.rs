//! Variables that the caller gives, as the control takes them.

use super::{Given, GivenVariable, TOOL_OF_FANUC};
use crate::control::Control;
use crate::expression::Name;
use crate::own_state::OwnState;
use crate::rules::Macros;

impl Control<'_> {
    /// Takes over what was given.
    pub(crate) fn give(&mut self, given: &GivenVariable) {
        let value = given.value;
        match &given.name {
            Given::Number(number) if self.is_system_parameter(*number) => {
                self.give_system_parameter(*number, value);
            }
            Given::Number(TOOL_OF_FANUC) if self.rules.macros == Macros::MacroB => {
                self.tools.give(value);
            }
            // There are fewer than a program may keep.
            Given::Number(number) => {
                let _ = self.parameters.set(&Name::Number(*number), Ok(Some(value)));
            }
            Given::Named(name) => {
                let _ = self
                    .parameters
                    .set(&Name::Text(name.into()), Ok(Some(value)));
            }
            Given::R(number) => {
                if let OwnState::Siemens(siemens) = &mut self.own {
                    siemens.keep(*number, value);
                }
            }
            Given::Common(name) | Given::Global(name) => match &mut self.own {
                OwnState::Osp(osp) => osp.keep(name, value),
                OwnState::Siemens(siemens) => siemens.keep_global(name, value),
                _ => {}
            },
        }
    }
}
