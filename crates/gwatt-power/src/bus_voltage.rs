//! The voltage of the bus next to a motion that is shown instant by instant.
//!
//! Input: what each converter draws and is fed back, from instant to instant. Output: the
//! lowest and the highest voltage that its bus may have, as planned at 100 %, in a run that
//! begins at the nominal voltage.

use super::duty_cycle::ShownBus;
use super::instant::Instant;
use super::model::PowerModel;
use super::trace::Slice;
use gwatt_machine::Machine;

/// The buses of a machine whose voltages have limits.
#[derive(Debug)]
pub struct BusVoltages(Vec<ShownBus>);

impl BusVoltages {
    /// At their nominal voltages; `None` where the machine file limits none.
    #[must_use]
    pub fn new(machine: &Machine, model: &PowerModel) -> Option<Self> {
        let list = ShownBus::list(machine, model);
        (!list.is_empty()).then_some(Self(list))
    }

    /// Time passes between two instants, in which powers change evenly.
    pub fn pass(&mut self, duration_s: f64, from: &Instant, to: &Instant) {
        for bus in &mut self.0 {
            let powers = |instant: &Instant| {
                let list = if bus.is_drawn() {
                    &instant.bus_w
                } else {
                    &instant.regen_w
                };
                list.get(bus.converter()).copied().unwrap_or(0.0)
            };
            let [from_w, to_w] = [from, to].map(powers);
            bus.take(&Slice::linear(duration_s, from_w, to_w));
        }
    }

    /// Puts the voltages into an instant.
    pub fn show(&self, instant: &mut Instant) {
        instant.volts.clear();
        instant.volts.extend(self.0.iter().map(ShownBus::volts));
    }

    /// What is shown: the converter of each, and whether it is the lowest voltage.
    pub fn names(&self) -> impl Iterator<Item = (usize, bool)> {
        self.0.iter().map(|bus| (bus.converter(), bus.is_drawn()))
    }
}
