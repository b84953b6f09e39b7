//! One bus and one direction of its power, by itself.

use super::limits::{Bus, Limits};
use super::rating::Place;
use crate::model::PowerModel;
use crate::trace::{Flow, Slice};
use gwatt_machine::Machine;

/// A bus whose lowest or highest voltage has a limit.
#[derive(Debug)]
pub(crate) struct ShownBus {
    converter: usize,
    flow: Flow,
    bus: Bus,
}

impl ShownBus {
    /// Those of a machine: by converter the lowest voltage, then the highest.
    pub fn list(machine: &Machine, model: &PowerModel) -> Vec<Self> {
        let margin = machine.limits.margin;
        let converters = machine.converters.iter().enumerate();
        let both = converters.flat_map(|(converter, it)| {
            let supply_w = model.limit_w(converter);
            let regen_w = model.regen_limit_w(converter);
            let drawn = Limits::drawn(it, margin, supply_w);
            let fed_back = Limits::fed_back(it, margin, regen_w);
            [(Flow::Drawn, drawn), (Flow::FedBack, fed_back)].map(|(flow, limits)| {
                let bus = limits.bus?;
                Some(Self {
                    converter,
                    flow,
                    bus,
                })
            })
        });
        both.flatten().collect()
    }

    pub fn converter(&self) -> usize {
        self.converter
    }

    /// Whether it is about what is drawn, and the lowest voltage.
    pub fn is_drawn(&self) -> bool {
        self.flow == Flow::Drawn
    }

    /// Takes what is drawn or fed back.
    pub fn take(&mut self, slice: &Slice) {
        if slice.duration_s > 0.0 {
            let store = &mut self.bus.store;
            store.take(slice, 0.0, Place::default(), &mut |_, _| {});
        }
    }

    /// The voltage now, V.
    pub fn volts(&self) -> f64 {
        self.bus.volts(self.bus.store.held_j())
    }
}
