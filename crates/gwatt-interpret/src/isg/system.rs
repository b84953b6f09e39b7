//! "Defining a machining coordinate system (#CS DEF, #CS ON/OFF)": a shift and
//! turns of the coordinates, put into one another.

use super::block::Reading;
use crate::expression::{Grammar, Outcome};
use crate::frame::Affine;

/// Coordinate systems that can be stored at the same time.
const STORED_MAX: usize = 5;

/// What stands in brackets after a command.
enum Given {
    Nothing,
    Number(u32),
    Map(Option<u32>, Affine),
}

impl Reading<'_, '_, '_> {
    pub(super) fn define_system(&mut self, start: usize) -> Outcome<()> {
        match self.given()? {
            Given::Map(number, map) => self.store(number, map, start),
            _ => Err(self.system_fault("#CS DEF without shifts and angles", start)),
        }
    }

    pub(super) fn system_on(&mut self, start: usize) -> Outcome<()> {
        let map = match self.given()? {
            Given::Map(number, map) => {
                if number.is_some() {
                    self.store(number, map, start)?;
                }
                Some(map)
            }
            Given::Number(number) => {
                let stored = &self.state.systems.stored;
                let found = stored.iter().find(|(known, _)| *known == number);
                found.map(|(_, map)| *map)
            }
            Given::Nothing => self.state.systems.stored.last().map(|(_, map)| *map),
        };
        let Some(map) = map else {
            return Err(self.system_fault("a coordinate system that is not stored", start));
        };
        if self.state.systems.active.len() >= STORED_MAX {
            return Err(self.system_fault("more than 5 coordinate systems in one another", start));
        }
        self.state.systems.activate(map);
        Ok(())
    }

    pub(super) fn system_off(&mut self, all: bool) {
        if all {
            self.state.systems.active.clear();
        } else {
            self.state.systems.active.pop();
        }
    }

    fn store(&mut self, number: Option<u32>, map: Affine, start: usize) -> Outcome<()> {
        let stored = &mut self.state.systems.stored;
        let free =
            (1..=STORED_MAX as u32 + 1).find(|free| stored.iter().all(|(known, _)| known != free));
        let number = number.or(free).unwrap_or_default();
        stored.retain(|(known, _)| *known != number);
        stored.push((number, map));
        if stored.len() > STORED_MAX {
            return Err(self.system_fault("more than 5 coordinate systems are stored", start));
        }
        Ok(())
    }

    /// `[1]`, `[0,0,10,0,0,45]`, `[1] [,,10]`.
    fn given(&mut self) -> Outcome<Given> {
        let first = self.list()?;
        let (number, values) = match *first.as_slice() {
            [] => return Ok(Given::Nothing),
            [Some(number)] => {
                let number = number as u32;
                let second = self.list()?;
                if second.is_empty() {
                    return Ok(Given::Number(number));
                }
                (Some(number), second)
            }
            _ => (None, first),
        };
        let unit = self.control.modal.mm_per_unit;
        let value = |index: usize| values.get(index).copied().flatten().unwrap_or(0.0);
        let shift = [0, 1, 2].map(|axis| value(axis) * unit);
        // P-CHAN-00394, by default ZYX: about Z first, then about the new Y, then
        // about the new X; the innermost turn meets a point first.
        let turn =
            |plane: [usize; 2], index: usize| Affine::rotation(plane, [0.0; 2], value(index));
        let map = turn([1, 2], 3)
            .then(&turn([2, 0], 4))
            .then(&turn([0, 1], 5))
            .then(&Affine::offset(shift));
        Ok(Given::Map(number, map))
    }

    /// Values in brackets, with gaps between their commas.
    fn list(&mut self) -> Outcome<Vec<Option<f64>>> {
        let start = self.cursor.at;
        let mut values = Vec::new();
        if !self.cursor.take(b'[') {
            return Ok(values);
        }
        let mut pending = true;
        loop {
            if self.cursor.take(b',') {
                if pending {
                    values.push(None);
                }
                pending = true;
            } else if self.cursor.take(b']') {
                break;
            } else if pending && values.len() < 6 {
                values.push(Some(self.number()?));
                pending = false;
            } else {
                return Err(self.system_fault("more than three shifts and three angles", start));
            }
        }
        Ok(values)
    }

    fn system_fault(&self, message: &str, start: usize) -> crate::expression::Fault {
        let help = "as in #CS ON [10,0,0,0,0,45]: shifts along X, Y, Z and angles about them";
        self.cursor.fault("coordinate-system", message, help, start)
    }
}
