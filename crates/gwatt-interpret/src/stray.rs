//! Arcs that end on another circle than they start on: spirals.
//!
//! `LinuxCNC` runs them with a radius that grows in proportion to the angle, `r₀ + k·φ`
//! (`pmCirclePoint` of its posemath), at the speed asked for along that path
//! (`findSpiralArcLengthFit` of its planner). The move has the circle of the smaller
//! radius `r₁` instead; `r₂` is the larger one. What differs is bounded:
//!
//! *Direction.* The tangent `(k, r)/√(r² + k²)`, radial and along the circle, is turned
//! from the circle's by `ψ = atan(k/r)`, most at `r₁`. Unit vectors at that angle are
//! `2·sin(ψ/2)` apart. Where it rises by `h` too, the move climbs at
//! `β = atan(h/(φ·r₁))`, the path between that and `β' = atan(h/(φ·√(r₂² + k²)))`, and
//! its height has up to `(1 + tan β)·(β − β')` more or less of the speed.
//!
//! *Acceleration.* The radius of curvature is `R(r) = (r² + k²)^1.5 / (r² + 2k²)`, which
//! grows with r. The planner takes it at the start (`pmCircleEffectiveMinRadius`), so that
//! turning takes up to `R(r₂)/R(r₁)` of what it may. Along the path it permits what keeps
//! the plane's axes within theirs over the length `√((r₁·φ)² + (r₂ − r₁)²)` (`ARC_FEED`),
//! where the path is up to `r₂/r₁` times as long. The product bounds both together.

use gwatt_machine::AxisValues;
use gwatt_motion::{Arc, Stray};

/// Below this slope `k/r₁` the end is off its circle by rounding: the powers of an axis
/// are off by no more than this share of what the path speed would draw along it.
const PLAIN: f64 = 0.005;

/// How far the path of an arc from `start` to `end` strays from its circle.
pub(super) fn of_arc(arc: &Arc, start: &AxisValues, end: &AxisValues) -> Stray {
    let [first, second] = arc.plane;
    let radius =
        |at: &AxisValues| libm::hypot(at[first] - arc.center[0], at[second] - arc.center[1]);
    let (from, to) = (radius(start), radius(end));
    let (inner, outer) = (from.min(to), from.max(to));
    let sweep = arc.sweep_rad.abs();
    let k = (outer - inner) / sweep;
    // Not the other way round: what is not a number strays.
    if k <= PLAIN * inner {
        return Stray::NONE;
    }
    let normal = 3_usize.saturating_sub(first + second);
    let rise = (end[normal] - start[normal]).abs();
    let turned = libm::atan2(k, inner);
    let climbs = libm::atan2(rise, sweep * inner);
    let least = libm::atan2(rise, sweep * libm::hypot(outer, k));
    let curvature = |r: f64| {
        let square = r * r + k * k;
        square * square.sqrt() / (square + k * k)
    };
    Stray {
        direction: 2.0 * libm::sin(0.5 * turned) + (1.0 + libm::tan(climbs)) * (climbs - least),
        accel: curvature(outer) / curvature(inner) * (outer / inner) - 1.0,
        in_chords: false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gwatt_machine::AXES;

    fn place(x: f64, y: f64) -> AxisValues {
        let mut at = [0.0; AXES];
        (at[0], at[1]) = (x, y);
        at
    }

    fn arc(radius_mm: f64, sweep_rad: f64) -> Arc {
        Arc {
            plane: [0, 1],
            center: [0.0; 2],
            radius_mm,
            start_angle_rad: 0.0,
            sweep_rad,
        }
    }

    #[test]
    fn rounding_does_not_stray() {
        let end = place(0.0, 10.07);
        let quarter = arc(10.0, std::f64::consts::FRAC_PI_2);
        assert_eq!(of_arc(&quarter, &place(10.0, 0.0), &end), Stray::NONE);
        let end = place(0.0, 10.09);
        assert!(of_arc(&quarter, &place(10.0, 0.0), &end) != Stray::NONE);
    }

    /// The spiral itself, point by point, against the bounds.
    #[test]
    fn bounds_hold_on_the_path() {
        for (from, to, sweep) in [(0.3_f64, 0.328, 1.2), (5.0, 4.97, 0.1), (0.04, 0.06, 4.0)] {
            let (inner, outer) = (from.min(to), from.max(to));
            let end = place(to * libm::cos(sweep), to * libm::sin(sweep));
            let stray = of_arc(&arc(inner, sweep), &place(from, 0.0), &end);
            let k = (to - from) / sweep;
            // The planner's radius of curvature is that at the start.
            let planned = curvature(from, k);
            let (mut direction, mut turning) = (0.0_f64, 0.0_f64);
            for step in 0..=1000 {
                let r = from + k * sweep * f64::from(step) / 1000.0;
                let long = libm::hypot(r, k);
                // Radial and along the circle, from (0, 1).
                direction = direction.max(libm::hypot(k / long, r / long - 1.0));
                turning = turning.max(planned / curvature(r, k));
            }
            assert!(direction <= stray.direction * (1.0 + 1e-12));
            assert!(stray.direction < 1.01 * direction);
            assert!(turning <= 1.0 + stray.accel);
            assert!(outer / inner <= 1.0 + stray.accel);
        }
    }

    /// From the third difference of points, without the formula of the other side.
    fn curvature(r: f64, k: f64) -> f64 {
        let step = 1e-4;
        let point = |angle: f64| {
            let own = r + k * angle;
            [own * libm::cos(angle), own * libm::sin(angle)]
        };
        let [a, b, c] = [point(-step), point(0.0), point(step)];
        let side = |p: [f64; 2], q: [f64; 2]| libm::hypot(p[0] - q[0], p[1] - q[1]);
        let area = ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs();
        side(a, b) * side(b, c) * side(a, c) / (2.0 * area)
    }
}
