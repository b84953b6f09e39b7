//! Positions: program coordinates to machine coordinates.
//!
//! Everything is kept in machine coordinates (mm, degrees); an absolute word
//! means `value + work offset + G92 offset + tool length`, turned and scaled
//! where the program says so.

use std::path::PathBuf;
use std::sync::Arc;

use super::datum::Datums;
use super::dialect::PointKinds;
use super::flow::limits::Limits;
use super::frame::Frame;
use super::given::GivenVariable;
use super::offsets::Offsets;
use super::parameter_file::ParameterFile;
use super::shelf::Shelf;
use super::tool_table::ToolTable;
use gwatt_machine::{AXES, AxisSet, AxisValues, Machine};
use gwatt_motion::Start;

/// Switches of block delete: `/` and `/1` obey the first, `/2` to `/9` those
/// of their numbers (B-63944EN, "Optional Block Skip").
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct BlockDelete(u16);

impl BlockDelete {
    /// No block is passed over.
    pub const NONE: Self = Self(0);
    /// All that begin with `/` are.
    pub const ALL: Self = Self(u16::MAX);

    /// The same with the switch of that level, 1 to 9, on.
    #[must_use]
    pub fn with(self, level: u8) -> Self {
        Self(self.0 | 1 << level.min(15))
    }

    /// The same with the switch of that level, 1 to 9, turned.
    #[must_use]
    pub fn turned(self, level: u8) -> Self {
        Self(self.0 ^ 1 << level.min(15))
    }

    /// Whether blocks of that level are passed over; level 0 is a block without
    /// `/`.
    #[must_use]
    pub fn passes(self, level: u8) -> bool {
        level > 0 && self.0 & 1 << level.min(15) != 0
    }
}

/// What probes are taken to find.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ProbeResult {
    /// They touch somewhere on their way.
    Hit,
    /// They reach their targets.
    Miss,
    /// Now this, now that: one of the ways in which a program can go on.
    Either(ProbeWay),
}

/// What is answered each time that a program asks whether a probe has touched, in order:
/// bit `n` is set where the answer number `n`, from 0, is no.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ProbeWay(u64);

impl ProbeWay {
    /// Whether that answer, from 0, is no.
    #[must_use]
    pub fn misses(self, answer: u32) -> bool {
        self.0.checked_shr(answer).is_some_and(|bits| bits & 1 == 1)
    }

    /// The next way, after this one on which the program has asked so often, 64 times at
    /// most; `None` where all have been followed. From the default on, each comes once.
    #[must_use]
    pub fn next(self, asked: u32) -> Option<Self> {
        let last_hit = (0..asked).rev().find(|answer| !self.misses(*answer))?;
        let before = 1_u64.checked_shl(last_hit)?;
        Some(Self(self.0 & (before - 1) | before))
    }
}

/// How a program is to be read.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    /// Position at the beginning.
    pub start: Start,
    /// Which blocks that begin with `/` are passed over.
    pub block_delete: BlockDelete,
    /// The tools, if they are known.
    pub tools: Option<Arc<ToolTable>>,
    /// Parameters that the control has kept, if they are known.
    pub parameters: Option<Arc<ParameterFile>>,
    /// Single variables that the control has kept.
    pub given: Arc<[GivenVariable]>,
    /// What probes find; `None`: not known, and what depends on it is refused.
    pub probe: Option<ProbeResult>,
    /// Folders where subprograms are looked for, in this order.
    pub sub_paths: Arc<[PathBuf]>,
    /// Where repetition stops.
    pub limits: Limits,
    /// Files that stand for those on the disk, where several are read together.
    pub shelf: Option<Arc<Shelf>>,
    /// The program's own number among them.
    pub text: u16,
}

impl Default for Reading {
    fn default() -> Self {
        Self {
            start: Start::At([0.0; AXES]),
            block_delete: BlockDelete::NONE,
            tools: None,
            parameters: None,
            given: Arc::default(),
            probe: None,
            sub_paths: Arc::default(),
            limits: Limits::default(),
            shelf: None,
            text: 0,
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
