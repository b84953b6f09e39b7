//! Programmable frames: TRANS ROT SCALE MIRROR and their additive forms.
//!
//! "Coordinate transformations (frames)": the substituting words delete the
//! frame before, the additive ones (ATRANS …) are put on what is there.

use gwatt_machine::{AXES, AxisValues};

/// Axes that can be turned, scaled and mirrored: X, Y and Z.
pub(super) const SPACE: usize = 3;

type Matrix = [[f64; SPACE]; SPACE];

const IDENTITY: Matrix = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// From program coordinates to machine coordinates.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Frame {
    matrix: Matrix,
    /// Its inverse.
    back: Matrix,
    /// What is added at last, for every axis.
    pub(super) shift: AxisValues,
}

impl Default for Frame {
    fn default() -> Self {
        Self {
            matrix: IDENTITY,
            back: IDENTITY,
            shift: [0.0; AXES],
        }
    }
}

impl Frame {
    /// True while a program coordinate is a machine coordinate but for an offset.
    pub(super) fn is_plain(&self) -> bool {
        self.matrix == IDENTITY
    }

    /// Puts an offset inside: in the axes as they are turned now.
    pub(super) fn translate(&mut self, by: &AxisValues) {
        let [x, y, z] = multiply(&self.matrix, [by[0], by[1], by[2]]);
        for (sum, more) in self.shift.iter_mut().zip([x, y, z]) {
            *sum += more;
        }
        for (sum, more) in self.shift.iter_mut().zip(by).skip(SPACE) {
            *sum += more;
        }
    }

    /// Puts a turn inside about the axis `about`, counter-clockwise seen from
    /// its positive end.
    pub(super) fn rotate(&mut self, about: usize, angle_deg: f64) {
        let (sin, cos) = sin_cos_deg(angle_deg);
        let [first, second] = [(about + 1) % SPACE, (about + 2) % SPACE];
        let turn = |sin: f64| {
            let mut turn = IDENTITY;
            turn[first][first] = cos;
            turn[first][second] = -sin;
            turn[second][first] = sin;
            turn[second][second] = cos;
            turn
        };
        self.matrix = product(&self.matrix, &turn(sin));
        self.back = product(&turn(-sin), &self.back);
    }

    /// Puts a scale inside; -1 mirrors. No factor may be 0.
    pub(super) fn scale(&mut self, factors: [f64; SPACE]) {
        let diagonal = |factors: [f64; SPACE]| {
            let mut matrix = IDENTITY;
            for (axis, factor) in factors.into_iter().enumerate() {
                matrix[axis][axis] = factor;
            }
            matrix
        };
        self.matrix = product(&self.matrix, &diagonal(factors));
        self.back = product(&diagonal(factors.map(|factor| 1.0 / factor)), &self.back);
    }

    /// Whether circles in any plane stay circles.
    pub(super) fn keeps_circles(&self) -> bool {
        crate::frame::keeps_circles(&self.matrix)
    }

    /// Machine coordinates of program coordinates.
    pub(super) fn machine(&self, program: &AxisValues) -> AxisValues {
        let [x, y, z] = multiply(&self.matrix, [program[0], program[1], program[2]]);
        let mut at = *program;
        at[..SPACE].copy_from_slice(&[x, y, z]);
        std::array::from_fn(|axis| at[axis] + self.shift[axis])
    }

    /// Program coordinates of a place.
    pub(super) fn program(&self, at: &AxisValues) -> AxisValues {
        let mut program: AxisValues = std::array::from_fn(|axis| at[axis] - self.shift[axis]);
        let [x, y, z] = multiply(&self.back, [program[0], program[1], program[2]]);
        program[..SPACE].copy_from_slice(&[x, y, z]);
        program
    }

    /// Whether the place of machine axis `axis` depends on program axis `by`.
    pub(super) fn depends(&self, axis: usize, by: usize) -> bool {
        if axis < SPACE && by < SPACE {
            self.matrix[axis][by] != 0.0
        } else {
            axis == by
        }
    }

    /// How circles of a plane appear: their scale, and whether they turn the
    /// other way round. `None` when they leave the plane or become ellipses.
    pub(super) fn plane(&self, [first, second, normal]: [usize; 3]) -> Option<(f64, bool)> {
        if self.is_plain() {
            return Some((1.0, false));
        }
        if first.max(second).max(normal) >= SPACE {
            return None;
        }
        let m = &self.matrix;
        let [a, b] = [m[first][first], m[first][second]];
        let [c, d] = [m[second][first], m[second][second]];
        let scale = libm::hypot(a, c);
        let none = |value: f64| value.abs() <= 1e-9 * scale;
        let flat = [first, second]
            .iter()
            .all(|&axis| none(m[axis][normal]) && none(m[normal][axis]));
        let flipped = a * d - b * c < 0.0;
        let alike = if flipped {
            none(a + d) && none(b - c)
        } else {
            none(a - d) && none(b + c)
        };
        (flat && alike && scale > 0.0).then_some((scale, flipped))
    }
}

/// Sine and cosine, exact at right angles.
pub(super) fn sin_cos_deg(angle_deg: f64) -> (f64, f64) {
    match angle_deg.rem_euclid(360.0) {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        angle => libm::sincos(angle.to_radians()),
    }
}

fn multiply(matrix: &Matrix, [x, y, z]: [f64; SPACE]) -> [f64; SPACE] {
    matrix.map(|[a, b, c]| a * x + b * y + c * z)
}

fn product(left: &Matrix, right: &Matrix) -> Matrix {
    std::array::from_fn(|row| {
        std::array::from_fn(|column| {
            (0..SPACE)
                .map(|inner| left[row][inner] * right[inner][column])
                .sum()
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(x: f64, y: f64, z: f64) -> AxisValues {
        let mut at = [0.0; AXES];
        at[..3].copy_from_slice(&[x, y, z]);
        at
    }

    #[test]
    fn what_is_added_lies_in_the_turned_axes() {
        let mut frame = Frame::default();
        frame.translate(&place(10.0, 0.0, 0.0));
        frame.rotate(2, 90.0);
        frame.translate(&place(5.0, 0.0, 0.0));
        assert_eq!(frame.machine(&place(1.0, 0.0, 0.0))[..3], [10.0, 6.0, 0.0]);
        assert_eq!(frame.plane([0, 1, 2]), Some((1.0, false)));
        assert_eq!(frame.plane([2, 0, 1]), None);
        frame.scale([-2.0, 2.0, 1.0]);
        assert_eq!(frame.plane([0, 1, 2]), Some((2.0, true)));
        let there = place(3.0, -4.0, 5.0);
        let back = frame.program(&frame.machine(&there));
        assert!((0..3).all(|axis| (back[axis] - there[axis]).abs() < 1e-12));
    }
}
