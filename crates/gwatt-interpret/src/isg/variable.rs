//! P parameters and variables ("Parameters and parameter calculation (P)",
//! "Programming variables (V.)", "Self-defined variables (#VAR, #ENDVAR)").

use super::block::Reading;
use super::cycle::parameter_name;
use super::terms::TERMS;
use crate::expression::{Cursor, Fault, Grammar, Ident, Names, Outcome, Terms, keep};

/// Letters P in a row: each asks for the value of the next.
const INDIRECT_MAX: usize = 8;
/// Indices of an array.
const DIMENSIONS: usize = 4;
/// The largest array that a declaration may fill.
const ARRAY_MAX: usize = 10_000;

impl<'t> Names<'t> for Reading<'_, '_, 't> {
    fn terms(&self) -> &'static Terms {
        &TERMS
    }

    fn cursor(&mut self) -> &mut Cursor<'t> {
        &mut self.cursor
    }

    fn variable(&mut self) -> Outcome<Option<f64>> {
        let start = self.cursor.at;
        let Some(name) = self.variable_name()? else {
            return Ok(None);
        };
        let Some(value) = self.value(&name) else {
            let reason = match name.get(..4) {
                Some("V.E.") => "comes from the PLC",
                Some("V.G." | "V.A.") => "is kept by the control",
                _ if name.starts_with('@') => "is given by no call of a cycle",
                _ => "has no value in this program",
            };
            let message = format!("{name} {reason}: what it holds, only the machine knows");
            let help = "give a P parameter or a V.P. variable its value in the program";
            return Err(self.cursor.fault("unknown-value", message, help, start));
        };
        self.uses.reads(name, &self.cursor, start)?;
        Ok(Some(value))
    }
}

impl Reading<'_, '_, '_> {
    /// Takes the name of a variable with its indices, upper case but for what is
    /// free in it: `P10`, `P[10]` and `PP2` by their number, `V.P.NAME[1]`.
    pub(super) fn variable_name(&mut self) -> Outcome<Option<Ident>> {
        self.cursor.peek();
        let name = match (self.cursor.byte(0), self.cursor.byte(1)) {
            (b'P', b'0'..=b'9' | b'P' | b'[') => {
                self.cursor.at += 1;
                Ident::of(format_args!("P{}", self.index_of_p()?))
            }
            (b'V', b'.') => free_name(&mut self.cursor),
            (b'@', b'P') => return parameter_name(&mut self.cursor).map(Some),
            _ => return Ok(None),
        };
        let mut name = name;
        for _ in 0..DIMENSIONS {
            if self.cursor.byte(0) != b'[' {
                break;
            }
            self.cursor.at += 1;
            let index = self.index()?;
            self.cursor.expect(b']')?;
            name = Ident::of(format_args!("{name}[{index}]"));
        }
        Ok(Some(name))
    }

    /// The number after P.
    fn index_of_p(&mut self) -> Outcome<i64> {
        match self.cursor.byte(0) {
            b'[' => {
                self.cursor.at += 1;
                let index = self.index()?;
                self.cursor.expect(b']')?;
                Ok(index)
            }
            // Indirect: the parameter whose number that one holds.
            b'P' if (0..=INDIRECT_MAX).all(|at| self.cursor.byte(at) == b'P') => {
                Err(not_an_index(&self.cursor, f64::NAN, self.cursor.at))
            }
            b'P' => {
                let start = self.cursor.at;
                let value = self.variable()?.unwrap_or_default();
                whole(value).ok_or_else(|| not_an_index(&self.cursor, value, start))
            }
            _ => {
                let start = self.cursor.at;
                self.cursor.digits();
                let text = self
                    .cursor
                    .text
                    .get(start..self.cursor.at)
                    .unwrap_or_default();
                let number = std::str::from_utf8(text)
                    .ok()
                    .and_then(|it| it.parse().ok());
                number.ok_or_else(|| not_an_index(&self.cursor, f64::NAN, start))
            }
        }
    }

    fn index(&mut self) -> Outcome<i64> {
        let start = self.cursor.at;
        let value = self.number()?;
        whole(value).ok_or_else(|| not_an_index(&self.cursor, value, start))
    }

    fn value(&self, name: &str) -> Option<f64> {
        if name.starts_with('@') {
            return self.state.levels.last()?.get(name).copied();
        }
        if is_local(name) {
            let mut levels = self.state.levels.iter().rev();
            return levels.find_map(|level| level.get(name)).copied();
        }
        self.state.globals.get(name).copied()
    }

    /// Gives a variable its value; V.L. where it was made, or here.
    pub(super) fn set(&mut self, name: &Ident, value: f64, start: usize) -> Outcome<()> {
        let kept = if name.starts_with('@') {
            self.state.levels.last_mut()
        } else if is_local(name) {
            let levels = &mut self.state.levels;
            let made = levels
                .iter()
                .rposition(|level| level.contains_key(name.as_str()));
            let at = made.unwrap_or(levels.len().saturating_sub(1));
            levels.get_mut(at)
        } else {
            Some(&mut self.state.globals)
        };
        let Some(kept) = kept else { return Ok(()) };
        keep(kept, name, value, &self.cursor, start)
    }

    /// `P1 = …`, `V.P.A = …`; also `+=` and the like. False where no variable
    /// begins.
    pub(super) fn assignment(&mut self) -> Outcome<bool> {
        let start = self.cursor.at;
        let Some(name) = self.variable_name()? else {
            return Ok(false);
        };
        let operator = self.cursor.peek().unwrap_or_default();
        let adds = matches!(operator, b'+' | b'-' | b'*' | b'/') && self.cursor.byte(1) == b'=';
        if !(adds || self.cursor.assigns()) {
            self.settable(&name, start)?;
            let message = format!("{name} stands alone");
            let help = "write its value after `=`, or the address that it is for before it";
            return Err(self.cursor.fault("assignment", message, help, start));
        }
        self.settable(&name, start)?;
        self.uses.assigns(&name, &self.cursor, start)?;
        self.cursor.at += if adds { 2 } else { 1 };
        if self.cursor.peek() == Some(b'"') {
            return Err(self
                .cursor
                .refused("a text in a variable", "no number", start));
        }
        let mut value = self.number()?;
        if adds {
            let Some(old) = self.value(&name) else {
                let message = format!("{name} has no value that could be changed");
                let help = "assign it before";
                return Err(self.cursor.fault("unknown-value", message, help, start));
            };
            value = match operator {
                b'+' => old + value,
                b'-' => old - value,
                b'*' => old * value,
                _ => old / value,
            };
            if !value.is_finite() {
                let message = "a result beyond all numbers";
                let help = "check the values that go into it";
                return Err(self.cursor.fault("arithmetic", message, help, start));
            }
        }
        self.set(&name, value, start)?;
        self.uses.assigned(name);
        Ok(true)
    }

    fn settable(&self, name: &str, start: usize) -> Outcome<()> {
        let own = name.starts_with('P')
            || name.starts_with('@') && self.state.is_called()
            || ["V.P.", "V.L.", "V.S.", "V.CYC."]
                .iter()
                .any(|front| name.starts_with(front));
        if own {
            return Ok(());
        }
        let message = format!("{name} belongs to the control or the PLC, and may change offsets");
        let help = "take it out, or write what it does in words";
        Err(self.cursor.fault("unsupported-word", message, help, start))
    }

    /// A line between #VAR and #ENDVAR.
    pub(super) fn declaration(&mut self) -> Outcome<()> {
        while self.cursor.peek().is_some() {
            let start = self.cursor.at;
            if self.cursor.byte(0) == b'#' {
                self.cursor.at += 1;
                if self.cursor.take_name("ENDVAR") {
                    self.state.declares = false;
                    return Ok(());
                }
                let message = "a command between #VAR and #ENDVAR";
                let help = "close the declaration by #ENDVAR";
                return Err(self.cursor.fault("syntax", message, help, start));
            }
            let Some(name) = self.base_name()? else {
                self.cursor.at += 1;
                let message = "a declaration needs a P parameter or a V. variable";
                let help = "write V.P.NAME = 1";
                return Err(self.cursor.fault("syntax", message, help, start));
            };
            self.settable(&name, start)?;
            self.declare(&name, start)?;
        }
        Ok(())
    }

    /// The name of a variable without its indices.
    fn base_name(&mut self) -> Outcome<Option<Ident>> {
        Ok(match (self.cursor.byte(0), self.cursor.byte(1)) {
            (b'P', b'0'..=b'9') => {
                self.cursor.at += 1;
                Some(Ident::of(format_args!("P{}", self.index_of_p()?)))
            }
            (b'V', b'.') => Some(free_name(&mut self.cursor)),
            _ => None,
        })
    }

    /// What stands after the name: lengths of an array, a type, values.
    fn declare(&mut self, name: &Ident, start: usize) -> Outcome<()> {
        let mut lengths = Vec::new();
        while lengths.len() < DIMENSIONS && self.cursor.take(b'[') {
            lengths.push(self.number()? as usize);
            self.cursor.expect(b']')?;
        }
        let count = lengths.iter().try_fold(1_usize, |all, length| {
            all.checked_mul(*length).filter(|all| *all <= ARRAY_MAX)
        });
        let Some(count) = count.filter(|count| *count > 0) else {
            let message = "an array without elements, or of more than 10000";
            let help = "declare a smaller one";
            return Err(self.cursor.fault("array-index", message, help, start));
        };
        if self.cursor.take(b':') {
            let kind = self.cursor.name();
            self.cursor.at += kind.len();
            if kind.starts_with("STRING") {
                self.cursor.pass_over_rest();
                return Ok(());
            }
        }
        let mut values = Vec::new();
        if self.cursor.take(b'=') {
            self.values(&mut values, count)?;
        }
        for element in 0..count {
            let value = values.get(element).copied().unwrap_or_default();
            let mut indices = String::new();
            let mut rest = element;
            for length in lengths.iter().rev() {
                indices = format!("[{}]{indices}", rest % length);
                rest /= length;
            }
            let name = Ident::of(format_args!("{name}{indices}"));
            // A declaration makes it again at this level.
            if is_local(&name) {
                let level = self.state.levels.last_mut();
                level.map(|level| level.insert(name.clone(), value));
            }
            self.set(&name, value, start)?;
        }
        Ok(())
    }

    /// `5` or `[1, 2, 3]`.
    fn values(&mut self, values: &mut Vec<f64>, most: usize) -> Outcome<()> {
        let start = self.cursor.at;
        if most == 1 && self.cursor.peek() != Some(b'[') {
            values.push(self.number()?);
            return Ok(());
        }
        self.cursor.expect(b'[')?;
        loop {
            values.push(self.number()?);
            if values.len() > most {
                let message = "more values than the array has elements";
                let help = "give the array its length in front";
                return Err(self.cursor.fault("array-index", message, help, start));
            }
            if !self.cursor.take(b',') {
                break;
            }
        }
        self.cursor.expect(b']')
    }
}

/// `V.P.NAME`: to a blank, an operator, a comment or a bracket. The case of what
/// is free counts.
fn free_name(cursor: &mut Cursor<'_>) -> Ident {
    let rest = cursor.text.get(cursor.at..).unwrap_or_default();
    let inside = |byte: &&u8| byte.is_ascii_alphanumeric() || matches!(**byte, b'_' | b'.');
    let length = rest.iter().take_while(inside).count();
    let name = rest.get(..length).unwrap_or_default();
    cursor.at += length;
    let begins = |front: &&str| {
        let own = name.get(..front.len());
        own.is_some_and(|own| own.eq_ignore_ascii_case(front.as_bytes()))
    };
    let front = ["V.P.", "V.L.", "V.S.", "V.CYC."].into_iter().find(begins);
    match front {
        Some(front) => {
            let free = name.get(front.len()..).unwrap_or_default();
            let free = std::str::from_utf8(free).unwrap_or_default();
            Ident::of(format_args!("{front}{free}"))
        }
        None => Ident::new(name),
    }
}

fn is_local(name: &str) -> bool {
    name.starts_with("V.L.") || name.starts_with("V.CYC.")
}

fn whole(value: f64) -> Option<i64> {
    ((-1e6..=1e9).contains(&value) && value.fract() == 0.0).then_some(value as i64)
}

fn not_an_index(cursor: &Cursor<'_>, value: f64, start: usize) -> Fault {
    let message = format!("{value} is no index");
    let help = "indices are whole numbers";
    cursor.fault("array-index", message, help, start)
}
