//! What the place of an axis rests on. Machine coordinates in which an offset or a reference
//! point was taken as 0, since nobody has given it, can be compared only with those that rest
//! on the same one: how far it is from one to another is not known.

use gwatt_machine::AXES;

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
        /// How often coordinates had been set at places that rest on something else.
        set: u32,
    },
    /// Nothing that another place could rest on.
    Nothing,
}

impl Datum {
    /// Whether it is known how far it is from one place to the other.
    pub(super) fn compares(self, other: Self) -> bool {
        let either = |datum: Self| self == datum || other == datum;
        !either(Self::Nothing) && (self == other || either(Self::Start))
    }
}

/// Coordinates that were set at a place (G92).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct SetHere {
    /// What the coordinates rest on while the offsets stay.
    on: Datum,
    /// What coordinates rested on by the offsets in force then.
    offsets: Datum,
    /// The number of the setting.
    number: u32,
}

/// What the places of all axes rest on.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Datums {
    places: [Datum; AXES],
    set_here: [Option<SetHere>; AXES],
    /// What the points of G28 and G30 rest on that the program has stored.
    stored: [[Option<Datum>; AXES]; 2],
    /// How often coordinates were set.
    number: u32,
    /// The work coordinate system in force, where the language keeps its offsets itself.
    pub(super) own_system: Option<u16>,
}

impl Datums {
    /// What the place of an axis rests on.
    pub(super) fn of(&self, axis: usize) -> Datum {
        self.places[axis]
    }

    /// Where an axis stands rests on this from now on.
    pub(super) fn place(&mut self, axis: usize, on: Datum) {
        self.places[axis] = on;
    }

    /// The coordinates of an axis are counted from where it stands, under offsets that rest
    /// on this.
    pub(super) fn set_here(&mut self, axis: usize, offsets: Datum) {
        self.number += 1;
        let on = match self.places[axis] {
            Datum::Start | Datum::Nothing => self.fresh(offsets),
            place => place,
        };
        if self.places[axis] == Datum::Nothing {
            self.places[axis] = on;
        }
        self.set_here[axis] = Some(SetHere {
            on,
            offsets,
            number: self.number,
        });
    }

    /// The coordinates of all axes were set to something that is not known.
    pub(super) fn set_unknown(&mut self, axis: usize, offsets: Datum) {
        self.number += 1;
        let on = self.fresh(offsets);
        self.set_here[axis] = Some(SetHere {
            on,
            offsets,
            number: self.number,
        });
    }

    fn fresh(&self, offsets: Datum) -> Datum {
        let (system, tool) = match offsets {
            Datum::Offsets { system, tool, .. } => (system, tool),
            _ => (0, 0),
        };
        Datum::Offsets {
            system,
            tool,
            set: self.number,
        }
    }

    /// An axis is at home: its coordinates are those of the machine.
    pub(super) fn home(&mut self, axis: usize) {
        self.places[axis] = Datum::Machine;
        self.set_here[axis] = None;
    }

    /// No coordinates are set any more.
    pub(super) fn forget_set(&mut self) {
        self.set_here = Default::default();
    }

    /// What coordinates of the program rest on, where the offsets in force do so.
    pub(super) fn of_program(&self, axis: usize, offsets: Datum) -> Datum {
        match self.set_here[axis] {
            None => offsets,
            Some(set) if set.offsets == offsets => set.on,
            // A shift between known places holds under known offsets as well.
            Some(set) if set.on == Datum::Machine && set.offsets == Datum::Machine => offsets,
            Some(set) => match offsets {
                Datum::Offsets { system, tool, .. } => Datum::Offsets {
                    system,
                    tool,
                    set: set.number,
                },
                _ => Datum::Offsets {
                    system: 0,
                    tool: 0,
                    set: set.number,
                },
            },
        }
    }

    /// G28.1 and G30.1: the place of an axis becomes that of a point, 1 or 2.
    pub(super) fn store(&mut self, point: usize, axis: usize) {
        self.stored[point - 1][axis] = Some(self.places[axis]);
    }

    /// What the point of G28 or G30 rests on that the program has stored for an axis.
    pub(super) fn stored(&self, point: u16, axis: usize) -> Option<Datum> {
        let points = self.stored.get(usize::from(point).checked_sub(1)?)?;
        points[axis]
    }
}
