//! Which of many values are looked at, and where they stand.

/// Of so many, evenly up to a third of `most`, then by factors: about `most`, and a
/// little more where there are many.
#[must_use]
pub fn thinned(count: usize, most: usize) -> Vec<usize> {
    if count <= most {
        return (0..count).collect();
    }
    let even = most as f64 / 3.0;
    let mut out = Vec::new();
    let mut place = 0.0;
    while (place as usize) < count {
        out.push(place as usize);
        place += (place / even).max(1.0);
    }
    out
}

/// Columns with their places.
#[must_use]
pub fn numbered(columns: &[Vec<f64>]) -> Vec<(usize, &[f64])> {
    columns.iter().map(Vec::as_slice).enumerate().collect()
}
