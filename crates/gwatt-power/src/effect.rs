//! What an action does to the motion before it.
//!
//! Input: the controller's profile and actions in program order. Output: for
//! each, whether the motion stops there.

use gwatt_machine::{Controller, LaserMode, MESSAGE, QueueEffect};
use gwatt_motion::{Action, ActionKind};

/// What an action does to the motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effect {
    /// It goes on.
    None,
    /// It goes on; lines before and after the action are not put together.
    Part,
    /// It stops.
    Stop,
    /// One of the two.
    Unknown,
}

/// What is switched on by the actions so far, for words that do nothing when they change
/// nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Switched {
    /// M3, M4 or M5; S.
    spindle: u16,
    speed: f64,
    /// Bits of M7 and M8.
    coolant: u8,
    tool: f64,
    /// The work offsets, G54 to G59.3.
    system: u16,
}

impl Default for Switched {
    fn default() -> Self {
        Self {
            spindle: 50,
            speed: 0.0,
            coolant: 0,
            tool: 0.0,
            system: 540,
        }
    }
}

impl Switched {
    /// What an action does to the motion before it. Where the profile says
    /// nothing: spindle, tool change, stop and end wait for the axes. What others do is not
    /// known: a firmware may wait for the axes before it sets something.
    pub fn effect(&mut self, controller: &Controller, action: &Action) -> Effect {
        let number = (action.value * 10.0).round().clamp(0.0, 65_535.0) as u16;
        let letter = match action.kind {
            ActionKind::SpindleSpeed | ActionKind::SpeedInMotion => b'S',
            ActionKind::ToolSelect => b'T',
            ActionKind::Offset => b'G',
            ActionKind::Message => MESSAGE,
            ActionKind::PathMode | ActionKind::Feed => return Effect::Part,
            ActionKind::SpindleRpm
            | ActionKind::SurfaceSpeed
            | ActionKind::SpindleClamp
            | ActionKind::SpindleCenter
            | ActionKind::TapSpeed
            | ActionKind::ToolLoaded => return Effect::None,
            ActionKind::Stop | ActionKind::End | ActionKind::Rest => return Effect::Stop,
            ActionKind::ToolChangeInMotion
            | ActionKind::EarlyLimits(_)
            | ActionKind::MayStop
            | ActionKind::BeamMayStop => {
                return Effect::Unknown;
            }
            ActionKind::Other if number == 0 => return Effect::None,
            ActionKind::Spindle
            | ActionKind::ToolChange
            | ActionKind::Coolant
            | ActionKind::Other => b'M',
        };
        let number = match action.kind {
            ActionKind::Message => action.value as u16,
            _ => number,
        };
        let printer = controller.language.family.facts().printer;
        let changes = self.switch(action, number);
        match controller.queue.effect(letter, number) {
            Some(QueueEffect::Stop) => Effect::Stop,
            Some(QueueEffect::StopOnChange) if changes => {
                match (action.kind, controller.queue.laser_mode) {
                    (ActionKind::SpeedInMotion, LaserMode::On) => Effect::Part,
                    (ActionKind::SpeedInMotion, LaserMode::Unknown) => Effect::Unknown,
                    _ => Effect::Stop,
                }
            }
            Some(QueueEffect::Pass) => Effect::Part,
            Some(QueueEffect::Join | QueueEffect::StopOnChange) => Effect::None,
            None => match action.kind {
                ActionKind::Spindle | ActionKind::ToolChange => Effect::Stop,
                // A printer's T changes the tool.
                ActionKind::ToolSelect if printer && changes => Effect::Unknown,
                ActionKind::ToolSelect => Effect::None,
                ActionKind::SpindleSpeed | ActionKind::SpeedInMotion if printer => Effect::None,
                _ => Effect::Unknown,
            },
        }
    }

    /// Takes over what an action sets; false where that was in force.
    fn switch(&mut self, action: &Action, number: u16) -> bool {
        let before = *self;
        match (action.kind, number) {
            (ActionKind::Spindle, _) => self.spindle = number,
            // A spindle that stands still keeps the speed for later.
            (ActionKind::SpindleSpeed | ActionKind::SpeedInMotion, _) => {
                self.speed = action.value;
                return matches!(self.spindle, 30 | 40) && before != *self;
            }
            (ActionKind::Coolant, 70) => self.coolant |= 1,
            (ActionKind::Coolant, 80) => self.coolant |= 2,
            (ActionKind::Coolant, _) => self.coolant = 0,
            (ActionKind::ToolSelect, _) => {
                self.tool = action.value;
                return before.tool != action.value;
            }
            (ActionKind::Offset, 540..=593) => {
                self.system = number;
                return before.system != number;
            }
            _ => return true,
        }
        let at_rest = |spindle: u16| !matches!(spindle, 30 | 40);
        let still = at_rest(before.spindle) && at_rest(self.spindle);
        before.coolant != self.coolant || before.spindle != self.spindle && !still
    }
}
