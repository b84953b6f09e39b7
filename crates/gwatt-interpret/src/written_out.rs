//! What is asked of the interpreter to write the moves of a cycle out as single blocks.

use super::code::Motion;
use super::execute::Interpreter;
use super::siemens::Siemens;
use gwatt_machine::{AxisId, AxisSet, AxisValues};

impl Interpreter<'_> {
    /// Whether the values of a canned cycle are in force.
    #[must_use]
    pub fn in_cycle(&self) -> bool {
        self.cycle() != 0
    }

    /// Whether blocks that only name places drill there: by a canned cycle, or by a call after
    /// each of them (SINUMERIK).
    #[must_use]
    pub fn drills_at_places(&self) -> bool {
        let own = self.control.own.siemens();
        self.in_cycle() || own.is_some_and(Siemens::calls_after_moves)
    }

    /// The number of the canned cycle that is in force, times ten; 0 without one.
    #[must_use]
    pub fn cycle(&self) -> u16 {
        self.control.special.active
    }

    /// The motion word that was in force before the canned cycle.
    #[must_use]
    pub fn motion_before_cycle(&self) -> Motion {
        self.control.special.before()
    }

    /// Whether canned cycles return to the level R, not to where they began.
    #[must_use]
    pub fn returns_to_r(&self) -> bool {
        !self.control.special.to_initial
    }

    /// Whether G41 or G42 is in force, though the radius may be 0 here.
    #[must_use]
    pub fn chooses_radius(&self) -> bool {
        let compensation = self.control.compensation.as_ref();
        compensation.is_some_and(|it| it.is_on())
    }

    /// A place of the machine, mm and degrees, in coordinates and units of the program.
    #[must_use]
    pub fn place_in_program(&self, place: &AxisValues) -> AxisValues {
        let control = &self.control;
        let mut place = match control.own.siemens() {
            Some(state) => state.program_place(place),
            None => control.position.frame.program(place),
        };
        for (axis, value) in place.iter_mut().enumerate() {
            *value = control.in_unit(axis, *value);
        }
        let own = control.own.siemens();
        if control.modal.diameter || own.is_some_and(Siemens::in_diameters) {
            place[AxisId::X as usize] *= 2.0;
        }
        place
    }

    /// Whether it is known where a return to a reference point leads these axes; `point` as in
    /// [`Facts::reference`](crate::Facts::reference).
    #[must_use]
    pub fn knows_reference(&self, point: u16, moving: AxisSet) -> bool {
        let known = |axis| self.control.known_reference(point, axis).is_some();
        moving.iter().all(known)
    }

    /// Why the places of the program may not be those of the machine that they are taken
    /// for, for a move of these axes; `None` where all between them is known.
    #[must_use]
    pub fn unsure_of_places(&self, moving: AxisSet) -> Option<&'static str> {
        let control = &self.control;
        let language = &control.machine.controller.language;
        let lathe = language.dialect.lathe.is_some();
        let offsets_unknown = if control.t_is_offset() {
            control.tools.guessed.is_some()
        } else {
            lathe && control.tools.selected != 0
        };
        if offsets_unknown {
            return Some(
                "the offsets of the lathe's tool are not known: give them with --tool-table",
            );
        }
        if control.rules.returns_suspend_frames {
            // The places are those of the machine there, whatever the frames are.
            let off = control.tools.selected == 0 || control.choice.number == Some(0);
            return (!off).then_some("the length of the tool is in force: write D0 before it");
        }
        if control.tools.guessed.is_some() && moving.contains(AxisId::Z as usize) {
            return Some("the length of the tool is not known: give it with --tool-table");
        }
        let offsets = control.position.offsets();
        let known = moving.iter().all(|axis| offsets.is_known_of(axis));
        (!known).then_some(
            "the work offset is not known: give it in [offsets] of the machine file, or with \
             --parameters",
        )
    }
}
