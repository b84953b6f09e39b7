//! Vectors in a plane.

/// A point or a direction: first and second axis of the plane.
pub(super) type Vector = [f64; 2];

pub(super) fn add(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1]]
}

pub(super) fn sub(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1]]
}

pub(super) fn scale(a: Vector, factor: f64) -> Vector {
    [a[0] * factor, a[1] * factor]
}

/// `a` and `factor` times the direction `b`.
pub(super) fn along(a: Vector, b: Vector, factor: f64) -> Vector {
    add(a, scale(b, factor))
}

pub(super) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Positive where `b` is to the left of `a`.
pub(super) fn cross(a: Vector, b: Vector) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// A quarter turn to the left.
pub(super) fn left(a: Vector) -> Vector {
    [-a[1], a[0]]
}

pub(super) fn length(a: Vector) -> f64 {
    libm::hypot(a[0], a[1])
}

pub(super) fn distance(a: Vector, b: Vector) -> f64 {
    length(sub(b, a))
}

/// The direction of `a`; without one, nothing.
pub(super) fn unit(a: Vector) -> Option<Vector> {
    let length = length(a);
    (length > 0.0 && length.is_finite()).then(|| scale(a, 1.0 / length))
}
