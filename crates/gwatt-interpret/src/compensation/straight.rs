//! Outside corners that the tool passes by straight moves.
//!
//! Fanuc B-63944EN, "Tool Movement in Offset Mode": where the path bends by up
//! to 90° the tool's centre goes on to where the shifted tangents meet; where it
//! bends by more, it goes on by the radius, across, and comes back by the
//! radius. Ends of arcs are left and met along their tangents. What is more than
//! the shifted moves themselves belongs to the block after the corner.

use super::Compensation;
use super::Fault;
use super::corner::{Bend, Track};
use super::follow::Element;
use crate::vector::{Vector, add, dot, left, scale, sub, unit};
use gwatt_motion::{Move, Step};

impl Compensation {
    /// Takes the tool round `corner`, in front of `mv`.
    pub(super) fn straight_round(
        &mut self,
        mv: &Move,
        corner: Vector,
        before: &Track,
        after: &Element,
        out: &mut Vec<Step>,
    ) -> Result<(), Fault> {
        let offset = sub(self.hold.end, corner);
        let came = unit(scale(left(offset), -self.side)).ok_or(Fault::NoCorner)?;
        let goes = after.tangent;
        let offset = |direction| scale(left(direction), self.side * self.radius_mm);
        let cosine = dot(came, goes);
        let (first, second) = if cosine >= 0.0 {
            let sum = add(offset(came), offset(goes));
            let point = add(corner, scale(sum, 1.0 / (1.0 + cosine)));
            (point, point)
        } else {
            let on = add(offset(came), scale(came, self.radius_mm));
            let back = sub(offset(goes), scale(goes, self.radius_mm));
            (add(corner, on), add(corner, back))
        };
        if matches!(before, Track::Line { .. }) {
            self.hold.release_at(first, out)?;
        } else {
            self.hold.finish(out)?;
            self.hold.cross(mv, first, out);
        }
        self.hold.cross(mv, second, out);
        if matches!(after.track, Track::Circle(_)) {
            self.hold.cross(mv, after.start, out);
        }
        Ok(())
    }

    /// Type B: the tool goes round the last corner before it leaves by `mv`.
    pub(super) fn turn_to_leave(&mut self, mv: &Move, out: &mut Vec<Step>) -> Result<(), Fault> {
        let [from, to] = [&mv.start, &mv.end].map(|at| self.plane.map(|axis| at[axis]));
        let Some(before) = self.hold.track().copied() else {
            return self.hold.finish(out);
        };
        let after = self.element(mv, from, to)?;
        if self.entering || self.bend(from, &before, &after) != Bend::Outside {
            return self.hold.finish(out);
        }
        self.straight_round(mv, from, &before, &after, out)
    }
}
