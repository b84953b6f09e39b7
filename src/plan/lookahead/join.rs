//! Lines that become one: the naive CAM detector of `LinuxCNC` (G64 Q).
//!
//! Input: elements in order. Output: the same, with runs of feeds put together
//! as long as all their corners stay within Q of the straight line from the
//! start of the first to the end of the last.

use arrayvec::ArrayVec;

use super::blend::Axes;
use super::element::{Element, Joint};
use super::vector::{Vector, add, dot, length, scale, sub, unit};
use crate::machine::AXES;

/// Points that are put together, at most: one more ends the line.
const POINTS_MAX: usize = 101;

/// A line and what it stands for.
#[derive(Debug, Clone)]
pub(super) struct Joined<T> {
    /// The line; its tag is that of the last element.
    pub element: Element<T>,
    /// The tag of the first.
    pub first: T,
    /// It is more than one element.
    pub several: bool,
}

/// Feeds that may still be put together.
#[derive(Debug, Clone)]
pub(super) struct Joiner<T> {
    /// The last element, if any is held; all of them are straight feeds.
    last: Option<(T, Element<T>)>,
    /// Ends of the elements held, from the start of the first.
    points: ArrayVec<Vector, POINTS_MAX>,
}

impl<T: Copy> Joiner<T> {
    pub fn new() -> Self {
        Self {
            last: None,
            points: ArrayVec::new(),
        }
    }

    /// Adds an element; gives what is complete before it, and the element
    /// itself where nothing can be joined to it.
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
            several: false,
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
        if !same || self.points.is_full() || length2 == 0.0 {
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
        self.points.clear();
        if several {
            element.length_mm = length(end);
            let along = unit(end)?;
            let accels = axes.accel(&element.axis_accel_mm_s2);
            element.speed_mm_s = f64::INFINITY;
            element.accel_mm_s2 = element.path_accel_mm_s2;
            element.jerk_mm_s3 = f64::INFINITY;
            element.start = [0.0; AXES];
            for (i, change) in along.into_iter().enumerate() {
                element.start[i] = change;
                if change != 0.0 {
                    element.speed_mm_s = element.speed_mm_s.min(axes.speed[i] / change.abs());
                    element.accel_mm_s2 = element.accel_mm_s2.min(accels[i] / change.abs());
                    element.jerk_mm_s3 = element.jerk_mm_s3.min(axes.jerk[i] / change.abs());
                }
            }
            element.end = element.start;
        }
        Some(Joined {
            element,
            first,
            several,
        })
    }
}

/// Whether an element is a straight feed of X, Y and Z under G64 with Q.
fn joins<T>(element: &Element<T>) -> bool {
    let joined = matches!(element.joint, Joint::Blend { join_mm, .. } if join_mm > 0.0);
    joined
        && !element.rapid
        && element.curve.is_none()
        && element.start.iter().skip(3).all(|change| *change == 0.0)
}
