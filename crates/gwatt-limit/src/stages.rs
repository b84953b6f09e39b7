//! Stages of a ramp: at which speeds the acceleration is stepped.
//!
//! Input: the speeds at both ends, and the largest acceleration that fits up to a speed.
//! Output: the speeds at which stages end, so that the ramp loses the least time against
//! the speed at its top; each stage has the acceleration that fits at its own top. How
//! many there are follows from that: one more must bring in its price, and none is
//! shorter than the control can use.

/// Speeds at which a stage may end: many for each of the shortest stages, which would last
/// longer than they have to otherwise.
const LEVELS: usize = 512;

/// What stages have to keep to.
#[derive(Debug, Clone, Copy)]
pub(super) struct Terms {
    /// The shortest time of a stage, s, and its shortest path, mm.
    pub(super) shortest_s: f64,
    pub(super) shortest_mm: f64,
    /// The shortest time that a stage would last at the speed of its foot, and at that of
    /// its top, s.
    pub(super) at_foot_s: f64,
    pub(super) at_top_s: f64,
    /// The least ratio of the speed of its top to that of its foot.
    pub(super) ratio: f64,
    /// What one stage more must gain, s.
    pub(super) price_s: f64,
}

/// The stages of a ramp.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Stages {
    /// Speeds at their tops, from low to high; the last one is that of the ramp.
    pub(super) tops_mm_s: Vec<f64>,
    /// Their path in all.
    pub(super) length_mm: f64,
}

/// The best way to reach a level.
#[derive(Debug, Clone, Copy)]
struct Way {
    /// What it loses against the top speed, s, with the prices of its stages.
    cost_s: f64,
    length_mm: f64,
    from: usize,
}

/// The stages between two speeds, mm/s; none where they are one. `None` where no stage is
/// long enough. A lower ramp read backwards is a way to brake.
pub(super) fn stages(
    low_mm_s: f64,
    top_mm_s: f64,
    accel_mm_s2: impl Fn(f64) -> f64,
    terms: Terms,
) -> Option<Stages> {
    if top_mm_s <= low_mm_s {
        return Some(Stages::default());
    }
    let speed = |level: usize| low_mm_s + (top_mm_s - low_mm_s) * level as f64 / LEVELS as f64;
    let mut ways: Vec<Option<Way>> = Vec::with_capacity(LEVELS + 1);
    ways.push(Some(Way {
        cost_s: 0.0,
        length_mm: 0.0,
        from: 0,
    }));
    // Stages to higher levels begin no lower.
    let mut lowest = 0;
    for level in 1..=LEVELS {
        let top = speed(level);
        let accel = accel_mm_s2(top);
        let mut best: Option<Way> = None;
        for (from, way) in ways.iter().enumerate().skip(lowest) {
            let Some(way) = way else { continue };
            let low = speed(from);
            let lasts_s = (top - low) / accel;
            let length_mm = 0.5 * (top + low) * lasts_s;
            let at_speed_mm = (terms.at_foot_s * low).max(terms.at_top_s * top);
            let shortest_mm = terms.shortest_mm.max(at_speed_mm);
            let long = lasts_s >= terms.shortest_s && length_mm >= shortest_mm;
            if !long || top < terms.ratio * low {
                // Stages from higher levels are shorter still.
                break;
            }
            let cost_s = way.cost_s + lasts_s - length_mm / top_mm_s + terms.price_s;
            if best.is_none_or(|best| cost_s < best.cost_s) {
                best = Some(Way {
                    cost_s,
                    length_mm: way.length_mm + length_mm,
                    from,
                });
            }
        }
        lowest = best.map_or(lowest, |best| best.from);
        ways.push(best);
    }
    let mut tops_mm_s = Vec::new();
    let mut level = LEVELS;
    let length_mm = ways.last().copied().flatten()?.length_mm;
    while let Some(Some(way)) = ways.get(level).filter(|_| level > 0) {
        tops_mm_s.push(speed(level));
        level = way.from;
    }
    tops_mm_s.reverse();
    Some(Stages {
        tops_mm_s,
        length_mm,
    })
}

#[cfg(test)]
mod tests {
    use super::{Terms, stages};

    const TERMS: Terms = Terms {
        shortest_s: 0.001,
        shortest_mm: 0.0,
        at_foot_s: 0.0,
        at_top_s: 0.0,
        ratio: 1.0,
        price_s: 1e-5,
    };

    /// What the same force gives at any speed needs one stage.
    #[test]
    fn a_constant_acceleration_is_one_stage() {
        let found = stages(0.0, 500.0, |_| 5000.0, TERMS).unwrap();
        assert_eq!(found.tops_mm_s, [500.0]);
        assert!((found.length_mm - 25.0).abs() < 1e-9);
    }

    /// Constant power above 100 mm/s: dv/dt = 5·10⁵/v, so that 0.1 s are gone at the knee
    /// and 500 mm/s is reached after 0.02 + (500² − 100²)/(2·5·10⁵) = 0.26 s, having lost
    /// that less the way, 1 + (500³ − 100³)/(3·5·10⁵) mm, at 500 mm/s.
    #[test]
    fn more_stages_come_nearer_to_constant_power() {
        let accel = |speed: f64| (5e5 / speed).min(5000.0);
        let lost = |tops: &[f64], length_mm: f64| {
            let mut low = 0.0;
            let mut lasts_s = 0.0;
            for top in tops {
                lasts_s += (top - low) / accel(*top);
                low = *top;
            }
            lasts_s - length_mm / 500.0
        };
        let limit = 0.26 - (1.0 + (500.0_f64.powi(3) - 1e6) / 1.5e6) / 500.0;
        let mut count = 0;
        for (price_s, worst) in [(1e-2, 0.5), (1e-3, 0.2), (1e-5, 0.05)] {
            let found = stages(0.0, 500.0, accel, Terms { price_s, ..TERMS }).unwrap();
            let share = lost(&found.tops_mm_s, found.length_mm) / limit - 1.0;
            assert!((0.0..worst).contains(&share), "{share} {found:?}");
            assert!(found.tops_mm_s.len() > count);
            count = found.tops_mm_s.len();
        }
    }

    #[test]
    fn no_stage_is_shorter_than_the_control_can_use() {
        let accel = |speed: f64| (5e5 / speed).min(5000.0);
        let terms = Terms {
            shortest_s: 0.06,
            ..TERMS
        };
        let found = stages(0.0, 500.0, accel, terms).unwrap();
        let mut low = 0.0;
        for top in &found.tops_mm_s {
            assert!((top - low) / accel(*top) >= 0.06);
            low = *top;
        }
        // One stage alone would last for 500/1000 s.
        assert!((2..=8).contains(&found.tops_mm_s.len()), "{found:?}");
        let long = Terms {
            shortest_s: 1.0,
            ..TERMS
        };
        assert_eq!(stages(0.0, 500.0, accel, long), None);
        assert!(stages(7.0, 7.0, accel, long).unwrap().tops_mm_s.is_empty());
    }

    /// What speeds up is not held back at its top, and a queue of few blocks sees enough.
    #[test]
    fn stages_keep_to_a_time_at_speed_and_to_a_ratio() {
        let accel = |speed: f64| (5e5 / speed).min(5000.0);
        let pairs = |terms: Terms| {
            let tops = stages(0.0, 500.0, accel, terms).unwrap().tops_mm_s;
            let mut low = 0.0;
            let pairs = tops
                .into_iter()
                .map(|top| (std::mem::replace(&mut low, top), top));
            pairs.collect::<Vec<_>>()
        };
        let length = |(low, top): (f64, f64)| 0.5 * (top * top - low * low) / accel(top);
        let slow = pairs(Terms {
            at_top_s: 0.02,
            ..TERMS
        });
        assert!(slow.len() > 3, "{slow:?}");
        assert!(slow.iter().all(|it| length(*it) >= 0.02 * it.1), "{slow:?}");
        let slow = pairs(Terms {
            at_foot_s: 0.02,
            ..TERMS
        });
        assert!(slow.iter().all(|it| length(*it) >= 0.02 * it.0), "{slow:?}");
        let few = pairs(Terms {
            ratio: 1.1,
            ..TERMS
        });
        assert!(few.len() > 3, "{few:?}");
        assert!(few.iter().all(|(low, top)| *top >= 1.1 * low), "{few:?}");
    }
}
