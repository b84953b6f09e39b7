//! What is found of a program: by move, by arc, and in all.

use super::circle::Roundness;
use crate::interpret::MoveKind;
use crate::machine::{AxisValues, Converter};

/// How a program is traced.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Period of the samples where no filter gives one, s.
    pub period_s: f64,
}

/// Why a machine cannot be traced.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{message}\n  help: {help}")]
pub struct ContourTrouble {
    /// What is wrong.
    pub message: String,
    /// What to do.
    pub help: String,
}

/// Contour errors, mm.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Errors {
    /// The largest.
    pub largest_mm: f64,
    /// Sum of squares, and of how many samples.
    square_sum: f64,
    count: u64,
}

impl Errors {
    pub(super) fn take(&mut self, distance2: f64) {
        self.largest_mm = self.largest_mm.max(distance2.sqrt());
        self.square_sum += distance2;
        self.count += 1;
    }

    /// Root of the mean square, mm.
    #[must_use]
    pub fn rms_mm(&self) -> f64 {
        if self.count == 0 {
            0.0
        } else {
            (self.square_sum / self.count as f64).sqrt()
        }
    }
}

/// What is found of one move.
#[derive(Debug, Clone, PartialEq)]
pub struct ContourRow {
    /// Line from 1.
    pub line: u64,
    /// Run of the line.
    pub run: u32,
    /// Kind of the move.
    pub kind: MoveKind,
    /// Start, s.
    pub start_s: f64,
    /// How long it is commanded, s.
    pub duration_s: f64,
    /// Errors without and with correction; none where axes run each for itself.
    pub errors: Option<[Errors; 2]>,
    /// Its arc, if it is one.
    pub arc: Option<ArcResult>,
}

/// What is found of an arc.
#[derive(Debug, Clone, PartialEq)]
pub struct ArcResult {
    /// Line from 1.
    pub line: u64,
    /// Run of the line.
    pub run: u32,
    /// Axes of its plane.
    pub plane: [usize; 2],
    /// Radius, mm.
    pub radius_mm: f64,
    /// Largest speed along the path, mm/s.
    pub speed_mm_s: f64,
    /// Without and with correction; none where the load has not settled.
    pub roundness: [Option<Roundness>; 2],
    /// Distance from the circle by direction, mm, without and with correction.
    pub bins: [Vec<f32>; 2],
}

/// A point of the path with what the load leaves it by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlotPoint {
    /// Of the programmed path next to the load, mm; without and with correction.
    pub path: [[f64; 3]; 2],
    /// The load's place less that, mm.
    pub off: [[f64; 3]; 2],
    /// Whether the path is that of a feed next to it, whose error counts.
    pub counts: [bool; 2],
}

/// Takes results one by one.
pub trait ContourSink {
    /// A move that is finished.
    ///
    /// # Errors
    /// Whatever the writing gives.
    fn row(&mut self, row: &ContourRow) -> std::io::Result<()>;

    /// A sample.
    fn point(&mut self, point: &PlotPoint);
}

/// What the drives do.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Effort {
    /// Largest power of the axes on one converter with its base load, W.
    pub peak_w: f64,
    /// The most that is fed back, W.
    pub regen_w: f64,
}

impl Effort {
    /// Takes the powers of all axes at an instant, W.
    pub(super) fn take(&mut self, converters: &[Converter], powers: &AxisValues) {
        for converter in converters {
            let own = || converter.axes.iter().filter_map(|axis| powers.get(axis));
            let (drawn, fed) = if converter.credit_regen {
                let sum = own().sum::<f64>() + converter.base_load_w;
                (sum, -sum)
            } else {
                let drawn: f64 = own().map(|p| p.max(0.0)).sum();
                let fed: f64 = own().map(|p| (-p).max(0.0)).sum();
                (drawn + converter.base_load_w, fed)
            };
            self.peak_w = self.peak_w.max(drawn);
            self.regen_w = self.regen_w.max(fed);
        }
    }
}

/// Forces of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisEffort {
    /// Its letter.
    pub letter: char,
    /// True for torque.
    pub rotary: bool,
    /// The largest, without and with correction, N or N·m.
    pub force_peak_n: [f64; 2],
    /// Root of the mean square.
    pub force_rms_n: [f64; 2],
}

/// What is found of a program.
#[derive(Debug, Clone, PartialEq)]
pub struct ContourSummary {
    /// Whether some command is corrected.
    pub corrected: bool,
    /// Sampling period, s.
    pub period_s: f64,
    /// How long the program lasts, s.
    pub duration_s: f64,
    /// Errors of feeds, without and with correction.
    pub errors: [Errors; 2],
    /// Lines of the largest.
    pub lines: [u64; 2],
    /// Forces by axis.
    pub axes: Vec<AxisEffort>,
    /// Powers, without and with correction.
    pub efforts: [Effort; 2],
    /// What the model leaves out.
    pub conditions: Vec<String>,
}
