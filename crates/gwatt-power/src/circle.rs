//! One axis on an arc or a helix: its motion, and bounds of its power.
//!
//! Input: speed ω and acceleration α of the angle (or of the path, for an axis
//! that follows in proportion). Output: speed and acceleration of the axis,
//! SI, and bounds that hold for any angle up to a speed.
//!
//! A plane axis is `x = R·cos q` with `q' = ω`, `q'' = α` constant, hence
//!
//! ```text
//! x'  = −R·ω·sin q              x''   = −R·(α·sin q + ω²·cos q)
//! x'·x'' = R²·ω·(α·sin² q + ω²·sin q·cos q)
//! ```
//!
//! and each bound below is the amplitude of the sinusoids of such a derivative.

use super::axis::AxisPower;

/// How an axis follows the arc.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Shape {
    /// First axis of the plane, radius in SI.
    Cosine(f64),
    /// Second axis of the plane, radius in SI.
    Sine(f64),
    /// As `Cosine`, ahead by an angle of which sine and cosine are given.
    Turn {
        /// In SI.
        radius: f64,
        /// Of the angle.
        sin: f64,
        /// Of the angle.
        cos: f64,
    },
    /// In proportion to the path: signed SI motion per mm.
    Line(f64),
}

/// An axis on an arc.
#[derive(Debug, Clone, Copy)]
pub(super) struct ArcAxis<'a> {
    /// Its coefficients.
    pub axis: &'a AxisPower,
    /// How it follows.
    pub shape: Shape,
}

/// Motion along the arc at one instant.
#[derive(Debug, Clone, Copy)]
pub(super) struct Motion {
    /// Path speed, mm/s, and acceleration, mm/s².
    pub v: f64,
    /// See `v`.
    pub a: f64,
    /// Angular speed, rad/s, not negative, and acceleration, rad/s².
    pub omega: f64,
    /// See `omega`.
    pub alpha: f64,
    /// Sine and cosine of the angle, the sine with the sign of the sweep's sense.
    pub sin: f64,
    /// See `sin`.
    pub cos: f64,
    /// Sense of the sweep, ±1.
    pub sense: f64,
}

/// What the motion along the arc reaches over a piece.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reach {
    /// The largest speeds, and the acceleration: where it changes, the largest
    /// size of it. The angle is of no account.
    pub fastest: Motion,
    /// Smallest and largest acceleration: of the path, mm/s², and of the angle.
    pub accel: [f64; 2],
    /// See `accel`.
    pub alpha: [f64; 2],
    /// Largest sizes of the third and fourth derivatives of the path, mm/s³
    /// and mm/s⁴, and of the angle; 0 at constant acceleration.
    pub path_rates: [f64; 2],
    /// See `path_rates`.
    pub angle_rates: [f64; 2],
}

impl Reach {
    /// Bounds of the first to fourth derivative of the position of an axis.
    ///
    /// With ω, α, j, s those of the angle the third is at most
    /// `R·(j + 3·ω·α + ω³)`, the fourth `R·(s + 4·ω·j + 3·α² + 6·ω²·α + ω⁴)`.
    fn derivatives(&self, shape: Shape) -> [f64; 4] {
        let m = &self.fastest;
        match shape {
            Shape::Line(direction) => {
                let [jerk, snap] = self.path_rates;
                [m.v, m.a, jerk, snap].map(|rate| (direction * rate).abs())
            }
            Shape::Cosine(r) | Shape::Sine(r) | Shape::Turn { radius: r, .. } => {
                let (w, alpha) = (m.omega, m.alpha.abs());
                let [jerk, snap] = self.angle_rates;
                let w2 = w * w;
                [
                    w,
                    alpha + w2,
                    jerk + w * (3.0 * alpha + w2),
                    snap + 4.0 * w * jerk + 3.0 * alpha * alpha + w2 * (6.0 * alpha + w2),
                ]
                .map(|rate| r * rate)
            }
        }
    }

    /// Whether acceleration is constant.
    fn is_steady(&self) -> bool {
        self.path_rates == [0.0; 2]
    }
}

impl ArcAxis<'_> {
    /// Speed and acceleration of the axis, SI.
    #[inline]
    pub fn motion(&self, m: &Motion) -> (f64, f64) {
        let square = m.omega * m.omega;
        match self.shape {
            Shape::Cosine(r) => (
                -r * m.sense * m.omega * m.sin,
                -r * (m.sense * m.alpha * m.sin + square * m.cos),
            ),
            Shape::Sine(r) => (
                r * m.sense * m.omega * m.cos,
                r * (m.sense * m.alpha * m.cos - square * m.sin),
            ),
            Shape::Turn { radius, sin, cos } => {
                let turned = Motion {
                    sin: m.sin * cos + m.cos * sin,
                    cos: m.cos * cos - m.sin * sin,
                    ..*m
                };
                let shape = Shape::Cosine(radius);
                Self { shape, ..*self }.motion(&turned)
            }
            Shape::Line(direction) => (direction * m.v, direction * m.a),
        }
    }

    /// `motion` between two turning points, where the axis moves in the
    /// direction `sign`: at a turning point rounding must not let it move back
    /// with the friction of the other direction.
    #[inline]
    pub fn motion_towards(&self, sign: f64, m: &Motion) -> (f64, f64) {
        let (v, a) = self.motion(m);
        if v * sign < 0.0 { (0.0, a) } else { (v, a) }
    }

    /// Bounds of the rates at which acceleration (SI) and force change while
    /// speeds are at most those of the reach.
    pub fn slopes(&self, reach: &Reach, factor: f64) -> (f64, f64) {
        let m = &reach.fastest;
        if !reach.is_steady() {
            let [_, accel, jerk, _] = reach.derivatives(self.shape);
            return (
                jerk,
                self.axis.mass * factor * jerk + self.axis.viscous_most() * accel,
            );
        }
        match self.shape {
            Shape::Line(direction) => (0.0, self.axis.viscous_most() * (direction * m.a).abs()),
            Shape::Cosine(r) | Shape::Sine(r) | Shape::Turn { radius: r, .. } => {
                let square = m.omega * m.omega;
                let jerk = r * m.omega * amplitude(3.0 * m.alpha, square);
                let accel = r * amplitude(m.alpha, square);
                (
                    jerk,
                    self.axis.mass * factor * jerk + self.axis.viscous_most() * accel,
                )
            }
        }
    }

    /// Bound of `|d²/dt²|` of any smooth branch of the electrical power,
    /// conversion left out, while speeds are at most those of the reach: of
    /// `v·F` and of `R·F²`. `factor` is how far acceleration may exceed the
    /// command.
    pub fn curvature(&self, reach: &Reach, factor: f64) -> (f64, f64) {
        let axis = self.axis;
        let m = &reach.fastest;
        let mass = axis.mass * factor;
        let constant = axis.coulomb_most() + axis.gravity.abs();
        if !reach.is_steady() {
            let [x1, x2, x3, x4] = reach.derivatives(self.shape);
            let force = mass * x2 + axis.viscous_most() * x1 + constant;
            let slope = mass * x3 + axis.viscous_most() * x2;
            let bend = mass * x4 + axis.viscous_most() * x3;
            return (
                x3 * force + 2.0 * x2 * slope + x1 * bend,
                axis.copper * 2.0 * (slope * slope + force * bend),
            );
        }
        let (w, alpha) = (m.omega, m.alpha.abs());
        match self.shape {
            Shape::Line(direction) => {
                let accel = direction * m.a;
                let slope = axis.viscous_most() * accel;
                (
                    2.0 * (slope * accel).abs(),
                    2.0 * axis.copper * slope * slope,
                )
            }
            Shape::Cosine(r) | Shape::Sine(r) | Shape::Turn { radius: r, .. } => {
                let (w2, a2) = (w * w, alpha * alpha);
                let w4 = w2 * w2;
                // Amplitudes of x', x'', x''', x''''.
                let x1 = r * w;
                let x2 = r * (a2 + w4).sqrt();
                let x3 = r * w * (9.0 * a2 + w4).sqrt();
                let inertial = amplitude(36.0 * w2 * alpha, f64::max(24.0 * a2, 8.0 * w4));
                let viscous = 2.0 * a2 + amplitude(10.0 * w2 * alpha, f64::max(2.0 * a2, 4.0 * w4));
                let mechanical = mass * r * r * w * 0.25 * inertial
                    + axis.viscous_most() * r * r * 0.5 * viscous
                    + constant * x3;
                if axis.copper == 0.0 {
                    return (mechanical, 0.0);
                }
                let x4 = r * amplitude(3.0 * a2 + w4, 6.0 * alpha * w2);
                let force = mass * x2 + axis.viscous_most() * x1 + constant;
                let slope = mass * x3 + axis.viscous_most() * x2;
                let bend = mass * x4 + axis.viscous_most() * x3;
                (
                    mechanical,
                    axis.copper * 2.0 * (slope * slope + force * bend),
                )
            }
        }
    }

    /// Upper bounds of the power drawn (W) and fed back at speeds up to those
    /// of the reach, whatever the angle; `factors` for drawing and feeding back.
    pub fn envelope(&self, reach: &Reach, factors: [f64; 2]) -> [f64; 2] {
        let axis = self.axis;
        let m = &reach.fastest;
        let (speed, accel, drawn, fed_back) = match self.shape {
            Shape::Line(direction) => {
                let square = direction * direction * m.v;
                let speed = (direction * m.v).abs();
                let accel = (direction * m.a).abs();
                let [low, high] = reach.accel;
                (
                    speed,
                    accel,
                    square * high.max(0.0),
                    square * (-low).max(0.0),
                )
            }
            Shape::Cosine(r) | Shape::Sine(r) | Shape::Turn { radius: r, .. } => {
                let w2 = m.omega * m.omega;
                let swing = amplitude(m.alpha, w2);
                let half = 0.5 * r * r * m.omega;
                let [low, high] = reach.alpha;
                let (drawn, fed_back) = (half * (swing + high), half * (swing - low));
                (r * m.omega, r * swing, drawn, fed_back)
            }
        };
        let constant = axis.coulomb_most() + axis.gravity.abs();
        let largest = factors[0].max(factors[1]);
        let force = axis.mass * accel * largest + axis.viscous_most() * speed + constant;
        let resisting = speed * (constant + axis.viscous_most() * speed);
        [
            (axis.mass * drawn * factors[0] + resisting) * axis.inverse_efficiency
                + axis.copper * force * force,
            (axis.mass * fed_back * factors[1] + speed * axis.gravity.abs()) * axis.efficiency,
        ]
    }
}

/// Amplitude of `a·cos + b·sin`.
#[inline]
fn amplitude(a: f64, b: f64) -> f64 {
    (a * a + b * b).sqrt()
}
