//! What the place of an axis rests on. Machine coordinates in which an offset or a reference
//! point was taken as 0, since nobody has given it, can be compared only with those that rest
//! on the same one: how far it is from one to another is not known.

use super::control::Control;
use super::position::Position;
use gwatt_machine::{AXES, AxisId, AxisSet};

/// What the machine coordinate of an axis rests on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Datum {
    /// The place where the program begins, which is stated.
    #[default]
    Start,
    /// All between it and the machine's zero is known.
    Machine,
    /// A reference point that nobody has given, by its number from 1.
    Reference(u16),
    /// Offsets that nobody has given: that of a work coordinate system, that of a tool; 0
    /// where it is known.
    Offsets {
        /// The work coordinate system, from 1.
        system: u16,
        /// The tool or its offset.
        tool: u32,
        /// Coordinates were set (G92) at a place that rested on something else.
        set_elsewhere: bool,
    },
}

impl Datum {
    /// Whether it is known how far it is from one place to the other.
    fn compares(self, other: Self) -> bool {
        self == other || self == Self::Start || other == Self::Start
    }
}

/// What the places of all axes rest on.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Datums {
    places: [Datum; AXES],
    /// Where coordinates were set (G92): what the place rested on, and what coordinates
    /// of the program did.
    set_at: [Option<(Datum, Datum)>; AXES],
}

impl Datums {
    /// Where an axis stands rests on this from now on.
    pub(super) fn place(&mut self, axis: usize, on: Datum) {
        self.places[axis] = on;
    }

    /// The coordinates of an axis are counted from where it stands.
    fn set_here(&mut self, axis: usize, offsets: Datum) {
        self.set_at[axis] = Some((self.places[axis], offsets));
    }

    /// No coordinates are set any more.
    pub(super) fn forget_set(&mut self) {
        self.set_at = Default::default();
    }
}

impl Position {
    /// Whether it is not known how far it is from where an axis stands to a place.
    pub(super) fn is_apart(&self, axis: usize, place: Datum) -> bool {
        self.unknown.contains(axis) || !self.datums.places[axis].compares(place)
    }

    /// Whether the place of an axis is known, and rests on just this.
    fn rests_on(&self, axis: usize, datum: Datum) -> bool {
        !self.unknown.contains(axis) && self.datums.places[axis] == datum
    }
}

impl Control<'_> {
    /// What absolute coordinates of the program rest on.
    pub(super) fn program_datum(&self, axis: usize) -> Datum {
        let offsets = self.offsets_datum(axis);
        match self.position.datums.set_at[axis] {
            None | Some((Datum::Start | Datum::Machine, _)) => offsets,
            Some((place, then)) if then == offsets => place,
            Some(_) => match offsets {
                Datum::Offsets { system, tool, .. } => Datum::Offsets {
                    system,
                    tool,
                    set_elsewhere: true,
                },
                _ => Datum::Offsets {
                    system: 0,
                    tool: 0,
                    set_elsewhere: true,
                },
            },
        }
    }

    /// What they rest on by the offsets in force.
    fn offsets_datum(&self, axis: usize) -> Datum {
        // Only differences of positions matter to a printer.
        if self.rules.relative_places {
            return Datum::Machine;
        }
        let offsets = self.position.offsets();
        let system = if offsets.is_known_of(axis) {
            0
        } else {
            offsets.system
        };
        match (system, self.guessed_tool(axis)) {
            (0, 0) => Datum::Machine,
            (system, tool) => Datum::Offsets {
                system,
                tool,
                set_elsewhere: false,
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
            set_elsewhere: false,
        }
    }

    /// The tool or offset whose values were taken as 0, plus 1; 0 where all is known.
    fn guessed_tool(&self, axis: usize) -> u32 {
        let lathe = self.machine.controller.language.dialect.lathe.is_some();
        let selected = self.tools.selected;
        let guessed = if lathe && self.rules.t_selects_offset {
            self.tools.guessed
        } else if lathe {
            Some(selected).filter(|tool| *tool != 0)
        } else if self.rules.returns_suspend_frames {
            // In G17 the tool is long along Z; a lathe's has two lengths.
            let along = axis == AxisId::Z as usize || self.modal.plane[2] != AxisId::Z as usize;
            let chosen = selected != 0 && self.choice.number != Some(0);
            Some(selected).filter(|_| chosen && along)
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
        let apart = self.position.is_apart(axis, datum);
        self.position.datums.place(axis, datum);
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
            if (absolute.contains(axis) || moves_along) && self.places(axis, machine_coordinates) {
                apart.insert(axis);
            }
        }
        apart
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
}
