//! Parameters of the control: how blocks read and set them.

use super::{UNDER_COMPENSATION, is_tool};
use crate::control::Control;
use crate::expression::{Held, KEPT, Name, Read, TOOL, Variables};
use crate::tools::ToolLength;
use gwatt_machine::Lathe;
use gwatt_motion::FeedMode;

impl Control<'_> {
    /// B-63944EN, "System Variables": what the program itself decides is known.
    pub(crate) fn fanuc_variable(&self, number: u32) -> Read {
        if matches!(number, 4001 | 4109) {
            self.reads_state.set(true);
        }
        if matches!(number, 3001 | 3002 | 3011 | 3012) {
            return Read::Unknown("the time");
        }
        if let Some(held) = self.parameters.number(number) {
            return held.into();
        }
        let shifted = self.compensation.as_ref().is_some_and(|it| it.shifts());
        if shifted && matches!(number, 5001..=5009 | 5021..=5029 | 5041..=5049) {
            return Read::Unknown(UNDER_COMPENSATION);
        }
        if self.is_kept(number) {
            return Read::Unknown(KEPT);
        }
        let axis = |first: u32| (number - first) as usize;
        let known = match number {
            _ if self.is_common(number) => return Read::Value(None),
            0 | 100..=199 | 500..=999 => return Read::Value(None),
            4001..=4021 => self.modal_code(number),
            4120 if self.tools.selected_known().is_none() => return Read::Unknown(TOOL),
            4120 => self.tools.selected_known().map(f64::from),
            4111 if self.dialect().lathe.is_none() => self.tools.length_number().map(f64::from),
            4109 => self.modal.feed.as_ref().map(|feed| feed.value),
            4119 => Some(self.modal.spindle_rpm),
            5001..=5009 => self.place(axis(5001)),
            5021..=5029 => self.place_in_machine(axis(5021)),
            5041..=5049 => self.place(axis(5041)),
            5221..=5326 => self.work_offset(number - 5221),
            _ => None,
        };
        match known {
            Some(value) => Read::Value(Some(value)),
            None if number >= 1000 => Read::Unknown("the state of the control"),
            None => Read::Missing,
        }
    }

    /// Whether the control keeps a variable whose value is not given.
    pub(crate) fn is_kept(&self, number: u32) -> bool {
        !self.parameters.complete && self.is_common(number)
    }

    /// Whether it keeps a variable from one program to the next.
    pub(crate) fn is_common(&self, number: u32) -> bool {
        let kept = &self.machine.controller.language.kept_variables;
        kept.iter()
            .any(|[first, last]| (*first..=*last).contains(&number))
    }

    /// #4001 and so on: the G codes in force, by group.
    fn modal_code(&self, number: u32) -> Option<f64> {
        let system_a = self.dialect().lathe == Some(Lathe::A);
        Some(match number {
            4001 => f64::from(self.modal.motion.digit()? - b'0'),
            4002 => match self.modal.plane {
                [0, 1, 2] => 17.0,
                [2, 0, 1] => 18.0,
                _ => 19.0,
            },
            4003 if system_a => return None,
            4003 if self.modal.absolute => 90.0,
            4003 => 91.0,
            4005 => match (self.modal.feed_mode, system_a) {
                (FeedMode::InverseTime, _) => 93.0,
                (FeedMode::PerMinute, false) => 94.0,
                (FeedMode::PerRevolution, false) => 95.0,
                (FeedMode::PerMinute, true) => 98.0,
                (FeedMode::PerRevolution, true) => 99.0,
            },
            4006 if self.modal.mm_per_unit == 1.0 => 21.0,
            4006 => 20.0,
            4008 if self.dialect().lathe.is_none() => match self.tools.length_form() {
                None => 49.0,
                Some(ToolLength::On) => 43.0,
                Some(ToolLength::Reversed) => 44.0,
                Some(_) => return None,
            },
            _ if self.dialect().work_offset_group.map(u32::from) == Some(number - 4000) => {
                match self.position.offsets().system {
                    system @ 1..=6 => 53.0 + f64::from(system),
                    _ => return None,
                }
            }
            _ => return None,
        })
    }

    /// #5221 and so on, twenty a system from G54 on: the origin of X, Y or Z on a mill, where
    /// it is known.
    fn work_offset(&self, place: u32) -> Option<f64> {
        let (system, axis) = ((place / 20 + 1) as u16, (place % 20) as usize);
        let offsets = self.position.offsets();
        if axis > 2 || self.dialect().lathe.is_some() || !offsets.is_origin_known(system, axis) {
            return None;
        }
        Some(self.in_unit(axis, offsets.origin_of(system)[axis]))
    }

    /// Gives a parameter a value, or takes note that what it holds is not known; the
    /// reason where it cannot have one.
    pub(crate) fn assign(&mut self, name: &Name<'_>, held: Held) -> Result<(), &'static str> {
        match name {
            Name::Number(0) => return Err("#0 is always null"),
            Name::Number(number) if !self.fanuc() => {
                if *number > 5601 {
                    return Err("there are parameters up to #5601");
                }
                if let Ok(value) = held
                    && self.set_system_parameter(*number, value.unwrap_or(0.0))
                {
                    return Ok(());
                }
                if self.is_system_parameter(*number) {
                    return Err("it can only be read");
                }
            }
            Name::Number(number) if self.is_common(*number) => {}
            Name::Number(3000) => return Err("#3000 raises an alarm, which ends the program"),
            Name::Number(number @ 1000..) if !(3000..4000).contains(number) => {
                return Err("it belongs to the control, and may change offsets");
            }
            Name::Text(name) if self.named_parameter(name).is_some() || is_tool(name) => {
                return Err("it can only be read");
            }
            _ => {}
        }
        if self.parameters.set(name, held) {
            Ok(())
        } else {
            Err("there are more than 100000 of them")
        }
    }
}
