//! Variables that a program keeps, and what one block does with them.

use std::collections::HashMap;

use super::cursor::Cursor;
use super::fault::{Fault, Outcome};
use super::ident::Ident;

/// Variables that a program may keep.
const COUNT_MAX: usize = 100_000;

/// What a program has assigned, by name.
pub(crate) type Kept = HashMap<Ident, f64>;

/// Keeps the value of a variable that was assigned at `start`.
pub(crate) fn keep(
    kept: &mut Kept,
    name: &Ident,
    value: f64,
    cursor: &Cursor<'_>,
    start: usize,
) -> Outcome<()> {
    if let Some(known) = kept.get_mut(name) {
        *known = value;
        return Ok(());
    }
    if kept.len() >= COUNT_MAX {
        let message = "more than 100000 variables";
        let help = "look for a loop that makes them";
        return Err(cursor.fault("assignment", message, help, start));
    }
    kept.insert(name.clone(), value);
    Ok(())
}

/// Variables that a block has read and assigned so far: which comes first, the
/// manuals do not say.
#[derive(Debug, Default)]
pub(crate) struct Uses {
    read: Vec<Ident>,
    assigned: Vec<Ident>,
}

impl Uses {
    /// A variable is used.
    pub(crate) fn reads(&mut self, name: Ident, cursor: &Cursor<'_>, start: usize) -> Outcome<()> {
        if self.assigned.contains(&name) {
            return Err(both(&name, cursor, start));
        }
        self.read.push(name);
        Ok(())
    }

    /// A variable is about to be assigned.
    pub(crate) fn assigns(&self, name: &Ident, cursor: &Cursor<'_>, start: usize) -> Outcome<()> {
        if self.assigned.contains(name) || self.read.contains(name) {
            return Err(both(name, cursor, start));
        }
        Ok(())
    }

    /// The value for it has been read: its own old value it may use.
    pub(crate) fn assigned(&mut self, name: Ident) {
        self.read.retain(|read| *read != name);
        self.assigned.push(name);
    }
}

fn both(name: &Ident, cursor: &Cursor<'_>, start: usize) -> Fault {
    let message = format!("the block assigns {name} and uses it");
    let help = "write two blocks: which comes first is not documented";
    cursor.fault("assignment", message, help, start)
}
