//! Judging moves with the voltage of the bus to be seen.

use super::assess::Assessor;
use super::assessment::Assessment;
use super::duty_cycle::{Lasts, VoltageCurve};
use gwatt_motion::{Move, MoveKind};

/// How long moves last that were judged, for the time axis of voltages.
#[derive(Debug, Default)]
pub struct Durations(Vec<Lasts>);

impl Durations {
    /// Takes a move that has been passed on.
    pub fn add(&mut self, mv: &Move, judged: &Assessment) {
        self.0.push(Lasts {
            duration_s: judged.duration_s,
            waits: mv.kind == MoveKind::Spindle,
        });
    }
}

impl Assessor<'_> {
    /// Keeps the voltages of the buses that have limits over time, on the time axis of the
    /// durations that are given with [`Self::lasting`]. To be called after
    /// [`Self::watching`].
    #[must_use]
    pub fn showing_voltage(mut self) -> Self {
        if let Some(watch) = &mut self.observer.watch {
            watch.show_voltage();
        }
        self
    }

    /// Takes how long the moves last that were passed on since the last call; to be called
    /// after each step, with all of them.
    pub fn lasting(&mut self, durations: &mut Durations) {
        if let Some(watch) = &mut self.observer.watch {
            watch.lasting(durations.0.drain(..));
        }
        durations.0.clear();
    }

    /// The voltages over time, after the end of the program; none where the machine limits
    /// none.
    #[must_use]
    pub fn voltages(&self) -> Vec<VoltageCurve> {
        let watch = self.observer.watch.as_ref();
        watch.map_or_else(Vec::new, |watch| watch.voltages())
    }
}
