//! Cycles of four moves: G90, G92 and G94 of system A, G77, G78 and G79 of
//! system B ("Outer Diameter/Internal Diameter Cutting Cycle (G90)", "Thread
//! Cutting Cycle (G92)", "End Face Turning Cycle (G94)").

use super::words::{note_parameter, turning_needs};
use super::{BOX, FACE, Held, THREAD_BOX, X, Z, xz};
use crate::control::{Control, Run};
use gwatt_motion::MoveKind::{Feed, Rapid};

impl Control<'_> {
    pub(super) fn single_cycle(&mut self, number: u16, run: &mut Run<'_, '_>) {
        if self.special.active != number {
            self.turning.held = Held::default();
            self.special.active = number;
        }
        let x = self.take_target(X, run);
        let z = self.take_target(Z, run);
        let taper = self.plain_length(b'R', run);
        let held = &mut self.turning.held;
        held.x = x.or(held.x);
        held.z = z.or(held.z);
        held.taper = taper.unwrap_or(held.taper);
        let (Some(x), Some(z)) = (held.x, held.z) else {
            let number = run.words.g.first().map_or(number, |(_, number, _)| *number);
            turning_needs("X and Z", number, run);
            return;
        };
        let taper = held.taper;
        let at = self.position.at;
        let (x0, z0) = (at[X], at[Z]);
        let corners = if number == FACE {
            [(x0, z + taper), (x, z), (x, z0)]
        } else {
            [(x + taper, z0), (x, z), (x0, z)]
        };
        let [first, second, third] = corners.map(|(x, z)| xz(at, x, z));
        self.part(run, Rapid, &first);
        match number {
            THREAD_BOX => {
                let Some(lead_mm) = self.lead(run) else {
                    return;
                };
                note_parameter(run);
                self.thread_to(&second, lead_mm, run);
                self.part(run, Rapid, &third);
            }
            BOX | FACE => {
                self.part(run, Feed, &second);
                self.part(run, Feed, &third);
            }
            _ => {}
        }
        self.part(run, Rapid, &at);
    }
}
