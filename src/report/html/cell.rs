//! Cells of a grid, and lines between them.

use super::block::Block;

/// A cell of the grid.
pub(super) type Cell = [i64; 3];

/// A line between two cells.
#[derive(Debug, Clone)]
pub(super) struct Line {
    pub ends: [Cell; 2],
    /// How far it may be from the middles of the cells that it passed, mm.
    pub apart_mm: f64,
    /// The row that takes most of its limits, of all that run here.
    pub lead: Block,
}
