//! How sure something has to be before it is said, or gone on with: all such thresholds, so
//! that they can be compared.
//!
//! Normal errors exceed two standard errors once in 22 times, three once in 370, four once
//! in 16 000 and five once in 1.7 million. What is asked once for a recording needs three;
//! what is looked for in many places, or would rule out the rest, needs more.

/// Standard errors from which on a sign is sure: the verdict rests on it.
pub const SIGN: f64 = 3.0;
/// A gain with a larger standard error, as a share, may have the other sign.
pub const SIGN_SHARE: f64 = 1.0 / SIGN;
/// Standard errors from which on friction differs by direction.
pub const DIRECTIONS: f64 = 3.0;
/// Standard errors from which on an offset is a weight.
pub const WEIGHT: f64 = 3.0;
/// Standard errors from which on there is friction: it changes all models after it.
pub const FRICTION: f64 = 4.0;
/// The same for each of its terms, once there is friction.
pub const FRICTION_TERM: f64 = 3.0;
/// The same for what is found next to a model.
pub const FRICTION_OF_MODEL: f64 = 3.0;
/// Standard errors from which on the size of an effect is sure; many sizes and periods are
/// tried for each.
pub const EFFECT: f64 = 5.0;
/// Standard errors of what is missing at a limit of the force, so that the motion shows more
/// than was recorded: the whole recording is in doubt then.
pub const LIMIT: f64 = 4.0;
/// Standard errors by which force and acceleration miss the mass at one of many frequencies.
pub const NOT_RIGID: f64 = 4.0;
/// Standard deviations of the energy that a model misses, summed up over all frequencies.
pub const MISSED_ENERGY: f64 = 4.0;
/// Once in so many recordings a model that misses nothing is widened by the highest point of
/// a spectrum: about [`MISSED_ENERGY`] as a chance.
pub const MISSED_SELDOM: f64 = 1e-4;
/// Standard errors from which on a force acts later than it was recorded.
pub const LATENESS: f64 = 4.0;
/// Standard errors from which on a mass is another one than before; seven places are tried.
pub const CHANGE: f64 = 5.0;
/// Standard errors from which on a delay is worth advice: it costs little to follow.
pub const DELAY_ADVICE: f64 = 2.0;
/// Standard deviations by which the shoulder of a dip stands out of the noise.
pub const SHOULDER: f64 = 3.0;

/// By how much the criterion of a model falls so that others need no look.
pub const MODEL: f64 = 4.0;
/// By how much it falls where a delay lies between samples: whole periods are likelier.
pub const PART_OF_PERIOD: f64 = 10.0;
/// By how much that of other noise falls: all fits begin again after it.
pub const OTHER_NOISE: f64 = 20.0;
