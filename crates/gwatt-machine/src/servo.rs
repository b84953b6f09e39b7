//! How a drive follows its command, and by what factor it exceeds it.
//!
//! Input: the [`Servo`]s of axes that share a converter, each with the error of its
//! mass. Output: their [`servo_factor`].
//!
//! ```text
//! w  = Kv·(r − x) + f·ṙ                   position loop, feedforward f
//! a  = (m₀/m)·(ω·(w − v + y) + g·r̈)       velocity loop, ω = 2π·bandwidth
//! ẏ  = (w − v)/Tn                         its integral part, if it has one
//! ```
//!
//! The acceleration that results is the commanded one, weighted with the answer `h` to
//! a push of it: `a(t) = ∫h(τ)·r̈(t − τ)dτ`. While speeds hardly change the power of
//! acceleration is weighted the same way. Whatever is commanded, as long as all axes
//! together ask for at most P, they draw at most
//!
//! ```text
//! P · ∫ max |h| dτ        the largest of all axes and masses at each τ
//! ```
//!
//! and some command asks for it: the one whose sign is that of `h`, each axis taking
//! its turn. For one axis that overshoots once it is the change from full braking to
//! full acceleration; for axes that follow with different delays, the end of one ramp as
//! the next begins. Commands count without limits of jerk, since lines meet arcs
//! with a step of acceleration.

use std::f64::consts::TAU;

/// How the drive of an axis follows its command.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Servo {
    /// Gain Kv of the position loop, 1/s.
    pub position_gain_1_s: f64,
    /// Bandwidth of the velocity loop at the mass of the machine file, Hz.
    pub velocity_bandwidth_hz: f64,
    /// Reset time Tn of the velocity loop, s; infinite: it has no integral part.
    pub velocity_integral_time_s: f64,
    /// Share of the commanded speed that is fed forward, 0 to 1.
    pub velocity_feedforward: f64,
    /// Share of the commanded acceleration that is fed forward, 0 to 1.
    pub acceleration_feedforward: f64,
}

/// The grid's first step, as a share of the fastest time constant.
const FIRST_STEP: f64 = 0.01;
/// Steps between doublings of the step; time is at least this many steps.
const STEPS_PER_DOUBLING: usize = 512;
/// Radians of an oscillation in one step.
const STEP_RAD: f64 = 0.05;
/// What counts as settled.
const SETTLED: f64 = 1e-6;
/// More steps than a servo that settles takes.
const MAX_STEPS: usize = 300_000;
/// Masses between the lightest and the heaviest.
const MASSES: u8 = 5;
/// The integral is right within this.
const ACCURACY: f64 = 2e-5;
/// Factors are rounded up to thousandths.
const DIGITS: f64 = 1e3;

/// The factor by which the power of acceleration of these axes, together or alone,
/// exceeds what is commanded at most, by the formula above, at the largest mass; at
/// least 1. Each servo comes with the share by which the mass may be more or less.
/// `None` where one does not settle.
#[must_use]
pub fn servo_factor(axes: &[(Servo, f64)]) -> Option<f64> {
    let over = answer(&mut loops(axes))?.size - ACCURACY;
    Some((over * DIGITS).ceil().max(DIGITS) / DIGITS)
}

/// The time over which a mean of a commanded step of speed is as steep as what the
/// quickest of these axes makes of it, s: `1 / max |h|`; 0 where acceleration is fed
/// forward. `None` where one does not settle.
#[must_use]
pub fn servo_response_s(axes: &[(Servo, f64)]) -> Option<f64> {
    let mut loops = loops(axes);
    for one in &mut loops {
        // Here the acceleration counts, not its power.
        one.weight = 1.0;
    }
    Some(answer(&mut loops)?.most_1_s.recip())
}

/// The loops of all axes at several masses, those that are alike once.
fn loops(axes: &[(Servo, f64)]) -> Vec<Loop> {
    let mut loops: Vec<Loop> = Vec::new();
    for (index, (servo, error)) in axes.iter().enumerate() {
        if axes
            .iter()
            .take(index)
            .all(|other| *other != (*servo, *error))
        {
            let masses = if *error == 0.0 { 1 } else { MASSES };
            let spread = |step: u8| match masses {
                1 => 1.0,
                _ => 1.0 - error + 2.0 * error * f64::from(step) / f64::from(masses - 1),
            };
            loops.extend((0..masses).map(|step| Loop::new(servo, spread(step), 1.0 + error)));
        }
    }
    loops
}

/// The largest answer of several loops, both directions counted as positive.
struct Answer {
    /// Its integral.
    size: f64,
    /// Its largest value, 1/s; infinite where a part comes at once.
    most_1_s: f64,
}

fn answer(loops: &mut [Loop]) -> Option<Answer> {
    let largest = |of: fn(&Loop) -> f64, loops: &[Loop]| loops.iter().map(of).fold(0.0, f64::max);
    let fastest = largest(|it| it.rates.iter().sum(), loops);
    let mut step_s = FIRST_STEP / fastest;
    for one in &mut *loops {
        one.step = one.over(step_s);
    }
    let mut sum = largest(|it| it.at_once, loops);
    let mut before = largest(Loop::answer, loops);
    let mut most_1_s = if sum > 0.0 { f64::INFINITY } else { before };
    for count in 1..=MAX_STEPS {
        loops.iter_mut().for_each(Loop::advance);
        let now = largest(Loop::answer, loops);
        sum += 0.5 * (before + now) * step_s;
        before = now;
        most_1_s = most_1_s.max(now);
        if loops.iter().all(Loop::is_settled) {
            return sum.is_finite().then_some(Answer {
                size: sum,
                most_1_s,
            });
        }
        if count % STEPS_PER_DOUBLING == 0
            && 2.0 * step_s * largest(Loop::frequency, loops) <= STEP_RAD
        {
            step_s *= 2.0;
            for one in &mut *loops {
                one.step = product(&one.step, &one.step);
            }
        }
    }
    None
}

type Matrix = [[f64; 3]; 3];

/// What a servo does once a push of acceleration has set the commanded speed to 1.
#[derive(Debug, Clone, Copy)]
struct Loop {
    /// Kv, ω·m₀/m, 1/Tn.
    rates: [f64; 3],
    /// What the loops add up: Kv times the position error beyond that of standing
    /// motion, what is missing of the speed, the integral part.
    state: [f64; 3],
    /// From one state to that a step later.
    step: Matrix,
    /// What is fed forward at once, as a share of the push.
    at_once: f64,
    /// Its mass by the largest one.
    weight: f64,
}

impl Loop {
    /// At a mass, as a share of the one described, of at most `heaviest`.
    fn new(servo: &Servo, mass: f64, heaviest: f64) -> Self {
        let weight = mass / heaviest;
        let at_once = servo.acceleration_feedforward / mass;
        Self {
            rates: [
                servo.position_gain_1_s,
                TAU * servo.velocity_bandwidth_hz / mass,
                servo.velocity_integral_time_s.recip(),
            ],
            state: [servo.velocity_feedforward - 1.0, 1.0 - at_once, 0.0],
            step: [[0.0; 3]; 3],
            at_once: at_once * weight,
            weight,
        }
    }

    /// An angular frequency above those with which it may still oscillate, 1/s.
    fn frequency(&self) -> f64 {
        if self.is_settled() {
            return 0.0;
        }
        let [position, velocity, integral] = self.rates;
        (velocity * (position + integral)).sqrt()
    }

    /// The size of the acceleration, by its weight.
    fn answer(&self) -> f64 {
        self.weight * (self.rates[1] * self.state.iter().sum::<f64>()).abs()
    }

    fn is_settled(&self) -> bool {
        self.state.iter().map(|part| part.abs()).sum::<f64>() < SETTLED
    }

    fn advance(&mut self) {
        let state = self.state;
        self.state = self
            .step
            .map(|row| row.iter().zip(&state).map(|(a, b)| a * b).sum());
    }

    /// From a state to that `time_s` later, which is short: a series.
    fn over(&self, time_s: f64) -> Matrix {
        let [position, velocity, integral] = self.rates.map(|rate| rate * time_s);
        let law = [
            [0.0, position, 0.0],
            [-velocity; 3],
            [integral, integral, 0.0],
        ];
        let one = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        // one + law·(one + law/2·(one + law/3·…))
        (1..=8).rev().fold(one, |rest, order| {
            let mut next = product(&law, &rest);
            for (row, unit) in next.iter_mut().zip(&one) {
                for (value, unit) in row.iter_mut().zip(unit) {
                    *value = *value / f64::from(order) + unit;
                }
            }
            next
        })
    }
}

fn product(left: &Matrix, right: &Matrix) -> Matrix {
    left.map(|row| {
        [0, 1, 2].map(|column| {
            let terms = row.iter().zip(right);
            terms.map(|(factor, other)| factor * other[column]).sum()
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn servo(velocity_bandwidth_hz: f64, velocity_feedforward: f64) -> Servo {
        Servo {
            position_gain_1_s: 50.0,
            velocity_bandwidth_hz,
            velocity_integral_time_s: f64::INFINITY,
            velocity_feedforward,
            acceleration_feedforward: 0.0,
        }
    }

    fn excess_of(servo: Servo, mass: f64) -> f64 {
        let answer = answer(&mut [Loop::new(&servo, mass, mass)]);
        answer.expect("it settles").size
    }

    #[track_caller]
    fn close(found: f64, expected: f64) {
        assert!((found - expected).abs() < 1e-5, "{found}, not {expected}");
    }

    /// ω = 4·Kv: two poles at p = 2·Kv. Without feedforward `h = p²·t·e^{-p·t}`, which is
    /// nowhere negative; with it the answer to a step of acceleration,
    /// `1 − (1 − p·t)·e^{-p·t}`, overshoots by e⁻² at p·t = 2.
    #[test]
    fn an_aperiodic_loop_overshoots_by_feedforward_only() {
        close(excess_of(servo(200.0 / TAU, 0.0), 1.0), 1.0);
        let twice = 2.0 * libm::exp(-2.0);
        close(excess_of(servo(200.0 / TAU, 1.0), 1.0), 1.0 + twice);
        assert_eq!(servo_factor(&[(servo(200.0 / TAU, 1.0), 0.0)]), Some(1.271));
        assert_eq!(servo_factor(&[(servo(200.0 / TAU, 0.0), 0.0)]), Some(1.0));
    }

    /// ω = 2·Kv: damping 1/√2, swings between ever smaller extremes, each e^{-π} of the
    /// last. Without feedforward the first overshoot is e^{-π}, and
    /// `∫|h| = coth(π/2)`; with it `h = 2·Kv·e^{-Kv·t}·cos(Kv·t)`.
    #[test]
    fn an_oscillation_adds_up() {
        let half = std::f64::consts::FRAC_PI_2;
        close(
            excess_of(servo(100.0 / TAU, 0.0), 1.0),
            libm::tanh(half).recip(),
        );
        // Extremes of the step's answer: 1 + e^{-π/2}, 1 − e^{-3π/2}, …
        let (first, ratio) = (libm::exp(-half), libm::exp(-2.0 * half));
        let swings = 1.0 + 2.0 * first / (1.0 - ratio);
        close(excess_of(servo(100.0 / TAU, 1.0), 1.0), swings);
    }

    /// All fed forward: the command itself; half of it: half at once, and the rest, `p·t`
    /// short of the above, `h = ½·(2p − p²·t)·e^{-p·t}`.
    #[test]
    fn acceleration_fed_forward_comes_at_once() {
        let fed = |share| Servo {
            acceleration_feedforward: share,
            ..servo(200.0 / TAU, 1.0)
        };
        close(excess_of(fed(1.0), 1.0), 1.0);
        close(excess_of(fed(0.5), 1.0), 1.0 + libm::exp(-2.0));
    }

    /// A mass twice as large halves the bandwidth.
    #[test]
    fn a_larger_mass_is_a_slower_loop() {
        let found = excess_of(servo(200.0 / TAU, 1.0), 2.0);
        close(found, excess_of(servo(100.0 / TAU, 1.0), 1.0));
        let [exact, within] = [0.0, 0.2].map(|error| servo_factor(&[(servo(60.0, 1.0), error)]));
        assert!(exact < within, "{exact:?}, {within:?}");
    }

    /// `h = p²·t·e^{-p·t}` is p/e at most, at p·t = 1; with the speed fed forward 2·p at
    /// once. A mass 20 % less is quicker.
    #[test]
    fn a_step_of_speed_is_as_steep_as_the_loop() {
        let response = |forward, error| {
            servo_response_s(&[(servo(200.0 / TAU, forward), error)]).expect("it settles")
        };
        close(response(0.0, 0.0), libm::exp(1.0) / 100.0);
        close(response(1.0, 0.0), 1.0 / 200.0);
        close(response(1.0, 0.2), 0.8 / 200.0);
        let fed = Servo {
            acceleration_feedforward: 0.1,
            ..servo(200.0 / TAU, 1.0)
        };
        assert_eq!(servo_response_s(&[(fed, 0.0)]), Some(0.0));
    }

    /// One axis is 1000 times as quick as the other: whatever one still draws comes on
    /// top of what the other draws already.
    #[test]
    fn axes_with_different_delays_add_up() {
        let quick = Servo {
            position_gain_1_s: 5e4,
            ..servo(200e3 / TAU, 0.0)
        };
        let both = servo_factor(&[(servo(200.0 / TAU, 0.0), 0.0), (quick, 0.0)]);
        assert!(both > Some(1.99) && both <= Some(2.0), "{both:?}");
        let alike = servo_factor(&[(servo(200.0 / TAU, 0.0), 0.0); 3]);
        assert_eq!(alike, Some(1.0));
    }

    /// By hand: s³ + ω·s² + ω·(Kv + 1/Tn)·s + ω·Kv/Tn is stable where
    /// ω·(Kv + 1/Tn) > Kv/Tn; ω = 20/s, Kv = 50/s, 1/Tn = 50/s: 2000 < 2500.
    #[test]
    fn what_swings_up_has_no_factor() {
        let integral = |hz| Servo {
            velocity_integral_time_s: 0.02,
            ..servo(hz, 0.0)
        };
        assert_eq!(servo_factor(&[(integral(20.0 / TAU), 0.0)]), None);
        assert_eq!(servo_factor(&[(integral(200.0 / TAU), 0.0)]), Some(1.0));
    }
}
