//! Means over a window of moves of which some have no timing that is known, and of bounds
//! over lower overrides.

use super::super::demand::larger;
use super::super::trace::{Apart, Slice};
use super::Span;
use super::rating::{Place, Worst};
use super::rms::Rms;
use super::span::Late;
use super::terms::Terms;

/// The mean over windows, bounded in two ways where the timing of moves is not
/// known: such a move counts as if it lasted for ever, or with the square of its
/// power over its longest time in place of its shortest. The lower bound holds.
#[derive(Debug, Clone)]
pub(super) struct Continuous {
    lasting: Rms,
    /// From the first such move on.
    dense: Option<Rms>,
    /// The largest power so far, which no mean exceeds, W.
    most_w: f64,
}

impl Continuous {
    pub fn new(window_s: f64) -> Self {
        Self {
            lasting: Rms::new(window_s),
            dense: None,
            most_w: 0.0,
        }
    }

    pub fn take(&mut self, slice: &Slice, time_s: f64, place: Place) {
        self.most_w = larger(self.most_w, slice.peak_w());
        self.lasting.take(slice, time_s, place);
        if let Some(dense) = &mut self.dense {
            dense.take(slice, time_s, place);
        }
    }

    /// A power that lasts for a time that is not known.
    pub fn span(&mut self, power_w: f64, span: Span, time_s: f64, place: Place) {
        self.most_w = larger(self.most_w, power_w);
        let dense = self.dense.get_or_insert_with(|| self.lasting.clone());
        dense.burst(power_w, span, time_s, place);
        self.lasting.last(power_w, time_s, place);
    }

    /// Both ways, where this is a bound: see [`Terms`](super::terms::Terms).
    fn ways(&mut self) -> impl Iterator<Item = &mut Rms> {
        std::iter::once(&mut self.lasting).chain(&mut self.dense)
    }

    /// A move begins.
    pub fn begin(&mut self, terms: &Terms, time_s: f64, place: Place) {
        let rest_w = terms.rest_w;
        self.most_w = larger(self.most_w, rest_w);
        for rms in self.ways() {
            if terms.least_share > 0.0 {
                rms.begin(rest_w, terms.longest_ratio());
            } else {
                rms.rest(rest_w, time_s, place);
            }
        }
    }

    /// It ends.
    pub fn end(&mut self, terms: &Terms, time_s: f64, place: Place) {
        for rms in self.ways() {
            rms.end();
        }
        if terms.surge_s > 0.0 {
            self.surge(terms.surge_w, terms.surge_s, time_s, place);
        }
    }

    /// A power that comes in addition.
    fn surge(&mut self, power_w: f64, duration_s: f64, time_s: f64, place: Place) {
        self.most_w = larger(self.most_w, power_w);
        for rms in self.ways() {
            let square = rms.beyond(power_w) * duration_s;
            rms.come(square, time_s, place);
        }
    }

    /// What may come after a move.
    pub fn late(&mut self, late: &Late, time_s: f64, place: Place) {
        let most_w = late.slice.peak_w();
        self.most_w = larger(self.most_w, most_w);
        for rms in self.ways() {
            let more = if late.slower { rms.own_more() } else { 0.0 };
            let square = (rms.beyond(most_w) + more) * late.slice.duration_s;
            rms.come(square, time_s, place);
        }
    }

    /// Axes that run for themselves: their work at no more than their largest power.
    pub fn apart(&mut self, apart: &Apart, rest_w: f64, time_s: f64, place: Place) {
        let Apart {
            most_w,
            work_j,
            duration_s,
        } = *apart;
        if duration_s <= 0.0 {
            return;
        }
        self.most_w = larger(self.most_w, rest_w + most_w);
        for rms in self.ways() {
            let at_most_s = if most_w > 0.0 { work_j / most_w } else { 0.0 };
            let square = rms.beyond(rest_w + most_w) * at_most_s;
            rms.blur(square);
            let floor2 = rms.floor_w() * rms.floor_w();
            let even_w = (floor2 + square / duration_s).sqrt();
            rms.take(&Slice::constant(duration_s, even_w), time_s, place);
        }
    }

    /// The worst mean as its root, in W.
    pub fn result(&self) -> Worst {
        self.least(self.most_w, Rms::result)
    }

    /// The same over all runs, where the program runs again and again; each begins with a
    /// power for so long in addition, W and s.
    pub fn repeated(&self, lead_w: f64, lead_s: f64) -> Worst {
        self.least(larger(self.most_w, lead_w), |rms| {
            rms.repeated(lead_w * lead_w * lead_s)
        })
    }

    fn least(&self, most_w: f64, of: impl Fn(&Rms) -> Worst) -> Worst {
        let of = |rms: &Rms| rms.with_edge(of(rms));
        let lasting = of(&self.lasting);
        let dense = self.dense.as_ref().map(of);
        let mut least = dense
            .filter(|dense| dense.value < lasting.value)
            .unwrap_or(lasting);
        least.value = least.value.min(most_w);
        least
    }
}
