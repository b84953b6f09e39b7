//! Tools: which one is loaded, what is known of it, and its length offset
//! ("T", "M6", "M61", "G43", "G43.1", "G43.2", "G49"; Fanuc "Tool Length
//! Offset (G43, G44, G49)").

pub(super) mod words;

use std::collections::BTreeMap;
use std::sync::Arc;

use super::tool_table::{Tool, ToolTable};

/// Tools that a program may set itself; `LinuxCNC` has room for as many.
const CHANGED_MAX: usize = 1000;
/// Numbers of offsets that T has in its last two digits on lathes.
pub(super) const OFFSETS_OF_T: u32 = 100;
/// The axis along which Fanuc's tool length lies.
const LENGTH_AXIS: usize = 2;

/// The forms of G43.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ToolLength {
    /// G49.
    Off,
    /// G43 H, or the loaded tool.
    On,
    /// G44 H (Fanuc): the other way.
    Reversed,
    /// G43.1: offsets from the block.
    Given,
    /// G43.2 H: one more tool's offsets on top.
    Added,
}

/// What is known of the tools.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Tools {
    table: Option<Arc<ToolTable>>,
    /// Those that the program has set by G10; in the machine's unit.
    changed: BTreeMap<u32, Tool>,
    /// T, and what M6 or M61 has loaded; 0: none.
    pub(super) selected: u32,
    pub(super) loaded: u32,
    /// Whether the program, or who runs it, has said which these are.
    selected_told: bool,
    loaded_told: bool,
    /// How often a tool was selected or changed.
    pub(super) changes: u32,
    /// The tool or offset whose length in force was taken as 0, since nothing is known of it.
    pub(super) guessed: Option<u32>,
    /// The number of G43 in force (Fanuc: H alone changes it).
    length: Option<(ToolLength, u32)>,
}

impl Tools {
    /// What G43 or G44 in force does; `None`: G49.
    pub(super) fn length_form(&self) -> Option<ToolLength> {
        self.length.map(|(form, _)| form)
    }

    /// The number of its offset.
    pub(super) fn length_number(&self) -> Option<u32> {
        self.length.map(|(_, number)| number)
    }

    pub(super) fn new(table: Option<Arc<ToolTable>>) -> Self {
        Self {
            table,
            ..Self::default()
        }
    }

    /// True without a tool table: nothing can be said of a tool.
    pub(super) fn unknown(&self) -> bool {
        self.table.is_none()
    }

    /// The number of T, once there was one.
    pub(super) fn selected_known(&self) -> Option<u32> {
        self.selected_told.then_some(self.selected)
    }

    /// The number of the tool in the spindle, once a change has said it.
    pub(super) fn loaded_known(&self) -> Option<u32> {
        self.loaded_told.then_some(self.loaded)
    }

    /// T.
    fn select(&mut self, number: u32) {
        self.changes = self.changes.saturating_add(1);
        self.selected = number;
        self.selected_told = true;
    }

    /// The tool that is in the spindle, and in T, as the program begins.
    pub(super) fn give(&mut self, number: f64) {
        self.select(number as u32);
        self.loaded = self.selected;
        self.loaded_told = true;
    }

    /// A tool, lengths in the machine's unit; tool 0 is none and has no length.
    pub(super) fn find(&self, number: u32) -> Option<Tool> {
        let known = self.changed.get(&number).copied();
        let table = || self.table.as_ref()?.find(number).copied();
        known.or_else(table).or((number == 0).then(Tool::default))
    }

    /// Keeps a tool that the program has set; false when there are too many.
    pub(super) fn set(&mut self, tool: Tool) -> bool {
        if self.changed.len() >= CHANGED_MAX && !self.changed.contains_key(&tool.number) {
            return false;
        }
        self.changed.insert(tool.number, tool);
        true
    }
}
