//! The joint speed of the classic jerk rule, as Marlin has it.
//!
//! Input: both sides of a joint. Output: the largest squared speed at which it is
//! passed, and at any lower override.
//!
//! The rule looks at the steps of the axes' speeds where the move before comes at the
//! lower of both speeds, but the next one begins at its own: one that is faster by more
//! than a step is entered slowly even where it goes straight on. With `v` the lower
//! speed, `ρ ≥ 1` the next one's share of it, `u` and `w` the directions an axis steps by
//! `v·|u − ρ·w|`. An override changes ρ only where an axis is at its limit on one side.

use gwatt_machine::AxisValues;

/// Sides that differ less begin on their own.
const THRESHOLD: f64 = 0.99;
/// By what share two speeds may differ by rounding.
const ROUNDING: f64 = 1e-9;

/// A joint; of each pair the side before comes first.
#[derive(Debug)]
pub(in crate::lookahead) struct JerkJoint<'a> {
    /// The largest steps of the axes that move, mm/s.
    pub steps: &'a [f64],
    pub exit: &'a AxisValues,
    pub entry: &'a AxisValues,
    /// The speeds that F and the axes permit, and that F asks for, mm/s.
    pub tops: [f64; 2],
    pub asked: [f64; 2],
    /// The squared speeds at which each side may begin and end on its own.
    pub rests2: [f64; 2],
}

impl JerkJoint<'_> {
    /// The largest squared speed at which it is passed.
    pub fn speed2(&self) -> f64 {
        let v2 = self.stepped2();
        self.or_rest(v2, v2)
    }

    /// The squared speed at which no axis makes too large a step.
    fn stepped2(&self) -> f64 {
        let [before, after] = self.tops;
        let speed = before.min(after);
        let mut factor = 1.0_f64;
        for (step, (exit, entry)) in self.steps.iter().zip(self.exit.iter().zip(self.entry)) {
            let jump = jump(exit * speed, entry * after);
            if jump * factor > *step {
                factor = step / jump;
            }
        }
        (speed * factor) * (speed * factor)
    }

    /// The squared speed at which the next side begins on its own, though the one before is
    /// slower than that: no step is too large for it.
    pub fn begins2(&self) -> Option<f64> {
        let [before, after] = self.rests2;
        let threshold2 = THRESHOLD * THRESHOLD * self.stepped2();
        let top2 = self.tops[0] * self.tops[0];
        (after > top2 && after > threshold2 && before > threshold2).then_some(after)
    }

    /// The same at this override and at any lower one: where both sides are slower than a
    /// step, each begins at its own speed.
    pub fn lower_begins2(&self) -> Option<f64> {
        let rises = |[before, after]: [f64; 2]| after > before * (1.0 + ROUNDING);
        (rises(self.asked) || rises(self.tops)).then_some(self.rests2[1])
    }

    /// [`Self::speed2`] at this override and at all lower ones, if that is more.
    pub fn lower_speed2(&self) -> Option<f64> {
        let [least, most] = self.ratios()?;
        let (mut slow, mut fast) = (f64::INFINITY, f64::INFINITY);
        for (step, (exit, entry)) in self.steps.iter().zip(self.exit.iter().zip(self.entry)) {
            let ends = [least, most].map(|ratio| jump(*exit, entry * ratio));
            let crosses = (exit - entry * least) * (exit - entry * most) <= 0.0;
            let smallest = if crosses { 0.0 } else { ends[0].min(ends[1]) };
            // A step of nothing at a jump of nothing is no limit.
            let speed = |jump: f64| {
                if jump > 0.0 {
                    step / jump
                } else {
                    f64::INFINITY
                }
            };
            slow = slow.min(speed(ends[0].max(ends[1])));
            fast = fast.min(speed(smallest));
        }
        let [before, after] = self.tops;
        let speed = before.min(after).min(fast);
        Some(self.or_rest(slow * slow, speed * speed))
    }

    /// Both sides could as well begin and end on their own: `most2`, or what that comes to
    /// where it is above the `least2` that the steps may leave.
    fn or_rest(&self, least2: f64, most2: f64) -> f64 {
        let threshold2 = least2 * (THRESHOLD * THRESHOLD);
        let [before, after] = self.rests2;
        let own2 = if after <= threshold2 || before <= threshold2 {
            most2
        } else if least2 == most2 {
            after
        } else {
            after.max(most2)
        };
        let [before, after] = self.tops.map(|top| top * top);
        own2.min(before).min(after)
    }

    /// Between what the speed of the next side by that of the one before, no less than 1,
    /// lies at this override and all lower ones; nothing where it is always the same.
    fn ratios(&self) -> Option<[f64; 2]> {
        let (tops, asked) = (self.tops, self.asked);
        let [before, after] = asked;
        let is_known = before < f64::INFINITY && after < f64::INFINITY;
        if !is_known || (tops[0] >= before && tops[1] >= after) {
            return None;
        }
        // It changes where an axis comes off its limit.
        let at = |share: f64| {
            let [before, after] = [0, 1].map(|side| tops[side].min(share * asked[side]));
            (after / before).max(1.0)
        };
        let shares = [1.0, tops[0] / before, tops[1] / after].map(|share| share.min(1.0));
        let all = shares.map(at);
        let slow = (after / before).max(1.0);
        let least = all.into_iter().fold(slow, f64::min);
        let most = all.into_iter().fold(slow, f64::max);
        (least < most).then_some([least, most])
    }
}

/// A change of direction counts as the larger of both parts.
fn jump(exit: f64, entry: f64) -> f64 {
    if exit * entry < 0.0 {
        exit.abs().max(entry.abs())
    } else {
        (exit - entry).abs()
    }
}

#[cfg(test)]
mod tests {
    use super::JerkJoint;
    use crate::random::Random;
    use gwatt_machine::{AXES, AxisValues};

    /// A joint in X and Y whose sides have these limits of their axes and this F, mm/s.
    fn joint<'a>(
        steps: &'a [f64; 2],
        directions: [&'a AxisValues; 2],
        limits: [f64; 2],
        asked: [f64; 2],
    ) -> JerkJoint<'a> {
        let tops = [0, 1].map(|side| limits[side].min(asked[side]));
        let rest = |side: usize| {
            let alone = steps.iter().zip(directions[side]);
            let alone = alone.map(|(step, change)| step / change.abs());
            let speed = alone.fold(tops[side], f64::min);
            speed * speed
        };
        JerkJoint {
            steps,
            exit: directions[0],
            entry: directions[1],
            tops,
            asked,
            rests2: [rest(0), rest(1)],
        }
    }

    fn heading(angle: f64) -> AxisValues {
        let mut direction = [0.0; AXES];
        (direction[1], direction[0]) = libm::sincos(angle);
        direction
    }

    #[test]
    fn a_step_up_counts_from_the_lower_speed_to_the_higher() {
        // Straight on with F of 100, of which the first move's axes permit 80.
        let along_x = heading(0.0);
        let joint = joint(&[10.0, 10.0], [&along_x; 2], [80.0, 1e3], [100.0; 2]);
        // 80 to 100 is a step of 20: half of the speed.
        assert!((joint.speed2() - 1600.0).abs() < 1e-9, "{}", joint.speed2());
        // At 80 % both are 80, and there is none.
        assert_eq!(joint.lower_speed2(), Some(6400.0));
    }

    #[test]
    fn at_no_lower_override_a_joint_is_passed_faster_than_the_bound() {
        let mut random = Random(7);
        let (mut more, mut same) = (0, 0);
        for _ in 0..20_000 {
            let mut next = |most: f64| most * random.next();
            let steps = [0.3 + next(15.0), 0.3 + next(15.0)];
            let first = next(6.3);
            let turn = next(1.0);
            let directions = [heading(first), heading(first + turn * turn * 3.0)];
            let limits = [5.0 + next(200.0), 5.0 + next(200.0)];
            let asked = [5.0 + next(400.0), 5.0 + next(400.0)];
            let asked = if turn < 0.3 { [asked[0]; 2] } else { asked };
            let at = |share: f64| {
                let directions = [&directions[0], &directions[1]];
                joint(&steps, directions, limits, asked.map(|asked| share * asked))
            };
            let now2 = at(1.0).speed2();
            let bound2 = at(1.0).lower_speed2().unwrap_or(now2);
            assert!(bound2 >= now2 * (1.0 - 1e-12), "{bound2} {now2}");
            for share in 1..=50 {
                let lower2 = at(f64::from(share) / 50.0).speed2();
                assert!(
                    lower2 <= bound2 * (1.0 + 1e-12),
                    "{share}: {lower2} {bound2}"
                );
                more += u32::from(lower2 > now2 * 1.01);
                same += u32::from(lower2 <= now2);
            }
        }
        assert!(more > 1000 && same > 1000, "{more} {same}");
    }
}
