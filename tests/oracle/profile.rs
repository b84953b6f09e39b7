//! Motion along one coordinate from rest to rest, as fast as its limits permit.
//!
//! * Without jerk limit: `v = min(V, √(A·L))`, ramps of `v/A`.
//! * S-curve: a ramp to v takes `v/A + A/J`, or `2·√(v/J)` where A is not
//!   reached; by its symmetry it is `v·t/2` long.
//! * Under a curve: `dt = dv/a(v)`, `ds = v·dv/a(v)` in small steps of speed.
//! * S-curve under a curve: small steps of time, the acceleration growing by J at
//!   most, below `a(v)` and below `√(2·J·(V − v))`, from where it can still fall.

/// Steps of speed of a ramp under a curve.
const STEPS: usize = 250;

/// A stretch of constant jerk, by its state at the beginning.
#[derive(Debug, Clone, Copy)]
pub struct Piece {
    pub lasts_s: f64,
    pub s: f64,
    pub v: f64,
    pub a: f64,
    pub j: f64,
}

/// Position, speed and acceleration.
pub type State = [f64; 3];

impl Piece {
    fn at(&self, t: f64) -> State {
        let (a, j) = (self.a, self.j);
        [
            self.s + t * (self.v + t * (a / 2.0 + t * j / 6.0)),
            (self.v + t * (a + t * j / 2.0)).max(0.0),
            a + t * j,
        ]
    }
}

/// A motion from rest to rest.
#[derive(Debug, Clone, Default)]
pub struct Profile {
    pieces: Vec<Piece>,
    /// When each piece begins, and when the last one ends.
    pub times_s: Vec<f64>,
}

/// What limits a motion.
pub struct Limits<'f> {
    pub speed: f64,
    pub accel: f64,
    /// Infinite: no limit.
    pub jerk: f64,
    /// The acceleration that drives leave at a speed: up and down.
    pub curve: Option<[&'f dyn Fn(f64) -> f64; 2]>,
}

/// A ramp from rest: how long each step lasts, and the acceleration at its ends.
type Ramp = Vec<[f64; 3]>;

fn length_and_speed(ramp: &Ramp) -> [f64; 2] {
    let (mut s, mut v) = (0.0, 0.0);
    for [dt, a0, a1] in ramp {
        s += dt * (v + dt * (a0 / 3.0 + a1 / 6.0));
        v += 0.5 * dt * (a0 + a1);
    }
    [s, v]
}

impl Limits<'_> {
    /// The ramp from rest to `v`, upwards (0) or, seen backwards, downwards (1).
    fn ramp(&self, v: f64, side: usize) -> Ramp {
        let (accel, jerk) = (self.accel, self.jerk);
        match self.curve {
            None if jerk == f64::INFINITY => vec![[v / accel, accel, accel]],
            None => {
                let top = accel.min((v * jerk).sqrt());
                let hold_s = (v - top * top / jerk).max(0.0) / top;
                let rise_s = top / jerk;
                vec![[rise_s, 0.0, top], [hold_s, top, top], [rise_s, top, 0.0]]
            }
            Some(curve) if jerk == f64::INFINITY => {
                let a = |i: usize| curve[side](v * i as f64 / STEPS as f64).min(accel);
                let step = |i: usize| {
                    let (a0, a1) = (a(i), a(i + 1));
                    [2.0 * v / STEPS as f64 / (a0 + a1), a0, a1]
                };
                (0..STEPS).map(step).collect()
            }
            Some(curve) => under_both(v, accel, jerk, curve[side]),
        }
    }

    /// The motion over a length.
    pub fn run(&self, length: f64) -> Profile {
        let ramps = |v: f64| [self.ramp(v, 0), self.ramp(v, 1)];
        let far = |v: f64| {
            ramps(v)
                .iter()
                .map(|it| length_and_speed(it)[0])
                .sum::<f64>()
        };
        let mut top = self.speed;
        if far(top) > length {
            let (mut low, mut high) = (0.0, top);
            for _ in 0..36 {
                let middle = 0.5 * (low + high);
                if far(middle) > length {
                    high = middle;
                } else {
                    low = middle;
                }
            }
            top = low;
        }
        // Rounding makes no cruise.
        let left = length - far(top);
        let cruise_s = if left > 1e-9 * length {
            left / top
        } else {
            0.0
        };
        let [up, down] = ramps(top);
        let mut profile = Profile::default();
        for [dt, a0, a1] in up {
            profile.push(dt, [a0, a1]);
        }
        profile.push(cruise_s, [0.0; 2]);
        for [dt, a0, a1] in down.into_iter().rev() {
            profile.push(dt, [-a1, -a0]);
        }
        profile
    }
}

/// The fastest ramp within a jerk and a curve, in steps of time.
fn under_both(v_top: f64, accel: f64, jerk: f64, curve: &dyn Fn(f64) -> f64) -> Ramp {
    let lowest = (0..=64).map(|i| curve(v_top * f64::from(i) / 64.0));
    let lowest = lowest.fold(accel, f64::min);
    let dt = (v_top / lowest + 2.0 * (v_top / jerk).sqrt()) / (3.0 * STEPS as f64);
    let (mut v, mut a) = (0.0, 0.0_f64);
    let mut ramp = Ramp::new();
    while v < v_top * (1.0 - 1e-9) && ramp.len() < 60 * STEPS {
        let ahead = (v + dt * a).min(v_top);
        let free = (a + jerk * dt).min(accel).min(curve(ahead));
        let next = free.min((2.0 * jerk * (v_top - ahead)).sqrt()).max(0.0);
        let mean = 0.5 * (a + next);
        if v + dt * mean >= v_top || mean * dt < 1e-12 * v_top {
            let last = (v_top - v) * 2.0 / a.max(1e-9 * accel);
            ramp.push([last, a, 0.0]);
            break;
        }
        ramp.push([dt, a, next]);
        v += dt * mean;
        a = next;
    }
    ramp
}

impl Profile {
    fn push(&mut self, lasts_s: f64, [a0, a1]: [f64; 2]) {
        if lasts_s <= 0.0 {
            return;
        }
        if self.times_s.is_empty() {
            self.times_s.push(0.0);
        }
        let [s, v, _] = self.pieces.last().map_or([0.0; 3], |it| it.at(it.lasts_s));
        self.times_s.push(self.duration_s() + lasts_s);
        let j = (a1 - a0) / lasts_s;
        self.pieces.push(Piece {
            lasts_s,
            s,
            v,
            a: a0,
            j,
        });
    }

    /// How long it lasts.
    pub fn duration_s(&self) -> f64 {
        self.times_s.last().copied().unwrap_or(0.0)
    }

    /// Whether speed changes with a constant acceleration in each piece, so that
    /// powers have their extremes at the ends.
    pub fn is_plain(&self) -> bool {
        self.pieces.iter().all(|piece| piece.j == 0.0)
    }

    /// The state at `t`, by the piece in which `inside` lies; `None` after the end.
    pub fn at(&self, t: f64, inside: f64) -> Option<State> {
        let after = self.times_s.partition_point(|start| *start <= inside);
        let piece = self.pieces.get(after.checked_sub(1)?)?;
        Some(piece.at((t - self.times_s[after - 1]).clamp(0.0, piece.lasts_s)))
    }
}
