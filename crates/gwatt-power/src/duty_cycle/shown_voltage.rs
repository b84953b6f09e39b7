//! Watching converters with the voltages of their buses to be seen.

use super::DutyCycle;
use super::filling::Filling;
use super::recorded::Recorded;
use super::track::Track;
use super::voltage::{VoltageCurve, spans};
use super::voltage_trace::{Lasts, Stretch, VoltageTrace};

impl DutyCycle {
    /// Keeps what capacitors lack or hold in excess, to be seen in [`Self::voltages`].
    pub fn show_voltage(&mut self) {
        let tracks = self.tracks.iter_mut().filter(|track| !track.bounds);
        let buses = tracks.filter_map(|track| track.limits.bus.as_mut());
        let mut count = 0;
        for bus in buses.filter(|bus| bus.is_rated()) {
            bus.store.recorded = Some(Box::new(Recorded::new()));
            count += 1;
        }
        self.voltage = (count > 0).then(|| Box::new(VoltageTrace::new(count)));
    }

    /// A move has been taken by all tracks.
    pub(super) fn end_stretch(&mut self, stretch: Stretch) {
        let Some(trace) = &mut self.voltage else {
            return;
        };
        let buses = self.tracks.iter_mut();
        let buses = buses.filter_map(|track| track.limits.bus.as_mut());
        let recorded = buses.filter_map(|bus| bus.store.recorded.as_mut());
        trace.push(stretch, recorded.map(|recorded| recorded.end()).collect());
    }

    /// What was judged since lasts so long, in the order of the program.
    pub fn lasting(&mut self, lasts: impl Iterator<Item = Lasts>) {
        if let Some(trace) = &mut self.voltage {
            trace.lasting(lasts);
        }
    }

    /// The voltages of all buses that have a limit, after the end of the program.
    pub fn voltages(&self) -> Vec<VoltageCurve> {
        let recorded = |track: &'_ &Track| {
            let bus = track.limits.bus.as_ref();
            bus.is_some_and(|bus| bus.store.recorded.is_some())
        };
        let tracks = self.tracks.iter().filter(recorded);
        let curves = self.voltage.iter().flat_map(|trace| trace.curves());
        let curve = |(track, filling): (&Track, &Filling)| {
            let bus = track.limits.bus.as_ref()?;
            let carried_j = if self.repeated {
                bus.store.carried_j()
            } else {
                0.0
            };
            let endless = carried_j == f64::INFINITY;
            let carried_j = if endless { 0.0 } else { carried_j };
            Some(VoltageCurve {
                converter: track.converter,
                measure: bus.measure,
                nominal_v: bus.nominal_v(),
                limit_v: bus.limit_v,
                endless,
                spans: spans(filling.list(), carried_j, |energy_j| bus.volts(energy_j)),
            })
        };
        tracks.zip(curves).filter_map(curve).collect()
    }
}
