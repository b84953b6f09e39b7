//! Which places and coordinates rest on what; see [`Datum`].

use super::control::Control;
use super::datum::Datum;
use super::position::Position;
use gwatt_machine::{AxisId, AxisSet};

/// More than the cutting edges of a tool on SINUMERIK.
const EDGES: u32 = 100;

impl Position {
    /// Whether it is not known how far it is from where an axis stands to a place.
    pub(super) fn is_apart(&self, axis: usize, place: Datum) -> bool {
        self.unknown.contains(axis) || !self.datums.of(axis).compares(place)
    }

    /// Whether the place of an axis is known, and rests on just this.
    fn rests_on(&self, axis: usize, datum: Datum) -> bool {
        !self.unknown.contains(axis) && self.datums.of(axis) == datum
    }
}

impl Control<'_> {
    /// What absolute coordinates of the program rest on.
    pub(super) fn program_datum(&self, axis: usize) -> Datum {
        let offsets = self.offsets_datum(axis);
        self.position.datums.of_program(axis, offsets)
    }

    /// What they rest on by the offsets in force.
    fn offsets_datum(&self, axis: usize) -> Datum {
        // Only differences of positions matter to a printer.
        if self.rules.relative_places {
            return Datum::Machine;
        }
        let offsets = self.position.offsets();
        let system = match self.position.datums.own_system {
            Some(system) => system,
            None if offsets.is_known_of(axis) => 0,
            None => offsets.system,
        };
        match (system, self.guessed_tool(axis)) {
            (0, 0) => Datum::Machine,
            (system, tool) => Datum::Offsets {
                system,
                tool,
                set: 0,
            },
        }
    }

    /// What coordinates of the machine rest on: a tool's length holds there too on SINUMERIK.
    pub(super) fn machine_datum(&self, axis: usize) -> Datum {
        let tool = if self.rules.returns_suspend_frames {
            self.guessed_tool(axis)
        } else {
            0
        };
        if tool == 0 {
            return Datum::Machine;
        }
        Datum::Offsets {
            system: 0,
            tool,
            set: 0,
        }
    }

    /// The tool or offset whose values were taken as 0, plus 1; 0 where all is known.
    fn guessed_tool(&self, axis: usize) -> u32 {
        let lathe = self.machine.controller.language.dialect.lathe.is_some();
        let guessed = if self.t_is_offset() {
            self.tools.guessed
        } else if lathe {
            Some(self.tools.selected).filter(|tool| *tool != 0)
        } else if self.rules.returns_suspend_frames {
            // In G17 the tool is long along Z; a lathe's has two lengths.
            let along = axis == AxisId::Z as usize || self.modal.plane[2] != AxisId::Z as usize;
            let chosen = self.tools.changes > 0 && self.choice.number != Some(0);
            let edge = self.choice.number.unwrap_or(1) % EDGES;
            let each = self
                .tools
                .changes
                .saturating_mul(EDGES)
                .saturating_add(edge);
            Some(each).filter(|_| chosen && along)
        } else {
            let along = axis == AxisId::Z as usize || self.modal.diameter;
            self.tools.guessed.filter(|_| along)
        };
        guessed.map_or(0, |tool| tool.saturating_add(1))
    }

    /// An axis goes to an absolute coordinate: whether it is not known how far that is.
    pub(super) fn places(&mut self, axis: usize, machine_coordinates: bool) -> bool {
        let datum = if machine_coordinates {
            self.machine_datum(axis)
        } else {
            self.program_datum(axis)
        };
        let apart = self.position.is_apart(axis, datum) || self.position.points.apart();
        self.position.datums.place(axis, datum);
        apart
    }

    /// The same in a cycle, whose later moves may lead back to where it began: what begins
    /// apart from the program's coordinates stays so.
    pub(super) fn places_in_cycle(&mut self, axis: usize) -> bool {
        let apart = self.places(axis, false);
        if apart {
            self.position.datums.place(axis, Datum::Nothing);
        }
        apart
    }

    /// The same for those that a block names by absolute coordinates, and for those that
    /// turned coordinates move with them: the axes of which it is not known how far they go.
    pub(super) fn place_all(
        &mut self,
        named: AxisSet,
        absolute: AxisSet,
        machine_coordinates: bool,
    ) -> AxisSet {
        let mut apart = AxisSet::default();
        for axis in self.machine.axis_set.iter() {
            let frame = &self.position.frame;
            let moves_along = !machine_coordinates
                && !named.contains(axis)
                && named.iter().any(|by| frame.depends(axis, by));
            let by_points = named.contains(axis) && self.position.points.apart();
            let placed = absolute.contains(axis) || moves_along;
            if placed && self.places(axis, machine_coordinates) || by_points {
                apart.insert(axis);
            }
        }
        apart
    }

    /// Of axes of which it is not known how far they go, those of which it is assumed where
    /// they start: what their places rest on was taken as 0.
    pub(super) fn assumed(&self, unknown_start: AxisSet) -> AxisSet {
        let lost = if self.rules.relative_places {
            unknown_start
        } else {
            self.position.unknown
        };
        AxisSet(unknown_start.0 & !lost.0)
    }

    /// Axes whose places do not rest on what coordinates of the program rest on.
    pub(super) fn apart_from_program(&self) -> AxisSet {
        let mut apart = AxisSet::default();
        for axis in self.machine.axis_set.iter() {
            if !self.position.rests_on(axis, self.program_datum(axis)) {
                apart.insert(axis);
            }
        }
        apart
    }

    /// G92 and its like: the coordinates of an axis are counted from where it stands.
    pub(super) fn set_coordinate(&mut self, axis: usize, value: f64) {
        let offsets = self.offsets_datum(axis);
        self.position.datums.set_here(axis, offsets);
        self.position.set_offset(axis, value);
    }

    /// The origin of a system along an axis was set by the place where it stands, which may
    /// rest on what is not known.
    pub(super) fn origin_from_place(&mut self, system: u16, axis: usize) {
        if self.position.datums.of(axis) == Datum::Machine {
            return;
        }
        self.position
            .change(|offsets| offsets.forget_origin(system, axis));
        if system == self.position.offsets().system {
            let offsets = self.offsets_datum(axis);
            self.position.datums.set_here(axis, offsets);
        }
    }

    /// The coordinates of all axes become something that is not known, or an offset that
    /// is not known changes.
    pub(super) fn set_all_unknown(&mut self) {
        for axis in self.machine.axis_set.iter() {
            let offsets = self.offsets_datum(axis);
            self.position.datums.set_unknown(axis, offsets);
        }
    }

    /// Whether the coordinate of an axis in the program is not known where it stands.
    pub(super) fn coordinate_unknown(&self, axis: usize) -> bool {
        self.position.is_apart(axis, self.program_datum(axis))
    }
}
