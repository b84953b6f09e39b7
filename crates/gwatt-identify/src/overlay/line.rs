//! The line through measured over predicted power.

use nalgebra::{Matrix4, Vector4};

use super::align::Place;
use super::meter::shown;
use super::tops::{Model, STATED};
use super::trace::PowerTrace;

/// Samples by which both ends are moved to see what that changes.
const MOVED: f64 = 1.0 / 64.0;

/// Measured power by predicted, as least squares find it while the program runs.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    pub(super) gain: f64,
    /// That of the gain, as it is stated.
    pub(super) error: f64,
    /// What is measured where nothing is predicted, W.
    pub(super) offset_w: f64,
    /// Root of the mean square of measured less predicted power, W.
    pub(super) rms_w: f64,
    pub(super) energy_ratio: f64,
    /// The largest power measured, W.
    pub(super) measured_peak_w: f64,
}

impl Line {
    pub(super) fn of(model: &Model<'_>, log: &PowerTrace, predicted_w: &[f64]) -> Self {
        let place = model.place;
        let rows = log.time_s.iter().zip(log.power_w.iter().zip(predicted_w));
        let running = rows.filter(|(t, _)| (place.start_s..=place.end_s).contains(*t));
        let running: Vec<(f64, f64)> = running.map(|(_, (own, model))| (*own, *model)).collect();
        let n = running.len().max(1) as f64;
        let mean = |of: fn(&(f64, f64)) -> f64| running.iter().map(of).sum::<f64>() / n;
        let (measured, predicted) = (mean(|it| it.0), mean(|it| it.1));
        let (mut both, mut square, mut own_square, mut error) = (0.0, 0.0, 0.0, 0.0);
        for (own, model) in &running {
            both += (own - measured) * (model - predicted);
            square += (model - predicted) * (model - predicted);
            own_square += (own - measured) * (own - measured);
            error += (own - model) * (own - model);
        }
        let gain = if square > 0.0 { both / square } else { 1.0 };
        let left = (own_square - gain * both).max(0.0);
        let scatter_w = (left / (n - 4.0).max(1.0)).sqrt();
        // Where both differ a little in time, x and x', the gain is also too small:
        // Σxx' = Σx² - Σ(x - x')²/2.
        let late = if own_square > 0.0 {
            gain.abs() * left / own_square / 2.0
        } else {
            0.0
        };
        let uncertain = uncertainty(model, log, (predicted_w, gain)).unwrap_or_default();
        Self {
            gain,
            error: STATED * scatter_w * uncertain + late,
            offset_w: measured - gain * predicted,
            rms_w: (error / n).sqrt(),
            energy_ratio: measured / predicted,
            measured_peak_w: running.iter().map(|it| it.0).fold(0.0, f64::max),
        }
    }
}

/// The standard error of a gain by 1 W of scatter, next to an offset and the times at which the
/// program begins and ends, which least squares find too.
fn uncertainty(
    model: &Model<'_>,
    log: &PowerTrace,
    (predicted_w, gain): (&[f64], f64),
) -> Option<f64> {
    let place = model.place;
    let by_s = MOVED * log.step_s();
    let ends = |start: f64, end: f64| {
        let moved = Place {
            start_s: place.start_s + start * by_s,
            end_s: place.end_s + end * by_s,
            ..place
        };
        shown(model.curve, &log.time_s, moved, model.width_s)
    };
    let (started, ended) = (ends(1.0, 0.0), ends(0.0, 1.0));
    let mut normal = Matrix4::zeros();
    let moved = predicted_w.iter().zip(started.iter().zip(&ended));
    for (t, (own, (started, ended))) in log.time_s.iter().zip(moved) {
        if (place.start_s..=place.end_s).contains(t) {
            let changes = [started - own, ended - own].map(|it| gain * it / MOVED);
            let row = Vector4::new(*own, 1.0, changes[0], changes[1]);
            normal += row * row.transpose();
        }
    }
    let scale = normal
        .diagonal()
        .map(|it: f64| if it > 0.0 { it.sqrt() } else { 1.0 });
    for (k, mut row) in normal.row_iter_mut().enumerate() {
        row.component_div_assign(&scale.transpose());
        row /= scale.get(k).copied()?;
    }
    // What does not depend on the ends has nothing there.
    for k in 0..4 {
        let at = normal.get_mut((k, k))?;
        *at = at.max(1e-9);
    }
    let inverse = normal.try_inverse()?;
    Some(inverse.get((0, 0))?.max(0.0).sqrt() / scale.get(0)?)
}
