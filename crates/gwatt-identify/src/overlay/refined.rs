//! Where the program lies in the log, to a part of a sample, and for how long the meter averages.

use super::align::Place;
use super::curve::Curve;
use super::meter::{INSTANT, correlation, shown};
use super::trace::PowerTrace;

/// Samples of a meter that are averaged over, and by which share of what is missing to 1 the
/// correlation must be better for it to count.
const AVERAGED: [f64; 10] = [1.0, 1.5, 2.0, 3.0, 5.0, 8.0, 12.0, 20.0, 35.0, 60.0];
const WORTH: f64 = 0.03;
/// Shifts that are tried with each, in samples.
const SHIFTS: [f64; 8] = [-1.0, -0.75, -0.5, -0.25, 0.25, 0.5, 0.75, 1.0];
/// Steps from one place to a better one, in samples: from, to, and how many of a size at most.
const STEPS: [f64; 2] = [1.0, 1.0 / 1024.0];
const STEPS_MAX: usize = 12;
/// Samples that are compared, in so many pieces of the log where it has more.
const SAMPLES: usize = 200_000;
const PIECES: usize = 200;

/// The samples that are compared.
struct Part<'a> {
    curve: &'a Curve,
    time_s: Vec<f64>,
    power_w: Vec<f64>,
    step_s: f64,
}

/// A place, and for how long the meter averages.
#[derive(Clone, Copy)]
struct Found {
    place: Place,
    averaging_s: f64,
    correlation: f64,
}

impl<'a> Part<'a> {
    fn of(curve: &'a Curve, log: &PowerTrace) -> Self {
        let count = log.time_s.len();
        let is_compared = |k: usize| {
            let piece = (count / PIECES).max(1);
            count <= SAMPLES || k % piece < SAMPLES / PIECES
        };
        let of = |values: &[f64]| {
            let all = values.iter().enumerate();
            let compared = all.filter(|(k, _)| is_compared(*k));
            compared.map(|(_, value)| *value).collect()
        };
        Self {
            curve,
            time_s: of(&log.time_s),
            power_w: of(&log.power_w),
            step_s: log.step_s(),
        }
    }

    fn judged(&self, from: Place, ends_s: [f64; 2], averaging_s: f64) -> Found {
        let place = Place {
            start_s: from.start_s + ends_s[0],
            end_s: from.end_s + ends_s[1],
            ..from
        };
        let width_s = averaging_s.max(self.step_s * INSTANT);
        let shown = shown(self.curve, &self.time_s, place, width_s);
        Found {
            place,
            averaging_s,
            correlation: correlation(&self.power_w, &shown),
        }
    }

    /// The best of a few shifts by less than a sample, each way. What a meter that averages shows
    /// comes half of that late.
    fn best_of(&self, place: Place, averaging_s: f64) -> Found {
        let late_s = averaging_s / 2.0;
        let at = |shift: f64| {
            let by = shift * self.step_s - late_s;
            self.judged(place, [by, by], averaging_s)
        };
        SHIFTS.into_iter().map(at).fold(at(0.0), better)
    }

    /// Goes to better ones: begins and ends earlier or later, and averages over less or more.
    fn climb(&self, found: Found) -> Found {
        let mut best = found;
        let mut step = STEPS[0];
        while step >= STEPS[1] {
            for _ in 0..STEPS_MAX {
                let by = step * self.step_s;
                let mut near = best;
                for ends in [[1.0, 1.0], [1.0, 0.0], [0.0, 1.0], [1.0, -1.0]] {
                    for by in [by, -by] {
                        let ends = ends.map(|end| end * by);
                        near = better(near, self.judged(best.place, ends, best.averaging_s));
                    }
                }
                if best.averaging_s > 0.0 {
                    for by in [by, -by]
                        .into_iter()
                        .filter(|by| best.averaging_s + by > 0.0)
                    {
                        // Later by half of what it averages over more, or not.
                        for ends in [[-by / 2.0; 2], [0.0; 2]] {
                            let wider = best.averaging_s + by;
                            near = better(near, self.judged(best.place, ends, wider));
                        }
                    }
                }
                if near.correlation <= best.correlation {
                    break;
                }
                best = near;
            }
            step /= 2.0;
        }
        best
    }
}

fn better(best: Found, it: Found) -> Found {
    if it.correlation > best.correlation {
        it
    } else {
        best
    }
}

/// The place to a part of a sample, with how long the meter averages.
pub(super) fn refined(curve: &Curve, log: &PowerTrace, place: Place) -> (Place, f64) {
    let part = Part::of(curve, log);
    let instant = part.climb(part.best_of(place, 0.0));
    let place = instant.place;
    let mut best = instant;
    let mut worse = 0;
    for samples in AVERAGED {
        let averaging_s = samples * part.step_s;
        if averaging_s > place.pace(curve) * curve.duration_s() / 10.0 || worse > 2 {
            break;
        }
        let found = part.best_of(place, averaging_s);
        if found.correlation > best.correlation + WORTH * (1.0 - best.correlation) {
            best = found;
            worse = 0;
        } else {
            worse += 1;
        }
    }
    if best.averaging_s > 0.0 {
        best = part.climb(best);
    }
    (best.place, best.averaging_s)
}
