//! Positions: program coordinates to machine coordinates.
//!
//! Everything is kept in machine coordinates (mm, degrees); an absolute word
//! means `value + work offset + G92 offset + tool length`, turned and scaled
//! where the program says so.

use super::datum::Datums;
use super::dialect::PointKinds;
use super::frame::Frame;
use super::offsets::Offsets;
use super::reading::Reading;
use gwatt_machine::{AXES, AxisSet, AxisValues, Machine};
use gwatt_motion::Start;

/// Position and offsets.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Position {
    /// Where the axes stand, machine coordinates.
    pub(super) at: AxisValues,
    /// Axes whose place is not known.
    pub(super) unknown: AxisSet,
    /// The map from program to machine that the offsets make.
    pub(super) frame: Frame,
    offsets: Offsets,
    /// Axes whose last programmed coordinate is no longer the place where they
    /// stand, since a turn or a scale has begun or ended (Fanuc).
    pub(super) adrift: AxisSet,
    /// What the places rest on.
    pub(super) datums: Datums,
    /// By which numbers they were stated.
    pub(super) points: PointKinds,
    /// Axes whose places do not rest on what coordinates of the program rest on, as of the
    /// last block that is not plain.
    pub(super) apart: AxisSet,
}

impl Position {
    pub(super) fn new(machine: &Machine, reading: &Reading) -> Self {
        let (at, unknown) = match reading.start {
            Start::At(at) => (at, AxisSet::default()),
            Start::Unknown => ([0.0; AXES], AxisSet((1 << AXES) - 1)),
        };
        let offsets = Offsets::new(machine, reading);
        Self {
            at,
            unknown,
            frame: offsets.frame(),
            offsets,
            adrift: AxisSet::default(),
            datums: Datums::default(),
            points: PointKinds::default(),
            apart: AxisSet((1 << AXES) - 1),
        }
    }

    /// Machine coordinate of an absolute program coordinate, for an axis that
    /// is not turned with another one.
    #[inline]
    pub(super) fn absolute(&self, axis: usize, value: f64) -> f64 {
        self.frame.absolute(axis, value)
    }

    /// Where the axes stand, in program coordinates (mm, degrees).
    pub(super) fn program(&self) -> AxisValues {
        self.frame.program(&self.at)
    }

    pub(super) fn offsets(&self) -> &Offsets {
        &self.offsets
    }

    /// Changes the offsets; the axes stay where they are.
    pub(super) fn change<T>(&mut self, change: impl FnOnce(&mut Offsets) -> T) -> T {
        let result = change(&mut self.offsets);
        self.frame = self.offsets.frame();
        result
    }

    /// G92: the place where the axis stands is called `value` from now on.
    pub(super) fn set_offset(&mut self, axis: usize, value: f64) {
        // A shift of the program coordinates lies within everything else.
        let difference = self.program()[axis] - value;
        self.change(|offsets| {
            let offset = offsets.g92[axis] + difference;
            offsets.set_g92(axis, offset);
        });
    }

    /// The axis moved by `by_mm` without a change of its program coordinate.
    pub(super) fn shift(&mut self, axis: usize, by_mm: f64) {
        // Often, and only where nothing is turned: without a new map.
        self.offsets.g92[axis] += by_mm;
        self.frame.nudge(axis, by_mm);
    }

    /// The axis stands at machine coordinate `at_mm`, without an offset.
    pub(super) fn home(&mut self, axis: usize, at_mm: f64) {
        self.at[axis] = at_mm;
        self.change(|offsets| offsets.set_g92(axis, 0.0));
        self.unknown.0 &= !(1 << axis);
        self.datums.home(axis);
    }

    /// The offsets of G92 in force.
    pub(super) fn shifts(&self) -> &AxisValues {
        &self.offsets.g92
    }

    /// Puts offsets back.
    pub(super) fn set_shifts(&mut self, shifts: &AxisValues) {
        self.change(|offsets| offsets.g92 = *shifts);
    }

    /// G92.1 (`forget`) and G92.2.
    pub(super) fn clear_offset(&mut self, forget: bool) {
        self.datums.forget_set();
        self.change(|offsets| offsets.clear_g92(forget));
    }
}
