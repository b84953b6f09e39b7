//! From program coordinates to machine coordinates.
//!
//! Nearly always that is one offset for each axis. Rotation, scaling and
//! mirroring of X, Y and Z make it an affine map, which costs a little more.

use gwatt_machine::{AXES, AxisValues};

/// Axes that can be turned, scaled and mirrored: X, Y and Z.
pub(super) const SPACE: usize = 3;
/// Difference of matrix entries that is rounding.
const ROUNDING: f64 = 1e-9;

/// An affine map of space: `matrix · p + shift`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Affine {
    matrix: [[f64; SPACE]; SPACE],
    shift: [f64; SPACE],
}

impl Affine {
    pub(super) const IDENTITY: Self = Self {
        matrix: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        shift: [0.0; SPACE],
    };

    /// A shift.
    pub(super) fn offset(shift: [f64; SPACE]) -> Self {
        Self {
            shift,
            ..Self::IDENTITY
        }
    }

    /// Each axis by its factor about `center`; a factor of -1 mirrors.
    pub(super) fn scaling(center: [f64; SPACE], factor: [f64; SPACE]) -> Self {
        let mut map = Self::IDENTITY;
        for axis in 0..SPACE {
            map.matrix[axis][axis] = factor[axis];
            map.shift[axis] = center[axis] * (1.0 - factor[axis]);
        }
        map
    }

    /// A turn in a plane (first and second axis), counter-clockwise in degrees.
    pub(super) fn rotation(plane: [usize; 2], center: [f64; 2], angle_deg: f64) -> Self {
        let [first, second] = plane;
        let (sin, cos) = sin_cos_deg(angle_deg);
        let mut map = Self::IDENTITY;
        map.matrix[first][first] = cos;
        map.matrix[first][second] = -sin;
        map.matrix[second][first] = sin;
        map.matrix[second][second] = cos;
        map.shift[first] = center[0] - (cos * center[0] - sin * center[1]);
        map.shift[second] = center[1] - (sin * center[0] + cos * center[1]);
        map
    }

    pub(super) fn apply(&self, point: [f64; SPACE]) -> [f64; SPACE] {
        let turned = multiply(&self.matrix, point);
        std::array::from_fn(|axis| turned[axis] + self.shift[axis])
    }

    /// First this map, then `outer`.
    pub(super) fn then(&self, outer: &Self) -> Self {
        let columns: [[f64; SPACE]; SPACE] = std::array::from_fn(|column| {
            let column = std::array::from_fn(|row| self.matrix[row][column]);
            multiply(&outer.matrix, column)
        });
        Self {
            matrix: std::array::from_fn(|row| std::array::from_fn(|column| columns[column][row])),
            shift: outer.apply(self.shift),
        }
    }
}

/// Sine and cosine, exact at right angles.
pub(super) fn sin_cos_deg(angle_deg: f64) -> (f64, f64) {
    let turn = angle_deg.rem_euclid(360.0);
    if turn == 0.0 {
        (0.0, 1.0)
    } else if turn == 90.0 {
        (1.0, 0.0)
    } else if turn == 180.0 {
        (0.0, -1.0)
    } else if turn == 270.0 {
        (-1.0, 0.0)
    } else {
        libm::sincos(turn.to_radians())
    }
}

fn multiply(matrix: &[[f64; SPACE]; SPACE], point: [f64; SPACE]) -> [f64; SPACE] {
    let [x, y, z] = point;
    matrix.map(|[a, b, c]| a * x + b * y + c * z)
}

/// The inverse; `None` for a matrix that has none.
fn inverse(m: &[[f64; SPACE]; SPACE]) -> Option<[[f64; SPACE]; SPACE]> {
    // Cofactors: each entry of the inverse is one, divided by the determinant.
    let cofactor = |row: usize, column: usize| {
        let [r, s] = [(row + 1) % 3, (row + 2) % 3];
        let [c, d] = [(column + 1) % 3, (column + 2) % 3];
        m[r][c] * m[s][d] - m[r][d] * m[s][c]
    };
    let determinant: f64 = (0..SPACE)
        .map(|column| m[0][column] * cofactor(0, column))
        .sum();
    (determinant.abs() > 1e-30).then(|| {
        std::array::from_fn(|row| std::array::from_fn(|column| cofactor(column, row) / determinant))
    })
}

/// Whether a map turns, mirrors and scales all axes alike: its columns are as long as one
/// another and at right angles.
pub(super) fn keeps_circles(matrix: &[[f64; SPACE]; SPACE]) -> bool {
    let product =
        |one: usize, other: usize| -> f64 { matrix.iter().map(|row| row[one] * row[other]).sum() };
    let square = product(0, 0);
    let near = |value: f64, wanted: f64| (value - wanted).abs() <= ROUNDING * square;
    square > 0.0
        && (0..SPACE).all(|axis| {
            near(product(axis, axis), square) && near(product(axis, (axis + 1) % SPACE), 0.0)
        })
}

/// How a plane appears after the map: its own scale, and whether it is flipped.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PlaneMap {
    pub(super) scale: f64,
    pub(super) flipped: bool,
}

/// The map in force.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Frame {
    /// What is added at last, for every axis.
    shift: AxisValues,
    /// Matrix and its inverse, if the axes are turned or scaled.
    turn: Option<Box<Turn>>,
}

#[derive(Debug, Clone, PartialEq)]
struct Turn {
    forward: [[f64; SPACE]; SPACE],
    back: [[f64; SPACE]; SPACE],
}

impl Frame {
    /// The map `map` of X, Y and Z, then `shift` for all axes. A map without
    /// inverse (a scale of 0) counts as identity: nobody makes one.
    pub(super) fn new(map: &Affine, mut shift: AxisValues) -> Self {
        for (sum, more) in shift.iter_mut().zip(map.shift) {
            *sum += more;
        }
        let turned = map.matrix != Affine::IDENTITY.matrix;
        let back = turned.then(|| inverse(&map.matrix)).flatten();
        Self {
            shift,
            turn: back.map(|back| {
                Box::new(Turn {
                    forward: map.matrix,
                    back,
                })
            }),
        }
    }

    /// True while a program coordinate is a machine coordinate but for an offset.
    #[inline]
    pub(super) fn is_plain(&self) -> bool {
        self.turn.is_none()
    }

    /// Moves the origin of an axis that is not turned.
    pub(super) fn nudge(&mut self, axis: usize, by: f64) {
        self.shift[axis] += by;
    }

    /// Machine coordinate of a program coordinate while the map is plain.
    #[inline]
    pub(super) fn shifted(&self, axis: usize, value: f64) -> f64 {
        value + self.shift[axis]
    }

    /// Machine coordinate of a program coordinate, for an axis that is neither
    /// turned nor scaled by another one.
    #[inline]
    pub(super) fn absolute(&self, axis: usize, value: f64) -> f64 {
        let factor = match &self.turn {
            Some(turn) if axis < SPACE => turn.forward[axis][axis],
            _ => 1.0,
        };
        value * factor + self.shift[axis]
    }

    /// Program coordinates of a place.
    pub(super) fn program(&self, at: &AxisValues) -> AxisValues {
        let mut program: AxisValues = std::array::from_fn(|axis| at[axis] - self.shift[axis]);
        if let Some(turn) = &self.turn {
            let [x, y, z] = multiply(&turn.back, [program[0], program[1], program[2]]);
            program[..SPACE].copy_from_slice(&[x, y, z]);
        }
        program
    }

    /// Machine coordinates of program coordinates.
    pub(super) fn machine(&self, program: &AxisValues) -> AxisValues {
        let mut at = *program;
        if let Some(turn) = &self.turn {
            let [x, y, z] = multiply(&turn.forward, [at[0], at[1], at[2]]);
            at[..SPACE].copy_from_slice(&[x, y, z]);
        }
        std::array::from_fn(|axis| at[axis] + self.shift[axis])
    }

    /// Whether the place of machine axis `axis` depends on program axis `by`.
    pub(super) fn depends(&self, axis: usize, by: usize) -> bool {
        match &self.turn {
            Some(turn) if axis < SPACE && by < SPACE => turn.forward[axis][by] != 0.0,
            _ => axis == by,
        }
    }

    /// Whether an axis is neither turned, scaled nor mirrored.
    pub(super) fn leaves_alone(&self, axis: usize) -> bool {
        (0..SPACE).all(|by| {
            let factor = |row: usize, column: usize| match &self.turn {
                Some(turn) if row < SPACE => turn.forward[row][column],
                _ => f64::from(u8::from(row == column)),
            };
            let own = f64::from(u8::from(by == axis));
            axis >= SPACE || factor(axis, by) == own && factor(by, axis) == own
        })
    }

    /// Whether circles in any plane stay circles.
    pub(super) fn keeps_circles(&self) -> bool {
        self.turn
            .as_ref()
            .is_none_or(|turn| keeps_circles(&turn.forward))
    }

    /// How a plane appears in the machine; `None` when it is no longer that
    /// plane, or when circles in it become ellipses.
    pub(super) fn plane(&self, [first, second, normal]: [usize; 3]) -> Option<PlaneMap> {
        let Some(turn) = &self.turn else {
            return Some(PlaneMap {
                scale: 1.0,
                flipped: false,
            });
        };
        if first.max(second).max(normal) >= SPACE {
            return None;
        }
        let m = &turn.forward;
        let leaves = [first, second]
            .iter()
            .any(|&axis| m[axis][normal].abs().max(m[normal][axis].abs()) > ROUNDING);
        let [a, b] = [m[first][first], m[first][second]];
        let [c, d] = [m[second][first], m[second][second]];
        let scale = libm::hypot(a, c);
        let near = |one: f64, other: f64| (one - other).abs() <= ROUNDING * scale;
        let flipped = a * d - b * c < 0.0;
        let alike = if flipped {
            near(a, -d) && near(b, c)
        } else {
            near(a, d) && near(b, -c)
        };
        (!leaves && alike && scale > 0.0).then_some(PlaneMap { scale, flipped })
    }
}

impl Default for Frame {
    fn default() -> Self {
        Self {
            shift: [0.0; AXES],
            turn: None,
        }
    }
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
    fn a_turn_about_a_point_keeps_that_point() {
        let map = Affine::rotation([0, 1], [10.0, 5.0], 90.0);
        assert_eq!(map.apply([10.0, 5.0, 3.0]), [10.0, 5.0, 3.0]);
        assert_eq!(map.apply([11.0, 5.0, 3.0]), [10.0, 6.0, 3.0]);
    }

    #[test]
    fn scaling_comes_before_the_turn() {
        let scaled = Affine::scaling([1.0, 0.0, 0.0], [2.0, 2.0, 1.0]);
        let map = scaled.then(&Affine::rotation([0, 1], [0.0, 0.0], 90.0));
        // (3, 0) becomes (5, 0), then (0, 5).
        assert_eq!(map.apply([3.0, 0.0, 7.0]), [0.0, 5.0, 7.0]);
    }

    #[test]
    fn there_and_back() {
        let map = Affine::scaling([1.0, 2.0, 3.0], [-1.0, 0.5, 2.0]).then(&Affine::rotation(
            [2, 0],
            [4.0, -1.0],
            33.0,
        ));
        let mut shift = [0.0; AXES];
        shift[..4].copy_from_slice(&[5.0, 6.0, 7.0, 8.0]);
        let frame = Frame::new(&map, shift);
        let mut at = place(1.5, -2.5, 3.5);
        at[3] = 90.0;
        let back = frame.machine(&frame.program(&at));
        for axis in 0..AXES {
            assert!((back[axis] - at[axis]).abs() < 1e-12);
        }
        assert_eq!(frame.program(&at)[3], 82.0);
    }

    #[test]
    fn planes_that_stay_planes() {
        let turned = Frame::new(&Affine::rotation([0, 1], [0.0; 2], 30.0), [0.0; AXES]);
        assert!(turned.plane([0, 1, 2]).is_some_and(|map| !map.flipped));
        assert_eq!(turned.plane([2, 0, 1]), None);
        let mirrored = Frame::new(&Affine::scaling([0.0; 3], [-2.0, 2.0, 1.0]), [0.0; AXES]);
        let flipped = PlaneMap {
            scale: 2.0,
            flipped: true,
        };
        assert_eq!(mirrored.plane([0, 1, 2]), Some(flipped));
        assert_eq!(mirrored.plane([2, 0, 1]), None);
    }

    #[test]
    fn an_identity_is_plain() {
        assert!(Frame::new(&Affine::IDENTITY, [1.0; AXES]).is_plain());
        assert!(Frame::new(&Affine::rotation([0, 1], [9.0; 2], 360.0), [1.0; AXES]).is_plain());
    }
}
