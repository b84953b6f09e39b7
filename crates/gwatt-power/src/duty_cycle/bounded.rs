//! How the limits take the move that is at hand, where they are bounds.

use super::limits::Limits;
use super::rating::Place;
use super::span::Late;
use super::terms::Terms;
use crate::trace::Apart;

impl Limits {
    /// A move begins.
    pub fn begin(&mut self, terms: &Terms, time_s: f64, place: Place) {
        for (overload, ..) in &mut self.overload {
            overload.begin(terms, time_s, place);
        }
        if let Some((continuous, ..)) = &mut self.continuous {
            continuous.begin(terms, time_s, place);
        }
        let bus = self.bus.iter_mut().map(|bus| &mut bus.store);
        let brake = self.brake.iter_mut().map(|(store, ..)| store);
        for store in bus.chain(brake) {
            store.begin(terms, time_s, place);
        }
    }

    /// It ends.
    pub fn end(&mut self, terms: &Terms, time_s: f64, place: Place) {
        for (overload, ..) in &mut self.overload {
            overload.end(terms, time_s, place);
        }
        if let Some((continuous, ..)) = &mut self.continuous {
            continuous.end(terms, time_s, place);
        }
        let bus = self.bus.iter_mut().map(|bus| &mut bus.store);
        let brake = self.brake.iter_mut().map(|(store, ..)| store);
        for store in bus.chain(brake) {
            store.end(terms, time_s, place);
        }
    }

    /// At the end of a move what may come when it is over at the largest overrides.
    pub fn late(&mut self, late: &Late, time_s: f64, place: Place) {
        for (overload, ..) in &mut self.overload {
            overload.late(late, time_s, place);
        }
        if let Some((continuous, ..)) = &mut self.continuous {
            continuous.late(late, time_s, place);
        }
        let bus = self.bus.iter_mut().map(|bus| &mut bus.store);
        let brake = self.brake.iter_mut().map(|(store, ..)| store);
        for store in bus.chain(brake) {
            store.late(&late.slice, time_s, place);
        }
    }

    /// A move whose axes run for themselves, after [`Self::begin`].
    pub fn apart(&mut self, apart: &Apart, rest_w: f64, time_s: f64, place: Place) {
        for (overload, ..) in &mut self.overload {
            overload.apart(apart, rest_w, time_s, place);
        }
        if let Some((continuous, ..)) = &mut self.continuous {
            continuous.apart(apart, rest_w, time_s, place);
        }
        let bus = self.bus.iter_mut().map(|bus| &mut bus.store);
        let brake = self.brake.iter_mut().map(|(store, ..)| store);
        for store in bus.chain(brake) {
            store.apart(apart, rest_w, time_s, place);
        }
    }
}
