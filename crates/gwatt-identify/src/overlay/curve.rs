//! The predicted power of a program over time.

/// Power over time in straight pieces; two points of one time are a jump.
#[derive(Debug, Clone, Default)]
pub struct Curve {
    time_s: Vec<f64>,
    power_w: Vec<f64>,
    /// The block that the piece up to a point belongs to.
    block: Vec<u64>,
    /// The integral up to each point, J.
    energy_j: Vec<f64>,
    /// What is drawn before and after the program, W.
    rest_w: f64,
}

impl Curve {
    /// A curve without points; `rest_w` is drawn before and after the program, W.
    #[must_use]
    pub fn new(rest_w: f64) -> Self {
        Self {
            rest_w,
            ..Self::default()
        }
    }

    /// Adds a point: the time, s, not before the last one, the power, W, and the number of the
    /// block (its line) that moves up to it.
    pub fn push(&mut self, time_s: f64, power_w: f64, block: u64) {
        let energy_j = match (
            self.time_s.last(),
            self.power_w.last(),
            self.energy_j.last(),
        ) {
            (Some(t), Some(w), Some(energy_j)) => energy_j + (time_s - t) * (w + power_w) / 2.0,
            _ => 0.0,
        };
        self.time_s.push(time_s);
        self.power_w.push(power_w);
        self.block.push(block);
        self.energy_j.push(energy_j);
    }

    /// When the program ends, s.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.time_s.last().copied().unwrap_or_default()
    }

    /// The times of its points, s.
    pub(super) fn times_s(&self) -> &[f64] {
        &self.time_s
    }

    /// What is drawn before and after the program, W.
    #[must_use]
    pub fn rest_w(&self) -> f64 {
        self.rest_w
    }

    /// The blocks in the order in which they run: number, beginning and end, s.
    #[must_use]
    pub fn blocks(&self) -> Vec<(u64, f64, f64)> {
        let mut found: Vec<(u64, f64, f64)> = Vec::new();
        let pieces = self.time_s.iter().zip(self.time_s.iter().skip(1));
        for ((from, to), block) in pieces.zip(self.block.iter().skip(1)) {
            match found.last_mut() {
                Some((last, _, end)) if last == block => *end = *to,
                _ => found.push((*block, *from, *to)),
            }
        }
        found
    }

    /// The same with so many times the other curves, where they draw, on top; these have
    /// points at the same times.
    pub(super) fn raised<'a>(&self, others: impl Iterator<Item = (f64, &'a Self)>) -> Self {
        let mut power_w = self.power_w.clone();
        for (times, other) in others {
            for (own, more) in power_w.iter_mut().zip(&other.power_w) {
                *own += times * more.max(0.0);
            }
        }
        let mut raised = Self::new(self.rest_w);
        let points = self.time_s.iter().zip(power_w).zip(&self.block);
        for ((time_s, power_w), block) in points {
            raised.push(*time_s, power_w, *block);
        }
        raised
    }

    /// What reads the curve at times that ascend.
    #[must_use]
    pub fn reader(&self) -> Reader<'_> {
        Reader { curve: self, at: 0 }
    }

    /// The same from a time on.
    pub(super) fn reader_from(&self, time_s: f64) -> Reader<'_> {
        let at = self.time_s.partition_point(|t| *t <= time_s);
        Reader { curve: self, at }
    }
}

/// Reads a curve at times that ascend.
#[derive(Debug)]
pub struct Reader<'a> {
    curve: &'a Curve,
    /// Points before the time that was read last.
    at: usize,
}

impl Reader<'_> {
    /// The energy from the beginning of the program up to a time, J; negative before it.
    pub fn energy_j(&mut self, time_s: f64) -> f64 {
        let curve = self.curve;
        while curve.time_s.get(self.at).is_some_and(|t| *t <= time_s) {
            self.at += 1;
        }
        let Some(before) = self.at.checked_sub(1) else {
            return curve.rest_w * time_s;
        };
        let (Some(t), Some(w), Some(energy_j)) = (
            curve.time_s.get(before),
            curve.power_w.get(before),
            curve.energy_j.get(before),
        ) else {
            return 0.0;
        };
        let since = time_s - t;
        match (curve.time_s.get(self.at), curve.power_w.get(self.at)) {
            (Some(next_t), Some(next_w)) => {
                let slope = (next_w - w) / (next_t - t);
                energy_j + since * (w + slope * since / 2.0)
            }
            _ => energy_j + since * curve.rest_w,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Up from 0 to 100 W in 2 s, a jump to 40 W for 1 s; 10 W at rest.
    fn curve() -> Curve {
        let mut curve = Curve::new(10.0);
        for (t, w, block) in [
            (0.0, 0.0, 1),
            (2.0, 100.0, 1),
            (2.0, 40.0, 2),
            (3.0, 40.0, 2),
        ] {
            curve.push(t, w, block);
        }
        curve
    }

    #[test]
    fn the_energy_is_the_area() {
        let curve = curve();
        let mut reader = curve.reader();
        for (t, energy_j) in [
            (-1.0, -10.0),
            (0.0, 0.0),
            (1.0, 25.0),
            (2.0, 100.0),
            (2.5, 120.0),
            (5.0, 160.0),
        ] {
            let found: f64 = reader.energy_j(t);
            assert!((found - energy_j).abs() < 1e-12, "{t} {found}");
        }
    }

    #[test]
    fn blocks_have_their_times() {
        assert_eq!(curve().blocks(), [(1, 0.0, 2.0), (2, 2.0, 3.0)]);
        assert_eq!(curve().duration_s(), 3.0);
    }
}
