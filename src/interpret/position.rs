//! Positions: program coordinates to machine coordinates.
//!
//! Everything is kept in machine coordinates (mm, degrees); an absolute word
//! means `value + work offset + G92 offset + tool length`.

use std::path::PathBuf;
use std::sync::Arc;

use super::flow::Limits;
use crate::machine::{AXES, AxisSet, AxisValues};

/// Where the axes stand at the beginning of a program.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Start {
    /// At these machine coordinates (mm or degrees); 0 by default.
    At(AxisValues),
    /// Nowhere known: each axis' first move is priced at its full speed and
    /// acceleration.
    Unknown,
}

/// How a program is to be read.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    /// Position at the beginning.
    pub start: Start,
    /// True: blocks that begin with `/` are passed over.
    pub block_delete: bool,
    /// Folders where subprograms are looked for, in this order.
    pub sub_paths: Arc<[PathBuf]>,
    /// Where repetition stops.
    pub limits: Limits,
}

impl Default for Reading {
    fn default() -> Self {
        Self {
            start: Start::At([0.0; AXES]),
            block_delete: false,
            sub_paths: Arc::default(),
            limits: Limits::default(),
        }
    }
}

/// Position and offsets.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Position {
    /// Where the axes stand, machine coordinates.
    pub(super) at: AxisValues,
    /// Axes whose place is not known.
    pub(super) unknown: AxisSet,
    /// G92 offset in force, and the one that G92.3 restores.
    offset: AxisValues,
    stored: AxisValues,
}

impl Position {
    pub(super) fn new(start: Start) -> Self {
        let (at, unknown) = match start {
            Start::At(at) => (at, AxisSet::default()),
            Start::Unknown => ([0.0; AXES], AxisSet((1 << AXES) - 1)),
        };
        Self {
            at,
            unknown,
            offset: [0.0; AXES],
            stored: [0.0; AXES],
        }
    }

    /// Machine coordinate of an absolute program coordinate.
    pub(super) fn absolute(&self, axis: usize, value: f64) -> f64 {
        value + self.offset[axis]
    }

    /// Sets what is added to program coordinates.
    pub(super) fn set_shift(&mut self, shift: &AxisValues) {
        self.offset = *shift;
    }

    /// G92: the place where the axis stands is called `value` from now on.
    pub(super) fn set_offset(&mut self, axis: usize, value: f64) {
        self.offset[axis] = self.at[axis] - value;
        self.stored[axis] = self.offset[axis];
    }

    /// The axis moved by `by_mm` without a change of its program coordinate.
    pub(super) fn shift(&mut self, axis: usize, by_mm: f64) {
        self.offset[axis] += by_mm;
    }

    /// The axis stands at machine coordinate `at_mm`, without an offset.
    pub(super) fn home(&mut self, axis: usize, at_mm: f64) {
        self.at[axis] = at_mm;
        self.offset[axis] = 0.0;
        self.stored[axis] = 0.0;
        self.unknown.0 &= !(1 << axis);
    }

    /// The offsets of G92 in force.
    pub(super) fn offsets(&self) -> &AxisValues {
        &self.offset
    }

    /// Puts offsets back.
    pub(super) fn set_offsets(&mut self, offsets: AxisValues) {
        self.offset = offsets;
    }

    /// G92.1 (`forget`) and G92.2.
    pub(super) fn clear_offset(&mut self, forget: bool) {
        self.offset = [0.0; AXES];
        if forget {
            self.stored = [0.0; AXES];
        }
    }

    /// G92.3.
    pub(super) fn restore_offset(&mut self) {
        self.offset = self.stored;
    }
}
