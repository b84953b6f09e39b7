//! Numbered parameters that the control itself keeps ("Parameters" of
//! `LinuxCNC`, 5061 to 5428): offsets, the loaded tool, the place.
//!
//! Offsets and tools are in the machine's unit, places in the program's.

use super::control::Control;
use super::offsets::{FIRST, LAST, PARAMETER_AXES};
use crate::rules::Macros;

/// Coordinates and success of the last probing.
pub(super) const PROBE_FIRST: u32 = 5061;
pub(super) const PROBE_LAST: u32 = 5070;
/// Result of M66.
const INPUT: u32 = 5399;
/// The loaded tool: number, offsets, diameter, angles, orientation.
const TOOL_FIRST: u32 = 5400;
const TOOL_LAST: u32 = 5413;
/// Where the axes stand.
const PLACE_FIRST: u32 = 5420;
const PLACE_LAST: u32 = 5428;

impl Control<'_> {
    /// Whether a number is one of these parameters, known or not.
    pub(super) fn is_system_parameter(&self, number: u32) -> bool {
        self.rules.macros == Macros::OWords
            && matches!(
                number,
                PROBE_FIRST..=PROBE_LAST
                    | FIRST..=LAST
                    | INPUT
                    | TOOL_FIRST..=TOOL_LAST
                    | PLACE_FIRST..=PLACE_LAST
            )
    }

    /// Its value; `None` if it is no such parameter, and if its value is known
    /// only while the program runs.
    pub(super) fn system_parameter(&self, number: u32) -> Option<f64> {
        if !self.is_system_parameter(number) {
            return None;
        }
        let after = |first: u32| (number - first) as usize;
        match number {
            PROBE_FIRST..=PROBE_LAST => self.probe.value(after(PROBE_FIRST)),
            FIRST..=LAST => self.position.offsets().known(number),
            INPUT => self.input,
            TOOL_FIRST..=TOOL_LAST => self.tool_parameter(after(TOOL_FIRST)),
            _ => self.place(after(PLACE_FIRST)),
        }
    }

    /// Assigns one of them; false for those that only the control sets
    /// ("Cannot assign to read-only parameter"), and for all other numbers.
    ///
    /// An assigned offset takes effect when its system is selected again.
    pub(super) fn set_system_parameter(&mut self, number: u32, value: f64) -> bool {
        if !self.is_system_parameter(number) {
            return false;
        }
        match number {
            PROBE_FIRST..=PROBE_LAST => {
                self.probe.set((number - PROBE_FIRST) as usize, value);
                true
            }
            FIRST..=LAST => self
                .position
                .change(|offsets| offsets.set_stored(number, value)),
            _ => false,
        }
    }

    /// Takes over one that was given before the program runs; offsets are in
    /// [`Offsets`](super::offsets::Offsets) already.
    pub(super) fn give_system_parameter(&mut self, number: u32, value: f64) {
        match number {
            PROBE_FIRST..=PROBE_LAST => {
                self.probe.set((number - PROBE_FIRST) as usize, value);
            }
            INPUT => self.input = Some(value),
            TOOL_FIRST => self.tools.give(value),
            _ => {}
        }
    }

    /// Place of an axis in machine coordinates, in units of the program.
    pub(super) fn place_in_machine(&self, axis: usize) -> Option<f64> {
        // Offsets that nobody has given are 0 here, as they are in all machine coordinates.
        if self.position.unknown.contains(axis) {
            return None;
        }
        Some(self.in_unit(axis, *self.position.at.get(axis)?))
    }

    /// Place of an axis in program coordinates and units.
    pub(super) fn place(&self, axis: usize) -> Option<f64> {
        let frame = &self.position.frame;
        let unknown = self.position.unknown;
        if unknown.iter().any(|by| frame.depends(by, axis)) || self.coordinate_unknown(axis) {
            return None;
        }
        Some(self.in_unit(axis, *self.position.program().get(axis)?))
    }

    /// Millimetres in units of the program; degrees stay degrees.
    pub(super) fn in_unit(&self, axis: usize, value: f64) -> f64 {
        if self.position.offsets().is_linear(axis) {
            value / self.modal.mm_per_unit
        } else {
            value
        }
    }

    fn tool_parameter(&self, index: usize) -> Option<f64> {
        let number = self.tools.loaded_known()?;
        if index == 0 {
            return Some(f64::from(number));
        }
        let tool = self.tools.find(number)?;
        Some(match index {
            1..=PARAMETER_AXES => tool.offsets.get(index - 1).copied()?,
            10 => tool.diameter,
            11 => tool.front_angle,
            12 => tool.back_angle,
            _ => f64::from(tool.orientation),
        })
    }
}
