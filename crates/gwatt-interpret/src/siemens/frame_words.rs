//! The words of frames.
//!
//! "Coordinate transformations (frames)": TRANS and ATRANS shift, ROT and AROT
//! turn, SCALE and ASCALE stretch, MIRROR and AMIRROR mirror. The words without
//! an A delete all frames that the program has set before; alone they do only
//! that. Several angles of one block are turned about Z, the new Y, the new X
//! (RPY, the default).

use super::frame::{Frame, SPACE};
use super::reading::Reading;
use super::{Siemens, frame};
use crate::expression::{Grammar, Outcome};
use gwatt_machine::{AXES, AxisId, AxisSet, AxisValues};

/// What is said where tool lengths would matter.
pub(super) const NO_TOOLS: &str = "without a tool table the tool length is taken as 0";
/// Differences of places that are rounding.
const SAME_MM: f64 = 1e-9;

/// Values by axis, and an angle in the plane (RPL).
type FrameValues = ([Option<f64>; AXES], Option<f64>);

impl Reading<'_, '_, '_> {
    /// What stands after a word for the frame.
    fn frame_values(&mut self, name: &str, kind: &str) -> Outcome<FrameValues> {
        let mut values: [Option<f64>; AXES] = [None; AXES];
        let mut in_plane = None;
        while self.cursor.peek().is_some() {
            let from = self.cursor.at;
            let letter = self.cursor.name();
            if kind == "ROT" && letter == "RPL" {
                self.cursor.at += letter.len();
                self.cursor.expect(b'=')?;
                in_plane = Some(self.number()?);
                continue;
            }
            let first = letter.bytes().next().unwrap_or_default();
            self.cursor.at += usize::from(!letter.is_empty());
            let value = if self.cursor.take(b'=') {
                self.number()?
            } else {
                let negative = self.cursor.take(b'-');
                if !negative {
                    self.cursor.take(b'+');
                }
                let value = self.cursor.number()?;
                if negative { -value } else { value }
            };
            let axis = AxisId::from_letter(first).map(|axis| axis as usize);
            let slot = axis.and_then(|axis| values.get_mut(axis));
            match slot {
                Some(slot) if kind == "TRANS" || axis < Some(SPACE) => *slot = Some(value),
                _ => {
                    let message = format!("{name} with {letter}");
                    let help = "name the axes X, Y and Z, each with a value";
                    return Err(self.cursor.fault("frame", message, help, from));
                }
            }
        }
        Ok((values, in_plane))
    }

    pub(super) fn frame_word(&mut self, name: &str, start: usize) -> Outcome<()> {
        let (additive, kind) = match name.strip_prefix('A') {
            Some(kind) => (true, kind),
            None => (false, name),
        };
        let (values, in_plane) = self.frame_values(name, kind)?;
        let mut frame = if additive {
            self.state.frame.clone()
        } else {
            Frame::default()
        };
        match kind {
            "TRANS" => {
                if self.state.diameter && values[0].is_some() {
                    let message = "a shift of X where X words are diameters (DIAMON, DIAM90)";
                    let help = "write it under DIAMOF";
                    return Err(self.cursor.fault("frame", message, help, start));
                }
                let control = self.control;
                frame.translate(&std::array::from_fn(|axis| {
                    values[axis].unwrap_or(0.0) * control.unit_of(axis)
                }));
            }
            "ROT" => {
                for axis in [2, 1, 0] {
                    if let Some(angle) = values[axis] {
                        frame.rotate(axis, angle);
                    }
                }
                if let Some(angle) = in_plane {
                    frame.rotate(self.control.modal.plane[2], angle);
                }
            }
            "SCALE" => {
                let factors = [values[0], values[1], values[2]].map(|value| value.unwrap_or(1.0));
                if factors.iter().any(|factor| factor.abs() < 1e-6) {
                    let message = "a scale of 0";
                    let help = "write factors that are not 0";
                    return Err(self.cursor.fault("frame", message, help, start));
                }
                frame.scale(factors);
            }
            _ => {
                let mirror = |value: Option<f64>| if value.is_some() { -1.0 } else { 1.0 };
                frame.scale([values[0], values[1], values[2]].map(mirror));
            }
        }
        self.state.change_frame(frame, &self.control.position.at);
        Ok(())
    }
}

impl Siemens {
    /// Program coordinates of a place.
    pub(crate) fn program_place(&self, at: &AxisValues) -> AxisValues {
        let straight: AxisValues = std::array::from_fn(|axis| at[axis] - self.turns[axis]);
        self.frame.program(&straight)
    }

    /// Machine coordinates of program coordinates.
    pub(super) fn machine_place(&self, program: &AxisValues) -> AxisValues {
        let at = self.frame.machine(program);
        std::array::from_fn(|axis| at[axis] + self.turns[axis])
    }

    /// Where each axis counts from when it moves by increments: where it was in
    /// program coordinates, whatever frames have changed since (SD42440
    /// `FRAME_OFFSET_INCR_PROG` = 1, the default: the offset is traversed too).
    pub(super) fn increments_from(&self, at: &AxisValues) -> AxisValues {
        let mut from = self.program_place(at);
        for axis in self.adrift.iter() {
            from[axis] = self.local[axis];
        }
        from
    }

    pub(super) fn change_frame(&mut self, frame: Frame, at: &AxisValues) {
        self.local = self.increments_from(at);
        self.frame = frame;
        self.adrift = AxisSet::default();
        for (axis, place) in self.program_place(at).into_iter().enumerate() {
            if (place - self.local[axis]).abs() > SAME_MM {
                self.adrift.insert(axis);
            }
        }
    }

    /// Offsets that plain words get, where the frame is nothing more.
    pub(super) fn plain_shift(&self) -> Option<AxisValues> {
        let shift = std::array::from_fn(|axis| self.frame.shift[axis] + self.turns[axis]);
        self.frame.is_plain().then_some(shift)
    }
}

/// A vector in program coordinates of a plane, at an angle.
pub(super) fn at_angle(radius: f64, angle_deg: f64) -> [f64; 2] {
    let (sin, cos) = frame::sin_cos_deg(angle_deg);
    [radius * cos, radius * sin]
}
