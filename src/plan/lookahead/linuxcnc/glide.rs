//! Lines that are run at full speed from blend to blend.

use super::super::blend::{Leg, between_lines};
use super::super::element::{Element, Joint};
use super::super::glide::{Line, LineStart, Passed};
use super::super::pending::Pending;
use super::super::vector::{dot, scale, sub};
use super::{CYCLES_MIN, LinuxCnc, TANGENTIAL_SHARE, share_of};

impl<T: Copy> LinuxCnc<T> {
    /// The element that waits and its start, if it is a plain line
    /// that is entered at this speed, squared.
    pub fn gliding(&self, speed2: f64) -> Option<(T, LineStart)> {
        let pending = self.pending.as_deref()?;
        let element = &pending.element;
        let speed = pending.target_speed();
        let plain = element.curve.is_none()
            && !pending.is_line
            && !pending.parabolic
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
        let joints = [before.joint, next.joint].map(|joint| match joint {
            Joint::Blend {
                tolerance_mm,
                join_mm: 0.0,
            } => Some(tolerance_mm),
            _ => None,
        });
        let [Some(tolerance_mm), Some(next_tolerance_mm)] = joints else {
            return None;
        };
        let cycle_mm = speed_mm_s * self.cycle_s;
        let shortest_mm = cycle_mm * CYCLES_MIN;
        if next.length_mm < cycle_mm || dot(before.direction, next.direction) <= 0.0 {
            return None;
        }
        let accel = self.axes.masked(next.axis_accel_mm_s2);
        let mut along = next.path_accel_mm_s2;
        for (limit, part) in accel.into_iter().zip(next.direction) {
            if part != 0.0 {
                along = along.min(limit / part.abs());
            }
        }
        let change = sub(next.direction, before.direction);
        let share = share_of(scale(change, speed_mm_s / self.cycle_s + along), accel);
        let length_mm = before.length_mm - before.start.taken_mm;
        if share <= self.kink_ratio {
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
        let leg = |line: &Line, length_mm, tolerance_mm| Leg {
            tangent: line.direction,
            nominal_mm: line.length_mm,
            length_mm,
            max_speed: speed_mm_s,
            asked_speed: speed_mm_s,
            tolerance_mm,
        };
        let legs = [
            leg(before, length_mm, tolerance_mm),
            leg(next, next.length_mm, next_tolerance_mm),
        ];
        let fit = between_lines([&legs[0], &legs[1]], &self.axes, accel)?;
        if fit.speed < speed_mm_s {
            return None;
        }
        let [taken_mm, next_mm] = fit.trims;
        let left_mm = length_mm - taken_mm;
        let blend_mm = fit.radius * fit.sweep;
        // What is too short to stand alone leads into the blend.
        let [own_mm, shared_mm] = if left_mm < self.gap_cycles * cycle_mm {
            [0.0, left_mm.max(0.0) + blend_mm]
        } else {
            [left_mm, blend_mm]
        };
        let long = shared_mm >= shortest_mm && (own_mm == 0.0 || own_mm >= shortest_mm);
        long.then_some(Passed {
            own_mm,
            shared_mm,
            curvature_per_mm: 1.0 / fit.radius,
            accel_share: TANGENTIAL_SHARE.min(1.0 - self.kink_ratio),
            next: LineStart {
                taken_mm: next_mm,
                kink: 0.0,
            },
        })
    }

    /// The motion has come to the start of this line at that speed, squared.
    pub fn glide_to(&mut self, element: &Element<T>, start: LineStart, speed2: f64) {
        let mut pending = Box::new(Pending::new(element, element.tag));
        pending.begin(false, self.cycle_s);
        pending.trim(start.taken_mm, true);
        pending.kink_before = start.kink;
        pending.entry2 = speed2;
        self.pending = Some(pending);
        self.last_max2 = speed2;
    }
}
