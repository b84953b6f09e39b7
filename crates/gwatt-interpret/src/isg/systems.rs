//! The coordinate systems of a program.

use crate::frame::Affine;

/// The coordinate systems of a program.
#[derive(Debug, Default)]
pub(super) struct Systems {
    /// What is stored, by its number; without one, by the next that is free.
    pub(super) stored: Vec<(u32, Affine)>,
    /// Those in force, each with what it stands in.
    pub(super) active: Vec<Affine>,
}

impl Systems {
    pub(super) fn in_force(&self) -> Option<Affine> {
        self.active.last().copied()
    }

    pub(super) fn activate(&mut self, map: Affine) {
        let map = self.active.last().map_or(map, |outer| map.then(outer));
        self.active.push(map);
    }
}
