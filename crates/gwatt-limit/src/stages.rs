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

/// A level at which a stage may begin.
///
/// A stage from the speed `u` to `w` with the acceleration `a` loses, against the top speed `V`,
/// `(w − u)/a − (w² − u²)/(2·a·V) = (g(w) − g(u))/a` with `g(u) = u − u²/2V`. By `1/a` the cost of
/// what begins at a level is a line, and the best level is on the lower envelope of all.
#[derive(Debug, Clone, Copy)]
struct Foot {
    level: usize,
    cost_s: f64,
    /// `g(u)`.
    gained_mm_s: f64,
}

impl Foot {
    /// What it costs, but for what depends on the stage's top alone, s.
    fn cost_s(&self, per_accel: f64) -> f64 {
        self.cost_s - self.gained_mm_s * per_accel
    }

    /// Whether it is above the envelope of the one before it and the one after it.
    fn is_above(&self, before: &Self, after: &Self) -> bool {
        let [own, next] = [self, after].map(|it| {
            (
                it.cost_s - before.cost_s,
                it.gained_mm_s - before.gained_mm_s,
            )
        });
        next.0 * own.1 <= own.0 * next.1
    }
}

/// The levels at which stages may begin, by speed, as far as one of them may yet be the best.
#[derive(Debug, Default)]
struct Envelope {
    feet: Vec<Foot>,
    /// The best for the last acceleration: those before it are not for lower ones.
    best: usize,
}

impl Envelope {
    fn push(&mut self, foot: Foot) {
        while let [.., before, last] = self.feet[self.best..]
            && last.is_above(&before, &foot)
        {
            self.feet.pop();
        }
        self.feet.push(foot);
    }

    /// The best for an acceleration that is no higher than at the last time.
    fn best(&mut self, per_accel: f64) -> Option<Foot> {
        while let [own, next, ..] = self.feet.get(self.best..)?
            && next.cost_s(per_accel) < own.cost_s(per_accel)
        {
            self.best += 1;
        }
        self.feet.get(self.best).copied()
    }
}

impl Terms {
    /// Whether a stage is long enough.
    fn permit(&self, [low, top]: [f64; 2], accel_mm_s2: f64) -> bool {
        let lasts_s = (top - low) / accel_mm_s2;
        let length_mm = 0.5 * (top + low) * lasts_s;
        let at_speed_mm = (self.at_foot_s * low).max(self.at_top_s * top);
        lasts_s >= self.shortest_s
            && length_mm >= self.shortest_mm.max(at_speed_mm)
            && top >= self.ratio * low
    }
}

/// The stages between two speeds, mm/s; none where they are one. `None` where no stage is
/// long enough. A lower ramp read backwards is a way to brake. At higher speeds no more
/// acceleration is taken than at lower ones.
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
    let gained = |speed_mm_s: f64| speed_mm_s * (1.0 - 0.5 * speed_mm_s / top_mm_s);
    let mut ways: Vec<Option<Way>> = Vec::with_capacity(LEVELS + 1);
    ways.push(Some(Way {
        cost_s: 0.0,
        length_mm: 0.0,
        from: 0,
    }));
    let mut envelope = Envelope::default();
    let (mut next, mut accel) = (0, f64::INFINITY);
    for level in 1..=LEVELS {
        let top = speed(level);
        accel = accel.min(accel_mm_s2(top));
        // What is long enough for one level is for all higher ones, and stages from higher
        // levels are shorter.
        while let Some(way) = ways.get(next) {
            if let Some(way) = way {
                if !terms.permit([speed(next), top], accel) {
                    break;
                }
                envelope.push(Foot {
                    level: next,
                    cost_s: way.cost_s,
                    gained_mm_s: gained(speed(next)),
                });
            }
            next += 1;
        }
        ways.push(envelope.best(accel.recip()).and_then(|foot| {
            let way = ways.get(foot.level).copied().flatten()?;
            let low = speed(foot.level);
            Some(Way {
                cost_s: foot.cost_s(accel.recip()) + gained(top) / accel + terms.price_s,
                length_mm: way.length_mm + 0.5 * (top + low) * (top - low) / accel,
                from: foot.level,
            })
        }));
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
    use super::{LEVELS, Terms, stages};

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

    /// What a ramp with stages between these speeds loses against its last one, with the price
    /// of each.
    fn cost_s(tops: &[f64], accel: impl Fn(f64) -> f64, price_s: f64) -> f64 {
        let most = *tops.last().unwrap();
        let mut low = 0.0;
        let mut cost = 0.0;
        for top in tops {
            let lasts = (top - low) / accel(*top);
            cost += lasts - 0.5 * (top + low) * lasts / most + price_s;
            low = *top;
        }
        cost
    }

    /// The least cost of all choices of levels, each tried.
    fn least_cost_s(accel: impl Fn(f64) -> f64, terms: Terms) -> f64 {
        let speed = |level: usize| 500.0 * level as f64 / LEVELS as f64;
        let mut costs = vec![0.0];
        for level in 1..=LEVELS {
            let top = speed(level);
            let a = accel(top);
            let from = |(from, before): (usize, &f64)| {
                let low = speed(from);
                let lasts = (top - low) / a;
                let length = 0.5 * (top + low) * lasts;
                let at_speed = (terms.at_foot_s * low).max(terms.at_top_s * top);
                let long = lasts >= terms.shortest_s && length >= terms.shortest_mm.max(at_speed);
                let cost = before + lasts - length / 500.0 + terms.price_s;
                if long && top >= terms.ratio * low {
                    cost
                } else {
                    f64::INFINITY
                }
            };
            costs.push(
                costs
                    .iter()
                    .enumerate()
                    .map(from)
                    .fold(f64::INFINITY, f64::min),
            );
        }
        costs[LEVELS]
    }

    /// Random powers, friction and terms: nothing is better than what is found.
    #[test]
    fn no_other_stages_lose_less() {
        let mut seed = 1_u64;
        let mut next = move |least: f64, most: f64| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            least + (most - least) * (seed >> 33) as f64 / f64::from(1_u32 << 31)
        };
        for _ in 0..200 {
            let (power, force, friction) = (next(5e4, 2e6), next(2e3, 2e4), next(0.0, 50.0));
            let accel = |speed: f64| (power / speed).min(force) - friction;
            let terms = Terms {
                shortest_s: next(1e-3, 2e-2),
                shortest_mm: next(0.0, 0.5),
                at_foot_s: next(0.0, 0.01),
                at_top_s: next(0.0, 0.01),
                ratio: next(1.0, 1.05),
                price_s: next(1e-6, 1e-3),
            };
            let least = least_cost_s(accel, terms);
            match stages(0.0, 500.0, accel, terms) {
                Some(found) => {
                    let cost = cost_s(&found.tops_mm_s, accel, terms.price_s);
                    assert!((cost - least).abs() < 1e-9, "{cost} {least} {terms:?}");
                }
                None => assert!(least.is_infinite(), "{least} {terms:?}"),
            }
        }
    }
}
