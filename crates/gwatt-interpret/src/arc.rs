//! Geometry of arcs: centre and sweep from I J K or R.
//!
//! Start and end need not be on one circle exactly: how far off they may be is the
//! controller's own (`arc_tolerance_mm` in its profile). LinuxCNC and grbl judge alike
//! (`arc_data_ijk` of rs274ngc, `gc_execute_line` of grbl): up to a small difference
//! always, up to a hundred times that where it is at most 0.1 % of the radius.

use std::f64::consts::TAU;

use gwatt_machine::Language;
use gwatt_motion::Arc;

/// Largest difference of the radii, mm, where the profile says nothing (grbl).
const RADIUS_DIFFERENCE_MAX_MM: f64 = 0.5;
/// Difference of the radii that is always allowed then, in mm, and in an inch program.
const RADIUS_TOLERANCE_MM: [f64; 2] = [0.005, 0.0127];
/// What the parts of an arc may be off, mm, in programs in mm and in inches.
const PART_TOLERANCE_MM: [f64; 2] = [0.0283, 0.0719];
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
    pub(super) slack: Slack,
}

/// How far the radii at start and end may differ.
#[derive(Debug, Clone, Copy)]
#[allow(clippy::struct_field_names, reason = "the unit belongs to each name")]
pub(super) struct Slack {
    /// What every controller bears, mm.
    small_mm: f64,
    /// What this one bears always, mm.
    always_mm: f64,
    /// What it bears where the radius is large, mm.
    most_mm: f64,
}

impl Slack {
    /// That of controllers that say nothing of it.
    pub(super) fn usual(inch: bool) -> Self {
        let small_mm = RADIUS_TOLERANCE_MM[usize::from(inch)];
        Self {
            small_mm,
            always_mm: small_mm,
            most_mm: RADIUS_DIFFERENCE_MAX_MM,
        }
    }

    /// What every controller bears at a radius, mm.
    fn usual_mm(&self, radius_mm: f64) -> f64 {
        let share_mm = RADIUS_TOLERANCE * radius_mm;
        self.small_mm.max(share_mm.min(RADIUS_DIFFERENCE_MAX_MM))
    }

    /// That of a language.
    pub(super) fn of(language: &Language, inch: bool) -> Self {
        let usual = Self::usual(inch);
        language.arc_tolerance_mm.map_or(usual, |own| {
            let always_mm = own[usize::from(inch)].max(usual.always_mm);
            Self {
                small_mm: usual.small_mm,
                always_mm,
                most_mm: usual.most_mm.max(100.0 * always_mm),
            }
        })
    }

    /// For a part of an arc that was found good: what the most generous controller
    /// bears (LinuxCNC).
    pub(super) fn of_part(inch: bool) -> Self {
        let small_mm = PART_TOLERANCE_MM[usize::from(inch)];
        Self {
            small_mm,
            always_mm: small_mm,
            most_mm: 100.0 * small_mm,
        }
    }
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
    let found = arc(ends, center, start_mm.min(end_mm), from, to);
    let slack = &ends.slack;
    let outer_mm = start_mm.max(end_mm);
    let own_mm = slack
        .always_mm
        .max((RADIUS_TOLERANCE * outer_mm).min(slack.most_mm));
    if difference <= slack.usual_mm(outer_mm).max(own_mm) {
        return Ok(found);
    }
    Err(ArcFault::RadiiDiffer {
        start_mm,
        end_mm,
        center,
    })
}

/// Whether an arc is further off its circle than any controller bears.
pub(super) fn is_loose(ends: &Ends, arc: &Arc) -> bool {
    let radius = |[x, y]: [f64; 2]| libm::hypot(x - arc.center[0], y - arc.center[1]);
    let (start_mm, end_mm) = (radius(ends.start), radius(ends.end));
    (start_mm - end_mm).abs() > ends.slack.usual_mm(start_mm.max(end_mm))
}

/// The arc of radius `r` (negative: the longer one).
pub(super) fn from_radius(ends: &Ends, r: f64) -> Result<Arc, ArcFault> {
    let chord = [ends.end[0] - ends.start[0], ends.end[1] - ends.start[1]];
    let half = libm::hypot(chord[0], chord[1]) / 2.0;
    let radius = r.abs();
    if half == 0.0 {
        return Err(ArcFault::NoChord);
    }
    if radius == 0.0 || half - radius > ends.slack.small_mm {
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
            slack: Slack::usual(false),
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
    fn a_controller_s_own_tolerance_counts() {
        let own = |inch: usize, start: f64, end: f64| {
            let always_mm = [0.028_284_271_247_461_9, 0.071_842_048_968_553_3][inch];
            let slack = Slack {
                always_mm,
                most_mm: 100.0 * always_mm,
                ..Slack::usual(inch == 1)
            };
            let half = Ends {
                slack,
                ..ends([start, 0.0], [-end, 0.0], false)
            };
            from_center(&half, [0.0, 0.0]).is_ok()
        };
        assert!(own(0, 25.0, 25.028) && !own(0, 25.0, 25.029));
        assert!(own(1, 25.0, 25.071) && !own(1, 25.0, 25.073));
        // 0.1 %, up to a hundred times as much.
        assert!(own(0, 2800.0, 2802.8) && !own(0, 2830.0, 2832.83));
        assert!(own(1, 7100.0, 7107.1) && !own(1, 7190.0, 7197.19));
        // What is always allowed is so on short arcs too.
        assert!(own(0, 0.05, 0.078) && !own(0, 0.05, 0.079));
    }

    #[test]
    fn turns_add_full_circles() {
        let mut helix = ends([10.0, 0.0], [0.0, 10.0], false);
        helix.turns = 3.0;
        let arc = from_center(&helix, [0.0, 0.0]).unwrap();
        assert!((arc.sweep_rad - (FRAC_PI_2 + 2.0 * TAU)).abs() < 1e-12);
    }
}
