//! The limits over time of one converter, for one direction of its power.

use super::super::trace::Slice;
use super::Span;
use super::continuous::Continuous;
use super::overload::Overload;
use super::rating::{Measure, Place, Rating};
use super::store::Store;
use gwatt_machine::{Capacitor, Converter};

/// What one direction of a converter's power is checked against.
#[derive(Debug, Default)]
pub(super) struct Limits {
    /// What the capacitor lacks, or holds in excess.
    pub(super) bus: Option<Bus>,
    /// Whether the capacitor takes peaks off the converter.
    buffered: bool,
    pub(super) overload: Vec<(Overload, Measure, f64)>,
    pub(super) continuous: Option<(Continuous, Measure, f64)>,
    pub(super) brake: Option<(Store, Measure, f64)>,
}

/// The capacitor as a store.
#[derive(Debug)]
pub(super) struct Bus {
    pub(super) store: Store,
    capacitor: Capacitor,
    /// Share of its energy that is counted on.
    share: f64,
    pub(super) measure: Measure,
    pub(super) limit_v: f64,
    /// Whether it is a limit, not only what takes peaks off the converter.
    rated: bool,
}

impl Limits {
    /// The limits of the power drawn.
    pub fn drawn(converter: &Converter, margin: f64, supply_w: f64) -> Self {
        let ratings = &converter.ratings;
        let share = 1.0 - margin;
        let continuous = ratings.continuous;
        let lasting_w = continuous.map_or(0.0, |continuous| continuous.power_w);
        let overload = ratings.overload.iter().map(|entry| {
            let lower = ratings.overload.iter().map(|other| other.power_w);
            let lower = lower.filter(|power| *power < entry.power_w);
            let above_w = share * lower.fold(lasting_w, f64::max);
            let measure = Measure::Overload {
                above_w,
                power_w: share * entry.power_w,
                every_s: entry.every_s,
            };
            let overload = Overload::new(above_w, entry.every_s);
            (overload, measure, entry.seconds)
        });
        let bus = ratings.capacitor.and_then(|capacitor| {
            Some(Bus {
                store: Store::new(supply_w),
                capacitor,
                share,
                measure: Measure::LowestVoltage,
                limit_v: capacitor.min_v?,
                rated: true,
            })
        });
        Self {
            buffered: ratings.credits_low(),
            bus,
            overload: overload.collect(),
            continuous: continuous.map(|continuous| {
                let window_s = continuous.window_s;
                let measure = Measure::Continuous { window_s };
                (
                    Continuous::new(window_s),
                    measure,
                    share * continuous.power_w,
                )
            }),
            brake: None,
        }
    }

    /// The limits of the power fed back.
    pub fn fed_back(converter: &Converter, margin: f64, regen_w: Option<f64>) -> Self {
        let ratings = &converter.ratings;
        let share = 1.0 - margin;
        let bus = ratings.capacitor.and_then(|capacitor| {
            Some(Bus {
                store: Store::new(regen_w?),
                capacitor,
                share,
                measure: Measure::HighestVoltage,
                limit_v: capacitor.max_v?,
                rated: true,
            })
        });
        let brake = ratings.brake.map(|brake| {
            let power_w = share * brake.power_w;
            let measure = Measure::Brake { power_w };
            (Store::new(power_w), measure, share * brake.energy_j)
        });
        Self {
            bus,
            brake,
            ..Self::default()
        }
    }

    /// Goes on with those that are `watched`, asked for in the order of [`Self::ratings`].
    pub fn only(&mut self, mut watched: impl FnMut() -> bool) {
        self.overload.retain(|_| watched());
        self.continuous = self.continuous.take().filter(|_| watched());
        if let Some(bus) = &mut self.bus {
            bus.rated = watched();
        }
        self.brake = self.brake.take().filter(|_| watched());
        let supplied = self.buffered && !(self.overload.is_empty() && self.continuous.is_none());
        self.bus = self.bus.take().filter(|bus| bus.rated || supplied);
    }

    pub fn is_empty(&self) -> bool {
        self.bus.is_none()
            && self.overload.is_empty()
            && self.continuous.is_none()
            && self.brake.is_none()
    }

    /// Takes a slice that begins at `time_s`.
    pub fn take(&mut self, slice: &Slice, time_s: f64, place: Place) {
        let Self {
            bus,
            buffered,
            overload,
            continuous,
            brake,
        } = self;
        let mut supplied = |slice: &Slice, time_s: f64| {
            for (overload, ..) in overload.iter_mut() {
                overload.take(slice, time_s, place);
            }
            if let Some((rms, ..)) = continuous {
                rms.take(slice, time_s, place);
            }
        };
        match bus {
            Some(bus) if *buffered => bus.store.take(slice, time_s, place, &mut supplied),
            Some(bus) => {
                bus.store.take(slice, time_s, place, &mut |_, _| {});
                supplied(slice, time_s);
            }
            None => supplied(slice, time_s),
        }
        if let Some((store, ..)) = brake {
            let mut now_s = time_s;
            for part in heating(slice) {
                store.take(&part, now_s, place, &mut |_, _| {});
                now_s += part.duration_s;
            }
        }
    }

    /// Whether nothing but stores of energy are limited.
    #[inline]
    pub fn only_stores(&self) -> bool {
        self.overload.is_empty() && self.continuous.is_none()
    }

    /// Up to this power nothing changes but means and the time, W.
    #[inline]
    pub fn calm_w(&self) -> f64 {
        let bus = self.bus.iter().map(|bus| bus.store.calm_w());
        let brake = self.brake.iter().map(|(store, ..)| store.calm_w());
        let overload = self.overload.iter().map(|(overload, ..)| overload.calm_w());
        bus.chain(brake)
            .chain(overload)
            .fold(f64::INFINITY, f64::min)
    }

    /// Time passes with so much energy, at a power of no account but to stores.
    #[inline]
    pub fn pass(&mut self, energy_j: f64, duration_s: f64) {
        if let Some(bus) = &mut self.bus {
            bus.store.pass(energy_j, duration_s);
        }
        if let Some((store, ..)) = &mut self.brake {
            store.pass(energy_j.max(0.0), duration_s);
        }
    }

    /// The same as [`Self::take`], of a slice that is nowhere above that power.
    #[inline]
    pub fn take_calm(&mut self, slice: &Slice, time_s: f64, place: Place) {
        if let Some(bus) = &mut self.bus {
            bus.store.pass(slice.energy_j(), slice.duration_s);
        }
        if let Some((store, ..)) = &mut self.brake {
            for part in heating(slice) {
                store.pass(part.energy_j(), part.duration_s);
            }
        }
        for (overload, ..) in &mut self.overload {
            overload.pass(slice.duration_s);
        }
        if let Some((rms, ..)) = &mut self.continuous {
            rms.take(slice, time_s, place);
        }
    }

    /// A power that lasts for a time that is not known.
    pub fn span(&mut self, power_w: f64, span: Span, time_s: f64, place: Place) {
        let mut supplied_w = power_w;
        if let Some(bus) = &mut self.bus {
            // While it charges again the converter gives all that it can.
            if self.buffered && !bus.store.is_empty() {
                supplied_w = super::super::demand::larger(power_w, bus.store.taken_w());
            }
            bus.store.span(power_w, span, time_s, place);
        }
        for (overload, ..) in &mut self.overload {
            overload.span(supplied_w, span, time_s, place);
        }
        if let Some((continuous, ..)) = &mut self.continuous {
            continuous.span(supplied_w, span, time_s, place);
        }
        if let Some((store, ..)) = &mut self.brake {
            store.span(power_w.max(0.0), span, time_s, place);
        }
    }

    /// What was found; where the program is `repeated`, over all of its runs.
    pub fn ratings(&self, converter: usize, repeated: bool) -> Vec<Rating> {
        let mut list = Vec::new();
        let lead_s = if repeated { self.lead_s() } else { 0.0 };
        for (overload, measure, limit) in &self.overload {
            let mut worst = if repeated {
                overload.repeated(lead_s)
            } else {
                overload.worst
            };
            worst.value += overload.edge_s;
            list.push(worst.rating(*measure, converter, *limit));
        }
        if let Some((rms, measure, limit)) = &self.continuous {
            let bus = self.bus.as_ref().filter(|_| lead_s > 0.0);
            let supply_w = bus.map_or(0.0, |bus| bus.store.taken_w());
            let worst = if repeated {
                rms.repeated(supply_w, lead_s)
            } else {
                rms.result()
            };
            list.push(worst.rating(*measure, converter, *limit));
        }
        let worst = |store: &Store| {
            let mut worst = if repeated {
                store.repeated()
            } else {
                store.worst
            };
            worst.value += store.edge_j;
            worst
        };
        if let Some(bus) = self.bus.as_ref().filter(|bus| bus.rated) {
            let mut worst = worst(&bus.store);
            worst.value = bus.volts(worst.value);
            list.push(worst.rating(bus.measure, converter, bus.limit_v));
        }
        if let Some((store, measure, limit)) = &self.brake {
            list.push(worst(store).rating(*measure, converter, *limit));
        }
        list
    }

    /// For how long at most a run begins with all that the converter gives, s: until
    /// the capacitor has back what the run before took from it last.
    fn lead_s(&self) -> f64 {
        let buffered = self.bus.as_ref().filter(|_| self.buffered);
        buffered.map_or(0.0, |bus| bus.store.refilled_s())
    }
}

impl Bus {
    /// Whether its voltage is a limit.
    pub fn is_rated(&self) -> bool {
        self.rated
    }

    /// What the converter keeps, V.
    pub fn nominal_v(&self) -> f64 {
        self.capacitor.nominal_v
    }

    /// The voltage at an energy off the nominal: `½·C·|V² − V_n²|`, V.
    pub fn volts(&self, energy_j: f64) -> f64 {
        let Capacitor {
            capacitance_f,
            nominal_v,
            ..
        } = self.capacitor;
        let squares = 2.0 * energy_j / (capacitance_f * self.share);
        match self.measure {
            Measure::LowestVoltage => (nominal_v * nominal_v - squares).max(0.0).sqrt(),
            _ => (nominal_v * nominal_v + squares).sqrt(),
        }
    }
}

/// A slice of what is fed back as a resistor sees it: what is drawn does not cool it.
fn heating(slice: &Slice) -> impl Iterator<Item = Slice> {
    let parts = slice.sides(0.0).into_iter();
    parts.map(|(part, above)| {
        if above {
            part
        } else {
            Slice::constant(part.duration_s, 0.0)
        }
    })
}
