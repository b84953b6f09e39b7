//! What converters bear over time, worked out of slices of the commanded power.
//!
//! * Overload: how long within any `every_s` more is drawn than the entry with the
//!   next lower power, or than `continuous_power_w`.
//! * Continuous power: the root of the mean square over the worst window, or over
//!   all of a shorter program.
//! * The capacitor: `½·C·U²` falls by what is drawn beyond the converter's limit,
//!   rises by what is fed back beyond `regen_power_w`, and comes back to nominal
//!   with what the converter has to spare.
//! * The braking resistor holds what is fed back beyond `brake_power_w`.

use gwatt::power::{Measure, Rating};

use super::judge::Slice;
use super::plant::{Converter, get};

/// The part of a slice in which a power that runs from `a` to `b` is above a limit.
fn part_above([a, b]: [f64; 2], limit: f64) -> f64 {
    match (a > limit, b > limit) {
        (true, true) => 1.0,
        (false, false) => 0.0,
        _ => (a.max(b) - limit) / (a - b).abs(),
    }
}

/// The largest sum of `values` within `window_s`, and how long all lasts.
fn windowed(slices: &[Slice], window_s: f64, value: impl Fn(&Slice) -> f64) -> [f64; 2] {
    let (mut worst, mut sum, mut lasts_s, mut total_s) = (0.0_f64, 0.0, 0.0, 0.0);
    let mut first = 0;
    for slice in slices {
        sum += value(slice);
        lasts_s += slice.0;
        total_s += slice.0;
        while lasts_s > window_s {
            sum -= value(&slices[first]);
            lasts_s -= slices[first].0;
            first += 1;
        }
        worst = worst.max(sum);
    }
    [worst, total_s]
}

/// The largest content of a store that `gain` fills or empties, never below 0.
fn store(slices: &[Slice], gain: impl Fn(&Slice) -> f64) -> f64 {
    let (mut content, mut worst) = (0.0_f64, 0.0_f64);
    for slice in slices {
        content = (content + gain(slice)).max(0.0);
        worst = worst.max(content);
    }
    worst
}

/// The value of a measure; to be compared with that of `Rating`. `share` is what
/// the margin leaves.
pub fn value(converter: &Converter, measure: Measure, slices: &[Slice], share: f64) -> f64 {
    let table = &converter.table;
    let drawn = |slice: &Slice| slice.1.map(|bus| bus.nominal_w.max(0.0));
    let fed = |slice: &Slice| slice.1.map(|bus| bus.nominal_fed_w);
    let mean = |[a, b]: [f64; 2]| 0.5 * (a + b);
    match measure {
        Measure::Overload {
            above_w, every_s, ..
        } => windowed(slices, every_s, |it| it.0 * part_above(drawn(it), above_w))[0],
        Measure::Continuous { window_s } => {
            let square = |it: &Slice| {
                let [a, b] = drawn(it);
                it.0 * (a * a + a * b + b * b) / 3.0
            };
            let [sum, total_s] = windowed(slices, window_s, square);
            (sum / window_s.min(total_s).max(1e-12)).sqrt()
        }
        Measure::LowestVoltage | Measure::HighestVoltage => {
            let nominal_v = get(table, "bus_nominal_v", 0.0);
            let farads = get(table, "capacitance_f", 0.0);
            let (sign, joules) = if measure == Measure::LowestVoltage {
                let beyond = |it: &Slice| it.0 * (mean(drawn(it)) - converter.limit_w);
                (-1.0, store(slices, beyond))
            } else {
                // With credit, what motors draw empties the capacitor.
                let signed = |it: &Slice| {
                    it.1.map(|bus| {
                        let drawn_w = if converter.credit { bus.nominal_w } else { 0.0 };
                        bus.nominal_fed_w - drawn_w.max(0.0)
                    })
                };
                let beyond = |it: &Slice| it.0 * (mean(signed(it)) - converter.regen_limit_w);
                (1.0, store(slices, beyond))
            };
            (nominal_v * nominal_v + sign * 2.0 * joules / farads)
                .max(0.0)
                .sqrt()
        }
        Measure::Brake { .. } => {
            let power_w = share * get(table, "brake_power_w", 0.0);
            store(slices, |it| it.0 * (mean(fed(it)) - power_w))
        }
    }
}

/// Whether a rating is at least as bad as the value says, by a share.
pub fn is_covered(rating: &Rating, value: f64, share: f64) -> bool {
    let slack = share * value.abs() + 1e-6;
    match rating.measure {
        Measure::LowestVoltage => rating.value <= value + slack,
        _ => rating.value >= value - slack,
    }
}
