//! What judging moves has to do with the spindle.

use super::SpindleBus;
use crate::{Assessment, Assessor};
use gwatt_motion::{Move, Start};

impl Assessor<'_> {
    /// The same for a program that begins from there: where the axes are not
    /// known, nothing is known of the spindle either.
    #[must_use]
    pub fn starting(mut self, start: Start) -> Self {
        if start == Start::Unknown {
            let overrides = [self.largest, self.nominal];
            self.bus = SpindleBus::new(self.machine, overrides, true).map(Box::new);
            self.watch_spindle();
        }
        self
    }

    /// Has the spindle report what it draws, where that is watched over time.
    pub(crate) fn watch_spindle(&mut self) {
        let watch = self.observer.watch.as_ref();
        if let Some(bus) = &mut self.bus {
            bus.spindle_loads = watch
                .filter(|watch| watch.follows_spindle())
                .map(|_| Vec::new());
        }
    }

    /// Takes the next move where the machine has a spindle.
    pub(crate) fn push_beside_spindle(
        &mut self,
        mv: &Move,
        text: &[u8],
        sink: &mut impl FnMut(&Move, &Assessment, &[u8]),
    ) {
        let Some(mut bus) = self.bus.take() else {
            return;
        };
        bus.push();
        let want = self.want;
        self.want = bus.want(want);
        self.push_axes(mv, text, &mut |mv, judged, text| {
            bus.take(mv, judged, text, want, sink);
        });
        self.want = want;
        self.observer
            .spindle_loads(&self.model, &mut bus.spindle_loads);
        self.bus = Some(bus);
    }
}
