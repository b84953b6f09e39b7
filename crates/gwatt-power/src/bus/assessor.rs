//! What judging moves has to do with the spindle.

use super::SpindleBus;
use crate::{Assessment, Assessor};
use gwatt_motion::{Move, Start};

impl<'m> Assessor<'m> {
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
        let bus = self.judge_with_spindle(bus, sink, |axes, mut sink| {
            axes.push_axes(mv, text, &mut sink);
        });
        self.bus = Some(bus);
    }

    /// Has the axes judge what they can, and passes it on with the spindle in it. Whatever lets
    /// moves go: their peaks count as closely as the sum needs.
    pub(crate) fn judge_with_spindle(
        &mut self,
        mut bus: Box<SpindleBus<'m>>,
        sink: &mut impl FnMut(&Move, &Assessment, &[u8]),
        judge: impl FnOnce(&mut Self, &mut dyn FnMut(&Move, &Assessment, &[u8])),
    ) -> Box<SpindleBus<'m>> {
        let want = self.want;
        self.want = bus.want(want);
        judge(self, &mut |mv, judged, text| {
            bus.take(mv, judged, text, want, sink);
        });
        self.want = want;
        self.observer
            .spindle_loads(&self.model, &mut bus.spindle_loads);
        bus
    }
}
