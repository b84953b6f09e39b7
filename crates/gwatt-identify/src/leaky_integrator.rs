//! Positions and speeds as they are compared with a model: as accelerations that leaky
//! integrators made of their differences.
//!
//! White noise of a position is `(1 − z⁻¹)²` times itself in its second differences:
//! nothing at all where motion is slow, which no autoregressive filter makes white.
//! `1/(1 − a·z⁻¹)` for each difference brings it back, but for what is slower than the
//! leak; disturbances of the force, which run off in a position, stay small by it. The
//! input goes through the same integrators: the model between them stays as it is.
//!
//! What they held at the first sample (the position, the speed) fades with `aᵏ` and
//! `k·aᵏ`; it is fitted next to the model.

use super::data::{Data, Signals};
use super::normal::Normal;
use super::stretch::{Column, OVER, ROWS};

/// The signals after leaky integrators.
pub struct Leaky {
    signals: Signals,
    leak: f64,
}

impl Leaky {
    /// Of differences as they are. `leak` is the share of what an integrator holds that
    /// it loses from sample to sample, below 1.
    #[must_use]
    pub fn of(data: &Data<'_>, leak: f64) -> Self {
        let times = data.measured.integrators();
        let held = |x: &[f64]| {
            let mut x = x.to_vec();
            (0..times).for_each(|_| integrate(&mut x, leak));
            x
        };
        let mut out = Self {
            signals: Signals::filtered(data, held),
            leak,
        };
        out.level(data);
        out
    }

    /// What was recorded, with these signals.
    #[must_use]
    pub fn data<'a>(&'a self, data: &Data<'a>) -> Data<'a> {
        Data {
            leak: self.leak,
            ..self.signals.data(data)
        }
    }

    /// The signals, to be filtered further.
    pub fn signals(&mut self) -> &mut Signals {
        &mut self.signals
    }

    /// Takes off what fades and an offset, which are fitted anyway: an axis that wanders
    /// off leaves few digits for the rest.
    fn level(&mut self, data: &Data<'_>) {
        let data = Data {
            leak: self.leak,
            ..*data
        };
        let skip = data.skip();
        let count = self.signals.output.len().saturating_sub(skip);
        let columns = || {
            let mut fading = Fading::new(&data);
            let mut from = 0;
            std::iter::from_fn(move || {
                let rows = count.checked_sub(from).filter(|rows| *rows > 0)?.min(ROWS);
                let mut columns = vec![[0.0; ROWS]; data.fading()];
                columns.push([1.0; ROWS]);
                fading.next(rows, |index, column| {
                    if let (Some(slot), Some(column)) = (columns.get_mut(index), column) {
                        *slot = *column;
                    }
                });
                from += rows;
                Some((skip + from - rows, rows, columns))
            })
        };
        let mut normal = Normal::new(data.fading() + 1);
        for (from, rows, columns) in columns() {
            let columns = columns.iter().enumerate();
            let columns = columns.filter_map(|(at, column)| Some((at, column.get(..rows)?)));
            let columns: Vec<(usize, &[f64])> = columns.collect();
            let part = self
                .signals
                .output
                .get(from..from + rows)
                .unwrap_or_default();
            normal.add_columns(&columns, part);
        }
        let Some(solution) = normal.solve_from(0, 1e-12) else {
            return;
        };
        for (from, rows, columns) in columns() {
            let part = self
                .signals
                .output
                .get_mut(from..from + rows)
                .unwrap_or_default();
            for (column, factor) in columns.iter().zip(solution.x.iter()) {
                for (slot, x) in part.iter_mut().zip(column) {
                    *slot -= factor * x;
                }
            }
        }
        // Before the first differences it ran on as after them: a step would ring.
        for at in (0..skip).rev() {
            if let Some([before, next, other]) = self.signals.output.get_mut(at..at + 3) {
                *before = 2.0 * *next - *other;
            }
        }
    }
}

fn integrate(x: &mut [f64], leak: f64) {
    let kept = 1.0 - leak;
    let mut held = 0.0;
    for slot in x {
        held = *slot + kept * held;
        *slot = held;
    }
}

/// How what the integrators held at the first row fades: `aᵏ`, and of two of them
/// `k·aᵏ` by the number of rows.
pub struct Fading {
    /// From row to row.
    kept: f64,
    count: usize,
    share: f64,
    now: f64,
    row: f64,
}

impl Fading {
    /// Of these signals.
    #[must_use]
    pub fn new(data: &Data<'_>) -> Self {
        Self {
            kept: libm::pow(1.0 - data.leak, data.every as f64),
            count: data.fading(),
            share: 1.0 / data.rows().max(1) as f64,
            now: 1.0,
            row: 0.0,
        }
    }

    /// The next rows, a column for each integrator; `None` for what is over.
    pub fn next(&mut self, rows: usize, mut take: impl FnMut(usize, Option<&Column>)) {
        if self.count == 0 || self.now < OVER {
            (0..self.count).for_each(|index| take(index, None));
            return;
        }
        let mut columns = [[0.0; ROWS]; 2];
        let [first, second] = &mut columns;
        for (first, second) in first.iter_mut().zip(second).take(rows) {
            (*first, *second) = (self.now, self.row * self.share * self.now);
            self.now *= self.kept;
            self.row += 1.0;
        }
        for (index, column) in columns.iter().enumerate().take(self.count) {
            take(index, Some(column));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::disturbance::as_it_is;
    use super::super::output_error::residuals;
    use super::super::state_space::{Measured, simulate};
    use super::super::transfer::{Factor, TransferFunction};
    use super::*;

    /// A recording that begins in the middle of a motion, under a force of which it
    /// holds but a part that changes: what the integrators would have held fades, and
    /// nothing of the output is left.
    #[test]
    fn what_went_before_fades() {
        let axis = TransferFunction {
            gain: 50.0,
            zeros: vec![Factor::Pair {
                omega_rad_s: 250.0,
                damping: 0.03,
            }],
            poles: vec![Factor::Pair {
                omega_rad_s: 340.0,
                damping: 0.04,
            }],
            delay_s: 0.0,
        };
        let force: Vec<f64> = (0..1500)
            .map(|k| libm::sin(0.001 * f64::from(k * k)))
            .collect();
        for measured in [Measured::Velocity, Measured::Position] {
            let whole: Vec<f64> = force.iter().map(|u| u + 0.3).collect();
            let output = simulate(&axis, measured, 1e-3, &whole).unwrap();
            let skip = measured.integrators();
            let mut late = output[500..].to_vec();
            late[..skip].fill(0.0);
            let data = Data {
                input: &force[500..],
                output: &late,
                friction: &[],
                viscous: None,
                turning: 0,
                undisturbed: None,
                period_s: 1e-3,
                measured,
                from_command: false,
                early_s: 0.0,
                positions: false,
                every: 1,
                leak: 0.0,
            };
            for leak in [0.2, 0.02, 0.002] {
                let leaky = Leaky::of(&data, leak);
                let data = leaky.data(&data);
                let left = residuals(&data, &as_it_is(&data, &axis).unwrap()).unwrap();
                let most = |x: &[f64]| x.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
                let share = most(&left) / most(data.output);
                assert!(share < 1e-6, "{measured:?} {leak}: {share}");
            }
        }
    }
}
