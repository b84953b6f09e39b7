//! Arcs as controllers without arcs run them: chords of equal length.
//!
//! Input: an arc or a helix. Output: its chords, one after the other, as
//! straight elements under the same tag.

use super::element::{Curve, Element};
use gwatt_machine::{AxisValues, ChordRule};

/// Chords of one arc that are followed.
const CHORDS_MAX: f64 = 16_384.0;

/// How many chords `rule` makes of an arc of this length (mm) and radius at a feed.
#[must_use]
pub fn chord_count(rule: &ChordRule, curve: &Curve, feed_mm_s: f64) -> u32 {
    number(rule, curve, feed_mm_s).clamp(1.0, CHORDS_MAX) as u32
}

/// Whether an arc gets no more chords than are followed: that of hundreds of
/// metres, or of a turned digit, would have millions.
pub(super) fn is_followed<T>(rule: &ChordRule, arc: &Element<T>) -> bool {
    arc.curve
        .as_ref()
        .is_none_or(|curve| number(rule, curve, asked_mm_s(arc)) <= CHORDS_MAX)
}

/// The largest speed, squared, at which a lower feed makes more than so many chords.
fn finer_speed2(rule: &ChordRule, curve: &Curve, count: u32) -> Option<f64> {
    let flat_mm = curve.radius_mm * curve.sweep_rad.abs();
    let chord_mm = flat_mm / f64::from(count);
    let speed = rule.per_second * chord_mm;
    (rule.per_second > 0.0 && chord_mm > rule.min_mm).then_some(speed * speed)
}

/// The number of chords, without bounds.
fn number(rule: &ChordRule, curve: &Curve, feed_mm_s: f64) -> f64 {
    let r = curve.radius_mm;
    let flat_mm = r * curve.sweep_rad.abs();
    let mut chord_mm = rule.max_mm;
    if rule.deviation_mm < 2.0 * r {
        chord_mm = chord_mm.min(2.0 * (rule.deviation_mm * (2.0 * r - rule.deviation_mm)).sqrt());
    }
    if rule.per_second > 0.0 {
        chord_mm = chord_mm.min(feed_mm_s / rule.per_second);
    }
    let least = rule.per_circle * curve.sweep_rad.abs() / std::f64::consts::TAU;
    let count = (flat_mm / chord_mm.max(rule.min_mm)).max(least);
    let whole = count.floor();
    if rule.more_from < 1.0 && count > whole && count - whole >= rule.more_from {
        whole + 1.0
    } else {
        whole
    }
}

/// The speed that is asked for on an arc, mm/s: the controller divides it up by F, whatever
/// the axes permit.
fn asked_mm_s<T>(arc: &Element<T>) -> f64 {
    if arc.feed_mm_s < f64::INFINITY {
        arc.feed_mm_s
    } else {
        arc.speed_mm_s
    }
}

/// What lower overrides may make of a chord whose length follows the feed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Finer {
    /// The largest acceleration along shorter chords in its place, mm/s².
    pub accel_mm_s2: f64,
    /// The largest speed along them that the axes permit, mm/s.
    pub axes_mm_s: f64,
    /// The largest speed, squared, at which they may be run.
    pub speed2: f64,
    /// Where the arc heads at both ends, which the first and the last of them come closer to.
    pub tangents: [AxisValues; 2],
}

/// From what speed the rest of an arc is enough to stop, as Marlin has it: at a speed that
/// turning permits, with the smaller limits of the plane's axes.
#[derive(Debug, Clone, Copy)]
struct SafeExit {
    speed2: f64,
    accel_mm_s2: f64,
    flat_mm: f64,
}

impl SafeExit {
    fn of<T>(arc: &Element<T>, curve: &Curve) -> Self {
        let limits = curve.plane.map(|axis| arc.axis_accel_mm_s2.get(axis));
        let limits = limits.into_iter().flatten();
        let accel_mm_s2 = limits.fold(f64::INFINITY, |accel, limit| accel.min(*limit));
        let [first, second] = curve.axes_mm_s;
        let speed = asked_mm_s(arc).min(first).min(second);
        Self {
            speed2: (speed * speed).min(accel_mm_s2 * curve.radius_mm),
            accel_mm_s2,
            flat_mm: curve.radius_mm * curve.sweep_rad.abs(),
        }
    }

    /// The speed, squared, where this share of the arc is left.
    fn speed2(&self, left: f64) -> f64 {
        self.speed2
            .min(2.0 * self.accel_mm_s2 * self.flat_mm * left)
    }
}

/// The chords of an arc.
#[derive(Debug, Clone)]
pub(super) struct Chords<T> {
    /// The last one that was given.
    pub chord: Element<T>,
    arc_mm: f64,
    curve: Curve,
    count: u32,
    next: u32,
    /// In-plane directions of the start: along the path and to its side.
    along: [f64; 2],
    step_rad: f64,
    /// Length of a chord's share in the plane, and of the chord, by that of the
    /// arc's piece.
    shorter: f64,
    stretch: f64,
    /// Speed that the axes across the plane permit, mm/s.
    across_mm_s: f64,
    safe_exit: Option<SafeExit>,
    /// See [`Finer::speed2`]; nothing where lower overrides make the same chords.
    finer_speed2: Option<f64>,
    tangents: [AxisValues; 2],
}

impl<T: Copy> Chords<T> {
    /// The chords of an element that is an arc.
    pub fn of(rule: &ChordRule, arc: &Element<T>) -> Option<Self> {
        let curve = arc.curve?;
        let along = curve
            .plane
            .map(|axis| arc.start.get(axis).copied().unwrap_or(0.0));
        let count = chord_count(rule, &curve, asked_mm_s(arc));
        let step_rad = curve.sweep_rad * (1.0 / f64::from(count));
        // A chord is shorter than its piece of the arc.
        let half = 0.5 * step_rad.abs();
        let shorter = if half > 0.0 {
            libm::sin(half) / half
        } else {
            1.0
        };
        let [x, y] = along;
        let flat2 = (x * x + y * y).min(1.0);
        // Axes across the plane keep their travel: the direction turns a little.
        let stretch = (flat2 * shorter * shorter + (1.0 - flat2)).sqrt();
        let mut chord = *arc;
        chord.start = chord.start.map(|change| change / stretch);
        chord.end = chord.start;
        chord.curve = None;
        chord.curve_speed_mm_s = f64::INFINITY;
        chord.length_mm = arc.length_mm * (1.0 / f64::from(count)) * stretch;
        // What the arc leaves is less than what its axes permit.
        chord.jerk_mm_s3 = arc.jerk_mm_s3 * stretch;
        Some(Self {
            chord,
            arc_mm: arc.length_mm,
            curve,
            count,
            next: 0,
            along,
            step_rad,
            shorter,
            stretch,
            across_mm_s: curve.across_mm_s * stretch,
            safe_exit: rule.safe_exit.then(|| SafeExit::of(arc, &curve)),
            finer_speed2: finer_speed2(rule, &curve, count),
            tangents: [arc.start, arc.end],
        })
    }

    /// What lower overrides may make of the chord that was given last.
    ///
    /// A shorter one points to some direction of the arc between half a chord before this
    /// one and half a chord after it, and `a = min(aᵢ/|uᵢ|)` of that is no more than with the
    /// least |uᵢ| there, nor than √(a₁² + a₂²) of the axes of the plane in it.
    pub fn finer(&self) -> Option<Finer> {
        let speed2 = self.finer_speed2?;
        let chord = &self.chord;
        // Of an axis across the plane: its share of the arc.
        let mut least = chord.start.map(|part| part * self.stretch);
        let half = 0.5 * self.step_rad;
        let middle = (f64::from(self.next) - 0.5) * self.step_rad;
        let sweep = self.curve.sweep_rad;
        let ends = [middle - 2.0 * half, middle + 2.0 * half];
        let ends = ends.map(|end| end.clamp(sweep.min(0.0), sweep.max(0.0)));
        let [x, y] = self.along;
        let parts = ends.map(|angle| {
            let (sin, cos) = libm::sincos(angle);
            [x * cos - y * sin, x * sin + y * cos]
        });
        let turns = (ends[1] - ends[0]).abs() > std::f64::consts::FRAC_PI_2;
        let (mut limit2, mut axes_mm_s) = (0.0, self.across_mm_s);
        for (index, axis) in self.curve.plane.into_iter().enumerate() {
            let [a, b] = parts.map(|part| part[index]);
            let crosses = turns || a * b <= 0.0;
            let part = if crosses { 0.0 } else { a.abs().min(b.abs()) };
            let part = part * self.shorter / self.stretch;
            axes_mm_s = axes_mm_s.min(self.curve.axes_mm_s[index] / part);
            if let Some(least) = least.get_mut(axis) {
                *least = part;
            }
            let limit = chord.axis_accel_mm_s2.get(axis).copied();
            let limit = limit.unwrap_or(f64::INFINITY);
            limit2 += limit * limit;
        }
        let flat = (x * x + y * y).sqrt() * self.shorter / self.stretch;
        let limits = chord.axis_accel_mm_s2.iter().zip(&least);
        let moving = limits.filter(|(_, part)| **part != 0.0);
        let accel = moving.fold(limit2.sqrt() / flat, |accel, (limit, part)| {
            accel.min(limit / part.abs())
        });
        Some(Finer {
            accel_mm_s2: accel.min(chord.path_accel_mm_s2),
            axes_mm_s,
            speed2,
            tangents: self.tangents,
        })
    }

    /// The speed, squared, at which the one that was given last may be left while nothing
    /// waits after it.
    pub fn exit2(&self) -> f64 {
        let left = f64::from(self.count - self.next) / f64::from(self.count);
        self.safe_exit.map_or(0.0, |exit| exit.speed2(left))
    }

    /// Makes `chord` the next one; gives where it begins and ends on the arc, mm.
    pub fn advance(&mut self) -> Option<[f64; 2]> {
        if self.next == self.count {
            return None;
        }
        let i = f64::from(self.next);
        self.next += 1;
        // It points to where the tangent of its middle does.
        let (sin, cos) = libm::sincos((i + 0.5) * self.step_rad);
        let [x, y] = self.along;
        let flat = [x * cos - y * sin, x * sin + y * cos];
        let chord = &mut self.chord;
        for (axis, change) in self.curve.plane.into_iter().zip(flat) {
            let change = change * self.shorter / self.stretch;
            if let (Some(start), Some(end)) = (chord.start.get_mut(axis), chord.end.get_mut(axis)) {
                (*start, *end) = (change, change);
            }
        }
        chord.accel_mm_s2 = straight_accel(chord).min(chord.path_accel_mm_s2);
        let plane = self.curve.axes_mm_s.into_iter().zip(flat);
        chord.speed_mm_s = plane.fold(self.across_mm_s, |speed, (limit, change)| {
            speed.min(limit / (change * self.shorter / self.stretch).abs())
        });
        let share = 1.0 / f64::from(self.count);
        let at = |k: f64| self.arc_mm * (k * share);
        Some([at(i), at(i + 1.0)])
    }
}

/// What the axes permit along a straight direction.
fn straight_accel<T>(chord: &Element<T>) -> f64 {
    let limits = chord.axis_accel_mm_s2.iter().zip(&chord.start);
    let moving = limits.filter(|(_, change)| **change != 0.0);
    moving.fold(f64::INFINITY, |accel, (limit, change)| {
        accel.min(limit / change.abs())
    })
}
