//! Motion along one coordinate from rest to rest, as fast as its limits permit.
//!
//! * Without jerk limit: `v = min(V, √(A·L))`, ramps of `v/A`.
//! * S-curve: a ramp to v takes `v/A + A/J`, or `2·√(v/J)` where A is not
//!   reached; by its symmetry it is `v·t/2` long.
//! * Under a curve: `dt = dv/a(v)`, `ds = v·dv/a(v)` in small steps of speed.
//! * S-curve under a curve: small steps of speed, in which `da²/dv = 2·J` at most.

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
            // Far below the largest speed too, rounding alone is left.
            for _ in 0..48 {
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

/// The fastest ramp within a jerk and a curve, in steps of speed: within one the
/// square of the acceleration changes by `2·J·dv` at most, forwards and backwards.
fn under_both(v_top: f64, accel: f64, jerk: f64, curve: &dyn Fn(f64) -> f64) -> Ramp {
    let steps = 4 * STEPS;
    let dv = v_top / steps as f64;
    let mut squares: Vec<f64> = (0..=steps)
        .map(|i| accel.min(curve(dv * i as f64)).powi(2))
        .collect();
    (squares[0], squares[steps]) = (0.0, 0.0);
    for i in 1..=steps {
        squares[i] = squares[i].min(squares[i - 1] + 2.0 * jerk * dv);
    }
    for i in (0..steps).rev() {
        squares[i] = squares[i].min(squares[i + 1] + 2.0 * jerk * dv);
    }
    let step = |pair: &[f64]| {
        let (a0, a1) = (pair[0].sqrt(), pair[1].sqrt());
        [2.0 * dv / (a0 + a1), a0, a1]
    };
    squares.windows(2).map(step).collect()
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
