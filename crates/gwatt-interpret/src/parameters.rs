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

use std::collections::HashMap;

use super::execute::Control;
use super::expression::{Held, KEPT, Name, PROBED, Read, TOOL, Value, Variables};
use super::parameter_file::ParameterFile;
use gwatt_machine::{Family, Lathe};
use gwatt_motion::FeedMode;

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
    pub(super) fn new(family: Family) -> Self {
        Self {
            numbered: HashMap::new(),
            locals: [Ok(None); LOCALS],
            named: HashMap::new(),
            local_names: HashMap::new(),
            callers: Vec::new(),
            own: if family == Family::Rs274 { 31 } else { 34 },
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

impl Variables for Control<'_> {
    fn numbered(&self, number: u32) -> Read {
        if let Some(held) = self.parameters.local(number) {
            return held.into();
        }
        if self.fanuc() {
            return self.fanuc_variable(number);
        }
        if self.is_compensating() && matches!(number, 5420..=5428) {
            return Read::Unknown(UNDER_COMPENSATION);
        }
        if let Some(value) = self.system_parameter(number) {
            return Read::Value(Some(value));
        }
        match number {
            5061..=5070 => Read::Unknown(PROBED),
            5161..=5390 => Read::Unknown(KEPT),
            5399 => Read::Unknown("an input (M66)"),
            5400..=5413 if self.tools.loaded_known().is_none() => Read::Unknown(TOOL),
            5400..=5413 => Read::Unknown("the tool, without a tool table"),
            5420..=5428 => Read::Unknown("the start position"),
            0 | 5602.. => Read::Missing,
            _ => match self.parameters.number(number) {
                Some(held) => held.map(|value| value.or(Some(0.0))).into(),
                None if self.is_kept(number) => Read::Unknown(KEPT),
                None => Read::Value(Some(0.0)),
            },
        }
    }

    fn named(&self, name: &str) -> Read {
        if let Some(held) = self.parameters.named(name) {
            return held.map(|value| value.or(Some(0.0))).into();
        }
        let place = matches!(name.as_bytes(), [b'_', b'a'..=b'c' | b'u'..=b'z']);
        if place && self.is_compensating() {
            return Read::Unknown(UNDER_COMPENSATION);
        }
        if matches!(name, "_feed" | "_motion_mode") {
            self.reads_state.set(true);
        }
        if let Some(value) = self.named_parameter(name) {
            return Read::Value(Some(value));
        }
        if is_tool(name) {
            return Read::Unknown(TOOL);
        }
        if name.starts_with("_hal[") || name.starts_with("_ini[") {
            return Read::Unknown("the machine's configuration");
        }
        Read::Missing
    }

    fn fanuc(&self) -> bool {
        self.machine.controller.language.family != Family::Rs274
    }
}

impl Control<'_> {
    /// B-63944EN, "System Variables": what the program itself decides is known.
    fn fanuc_variable(&self, number: u32) -> Read {
        if matches!(number, 4001 | 4109) {
            self.reads_state.set(true);
        }
        if matches!(number, 3001 | 3002 | 3011 | 3012) {
            return Read::Unknown("the time");
        }
        if let Some(held) = self.parameters.number(number) {
            return held.into();
        }
        let shifted = self.compensation.as_ref().is_some_and(|it| it.shifts());
        if shifted && matches!(number, 5001..=5009 | 5021..=5029 | 5041..=5049) {
            return Read::Unknown(UNDER_COMPENSATION);
        }
        if self.is_kept(number) {
            return Read::Unknown(KEPT);
        }
        let axis = |first: u32| (number - first) as usize;
        let known = match number {
            _ if self.is_common(number) => return Read::Value(None),
            0 | 100..=199 | 500..=999 => return Read::Value(None),
            4001..=4021 => self.modal_code(number),
            4120 if self.tools.selected_known().is_none() => return Read::Unknown(TOOL),
            4120 => self.tools.selected_known().map(f64::from),
            4109 => self.modal.feed.as_ref().map(|feed| feed.value),
            4119 => Some(self.modal.spindle_rpm),
            5001..=5009 => self.place(axis(5001)),
            5021..=5029 => self.place_in_machine(axis(5021)),
            5041..=5049 => self.place(axis(5041)),
            _ => None,
        };
        match known {
            Some(value) => Read::Value(Some(value)),
            None if number >= 1000 => Read::Unknown("the state of the control"),
            None => Read::Missing,
        }
    }

    /// Whether the control keeps a variable whose value is not given.
    fn is_kept(&self, number: u32) -> bool {
        !self.parameters.complete && self.is_common(number)
    }

    /// Whether it keeps a variable from one program to the next.
    pub(super) fn is_common(&self, number: u32) -> bool {
        let kept = &self.machine.controller.language.kept_variables;
        kept.iter()
            .any(|[first, last]| (*first..=*last).contains(&number))
    }

    /// #4001 and so on: the G codes in force, by group.
    fn modal_code(&self, number: u32) -> Option<f64> {
        let system_a = self.dialect().lathe == Some(Lathe::A);
        Some(match number {
            4001 => f64::from(self.modal.motion.digit()? - b'0'),
            4002 => match self.modal.plane {
                [0, 1, 2] => 17.0,
                [2, 0, 1] => 18.0,
                _ => 19.0,
            },
            4003 if system_a => return None,
            4003 if self.modal.absolute => 90.0,
            4003 => 91.0,
            4005 => match (self.modal.feed_mode, system_a) {
                (FeedMode::InverseTime, _) => 93.0,
                (FeedMode::PerMinute, false) => 94.0,
                (FeedMode::PerRevolution, false) => 95.0,
                (FeedMode::PerMinute, true) => 98.0,
                (FeedMode::PerRevolution, true) => 99.0,
            },
            4006 if self.modal.mm_per_unit == 1.0 => 21.0,
            4006 => 20.0,
            4014 => match self.position.offsets().system {
                system @ 1..=6 => 53.0 + f64::from(system),
                _ => return None,
            },
            _ => return None,
        })
    }

    /// Gives a parameter a value, or takes note that what it holds is not known; the
    /// reason where it cannot have one.
    pub(super) fn assign(&mut self, name: &Name<'_>, held: Held) -> Result<(), &'static str> {
        match name {
            Name::Number(0) => return Err("#0 is always null"),
            Name::Number(number) if !self.fanuc() => {
                if *number > 5601 {
                    return Err("there are parameters up to #5601");
                }
                if let Ok(value) = held
                    && self.set_system_parameter(*number, value.unwrap_or(0.0))
                {
                    return Ok(());
                }
                if self.is_system_parameter(*number) {
                    return Err("it can only be read");
                }
            }
            Name::Number(number) if self.is_common(*number) => {}
            Name::Number(3000) => return Err("#3000 raises an alarm, which ends the program"),
            Name::Number(number @ 1000..) if !(3000..4000).contains(number) => {
                return Err("it belongs to the control, and may change offsets");
            }
            Name::Text(name) if self.named_parameter(name).is_some() || is_tool(name) => {
                return Err("it can only be read");
            }
            _ => {}
        }
        if self.parameters.set(name, held) {
            Ok(())
        } else {
            Err("there are more than 100000 of them")
        }
    }
}
