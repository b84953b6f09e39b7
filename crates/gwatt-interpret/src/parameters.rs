//! Parameters: what programs keep in `#1`, `#<name>` and `#<_name>`.
//!
//! RS274/NGC (`LinuxCNC`, "Numbered Parameters", "Named Parameters"): #1 to #30
//! belong to the subroutine that runs, all are 0 until they are set; names
//! without `_` in front belong to it too. Fanuc (B-63944EN, "Variables"): #1 to
//! #33 belong to the macro that runs, #100 to #199 and #500 to #999 to all, and
//! each is null until it is set; from #1000 on they belong to the control.
//!
//! Those that the control keeps from one program to the next (`kept_variables` of the
//! profile) are unknown until a parameter file, `--set` or the program gives them a value.

mod control;
mod variables;

use crate::rules::Macros;
use std::collections::HashMap;

use super::expression::{Held, Name, Value};
use super::parameter_file::ParameterFile;

/// Numbers that belong to the subroutine that runs, and 0.
pub(super) const LOCALS: usize = 34;
/// Parameters that a program may keep: beyond, something runs away.
const COUNT_MAX: usize = 100_000;

/// `LinuxCNC` does not give places there either.
const UNDER_COMPENSATION: &str = "where the path ends under cutter compensation";

/// What a program has assigned.
#[derive(Debug)]
pub(super) struct Parameters {
    numbered: HashMap<u32, Held>,
    locals: [Held; LOCALS],
    named: HashMap<String, Held>,
    /// Names of the subroutine that runs.
    local_names: HashMap<String, Held>,
    callers: Vec<Saved>,
    /// Numbers below this one belong to the subroutine that runs.
    own: u32,
    /// All that the control has kept is known.
    complete: bool,
    /// The line that is executed, from 1, where its values may ask for it.
    pub(super) line: u64,
}

/// Which variables a subprogram has of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Scope {
    Own,
    /// Names; its numbers are those of the caller.
    OwnNames,
    Shared,
}

/// What a caller goes on with.
#[derive(Debug)]
struct Saved {
    locals: [Held; LOCALS],
    names: HashMap<String, Held>,
}

impl Parameters {
    pub(super) fn new(macros: Macros) -> Self {
        Self {
            numbered: HashMap::new(),
            locals: [Ok(None); LOCALS],
            named: HashMap::new(),
            local_names: HashMap::new(),
            callers: Vec::new(),
            own: if macros == Macros::OWords { 31 } else { 34 },
            complete: false,
            line: 0,
        }
    }

    /// Takes over what the control has kept; what shows its state is not here.
    pub(super) fn keep(&mut self, file: &ParameterFile) {
        self.complete = true;
        for (number, value) in file.iter() {
            // The file has as many as there are numbers, which is not too many.
            let _ = self.set(&Name::Number(number), Ok(Some(value)));
        }
    }

    /// A subprogram begins, with these values in #1 and so on if they are its
    /// own.
    pub(super) fn enter(&mut self, scope: Scope, arguments: &[Value; LOCALS]) {
        if scope == Scope::Shared {
            return;
        }
        let locals = if scope == Scope::Own {
            arguments.map(Ok)
        } else {
            self.locals
        };
        self.callers.push(Saved {
            locals: std::mem::replace(&mut self.locals, locals),
            names: std::mem::take(&mut self.local_names),
        });
    }

    /// How many subprograms run inside one another.
    pub(super) fn call_level(&self) -> usize {
        self.callers.len()
    }

    /// A subprogram with this scope has ended.
    pub(super) fn leave(&mut self, scope: Scope) {
        if scope == Scope::Shared {
            return;
        }
        if let Some(saved) = self.callers.pop() {
            if scope == Scope::Own {
                self.locals = saved.locals;
            }
            self.local_names = saved.names;
        }
    }

    /// What a number of the subroutine that runs holds; `None` for others.
    fn local(&self, number: u32) -> Option<Held> {
        let held = self.locals.get(number as usize).copied()?;
        (1..self.own).contains(&number).then(|| {
            // Without null it is 0.
            let rs274 = self.own < LOCALS as u32;
            held.map(|value| if rs274 { value.or(Some(0.0)) } else { value })
        })
    }

    /// What was assigned; `None` if nothing was.
    pub(super) fn number(&self, number: u32) -> Option<Held> {
        match self.locals.get(number as usize) {
            Some(value) if number < self.own => Some(*value),
            _ => self.numbered.get(&number).copied(),
        }
    }

    /// Keeps a value; false when there are too many.
    #[must_use]
    pub(super) fn set(&mut self, name: &Name<'_>, held: Held) -> bool {
        match name {
            Name::Number(number) => match self.locals.get_mut(*number as usize) {
                Some(local) if *number < self.own => *local = held,
                _ => drop(self.numbered.insert(*number, held)),
            },
            Name::Text(name) => {
                let names = if name.starts_with('_') {
                    &mut self.named
                } else {
                    &mut self.local_names
                };
                if let Some(known) = names.get_mut(name.as_ref()) {
                    *known = held;
                } else {
                    names.insert(name.clone().into_owned(), held);
                }
            }
        }
        self.numbered
            .len()
            .max(self.named.len())
            .max(self.local_names.len())
            <= COUNT_MAX
    }

    fn named(&self, name: &str) -> Option<Held> {
        let names = if name.starts_with('_') {
            &self.named
        } else {
            &self.local_names
        };
        names.get(name).copied()
    }
}

/// Predefined names that are not known before the program has a T.
fn is_tool(name: &str) -> bool {
    matches!(name, "_current_tool" | "_selected_tool")
}
