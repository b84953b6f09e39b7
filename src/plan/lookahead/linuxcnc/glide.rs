//! Lines that are run at full speed from blend to blend.

use super::super::blend::{Corner, Leg, Rounded};
use super::super::element::Element;
use super::super::glide::{Line, LineStart, Passed};
use super::super::vector::dot;
use super::{CYCLES_MIN, LinuxCnc, TANGENTIAL_SHARE};

impl<T: Copy> LinuxCnc<T> {
    /// The element that waits and its start, if it is a plain line
    /// that is entered at this speed, squared.
    pub fn gliding(&self, speed2: f64) -> Option<(T, LineStart)> {
        let pending = self.pending.as_deref()?;
        let element = &pending.element;
        let speed = pending.target_speed();
        let plain = element.curve.is_none()
            && !pending.is_line
            && !pending.overlaps()
            && !pending.blended_before
            && !pending.rotates()
            && pending.entry2 == speed2
            && speed * speed == speed2
            && !self.joiner.holds();
        let start = LineStart {
            taken_mm: pending.from_mm,
            kink: pending.kink_before,
        };
        plain.then_some((element.tag, start))
    }

    /// As the rule passes a joint of two lines, where that slows nothing down.
    #[inline]
    pub fn passes(&self, before: &Line, next: &Line, speed_mm_s: f64) -> Option<Passed> {
        let cycle_mm = speed_mm_s * self.cycle_s;
        let shortest_mm = cycle_mm * CYCLES_MIN;
        let (u, w) = (before.direction, next.direction);
        if next.length_mm < cycle_mm || dot(u, w) <= 0.0 {
            return None;
        }
        let length_mm = before.length_mm - before.start.taken_mm;
        if let Some(share) = self.kink_share(u, next, speed_mm_s) {
            return (length_mm >= shortest_mm).then_some(Passed {
                own_mm: length_mm,
                accel_share: 1.0 - self.kink_ratio,
                next: LineStart {
                    taken_mm: 0.0,
                    kink: share,
                },
                ..Passed::default()
            });
        }
        let leg = |line: &Line, length_mm| Leg {
            tangent: line.direction,
            nominal_mm: line.length_mm,
            length_mm,
            max_speed: speed_mm_s,
            asked_speed: speed_mm_s,
            tolerance_mm: line.tolerance_mm,
        };
        let first = leg(before, length_mm);
        let second = leg(next, next.length_mm);
        let legs = [&first, &second];
        let blend = Rounded::shallow(legs, &self.axes, next.inverse_accel)
            .or_else(|| self.rounded(legs, next, speed_mm_s))?;
        let left_mm = length_mm - blend.trim;
        // What is too short to stand alone leads into the blend.
        let (own_mm, shared_mm) = if left_mm < self.gap_cycles * cycle_mm {
            (0.0, left_mm.max(0.0) + blend.length_mm)
        } else {
            (left_mm, blend.length_mm)
        };
        let long = shared_mm >= shortest_mm && (own_mm == 0.0 || own_mm >= shortest_mm);
        long.then_some(Passed {
            own_mm,
            shared_mm,
            curvature_per_mm: blend.curvature_per_mm,
            accel_share: TANGENTIAL_SHARE.min(1.0 - self.kink_ratio),
            next: LineStart {
                taken_mm: blend.trim,
                kink: 0.0,
            },
        })
    }

    /// The circle in any corner, where it slows nothing down.
    fn rounded(&self, legs: [&Leg; 2], next: &Line, speed_mm_s: f64) -> Option<Rounded> {
        let accel = self.axes.masked(next.axis_accel_mm_s2);
        let corner = Corner::of(legs[0].tangent, legs[1].tangent)?;
        let rounding = corner.round_lines(legs, &self.axes, accel)?;
        (rounding.speed >= speed_mm_s).then(|| Rounded::of(&rounding))
    }

    /// The share of an axis' acceleration that the step of velocity takes, if the
    /// corner is passed so.
    #[inline]
    fn kink_share(&self, u: [f64; 3], next: &Line, speed_mm_s: f64) -> Option<f64> {
        // What the axes permit along the path, as its inverse.
        let (mut steepest, mut largest) = (next.inverse_path_accel, 0.0);
        let w = next.direction;
        for ((u, w), inverse) in u.into_iter().zip(w).zip(next.inverse_accel) {
            let (part, change) = (w.abs() * inverse, (w - u).abs() * inverse);
            if part > steepest {
                steepest = part;
            }
            if change > largest {
                largest = change;
            }
        }
        let rate = speed_mm_s / self.cycle_s;
        // Where it plainly is not, that takes no division.
        if largest * (rate * steepest + 1.0) > 1.001 * self.kink_ratio * steepest {
            return None;
        }
        let share = largest * (rate + 1.0 / steepest);
        (share <= self.kink_ratio).then_some(share)
    }

    /// The motion has come to the start of this line at that speed, squared.
    pub fn glide_to(&mut self, element: &Element<T>, start: LineStart, speed2: f64) {
        self.spare = self.pending.take().or(self.spare.take());
        let mut pending = self.begin(element, element.tag, false);
        pending.trim(start.taken_mm, true);
        pending.kink_before = start.kink;
        pending.entry2 = speed2;
        self.pending = Some(pending);
        self.last_max2 = speed2;
    }
}
