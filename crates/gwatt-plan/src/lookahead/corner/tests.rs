use super::{After, Corner, Element, Joint, LINEAR};
use crate::random::Random;
use gwatt_machine::{CornerAngle, CornerRule};

impl Random {
    /// Between 1 and 10 to the power of so much.
    fn scale(&mut self, decades: f64) -> f64 {
        libm::pow(10.0, decades * self.next())
    }
}

fn element(direction: [f64; 3], length_mm: f64, limits: [f64; 3]) -> Element<()> {
    let mut element = Element::blank(());
    let length = direction.iter().map(|d| d * d).sum::<f64>().sqrt();
    for axis in 0..LINEAR {
        element.start[axis] = direction[axis] / length;
        element.axis_accel_mm_s2[axis] = limits[axis];
    }
    element.end = element.start;
    element.length_mm = length_mm;
    element.accel_mm_s2 = limits.into_iter().fold(f64::INFINITY, f64::min) * 1.5;
    element.joint = Joint::Exact;
    element
}

#[test]
fn the_quick_answer_never_permits_more_than_the_rule() {
    let mut random = Random(11);
    let (mut permitted, mut refused, mut wrong) = (0, 0, 0);
    for case in 0..100_000 {
        let mut direction = || [(); 3].map(|()| 2.0 * random.next() - 1.0);
        let (first, by) = (direction(), direction());
        // From reversals over right angles to the straight.
        let bend = 1e-5 * random.scale(6.0);
        let second = [0, 1, 2].map(|i| first[i] + bend * by[i]);
        let limits = [(); 3].map(|()| 100.0 * random.scale(2.0));
        let length_mm = 0.01 * random.scale(3.0);
        let rule = CornerRule::JunctionDeviation {
            deviation_mm: 0.01,
            angle: CornerAngle::AllAxes,
            per_axis: case % 2 == 0,
            block_accel: case % 5 < 2,
            small_block_mm: if case % 3 == 0 { 1.0 } else { 0.0 },
        };
        let before = element(first, 1.0, limits);
        let before = After::new(&rule, &before).before();
        let after = element(second, length_mm, limits);
        let corner = Corner {
            deviation_mm: 0.01,
            per_axis: case % 2 == 0,
            block_accel: case % 5 < 2 || case % 2 != 0,
            small_block_mm: if case % 3 == 0 { 1.0 } else { 0.0 },
            axes: LINEAR,
            are_units: true,
            before: &before,
            after: &after,
        };
        let v2 = corner.speed2();
        // Close to the rule's own figure, and at any other.
        let most2 = match case % 4 {
            0 => v2 * (1.0 - 1e-9),
            1 => v2 * (1.0 + 1e-9),
            2 => v2 * random.scale(1.0),
            _ => v2 / random.scale(1.0),
        };
        let permits = most2.is_finite() && corner.permits(most2);
        permitted += usize::from(permits);
        refused += usize::from(!permits);
        wrong += usize::from(permits && v2 < most2);
    }
    assert_eq!(wrong, 0);
    assert!(
        permitted > 10_000 && refused > 10_000,
        "{permitted} {refused}"
    );
}
