//! Geometry of arcs: centre and sweep from I J K or R.
//!
//! Tolerances are those of LinuxCNC ("G2, G3 Arc Move": the radii at start and
//! end may differ by 0.5 mm, and by 0.005 mm or 0.1 % of the radius).

use std::f64::consts::TAU;

use super::moves::Arc;

/// Largest difference of the radii, mm.
const RADIUS_DIFFERENCE_MAX_MM: f64 = 0.5;
/// Difference of the radii that is always allowed, in mm, and in an inch program.
const RADIUS_TOLERANCE_MM: [f64; 2] = [0.005, 0.0127];
/// Share of the radius that the radii may differ by.
const RADIUS_TOLERANCE: f64 = 1e-3;
/// Angles below it count as none, so that the arc is a full circle.
pub(super) const FULL_CIRCLE_RAD: f64 = 1e-6;

/// An arc that cannot be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum ArcFault {
    /// The radius is zero.
    NoRadius,
    /// Radii at start and end, mm.
    RadiiDiffer {
        start_mm: f64,
        end_mm: f64,
        center: [f64; 2],
    },
    /// R, and half the distance from start to end, mm.
    RadiusTooSmall { radius_mm: f64, half_chord_mm: f64 },
    /// R with end = start: any circle through that point would do.
    NoChord,
}

/// Ends of an arc in its plane and how it turns.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ends {
    pub(super) plane: [usize; 2],
    pub(super) start: [f64; 2],
    pub(super) end: [f64; 2],
    pub(super) clockwise: bool,
    /// Number of started turns; 1 for all but `P`.
    pub(super) turns: f64,
    pub(super) inch: bool,
}

/// The arc about `center`.
pub(super) fn from_center(ends: &Ends, center: [f64; 2]) -> Result<Arc, ArcFault> {
    let from = [ends.start[0] - center[0], ends.start[1] - center[1]];
    let to = [ends.end[0] - center[0], ends.end[1] - center[1]];
    let start_mm = libm::hypot(from[0], from[1]);
    let end_mm = libm::hypot(to[0], to[1]);
    if !(start_mm > 0.0 && end_mm > 0.0 && start_mm.is_finite() && end_mm.is_finite()) {
        return Err(ArcFault::NoRadius);
    }
    let difference = (start_mm - end_mm).abs();
    let allowed =
        RADIUS_TOLERANCE_MM[usize::from(ends.inch)].max(RADIUS_TOLERANCE * start_mm.max(end_mm));
    if difference > RADIUS_DIFFERENCE_MAX_MM || difference > allowed {
        return Err(ArcFault::RadiiDiffer {
            start_mm,
            end_mm,
            center,
        });
    }
    Ok(arc(ends, center, start_mm.min(end_mm), from, to))
}

/// The arc of radius `r` (negative: the longer one).
pub(super) fn from_radius(ends: &Ends, r: f64) -> Result<Arc, ArcFault> {
    let chord = [ends.end[0] - ends.start[0], ends.end[1] - ends.start[1]];
    let half = libm::hypot(chord[0], chord[1]) / 2.0;
    let radius = r.abs();
    if half == 0.0 {
        return Err(ArcFault::NoChord);
    }
    if radius == 0.0 || half - radius > RADIUS_TOLERANCE_MM[usize::from(ends.inch)] {
        return Err(ArcFault::RadiusTooSmall {
            radius_mm: radius,
            half_chord_mm: half,
        });
    }
    let radius = radius.max(half);
    let height = ((radius - half) * (radius + half)).sqrt();
    // The short way round has its centre to the left of the chord for a
    // counter-clockwise arc, to the right for a clockwise one.
    let side = if ends.clockwise == (r > 0.0) {
        -1.0
    } else {
        1.0
    };
    let normal = [-chord[1] / (2.0 * half), chord[0] / (2.0 * half)];
    let center = [
        ends.start[0] + chord[0] / 2.0 + side * height * normal[0],
        ends.start[1] + chord[1] / 2.0 + side * height * normal[1],
    ];
    let from = [ends.start[0] - center[0], ends.start[1] - center[1]];
    let to = [ends.end[0] - center[0], ends.end[1] - center[1]];
    Ok(arc(ends, center, radius, from, to))
}

fn arc(ends: &Ends, center: [f64; 2], radius_mm: f64, from: [f64; 2], to: [f64; 2]) -> Arc {
    let start_angle_rad = libm::atan2(from[1], from[0]);
    let cross = from[0] * to[1] - from[1] * to[0];
    let dot = from[0] * to[0] + from[1] * to[1];
    let mut turn = libm::atan2(cross, dot);
    if ends.clockwise {
        turn = -turn;
    }
    if turn < FULL_CIRCLE_RAD {
        turn += TAU;
    }
    turn += (ends.turns - 1.0) * TAU;
    let sweep_rad = if ends.clockwise { -turn } else { turn };
    Arc {
        plane: ends.plane,
        center,
        radius_mm,
        start_angle_rad,
        sweep_rad,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    fn ends(start: [f64; 2], end: [f64; 2], clockwise: bool) -> Ends {
        Ends {
            plane: [0, 1],
            start,
            end,
            clockwise,
            turns: 1.0,
            inch: false,
        }
    }

    #[test]
    fn quarter_and_three_quarters() {
        let ccw = from_center(&ends([10.0, 0.0], [0.0, 10.0], false), [0.0, 0.0]).unwrap();
        assert!((ccw.sweep_rad - FRAC_PI_2).abs() < 1e-15);
        let cw = from_center(&ends([10.0, 0.0], [0.0, 10.0], true), [0.0, 0.0]).unwrap();
        assert!((cw.sweep_rad + 3.0 * FRAC_PI_2).abs() < 1e-15);
    }

    #[test]
    fn same_end_is_a_full_circle() {
        for clockwise in [false, true] {
            let circle =
                from_center(&ends([10.0, 0.0], [10.0, 0.0], clockwise), [0.0, 0.0]).unwrap();
            assert_eq!(circle.sweep_rad.abs(), TAU);
            assert_eq!(circle.sweep_rad < 0.0, clockwise);
        }
    }

    #[test]
    fn radius_gives_the_short_or_the_long_way() {
        let short = from_radius(&ends([0.0, 0.0], [10.0, 10.0], false), 10.0).unwrap();
        assert!((short.sweep_rad - FRAC_PI_2).abs() < 1e-12);
        assert!((short.center[0] - 0.0).abs() < 1e-12 && (short.center[1] - 10.0).abs() < 1e-12);
        let long = from_radius(&ends([0.0, 0.0], [10.0, 10.0], false), -10.0).unwrap();
        assert!((long.sweep_rad - 3.0 * FRAC_PI_2).abs() < 1e-12);
        let clockwise = from_radius(&ends([0.0, 0.0], [10.0, 10.0], true), 10.0).unwrap();
        assert!((clockwise.sweep_rad + FRAC_PI_2).abs() < 1e-12);
        assert!((clockwise.center[0] - 10.0).abs() < 1e-12);
    }

    #[test]
    fn half_circle_by_radius_forgives_rounding() {
        let half = from_radius(&ends([0.0, 0.0], [10.0, 0.0], true), 4.999).unwrap();
        assert!((half.sweep_rad + PI).abs() < 1e-12);
        assert_eq!(half.radius_mm, 5.0);
    }

    #[test]
    fn faults() {
        assert_eq!(
            from_center(&ends([0.0, 0.0], [1.0, 0.0], true), [0.0, 0.0]),
            Err(ArcFault::NoRadius)
        );
        assert!(matches!(
            from_center(&ends([10.0, 0.0], [0.0, 10.1], true), [0.0, 0.0]),
            Err(ArcFault::RadiiDiffer { .. })
        ));
        assert_eq!(
            from_radius(&ends([1.0, 0.0], [1.0, 0.0], true), 5.0),
            Err(ArcFault::NoChord)
        );
        assert!(matches!(
            from_radius(&ends([0.0, 0.0], [10.0, 0.0], true), 4.9),
            Err(ArcFault::RadiusTooSmall { .. })
        ));
    }

    #[test]
    fn turns_add_full_circles() {
        let mut helix = ends([10.0, 0.0], [0.0, 10.0], false);
        helix.turns = 3.0;
        let arc = from_center(&helix, [0.0, 0.0]).unwrap();
        assert!((arc.sweep_rad - (FRAC_PI_2 + 2.0 * TAU)).abs() < 1e-12);
    }
}
