//! The value of a variable, as the control has it.

use super::{UNDER_COMPENSATION, is_tool};
use crate::control::Control;
use crate::expression::{KEPT, PROBED, Read, TOOL, Variables};
use crate::rules::Macros;
use gwatt_machine::InverseAngles;

impl Variables for Control<'_> {
    fn numbered(&self, number: u32) -> Read {
        if let Some(held) = self.parameters.local(number) {
            return held.into();
        }
        if self.fanuc() {
            return self.fanuc_variable(number);
        }
        if self.is_compensating() && matches!(number, 5420..=5428) {
            return Read::Unknown(UNDER_COMPENSATION);
        }
        if let Some(value) = self.system_parameter(number) {
            return Read::Value(Some(value));
        }
        match number {
            5061..=5070 => Read::Unknown(PROBED),
            5161..=5390 => Read::Unknown(KEPT),
            5399 => Read::Unknown("an input (M66)"),
            5400..=5413 if self.tools.loaded_known().is_none() => Read::Unknown(TOOL),
            5400..=5413 => Read::Unknown("the tool, without a tool table"),
            5420..=5428 => Read::Unknown("the start position"),
            0 | 5602.. => Read::Missing,
            _ => match self.parameters.number(number) {
                Some(held) => held.map(|value| value.or(Some(0.0))).into(),
                None if self.is_kept(number) => Read::Unknown(KEPT),
                None => Read::Value(Some(0.0)),
            },
        }
    }

    fn named(&self, name: &str) -> Read {
        if let Some(held) = self.parameters.named(name) {
            return held.map(|value| value.or(Some(0.0))).into();
        }
        let place = matches!(name.as_bytes(), [b'_', b'a'..=b'c' | b'u'..=b'z']);
        if place && self.is_compensating() {
            return Read::Unknown(UNDER_COMPENSATION);
        }
        if matches!(name, "_feed" | "_motion_mode") {
            self.reads_state.set(true);
        }
        if let Some(value) = self.named_parameter(name) {
            return Read::Value(Some(value));
        }
        if is_tool(name) {
            return Read::Unknown(TOOL);
        }
        if name.starts_with("_hal[") || name.starts_with("_ini[") {
            return Read::Unknown("the machine's configuration");
        }
        Read::Missing
    }

    fn fanuc(&self) -> bool {
        self.rules.macros != Macros::OWords
    }

    fn inverse_angles(&self) -> (InverseAngles, bool) {
        let dialect = &self.machine.controller.language.dialect;
        (dialect.inverse_angles, dialect.inverse_angles_are_known)
    }
}
