//! How a planner runs the stretches of a way: the speeds at their joints.
//!
//! Input: a way. Output: how long it lasts, and whether it is run as designed even where
//! the control runs short blocks at a lower F.

use super::road::{MOST, Road, SHORTEST_MM, Stretch, Way};
use gwatt_plan::Profile;
use gwatt_plan::lookahead::Speeds2;

/// What rounding may take of the square of a speed.
const ROUNDING: f64 = 1e-9;

impl Road<'_> {
    /// How long the way lasts in these stretches, as a planner runs them; `None` where one
    /// of them is too short, or draws too much.
    pub(super) fn duration_s(&self, stretches: &[Stretch]) -> Option<f64> {
        let top = self.limit_mm_s * self.limit_mm_s;
        let joints = self.joints2(stretches)?;
        let mut duration_s = 0.0;
        for (stretch, joint) in stretches.iter().zip(joints.windows(2)) {
            let [start, end] = *joint else { return None };
            let speeds2 = Speeds2 { start, end, top };
            let profile = Profile::between(stretch.length_mm, speeds2, stretch.step.accel_mm_s2);
            let lasts_s = profile.duration_s();
            let usable = lasts_s >= self.shortest_s && stretch.length_mm >= SHORTEST_MM;
            let too_fast = profile.top_speed_mm_s() > self.top_mm_s * (1.0 + ROUNDING);
            if !usable || too_fast || self.load(profile) > MOST {
                return None;
            }
            duration_s += lasts_s;
        }
        Some(duration_s)
    }

    /// The speed at which the way ends, mm/s.
    pub(super) fn end_mm_s(&self, way: &Way) -> Option<f64> {
        let joints2 = self.joints2(&way.stretches)?;
        joints2.last().map(|end2| end2.sqrt())
    }

    /// The squares of the speeds at the joints, and at both ends.
    fn joints2(&self, stretches: &[Stretch]) -> Option<Vec<f64>> {
        let top2 = self.limit_mm_s * self.limit_mm_s;
        let [start2, end2] = self.ends_mm_s.map(|end| end * end);
        let mut joints2 = vec![start2];
        for stretch in stretches {
            let before = joints2.last().copied()?;
            joints2.push((before + stretch.gain2()).min(top2));
        }
        let last = joints2.last_mut()?;
        *last = last.min(end2);
        for index in (0..stretches.len()).rev() {
            let most = joints2.get(index + 1)? + stretches.get(index)?.gain2();
            let joint = joints2.get_mut(index)?;
            *joint = joint.min(most);
        }
        Some(joints2)
    }

    /// Whether the speeds at which the way is to be braked are reached even where the
    /// control runs short blocks at a lower F: after lower ones there would be room to
    /// speed up in a stretch that is meant for braking.
    pub(super) fn recovers(&self, way: &Way) -> bool {
        let at_feed_s = self.solver.machine.controller.planner.shortest_at_feed_s;
        if at_feed_s == 0.0 {
            return true;
        }
        let Some(joints2) = self.joints2(&way.stretches) else {
            return false;
        };
        // What the lower F leaves of the square of the speed.
        let slowest2 = |stretch: &Stretch| {
            let slowest_mm_s = stretch.length_mm / at_feed_s;
            slowest_mm_s * slowest_mm_s
        };
        let mut speed2 = f64::INFINITY;
        for (index, (stretch, joint)) in way.stretches.iter().zip(joints2.windows(2)).enumerate() {
            let [start2, end2] = *joint else { return false };
            let slowest2 = slowest2(stretch);
            if index < way.brakes_from {
                speed2 = speed2.min(start2).min(slowest2) + stretch.gain2();
                speed2 = speed2.min(slowest2);
                if index + 1 == way.brakes_from && speed2 < end2 * (1.0 - ROUNDING) {
                    return false;
                }
            } else if slowest2 < end2 * (1.0 - ROUNDING) {
                return false;
            }
        }
        true
    }
}
