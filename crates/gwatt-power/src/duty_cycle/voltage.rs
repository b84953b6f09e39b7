//! The voltage of a bus over time, as the limits over time have it.
//!
//! Input: what the capacitor lacks or holds in excess ([`Fill`]), move by move, and how long
//! each move lasts. Output: a [`VoltageCurve`], whose lowest or highest voltage is what the
//! rating has.

use super::filling::Fill;
use super::rating::Measure;

/// The lowest or the highest voltage that a bus may have, over time.
///
/// It is worked out as the limit is: at the largest overrides, with the capacitance less the
/// margin, and where the program runs again and again, of the runs after the first. The times
/// are those at 100 %.
#[derive(Debug, Clone, PartialEq)]
pub struct VoltageCurve {
    /// Which converter.
    pub converter: usize,
    /// [`Measure::LowestVoltage`] or [`Measure::HighestVoltage`].
    pub measure: Measure,
    /// What the converter keeps, V.
    pub nominal_v: f64,
    /// What is permitted, V.
    pub limit_v: f64,
    /// Each run leaves more than the one before: what is drawn is the first.
    pub endless: bool,
    /// In the order of time.
    pub spans: Vec<VoltageSpan>,
}

/// The worst voltage of some time, or that at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VoltageSpan {
    /// In s.
    pub from_s: f64,
    /// See `from_s`.
    pub to_s: f64,
    /// In V; infinite where a power may last for ever.
    pub volts: f64,
    /// A bound: how the control blends moves before it is not modelled.
    pub bound: bool,
}

impl VoltageCurve {
    /// The lowest voltage, or the highest.
    #[must_use]
    pub fn worst_v(&self) -> f64 {
        let volts = self.spans.iter().map(|span| span.volts);
        match self.measure {
            Measure::LowestVoltage => volts.fold(f64::INFINITY, f64::min),
            _ => volts.fold(0.0, f64::max),
        }
    }
}

/// The voltages of a store that begins with `carried_j`.
pub(super) fn spans(
    fills: &[Fill],
    carried_j: f64,
    volts: impl Fn(f64) -> f64,
) -> Vec<VoltageSpan> {
    // From the moment on at which the store has been empty both are alike.
    let held_j = |fill: &Fill| fill.held_j.max(carried_j + fill.net_j);
    let mut spans: Vec<VoltageSpan> = Vec::new();
    let mut last: Option<&Fill> = None;
    for fill in fills {
        if let Some(before) = last
            && let Some(time_s) = emptied_s(before, fill, carried_j)
        {
            push(
                &mut spans,
                VoltageSpan {
                    from_s: time_s,
                    to_s: time_s,
                    volts: volts(0.0),
                    bound: false,
                },
            );
        }
        push(
            &mut spans,
            VoltageSpan {
                from_s: fill.from_s,
                to_s: fill.to_s,
                volts: volts(held_j(fill)),
                bound: fill.lasting,
            },
        );
        last = Some(fill);
    }
    spans
}

/// When what the run before has left is gone, where that is between two instants of a store
/// which were empty without it.
fn emptied_s(before: &Fill, fill: &Fill, carried_j: f64) -> Option<f64> {
    let [from_j, to_j] = [before, fill].map(|it| carried_j + it.net_j);
    let empty = before.held_j <= 0.0 && fill.held_j <= 0.0;
    let crosses = from_j > 0.0 && to_j < 0.0 && fill.from_s > before.to_s;
    (empty && crosses).then(|| before.to_s + (fill.from_s - before.to_s) * from_j / (from_j - to_j))
}

/// Appends a span; a line that goes on as it is stays one.
fn push(spans: &mut Vec<VoltageSpan>, next: VoltageSpan) {
    if let [.., before, last] = spans.as_mut_slice()
        && before.volts.to_bits() == last.volts.to_bits()
        && last.volts.to_bits() == next.volts.to_bits()
        && [before.bound, next.bound] == [last.bound; 2]
    {
        last.to_s = next.to_s;
        return;
    }
    spans.push(next);
}
