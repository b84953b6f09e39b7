//! Arcs: how round the load runs where it has settled, and how much smaller.

use std::f64::consts::TAU;

use crate::interpret::Arc;

/// Less than a quarter of a turn says nothing of roundness.
const SWEEP_MIN_RAD: f64 = 0.25 * TAU;
/// Directions in which a circle is drawn.
pub const BINS: usize = 360;

/// The run of the load along an arc.
#[derive(Debug, Clone, PartialEq)]
pub struct Roundness {
    /// Largest less smallest distance from the programmed centre, mm.
    pub roundness_mm: f64,
    /// Programmed radius less the mean distance, mm.
    pub shrinkage_mm: f64,
}

/// An arc that is measured.
#[derive(Debug, Clone)]
pub(super) struct Circle {
    pub plane: [usize; 2],
    center: [f64; 2],
    pub radius_mm: f64,
    runs: [Run; 2],
}

/// Distances from the centre, without and with correction.
#[derive(Debug, Clone)]
struct Run {
    least: f64,
    most: f64,
    sum: f64,
    count: u64,
    /// Angle of the load at the last sample, and by how much it has turned.
    last: f64,
    swept: f64,
    bins: Vec<f32>,
}

impl Circle {
    /// Of an arc.
    pub fn of(arc: &Arc) -> Self {
        let run = || Run {
            least: f64::INFINITY,
            most: f64::NEG_INFINITY,
            sum: 0.0,
            count: 0,
            last: 0.0,
            swept: 0.0,
            bins: Vec::new(),
        };
        Self {
            plane: arc.plane,
            center: arc.center,
            radius_mm: arc.radius_mm,
            runs: [run(), run()],
        }
    }

    /// Takes a position of the load; `which` is 0 without correction, 1 with.
    pub fn take(&mut self, which: usize, load: [f64; 3]) {
        let [x, y] = [0, 1].map(|n| {
            let at = self.plane.get(n).and_then(|axis| load.get(*axis));
            at.copied().unwrap_or(0.0) - self.center[n]
        });
        let (radius, angle) = (libm::hypot(x, y), libm::atan2(y, x));
        let Some(run) = self.runs.get_mut(which) else {
            return;
        };
        if run.count == 0 {
            run.bins = vec![f32::NAN; BINS];
        } else {
            let step = (angle - run.last + 1.5 * TAU) % TAU - 0.5 * TAU;
            run.swept += step;
        }
        run.last = angle;
        run.count += 1;
        run.sum += radius;
        run.least = run.least.min(radius);
        run.most = run.most.max(radius);
        let bin = ((angle / TAU + 1.0) % 1.0 * BINS as f64) as usize;
        if let Some(slot) = run.bins.get_mut(bin.min(BINS - 1)) {
            *slot = (radius - self.radius_mm) as f32;
        }
    }

    /// What was found; `None` where the load had not settled for long enough.
    pub fn roundness(&self, which: usize) -> Option<Roundness> {
        let run = self.runs.get(which)?;
        (run.count > 1 && run.swept.abs() >= SWEEP_MIN_RAD * (1.0 - 1e-3)).then(|| Roundness {
            roundness_mm: run.most - run.least,
            shrinkage_mm: self.radius_mm - run.sum / run.count as f64,
        })
    }

    /// Distance from the programmed circle by direction, mm; not a number where
    /// the load was not.
    pub fn bins(&self, which: usize) -> &[f32] {
        self.runs.get(which).map_or(&[], |run| &run.bins)
    }
}
