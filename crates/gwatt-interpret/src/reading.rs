//! How a program is to be read.

use super::flow::limits::Limits;
use super::given::GivenVariable;
use super::parameter_file::ParameterFile;
use super::shelf::Shelf;
use super::tool_table::ToolTable;
use gwatt_machine::AXES;
use gwatt_motion::Start;
use std::path::PathBuf;
use std::sync::Arc;

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
