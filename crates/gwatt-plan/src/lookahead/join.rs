//! Lines that become one: the naive CAM detector of `LinuxCNC` (G64 P Q).
//!
//! Input: elements in order. Output: the same, with runs of feeds put together
//! as long as all their corners stay within Q of the straight line from the
//! start of the first to the end of the last. An arc of the XY plane that bulges
//! less than Q is two chords, which meet at its middle.

use arrayvec::ArrayVec;

use super::blend::Axes;
use super::element::{Element, Joint};
use super::vector::{Vector, add, dot, length, scale, sub, unit};
use gwatt_machine::{AXES, AxisValues};
use std::f64::consts::TAU;

/// Points that are put together, at most: one more ends the line.
const POINTS_MAX: usize = 101;

/// Two points no further apart are one, mm: sums of ways do not come back exactly.
const NO_WAY_MM: f64 = 1e-7;

/// A line and what it stands for.
#[derive(Debug, Clone)]
pub(super) struct Joined<T> {
    /// The line; its tag is that of the last element.
    pub element: Element<T>,
    /// The tag of the first.
    pub first: T,
    /// It is not the element's own path: several elements, or a chord.
    pub is_line: bool,
}

/// Feeds that may still be put together.
#[derive(Debug, Clone)]
pub(super) struct Joiner<T> {
    /// The last element, if any is held; all of them are straight feeds.
    last: Option<(T, Element<T>)>,
    /// Ends of the elements held, from the start of the first.
    points: ArrayVec<Vector, POINTS_MAX>,
    /// A chord of an arc is among them.
    has_chord: bool,
}

impl<T: Copy> Joiner<T> {
    pub fn new() -> Self {
        Self {
            last: None,
            points: ArrayVec::new(),
            has_chord: false,
        }
    }

    /// Whether an element goes through as it is: none is held, and nothing can be
    /// joined to it.
    pub fn passes(&self, element: &Element<T>) -> bool {
        let may_join = matches!(element.joint, Joint::Blend { join_mm, .. } if join_mm > 0.0);
        self.last.is_none() && (!may_join || element.curve.is_none() && !joins(element))
    }

    /// Adds a chord of an arc: what [`Self::push`] gives.
    pub fn push_chord(&mut self, chord: &Element<T>, axes: &Axes) -> [Option<Joined<T>>; 2] {
        let [before, mut alone] = self.push(chord, axes);
        self.has_chord = alone.is_none();
        if let Some(chord) = &mut alone {
            chord.is_line = true;
        }
        [before, alone]
    }

    /// Adds an element that is no arc of two chords; gives what is complete before it,
    /// and the element itself where nothing can be joined to it.
    pub fn push(&mut self, element: &Element<T>, axes: &Axes) -> [Option<Joined<T>>; 2] {
        let change = &element.start;
        let travel = scale([change[0], change[1], change[2]], element.length_mm);
        let joins = joins(element);
        let mut before = None;
        if let Some((_, last)) = &self.last {
            let end = add(self.points.last().copied().unwrap_or_default(), travel);
            if joins && self.links(last, element, end) {
                self.points.push(end);
                if let Some((_, last)) = &mut self.last {
                    *last = *element;
                }
                return [None, None];
            }
            before = self.flush(axes);
        }
        if joins {
            self.points.push(travel);
            self.last = Some((element.tag, *element));
            return [before, None];
        }
        let alone = Joined {
            element: *element,
            first: element.tag,
            is_line: false,
        };
        [before, Some(alone)]
    }

    /// Whether an element can be put to those held.
    fn links(&self, last: &Element<T>, element: &Element<T>, end: Vector) -> bool {
        let Joint::Blend { join_mm, .. } = last.joint else {
            return false;
        };
        let same = last.feed_mm_s == element.feed_mm_s
            && last.joint == element.joint
            && last.axis_accel_mm_s2 == element.axis_accel_mm_s2;
        let length2 = dot(end, end);
        // What comes back to the start of the line ends it.
        if !same || self.points.is_full() || length2 <= NO_WAY_MM * NO_WAY_MM {
            return false;
        }
        self.points.iter().all(|point| {
            let share = (dot(end, *point) / length2).clamp(0.0, 1.0);
            length(sub(*point, scale(end, share))) <= join_mm
        })
    }

    /// What is held, as one line.
    pub fn flush(&mut self, axes: &Axes) -> Option<Joined<T>> {
        let (first, mut element) = self.last.take()?;
        let end = self.points.last().copied()?;
        let several = self.points.len() > 1;
        let is_line = std::mem::take(&mut self.has_chord) || several;
        self.points.clear();
        if several {
            element = straight(&element, end, [0.0; AXES], axes)?;
        }
        Some(Joined {
            element,
            first,
            is_line,
        })
    }
}

/// An element as a straight line with the limits of its direction; `others`: how far
/// the axes move that are not X, Y or Z. `None` if it has no length.
fn straight<T: Copy>(
    of: &Element<T>,
    travel: Vector,
    others: AxisValues,
    axes: &Axes,
) -> Option<Element<T>> {
    let length_mm = length(travel);
    let along = unit(travel)?;
    let mut element = Element {
        length_mm,
        speed_mm_s: f64::INFINITY,
        accel_mm_s2: of.path_accel_mm_s2,
        jerk_mm_s3: f64::INFINITY,
        curve_speed_mm_s: f64::INFINITY,
        curve: None,
        start: others.map(|change| change / length_mm),
        ..*of
    };
    element.start[..3].copy_from_slice(&along);
    for (i, change) in element.start.iter().enumerate() {
        if *change != 0.0 {
            let per = 1.0 / change.abs();
            element.speed_mm_s = element.speed_mm_s.min(axes.speeds[i] * per);
            element.accel_mm_s2 = element.accel_mm_s2.min(of.axis_accel_mm_s2[i] * per);
            element.jerk_mm_s3 = element.jerk_mm_s3.min(axes.jerks[i] * of.jerk_factor * per);
        }
    }
    element.end = element.start;
    Some(element)
}

/// The two chords of an arc that bulges so little that the detector takes it for
/// lines.
pub(super) fn chords<T: Copy>(element: &Element<T>, axes: &Axes) -> Option<[Element<T>; 2]> {
    let curve = element.curve.as_ref()?;
    let Joint::Blend { join_mm, .. } = element.joint else {
        return None;
    };
    // Full turns are not looked at, and are lost in the lines (`chord_deviation`).
    let turned_rad = curve.sweep_rad % TAU;
    let sweep_rad = if turned_rad.abs() <= 1e-5 {
        curve.sweep_rad.signum() * TAU
    } else {
        turned_rad
    };
    let half_rad = 0.5 * sweep_rad;
    let bulge_mm = curve.radius_mm * (1.0 - libm::cos(half_rad));
    if curve.plane != [0, 1] || bulge_mm >= join_mm {
        return None;
    }
    let tangent = unit([element.start[0], element.start[1], 0.0])?;
    let outward = scale([tangent[1], -tangent[0], 0.0], curve.sweep_rad.signum());
    let rise_mm = element.start[2] * element.length_mm;
    // Where the arc has turned by an angle, from its start.
    let at = |turned_rad: f64| {
        let (sin, cos) = libm::sincos(turned_rad.abs());
        let flat = add(scale(outward, cos - 1.0), scale(tangent, sin));
        let rise = rise_mm * turned_rad / sweep_rad;
        add(scale(flat, curve.radius_mm), [0.0, 0.0, rise])
    };
    let (middle, end) = (at(half_rad), at(sweep_rad));
    // The other axes move by half with each.
    let mut others = element.start.map(|change| 0.5 * change * element.length_mm);
    others[..3].fill(0.0);
    let first = straight(element, middle, others, axes)?;
    Some([first, straight(element, sub(end, middle), others, axes)?])
}

/// Whether axes other than X, Y and Z stand.
fn keeps_to_xyz<T>(element: &Element<T>) -> bool {
    element.start.iter().skip(3).all(|change| *change == 0.0)
}

/// Whether an element is a straight feed of X, Y and Z under G64 with Q.
fn joins<T>(element: &Element<T>) -> bool {
    let joined = matches!(element.joint, Joint::Blend { join_mm, .. } if join_mm > 0.0);
    joined && !element.rapid && element.curve.is_none() && keeps_to_xyz(element)
}
