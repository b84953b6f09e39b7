//! Lines that follow each other as one.

use super::cell::{Cell, Line};
use crate::interpret::MoveKind;

/// Lines that become one at most.
const POINTS_MAX: usize = 64;

/// Joins lines of which each begins where the last one ends, as long as what is drawn stays
/// within a cell's side of the middles of the cells that they pass. A rapid stays apart.
pub(super) fn joined(lines: Vec<Line>, cell_mm: f64) -> Vec<Line> {
    let mut kept = Vec::with_capacity(lines.len());
    let mut lines = lines.into_iter();
    let Some(first) = lines.next() else {
        return kept;
    };
    let mut run = Run::of(first);
    for line in lines {
        match run.apart_mm_with(&line, cell_mm) {
            Some(apart_mm) => run.take(line, apart_mm),
            None => kept.push(std::mem::replace(&mut run, Run::of(line)).line),
        }
    }
    kept.push(run.line);
    kept
}

/// Lines so far.
struct Run {
    line: Line,
    /// Where they meet.
    inside: Vec<Cell>,
    /// The largest distance of each of them from the way, mm.
    most_mm: f64,
}

impl Run {
    fn of(line: Line) -> Self {
        Self {
            inside: Vec::new(),
            most_mm: line.apart_mm,
            line,
        }
    }

    /// How far one line for all of them and the next would be from the way, mm; `None` where
    /// that is too far, or they do not belong together.
    fn apart_mm_with(&self, next: &Line, cell_mm: f64) -> Option<f64> {
        let [from, meet] = self.line.ends;
        let is_rapid = |line: &Line| line.lead.row.kind == MoveKind::Rapid;
        let goes_on = meet == next.ends[0] && is_rapid(&self.line) == is_rapid(next);
        if !goes_on || self.inside.len() >= POINTS_MAX {
            return None;
        }
        let ends = [from, next.ends[1]];
        let inside = self.inside.iter().chain([&meet]);
        let far = inside.map(|cell| distance(*cell, ends));
        let apart_mm = cell_mm * far.fold(0.0, f64::max) + self.most_mm.max(next.apart_mm);
        (apart_mm <= cell_mm).then_some(apart_mm)
    }

    fn take(&mut self, next: Line, apart_mm: f64) {
        let [_, meet] = self.line.ends;
        self.inside.push(meet);
        self.most_mm = self.most_mm.max(next.apart_mm);
        self.line.ends[1] = next.ends[1];
        self.line.apart_mm = apart_mm;
        self.line.raise(next.lead);
    }
}

/// How far a cell is from the line between two, in cells.
fn distance(cell: Cell, [from, to]: [Cell; 2]) -> f64 {
    let between = |a: Cell, b: Cell| -> [f64; 3] { std::array::from_fn(|i| (b[i] - a[i]) as f64) };
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let (way, to_cell) = (between(from, to), between(from, cell));
    let length2 = dot(way, way);
    let share = if length2 > 0.0 {
        (dot(to_cell, way) / length2).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let off: [f64; 3] = std::array::from_fn(|i| to_cell[i] - share * way[i]);
    dot(off, off).sqrt()
}

#[cfg(test)]
mod tests {
    use super::super::block::Passing;
    use super::super::path::{LINES_MAX, Path};
    use crate::pipeline::Route;
    use crate::report::record::example;

    /// A long walk: few lines, and each of its points near one of them.
    #[test]
    fn a_long_way_is_drawn_within_the_error() {
        let at = |step: u32| {
            let t = f64::from(step);
            let mut place = [0.0; crate::machine::AXES];
            place[0] = 150.0 * libm::sin(0.37e-2 * t) + 0.2 * libm::sin(1.3 * t);
            place[1] = 90.0 * libm::cos(0.91e-3 * t);
            place[2] = 20.0 * libm::sin(1e-2 * t);
            place
        };
        let mut path = Path::default();
        for step in 0..60_000 {
            let mut row = example();
            row.route = Some(Route {
                start: at(step),
                end: at(step + 1),
                arc: None,
            });
            row.peak_w = f64::from(step);
            path.add(Passing {
                index: u64::from(step),
                row: &row,
                other: None,
            });
        }
        assert!(path.list.len() <= LINES_MAX);
        assert!(path.error_mm() < 2.0, "{}", path.error_mm());
        let last = path.list.iter().map(|line| line.lead.row.peak_w);
        assert_eq!(last.fold(0.0, f64::max), 59_999.0);
        let cell_mm = path.cell_mm();
        let drawn: Vec<[[f64; 3]; 2]> = path
            .list
            .iter()
            .map(|line| {
                line.ends
                    .map(|cell| cell.map(|at| (at as f64 + 0.5) * cell_mm))
            })
            .collect();
        for step in (0..60_000).step_by(997) {
            let point = at(step);
            let near = drawn.iter().map(|[a, b]| {
                let way: [f64; 3] = std::array::from_fn(|i| b[i] - a[i]);
                let off: [f64; 3] = std::array::from_fn(|i| point[i] - a[i]);
                let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
                let share = (dot(off, way) / dot(way, way)).clamp(0.0, 1.0);
                let rest: [f64; 3] = std::array::from_fn(|i| off[i] - share * way[i]);
                dot(rest, rest).sqrt()
            });
            let near_mm = near.fold(f64::INFINITY, f64::min);
            assert!(near_mm <= path.error_mm(), "{step}: {near_mm} mm");
        }
    }
}
