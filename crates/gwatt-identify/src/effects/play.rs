//! A load that a motor moves through a play: it is pushed at either end of the play, and
//! coasts between them, until friction stops it.

use super::super::equations::{Raw, sign};

/// A play, and what brakes a load within it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Play {
    /// From end to end, m (rad).
    pub width: f64,
    /// Coulomb friction by mass, m/s².
    pub coulomb: f64,
    /// Viscous friction by mass, 1/s.
    pub viscous: f64,
}

/// Where the load is.
#[derive(Debug, Clone, Copy, PartialEq)]
enum At {
    /// Pushed forward (1) or backward (−1).
    End(f64),
    /// Between the ends, so far from where the motor is.
    Between(f64),
}

/// What a load does from one sample to the next.
struct Step {
    /// Its speed before and after.
    before: f64,
    after: f64,
    /// Whether it goes with the motor all the time.
    is_pushed: bool,
    /// Whether it coasted, and was caught by an end of the play.
    is_caught: bool,
}

impl Play {
    /// How the load's acceleration differs from that which it had if it went with the motor.
    /// `None` where the speed is not known.
    pub fn accelerations(self, raw: &Raw) -> Option<Vec<f64>> {
        self.differences(raw, |step, _, a| {
            (step.after - step.before) / raw.period_s - a
        })
    }

    /// The same of its friction by mass.
    pub fn rubbing(self, raw: &Raw) -> Option<Vec<f64>> {
        self.differences(raw, |step, v, _| {
            self.friction(step.after) - self.friction(v)
        })
    }

    fn differences(self, raw: &Raw, of: impl Fn(&Step, f64, f64) -> f64) -> Option<Vec<f64>> {
        let mut out = Vec::with_capacity(raw.force.len());
        self.follow(raw, |step, v, a| {
            out.push(if step.is_pushed { 0.0 } else { of(step, v, a) });
        })?;
        Some(out)
    }

    /// How fast an end of the play meets the load, as the root of the mean square, m/s
    /// (rad/s).
    pub fn catching_speed(self, raw: &Raw) -> Option<f64> {
        let (mut squares, mut times) = (0.0, 0.0_f64);
        self.follow(raw, |step, v, _| {
            if step.is_caught {
                let apart = v - self.coasted(step.before, raw.period_s);
                squares += apart * apart;
                times += 1.0;
            }
        })?;
        Some((squares / times.max(1.0)).sqrt())
    }

    /// Whether anything brakes the load within it.
    pub fn is_braked(self) -> bool {
        self.coulomb > 0.0 || self.viscous > 0.0
    }

    fn friction(self, v: f64) -> f64 {
        self.coulomb * sign(v) + self.viscous * v
    }

    /// Calls `each` with what the load does, and the motor's speed and acceleration.
    fn follow(self, raw: &Raw, mut each: impl FnMut(&Step, f64, f64)) -> Option<()> {
        let velocity = raw.velocity.as_ref()?;
        let t = raw.period_s;
        let mut load_speed = velocity.first().copied().unwrap_or_default();
        let mut at = At::End(if load_speed < 0.0 { -1.0 } else { 1.0 });
        for (v, a) in velocity.iter().zip(raw.acceleration.iter()) {
            let mut step = Step {
                before: load_speed,
                after: *v,
                is_pushed: false,
                is_caught: false,
            };
            let from = match at {
                At::End(side) if (a + self.friction(*v)) * side >= 0.0 => {
                    step.is_pushed = true;
                    load_speed = *v;
                    each(&step, *v, *a);
                    continue;
                }
                At::End(side) => 0.5 * self.width * side,
                At::Between(apart) => apart,
            };
            load_speed = self.coasted(load_speed, t);
            let apart = from + t * (v - load_speed);
            at = if apart.abs() < 0.5 * self.width {
                At::Between(apart)
            } else {
                step.is_caught = true;
                load_speed = *v;
                At::End(sign(apart))
            };
            step.after = load_speed;
            each(&step, *v, *a);
        }
        Some(())
    }

    /// The speed of a load that coasts a while: friction stops it, and no more.
    fn coasted(self, v: f64, t: f64) -> f64 {
        let slower = v.abs() - t * (self.coulomb + self.viscous * v.abs());
        sign(v) * slower.max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::super::super::column::Kind;
    use super::*;

    /// A motor that stops at once and goes back, 1 m/s every 0.1 s; the load coasts through
    /// 0.25 m without friction, is stopped at the other end, and goes back with the motor.
    #[test]
    fn a_load_coasts_until_it_is_caught() {
        let velocity = [1.0, 1.0, 0.0, -1.0, -1.0, -1.0];
        let raw = Raw {
            force: Arc::new(vec![0.0; 6]),
            acceleration: Arc::new(vec![0.0, 0.0, -10.0, -10.0, 0.0, 0.0]),
            velocity: Some(Arc::new(velocity.to_vec())),
            position: None,
            period_s: 0.1,
            motion: Kind::Linear,
            cut_off: None,
        };
        let play = Play {
            width: 0.25,
            coulomb: 0.0,
            viscous: 0.0,
        };
        let accelerations = play.accelerations(&raw).unwrap();
        // 0.125 − 0.1 apart, then 0.025 − 0.2: the load has gone from 1 to −1 m/s.
        for (found, expected) in accelerations.iter().zip([0.0, 0.0, 10.0, -10.0, 0.0, 0.0]) {
            assert!((found - expected).abs() < 1e-9, "{accelerations:?}");
        }
        // The end that goes back with 1 m/s meets a load that goes on with 1 m/s.
        assert!((play.catching_speed(&raw).unwrap() - 2.0).abs() < 1e-9);
        // Friction of 4 m/s² stops it in three steps; viscous friction of 2/s by a fifth.
        let braked = Play {
            coulomb: 4.0,
            ..play
        };
        assert!((braked.coasted(-1.0, 0.1) + 0.6).abs() < 1e-12);
        assert_eq!(braked.coasted(0.3, 0.1), 0.0);
        let viscous = Play {
            viscous: 2.0,
            ..play
        };
        assert!((viscous.coasted(1.0, 0.1) - 0.8).abs() < 1e-12);
    }
}
