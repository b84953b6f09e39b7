//! What a plain straight block depends on, and what it leaves after.
//!
//! A block that takes the short way (see `direct`) and changes neither motion
//! word nor feed reads no state but this one, and changes nothing but the place
//! where the axes stand. Where two interpreters agree in it, such a block does
//! the same in both.

use super::control::Control;
use super::execute::Interpreter;
use super::frame::Frame;
use super::knob::KnobState;
use super::modal::Modal;
use gwatt_machine::{AxisSet, AxisValues};

/// The state that a plain straight block depends on.
#[derive(Debug, Clone, PartialEq)]
pub struct FastPathState {
    /// A straight block may take the short way.
    direct: bool,
    modal: Modal,
    at: AxisValues,
    apart: AxisSet,
    frame: Frame,
    knobs: KnobState,
    loads: u32,
    run: u32,
    text: u16,
}

impl FastPathState {
    /// A plain block has moved the axes, machine coordinates in mm and degrees.
    pub fn move_to(&mut self, end: &AxisValues) {
        self.at = *end;
    }
}

impl Control<'_> {
    fn fast_path_state(&self) -> FastPathState {
        FastPathState {
            direct: self.may_go_direct(),
            modal: self.modal.clone(),
            at: self.position.at,
            apart: self.position.apart,
            frame: self.position.frame.clone(),
            knobs: self.knobs.clone(),
            loads: self.loads.on(),
            run: self.run,
            text: self.text,
        }
    }
}

impl Interpreter<'_> {
    /// What a plain block that comes next depends on.
    #[must_use]
    pub fn fast_path_state(&self) -> FastPathState {
        self.control.fast_path_state()
    }

    /// Whether a plain block does here what it does in this state.
    #[must_use]
    pub fn stands_as(&self, fast_path_state: &FastPathState) -> bool {
        self.control.fast_path_state() == *fast_path_state
    }

    /// Plain blocks that began in a state equal to this interpreter's have
    /// moved the axes to where `fast_path_state` has them.
    pub fn follow(&mut self, fast_path_state: &FastPathState) {
        self.control.begun = true;
        self.control.position.at = fast_path_state.at;
    }
}
